"""Axis-parallel boxes around parts of a mesh, and the search for boxes that contain others."""

from collections.abc import Iterator

import numpy as np

from .._types import FloatArray, IndexArray
from .box_tree import BoxTree, NearPairSearch

#: The number of boxes in one search: among a thousand nested boxes, a search takes 2 MB.
_BOXES_PER_BATCH = 256


def boxes_of(corners: FloatArray, owner: IndexArray) -> FloatArray:
    """Return the axis-parallel box around the triangles of each group.

    Parameters
    ----------
    corners : (m, 3, 3) float64
    owner : (m,) int64
        For each triangle the number of its group, from 0; no group is empty.

    Returns
    -------
    (n, 2, 3) float64
        The smallest and the largest coordinates of each box.
    """
    order = np.argsort(owner, kind="stable")
    starts = np.flatnonzero(np.diff(owner[order], prepend=-1))
    low = np.minimum.reduceat(corners.min(axis=1)[order], starts)
    high = np.maximum.reduceat(corners.max(axis=1)[order], starts)
    return np.stack([low, high], axis=1)


def boxes_around(inner: FloatArray, outer: FloatArray) -> Iterator[IndexArray]:
    """Yield for each box of `inner` the numbers of the boxes of `outer` that contain it, ascending.

    A box contains an equal box.

    Parameters
    ----------
    inner : (k, 2, 3) float64
    outer : (n, 2, 3) float64

    Notes
    -----
    The time grows with (k + n) log n, and with the number of pairs in which an outer box contains
    a corner of an inner box.
    """
    if not len(inner) or not len(outer):
        yield from (np.zeros(0, dtype=np.int64) for _ in inner)
        return
    tree = BoxTree.over(outer)
    for at in range(0, len(inner), _BOXES_PER_BATCH):
        yield from _around(inner[at : at + _BOXES_PER_BATCH], outer, tree)


def _around(inner: FloatArray, outer: FloatArray, tree: BoxTree) -> list[IndexArray]:
    """Return for each box of `inner` the numbers of the boxes of `outer` that contain it.

    `tree` is the tree over `outer`.
    """
    found = [np.zeros((0, 2), dtype=np.int64)]
    for pairs in NearPairSearch(BoxTree.of_points(inner[:, 0]), tree, 0.0).leaves():
        numbers, rows = tree.members(pairs[:, 1])
        owners = pairs[rows, 0]
        begins = (outer[numbers, 0] <= inner[owners, 0]).all(axis=1)
        holds = begins & (outer[numbers, 1] >= inner[owners, 1]).all(axis=1)
        found.append(np.column_stack([owners[holds], numbers[holds]]))
    owners, numbers = np.concatenate(found).T
    ends = np.bincount(owners, minlength=len(inner)).cumsum()
    return np.split(numbers[np.lexsort((numbers, owners))], ends[:-1])
