"""What six digits took away: rotations that are not quite, faces that no longer meet."""

import math

import numpy as np

from .._types import FloatArray

#: Entries of a matrix may be this far from a rotation's to be taken for one.
NEARLY = 1e-5

#: OpenSCAD writes so many digits.
DIGITS = 6


def polished_matrix(matrix: FloatArray) -> FloatArray:
    """Return the matrix with its linear part replaced by the nearest rotation, if it is near.

    Parameters
    ----------
    matrix : (4, 4) float64

    Notes
    -----
    The nearest orthogonal matrix is U V' of the singular value decomposition U S V' (Schönemann
    1966). Mirror images stay such. Entries that are 0 or ±1 up to rounding become so.
    """
    u, _, v = np.linalg.svd(matrix[:3, :3])
    rotation = u @ v
    if np.abs(rotation - matrix[:3, :3]).max() > NEARLY:
        return matrix
    whole = np.round(rotation)
    rotation = np.where(np.abs(rotation - whole) < 1e-12, whole, rotation)
    result = matrix.copy()
    result[:3, :3] = rotation
    return result


def polished_pitch(largest: float) -> int:
    """Return the pitch of the lattice for a model whose coordinates reach so far.

    Its step is a unit of the sixth digit there: no coordinate was written finer, and what differs
    by rounding alone falls on one lattice point, unless it lies halfway between two.
    """
    return math.floor(math.log10(largest)) + 1 - DIGITS if largest > 0 else -9
