"""The nearest points of segments."""

from typing import Any

import numpy as np

from .._types import FloatArray
from ..errors import InvalidMeshError

#: How many pairs of point and segment are looked at together.
_PAIRS = 1 << 20


def nearest_on_segments(points: Any, segments: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the nearest point of any of (n, 2, 2) segments to each of (k, 2) points, and how far.

    Raises
    ------
    InvalidMeshError
        If the points have another shape or are not finite.
    """
    array = np.asarray(points, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 2:
        raise InvalidMeshError(f"Points must have shape (k, 2), not {array.shape}.", "shape")
    if not np.isfinite(array).all():
        raise InvalidMeshError("Points must be finite.", "non_finite")
    step = max(_PAIRS // len(segments), 1)
    blocks = [array[k : k + step] for k in range(0, len(array), step)]
    found = [_nearest(block, segments) for block in blocks]
    if not found:
        return np.zeros((0, 2)), np.zeros(0)
    nearest = np.concatenate(found)
    return nearest, np.hypot(*(nearest - array).T)


def _nearest(points: FloatArray, segments: FloatArray) -> FloatArray:
    start = segments[:, 0]
    along = segments[:, 1] - start
    length = (along**2).sum(axis=1)
    offset = points[:, None, :] - start
    t = np.clip((offset * along).sum(axis=2) / length, 0.0, 1.0)
    candidates = start + t[:, :, None] * along
    best = ((candidates - points[:, None, :]) ** 2).sum(axis=2).argmin(axis=1)
    return np.asarray(candidates[np.arange(len(points)), best])
