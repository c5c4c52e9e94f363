"""Exact tests for triangles without area, and for triangles that a change of corners turns over.

Doubles decide where their error bound allows it, fractions decide all other cases.
"""

from fractions import Fraction

import numpy as np
import numpy.typing as npt

from .._types import FloatArray

#: A bound of the error of a normal's coordinate, relative to the product of the two edges' lengths.
#: Differences have a relative error of u = 2**-53, so a product of two has 3 u, a difference of
#: two such products at most 8 u of the larger; each product is at most the product of the lengths.
_NORMAL_ERROR = 2.0**-49

#: Added to error bounds, since these are too small where products underflow.
_UNDERFLOW_ERROR = 1e-280

#: Between these magnitudes, products as pairs of doubles neither overflow nor underflow.
_MIN_EXACT_SIZE, _MAX_EXACT_SIZE = 2.0**-400, 2.0**400

#: Dekker's factor, which splits the 53 bits of a double into two halves with exact products.
_SPLITTER = 2.0**27 + 1

_Normals = tuple[FloatArray, FloatArray]


def are_flat(corners: FloatArray) -> npt.NDArray[np.bool_]:
    """Say for each triangle, (m, 3, 3), whether it has no area, decided exactly."""
    normals, errors = _normals(corners)
    flat = np.asarray(~(np.abs(normals) > errors[:, None]).any(axis=1))
    unsure = np.flatnonzero(flat)
    flat[unsure], decided = _flat_by_products(corners[unsure])
    for triangle in unsure[~decided].tolist():
        flat[triangle] = not any(_exact_normal(corners[triangle]))
    return flat


def _flat_by_products(corners: FloatArray) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Return for each triangle whether it has no area, and whether this result is certain.

    The result is certain if the differences of corners were not rounded: then products as pairs of
    doubles are exact. Corners in single precision have such differences, unless their magnitudes
    differ by a factor of 2**29.
    """
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    exact = _is_difference(first, corners[:, 1], corners[:, 0])
    exact &= _is_difference(second, corners[:, 2], corners[:, 0])
    sizes = np.abs(np.concatenate([first, second], axis=1))
    exact &= ((sizes == 0) | ((sizes > _MIN_EXACT_SIZE) & (sizes < _MAX_EXACT_SIZE))).all(axis=1)
    flat = np.ones(len(corners), dtype=bool)
    for one, other in ((0, 1), (1, 2), (2, 0)):
        left = _product(first[:, one], second[:, other])
        right = _product(first[:, other], second[:, one])
        flat &= (left[0] == right[0]) & (left[1] == right[1])
    return flat, exact


def _is_difference(found: FloatArray, end: FloatArray, start: FloatArray) -> npt.NDArray[np.bool_]:
    """Say for each row whether `found`, the difference end - start, was not rounded (Knuth)."""
    back = found - end
    exact: npt.NDArray[np.bool_]
    exact = ((end - (found - back)) + (-start - back) == 0).all(axis=1)
    return exact


def _product(one: FloatArray, other: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the exact product as two doubles: the rounded product and its error (Dekker)."""
    product = one * other
    (a, b), (c, d) = _halves(one), _halves(other)
    return product, b * d - (((product - a * c) - b * c) - a * d)


def _halves(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    scaled = values * _SPLITTER
    high = scaled - (scaled - values)
    return high, values - high


def are_turned(before: FloatArray, after: FloatArray) -> npt.NDArray[np.bool_]:
    """Say for each triangle whether its normals before and after are over a right angle apart.

    The triangles are (m, 3, 3); the decision is exact.
    """
    (first, first_error), (second, second_error) = _normals(before), _normals(after)
    with np.errstate(over="ignore", invalid="ignore"):
        cosines = np.einsum("mi,mi->m", first, second)
        # An error bound of the sum of products; twice as much also covers its own rounding.
        error = first_error * np.abs(second).sum(axis=1)
        error += second_error * (np.abs(first).sum(axis=1) + 3 * first_error)
        turned: npt.NDArray[np.bool_] = cosines < 0
        unsure = ~(np.abs(cosines) > 2 * error + _UNDERFLOW_ERROR)
    for triangle in np.flatnonzero(unsure).tolist():
        exact = zip(_exact_normal(before[triangle]), _exact_normal(after[triangle]), strict=True)
        turned[triangle] = sum(one * other for one, other in exact) < 0
    return turned


def _normals(corners: FloatArray) -> _Normals:
    """Return the normals of triangles (m, 3), as long as twice the areas, and error bounds (m,)."""
    with np.errstate(over="ignore", invalid="ignore", under="ignore"):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = np.ascontiguousarray(corners.transpose(1, 2, 0))
        px, py, pz, qx, qy, qz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        normals = np.stack([py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx], axis=1)
        sizes = (np.abs(px) + np.abs(py) + np.abs(pz)) * (np.abs(qx) + np.abs(qy) + np.abs(qz))
        errors = np.where(np.isfinite(sizes), _NORMAL_ERROR * sizes + _UNDERFLOW_ERROR, np.inf)
    return normals, errors


def _exact_normal(triangle: FloatArray) -> tuple[Fraction, Fraction, Fraction]:
    a, b, c = ([Fraction(value) for value in corner] for corner in triangle.tolist())
    p, q = ([x - y for x, y in zip(end, a, strict=True)] for end in (b, c))
    return (
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    )
