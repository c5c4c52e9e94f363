"""Images of trees over facets under motions of the lattice: turns, shifts, whole factors."""

from collections.abc import Sequence
from fractions import Fraction
from operator import index
from typing import Any

import numpy as np

from ..._core import FragmentTree
from ..._types import IndexArray
from ...errors import LimitError, core_errors, invalid_parameter
from ...geometry.arrays import doubles
from ...geometry.hyperplane import exact_number

#: The first entry of a row of ``arrays["cut"]`` whose second is an index in `own_hyperplanes`.
_OWN = -2

#: Lattice coordinates are below this many steps.
_REACH = 2**53


def moved_core(
    core: FragmentTree,
    lenience: tuple[bool, bool],
    axes: Sequence[int] | None,
    offset: Any,
    scale: int,
) -> FragmentTree:
    """Return the core's tree with moved facets, rebuilt with moved cuts."""
    corners, offsets = core.lattice()
    matrix = _rotation(axes, core.dimension)
    shift = _steps(offset, core.dimension, core.pitch)
    largest = int(np.abs(corners).max(initial=0)) * scale + int(np.abs(shift).max())
    if largest >= _REACH:
        raise LimitError(
            "The moved tree extends beyond the lattice of 2^53 steps; move it less, or build it"
            " with a coarser pitch.",
            "too_large",
        )
    own = [_moved_row(row, matrix, shift, scale) for row in core.own()]
    cuts = core.nodes()["cut"].copy()
    for cut in cuts:
        if cut[0] >= 0:
            row = [0] * core.dimension + [int(cut[1])]
            row[cut[0]] = 1
            # After a rotation the minus side may have the larger coordinates, which an
            # axis-parallel cut cannot express.
            cut[:] = _OWN, len(own)
            own.append(_moved_row(row, matrix, shift, scale))
    moved = np.ascontiguousarray(scale * corners @ matrix.T + shift)
    with core_errors():
        return FragmentTree.rebuild(moved, offsets, core.pitch, cuts, lenience, own)


def _rotation(axes: Sequence[int] | None, dimension: int) -> IndexArray:
    """Return the matrix of a signed permutation of the axes that is no mirror image."""
    message = (
        f"axes must contain each number from 1 to {dimension} exactly once, with a plus or minus"
        " sign."
    )
    try:
        given = list(range(1, dimension + 1)) if axes is None else list(map(index, axes))
    except TypeError as error:
        raise invalid_parameter(message) from error
    if sorted(map(abs, given)) != list(range(1, dimension + 1)):
        raise invalid_parameter(message)
    matrix = np.zeros((dimension, dimension), dtype=np.int64)
    for row, axis in enumerate(given):
        matrix[row, abs(axis) - 1] = 1 if axis > 0 else -1
    if round(float(np.linalg.det(matrix))) != 1:
        raise invalid_parameter(
            f"axes={tuple(given)} is a reflection, but must be a rotation; change the sign of one"
            " axis."
        )
    return matrix


def _steps(offset: Any, dimension: int, pitch: int) -> IndexArray:
    if offset is None:
        return np.zeros(dimension, dtype=np.int64)
    refusal = invalid_parameter(f"offset must be {dimension} finite numbers.")
    given = np.atleast_1d(doubles(offset, refusal))
    if given.shape != (dimension,) or not np.isfinite(given).all():
        raise refusal
    steps = [round(exact_number(x) / Fraction(10) ** pitch) for x in given.tolist()]
    if max(map(abs, steps)) >= _REACH:
        raise LimitError(
            "The moved tree extends beyond the lattice of 2^53 steps; move it less, or build it"
            " with a coarser pitch.",
            "too_large",
        )
    return np.array(steps, dtype=np.int64)


def _moved_row(row: Sequence[int], matrix: IndexArray, shift: IndexArray, scale: int) -> list[int]:
    """Return the image (*n', c') of a hyperplane n·x = c, given as (*n, c), under a motion.

    The motion scales x by `scale`, rotates it by `matrix`, and adds `shift`.
    """
    *normal, product = row
    turned = [sum(int(m) * n for m, n in zip(line, normal, strict=True)) for line in matrix]
    moved = sum(n * int(s) for n, s in zip(turned, shift, strict=True))
    return [*turned, product * scale + moved]
