"""Converts anything that callers pass to arrays of doubles."""

import sys
from typing import Any

import numpy as np

from .._types import FloatArray
from ..errors import BspcsgError

#: The kinds of arrays that hold numbers: signed and unsigned integers, floats, objects.
_NUMBERS = "iufO"


def axes_of(values: Any) -> int | None:
    """Return the number of axes of values as an array; None if they do not form one."""
    try:
        return int(np.ndim(values))
    except ValueError:
        return None


def doubles(values: Any, refusal: BspcsgError) -> FloatArray:
    """Return values as an array of doubles, of any shape.

    Parameters
    ----------
    values : array_like
    refusal : BspcsgError
        The error to raise if they are not numbers.
    """
    array = doubles_or_none(values)
    if array is None:
        raise refusal
    return array


def doubles_or_none(values: Any) -> FloatArray | None:
    """Return values as an array of doubles, of any shape; None if they are not numbers.

    Complex numbers, dates, truth values and texts do not count, though numpy would convert them,
    nor do arrays with masked entries.
    """
    if is_masked(values):
        return None
    try:
        array = np.asarray(values)
        return array.astype(np.float64, copy=False) if array.dtype.kind in _NUMBERS else None
    except (TypeError, ValueError, OverflowError):
        return None


def is_masked(values: Any) -> bool:
    """Say whether an array has masked entries, which numpy's conversion would unmask."""
    # Such an array needs numpy.ma to be imported; another thread may be importing it just now.
    masks: Any = sys.modules.get("numpy.ma")
    kind = getattr(masks, "MaskedArray", ())
    return isinstance(values, kind) and bool(masks.is_masked(values))
