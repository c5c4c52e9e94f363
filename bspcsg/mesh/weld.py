"""Welding: finding the distinct points among points with equal coordinates."""

import numpy as np

from .._core import welded_points
from .._types import FloatArray, IndexArray
from ..errors import core_errors


def welded(points: FloatArray) -> tuple[FloatArray, IndexArray]:
    """Return the distinct points in the order of first occurrence, and an index for each point.

    The index is that of the equal distinct point. Points are equal if their coordinates are equal
    as numbers; 0.0 equals -0.0.

    Parameters
    ----------
    points : (k, 3) float64

    Returns
    -------
    (n, 3) float64, (k,) int64
    """
    with core_errors():
        return welded_points(np.asarray(points, dtype=np.float64))


def distinct_count(points: FloatArray) -> int:
    """Return the number of distinct points; points with equal coordinates count once.

    Parameters
    ----------
    points : (k, 3) float64
    """
    return len(welded(points)[0])
