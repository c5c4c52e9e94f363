"""The sweep of a convex tool along the surface of a solid, as one mesh.

Let the tool grow from the origin. Where it first touches the surface, a corner of the tool touches
a face, an edge touches an edge, or a face touches a corner. So the body swept outside consists of
prisms on faces, wedges along convex edges and pyramids at corners. Walls between two pieces cancel,
and so do the faces of the solid. The remaining mesh winds around each point once for each piece
that contains it, and once more inside the solid.
"""

from collections.abc import Iterator

import numpy as np

from ..._types import IndexArray
from ...errors import LimitError
from .polyhedra import Marks, Polyhedron, blocks, rising, rising_in_pairs

#: The largest number of faces of pieces in memory. Each takes 24 bytes, and several times as many
#: while faces cancel each other: 2 GB in all.
_MAX_PIECE_FACES = 10_000_000

#: In place of a corner of the tool.
_ORIGIN = -1


class _Sums:
    """Numbering of the sums of a corner of a solid and a corner of a tool or the origin."""

    def __init__(self, solid: Polyhedron, tool: Polyhedron) -> None:
        self._points = solid.points
        self._ends = np.concatenate([tool.points, np.zeros((1, 3), np.int64)])

    def of(self, corners: IndexArray, ends: IndexArray | int) -> IndexArray:
        """Return the numbers of sums."""
        numbers: IndexArray = corners * len(self._ends) + ends % len(self._ends)
        return numbers

    def points(self, numbers: IndexArray) -> IndexArray:
        """Return the positions of sums."""
        corners, ends = np.divmod(numbers, len(self._ends))
        points: IndexArray = self._points[corners] + self._ends[ends]
        return points


def swept_mesh(solid: Polyhedron, tool: Polyhedron) -> tuple[IndexArray, IndexArray]:
    """Return the corners and faces of a mesh that winds around the sum of a solid and a tool.

    Parameters
    ----------
    solid : Polyhedron
    tool : Polyhedron
        Convex; it contains the origin.

    Raises
    ------
    LimitError
        If the mesh would be too large.
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
    """Return for each face the corner of the tool that is farthest along its normal."""
    normals, along = solid.normals.each, tool.along
    found = np.empty(len(normals.units), np.int64)
    for block in blocks(len(found), 2 * len(along.of)):
        rises = rising(normals.at(block), along.each)[:, along.of]
        corner, row = tool.tops(rises.T)
        found[block][row] = corner
    return found[solid.normals.of]


def _walls_of_faces(solid: Polyhedron, tops: IndexArray, sums: _Sums) -> Iterator[IndexArray]:
    """Yield the walls of the prism on each face, except those along flat edges, which cancel."""
    start, end = (part[solid.sharp] for part in solid.ends)
    left, right = (side[solid.sharp] for side in solid.beside)
    yield from _wall(start, end, tops[left], sums)
    yield from _wall(end, start, tops[right], sums)


def _steps_around(
    solid: Polyhedron, tool: Polyhedron
) -> Iterator[tuple[IndexArray, IndexArray, IndexArray]]:
    """Yield the convex edges of the solid, each with the edges of the tool that touch it.

    A plane that turns around an edge, from one face to the other, touches the tool at one corner
    after another. Each step leads along an edge of the tool, from its start to its end.
    """
    steps = tool.sharp
    for block in blocks(len(solid.convex), 4 * len(steps)):
        edges = solid.convex[block]
        before, after = (_along_tool(solid, side[edges], tool) for side in solid.beside)
        row, column = np.nonzero(before != after)
        edge, step = edges[row], steps[column]
        is_forth = after[row, column]
        left, right = (
            rising_in_pairs(solid.along.at(edge), tool.normals.at(side[step]))
            for side in tool.beside
        )
        touch = (left != right) & (left == is_forth)
        start, end = (part[step] for part in tool.ends)
        start, end = np.where(is_forth, start, end), np.where(is_forth, end, start)
        yield edge[touch], start[touch], end[touch]


def _along_tool(solid: Polyhedron, faces: IndexArray, tool: Polyhedron) -> Marks:
    """Return for each face of the solid which sharp edges of the tool rise along the normal."""
    normals, row = np.unique(solid.normals.of[faces], return_inverse=True)
    edges, column = np.unique(tool.along.of[tool.sharp], return_inverse=True)
    return rising(solid.normals.each.at(normals), tool.along.each.at(edges))[row][:, column]


def _facing_corners(solid: Polyhedron, tool: Polyhedron) -> Iterator[tuple[IndexArray, IndexArray]]:
    """Yield corners of the solid and faces of the tool that touch them from outside."""
    is_convex = np.zeros(len(solid.points), bool)
    for ends in solid.ends:
        is_convex[ends[solid.convex]] = True
    for block in blocks(len(tool.faces), 4 * len(solid.along.of)):
        normals, column = np.unique(tool.normals.of[block], return_inverse=True)
        rises = rising(solid.along.each, tool.normals.each.at(normals))[solid.along.of]
        corner, face = solid.tops(rises[:, column])
        yield corner[is_convex[corner]], block.start + face[is_convex[corner]]


def _wedges(
    solid: Polyhedron, edges: IndexArray, start: IndexArray, end: IndexArray, sums: _Sums
) -> Iterator[IndexArray]:
    """Yield the faces of wedges: edges swept by the triangle of a tool's edge and the origin."""
    p, q = (part[edges] for part in solid.ends)
    yield _triangles(sums.of(p, start), sums.of(p, end), sums.of(q, end))
    yield _triangles(sums.of(p, start), sums.of(q, end), sums.of(q, start))
    yield _triangles(sums.of(p, _ORIGIN), sums.of(p, end), sums.of(p, start))
    yield _triangles(sums.of(q, _ORIGIN), sums.of(q, start), sums.of(q, end))
    yield from _wall(q, p, start, sums)
    yield from _wall(p, q, end, sums)


def _pyramids(corners: IndexArray, bases: IndexArray, sums: _Sums) -> Iterator[IndexArray]:
    """Yield the faces of pyramids: corners swept by tetrahedra of a tool's faces and the origin."""
    yield sums.of(corners[:, None], bases)
    origins = sums.of(corners, _ORIGIN)
    for k in range(3):
        yield _triangles(origins, sums.of(corners, bases[:, k]), sums.of(corners, bases[:, k - 1]))


def _wall(p: IndexArray, q: IndexArray, top: IndexArray, sums: _Sums) -> Iterator[IndexArray]:
    """Yield the faces that edges sweep from the origin to a corner, alike on both sides."""
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
