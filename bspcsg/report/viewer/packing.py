"""Models as JSON values that the viewer in a page unpacks: `assets/viewer/unpacking.js` does it.

Coordinates are whole numbers of 16 bits in the box of the whole model, so that layers which touch
still do, or single precision about its middle; whole numbers are stored as steps from one to the
next. Bytes of equal weight lie together, which lets gzip find more.
"""

import base64
import gzip
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..._types import FloatArray, IndexArray
from .landmark import Landmark
from .layer import Layer, bounds_of
from .paint import Colours, Paint, Scale

#: Steps along each side of the box.
_STEPS = 65535


def packed(
    layers: Sequence[Layer],
    *,
    quantised: bool,
    unit: str = "",
    paint: str = "",
    landmarks: Iterable[Landmark] = (),
) -> dict[str, Any]:
    """Return a model as JSON values.

    Parameters
    ----------
    layers : sequence of Layer
    quantised : bool
        Sixteen bits for each coordinate; otherwise single precision, for looking closely.
    unit : str
        The unit of lengths.
    paint : str
        The name of the paint that is on at first.
    landmarks : iterable of Landmark
        The places that somebody may want to look at.
    """
    low, high = bounds_of(layers)
    middle, side = low + (high - low) / 2, high - low
    longest = float(side.max()) or 1.0
    chunks = []
    for layer in layers:
        placed = (layer.vertices - middle) * (2 / longest)
        chunks.append(_steps(placed, side / longest) if quantised else _planar(placed))
        chunks += [_indices(layer.faces), _indices(layer.lines)]
        chunks += [part for one in layer.paints for part in _painted(one)]
    return {
        "layers": [_looks(layer) for layer in layers],
        "quantised": quantised,
        "step": (2 * side / longest / _STEPS).tolist(),
        "low": low.tolist(),
        "high": high.tolist(),
        "longest": longest,
        "unit": unit,
        "paint": paint,
        "places": [
            {
                "name": place.name,
                "at": ((place.at - middle) * (2 / longest)).tolist(),
                "size": place.size * 2 / longest,
            }
            for place in landmarks
        ],
        "data": compressed(b"".join(chunks)),
    }


def compressed(data: bytes) -> str:
    """Return the text of compressed bytes; the same for the same bytes, whenever it is made."""
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode("ascii")


def _looks(layer: Layer) -> dict[str, Any]:
    return {
        "name": layer.name,
        "colour": layer.colour,
        "opacity": layer.opacity,
        "shown": layer.shown,
        "closed": layer.is_closed,
        "vertices": len(layer.vertices),
        "triangles": len(layer.faces),
        "segments": len(layer.lines),
        "paints": [_look(paint) for paint in layer.paints],
    }


def _look(paint: Paint) -> dict[str, Any]:
    """Return all of a paint but its values."""
    if isinstance(paint, Colours):
        return {"name": paint.name, "kind": "colours", "at": paint.at}
    if isinstance(paint, Scale):
        ends = {"low": paint.low, "high": paint.high, "isCapped": paint.is_capped}
        return {
            "name": paint.name,
            "kind": "scale",
            "at": paint.at,
            "stops": list(paint.stops),
            **ends,
        }
    look: dict[str, Any] = {
        "name": paint.name,
        "kind": "labels",
        "at": "face",
        "labels": list(paint.labels),
        "colours": list(paint.colours),
    }
    if paint.uv is not None:
        look["images"] = [
            None if image is None else base64.b64encode(image).decode("ascii")
            for image in paint.images
        ]
    return look


def _painted(paint: Paint) -> list[bytes]:
    """Return the values of a paint."""
    if isinstance(paint, Colours):
        return [_planes(paint.values.reshape(-1, 4).T)]
    if isinstance(paint, Scale):
        return [_planes(paint.steps(_STEPS))]
    chunks = [_planes(paint.numbers.astype(np.uint16))]
    return chunks if paint.uv is None else [*chunks, _planar(paint.uv.reshape(-1, 2))]


def _steps(placed: FloatArray, half: FloatArray) -> bytes:
    """Return coordinates from -half to half as differences of whole numbers."""
    scale = _STEPS / np.where(half > 0, 2 * half, np.inf)
    # A side without length has all its points in the middle, wherever that is rounded to.
    whole = np.clip(np.rint((placed + half) * scale), 0, _STEPS).astype(np.int64).T
    return _planes(np.diff(whole, axis=1, prepend=0).astype(np.uint16))


def _planar(placed: FloatArray) -> bytes:
    return _planes(np.ascontiguousarray(placed.T, dtype="<f4"))


def _indices(indices: IndexArray) -> bytes:
    steps = np.diff(indices.ravel(), prepend=0)
    return _planes(((steps << 1) ^ (steps >> 63)).astype(np.uint32))


def _planes(numbers: npt.NDArray[Any]) -> bytes:
    """Return the lowest bytes of all numbers, then the next ones, up to the highest."""
    flat = np.ascontiguousarray(numbers).ravel()
    little = flat.astype(flat.dtype.newbyteorder("<"), copy=False)
    return little.view(np.uint8).reshape(-1, flat.itemsize).T.tobytes()
