"""Minkowski sums in the plane."""

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...errors import LimitError
from .hulls import hull_region

#: The largest number of pairs of convex parts of two regions. More would take hours.
_MAX_PART_PAIRS = 20_000


def sum_of_regions(a: Region, b: Region) -> Region:
    """Return the Minkowski sum of two regions.

    Regions that are not convex are divided into convex parts. The sum of two parts is the hull of
    the sums of their corners; these hulls are united.

    Raises
    ------
    UnboundedError
        If a region reaches to infinity.
    LimitError
        If there are more than 20 000 pairs of convex parts ("too_large").
    """
    first, second = a.convex_parts(), b.convex_parts()
    if len(first) * len(second) > _MAX_PART_PAIRS:
        message = (
            f"the convex parts of the two regions form {len(first) * len(second):,} pairs, and"
            f" at most {_MAX_PART_PAIRS:,} are allowed; simplify the regions."
        )
        raise LimitError(message, "too_large")
    pitch = min(a.pitch, b.pitch)
    return Region.compose(hull_region(_sums(p, q), pitch) for p in first for q in second)


def _sums(first: FloatArray, second: FloatArray) -> FloatArray:
    sums = first[:, None, :] + second[None, :, :]
    return np.ascontiguousarray(sums.reshape(-1, 2))
