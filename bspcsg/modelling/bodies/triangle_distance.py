"""The distance between two triangles, in doubles or in exact fractions."""

from typing import Any, TypeAlias

import numpy as np

from ..._types import FloatArray

#: An array of float64, or of `Fraction` objects.
Numbers: TypeAlias = np.ndarray[Any, np.dtype[Any]]


def nearest_points(first: Numbers, second: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Return the squared distances and nearest points of pairs of triangles that do not cross.

    Parameters
    ----------
    first, second : (k, 3, 3)
        Corners of triangles with area: float64, or `Fraction` objects for exact results.

    Returns
    -------
    (k,), (k, 3), (k, 3)
        The squared distances, and the nearest points on the first and the second triangles, in
        the same number type.

    Notes
    -----
    If triangles do not cross, the nearest points are those of two edges, or a corner and its
    projection onto the other triangle.
    """
    best, p, q = _of_edges(first, second, 0, 0)
    for edge in range(1, 9):
        best, p, q = _nearer((best, p, q), _of_edges(first, second, edge // 3, edge % 3))
    for corner in range(3):
        foot, gap, counts = _plane_projections(first[:, corner], second)
        gap = np.where(counts, gap, best)
        best, p, q = _nearer((best, p, q), (gap, first[:, corner], foot))
        foot, gap, counts = _plane_projections(second[:, corner], first)
        gap = np.where(counts, gap, best)
        best, p, q = _nearer((best, p, q), (gap, foot, second[:, corner]))
    return best, p, q


def least_gaps(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return lower bounds, (k,), of the squared distances of pairs of triangles, up to rounding.

    Parameters
    ----------
    first, second : (k, 3, 3) float64
        Corners of the triangles.
    """
    ways = second.mean(axis=1) - first.mean(axis=1)
    lengths = np.linalg.norm(ways, axis=1)
    ends = np.einsum("kij,kj->ki", first, ways).max(axis=1)
    starts = np.einsum("kij,kj->ki", second, ways).min(axis=1)
    apart = np.divide(starts - ends, lengths, np.zeros_like(lengths), where=lengths > 0)
    gaps: FloatArray = np.maximum(apart, 0.0) ** 2
    return gaps


def _nearer(
    one: tuple[Numbers, Numbers, Numbers], other: tuple[Numbers, Numbers, Numbers]
) -> tuple[Numbers, Numbers, Numbers]:
    less = (other[0] < one[0]).astype(bool)
    wide = less[:, None]
    return (
        np.where(less, other[0], one[0]),
        np.where(wide, other[1], one[1]),
        np.where(wide, other[2], one[2]),
    )


def _dot(a: Numbers, b: Numbers) -> Numbers:
    product: Numbers = a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2]
    return product


def _cross(a: Numbers, b: Numbers) -> Numbers:
    parts = [a[:, k - 2] * b[:, k - 1] - a[:, k - 1] * b[:, k - 2] for k in range(3)]
    return np.stack(parts, axis=1)


def _clamped(numbers: Numbers) -> Numbers:
    return np.where(numbers < 0, 0 * numbers, np.where(numbers > 1, 0 * numbers + 1, numbers))


def _quotient(a: Numbers, b: Numbers) -> Numbers:
    """Return a / b, and 0 where b is 0."""
    zero = (b == 0).astype(bool)
    return np.where(zero, 0 * a, a / np.where(zero, 0 * b + 1, b))


def _of_edges(first: Numbers, second: Numbers, i: int, j: int) -> tuple[Numbers, Numbers, Numbers]:
    """Return squared distances and nearest points of edge i of `first` and edge j of `second`.

    Edge k runs from corner k to corner k - 2 (Ericson 2005, 5.1.9).
    """
    p, u = first[:, i], first[:, i - 2] - first[:, i]
    q, v = second[:, j], second[:, j - 2] - second[:, j]
    r = p - q
    a, b, c, e, f = _dot(u, u), _dot(u, v), _dot(u, r), _dot(v, v), _dot(v, r)
    s = _clamped(_quotient(b * f - c * e, a * e - b * b))
    t = _clamped((b * s + f) / e)
    s = _clamped((b * t - c) / a)
    x, y = p + s[:, None] * u, q + t[:, None] * v
    return _dot(x - y, x - y), x, y


def _plane_projections(points: Numbers, triangles: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """Project each point onto the plane of one triangle.

    Return the projections, (k, 3), the squared distances, (k,), and where a projection lies in its
    triangle, (k,) bool.
    """
    a = triangles[:, 0]
    u, v, w = triangles[:, 1] - a, triangles[:, 2] - a, points - a
    n = _cross(u, v)
    size, height = _dot(n, n), _dot(w, n)
    gamma, beta = _dot(_cross(u, w), n), _dot(_cross(w, v), n)
    inside = (size > 0) & (gamma >= 0) & (beta >= 0) & (gamma + beta <= size)
    share = _quotient(height, size)
    foot = points - share[:, None] * n
    return foot, share * height, inside.astype(bool)
