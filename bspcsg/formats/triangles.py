"""Exact tests for triangles without area, and for triangles that a change of corners flips.

Floating point decides where its error bound allows, fractions decide the rest.
"""

from fractions import Fraction

import numpy as np
import numpy.typing as npt

from .._types import FloatArray

#: Bound of the error of a normal's coordinate, in units of the product of the two edges' lengths.
#: Differences have a relative error of u = 2**-53, so a product of two has 3 u, a difference of
#: two such products at most 8 u of the larger; each product is at most that of the lengths.
_NORMAL_ERROR = 2.0**-49

#: Added to error bounds, which do not hold by themselves where products underflow.
_UNDERFLOW_ERROR = 1e-280

#: Between these sizes, products in pairs of doubles neither overflow nor underflow.
_MIN_EXACT_SIZE, _MAX_EXACT_SIZE = 2.0**-400, 2.0**400

#: Splits the 53 bits of a double into two halves whose products are exact.
_SPLITTER = 2.0**27 + 1

_Normals = tuple[FloatArray, FloatArray]


def are_flat(corners: FloatArray) -> npt.NDArray[np.bool_]:
    """Say whether each of (m, 3, 3) triangles has no area, decided exactly."""
    normals, errors = _normals(corners)
    flat = np.asarray(~(np.abs(normals) > errors[:, None]).any(axis=1))
    unsure = np.flatnonzero(flat)
    flat[unsure], decided = _flat_by_products(corners[unsure])
    for triangle in unsure[~decided].tolist():
        flat[triangle] = not any(_exact_normal(corners[triangle]))
    return flat


def _flat_by_products(corners: FloatArray) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Return which triangles are flat, and for which triangles this is certain.

    The answer is certain if the edges are differences without rounding: then products in two
    doubles are exact. Corners in single precision are such, unless their sizes differ by a factor
    of 2**29.
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
    """Say whether (m, 3) differences were not rounded, by Knuth's error of a sum."""
    back = found - end
    exact: npt.NDArray[np.bool_]
    exact = ((end - (found - back)) + (-start - back) == 0).all(axis=1)
    return exact


def _product(one: FloatArray, other: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return products as two doubles each, the rounded product and its error (Dekker)."""
    product = one * other
    (a, b), (c, d) = _halves(one), _halves(other)
    return product, b * d - (((product - a * c) - b * c) - a * d)


def _halves(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    scaled = values * _SPLITTER
    high = scaled - (scaled - values)
    return high, values - high


def are_turned(before: FloatArray, after: FloatArray) -> npt.NDArray[np.bool_]:
    """Say whether the normals of (m, 3, 3) triangles are more than a right angle apart, exactly."""
    (first, first_error), (second, second_error) = _normals(before), _normals(after)
    with np.errstate(over="ignore", invalid="ignore"):
        cosines = np.einsum("mi,mi->m", first, second)
        # Each coordinate has at most this error, and the sum of three is rounded once more.
        error = first_error * np.abs(second).sum(axis=1)
        error += second_error * (np.abs(first).sum(axis=1) + 3 * first_error)
        turned: npt.NDArray[np.bool_] = cosines < 0
        unsure = ~(np.abs(cosines) > 2 * error + _UNDERFLOW_ERROR)
    for triangle in np.flatnonzero(unsure).tolist():
        exact = zip(_exact_normal(before[triangle]), _exact_normal(after[triangle]), strict=True)
        turned[triangle] = sum(one * other for one, other in exact) < 0
    return turned


def _normals(corners: FloatArray) -> _Normals:
    """Return normals (m, 3), as long as twice the areas, and error bounds of coordinates."""
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
