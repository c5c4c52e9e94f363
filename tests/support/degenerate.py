"""Random scenes of parts that nearly coincide, with differences down to 1e-9 units."""

import random
from collections.abc import Callable

import numpy as np

import bspcsg as b

NEAR = [1e-9, 3e-9, 1e-8, 1e-7]


def _tetrahedron(rng: random.Random) -> "b.Solid":
    corners = np.array(
        [[rng.choice([0, 1, 0.5, 1e-9, rng.random()]) for _ in "xyz"] for _ in "abcd"]
    )
    size = np.linalg.det(corners[1:] - corners[0])
    if abs(size) < 1e-25:
        return b.box((1, 1, 1))
    faces = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    try:
        return b.Solid(corners, faces if size > 0 else faces[:, ::-1])
    except (b.InvalidMeshError, b.LimitError):
        return b.box((1, 1, 1))


_PARTS: list[Callable[[random.Random], "b.Solid"]] = [
    lambda rng: b.box([rng.choice([1, 2, 0.5, 1e-9, 3e-9, 1e-3]) for _ in "xyz"]),
    lambda rng: b.sphere(1, segments=rng.choice([6, 8, 12])),
    lambda rng: b.cylinder(
        rng.choice([0.5, 1]), rng.choice([1, 2, 1e-9, 1e-6]), segments=rng.choice([5, 8, 16])
    ),
    lambda rng: b.cone(1, 1, segments=rng.choice([4, 7, 12])),
    _tetrahedron,
    lambda rng: b.prism(rng.choice([3, 5, 6]), h=rng.choice([1, 1e-9]), r=1),
    lambda rng: b.box((1, 1, 1)),
]

_MOVES: list[Callable[[random.Random, "b.Solid"], "b.Solid"]] = [
    lambda rng, part: part.rotate(
        rng.choice([1e-9, 1e-8, 1e-7, 30, 45, rng.uniform(0, 360)]), rng.choice("xyz")
    ),
    lambda rng, part: part.translate(
        *[rng.choice([0, 1e-9, -1e-9, 0.5, rng.random()]) for _ in "xyz"]
    ),
    lambda rng, part: part.rotate([rng.uniform(0, 360) for _ in "xyz"]),
    lambda rng, part: part.scale([rng.choice([1, 0.5, 1e-3]) for _ in "xyz"]),
    lambda rng, part: part.rotate([rng.choice([0, 1e-9, 90, 1e-7]) for _ in "xyz"]),
]


def _part(rng: random.Random) -> "b.Solid":
    part = rng.choice(_PARTS)(rng)
    for _ in range(rng.randrange(3)):
        part = rng.choice(_MOVES)(rng, part)
    return part


def scene(seed: int) -> "b.Solid":
    """Return a random expression of two to six parts, some of them slightly moved copies."""
    rng = random.Random(seed)
    parts = [_part(rng) for _ in range(rng.randrange(2, 5))]
    if rng.random() < 0.4:
        parts.append(rng.choice(parts).translate(*[rng.choice([0, 1e-9, 1e-8]) for _ in "xyz"]))
    if rng.random() < 0.3:
        parts.append(rng.choice(parts).rotate(rng.choice(NEAR), rng.choice("xyz")))
    result = parts[0]
    for part in parts[1:]:
        result = rng.choice([result | part, result - part, result ^ part, result & part])
    return result
