"""Check points and hyperplanes, and convert them to rows for the core."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..._types import FloatArray, Scalar
from ...errors import invalid_parameter
from ...geometry import hyperplane as exact
from ...geometry.arrays import doubles
from ..trees.chosen_cuts import pairs_of
from .pieces import NormalAndOffset


def hyperplane(normal: Any, offset: Scalar, dimension: int | None = None) -> exact.Hyperplane:
    """Return the exact hyperplane with a normal and an offset; in 1D a number can be the normal."""
    entries = np.atleast_1d(np.asarray(normal, dtype=object)).tolist()
    count = len(entries)
    if dimension is None and not 1 <= count <= 3:
        raise invalid_parameter(
            f"The normal of a hyperplane must have one to three numbers, not {count}."
        )
    if dimension not in (None, count):
        raise invalid_parameter(
            f"The hyperplane's normal must have {dimension} numbers, not {count}."
        )
    return exact.Hyperplane.from_numbers(entries, offset)


def hyperplane_row(normal: Any, offset: Scalar, dimension: int, pitch: int) -> list[int]:
    """Return the lattice hyperplane nearest to a given one, as integers (*normal, offset)."""
    return hyperplane(normal, offset, dimension).on_lattice(pitch).row


def hyperplane_rows(cuts: Sequence[NormalAndOffset], dimension: int, pitch: int) -> list[list[int]]:
    """Return for each hyperplane the nearest one of the lattice, as integers (*normal, offset)."""
    return [hyperplane_row(*pair, dimension, pitch) for pair in pairs_of(cuts)]


def point_rows(points: Any, dimension: int) -> FloatArray:
    """Return points as a (k, dimension) float64 array, or raise an error for another shape."""
    array = np.ascontiguousarray(
        doubles(points, invalid_parameter("points must be an array of numbers."))
    )
    if dimension == 1 and array.ndim == 1:
        array = array[:, None]
    if array.size == 0:
        return np.zeros((0, dimension))
    if array.ndim != 2 or array.shape[1] != dimension:
        raise invalid_parameter(f"Points must have shape (n, {dimension}), not {array.shape}.")
    return array
