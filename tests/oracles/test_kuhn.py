"""Sets of Kuhn tetrahedra: results of operations against counts of cells, without geometry.

Corners, edges, planes and whole faces are shared at random. Shells are doubled, reversed and
nested, so that most winding numbers of a mesh are from -2 to 3. Corners of results are integers.
"""

import json
from collections.abc import Callable
from operator import and_, or_, sub, xor
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import bspcsg as b
from support import DEEP
from support.checks import assert_counts, assert_sound
from support.kuhn import (
    ORDERS,
    Cells,
    KuhnGrid,
    Random,
    Shell,
    areas_by_direction,
    reduced,
    tally,
)

OPERATIONS: list[Callable[[Any, Any], Any]] = [or_, and_, sub, xor]

RULES: dict[str, Callable[[Any], Any]] = {
    "positive": lambda numbers: numbers > 0,
    "nonzero": lambda numbers: numbers != 0,
    "even-odd": lambda numbers: numbers % 2 == 1,
}

#: The number of cubes along each axis.
SIDE = 3

SOME = pytest.mark.parametrize("seed", range(1000 if DEEP else 30))
MANY = pytest.mark.parametrize("seed", range(2000 if DEEP else 45))


class Operand(NamedTuple):
    """A solid and the cells inside it."""

    solid: b.Solid
    cells: Cells

    def with_other(self, merge: Callable[[Any, Any], Any], other: "Operand") -> "Operand":
        """Return the result of an operation; for cells, ``p - q`` is ``p & ~q``."""
        cells = self.cells & ~other.cells if merge is sub else merge(self.cells, other.cells)
        return Operand(merge(self.solid, other.solid), cells)


def random_frame(rng: Random) -> Any:
    """Return a matrix of small integers with a positive determinant; often the unit matrix."""
    frame = np.eye(3, dtype=np.int64)
    while rng.random() < 0.5 or np.linalg.det(frame) < 0.5:
        frame = rng.integers(-3, 4, (3, 3))
    return frame


def random_shells(rng: Random) -> list[Shell]:
    """Return a few shells, about a quarter of them reversed, and some more than once."""
    shells = []
    for _ in range(rng.integers(1, 7)):
        size = int(rng.integers(1, SIDE + 1))
        low = tuple(rng.integers(0, SIDE - size + 1, 3).tolist())
        order = None if rng.random() < 0.2 else ORDERS[rng.integers(6)]
        shell = Shell(low, size, order, bool(rng.random() < 0.25))
        shells += [shell] * (2 if rng.random() < 0.15 else 1)
    return shells


def random_operand(rng: Random, grid: KuhnGrid) -> Operand:
    """Return shells as one mesh, whose common vertices and opposite faces are joined or not."""
    shells = random_shells(rng)
    rule = rng.choice(["positive", *RULES])
    cells = RULES[rule](grid.winding_numbers(shells))
    faces = tally(shells)
    way = rng.choice(["apart", "welded", "reduced"])
    if way == "reduced":
        faces = reduced(faces)
    if not faces:
        return Operand(b.Solid.empty(), cells)
    mesh = grid.shells_apart(shells) if way == "apart" else grid.mesh(faces.elements())
    return Operand(b.Solid(*mesh, winding=rule), cells)


def random_expression(rng: Random, operands: list[Operand]) -> Operand:
    """Return all operands combined by random operations in a random order."""
    left = list(operands)
    while len(left) > 1:
        one, other = (left.pop(rng.integers(len(left))) for _ in range(2))
        left.append(one.with_other(OPERATIONS[rng.integers(4)], other))
    return left[0]


def scene(kind: int, seed: int, count: int) -> tuple[Random, KuhnGrid, list[Operand]]:
    """Return random operands in one grid."""
    rng = np.random.default_rng([kind, seed])
    grid = KuhnGrid(SIDE, random_frame(rng))
    return rng, grid, [random_operand(rng, grid) for _ in range(count)]


def assert_is(found: Operand, grid: KuhnGrid) -> None:
    """Assert that a solid has the cells: by volume, points, areas of all directions, and counts."""
    solid, cells = found
    assert 6 * solid.volume_exact == int(cells.sum()) * grid.six_volumes
    assert solid.classify(grid.centres).tolist() == np.where(cells, 1, -1).tolist()
    mesh = assert_sound(solid)
    assert np.array_equal(mesh.vertices, np.rint(mesh.vertices))
    areas = grid.areas(cells)
    assert areas_by_direction(mesh.vertices, mesh.faces) == areas
    area = sum(count * np.linalg.norm(normal) / 2 for normal, count in areas.items())
    assert solid.area == pytest.approx(area, rel=1e-12)
    assert_counts(solid, grid.counts(cells))


@pytest.mark.sampled(3)
@SOME
def test_meshes(seed: int) -> None:
    _, grid, (operand,) = scene(0, seed, 1)
    assert_is(operand, grid)


@pytest.mark.sampled(3)
@MANY
def test_pairs(seed: int) -> None:
    _, grid, (one, other) = scene(1, seed, 2)
    for merge in OPERATIONS:
        assert_is(one.with_other(merge, other), grid)


@pytest.mark.sampled(3)
@SOME
def test_chains(seed: int) -> None:
    rng, grid, (found, *others) = scene(2, seed, 8)
    for other in others:
        found = found.with_other(OPERATIONS[rng.integers(4)], other)
        assert_is(found, grid)


@pytest.mark.sampled(3)
@SOME
def test_expressions(seed: int) -> None:
    rng, grid, operands = scene(3, seed, 3 + 2 * (seed % 12))
    assert_is(random_expression(rng, operands), grid)


def made_anew(cells: Cells, grid: KuhnGrid) -> list[b.Solid]:
    """Return solids of the same cells, made in different ways."""
    shells = grid.shells_of(cells)
    if not shells:
        return [b.Solid.empty()]
    return [
        b.Solid(*grid.shells_apart(shells)),
        b.Solid(*grid.mesh(reduced(tally(shells)).elements())),
        b.union(b.Solid(*grid.mesh(shell.faces)) for shell in shells[::-1]),
    ]


@pytest.mark.sampled(10)
@SOME
def test_equal_sets_are_equal(seed: int) -> None:
    rng, grid, operands = scene(4, seed, 3)
    solid, cells = random_expression(rng, operands)
    solids = [solid, ~~solid, *made_anew(cells, grid)]
    assert all(one.equals(other) for one in solids for other in solids)
    counts = grid.counts(cells)
    for solid in solids:
        assert_counts(solid, counts)
    changed = cells.copy()
    changed[rng.integers(len(changed))] ^= True
    others = made_anew(changed, grid)
    assert not any(one.equals(other) for one in solids for other in others)


@pytest.mark.sampled(3)
@SOME
def test_counts_of_meshes(seed: int) -> None:
    _, grid, (operand,) = scene(0, seed, 1)
    cells = operand.cells
    if cells.any():
        _, surfaces, euler_number = grid.counts(cells)
        mesh = b.Solid(*grid.mesh(grid.walls(cells))).to_mesh()
        if grid.has_twin_edges(cells):
            assert mesh.surface_count >= surfaces and mesh.euler_number > euler_number
        else:
            assert (mesh.surface_count, mesh.euler_number) == (surfaces, euler_number)


@pytest.mark.xfail(
    strict=True,
    reason="where operands divide their contact edges differently, a union may have 5 parts, not 6",
)
def test_parts_do_not_depend_on_how_operands_divide_contact_edges() -> None:
    text = Path(__file__).with_name("divided_contact_edges.json").read_text("utf-8")
    case = json.loads(text)
    one, other = (b.Solid(np.array(m["vertices"], float), m["faces"]) for m in case["operands"])
    union = one | other
    counts = len(union.components), union.surface_count, union.euler_number
    assert counts == tuple(case["counts"])
