"""Convex polygons as flat arrays, and their parts in a half-space."""

from dataclasses import dataclass

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from ..trees.fragments import ranges


@dataclass(frozen=True, eq=False)
class Polygons:
    """Convex polygons one after another.

    Parameters
    ----------
    corners : (n, d) float64
    offsets : (k + 1,) int64
        Polygon i owns ``corners[offsets[i]:offsets[i + 1]]``.
    marked : (n,) bool
        Marks of the edges from each corner to the next; edges added by clipping are unmarked.
    """

    corners: FloatArray
    offsets: IndexArray
    marked: BoolArray

    def take(self, indices: IndexArray) -> "Polygons":
        """Return the polygons with these indices, in this order."""
        starts, ends = self.offsets[:-1][indices], self.offsets[1:][indices]
        kept = ranges(starts, ends)
        offsets = np.concatenate([[0], np.cumsum(ends - starts)])
        return Polygons(self.corners[kept], offsets, self.marked[kept])


def following(offsets: IndexArray) -> IndexArray:
    """Return for each corner the index of the next one around its polygon."""
    after = np.arange(1, offsets[-1] + 1)
    filled = offsets[1:] > offsets[:-1]
    after[offsets[1:][filled] - 1] = offsets[:-1][filled]
    return after


def owners(offsets: IndexArray) -> IndexArray:
    """Return for each corner the index of its polygon."""
    return np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))


def clip(polygons: Polygons, normal: FloatArray, least: float) -> tuple[Polygons, IndexArray]:
    """Return the parts of polygons where normal·x is at least `least`, and their polygons.

    Clips all polygons at once by the method of Sutherland and Hodgman 1974, "Reentrant polygon
    clipping".
    """
    distance = polygons.corners @ normal - least
    inside = distance >= 0
    if inside.all():
        return polygons, np.arange(len(polygons.offsets) - 1)
    after = following(polygons.offsets)
    crossing = inside != inside[after]
    counts = inside.astype(np.int64) + crossing
    firsts = np.cumsum(counts) - counts
    corners = np.empty((int(counts.sum()), polygons.corners.shape[1]))
    marked = np.zeros(len(corners), dtype=bool)
    corners[firsts[inside]] = polygons.corners[inside]
    marked[firsts[inside]] = polygons.marked[inside]

    places = (firsts + inside)[crossing]
    corners[places] = _crossings(polygons.corners, distance, np.flatnonzero(crossing), after)
    # Where the boundary re-enters, the rest of the old edge follows.
    marked[places] = (polygons.marked & ~inside)[crossing]

    offsets = np.concatenate([[0], np.cumsum(counts)])[polygons.offsets]
    left = np.flatnonzero(np.diff(offsets) > 2)
    return Polygons(corners, offsets, marked).take(left), left


def _crossings(
    corners: FloatArray, distance: FloatArray, at: IndexArray, after: IndexArray
) -> FloatArray:
    start, end = distance[at], distance[after[at]]
    share = (start / (start - end))[:, None]
    found: FloatArray = corners[at] + share * (corners[after[at]] - corners[at])
    return found
