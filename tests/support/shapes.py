"""Closed meshes as plain arrays (vertices, faces), made without the package under test."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Vertices: TypeAlias = npt.NDArray[np.float64]
Faces: TypeAlias = npt.NDArray[np.int64]
Arrays: TypeAlias = tuple[Vertices, Faces]
Grid: TypeAlias = npt.NDArray[np.bool_]

# Corner k of a unit cube has the bits of k as its coordinates.
_CORNERS = np.array([[k >> 2 & 1, k >> 1 & 1, k & 1] for k in range(8)], dtype=np.float64)
_QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
_CUBE_FACES = np.array([t for a, b, c, d in _QUADS for t in ((a, b, c), (a, c, d))], dtype=np.int64)


def cuboid(low: npt.ArrayLike, high: npt.ArrayLike) -> Arrays:
    """Return the 12 triangles of an axis-parallel box."""
    corner = np.asarray(low, dtype=np.float64)
    return corner + _CORNERS * (np.asarray(high, dtype=np.float64) - corner), _CUBE_FACES.copy()


def cube(side: float = 1.0) -> Arrays:
    """Return a cube with one corner at the origin."""
    return cuboid((0, 0, 0), (side, side, side))


def tetrahedron(corners: npt.ArrayLike) -> Arrays:
    """Return a tetrahedron with four given corners, oriented to positive volume."""
    points = np.asarray(corners, dtype=np.float64)
    faces = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)], dtype=np.int64)
    a, b, c, d = points
    return points, faces if np.dot(np.cross(b - a, c - a), d - a) > 0 else faces[:, ::-1].copy()


def octahedron() -> Arrays:
    """Return the octahedron with corners on the axes at distance 1 from the origin."""
    points = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)])
    faces = [
        (x, y, z) if (x + y + z) % 2 == 0 else (y, x, z)
        for x in (0, 1)
        for y in (2, 3)
        for z in (4, 5)
    ]
    return points.astype(np.float64), np.array(faces, dtype=np.int64)


def icosphere(level: int) -> Arrays:
    """Return a unit sphere of 20 · 4^level triangles."""
    golden = (1 + 5**0.5) / 2
    ring = [(s, t * golden) for s in (-1.0, 1.0) for t in (-1.0, 1.0)]
    points = np.array([np.roll((0.0, s, t), axis) for axis in range(3) for s, t in ring])
    points /= np.linalg.norm(points[0])
    faces = _hull_of_icosahedron(points)
    for _ in range(level):
        points, faces = _subdivide(points, faces)
        points /= np.linalg.norm(points, axis=1)[:, None]
    return points, faces


def _hull_of_icosahedron(points: Vertices) -> Faces:
    edge = np.sort(np.linalg.norm(points - points[0], axis=1))[1]
    near = np.abs(np.linalg.norm(points[:, None] - points[None], axis=2) - edge) < 1e-9
    faces = []
    for a in range(12):
        for b in range(a + 1, 12):
            for c in range(b + 1, 12):
                if near[a, b] and near[b, c] and near[a, c]:
                    outward = np.linalg.det(points[[a, b, c]]) > 0
                    faces.append((a, b, c) if outward else (a, c, b))
    return np.array(faces, dtype=np.int64)


def _subdivide(points: Vertices, faces: Faces) -> Arrays:
    ends = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, which = np.unique(ends, axis=0, return_inverse=True)
    middle = which.reshape(-1, 3) + len(points)
    (a, b, c), (ab, bc, ca) = faces.T, middle.T
    parts = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return (
        np.concatenate([points, points[edges].mean(axis=1)]),
        np.stack([np.stack(part, axis=1) for part in parts], axis=1).reshape(-1, 3),
    )


def prism(outline: Sequence[tuple[float, float]], low: float, high: float) -> Arrays:
    """Return the prism over a convex counter-clockwise outline, from z = `low` to z = `high`."""
    n = len(outline)
    points = np.array([(x, y, z) for z in (low, high) for x, y in outline], dtype=np.float64)
    caps = [t for k in range(1, n - 1) for t in ((0, k + 1, k), (n, n + k, n + k + 1))]
    around = [*range(n), 0]
    sides = [t for i, j in pairwise(around) for t in ((i, j, n + j), (i, n + j, n + i))]
    return points, np.array(caps + sides, dtype=np.int64)


def regular_outline(
    sides: int, radius: float = 1.0, turn: float = 0.0
) -> list[tuple[float, float]]:
    """Return the corners of a regular polygon, counter-clockwise, rotated by `turn` radians."""
    angles = turn + 2 * np.pi * np.arange(sides) / sides
    return [(radius * float(np.cos(a)), radius * float(np.sin(a))) for a in angles]


def pyramid(base: float, apex: tuple[float, float, float]) -> Arrays:
    """Return the pyramid over a square of half side `base` in the plane z = 0."""
    corners = [(-base, -base, 0), (base, -base, 0), (base, base, 0), (-base, base, 0), apex]
    faces = [(0, 3, 2), (0, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    return np.array(corners, dtype=np.float64), np.array(faces, dtype=np.int64)


def joined(*meshes: Arrays) -> Arrays:
    """Return several meshes as one, without welding vertices."""
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([faces + start for (_, faces), start in zip(meshes, starts, strict=False)]),
    )


def flipped(mesh: Arrays) -> Arrays:
    """Return the mesh with all faces reversed."""
    return mesh[0], mesh[1][:, ::-1].copy()


def moved(mesh: Arrays, by: npt.ArrayLike) -> Arrays:
    """Return the mesh translated by a vector."""
    return mesh[0] + np.asarray(by, dtype=np.float64), mesh[1]


def turned(mesh: Arrays, matrix: npt.NDArray[np.float64]) -> Arrays:
    """Return the mesh with its vertices multiplied by a (3, 3) matrix."""
    return mesh[0] @ matrix.T, mesh[1]


def random_rotation(rng: np.random.Generator) -> npt.NDArray[np.float64]:
    """Return a uniformly distributed rotation matrix, (3, 3)."""
    w, x, y, z = (q := rng.normal(size=4)) / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def affine(linear: npt.ArrayLike, shift: npt.ArrayLike = (0, 0, 0)) -> npt.NDArray[np.float64]:
    """Return the (4, 4) matrix of a linear part and a translation."""
    matrix = np.eye(4)
    matrix[:3, :3] = linear
    matrix[:3, 3] = shift
    return matrix


def cells_as_boxes(grid: Grid) -> Arrays:
    """Return one unit box for each true cell; touching boxes have double walls."""
    return joined(*[cuboid(cell, cell + 1) for cell in np.argwhere(grid)])


def box_of_squares(low: Sequence[int], high: Sequence[int]) -> Arrays:
    """Return a box with integer corners whose sides are divided into unit squares."""
    sizes = [high[i] - low[i] for i in range(3)]
    points: list[npt.NDArray[np.int64]] = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for end in (0, 1):
            at = np.zeros((sizes[u], sizes[v], 1, 3), dtype=np.int64)
            at[..., u] = np.arange(sizes[u])[:, None, None]
            at[..., v] = np.arange(sizes[v])[None, :, None]
            at[..., axis] = end * sizes[axis]
            steps = np.zeros((6, 3), dtype=np.int64)
            turns = [(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)]
            steps[:, [u, v]] = turns if end else [(b, a) for a, b in turns]
            points.append((at + steps).reshape(-1, 3))
    vertices, numbers = np.unique(np.concatenate(points), axis=0, return_inverse=True)
    return (vertices + np.asarray(low)).astype(np.float64), numbers.reshape(-1, 3)


def exact_volume(mesh: Arrays, pitch: int = -9) -> Fraction:
    """Return the exact signed volume of a mesh, snapped to the lattice of step 10^pitch."""
    step = Fraction(10) ** pitch
    steps = [[round(Fraction(x) / step) for x in vertex] for vertex in mesh[0].tolist()]
    six = 0
    for i, j, k in mesh[1].tolist():
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = steps[i], steps[j], steps[k]
        six += ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx)
    return Fraction(six, 6) * step**3
