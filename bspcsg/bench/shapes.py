"""Meshes for benchmarks, as arrays (vertices, faces) that any engine accepts."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from .._types import FloatArray, IndexArray, MeshArrays
from ..errors import missing_part

#: Meshes are vertices (n, 3) and faces (m, 3), counter-clockwise seen from outside.


#: An arbitrary fixed seed, so that all runs have the same arrays.
_SEED = 7


def generator(number: int = 0) -> np.random.Generator:
    """Return a random number generator, seeded with the number of a case."""
    return np.random.default_rng([_SEED, number])


def moved(mesh: MeshArrays, by: object) -> MeshArrays:
    """Return the mesh translated by a vector."""
    return mesh[0] + np.asarray(by, dtype=np.float64), mesh[1]


def scaled(mesh: MeshArrays, factor: float) -> MeshArrays:
    """Return the mesh scaled about the origin."""
    return mesh[0] * factor, mesh[1]


def turned(mesh: MeshArrays, matrix: FloatArray) -> MeshArrays:
    """Return the mesh with its vertices multiplied by a (3, 3) matrix."""
    return mesh[0] @ matrix.T, mesh[1]


def rotation(axis: object, angle: float) -> FloatArray:
    """Return the matrix of a rotation by an angle in radians about an axis through the origin."""
    x, y, z = (v := np.asarray(axis, dtype=np.float64)) / np.linalg.norm(v)
    across = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + np.sin(angle) * across + (1 - np.cos(angle)) * (across @ across))


def rotation_of(quaternion: FloatArray) -> FloatArray:
    """Return the matrix of the rotation that a quaternion (w, x, y, z) of any length describes."""
    w, axis = quaternion[0], quaternion[1:]
    return rotation(axis, 2 * float(np.arctan2(np.linalg.norm(axis), w)))


def random_rotation(random: np.random.Generator) -> FloatArray:
    """Return a uniformly distributed rotation matrix, (3, 3)."""
    matrix, upper = np.linalg.qr(random.normal(size=(3, 3)))
    matrix = matrix * np.sign(np.diag(upper))
    return np.ascontiguousarray(matrix * np.linalg.det(matrix))


def unit_vector(random: np.random.Generator) -> FloatArray:
    """Return a uniformly distributed unit vector, (3,)."""
    direction = random.normal(size=3)
    return np.asarray(direction / np.linalg.norm(direction))


def joined(meshes: Sequence[MeshArrays]) -> MeshArrays:
    """Return several meshes as one mesh."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])
    faces = [mesh[1] + start for mesh, start in zip(meshes, starts, strict=False)]
    return np.concatenate([vertices for vertices, _ in meshes]), np.concatenate(faces)


def _creation() -> Any:
    try:
        import trimesh
    except ImportError as error:
        raise missing_part("trimesh", "for the meshes of bench", "pip install trimesh") from error
    return trimesh.creation


def box(low: object, high: object) -> MeshArrays:
    """Return the 12 triangles of an axis-parallel box."""
    creation = _creation()
    corners = np.array([low, high], dtype=np.float64)
    mesh = creation.box(bounds=corners)
    # Replace vertices, which trimesh computes with rounding, by the exact corners.
    nearest = mesh.vertices > corners.mean(axis=0)
    return np.where(nearest, corners[1], corners[0]), np.asarray(mesh.faces, dtype=np.int64)


def icosphere(level: int) -> MeshArrays:
    """Return a unit sphere of 20 · 4^level triangles."""
    creation = _creation()
    mesh = creation.icosphere(subdivisions=level)
    return np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64)


def octasphere(n: int) -> MeshArrays:
    """Return a unit sphere of 8 · n² triangles: an octahedron with each face divided evenly."""
    rows = np.arange(-n, n + 1)
    x, y = (a.ravel() for a in np.meshgrid(rows, rows, indexing="ij"))
    # One half of the octahedron lies over the diamond |x| + |y| ≤ n; its rim belongs to both
    # halves.
    inside = np.abs(x) + np.abs(y) <= n
    x, y = x[inside], y[inside]
    height = n - np.abs(x) - np.abs(y)
    number = np.full((2 * n + 1, 2 * n + 1), -1)
    number[x + n, y + n] = np.arange(len(x))
    upper = np.column_stack([x, y, height])
    open_part = height > 0
    lower = upper[open_part] * (1, 1, -1)
    below = number.copy()
    below[x[open_part] + n, y[open_part] + n] = len(upper) + np.arange(len(lower))
    top = _diamond_triangles(number, n)
    faces = np.concatenate([top, _diamond_triangles(below, n)[:, ::-1]])
    points = np.concatenate([upper, lower]).astype(np.float64)
    return points / np.linalg.norm(points, axis=1)[:, None], np.ascontiguousarray(faces)


def _diamond_triangles(number: IndexArray, n: int) -> IndexArray:
    """Return the triangles of a diamond-shaped grid; all diagonals are parallel to the rim."""
    parts = []
    for sx, sy in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
        i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
        parts += [
            _quadrant(number, n, (sx, sy), keep, corners)
            for keep, corners in (
                ((i + j < n), ((i, j), (i + 1, j), (i, j + 1))),
                ((i + j < n - 1), ((i + 1, j), (i + 1, j + 1), (i, j + 1))),
            )
        ]
    return np.concatenate(parts)


def _quadrant(
    number: IndexArray,
    n: int,
    signs: tuple[int, int],
    keep: object,
    corners: tuple[tuple[IndexArray, IndexArray], ...],
) -> IndexArray:
    kept = np.asarray(keep, dtype=bool)
    triangles = np.column_stack(
        [number[signs[0] * i[kept] + n, signs[1] * j[kept] + n] for i, j in corners]
    )
    # Triangles of a mirrored quadrant are reversed.
    return triangles if signs[0] * signs[1] > 0 else triangles[:, ::-1]


def cylinder(sides: int, radius: float, low: float, high: float) -> MeshArrays:
    """Return a prism along z over a regular polygon with this number of sides."""
    angles = 2 * np.pi * np.arange(sides) / sides
    ring = np.column_stack([radius * np.cos(angles), radius * np.sin(angles)])
    return prism(ring, low, high)


def prism(ring: FloatArray, low: float, high: float) -> MeshArrays:
    """Return a prism along z over a convex polygon, with its caps as fans around a corner."""
    sides = len(ring)
    points = np.concatenate([np.column_stack([ring, np.full(sides, z)]) for z in (low, high)])
    i = np.arange(sides)
    j = (i + 1) % sides
    walls = np.concatenate(
        [np.column_stack([i, j, j + sides]), np.column_stack([i, j + sides, i + sides])]
    )
    k = np.arange(1, sides - 1)
    floor = np.column_stack([np.zeros_like(k), k + 1, k])
    roof = np.column_stack([np.zeros_like(k), k, k + 1]) + sides
    return points, np.concatenate([walls, floor, roof])


def spheres_apart(ball: MeshArrays, number: int = 0) -> tuple[MeshArrays, MeshArrays]:
    """Return a unit sphere and a rotated copy with its centre on the first sphere's surface."""
    random = generator(number)
    return ball, moved(turned(ball, random_rotation(random)), unit_vector(random))


def spheres_coincident(ball: MeshArrays) -> tuple[MeshArrays, MeshArrays]:
    """Return a unit sphere, and a copy that is 10⁻⁴ larger and rotated by 0.01 radians."""
    matrix = rotation(unit_vector(generator()), 0.01)
    return ball, scaled(turned(ball, matrix), 1 + 1e-4)


def needles(sides: int, length: float = 9450.0) -> tuple[MeshArrays, MeshArrays]:
    """Return two nearly parallel rods whose walls are 4 · `sides` very thin triangles.

    The bounding boxes of all walls overlap, since each wall runs along the whole rod, so that a
    search by boxes finds every pair of walls.
    """
    rod = cylinder(sides, 25.0, 0.0, length)
    askew = rotation((1, -2, 0.5), 0.7)
    twin = moved(turned(rod, rotation((0, 0, 1), np.pi / sides)), (8.0, 5.0, 40.0))
    return turned(rod, askew), turned(turned(twin, rotation((1, 0, 0), 0.001)), askew)


def drilled_cube(count: int) -> tuple[MeshArrays, list[MeshArrays]]:
    """Return a unit cube, and spheres of 128 triangles at random points in it."""
    ball = scaled(octasphere(4), 0.03)
    places = generator().random((count, 3))
    return box((0, 0, 0), (1, 1, 1)), [moved(ball, at) for at in places]


def drilled_plate(rows: int) -> tuple[MeshArrays, list[MeshArrays]]:
    """Return a plate, and `rows` · `rows` disjoint cylinders of 32 sides through it."""
    drill = cylinder(32, 0.35, -1.0, 2.0)
    places = [(x + 0.5, y + 0.5, 0.0) for x in range(rows) for y in range(rows)]
    return box((0, 0, 0), (rows, rows, 1)), [moved(drill, at) for at in places]


def random_boxes(count: int) -> list[MeshArrays]:
    """Return axis-parallel boxes in the unit cube that overlap at random."""
    random = generator()
    low = random.random((count, 3))
    size = 0.05 + 0.15 * random.random((count, 3))
    return [box(a, a + s) for a, s in zip(low, size, strict=True)]


def menger(depth: int) -> tuple[MeshArrays, list[list[MeshArrays]]]:
    """Return the cube of a Menger sponge, and its holes along x, along y and along z.

    The side of the cube is 3^depth, so that all coordinates are integers.
    """
    side = 3**depth
    squares = list(_squares(0, 0, side))
    groups = []
    for axis in range(3):
        holes = []
        for u, v, width in squares:
            low, high = np.array([u, v, 0]), np.array([u + width, v + width, side])
            holes.append(box(np.roll(low, axis), np.roll(high, axis)))
        groups.append(holes)
    return box((0, 0, 0), (side,) * 3), groups


def _squares(u: int, v: int, side: int) -> Iterator[tuple[int, int, int]]:
    """Yield corner and width of the square holes in a Menger sponge's face, the largest first."""
    third = side // 3
    if third == 0:
        return
    yield u + third, v + third, third
    for i in range(3):
        for j in range(3):
            if (i, j) != (1, 1):
                yield from _squares(u + i * third, v + j * third, third)


def milled_by_cylinders(count: int) -> tuple[MeshArrays, list[MeshArrays]]:
    """Return a block, and the solids that a flat mill of 32 sides removes on a spiral downwards.

    Each solid is a prism over a slot; neighbours have half a cylinder in common, and many floors
    are coplanar.
    """
    radius, windings = 0.08, 8
    turns = np.linspace(0, 2 * np.pi * windings, count + 1)
    out = 0.1 + 0.3 * turns / turns[-1]
    path = np.column_stack([out * np.cos(turns), out * np.sin(turns)])
    depths = 0.3 - 0.05 * (turns[:-1] // (2 * np.pi))
    tools = [
        prism(_slot(a, b, radius, 32), depth, 0.6)
        for a, b, depth in zip(path[:-1], path[1:], depths, strict=True)
    ]
    return box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)), tools


def _slot(start: FloatArray, end: FloatArray, radius: float, sides: int) -> FloatArray:
    """Return the convex polygon that a regular polygon sweeps along a segment."""
    along = end - start
    angles = np.arctan2(along[1], along[0]) + np.pi * (0.5 + np.arange(sides // 2 + 1) * 2 / sides)
    half = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    return np.concatenate([start + half, end - half])


def milled_by_balls(count: int) -> tuple[MeshArrays, list[MeshArrays]]:
    """Return a block, and the capsules that a ball sweeps along a curve through it."""
    t = np.linspace(0, 2 * np.pi, count + 1)
    path = 0.42 * np.column_stack([np.sin(5 * t), np.sin(7 * t + 1), np.sin(4 * t + 2)])
    tools = [_capsule(a, b, 0.1) for a, b in pairwise(path)]
    return box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)), tools


#: The numbers of sides and of rings of each half of a capsule, which give 360 triangles.
_CAPSULE_SIDES, _CAPSULE_RINGS = 18, 5


def _capsule(start: FloatArray, end: FloatArray, radius: float) -> MeshArrays:
    """Return a triangulated capsule, the hull of two balls; its vertices lie on the balls."""
    length = float(np.linalg.norm(end - start))
    rise = np.pi / 2 * np.arange(_CAPSULE_RINGS) / _CAPSULE_RINGS
    upper = np.column_stack([np.cos(rise), np.sin(rise)]) * radius
    profile = np.concatenate([upper[::-1] * (1, -1), upper + (0, length)])
    angles = 2 * np.pi * np.arange(_CAPSULE_SIDES) / _CAPSULE_SIDES
    around = np.column_stack([np.cos(angles), np.sin(angles)])
    rings = [np.column_stack([r * around, np.full(len(around), z)]) for r, z in profile]
    poles = [[(0.0, 0.0, -radius)], [(0.0, 0.0, length + radius)]]
    points = np.concatenate([*rings, *poles])
    return points @ _frame((end - start) / length).T + start, _lathe_faces(len(profile))


def _frame(axis: FloatArray) -> FloatArray:
    """Return a rotation matrix that maps the z axis to a unit vector."""
    least = np.eye(3)[np.argmin(np.abs(axis))]
    x = np.cross(least, axis)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(axis, x), axis])


def _lathe_faces(rings: int) -> IndexArray:
    """Return the triangles between consecutive rings, and from the end rings to the poles."""
    i = np.arange(_CAPSULE_SIDES)
    j = (i + 1) % _CAPSULE_SIDES
    below, above = rings * _CAPSULE_SIDES, rings * _CAPSULE_SIDES + 1
    parts = [np.column_stack([j, i, np.full_like(i, below)])]
    for start in range(0, (rings - 1) * _CAPSULE_SIDES, _CAPSULE_SIDES):
        a, b, c, d = i + start, j + start, j + start + _CAPSULE_SIDES, i + start + _CAPSULE_SIDES
        parts += [np.column_stack([a, b, c]), np.column_stack([a, c, d])]
    last = (rings - 1) * _CAPSULE_SIDES
    parts.append(np.column_stack([i + last, j + last, np.full_like(i, above)]))
    return np.concatenate(parts)


#: The number of steps of the whole dome; a shorter run is the beginning of the same spiral.
DOME_STEPS = 100_000


def dome(steps: int) -> tuple[MeshArrays, Iterator[MeshArrays]]:
    """Return a block, and an iterator of balls that carve a flat dome into its top.

    The balls follow a spiral outwards, as far apart along it as its windings are, so that each ball
    overlaps about eight earlier ones.
    """
    spacing = np.sqrt(np.pi / DOME_STEPS)
    radius = 1.2 * spacing
    block = box((-1.1, -1.1, -0.2), (1.1, 1.1, 0.0))
    return block, _dome_balls(steps, spacing, radius)


def _dome_balls(steps: int, spacing: float, radius: float) -> Iterator[MeshArrays]:
    ball = scaled(octasphere(4), radius)
    random = generator()
    for k in range(steps):
        # Each step covers an area of spacing²; the angle follows from dθ = spacing / r.
        r = spacing * np.sqrt((k + 0.5) / np.pi)
        angle = 2 * np.sqrt(np.pi * (k + 0.5))
        depth = radius * (0.4 - r * r)
        at = (r * np.cos(angle), r * np.sin(angle), depth)
        yield moved(turned(ball, random_rotation(random)), at)
