"""Points with equal coordinates as one point."""

import numpy as np

from .._types import FloatArray, IndexArray

#: Odd multipliers that spread the bits of three coordinates over one 64-bit word.
_MIXERS = (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)


def welded(points: FloatArray) -> tuple[FloatArray, IndexArray]:
    """Return the different points in the order in which they first occur, and who is which.

    Points are the same if their coordinates are equal as numbers; 0.0 and -0.0 are.

    Parameters
    ----------
    points : (k, 3) float64

    Returns
    -------
    (n, 3) float64, (k,) int64
    """
    points = points + 0.0
    mixed = _mixed(points)
    _, first, same = np.unique(mixed, return_index=True, return_inverse=True)
    if not np.array_equal(points[first[same]], points):
        # Two different points fell on one word.
        _, first, same = np.unique(points, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.argsort(order)
    return points[first[order]], rank[same.ravel()]


def distinct(points: FloatArray) -> int:
    """Return how many different points there are, as `welded` tells them apart.

    Parameters
    ----------
    points : (k, 3) float64
    """
    points = points + 0.0
    mixed = _mixed(points)
    words = np.sort(mixed)
    if (words[1:] != words[:-1]).all():
        return len(points)
    order = np.argsort(mixed)
    ranked, sorted_points = mixed[order], points[order]
    is_next = ranked[1:] != ranked[:-1]
    if (is_next | (sorted_points[1:] == sorted_points[:-1]).all(axis=1)).all():
        return int(is_next.sum()) + (len(points) > 0)
    # Two different points fell on one word.
    return len(np.unique(points, axis=0))


def _mixed(points: FloatArray) -> "np.ndarray[tuple[int], np.dtype[np.uint64]]":
    """Return a word for each point, the same for equal points."""
    words = points.view(np.uint64)
    mixed = words[:, 0] * np.uint64(_MIXERS[0])
    for axis in (1, 2):
        mixed = (mixed ^ (mixed >> np.uint64(29))) + words[:, axis] * np.uint64(_MIXERS[axis])
    word: np.ndarray[tuple[int], np.dtype[np.uint64]] = mixed
    return word
