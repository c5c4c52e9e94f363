"""Packing of models as JSON values for the viewer in a page, which `assets/viewer` unpacks.

Coordinates are 16-bit numbers in the bounding box of the whole model, so that layers that touch
still touch, or numbers of single precision relative to the centre of that box. Integers are stored
as differences. Bytes of equal significance are stored together, so that gzip compresses better.
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

#: The number of steps along each side of the bounding box, in which coordinates are counted.
_STEPS = 65535


def packed(
    layers: Sequence[Layer],
    *,
    quantised: bool,
    unit: str = "",
    paint: str = "",
    landmarks: Iterable[Landmark] = (),
) -> dict[str, Any]:
    """Return a model, with layers and landmarks, as JSON values for the viewer.

    Parameters
    ----------
    layers : sequence of Layer
    quantised : bool
        True for 16 bits for each coordinate; False for single precision, which shows details.
    unit : str
        The unit of lengths.
    paint : str
        The name of the paint that is used when the page is opened.
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
    """Compress bytes with gzip, and return them as base64; equal bytes give equal text."""
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
    """Return a paint as JSON values, without the values of its faces or corners."""
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
    """Return the values of a paint for all faces or corners, as blocks of bytes."""
    if isinstance(paint, Colours):
        return [_planes(paint.values.reshape(-1, 4).T)]
    if isinstance(paint, Scale):
        return [_planes(paint.steps(_STEPS))]
    chunks = [_planes(paint.numbers.astype(np.uint16))]
    return chunks if paint.uv is None else [*chunks, _planar(paint.uv.reshape(-1, 2))]


def _steps(placed: FloatArray, half: FloatArray) -> bytes:
    """Return coordinates from -half to half as 16-bit integers, each minus the previous one."""
    scale = _STEPS / np.where(half > 0, 2 * half, np.inf)
    # If a side of the box has no length, all points have step 0 there.
    whole = np.clip(np.rint((placed + half) * scale), 0, _STEPS).astype(np.int64).T
    return _planes(np.diff(whole, axis=1, prepend=0).astype(np.uint16))


def _planar(placed: FloatArray) -> bytes:
    return _planes(np.ascontiguousarray(placed.T, dtype="<f4"))


def _indices(indices: IndexArray) -> bytes:
    steps = np.diff(indices.ravel(), prepend=0)
    return _planes(((steps << 1) ^ (steps >> 63)).astype(np.uint32))


def _planes(numbers: npt.NDArray[Any]) -> bytes:
    """Return the least significant bytes of all numbers, then their next bytes, and so on."""
    flat = np.ascontiguousarray(numbers).ravel()
    little = flat.astype(flat.dtype.newbyteorder("<"), copy=False)
    return little.view(np.uint8).reshape(-1, flat.itemsize).T.tobytes()
