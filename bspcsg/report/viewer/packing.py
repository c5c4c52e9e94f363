"""Models as JSON values for the viewer in a page; `assets/viewer/unpacking.js` unpacks them.

Coordinates are 16-bit numbers in the box of the whole model, so that layers that touch still touch,
or single precision relative to its middle. Integers are stored as differences. Bytes of equal
significance lie together, which improves compression by gzip.
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
        The points of interest.
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
    """Return compressed bytes as text, reproducibly."""
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
    """Return the description of a paint without its values."""
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
    """Return coordinates from -half to half as differences of integers."""
    scale = _STEPS / np.where(half > 0, 2 * half, np.inf)
    # A side without length has all its points in the middle.
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
