"""Boxes around parts of a mesh, and those that lie in others."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from .._types import FloatArray, IndexArray

#: Boxes that are asked for at once: of a thousand nested ones, 2 MB.
_BATCH = 256


def boxes_of(corners: FloatArray, owner: IndexArray) -> FloatArray:
    """Return the boxes around the triangles of each owner.

    Parameters
    ----------
    corners : (m, 3, 3) float64
    owner : (m,) int64
        For each triangle the number of its owner, from 0; each has one at least.

    Returns
    -------
    (n, 2, 3) float64
        The least and the largest corner of each.
    """
    order = np.argsort(owner, kind="stable")
    starts = np.flatnonzero(np.diff(owner[order], prepend=-1))
    low = np.minimum.reduceat(corners.min(axis=1)[order], starts)
    high = np.maximum.reduceat(corners.max(axis=1)[order], starts)
    return np.stack([low, high], axis=1)


def boxes_around(inner: FloatArray, outer: FloatArray) -> Iterator[IndexArray]:
    """Yield for each box the numbers of those that hold it, ascending; equal ones hold each other.

    Parameters
    ----------
    inner : (k, 2, 3) float64
    outer : (n, 2, 3) float64

    Notes
    -----
    Linear in the boxes, but for those that hold a corner of one and the logarithm of their number.
    """
    if not len(inner) or not len(outer):
        yield from (np.zeros(0, dtype=np.int64) for _ in inner)
        return
    index = box_index(outer)
    for at in range(0, len(inner), _BATCH):
        batch = inner[at : at + _BATCH]
        found, counts = index.intersection_v(batch[:, 0], batch[:, 0])
        near = np.split(found.astype(np.int64), counts.astype(np.int64).cumsum()[:-1])
        for box, numbers in zip(batch, near, strict=True):
            yield np.sort(numbers[(outer[numbers, 1] >= box[1]).all(axis=1)])


def box_index(boxes: FloatArray) -> Any:
    """Return an index of rtree over boxes, (n, 2, 3)."""
    from rtree.index import Index, Property  # late: most calls need none

    numbers = np.arange(len(boxes))
    return Index((numbers, boxes[:, 0], boxes[:, 1]), properties=Property(dimension=3))
