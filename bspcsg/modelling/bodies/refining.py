"""Surfaces in smaller triangles, the same set of points."""

from typing import Any

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray, MeshArrays
from ...errors import LimitError, invalid_parameter
from ...parameters import at_least, positive
from ...solid.counting import counted
from ...solid.solid import Solid

#: Triangles of a result. While its solid is made each takes some 300 bytes, all of them 3 GB.
_MOST_TRIANGLES = 10_000_000


@counted
def refine(solid: Solid, n: Any = None, edge_length: Any = None) -> Solid:
    """Return the solid with smaller triangles (see `Solid.refine`)."""
    if (n is None) == (edge_length is None):
        raise invalid_parameter("Say either n or edge_length.")
    mesh = solid.normalized().to_mesh()
    if len(mesh.faces) == 0:
        return solid
    if n is not None:
        parts = at_least(1, n, "n")
        refuse_many(len(mesh.faces) * parts**2)
        if parts == 1:
            return solid
        arrays = divided(mesh.vertices, mesh.faces, parts)
    else:
        arrays = halved(mesh.vertices, mesh.faces, positive(edge_length, "edge_length"))
    return Solid(*arrays, pitch=solid.pitch)


def divided(vertices: FloatArray, faces: IndexArray, parts: int) -> MeshArrays:
    """Return each triangle in parts² alike, new corners evenly along edges and inside."""
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
    low = [(i, j) for i in range(parts) for j in range(parts - i)]
    high = [(i, j) for i, j in low if i + j < parts - 1]
    pieces = [(grid[i, j], grid[i + 1, j], grid[i, j + 1]) for i, j in low]
    pieces += [(grid[i + 1, j], grid[i + 1, j + 1], grid[i, j + 1]) for i, j in high]
    small = np.stack([np.stack(piece, axis=1) for piece in pieces], axis=1).reshape(-1, 3)
    return np.concatenate([vertices, along.reshape(-1, 3), *inner]), small


def _grid(
    faces: IndexArray, edges: IndexArray, sides: IndexArray, parts: int, first: int
) -> dict[tuple[int, int], IndexArray]:
    """Return the corners of all triangles' parts on their edges, by steps to corners 1 and 2."""
    grid = {(0, 0): faces[:, 0], (parts, 0): faces[:, 1], (0, parts): faces[:, 2]}
    for k in range(1, parts):
        ways = ((k, 0), (parts - k, k), (0, parts - k))
        for side, way in enumerate(ways):
            forward = edges[sides[:, side], 0] == faces[:, side]
            step = np.where(forward, k, parts - k) - 1
            grid[way] = first + sides[:, side] * (parts - 1) + step
    return grid


def _between(low: FloatArray, high: FloatArray, shares: FloatArray) -> FloatArray:
    """Return points between others, (n, shares, 3)."""
    weights = shares[:, None]
    points: FloatArray = low[:, None] + (high - low)[:, None] * weights
    return points


def halved(vertices: FloatArray, faces: IndexArray, longest: float) -> MeshArrays:
    """Return the mesh with edges halved until none is longer.

    Triangles fall into two, three or four, as many of their edges as are halved, so that no corner
    lies within an edge.
    """
    while True:
        edges, sides = _edges(faces, len(vertices))
        ends = vertices[edges]
        long = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) > longest
        # What the lattice cannot halve stays.
        middles = (ends[:, 0] + ends[:, 1]) / 2
        long &= (middles != ends[:, 0]).any(axis=1) & (middles != ends[:, 1]).any(axis=1)
        if not long.any():
            return vertices, faces
        refuse_many(len(faces) + 2 * int(long.sum()))
        number = np.full(len(edges), -1)
        number[long] = len(vertices) + np.arange(int(long.sum()))
        vertices = np.concatenate([vertices, middles[long]])
        faces = _cut_at(vertices, faces, number[sides])


def _cut_at(vertices: FloatArray, faces: IndexArray, middles: IndexArray) -> IndexArray:
    """Return triangles cut at the middles of their edges, -1 where an edge is whole."""
    count = (middles >= 0).sum(axis=1)
    pieces = [faces[count == 0]]
    faces_3, m = faces[count == 3], middles[count == 3]
    pieces += [np.stack([faces_3[:, k], m[:, k], m[:, k - 1]], axis=1) for k in range(3)] + [m]
    for k in range(3):
        (a, b, c), m = _turned(faces, middles, (count == 1) & (middles[:, k] >= 0), k)
        pieces += [np.stack([a, m[0], c], axis=1), np.stack([m[0], b, c], axis=1)]
        whole = (count == 2) & (middles[:, k] < 0)
        (a, b, c), m = _turned(faces, middles, whole, k)
        pieces.append(np.stack([m[2], m[1], c], axis=1))
        # The shorter diagonal of the quadrilateral that is left.
        first = _lengths(vertices, a, m[1]) <= _lengths(vertices, b, m[2])
        fourth, far = np.where(first, m[1], m[2]), np.where(first, a, b)
        pieces.append(np.stack([a, b, fourth], axis=1))
        pieces.append(np.stack([far, m[1], m[2]], axis=1))
    return np.concatenate(pieces)


def _turned(
    faces: IndexArray, middles: IndexArray, chosen: BoolArray, k: int
) -> tuple[IndexArray, IndexArray]:
    """Return corners and middles of some triangles, (3, n), with edge k as the first."""
    order = [k, (k + 1) % 3, (k + 2) % 3]
    return faces[chosen][:, order].T, middles[chosen][:, order].T


def _lengths(vertices: FloatArray, start: IndexArray, end: IndexArray) -> FloatArray:
    lengths: FloatArray = np.linalg.norm(vertices[end] - vertices[start], axis=1)
    return lengths


def _edges(faces: IndexArray, count: int) -> tuple[IndexArray, IndexArray]:
    """Return the edges, (e, 2), lower corner first, and which are the sides of each triangle."""
    ends = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    keys, sides = np.unique(ends[:, 0] * np.int64(count) + ends[:, 1], return_inverse=True)
    return np.stack([keys // count, keys % count], axis=1), sides.reshape(-1, 3)


def refuse_many(count: int) -> None:
    """Raise `LimitError` for more triangles than a result may have."""
    if count > _MOST_TRIANGLES:
        message = f"The result would have {count:,} triangles; {_MOST_TRIANGLES:,} are the most."
        raise LimitError(message, "too_large")
