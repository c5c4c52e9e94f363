"""Closed chains of edges that are blended as one, such as the rim of a bore.

Two edges of a corner that are mirror images meet in the bisecting plane, where their sections form
one ring. So the tool along a whole chain is one mesh through such rings.
"""

from collections.abc import Callable, Set
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from ..._types import FloatArray, IndexArray
from ...geometry.transform import whole_steps
from ...solid.solid import Solid
from .rings import solid_of, walls
from .skeleton import Skeleton

#: The edges of a chain in its order, each with the vertex at its end.
Chain: TypeAlias = list[tuple[int, int]]

#: The least sine between an edge and the plane between it and the next one, and between a face and
#: the new surface where that begins.
_FLATTEST = 1e-3

#: Lattice steps by which a mesh reaches beyond faces that its corners may miss by one.
_BEYOND = 20


def closed_chains(skeleton: Skeleton, chosen: Set[int]) -> list[Chain]:
    """Return the loops of edges of one kind that meet in pairs at corners of three edges."""
    chains, seen = [], set[int]()
    for first in sorted(chosen):
        if first not in seen:
            chain, is_closed = _walked(skeleton, chosen, first)
            seen.update(edge for edge, _ in chain)
            if is_closed and len(chain) > 2:
                chains.append(chain)
    return chains


def _walked(skeleton: Skeleton, chosen: Set[int], first: int) -> tuple[Chain, bool]:
    """Return the edges from one on, until no edge or more than one follows."""
    edge, end = first, int(skeleton.ends[first, 1])
    chain = [(edge, end)]
    while True:
        others = [other for other in skeleton.edges_at(end) if other != edge]
        after = [other for other in others if other in chosen]
        if len(others) != 2 or len(after) != 1:
            return chain, False
        if skeleton.is_convex[after[0]] != skeleton.is_convex[edge]:
            return chain, False
        edge = after[0]
        end = int(skeleton.ends[edge].sum()) - end
        if edge == first:
            return chain, True
        chain.append((edge, end))


@dataclass(frozen=True, eq=False)
class ChainTools:
    """Tools along closed chains, to be removed or added.

    Parameters
    ----------
    skeleton : Skeleton
    section : function
        Returns, for an edge, the corners of the new surface across it from the left face to the
        right one, (k, 3), seen from a point of the edge.
    near : float
        The largest difference of the sections of two edges in their bisecting plane.
    pitch : int
        The pitch of the result.
    """

    skeleton: Skeleton
    section: Callable[[int], FloatArray]
    near: float
    pitch: int

    def tool(self, chain: Chain) -> Solid | None:
        """Return the tool for a chain; None if neighbouring edges are no mirror images."""
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
        """Return the common section of two edges in their bisecting plane, if they agree."""
        (third,) = set(self.skeleton.edges_at(vertex)) - {edge, after}
        axis = self.skeleton.directions[third]
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
            # If an edge runs against the chain, its left is the chain's right.
            if direction @ self.skeleton.directions[one] < 0:
                corners = corners[::-1]
            rings.append(corners - np.outer(corners @ normal / lean, direction))
        if np.abs(rings[0] - rings[1]).max() > self.near:
            return None
        return np.asarray(self.skeleton.vertices[vertex] + rings[0])

    def _along(self, edge: int, vertex: int, sign: int) -> FloatArray:
        """Return the direction of an edge along the chain: away from a vertex, or towards it."""
        is_start = self.skeleton.ends[edge, 0] == vertex
        direction: FloatArray = self.skeleton.directions[edge]
        return direction * (sign if is_start else -sign)

    def _whole_ring(
        self, edge: int, after: int, vertex: int, ring: FloatArray
    ) -> FloatArray | None:
        """Return a ring with a corner at the edge, and both ends slightly beyond their faces.

        Where corners may miss faces by a lattice step, the mesh reaches beyond the faces, so that
        no thin skin is left. Return None if it would reach far.
        """
        sides = np.array([self._sides(edge, vertex, -1), self._sides(after, vertex, 1)])
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
        tip = self.skeleton.vertices[vertex] + np.linalg.lstsq(normals, steps, rcond=None)[0]
        return np.array([tip, ends[0][0], *ring[1:-1], ends[1][0]])

    def _sides(self, edge: int, vertex: int, sign: int) -> IndexArray:
        """Return the faces on the left and on the right of an edge along the chain."""
        sides: IndexArray = self.skeleton.sides[edge]
        is_forth = self._along(edge, vertex, sign) @ self.skeleton.directions[edge] > 0
        return sides if is_forth else sides[::-1]

    def _outward(
        self, edge: int, after: int, vertex: int, faces: IndexArray, corner: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return normals away from the material, and the reach beyond each of two faces."""
        normals = self.skeleton.normals[faces]
        if faces[0] == faces[1]:
            is_exact = self._is_level(faces[0], vertex)
        else:
            (third,) = set(self.skeleton.edges_at(vertex)) - {edge, after}
            is_exact = self._is_on(third, corner)
        beyond = 0.0 if is_exact else _BEYOND * 10.0**self.pitch
        return normals * (1 if self.skeleton.is_convex[edge] else -1), np.full(2, beyond)

    def _is_level(self, face: int, vertex: int) -> bool:
        """Say whether a face is perpendicular to an axis, at a lattice coordinate."""
        axis = int(np.abs(self.skeleton.normals[face]).argmax())
        height = float(self.skeleton.vertices[vertex, axis])
        is_square = bool(np.abs(self.skeleton.normals[face, axis]) == 1)
        return is_square and whole_steps(height, self.pitch) is not None

    def _is_on(self, edge: int, corner: FloatArray) -> bool:
        """Say whether a snapped corner lies exactly on an edge between two lattice points."""
        ends = self.skeleton.vertices[self.skeleton.ends[edge]]
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
    """Return the solid of the closed mesh through rings, the last joined to the first."""
    closed = np.concatenate([rings, rings[:1]])
    count = rings.shape[1]
    around = np.column_stack([np.arange(count), np.roll(np.arange(count), -1)])
    triangles = walls(closed, around) % (len(rings) * count)
    points = rings.reshape(-1, 3)
    a, b, c = (points[triangles[:, k]] - points[0] for k in range(3))
    if np.einsum("ij,ij->", np.cross(a, b), c) < 0:
        triangles = triangles[:, ::-1]
    return solid_of(points, triangles)
