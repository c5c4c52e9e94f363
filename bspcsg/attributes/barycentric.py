"""Barycentric coordinates in double-doubles, and in fractions for very thin triangles.

A point lies in its triangle's plane up to rounding, so both are projected along a coordinate axis.
"""

from fractions import Fraction
from typing import TypeAlias

import numpy as np

from .._types import FloatArray

#: A double-double, the unevaluated sum of two doubles: the rounded value and its error.
_Pair: TypeAlias = tuple[FloatArray, FloatArray]

#: The factor that splits the 53 bits of a double into two halves whose products are exact.
_SPLITTER = 2.0**27 + 1

#: The largest ratio of the product of two edge lengths to twice the area for which double-doubles
#: suffice. Determinants err by less than 2**-98 of that product, so weights by less than 2**-58.
_MAX_EXACT_THINNESS = 2.0**40


def weights(points: FloatArray, triangles: FloatArray) -> FloatArray:
    """Return the barycentric coordinates, (k, 3), of (k, 3) points in (k, 3, 3) triangles.

    Their error is a few units in the last place of 1. In triangles without area they are not
    finite.
    """
    flat, seen = _projected(points, triangles)
    a, b, c = seen[:, 0], seen[:, 1], seen[:, 2]
    area, size = _determinant(a, b, c)
    second, _ = _determinant(a, flat, c)
    third, _ = _determinant(a, b, flat)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        v, w = (_quotient(part, area) for part in (second, third))
        thin = ~(size <= _MAX_EXACT_THINNESS * np.abs(area[0]))
    found = np.stack([1.0 - v - w, v, w], axis=1)
    for k in np.flatnonzero(thin).tolist():
        found[k] = _exact_weights(flat[k], seen[k])
    return found


def _projected(points: FloatArray, triangles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Project points and triangles along the axis nearest to each triangle's normal.

    Return (k, 2) points and (k, 3, 2) triangles.
    """
    edges = triangles[:, 1:] - triangles[:, :1]
    normals = np.abs(np.cross(edges[:, 0], edges[:, 1]))
    axes = np.array([[1, 2], [2, 0], [0, 1]])[normals.argmax(axis=1)]
    rows = np.arange(len(points))[:, None]
    return points[rows, axes], triangles[rows[:, :, None], np.arange(3)[:, None], axes[:, None]]


def _determinant(a: FloatArray, b: FloatArray, c: FloatArray) -> tuple[_Pair, FloatArray]:
    """Return twice the signed area of each triangle, and a bound of the products in it."""
    px, py = _difference(b[:, 0], a[:, 0]), _difference(b[:, 1], a[:, 1])
    qx, qy = _difference(c[:, 0], a[:, 0]), _difference(c[:, 1], a[:, 1])
    left, right = _product(px, qy), _product(py, qx)
    high, low = _difference(left[0], right[0])
    size = (np.abs(px[0]) + np.abs(py[0])) * (np.abs(qx[0]) + np.abs(qy[0]))
    return _two_sum(high, low + (left[1] - right[1])), size


def _difference(one: FloatArray, other: FloatArray) -> _Pair:
    found = one - other
    back = found - one
    return found, (one - (found - back)) + (-other - back)


def _two_sum(high: FloatArray, low: FloatArray) -> _Pair:
    total = high + low
    return total, low - (total - high)


def _product(one: _Pair, other: _Pair) -> _Pair:
    high = one[0] * other[0]
    (a, b), (c, d) = _split_doubles(one[0]), _split_doubles(other[0])
    low = b * d - (((high - a * c) - b * c) - a * d)
    return _two_sum(high, low + (one[0] * other[1] + one[1] * other[0]))


def _split_doubles(values: FloatArray) -> _Pair:
    scaled = values * _SPLITTER
    high = scaled - (scaled - values)
    return high, values - high


def _quotient(part: _Pair, whole: _Pair) -> FloatArray:
    """Return the quotients of double-doubles as doubles: a first quotient and its correction."""
    first = part[0] / whole[0]
    taken = _product((first, np.zeros_like(first)), whole)
    rest = (part[0] - taken[0]) + (part[1] - taken[1])
    quotient: FloatArray = first + rest / whole[0]
    return quotient


def _exact_weights(point: FloatArray, triangle: FloatArray) -> tuple[float, float, float]:
    a, b, c, p = ([Fraction(x) for x in corner] for corner in (*triangle.tolist(), point.tolist()))

    def area(u: list[Fraction], v: list[Fraction], w: list[Fraction]) -> Fraction:
        return (v[0] - u[0]) * (w[1] - u[1]) - (v[1] - u[1]) * (w[0] - u[0])

    whole = area(a, b, c)
    if whole == 0:
        return np.nan, np.nan, np.nan
    v, w = area(a, p, c) / whole, area(a, b, p) / whole
    return float(1 - v - w), float(v), float(w)
