"""Models as JSON values that the viewer in a page unpacks: `assets/loader.js` is the other end.

Coordinates are whole numbers of 16 bits in the box of the whole model, so that layers which touch
still do, or single precision about its middle; whole numbers are stored as steps from one to the
next. Bytes of equal weight lie together, which lets gzip find more.
"""

import base64
import gzip
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ..._types import FloatArray, IndexArray
from .layer import Layer, bounds_of

#: Steps along each side of the box.
_STEPS = 65535


def packed(layers: Sequence[Layer], *, quantised: bool, unit: str = "") -> dict[str, Any]:
    """Return a model as JSON values.

    Parameters
    ----------
    layers : sequence of Layer
    quantised : bool
        Sixteen bits for each coordinate; otherwise single precision, for looking closely.
    unit : str
        What lengths are shown in.
    """
    low, high = bounds_of(layers)
    middle, side = low + (high - low) / 2, high - low
    longest = float(side.max()) or 1.0
    chunks = []
    for layer in layers:
        placed = (layer.vertices - middle) * (2 / longest)
        chunks.append(_steps(placed, side / longest) if quantised else _planar(placed))
        chunks.append(_faces(layer.faces))
    return {
        "layers": [_looks(layer) for layer in layers],
        "quantised": quantised,
        "step": (2 * side / longest / _STEPS).tolist(),
        "low": low.tolist(),
        "high": high.tolist(),
        "longest": longest,
        "radius": float(np.linalg.norm(side)) / longest or 1.0,
        "unit": unit,
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
    }


def _steps(placed: FloatArray, half: FloatArray) -> bytes:
    """Return coordinates from -half to half as differences of whole numbers."""
    scale = _STEPS / np.where(half > 0, 2 * half, np.inf)
    # A side without length has all its points in the middle, wherever that is rounded to.
    whole = np.clip(np.rint((placed + half) * scale), 0, _STEPS).astype(np.int64).T
    return _planes(np.diff(whole, axis=1, prepend=0).astype(np.uint16))


def _planar(placed: FloatArray) -> bytes:
    return _planes(np.ascontiguousarray(placed.T, dtype="<f4"))


def _faces(faces: IndexArray) -> bytes:
    steps = np.diff(faces.ravel(), prepend=0)
    return _planes(((steps << 1) ^ (steps >> 63)).astype(np.uint32))


def _planes(numbers: npt.NDArray[Any]) -> bytes:
    """Return the lowest bytes of all numbers, then the next ones, up to the highest."""
    flat = np.ascontiguousarray(numbers).ravel()
    little = flat.astype(flat.dtype.newbyteorder("<"), copy=False)
    return little.view(np.uint8).reshape(-1, flat.itemsize).T.tobytes()
