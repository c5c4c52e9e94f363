"""Arrays of doubles out of whatever callers hand in."""

from typing import Any

import numpy as np

from .._types import FloatArray
from ..errors import BspcsgError


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
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise refusal from error
