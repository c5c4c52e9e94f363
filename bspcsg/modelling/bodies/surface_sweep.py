"""The sweep of a convex tool along the surface of a solid, as one mesh.

The tool contains the origin. Where it touches the surface from outside, a corner of the tool
touches a face, an edge touches an edge, or a face touches a corner. So the swept volume outside
consists of prisms on faces, wedges along convex edges and pyramids at corners. Walls between two
pieces cancel, and so do the faces of the solid. The remaining mesh has as winding number at each
point the number of pieces that contain it, plus one inside the solid.
"""

from collections.abc import Iterator

import numpy as np

from ..._types import IndexArray
from ...errors import LimitError
from .polyhedra import Mask, Polyhedron, blocks, positive_pair_products, positive_products

#: The largest number of triangles of all swept pieces together. Each takes 24 bytes, and several
#: times as much while opposite ones cancel: up to 2 GB in all.
_MAX_PIECE_FACES = 10_000_000

#: The origin, where the number of a tool's corner is expected.
_ORIGIN = -1


class _Sums:
    """The numbering of all sums p + q: p is a corner of a solid, q a corner of a tool or 0."""

    def __init__(self, solid: Polyhedron, tool: Polyhedron) -> None:
        self._points = solid.points
        self._ends = np.concatenate([tool.points, np.zeros((1, 3), np.int64)])

    def of(self, corners: IndexArray, ends: IndexArray | int) -> IndexArray:
        """Return the numbers of the sums corners[k] + ends[k], given the corners' numbers."""
        numbers: IndexArray = corners * len(self._ends) + ends % len(self._ends)
        return numbers

    def points(self, numbers: IndexArray) -> IndexArray:
        """Return the positions of sums, (n, 3) in lattice steps, given their numbers."""
        corners, ends = np.divmod(numbers, len(self._ends))
        points: IndexArray = self._points[corners] + self._ends[ends]
        return points


def swept_mesh(solid: Polyhedron, tool: Polyhedron) -> tuple[IndexArray, IndexArray]:
    """Return points and faces of a mesh whose winding number is positive inside a Minkowski sum.

    Parameters
    ----------
    solid : Polyhedron
    tool : Polyhedron
        A convex polyhedron that contains the origin.

    Raises
    ------
    LimitError
        If the swept pieces have more than 10 million triangles.
    """
    sums = _Sums(solid, tool)
    tops = _tops_over_faces(solid, tool)
    parts = [sums.of(solid.faces, tops[:, None])]
    count = 0
    for triangles in _pieces(solid, tool, tops, sums):
        parts.append(triangles)
        count += len(triangles)
        if count > _MAX_PIECE_FACES:
            message = (
                f"the part of a solid of {len(solid.faces):,} faces that a tool of"
                f" {len(tool.faces):,} faces touches has more than {_MAX_PIECE_FACES:,} faces,"
                " the largest number allowed; choose solids with fewer faces."
            )
            raise LimitError(message, "too_large")
    left = _cancelled(np.concatenate(parts))
    numbers, faces = np.unique(left, return_inverse=True)
    return sums.points(numbers), faces.reshape(-1, 3)


def _pieces(
    solid: Polyhedron, tool: Polyhedron, tops: IndexArray, sums: _Sums
) -> Iterator[IndexArray]:
    yield from _walls_of_faces(solid, tops, sums)
    for edges, start, end in _steps_around(solid, tool):
        yield from _wedges(solid, edges, start, end, sums)
    for corners, faces in _facing_corners(solid, tool):
        yield from _pyramids(corners, tool.faces[faces], sums)


def _tops_over_faces(solid: Polyhedron, tool: Polyhedron) -> IndexArray:
    """Return, for each face of a solid, the tool's corner that is farthest along the normal."""
    normals, along = solid.normals.distinct, tool.along
    found = np.empty(len(normals.units), np.int64)
    for block in blocks(len(found), 2 * len(along.rows)):
        rises = positive_products(normals.at(block), along.distinct)[:, along.rows]
        corner, row = tool.tops(rises.T)
        found[block][row] = corner
    return found[solid.normals.rows]


def _walls_of_faces(solid: Polyhedron, tops: IndexArray, sums: _Sums) -> Iterator[IndexArray]:
    """Yield the side walls of the prisms on the solid's faces; along flat edges they cancel."""
    start, end = (part[solid.sharp] for part in solid.ends)
    left, right = (side[solid.sharp] for side in solid.adjacent_faces)
    yield from _wall(start, end, tops[left], sums)
    yield from _wall(end, start, tops[right], sums)


def _steps_around(
    solid: Polyhedron, tool: Polyhedron
) -> Iterator[tuple[IndexArray, IndexArray, IndexArray]]:
    """Yield pairs of a convex edge of the solid and an edge of the tool that touches it.

    Let a plane turn around the solid's edge, from one adjacent face to the other. The tool's corner
    farthest along the normal then passes along edges of the tool. Each such tool edge is given by
    its start and its end corner.
    """
    steps = tool.sharp
    for block in blocks(len(solid.convex), 4 * len(steps)):
        edges = solid.convex[block]
        before, after = (_along_tool(solid, side[edges], tool) for side in solid.adjacent_faces)
        row, column = np.nonzero(before != after)
        edge, step = edges[row], steps[column]
        is_forth = after[row, column]
        left, right = (
            positive_pair_products(solid.along.at(edge), tool.normals.at(side[step]))
            for side in tool.adjacent_faces
        )
        touch = (left != right) & (left == is_forth)
        start, end = (part[step] for part in tool.ends)
        start, end = np.where(is_forth, start, end), np.where(is_forth, end, start)
        yield edge[touch], start[touch], end[touch]


def _along_tool(solid: Polyhedron, faces: IndexArray, tool: Polyhedron) -> Mask:
    """Return an (m, n) mask: whether sharp edge n of the tool rises along the normal of face m."""
    normals, row = np.unique(solid.normals.rows[faces], return_inverse=True)
    edges, column = np.unique(tool.along.rows[tool.sharp], return_inverse=True)
    return positive_products(solid.normals.distinct.at(normals), tool.along.distinct.at(edges))[
        row
    ][:, column]


def _facing_corners(solid: Polyhedron, tool: Polyhedron) -> Iterator[tuple[IndexArray, IndexArray]]:
    """Yield pairs of a corner of the solid and a face of the tool that touches it from outside."""
    is_convex = np.zeros(len(solid.points), bool)
    for ends in solid.ends:
        is_convex[ends[solid.convex]] = True
    for block in blocks(len(tool.faces), 4 * len(solid.along.rows)):
        normals, column = np.unique(tool.normals.rows[block], return_inverse=True)
        rises = positive_products(solid.along.distinct, tool.normals.distinct.at(normals))[
            solid.along.rows
        ]
        corner, face = solid.tops(rises[:, column])
        yield corner[is_convex[corner]], block.start + face[is_convex[corner]]


def _wedges(
    solid: Polyhedron, edges: IndexArray, start: IndexArray, end: IndexArray, sums: _Sums
) -> Iterator[IndexArray]:
    """Yield the faces of wedges: each is an edge of the solid plus a triangle.

    The triangle joins the origin to the tool's edge from corner `start` to corner `end`.
    """
    p, q = (part[edges] for part in solid.ends)
    yield _triangles(sums.of(p, start), sums.of(p, end), sums.of(q, end))
    yield _triangles(sums.of(p, start), sums.of(q, end), sums.of(q, start))
    yield _triangles(sums.of(p, _ORIGIN), sums.of(p, end), sums.of(p, start))
    yield _triangles(sums.of(q, _ORIGIN), sums.of(q, start), sums.of(q, end))
    yield from _wall(q, p, start, sums)
    yield from _wall(p, q, end, sums)


def _pyramids(corners: IndexArray, bases: IndexArray, sums: _Sums) -> Iterator[IndexArray]:
    """Yield the faces of pyramids: a corner of the solid, and a face of the tool shifted by it."""
    yield sums.of(corners[:, None], bases)
    origins = sums.of(corners, _ORIGIN)
    for k in range(3):
        yield _triangles(origins, sums.of(corners, bases[:, k]), sums.of(corners, bases[:, k - 1]))


def _wall(p: IndexArray, q: IndexArray, top: IndexArray, sums: _Sums) -> Iterator[IndexArray]:
    """Yield the two triangles that each edge p q sweeps while it moves to a tool's corner `top`.

    The diagonal does not depend on the order of p and q, so that opposite walls cancel.
    """
    low, high = np.minimum(p, q), np.maximum(p, q)
    start, end = sums.of(low, _ORIGIN), sums.of(high, top)
    for faces in (
        _triangles(start, sums.of(high, _ORIGIN), end),
        _triangles(start, end, sums.of(low, top)),
    ):
        yield np.where((p < q)[:, None], faces, faces[:, [0, 2, 1]])


def _triangles(*corners: IndexArray) -> IndexArray:
    return np.stack(corners, axis=1)


def _cancelled(triangles: IndexArray) -> IndexArray:
    """Return the triangles that remain after pairs of opposite triangles cancel."""
    a, b, c = triangles.T
    turn = np.where((a > b) ^ (b > c) ^ (a > c), -1, 1)
    rows = np.sort(triangles, axis=1)
    order = np.lexsort(rows.T)
    rows = rows[order]
    first = np.flatnonzero(np.r_[True, (rows[1:] != rows[:-1]).any(axis=1)])
    turns = np.add.reduceat(turn[order], first)
    left = np.repeat(rows[first], np.abs(turns), axis=0)
    is_turned = np.repeat(turns < 0, np.abs(turns))
    return np.where(is_turned[:, None], left[:, ::-1], left)
