"""Arcs and patches of the unit sphere, for rounded edges and corners."""

import math

import numpy as np

from ..._types import FloatArray, IndexArray
from ...geometry.transform import cos_sin


def arc_directions(start: FloatArray, end: FloatArray, steps: int) -> FloatArray:
    """Return (steps + 1, 3) unit vectors, evenly spaced on the great circle from start to end."""
    degrees = _degrees(start, end)
    rows = [
        _blended([(start, degrees * (1 - k / steps)), (end, degrees * (k / steps))])
        for k in range(steps + 1)
    ]
    return np.array([start, *rows[1:-1], end])


def patch_directions(corners: FloatArray, steps: int) -> FloatArray:
    """Return unit vectors in a grid over a spherical triangle, row by row from its first corner.

    Row i has i + 1 vectors; the vectors on each side of the triangle equal `arc_directions`.

    Parameters
    ----------
    corners : (3, 3) float64
        The unit vectors of the triangle's corners.
    steps : int
        The number of parts of each side.
    """
    sides = [_degrees(corners[k], corners[(k + 1) % 3]) for k in range(3)]
    points = []
    for i in range(steps + 1):
        for j in range(i + 1):
            shares = ((steps - i) / steps, (i - j) / steps, j / steps)
            points.append(_on_patch(corners, sides, shares))
    return np.array(points)


def patch_faces(steps: int) -> IndexArray:
    """Return the (steps², 3) triangles of a grid of `patch_directions`, with its orientation."""
    faces = []
    for i in range(steps):
        low, high = i * (i + 1) // 2, (i + 1) * (i + 2) // 2
        faces += [(low + j, high + j, high + j + 1) for j in range(i + 1)]
        faces += [(low + j, high + j + 1, low + j + 1) for j in range(i)]
    return np.array(faces, dtype=np.int64)


def _on_patch(
    corners: FloatArray, sides: list[float], shares: tuple[float, float, float]
) -> FloatArray:
    """Return a point of a spherical triangle as a unit vector, given three numbers that add to 1.

    The numbers, `shares`, act as barycentric coordinates. The weight of a corner is the sine of its
    number times an angle. On a side of the triangle that angle is the side's length in degrees, so
    evenly spaced numbers give evenly spaced points.
    """
    weighted = []
    for k in range(3):
        following, last = shares[(k + 1) % 3], shares[(k + 2) % 3]
        rest = following + last
        mean = (following * sides[k] + last * sides[(k + 2) % 3]) / rest if rest else 90.0
        weighted.append((corners[k], mean * shares[k]))
    return _blended(weighted)


def _blended(weighted: list[tuple[FloatArray, float]]) -> FloatArray:
    total = sum((corner * cos_sin(angle)[1] for corner, angle in weighted), np.zeros(3))
    unit: FloatArray = total / math.hypot(*total.tolist())
    return unit


def _degrees(one: FloatArray, other: FloatArray) -> float:
    across = math.hypot(*np.cross(one, other).tolist())
    return math.degrees(math.atan2(across, float(one @ other)))
