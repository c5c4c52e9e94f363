"""A tree of boxes around triangles, and the search for near pairs of leaves of two such trees."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from .._types import FloatArray, IndexArray

#: The number of members in a leaf.
_LEAF_SIZE = 8

#: The number of boxes on each level in which `near_leaves` looks further. With 1, the search for
#: the nearest triangles takes four times as long as with 4; with 8, half as long again.
_BOXES_FOLLOWED = 4

#: Bits of each coordinate in the position on Morton's curve, by which members are sorted.
_BITS = 21

#: The number of pairs of boxes that are divided at a time: this bounds the memory to some 100 MB.
_PAIRS_PER_BATCH = 1 << 16

#: Pairs of boxes, (k, 2): the number of a box in a level of each of two trees.
BoxPairs: TypeAlias = IndexArray


@dataclass(frozen=True, eq=False)
class BoxTree:
    """A binary tree of axis-parallel boxes; a leaf is the box around eight members near each other.

    Members are triangles, boxes or points.

    Parameters
    ----------
    order : (m,) int64
        The numbers of the members; leaf k has members 8 k to 8 k + 7 of this array.
    levels : list of (low, high), each (n, 3) float64
        Boxes from the leaves to the root; box k contains boxes 2 k and 2 k + 1 of the level before.
    """

    order: IndexArray
    levels: list[tuple[FloatArray, FloatArray]]

    @classmethod
    def over(cls, corners: FloatArray) -> "BoxTree":
        """Return the tree over triangles, (m, 3, 3), or over boxes, (m, 2, 3)."""
        low, high = corners.min(axis=1), corners.max(axis=1)
        order = np.argsort(_morton_positions((low + high) / 2), kind="stable")
        starts = np.arange(0, len(order), _LEAF_SIZE)
        boxes = np.minimum.reduceat(low[order], starts), np.maximum.reduceat(high[order], starts)
        levels = [boxes]
        while len(levels[-1][0]) > 1:
            low, high = levels[-1]
            starts = np.arange(0, len(low), 2)
            levels.append((np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)))
        return cls(order, levels)

    @classmethod
    def of_points(cls, points: FloatArray) -> "BoxTree":
        """Return a tree of one level over points, (m, 3), in which leaf k is point k."""
        return cls(np.arange(len(points)), [(points, points)])

    def near_leaves(self, points: FloatArray) -> IndexArray:
        """Return up to four leaves near each point, (m, k), not necessarily the nearest ones."""
        near, around = np.zeros((len(points), 1), np.int64), points[:, None]
        for low, high in reversed(self.levels[:-1]):
            halves = np.hstack([2 * near, np.minimum(2 * near + 1, len(low) - 1)])
            gaps = squared_gaps(low[halves], high[halves], around, around)
            best = np.argsort(gaps, axis=1, kind="stable")[:, :_BOXES_FOLLOWED]
            near = np.take_along_axis(halves, best, axis=1)
        return near

    def members(self, leaves: IndexArray) -> tuple[IndexArray, IndexArray]:
        """Return the members of all given leaves, and each member's row in the array `leaves`."""
        places = leaves[:, None] * _LEAF_SIZE + np.arange(_LEAF_SIZE)
        rows = np.broadcast_to(np.arange(len(leaves))[:, None], places.shape)
        there = places < len(self.order)
        return self.order[places[there]], rows[there]


class NearPairSearch:
    """A search for pairs of leaves of two trees that are near to each other.

    Parameters
    ----------
    first, second : BoxTree
    limit : float or (n,) float64
        Pairs with a larger squared distance are ignored; the caller may lower it during the search.
        If the first tree is of points, each point may have its own limit.
    """

    def __init__(self, first: BoxTree, second: BoxTree, limit: float | FloatArray) -> None:
        self._trees = first, second
        self.limit = limit

    def leaves(self) -> Iterator[BoxPairs]:
        """Yield pairs of leaves with squared distances up to `limit`, roughly nearest first."""
        top = len(self._trees[0].levels) - 1, len(self._trees[1].levels) - 1
        roots = np.arange(len(self._trees[0].levels[-1][0]))
        waiting = [(top, np.column_stack([roots, np.zeros_like(roots)]))]
        while waiting:
            level, pairs = waiting.pop()
            gaps = self._gaps(level, pairs)
            limit = self.limit[pairs[:, 0]] if isinstance(self.limit, np.ndarray) else self.limit
            near = np.flatnonzero(gaps <= limit)
            near = near[np.argsort(gaps[near], kind="stable")]
            if len(near) == 0:
                continue
            if level == (0, 0):
                yield pairs[near]
                continue
            below, halves = self._divided(level, pairs[near])
            chunks = [
                halves[k : k + _PAIRS_PER_BATCH] for k in range(0, len(halves), _PAIRS_PER_BATCH)
            ]
            waiting.extend((below, chunk) for chunk in reversed(chunks))

    def _gaps(self, level: tuple[int, int], pairs: BoxPairs) -> FloatArray:
        low, high = self._trees[0].levels[level[0]]
        low_b, high_b = self._trees[1].levels[level[1]]
        i, j = pairs.T
        return squared_gaps(low[i], high[i], low_b[j], high_b[j])

    def _divided(self, level: tuple[int, int], pairs: BoxPairs) -> tuple[tuple[int, int], BoxPairs]:
        """Replace the boxes of pairs by their children, in the tree with more levels below them.

        If both trees have equally many levels below, replace both boxes. Return the new levels,
        and all pairs of boxes.
        """
        deepest = max(level)
        cut = [own == deepest for own in level]
        below = level[0] - cut[0], level[1] - cut[1]
        for side in (0, 1):
            if cut[side]:
                lower = np.repeat(pairs, 2, axis=0)
                lower[:, side] = 2 * lower[:, side] + np.tile([0, 1], len(pairs))
                count = len(self._trees[side].levels[below[side]][0])
                pairs = lower[lower[:, side] < count]
        return below, pairs


def squared_gaps(
    low: FloatArray, high: FloatArray, low_b: FloatArray, high_b: FloatArray
) -> FloatArray:
    """Return the squared distances between boxes, given by corners of shape (…, 3)."""
    apart = np.maximum(np.maximum(low - high_b, low_b - high), 0.0)
    gaps: FloatArray = np.einsum("...j,...j->...", apart, apart)
    return gaps


def _morton_positions(points: FloatArray) -> IndexArray:
    """Return the positions of points along Morton's curve, close for points that are near."""
    low = points.min(axis=0)
    extent = float((points.max(axis=0) - low).max()) or 1.0
    cells = ((points - low) / extent * ((1 << _BITS) - 1)).astype(np.int64)
    place = np.zeros(len(points), np.int64)
    for axis in range(3):
        place |= _spread_bits(cells[:, axis]) << axis
    return place


def _spread_bits(numbers: IndexArray) -> IndexArray:
    """Return numbers of 21 bits with two zero bits inserted after each bit."""
    masks = (0x1F00000000FFFF, 0x1F0000FF0000FF, 0x100F00F00F00F00F, 0x10C30C30C30C30C3)
    spread = numbers
    for shift, mask in zip((32, 16, 8, 4), masks, strict=True):
        spread = (spread | (spread << shift)) & mask
    return (spread | (spread << 2)) & 0x1249249249249249
