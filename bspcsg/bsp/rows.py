"""Points and hyperplanes as rows for the core."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from .._types import FloatArray, Scalar
from ..errors import invalid_parameter
from .pieces import Hyperplane


def hyperplane_row(normal: Any, offset: Scalar) -> FloatArray:
    """Return a normal and an offset as one row."""
    try:
        row = np.append(np.atleast_1d(np.asarray(normal, dtype=np.float64)), float(offset))
    except (TypeError, ValueError) as error:
        raise invalid_parameter("A hyperplane is a normal and an offset, in numbers.") from error
    if not 2 <= len(row) <= 4:
        raise invalid_parameter("The normal of a hyperplane has one to three numbers.")
    return row


def hyperplane_rows(cuts: Sequence[Hyperplane], dimension: int) -> FloatArray:
    """Return hyperplanes as rows of normal and offset."""
    rows = [hyperplane_row(normal, offset) for normal, offset in cuts]
    if any(len(row) != dimension + 1 for row in rows):
        raise invalid_parameter(f"The normals of the cuts must have {dimension} numbers.")
    return np.array(rows)


def point_rows(points: Any, dimension: int) -> FloatArray:
    """Return points as (k, dimension) float64."""
    try:
        array = np.ascontiguousarray(points, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise invalid_parameter("Points must be numbers.") from error
    if dimension == 1 and array.ndim == 1:
        array = array[:, None]
    if array.size == 0:
        return np.zeros((0, dimension))
    if array.ndim != 2 or array.shape[1] != dimension:
        raise invalid_parameter(f"Points must have shape (n, {dimension}), not {array.shape}.")
    return array
