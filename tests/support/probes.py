"""Random probes of coincidences: each function returns the rounds that failed.

Round k of a probe uses the random generator seeded with (seed, k), so that it can be repeated
alone.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

import numpy as np

import bspcsg as b

from .checks import facts, open_edges
from .shapes import affine, cube, cuboid, moved, random_rotation, tetrahedron, turned

Rng = np.random.Generator
BOX = (8, 12, 1)


class Failure(NamedTuple):
    """A round of a probe that failed, and why."""

    round: int
    what: str


def failures(rounds: int, seed: int, probe: Callable[[Rng], str]) -> list[Failure]:
    """Run a probe for all rounds, and return the rounds for which it returns a complaint."""
    told = ((k, probe(np.random.default_rng([seed, k]))) for k in range(rounds))
    return [Failure(k, what) for k, what in told if what]


def _wrong(name: str, found: object, expected: object) -> str:
    return "" if found == expected else f"{name} {found}, not {expected}"


def _is_box(solid: "b.Solid", like: "b.Solid") -> str:
    mesh = solid.to_mesh()
    return (
        _wrong("vertices, faces, parts", facts(mesh), BOX)
        or _wrong("open edges", open_edges(mesh.faces), [])
        or _wrong("equality with the original", solid.equals(like), True)
    )


def points_on_half_spaces(rounds: int, seed: int) -> list[Failure]:
    """Check that integer points on planes with integer normals are on the half-spaces' boundary."""

    def probe(rng: Rng) -> str:
        normal, point = rng.integers(-20, 21, 3), rng.integers(-50, 51, 3)
        if not normal.any():
            normal[2] = 1
        side = b.half_space(normal.tolist(), int(normal @ point))
        return _wrong("the point's side", side.classify([point.tolist()]).tolist(), [0])

    return failures(rounds, seed, probe)


def corner_of_a_box() -> list[Failure]:
    """Check that a box and a half-space through three of its corners intersect in a tetrahedron."""

    def probe(_: Rng) -> str:
        corners = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
        cut = b.box((1, 1, 1)) & b.half_space((1, 1, 1), 1)
        return _wrong("equality", cut.equals(b.Solid(*tetrahedron(corners))), True)

    return failures(1, 0, probe)


def glued_tetrahedra(rounds: int, seed: int) -> list[Failure]:
    """Check that two tetrahedra on one triangle unite to 5 vertices, 6 triangles and one part."""

    def probe(rng: Rng) -> str:
        shared, above = rng.uniform(-1, 1, (3, 3)), rng.uniform(-1, 1, 3)
        normal = np.cross(shared[1] - shared[0], shared[2] - shared[0])
        below = rng.uniform(-1, 1, 3)
        if np.dot(above - shared[0], normal) * np.dot(below - shared[0], normal) > 0:
            below -= 2 * np.dot(below - shared[0], normal) / np.dot(normal, normal) * normal
        order = rng.permutation(3)
        first = b.Solid(*tetrahedron([*shared, above]))
        second = b.Solid(*tetrahedron([*shared[order], below]))
        union = first | second
        total = first.volume_exact + second.volume_exact
        return _wrong("vertices, faces, parts", facts(union.to_mesh()), (5, 6, 1)) or _wrong(
            "volume", union.volume_exact, total
        )

    return failures(rounds, seed, probe)


def _turned_cube(rng: Rng, reach: float) -> "b.Solid":
    shape = turned(moved(cube(), (-0.5, -0.5, -0.5)), random_rotation(rng))
    return b.Solid(*moved(shape, rng.uniform(-reach, reach, 3)))


def parts_reunited(rounds: int, seed: int) -> list[Failure]:
    """Check that (A ∩ B) ∪ (A − B) is A, for cubes in general position."""

    def probe(rng: Rng) -> str:
        a, c = _turned_cube(rng, 0), _turned_cube(rng, 0.6)
        return _is_box((a & c) | (a - c), a)

    return failures(rounds, seed, probe)


def halves_reunited(rounds: int, seed: int) -> list[Failure]:
    """Check that both parts of a cube on the sides of a random plane unite to the cube."""

    def probe(rng: Rng) -> str:
        a = _turned_cube(rng, 0)
        normal, offset = rng.normal(size=3), float(rng.uniform(-0.4, 0.4))
        normal /= np.linalg.norm(normal)
        side = b.half_space(tuple(normal.tolist()), offset)
        below, above = a & side, a - side
        return (
            _wrong("common part is empty", (below & above).is_empty, True)
            or _wrong("sum", below.volume_exact + above.volume_exact, a.volume_exact)
            or _is_box(below | above, a)
        )

    return failures(rounds, seed, probe)


def boxes_turned_together(rounds: int, seed: int) -> list[Failure]:
    """Check that two cubes with a common face, rotated together, unite to a box of 12 triangles."""

    def probe(rng: Rng) -> str:
        together = affine(random_rotation(rng), rng.uniform(-1, 1, 3))
        first, second = b.Solid(*cube()), b.Solid(*moved(cube(), (1, 0, 0)))
        union = first.transform(together) | second.transform(together)
        return _is_box(union, b.Solid(*cuboid((0, 0, 0), (2, 1, 1))).transform(together))

    return failures(rounds, seed, probe)


def half_of_turned_box(rounds: int, seed: int) -> list[Failure]:
    """Check that a 2 × 1 × 1 box minus its half, both rotated together, is its other half."""

    def probe(rng: Rng) -> str:
        together = affine(random_rotation(rng))
        whole, half = b.Solid(*cuboid((0, 0, 0), (2, 1, 1))), b.Solid(*cube())
        rest = whole.transform(together) - half.transform(together)
        return _is_box(rest, b.Solid(*moved(cube(), (1, 0, 0))).transform(together))

    return failures(rounds, seed, probe)


def cubes_at(far: float) -> list[Failure]:
    """Check the volumes of set operations on two overlapping unit cubes far from the origin."""

    def probe(_: Rng) -> str:
        a = b.Solid(*moved(cube(), (far, 0, 0)))
        c = b.Solid(*moved(cube(), (far + 0.5, 0.5, 0.5)))
        volumes = tuple(solid.volume_exact for solid in (a | c, a & c, a - c, a ^ c))
        expected = tuple(Fraction(n, 8) for n in (15, 1, 7, 14))
        faulty = [len(open_edges(solid.to_mesh().faces)) for solid in (a | c, a & c, a - c, a ^ c)]
        return _wrong("volumes", volumes, expected) or _wrong("open edges", faulty, [0] * 4)

    return failures(1, 0, probe)


def nearly_identical_cubes(rounds: int, seed: int) -> list[Failure]:
    """Check exact volumes of cubes that are at most some lattice steps apart."""

    def probe(rng: Rng) -> str:
        shift = rng.integers(-3, 4, 3) * 10.0 ** float(rng.integers(-11, -7))
        a, c = b.Solid(*cube()), b.Solid(*moved(cube(), shift))
        steps = [Fraction(abs(round(s * 1e9)), 10**9) for s in shift.tolist()]
        common = (1 - steps[0]) * (1 - steps[1]) * (1 - steps[2])
        found = ((a & c).volume_exact, (a | c).volume_exact, (a - c).volume_exact)
        return _wrong("volumes", found, (common, 2 - common, 1 - common))

    return failures(rounds, seed, probe)


def decimals_meet() -> list[Failure]:
    """Check that sums of decimals that are no doubles snap to one lattice point."""

    def probe(_: Rng) -> str:
        small = b.Solid(*cube(0.3)) | b.Solid(*moved(cube(0.3), (0.1 + 0.2, 0, 0)))
        first = b.Solid(*cuboid((0.0999 * 50, 0, 0), (0.0999 * 51, 1, 1)))
        second = b.Solid(*cuboid((0.0999 * 50 + 0.0999, 0, 0), (0.0999 * 52, 1, 1)))
        return (
            _wrong("0.3 beside 0.1 + 0.2", facts(small.to_mesh()), BOX)
            or _wrong("its volume", small.volume_exact, Fraction(54, 1000))
            or _wrong("multiples of 0.0999", facts((first | second).to_mesh()), BOX)
        )

    return failures(1, 0, probe)


def chains_of_cubes(rounds: int, length: int, seed: int) -> list[Failure]:
    """Check that chains of set operations on rotated cubes are closed and their volumes add up."""

    def probe(rng: Rng) -> str:
        solid = _turned_cube(rng, 0)
        for _ in range(length):
            other = _turned_cube(rng, 0.5)
            both, joined = solid & other, solid | other
            total = solid.volume_exact + other.volume_exact
            if both.volume_exact + joined.volume_exact != total:
                return "union and intersection do not add up"
            solid = joined if rng.random() < 0.5 else solid - other
            if loose := open_edges(solid.to_mesh().faces):
                return f"{len(loose)} open edges"
        return ""

    return failures(rounds, seed, probe)
