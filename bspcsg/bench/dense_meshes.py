"""Meshes in which many faces meet, each as a function of a count."""

import numpy as np

from .._types import MeshArrays
from .shapes import (
    box,
    cylinder,
    generator,
    icosphere,
    joined,
    moved,
    octasphere,
    prism,
    random_rotation,
    rotation,
    scaled,
    turned,
    unit_vector,
)

#: The number of sides of a tube.
_TUBE_SIDES = 24

#: A rotation for meshes that would otherwise be axis-parallel.
_ASKEW = rotation((1, 2, 3), 0.4)


def cubes_around_ball(count: int) -> list[MeshArrays]:
    """Return large cubes that contain the unit ball, each of which touches it with one side."""
    random = generator(1)
    cube = box((-4, -4, -7), (4, 4, 1))
    return [turned(cube, random_rotation(random)) for _ in range(count)]


def turned_cubes(count: int) -> list[MeshArrays]:
    """Return randomly rotated unit cubes around the origin."""
    random = generator(2)
    cube = box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
    return [turned(cube, random_rotation(random)) for _ in range(count)]


def aligned_boxes(count: int) -> list[MeshArrays]:
    """Return axis-parallel boxes at random in a small space, so that most of them overlap."""
    random = generator(3)
    lows = random.random((count, 3))
    sizes = 0.2 + 0.8 * random.random((count, 3))
    return [box(low, low + size) for low, size in zip(lows, sizes, strict=True)]


def bundles(count: int) -> tuple[MeshArrays, MeshArrays]:
    """Return a bundle of parallel thin tetrahedra, and a randomly rotated copy of it."""
    random = generator(4)
    rows = int(np.ceil(np.sqrt(count)))
    pitch = 2.0 / rows
    needle = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0.03, 0.03, 10 / pitch]]) * pitch
    places = [(k // rows, k % rows) for k in range(count)]
    starts = [(x * pitch - 1, y * pitch - 1, -5 + 0.1 * random.random()) for x, y in places]
    bundle = joined([(needle + start, _TETRAHEDRON) for start in starts])
    return bundle, turned(bundle, random_rotation(random))


def near_cones(sides: int) -> tuple[MeshArrays, MeshArrays]:
    """Return two equal cones, one of which is shifted by a tenth of its radius."""
    return cone(sides), moved(cone(sides), (0.03, 0.05, 0.08))


def cones_at_one_apex(sides: int) -> tuple[MeshArrays, MeshArrays]:
    """Return a cone and a copy that is rotated about the apex."""
    return cone(sides), turned(cone(sides), rotation((1, 0.2, 0.1), 0.8))


def equal_cones(sides: int) -> tuple[MeshArrays, MeshArrays]:
    """Return two equal cones."""
    return cone(sides), cone(sides)


def turned_cones(count: int) -> list[MeshArrays]:
    """Return cones of eight sides, randomly rotated about their common apex."""
    random = generator(5)
    return [turned(cone(8), random_rotation(random)) for _ in range(count)]


def punched_plate(count: int) -> list[MeshArrays]:
    """Return a plate and disjoint boxes through it in rows of thirty, all rotated off the axes."""
    rows = -(-count // 30)
    plate = box((0, 0, 0), (rows, min(count, 30), 1))
    places = [divmod(k, 30) for k in range(count)]
    holes = [box((x + 0.25, y + 0.25, -1), (x + 0.75, y + 0.75, 2)) for x, y in places]
    return [turned(mesh, _ASKEW) for mesh in [plate, *holes]]


def drilled_plate(count: int) -> list[MeshArrays]:
    """Return a plate and disjoint cylinders of 32 sides through it, in rows of thirty."""
    rows = -(-count // 30)
    drill = cylinder(32, 0.35, -1.0, 2.0)
    places = [divmod(k, 30) for k in range(count)]
    holes = [moved(drill, (x + 0.5, y + 0.5, 0)) for x, y in places]
    return [box((0, 0, 0), (rows, min(count, 30), 1)), *holes]


def drilled_at_once(count: int) -> tuple[MeshArrays, MeshArrays]:
    """Return the plate of `drilled_plate` and its cylinders as one mesh."""
    plate, *holes = drilled_plate(count)
    return plate, joined(holes)


def slab_and_column(sides: int) -> tuple[MeshArrays, MeshArrays]:
    """Return a column and a slab that cuts it in two; edges meet on diagonals of the slab."""
    return cylinder(sides, 2.0, 0.0, 5.0), box((-3, -3, 1), (3, 3, 2))


def nested_balls(count: int) -> list[MeshArrays]:
    """Return balls with one centre and increasing radii."""
    ball = icosphere(2)
    return [scaled(ball, 1 + 0.01 * k) for k in range(count)]


def film(triangles: int) -> tuple[MeshArrays, MeshArrays]:
    """Return a ball of about `triangles` triangles, and a copy shifted by one lattice step."""
    ball = octasphere(round((triangles / 8) ** 0.5))
    return ball, moved(ball, (1e-9, 0, 0))


def moved_copies(count: int) -> list[MeshArrays]:
    """Return copies of a ball, each shifted by another thousandth of a lattice step."""
    ball = icosphere(3)
    return [moved(ball, (1e-12 * k, 0, 0)) for k in range(count)]


def copies(count: int) -> list[MeshArrays]:
    """Return `count` equal balls."""
    return [icosphere(2)] * count


def revisions(triangles: int) -> tuple[MeshArrays, MeshArrays]:
    """Return a ball, and a copy with one vertex moved outwards and its faces in another order."""
    points, faces = octasphere(round((triangles / 8) ** 0.5))
    later = points.copy()
    later[0] *= 1.01
    return (points, faces), (later, generator(12).permutation(faces))


def near_balls(count: int) -> list[MeshArrays]:
    """Return balls rotated by a hundredth of a radian each, with slightly increasing radii."""
    random = generator(8)
    turns = [rotation(unit_vector(random), 0.01) for _ in range(count)]
    ball = icosphere(2)
    return [turned(scaled(ball, 1 + 1e-4 * k), turn) for k, turn in enumerate(turns)]


def touching_cubes(count: int) -> list[MeshArrays]:
    """Return unit cubes that touch side by side, in layers of ten by ten."""
    places = [(k // 100, k // 10 % 10, k % 10) for k in range(count)]
    return [box(at, np.array(at) + 1) for at in places]


def cubes_in_room(count: int) -> list[MeshArrays]:
    """Return randomly rotated unit cubes at random points, one per unit of volume."""
    random = generator(9)
    cube = box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
    side = count ** (1 / 3)
    return [
        moved(turned(cube, random_rotation(random)), side * random.random(3)) for _ in range(count)
    ]


def tetrahedra_in_room(count: int) -> list[MeshArrays]:
    """Return randomly rotated tetrahedra at random points, one per unit of volume."""
    random = generator(11)
    shape = np.vstack([np.zeros(3), np.eye(3)]) - 0.25, _TETRAHEDRON
    side = count ** (1 / 3)
    return [
        moved(turned(shape, random_rotation(random)), side * random.random(3)) for _ in range(count)
    ]


def combs(teeth: int) -> tuple[MeshArrays, MeshArrays]:
    """Return two combs of parallel slabs across each other, rotated off the axes."""
    slabs = [box((k / teeth, 0, 0), ((k + 0.5) / teeth, 1, 0.2)) for k in range(teeth)]
    comb = joined(slabs)
    other = moved(turned(comb, rotation((0, 0, 1), np.pi / 2)), (1.0, 0.0, 0.1))
    return turned(comb, _ASKEW), turned(other, _ASKEW)


def bar(sides: int) -> list[MeshArrays]:
    """Return a thin bar with a round end, in single precision; its caps have thin triangles."""
    return [_in_single_precision(turned(_round_bar(sides), rotation((3, 1, 2), 0.7)))]


def bars(sides: int) -> tuple[MeshArrays, MeshArrays]:
    """Return two long thin bars with round ends across each other (see `bar`)."""
    [first] = bar(sides)
    return first, _in_single_precision(turned(first, rotation((1, 2, -1), 0.3)))


def _round_bar(sides: int) -> MeshArrays:
    angles = np.pi * np.arange(sides) / (sides - 1) - np.pi / 2
    round_end = np.column_stack([9 + 0.05 * np.cos(angles), 0.05 * np.sin(angles)])
    return prism(np.concatenate([[[0, 0.05], [0, -0.05]], round_end]), -0.01, 0.01)


def _in_single_precision(mesh: MeshArrays) -> MeshArrays:
    return mesh[0].astype(np.float32).astype(np.float64), mesh[1]


def tube_and_box(rings: int) -> tuple[MeshArrays, MeshArrays]:
    """Return a tube that passes through itself, and a box around the crossing."""
    return _loop(rings), turned(box((-0.3, -0.3, 0), (0.3, 0.3, 1)), _ASKEW)


def _loop(rings: int) -> MeshArrays:
    # The curve (t² − 1, t³ − t) passes through the origin at −1 and at 1.
    t = np.linspace(-1.4, 1.4, rings)
    x, y = t * t - 1, t**3 - t
    ahead = np.hypot(2 * t, 3 * t * t - 1)
    aside = np.stack([1 - 3 * t * t, 2 * t, 0 * t], axis=1) / ahead[:, None]
    middle = np.stack([x, y, 0 * t], axis=1)
    turn = 2 * np.pi * np.arange(_TUBE_SIDES) / _TUBE_SIDES + 0.1
    out = aside[:, None] * np.cos(turn)[:, None] + np.outer(np.sin(turn), (0, 0, 1))
    around = (middle[:, None] + 0.2 * out).reshape(-1, 3)
    vertices = np.concatenate([around, middle[[0, -1]]])
    ring, side = (a.ravel() for a in np.indices((rings - 1, _TUBE_SIDES)))
    a, d = ring * _TUBE_SIDES + side, ring * _TUBE_SIDES + (side + 1) % _TUBE_SIDES
    b, c = a + _TUBE_SIDES, d + _TUBE_SIDES
    first, last = a[:_TUBE_SIDES], d[:_TUBE_SIDES]
    top = (rings - 1) * _TUBE_SIDES
    ends = [np.full(_TUBE_SIDES, len(around) + k) for k in range(2)]
    rows = [(a, d, c), (a, c, b), (first, ends[0], last), (first + top, last + top, ends[1])]
    return vertices, np.concatenate([np.stack(row, axis=1) for row in rows])


def spikes(count: int) -> list[MeshArrays]:
    """Return randomly rotated thin tetrahedra with one corner at the origin."""
    random = generator(10)
    spike = np.array([[0, 0, 0], [0.05, 0, 2], [-0.02, 0.04, 2], [-0.02, -0.04, 2]])
    return [turned((spike, _TETRAHEDRON), random_rotation(random)) for _ in range(count)]


#: The faces of a tetrahedron of positive volume.
_TETRAHEDRON = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])


def cone(sides: int) -> MeshArrays:
    """Return a cone with its apex at the origin; its base is a fan around the centre."""
    angles = 2 * np.pi * np.arange(sides) / sides
    rim = np.column_stack([0.9 * np.cos(angles), 0.9 * np.sin(angles), np.full(sides, -1.0)])
    points = np.concatenate([rim, [[0, 0, 0], [0, 0, -1]]])
    i = np.arange(sides)
    j = (i + 1) % sides
    walls = np.column_stack([i, j, np.full(sides, sides)])
    base = np.column_stack([j, i, np.full(sides, sides + 1)])
    return points, np.concatenate([walls, base])
