"""Convex polygons as flat arrays, and clipping them with half-spaces."""

from dataclasses import dataclass

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from ..trees.fragments import concatenated_ranges


@dataclass(frozen=True, eq=False)
class Polygons:
    """Convex polygons of any dimension d, stored in flat arrays, with marks on edges.

    Parameters
    ----------
    corners : (n, d) float64
    offsets : (k + 1,) int64
        Polygon i owns ``corners[offsets[i]:offsets[i + 1]]``.
    marked : (n,) bool
        True if the edge from this corner to the next is marked; clipping adds unmarked edges.
    """

    corners: FloatArray
    offsets: IndexArray
    marked: BoolArray

    def take(self, indices: IndexArray) -> "Polygons":
        """Return the polygons with these indices, in this order."""
        starts, ends = self.offsets[:-1][indices], self.offsets[1:][indices]
        kept = concatenated_ranges(starts, ends)
        offsets = np.concatenate([[0], np.cumsum(ends - starts)])
        return Polygons(self.corners[kept], offsets, self.marked[kept])


def next_corners(offsets: IndexArray) -> IndexArray:
    """Return for each corner of polygons the index of the next corner around its polygon, (n,)."""
    after = np.arange(1, offsets[-1] + 1)
    filled = offsets[1:] > offsets[:-1]
    after[offsets[1:][filled] - 1] = offsets[:-1][filled]
    return after


def polygon_of_corner(offsets: IndexArray) -> IndexArray:
    """Return for each corner of polygons the index of its polygon, (n,)."""
    return np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))


def clip(polygons: Polygons, normal: FloatArray, least: float) -> tuple[Polygons, IndexArray]:
    """Return the parts of polygons with normal·x ≥ `least`, and the original index of each part.

    The method is that of Sutherland and Hodgman 1974, "Reentrant polygon clipping", for all
    polygons at once.
    """
    distance = polygons.corners @ normal - least
    inside = distance >= 0
    if inside.all():
        return polygons, np.arange(len(polygons.offsets) - 1)
    after = next_corners(polygons.offsets)
    crossing = inside != inside[after]
    counts = inside.astype(np.int64) + crossing
    firsts = np.cumsum(counts) - counts
    corners = np.empty((int(counts.sum()), polygons.corners.shape[1]))
    marked = np.zeros(len(corners), dtype=bool)
    corners[firsts[inside]] = polygons.corners[inside]
    marked[firsts[inside]] = polygons.marked[inside]

    places = (firsts + inside)[crossing]
    corners[places] = _crossings(polygons.corners, distance, np.flatnonzero(crossing), after)
    # An edge that enters the half-space continues as a part of the old edge, with its mark.
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
