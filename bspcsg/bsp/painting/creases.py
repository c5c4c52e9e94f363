"""Neighbours of facets across edges, and the choice of edges to draw in a picture."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from ..trees.fragments import Fragments, concatenated_ranges
from .clip import next_corners, polygon_of_corner


@dataclass(frozen=True, eq=False)
class Facets:
    """Planar polygons in space that may share edges.

    Parameters
    ----------
    corners : (n, 3) float64
        The corners of all polygons, one after another, counterclockwise seen from outside (the plus
        side).
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
        return Facets(self.corners[concatenated_ranges(starts, ends)], offsets)

    @cached_property
    def firsts(self) -> FloatArray:
        """The first corner of each facet, (k, 3) float64."""
        firsts: FloatArray = self.corners[self.offsets[:-1]]
        return firsts

    @cached_property
    def normals(self) -> FloatArray:
        """The unit normal of each facet towards its plus side, (k, 3); zero without area."""
        if not len(self):
            return np.zeros((0, 3))
        after, owner = next_corners(self.offsets), polygon_of_corner(self.offsets)
        # Coordinates relative to a corner keep precision far from the origin.
        arms = self.corners - self.firsts[owner]
        areas = np.add.reduceat(np.cross(arms, arms[after]), self.offsets[:-1])
        lengths = np.linalg.norm(areas, axis=1, keepdims=True)
        normals: FloatArray = areas / np.where(lengths > 0, lengths, 1)
        return normals

    @cached_property
    def _keys(self) -> tuple[IndexArray, IndexArray]:
        """A number for each directed edge, and the number of the edge in opposite direction."""
        names = _names(self.corners)
        ends = names[next_corners(self.offsets)]
        count = len(self.corners) + 1
        return names * count + ends, ends * count + names

    @cached_property
    def neighbours(self) -> IndexArray:
        """The facet on the other side of each edge, (n,); -1 if there is none or more than one."""
        forth, back = self._keys
        order = np.argsort(forth, kind="stable")
        ordered = forth[order]
        found = np.searchsorted(ordered, back)
        opposites = np.searchsorted(ordered, back, side="right") - found
        equals = np.searchsorted(ordered, forth, side="right") - np.searchsorted(ordered, forth)
        single = (opposites == 1) & (equals == 1)
        partner = order[np.where(single, found, 0)] if len(order) else found
        return (
            np.where(single, polygon_of_corner(self.offsets)[partner], -1) if len(order) else found
        )

    @cached_property
    def is_closed(self) -> bool:
        """True if each edge has as many opposite as equal edges, and the volume is positive."""
        forth, back = self._keys
        if not len(forth) or not np.array_equal(np.sort(forth), np.sort(back)):
            return False
        return self._volume() > 0

    def _volume(self) -> float:
        after, owner = next_corners(self.offsets), polygon_of_corner(self.offsets)
        arms = self.corners - self.corners[0]
        cones = np.cross(arms, arms[after])
        return float(np.einsum("ij,ij->", arms[self.offsets[:-1]][owner], cones))

    def features(self, facing: BoolArray, crease: float) -> BoolArray:
        """Return which edges are feature edges, (n,) bool.

        These are edges without exactly one neighbour, edges whose facets' normals differ by more
        than `crease` degrees, and contours, where only one of the two facets faces the viewer.
        """
        owner, other = polygon_of_corner(self.offsets), self.neighbours
        cosines = np.einsum("ij,ij->i", self.normals[owner], self.normals[other])
        bent = cosines < np.cos(np.radians(crease))
        contour = facing[owner] != facing[other]
        # Facets without area have no normal to compare.
        wide: BoolArray = (self.normals != 0).any(axis=1)
        drawn: BoolArray = (other < 0) | ((bent | contour) & wide[owner] & wide[other])
        return drawn

    def drawn_edges(self, fragments: Fragments, drawn: BoolArray) -> BoolArray:
        """Return which edges of fragments lie on drawn edges of these facets, (m,) bool.

        Parameters
        ----------
        fragments : Fragments
            Parts of the facets; `source` has the facet of each.
        drawn : (n,) bool
            True for the edges of facets that are drawn.
        """
        if drawn.all():
            return fragments.original
        some = np.logical_or.reduceat(drawn, self.offsets[:-1]) if len(self) else drawn
        owner = fragments.source[polygon_of_corner(fragments.offsets)]
        asked = np.flatnonzero(fragments.original & some[owner])
        ends = fragments.vertices[next_corners(fragments.offsets)[asked]]
        middles = (fragments.vertices[asked] + ends) / 2
        result = np.zeros(len(fragments.vertices), dtype=bool)
        result[asked] = drawn[self._nearest_edges(middles, owner[asked])]
        return result

    def _nearest_edges(self, points: FloatArray, facets: IndexArray) -> IndexArray:
        """Return for each point the nearest edge of its facet, as the index of the first corner."""
        after = next_corners(self.offsets)
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
    """Return the squared distance of each point from its segment, (n,)."""
    along, arm = ends - starts, points - starts
    length = np.einsum("ij,ij->i", along, along)
    share = np.einsum("ij,ij->i", arm, along) / np.where(length > 0, length, 1)
    gap = arm - np.clip(share, 0, 1)[:, None] * along
    squares: FloatArray = np.einsum("ij,ij->i", gap, gap)
    return squares


def _names(corners: FloatArray) -> IndexArray:
    """Return an integer from 0 on for each point; two are equal exactly if the points are equal."""
    order = np.lexsort(corners.T)
    ordered = corners[order]
    new = np.ones(len(corners), dtype=bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    names = np.empty(len(corners), dtype=np.int64)
    names[order] = np.cumsum(new) - 1
    return names
