"""Convert numbers in any form that callers pass to arrays of doubles."""

import sys
from typing import Any

import numpy as np

from .._types import FloatArray
from ..errors import BspcsgError

#: numpy's codes of array kinds that are numbers: signed and unsigned integers, floats, objects.
_NUMBERS = "iufO"


def axes_of(values: Any) -> int | None:
    """Return the number of axes that values have as an array; None if they do not form an array."""
    try:
        return int(np.ndim(values))
    except ValueError:
        return None


def doubles(values: Any, refusal: BspcsgError) -> FloatArray:
    """Return values as an array of doubles of any shape, or raise the given error.

    Parameters
    ----------
    values : array_like
    refusal : BspcsgError
        The error to raise if `values` are not numbers.
    """
    array = doubles_or_none(values)
    if array is None:
        raise refusal
    return array


def doubles_or_none(values: Any) -> FloatArray | None:
    """Return values as an array of doubles of any shape; None if they are not all numbers.

    Complex numbers, dates, truth values, texts and masked entries do not count as numbers, though
    numpy would convert them.
    """
    if is_masked(values):
        return None
    try:
        array = np.asarray(values)
        return array.astype(np.float64, copy=False) if array.dtype.kind in _NUMBERS else None
    except (TypeError, ValueError, OverflowError):
        return None


def is_masked(values: Any) -> bool:
    """Return true if an array has masked entries, which numpy's conversion would unmask."""
    # Without numpy.ma imported there are no masked arrays; it may be half imported by another
    # thread.
    masks: Any = sys.modules.get("numpy.ma")
    kind = getattr(masks, "MaskedArray", ())
    return isinstance(values, kind) and bool(masks.is_masked(values))
