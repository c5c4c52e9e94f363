"""Arrays of doubles out of whatever callers hand in."""

import sys
from typing import Any

import numpy as np

from .._types import FloatArray
from ..errors import BspcsgError

#: The kinds of arrays that hold numbers: signed and unsigned integers, floats, objects.
_NUMBERS = "iufO"


def axes_of(values: Any) -> int | None:
    """Return how many axes values have as an array; None if they make up none."""
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
        The error to raise if they are no numbers.
    """
    array = doubles_or_none(values)
    if array is None:
        raise refusal
    return array


def doubles_or_none(values: Any) -> FloatArray | None:
    """Return values as an array of doubles, of any shape; None if they are no numbers.

    Complex numbers, dates, truth values and texts are none, though numpy would make doubles of
    them, and so are arrays with entries that are masked out.
    """
    if is_masked(values):
        return None
    try:
        array = np.asarray(values)
        return array.astype(np.float64, copy=False) if array.dtype.kind in _NUMBERS else None
    except (TypeError, ValueError, OverflowError):
        return None


def is_masked(values: Any) -> bool:
    """Say whether an array has entries that are masked out, which numpy would show again."""
    # Whoever has such an array has imported this; another thread may just be importing it.
    masks: Any = sys.modules.get("numpy.ma")
    kind = getattr(masks, "MaskedArray", ())
    return isinstance(values, kind) and bool(masks.is_masked(values))
