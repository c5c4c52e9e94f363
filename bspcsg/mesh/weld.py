"""Points with equal coordinates as one point."""

import numpy as np

from .._core import welded_points
from .._types import FloatArray, IndexArray
from ..errors import core_errors


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
    with core_errors():
        return welded_points(np.asarray(points, dtype=np.float64))


def distinct(points: FloatArray) -> int:
    """Return how many different points there are, as `welded` tells them apart.

    Parameters
    ----------
    points : (k, 3) float64
    """
    return len(welded(points)[0])
