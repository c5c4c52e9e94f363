"""Division of the triangles of a surface into smaller ones."""

from typing import Any, TypeAlias

import numpy as np

from ..._types import FloatArray, IndexArray
from ...attributes.attributes import Attributes
from ...attributes.transfer import Surface, inherited_attributes
from ...errors import LimitError, invalid_parameter
from ...mesh.mesh import Mesh
from ...parameters import at_least, positive
from ...solid.ledger import counted
from ...solid.solid import Solid, given_pitch, keeping_pitch, solid_with

#: A factor by which rounding never lengthens an edge.
_ROUNDED = 1 + 2.0**-30

#: A refined mesh: vertices, triangles, and for each triangle the row of the original triangle that
#: contains it.
RefinedMesh: TypeAlias = tuple[FloatArray, IndexArray, IndexArray]

#: The rows of original triangles, and for each row a part of that triangle, as three vertices.
_Piece: TypeAlias = tuple[IndexArray, IndexArray]

#: The largest number of triangles of a result. Each takes about 300 bytes while the solid is made,
#: so at most 3 GB in all.
_MAX_TRIANGLES = 10_000_000


@counted
def refine(solid: Solid, n: Any = None, edge_length: Any = None) -> Solid:
    """Return the solid with each triangle divided, into n² parts or until edges are short enough.

    Give either `n` or `edge_length`, the largest length of an edge in model units.
    """
    if (n is None) == (edge_length is None):
        raise invalid_parameter("Give exactly one of n and edge_length.")
    mesh = solid.normalized().to_mesh()
    if len(mesh.faces) == 0:
        return solid
    if n is not None:
        parts = at_least(1, n, "n")
        refuse_many_triangles(len(mesh.faces) * parts**2)
        if parts == 1:
            return solid
        finer = with_triangles_divided(mesh.vertices, mesh.faces, parts)
    else:
        finer = with_edges_halved(mesh.vertices, mesh.faces, positive(edge_length, "edge_length"))
    said = None if mesh.carried is None else attributes_on(mesh, *finer)
    return keeping_pitch(solid_with(*finer[:2], said, pitch=solid.pitch), given_pitch(solid))


def attributes_on(
    mesh: Mesh, vertices: FloatArray, faces: IndexArray, origins: IndexArray
) -> Attributes:
    """Return the attributes of new triangles, interpolated from a mesh's triangles around them.

    Each new triangle k lies in the triangle `origins[k]` of the mesh.
    """
    source = np.stack([np.zeros_like(origins), origins], axis=1)
    surface = Surface(vertices, faces, source, np.zeros(len(faces), dtype=bool))
    known = mesh.vertices, mesh.vertices, mesh.faces, np.arange(len(mesh.faces))
    return inherited_attributes(surface, [mesh.attributes], lambda _: known)


def with_triangles_divided(vertices: FloatArray, faces: IndexArray, parts: int) -> RefinedMesh:
    """Divide each triangle into parts² similar triangles, whose corners are evenly spaced."""
    edges, sides = _edges(faces, len(vertices))
    shares = np.arange(1, parts) / parts
    along = _between(vertices[edges[:, 0]], vertices[edges[:, 1]], shares)
    places = [(i, j) for i in range(1, parts) for j in range(1, parts - i)]
    inner = [
        (vertices[faces] * np.array([parts - i - j, i, j])[:, None]).sum(axis=1) / parts
        for i, j in places
    ]
    start = len(vertices) + len(edges) * (parts - 1)
    grid = _grid(faces, edges, sides, parts, len(vertices))
    for number, (i, j) in enumerate(places):
        grid[i, j] = start + number * len(faces) + np.arange(len(faces))
    pieces = [[grid[place] for place in corners] for corners in small_triangles(parts)]
    small = np.stack([np.stack(piece, axis=1) for piece in pieces], axis=1).reshape(-1, 3)
    points = np.concatenate([vertices, along.reshape(-1, 3), *inner])
    return points, small, np.repeat(np.arange(len(faces)), parts**2)


def small_triangles(parts: int) -> list[list[tuple[int, int]]]:
    """Return the parts² parts of a triangle whose sides are divided into `parts` equal steps.

    Each corner of a part is a pair (i, j): i steps from corner 0 towards corner 1, j towards 2.
    """
    low = [(i, j) for i in range(parts) for j in range(parts - i)]
    high = [(i, j) for i, j in low if i + j < parts - 1]
    upright = [[(i, j), (i + 1, j), (i, j + 1)] for i, j in low]
    return upright + [[(i + 1, j), (i + 1, j + 1), (i, j + 1)] for i, j in high]


def _grid(
    faces: IndexArray, edges: IndexArray, sides: IndexArray, parts: int, first: int
) -> dict[tuple[int, int], IndexArray]:
    """Return the vertex numbers of the points on triangle sides, an array over all faces for each.

    The key (i, j) means i steps from corner 0 towards corner 1, and j towards corner 2.
    """
    grid = {(0, 0): faces[:, 0], (parts, 0): faces[:, 1], (0, parts): faces[:, 2]}
    for k in range(1, parts):
        ways = ((k, 0), (parts - k, k), (0, parts - k))
        for side, way in enumerate(ways):
            forward = edges[sides[:, side], 0] == faces[:, side]
            step = np.where(forward, k, parts - k) - 1
            grid[way] = first + sides[:, side] * (parts - 1) + step
    return grid


def _between(low: FloatArray, high: FloatArray, shares: FloatArray) -> FloatArray:
    """Return points on the segments from low[k] to high[k], at fractions from 0 to 1 of each."""
    weights = shares[:, None]
    points: FloatArray = low[:, None] + (high - low)[:, None] * weights
    return points


def with_edges_halved(vertices: FloatArray, faces: IndexArray, longest: float) -> RefinedMesh:
    """Return the mesh with edges halved until none is longer than `longest`.

    A triangle with one, two or three halved edges is divided into two, three or four, so no
    vertex lies inside an edge of another triangle.
    """
    refuse_many_triangles(least_halved(vertices, faces, longest), "at least ")
    origins = np.arange(len(faces))
    while True:
        edges, sides = _edges(faces, len(vertices))
        ends = vertices[edges]
        long = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) > longest
        # Do not halve edges so short that the midpoint rounds to an end.
        middles = (ends[:, 0] + ends[:, 1]) / 2
        long &= (middles != ends[:, 0]).any(axis=1) & (middles != ends[:, 1]).any(axis=1)
        if not long.any():
            return vertices, faces, origins
        refuse_many_triangles(len(faces) + 2 * int(long.sum()), "at least ")
        number = np.full(len(edges), -1)
        number[long] = len(vertices) + np.arange(int(long.sum()))
        vertices = np.concatenate([vertices, middles[long]])
        faces, rows = _cut_at(vertices, faces, number[sides])
        origins = origins[rows]


def least_halved(vertices: FloatArray, faces: IndexArray, longest: float) -> int:
    """Return a lower bound of the number of triangles after all edges are halved to `longest`.

    Each triangle is divided into four similar ones until its shortest side is short enough. Then
    the longer sides are cut; each part of a side belongs to one of the final triangles, which have
    three sides each.
    """
    corners = vertices[faces]
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    # An edge of four spacings of doubles or less cannot be halved.
    length = max(longest * _ROUNDED, 4 * float(np.spacing(np.abs(vertices).max(initial=0.0))))
    halvings = np.ceil(np.log2(np.maximum(sides.min(axis=1) / length, 1.0)))
    lengths = sides / length / 2 ** halvings[:, None]
    cut = np.maximum(1 + (lengths > 1).sum(axis=1), lengths.sum(axis=1) / 3)
    return int(min(float((4**halvings * cut).sum()), 1e300))


def _cut_at(
    vertices: FloatArray, faces: IndexArray, middles: IndexArray
) -> tuple[IndexArray, IndexArray]:
    """Return the parts of triangles cut at midpoints of edges, and each part's original triangle.

    The (m, 3) `middles` are the vertex numbers of the midpoints, -1 for an uncut edge.
    """
    count = (middles >= 0).sum(axis=1)
    pieces = [(np.flatnonzero(count == 0), faces[count == 0])]
    pieces += _quartered(faces, middles, np.flatnonzero(count == 3))
    for k in range(3):
        is_cut = middles[:, k] >= 0
        turn = [k, (k + 1) % 3, (k + 2) % 3]
        faces_k, middles_k = faces[:, turn], middles[:, turn]
        pieces += _cut_once(faces_k, middles_k, np.flatnonzero((count == 1) & is_cut))
        pieces += _cut_twice(vertices, faces_k, middles_k, np.flatnonzero((count == 2) & ~is_cut))
    rows, cut = (np.concatenate(column) for column in zip(*pieces, strict=True))
    return cut, rows


def _quartered(faces: IndexArray, middles: IndexArray, rows: IndexArray) -> list[_Piece]:
    f, m = faces[rows], middles[rows]
    corners = [np.stack([f[:, k], m[:, k], m[:, k - 1]], axis=1) for k in range(3)]
    return [(rows, piece) for piece in (*corners, m)]


def _cut_once(faces: IndexArray, middles: IndexArray, rows: IndexArray) -> list[_Piece]:
    """Return the two halves of each triangle of `rows`, which is cut only at edge 0."""
    (a, b, c), m = faces[rows].T, middles[rows, 0]
    return [(rows, np.stack([a, m, c], axis=1)), (rows, np.stack([m, b, c], axis=1))]


def _cut_twice(
    vertices: FloatArray, faces: IndexArray, middles: IndexArray, rows: IndexArray
) -> list[_Piece]:
    """Return the three parts of each triangle of `rows`, which is cut at edges 1 and 2."""
    (a, b, c), (_, m, n) = faces[rows].T, middles[rows].T
    # Divide the quadrilateral beside edge 0 along its shorter diagonal.
    first = _lengths(vertices, a, m) <= _lengths(vertices, b, n)
    fourth, far = np.where(first, m, n), np.where(first, a, b)
    parts = ([n, m, c], [a, b, fourth], [far, m, n])
    return [(rows, np.stack(part, axis=1)) for part in parts]


def _lengths(vertices: FloatArray, start: IndexArray, end: IndexArray) -> FloatArray:
    lengths: FloatArray = np.linalg.norm(vertices[end] - vertices[start], axis=1)
    return lengths


def _edges(faces: IndexArray, count: int) -> tuple[IndexArray, IndexArray]:
    """Return the distinct edges, (e, 2) sorted vertex numbers, and each triangle's edges, (m, 3).

    `count` is the number of vertices.
    """
    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    keys, sides = np.unique(ends[:, 0] * np.int64(count) + ends[:, 1], return_inverse=True)
    return np.stack([keys // count, keys % count], axis=1), sides.reshape(-1, 3)


def refuse_many_triangles(count: int, about: str = "") -> None:
    """Raise `LimitError` if `count` triangles are too many; the message puts `about` before it."""
    if count > _MAX_TRIANGLES:
        amount = f"{about}{count:,}" if count < _MAX_TRIANGLES**2 else "far too many"
        message = (
            f"The result would have {amount} triangles, and at most {_MAX_TRIANGLES:,} are"
            " allowed; choose larger triangles."
        )
        raise LimitError(message, "too_large")
