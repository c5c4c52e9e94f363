"""Closed chains of edges that are blended by one tool, such as the rim of a bore.

If two consecutive edges are mirror images, their blends have the same section in the plane that
bisects their angle. So the tool along a chain is one mesh through the sections at its corners.
"""

from collections.abc import Callable, Set
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from ..._types import FloatArray, IndexArray
from ...geometry.transform import whole_steps
from ...solid.solid import Solid
from .plane_faces import FaceGraph
from .rings import solid_of, walls

#: Consecutive edges, as pairs of an edge number and the vertex where the edge ends.
Chain: TypeAlias = list[tuple[int, int]]

#: The least sine of the angle between an edge and the plane that bisects its angle with the next
#: edge, and of the angle between a face and the blend at its border.
_FLATTEST = 1e-3

#: Lattice steps by which a tool extends past a face if rounding may move its corners off the face.
_EXTENSION_STEPS = 20


def closed_chains(graph: FaceGraph, chosen: Set[int]) -> list[Chain]:
    """Return closed loops of chosen edges, at whose corners exactly three edges meet.

    In a loop, all edges are convex or all are concave.
    """
    chains, seen = [], set[int]()
    for first in sorted(chosen):
        if first not in seen:
            chain, is_closed = _walked(graph, chosen, first)
            seen.update(edge for edge, _ in chain)
            if is_closed and len(chain) > 2:
                chains.append(chain)
    return chains


def _walked(graph: FaceGraph, chosen: Set[int], first: int) -> tuple[Chain, bool]:
    """Return the chain of chosen edges that begins with `first`, and whether it is closed.

    It ends where no chosen edge or more than one follows, or where convex and concave edges meet.
    """
    edge, end = first, int(graph.ends[first, 1])
    chain = [(edge, end)]
    while True:
        others = [other for other in graph.edges_at(end) if other != edge]
        after = [other for other in others if other in chosen]
        if len(others) != 2 or len(after) != 1:
            return chain, False
        if graph.is_convex[after[0]] != graph.is_convex[edge]:
            return chain, False
        edge = after[0]
        end = int(graph.ends[edge].sum()) - end
        if edge == first:
            return chain, True
        chain.append((edge, end))


@dataclass(frozen=True, eq=False)
class ChainTools:
    """Maker of the solids to remove or add along closed chains of edges.

    Parameters
    ----------
    graph : FaceGraph
    section : function
        Returns the section of an edge's blend from the left to the right face, (k, 3), relative to
        a point of the edge.
    near : float
        The largest distance between the sections of two edges in their bisecting plane.
    pitch : int
        The pitch of the result.
    """

    graph: FaceGraph
    section: Callable[[int], FloatArray]
    near: float
    pitch: int

    def tool(self, chain: Chain) -> Solid | None:
        """Return the tool for a chain; None if two consecutive edges are not mirror images."""
        rings = []
        for (edge, vertex), (after, _) in zip(chain, chain[1:] + chain[:1], strict=True):
            ring = self._ring(edge, after, vertex)
            if ring is None:
                return None
            whole = self._whole_ring(edge, after, vertex, ring)
            if whole is None:
                return None
            rings.append(whole)
        return _through(np.round(rings, -self.pitch) if self.pitch < 0 else np.array(rings))

    def _ring(self, edge: int, after: int, vertex: int) -> FloatArray | None:
        """Return the section, (k, 3), that the blends of two edges share in their bisecting plane.

        None means that the two sections differ, or that an edge is nearly parallel to the plane.
        """
        (third,) = set(self.graph.edges_at(vertex)) - {edge, after}
        axis = self.graph.directions[third]
        along = np.array([self._along(edge, vertex, -1), self._along(after, vertex, 1)])
        across = along - np.outer(along @ axis, axis)
        sizes = np.linalg.norm(across, axis=1)
        if sizes.min() < _FLATTEST:
            return None
        across /= sizes[:, None]
        normal = across[0] + across[1]
        leans = along @ normal
        if np.abs(leans).min() < _FLATTEST:
            return None
        rings = []
        for one, direction, lean in zip((edge, after), along, leans, strict=True):
            corners = self.section(one)
            # If an edge runs against the chain, exchange its left and right.
            if direction @ self.graph.directions[one] < 0:
                corners = corners[::-1]
            rings.append(corners - np.outer(corners @ normal / lean, direction))
        if np.abs(rings[0] - rings[1]).max() > self.near:
            return None
        return np.asarray(self.graph.vertices[vertex] + rings[0])

    def _along(self, edge: int, vertex: int, sign: int) -> FloatArray:
        """Return an edge's unit vector, away from a vertex if sign is 1, towards it if -1."""
        is_start = self.graph.ends[edge, 0] == vertex
        direction: FloatArray = self.graph.directions[edge]
        return direction * (sign if is_start else -sign)

    def _whole_ring(
        self, edge: int, after: int, vertex: int, ring: FloatArray
    ) -> FloatArray | None:
        """Return a section closed by a corner near the edges' common vertex.

        If rounding may move its ends off their faces, the section extends past the faces, so that
        no thin skin remains. None means that it would extend far, as the blend is nearly tangent.
        """
        sides = np.array(
            [
                self._left_and_right_faces(edge, vertex, -1),
                self._left_and_right_faces(after, vertex, 1),
            ]
        )
        ends = []
        for side, corner, inner in ((0, ring[0], ring[1]), (1, ring[-1], ring[-2])):
            normals, steps = self._outward(edge, after, vertex, sides[:, side], corner)
            chord = corner - inner
            unit = chord / max(float(np.linalg.norm(chord)), self.near)
            rises = (normals @ unit)[steps > 0]
            if rises.min(initial=1) < _FLATTEST:
                return None
            ends.append((corner + unit * float(steps.max() / rises.min(initial=1)), normals, steps))
        normals, steps = (np.concatenate([end[k] for end in ends]) for k in (1, 2))
        tip = self.graph.vertices[vertex] + np.linalg.lstsq(normals, steps, rcond=None)[0]
        return np.array([tip, ends[0][0], *ring[1:-1], ends[1][0]])

    def _left_and_right_faces(self, edge: int, vertex: int, sign: int) -> IndexArray:
        """Return the faces on the left and the right of an edge, in the chain's direction."""
        sides: IndexArray = self.graph.sides[edge]
        is_forth = self._along(edge, vertex, sign) @ self.graph.directions[edge] > 0
        return sides if is_forth else sides[::-1]

    def _outward(
        self, edge: int, after: int, vertex: int, faces: IndexArray, corner: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return outward normals of two faces, and how far the tool must extend past each.

        The distance is 0 if `corner` is exactly on both faces.
        """
        normals = self.graph.normals[faces]
        if faces[0] == faces[1]:
            is_exact = self._is_level(faces[0], vertex)
        else:
            (third,) = set(self.graph.edges_at(vertex)) - {edge, after}
            is_exact = self._is_on(third, corner)
        beyond = 0.0 if is_exact else _EXTENSION_STEPS * 10.0**self.pitch
        return normals * (1 if self.graph.is_convex[edge] else -1), np.full(2, beyond)

    def _is_level(self, face: int, vertex: int) -> bool:
        """Return True if a face is perpendicular to an axis and lies at a lattice coordinate."""
        axis = int(np.abs(self.graph.normals[face]).argmax())
        height = float(self.graph.vertices[vertex, axis])
        is_square = bool(np.abs(self.graph.normals[face, axis]) == 1)
        return is_square and whole_steps(height, self.pitch) is not None

    def _is_on(self, edge: int, corner: FloatArray) -> bool:
        """Return True if a corner, snapped to the lattice, lies exactly on an edge's line.

        Both ends of the edge must be lattice points.
        """
        ends = self.graph.vertices[self.graph.ends[edge]]
        snapped = np.round(corner, -self.pitch) if self.pitch < 0 else corner
        rows = [*ends.tolist(), snapped.tolist()]
        steps = [[whole_steps(value, self.pitch) for value in row] for row in rows]
        known = [[step for step in row if step is not None] for row in steps]
        if min(map(len, known)) < 3:
            return False
        first, *others = known
        (a, b, c), (x, y, z) = ([p - q for p, q in zip(row, first, strict=True)] for row in others)
        return a * y == b * x and b * z == c * y and a * z == c * x


def _through(rings: FloatArray) -> Solid:
    """Return the solid through consecutive polygons in space, the last one joined to the first."""
    closed = np.concatenate([rings, rings[:1]])
    count = rings.shape[1]
    around = np.column_stack([np.arange(count), np.roll(np.arange(count), -1)])
    triangles = walls(closed, around) % (len(rings) * count)
    points = rings.reshape(-1, 3)
    a, b, c = (points[triangles[:, k]] - points[0] for k in range(3))
    if np.einsum("ij,ij->", np.cross(a, b), c) < 0:
        triangles = triangles[:, ::-1]
    return solid_of(points, triangles)
