"""Neighbours of facets, and the choice of edges for a picture."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from ..trees.fragments import Fragments, ranges
from .clip import following, owners


@dataclass(frozen=True, eq=False)
class Facets:
    """Planar polygons that may share edges.

    Parameters
    ----------
    corners : (n, 3) float64
        One polygon after another, counterclockwise seen from outside (the plus side).
    offsets : (k + 1,) int64
        Facet i owns ``corners[offsets[i]:offsets[i + 1]]``.
    """

    corners: FloatArray
    offsets: IndexArray

    def __len__(self) -> int:
        """Return the number of facets."""
        return len(self.offsets) - 1

    def take(self, indices: IndexArray) -> "Facets":
        """Return the facets with these indices, in this order."""
        starts, ends = self.offsets[:-1][indices], self.offsets[1:][indices]
        offsets = np.concatenate([[0], np.cumsum(ends - starts)])
        return Facets(self.corners[ranges(starts, ends)], offsets)

    @cached_property
    def firsts(self) -> FloatArray:
        """The first corner of each facet, (k, 3)."""
        firsts: FloatArray = self.corners[self.offsets[:-1]]
        return firsts

    @cached_property
    def normals(self) -> FloatArray:
        """Unit normals (k, 3) towards the plus side."""
        if not len(self):
            return np.zeros((0, 3))
        after, owner = following(self.offsets), owners(self.offsets)
        # Coordinates relative to a corner keep precision far from the origin.
        arms = self.corners - self.firsts[owner]
        areas = np.add.reduceat(np.cross(arms, arms[after]), self.offsets[:-1])
        lengths = np.linalg.norm(areas, axis=1, keepdims=True)
        normals: FloatArray = areas / np.where(lengths > 0, lengths, 1)
        return normals

    @cached_property
    def _keys(self) -> tuple[IndexArray, IndexArray]:
        """Numbers of the directed edges, and of their opposites."""
        names = _names(self.corners)
        ends = names[following(self.offsets)]
        count = len(self.corners) + 1
        return names * count + ends, ends * count + names

    @cached_property
    def neighbours(self) -> IndexArray:
        """For the edge from each corner, the facet on its other side, (n,); -1 if not just one."""
        forth, back = self._keys
        order = np.argsort(forth, kind="stable")
        ordered = forth[order]
        found = np.searchsorted(ordered, back)
        opposites = np.searchsorted(ordered, back, side="right") - found
        equals = np.searchsorted(ordered, forth, side="right") - np.searchsorted(ordered, forth)
        single = (opposites == 1) & (equals == 1)
        partner = order[np.where(single, found, 0)] if len(order) else found
        return np.where(single, owners(self.offsets)[partner], -1) if len(order) else found

    @cached_property
    def is_closed(self) -> bool:
        """True if the facets enclose a positive volume: every edge has equally many opposites."""
        forth, back = self._keys
        if not len(forth) or not np.array_equal(np.sort(forth), np.sort(back)):
            return False
        return self._volume() > 0

    def _volume(self) -> float:
        after, owner = following(self.offsets), owners(self.offsets)
        arms = self.corners - self.corners[0]
        cones = np.cross(arms, arms[after])
        return float(np.einsum("ij,ij->", arms[self.offsets[:-1]][owner], cones))

    def features(self, facing: BoolArray, crease: float) -> BoolArray:
        """Return the feature edges, (n,) bool.

        Those without exactly one neighbour, those where the angle between the normals is above
        `crease` degrees, and the contour, where a facet that faces the viewer meets one that does
        not.
        """
        owner, other = owners(self.offsets), self.neighbours
        cosines = np.einsum("ij,ij->i", self.normals[owner], self.normals[other])
        bent = cosines < np.cos(np.radians(crease))
        contour = facing[owner] != facing[other]
        # Facets without area have no direction to compare.
        wide: BoolArray = (self.normals != 0).any(axis=1)
        drawn: BoolArray = (other < 0) | ((bent | contour) & wide[owner] & wide[other])
        return drawn

    def drawn_edges(self, fragments: Fragments, drawn: BoolArray) -> BoolArray:
        """Return which edges of fragments lie on drawn edges of these facets.

        Parameters
        ----------
        fragments : Fragments
            Parts of the facets, `source` naming them.
        drawn : (n,) bool
            Edges of the facets.
        """
        if drawn.all():
            return fragments.original
        some = np.logical_or.reduceat(drawn, self.offsets[:-1]) if len(self) else drawn
        owner = fragments.source[owners(fragments.offsets)]
        asked = np.flatnonzero(fragments.original & some[owner])
        ends = fragments.vertices[following(fragments.offsets)[asked]]
        middles = (fragments.vertices[asked] + ends) / 2
        result = np.zeros(len(fragments.vertices), dtype=bool)
        result[asked] = drawn[self._nearest_edges(middles, owner[asked])]
        return result

    def _nearest_edges(self, points: FloatArray, facets: IndexArray) -> IndexArray:
        """Return the edge of the given facet nearest to each point, by its first corner."""
        after = following(self.offsets)
        starts, counts = self.offsets[:-1][facets], np.diff(self.offsets)[facets]
        best, least = starts.copy(), np.full(len(points), np.inf)
        for step in range(int(counts.max()) if len(counts) else 0):
            rows = np.flatnonzero(counts > step)
            edges = starts[rows] + step
            found = _distances(points[rows], self.corners[edges], self.corners[after[edges]])
            nearer = found < least[rows]
            best[rows[nearer]], least[rows[nearer]] = edges[nearer], found[nearer]
        return best


def _distances(points: FloatArray, starts: FloatArray, ends: FloatArray) -> FloatArray:
    """Return the squared distances of points from segments."""
    along, arm = ends - starts, points - starts
    length = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", arm, along) / np.where(length > 0, length, 1)
    gap = arm - np.clip(share, 0, 1)[:, None] * along
    squares: FloatArray = np.einsum("ij,ij->i", gap, gap)
    return squares


def _names(corners: FloatArray) -> IndexArray:
    """Return numbers from 0 on, equal just for equal points."""
    order = np.lexsort(corners.T)
    ordered = corners[order]
    new = np.ones(len(corners), dtype=bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    names = np.empty(len(corners), dtype=np.int64)
    names[order] = np.cumsum(new) - 1
    return names
