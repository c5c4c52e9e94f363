"""Constructions with known measures that other engines use as their test suite.

The cases are Manifold's boolean and sample tests; volumes, areas and topology follow from the
construction. Two wedges that meet in an edge or a point count as two parts here, whatever other
engines count.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

import pytest

import bspcsg as b
from support.checks import assert_sound
from support.shapes import (
    affine,
    cube,
    cuboid,
    moved,
    octahedron,
    prism,
    pyramid,
    regular_outline,
    tetrahedron,
)

TETRAHEDRON = [(-1, -1, 1), (-1, 1, -1), (1, -1, -1), (1, 1, 1)]


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> "b.Solid":
    """Return the box between two corners."""
    return b.Solid(*cuboid(low, high))


def tetra() -> "b.Solid":
    """Return the regular tetrahedron with edge 2√2."""
    return b.Solid(*tetrahedron(TETRAHEDRON))


def unit() -> "b.Solid":
    """Return the unit cube with a corner at the origin."""
    return b.Solid(*cube())


def mirrored() -> "b.Solid":
    """Return the difference of two mirrored boxes."""
    small = b.Solid(*cube()).scale((0.5, -1, 0.5))
    return unit().scale((1, -1, 1)) - small


def three_boxes() -> "b.Solid":
    """Return the union of three boxes with coplanar faces."""
    base = box((-0.6, -1, 0), (0.6, 0, 1))
    return base | box((-0.5, 0, 0.5), (0.5, 0.8, 1)) | box((-0.6, -0.1, 0), (0.6, 0, 0.5))


def corner() -> "b.Solid":
    """Return the tetrahedron at one corner of the unit cube."""
    return b.Solid(*tetrahedron([(0, 0, 0), (0, 1, 0), (1, 0, 0), (0, 0, 1)]))


def diamonds() -> "b.Solid":
    """Return a diamond over a diamond-shaped hole, with a wedge cut off: edges and points touch."""
    outer = b.Solid(*prism([(0, 2), (2, 0), (4, 2), (2, 4)], 0, 1))
    hole = [(1, 2), (2, 1), (3, 2), (2, 3)]
    ring = outer - b.Solid(*prism(hole, 0, 1))
    return (ring | b.Solid(*prism(hole, 1, 2))) - b.Solid(*prism([(1, 2), (2, 2), (2, 3)], 1, 2))


def octagonal_ring() -> "b.Solid":
    """Return an octagonal prism without a smaller, rotated one of the same height."""
    turn = 185 * 3.141592653589793 / 180
    inner = b.Solid(*prism(regular_outline(8, 0.8, turn), 0, 1))
    return b.Solid(*prism(regular_outline(8), 0, 1)) - inner


def two_columns() -> "b.Solid":
    """Return a cube without two shifted cubes, which leaves two columns."""
    return unit() - unit().translate(0.3, 0.3, 0) - unit().translate(-0.3, -0.3, 0)


def crossed_tetrahedra() -> "b.Solid":
    """Return two tetrahedra that touch with crossed edges."""
    quarter_turn = affine([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    return tetra().translate(0, 0, -1) | tetra().translate(0, 0, 1).transform(quarter_turn)


def block() -> "b.Solid":
    """Return the cube of side 2 about the origin."""
    return box((-1, -1, -1), (1, 1, 1))


def bump() -> "b.Solid":
    """Return an octahedron around the centre of the block's top."""
    return b.Solid(*moved(octahedron(), (0, 0, 1)))


def upright() -> "b.Solid":
    """Return the block shifted and then rotated so that it stands on z = 0."""
    quarter_turn = affine([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    return block().translate(0, 1, 0).transform(quarter_turn)


def vug() -> "b.Solid":
    """Return a block with a closed cavity."""
    return box((-2, -2, -2), (2, 2, 2)) - unit()


def square_ring() -> "b.Solid":
    """Return a square frame of height 1."""
    return box((-2, -2, 0), (2, 2, 1)) - box((-1, -1, 0), (1, 1, 1))


def pointed_ring() -> "b.Solid":
    """Return a square pyramid without a smaller one with the same apex."""
    return b.Solid(*pyramid(2, (0, 0, 1))) - b.Solid(*pyramid(1, (0, 0, 1)))


def sponge(depth: int) -> "b.Solid":
    """Return Menger's sponge: one cube minus three combs of square holes."""
    holes = []
    for level in range(1, depth + 1):
        count, width = 3 ** (level - 1), Fraction(1, 3**level)
        for i in range(count):
            for j in range(count):
                u, v = (3 * i + 1) * width, (3 * j + 1) * width
                holes.append((u, v, width))
    # Thirds are no decimals: build at 3^depth times the size, where all corners are whole numbers.
    side = 3**depth
    combs = []
    for u, v, width in holes:
        low, high = (
            (int(u * side), int(v * side)),
            (int((u + width) * side), int((v + width) * side)),
        )
        combs.append(box((low[0], low[1], 0), (high[0], high[1], side)))
        combs.append(box((low[0], 0, low[1]), (high[0], side, high[1])))
        combs.append(box((0, low[0], low[1]), (side, high[0], high[1])))
    return box((0, 0, 0), (side, side, side)) - b.union(combs)


class Case(NamedTuple):
    """A construction and its expected measures; the Euler number is of all surfaces together."""

    build: Callable[[], "b.Solid"]
    volume: Fraction | float
    area: float | None
    euler: int
    parts: int


def _upper(solid: "b.Solid", height: float) -> "b.Solid":
    return solid - b.half_space((0, 0, 1), height)


def _lower(solid: "b.Solid", height: float) -> "b.Solid":
    return solid & b.half_space((0, 0, 1), height)


CASES = {
    "tetra": Case(
        lambda: tetra().translate(0.5, 0.5, 0.5) - tetra(), Fraction(129, 64), 16.56273585, 2, 1
    ),
    "mirrored": Case(mirrored, Fraction(3, 4), 11 / 2, 2, 1),
    "cubes": Case(three_boxes, Fraction(8, 5), 9.2, 2, 1),
    "selfsub": Case(lambda: unit() - unit(), Fraction(0), 0, 0, 0),
    "corner": Case(lambda: corner() - corner(), Fraction(0), 0, 0, 0),
    "perturb1": Case(diamonds, Fraction(15, 2), 38.21320344, 2, 2),
    "coplanar": Case(octagonal_ring, 1.018233765, 13.05775038, 0, 1),
    "multicoplanar": Case(two_columns, Fraction(9, 50), 2.76, 4, 2),
    "faceunion": Case(lambda: unit() | unit().translate(1, 0, 0), Fraction(2), 10, 2, 1),
    "edgeunion": Case(lambda: unit() | unit().translate(1, 1, 0), Fraction(2), 12, 4, 2),
    "edgeunion2": Case(crossed_tetrahedra, Fraction(16, 3), 27.71281292, 4, 2),
    "cornerunion": Case(lambda: unit() | unit().translate(1, 1, 1), Fraction(2), 12, 4, 2),
    "split_in": Case(lambda: block() & bump(), Fraction(2, 3), 5.464101615, 2, 1),
    "split_out": Case(lambda: block() - bump(), Fraction(22, 3), 25.46410162, 2, 1),
    "plane_below": Case(lambda: _lower(upright(), 1), Fraction(4), 16, 2, 1),
    "plane_above": Case(lambda: _upper(upright(), 1), Fraction(4), 16, 2, 1),
    "vug": Case(vug, Fraction(63), 102, 4, 2),
    "vug_cut": Case(lambda: _upper(vug(), -1), Fraction(47), 86, 4, 2),
    "donut": Case(square_ring, Fraction(12), 48, 0, 1),
    "cone": Case(pointed_ring, Fraction(4), None, 2, 1),
    "sponge1": Case(lambda: sponge(1), Fraction(20), None, 2 - 2 * 5, 1),
    "sponge2": Case(lambda: sponge(2), Fraction(400), None, 2 - 2 * 81, 1),
    "sponge3": Case(lambda: sponge(3), Fraction(8000), None, 2 - 2 * 1409, 1),
}


@pytest.mark.parametrize("name", CASES)
def test_measures_and_topology(name: str) -> None:
    case = CASES[name]
    solid = case.build()
    mesh = assert_sound(solid)
    if isinstance(case.volume, Fraction):
        assert solid.volume_exact == case.volume
    else:
        assert float(solid.volume_exact) == pytest.approx(case.volume, rel=1e-8)
    if case.area is not None:
        assert mesh.area == pytest.approx(case.area, rel=1e-8)
    assert (mesh.euler_number, mesh.surface_count) == (case.euler, case.parts)
    assert solid.genus == case.parts - case.euler // 2


@pytest.mark.deep
@pytest.mark.timeout(1800)
def test_sponge_of_depth_four_and_its_diagonal_cut() -> None:
    whole = sponge(4)
    assert whole.volume_exact == 20**4
    assert whole.genus == 26433
    # The plane goes through corners of all levels.
    diagonal = b.half_space((1, 1, 1), 1.5 * 81)
    for half in (whole & diagonal, whole - diagonal):
        mesh = assert_sound(half)
        assert half.volume_exact == Fraction(20**4, 2)
        assert mesh.genus == 13394


def test_the_halves_of_a_cut_add_up() -> None:
    whole = block()
    assert (whole & bump()).volume_exact + (whole - bump()).volume_exact == whole.volume_exact
    assert ((whole & bump()) | (whole - bump())).equals(whole)


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (lambda: b.sphere(0), "radius"),
        (lambda: b.cylinder(0, 5), "height"),
        (lambda: b.cube(0), "side"),
        (lambda: b.box((-1, 1, 1)), "negative side"),
        (lambda: b.extrude([(0, 0), (1, 0), (0, 1)], 0), "height"),
        (lambda: b.extrude([], 1), "no outline"),
        (lambda: b.cube(float("nan")), "not a number"),
    ],
)
def test_a_parameter_that_makes_no_solid_is_an_error(
    make: Callable[[], "b.Solid"], why: str
) -> None:
    with pytest.raises(b.BspcsgError) as caught:
        make()
    assert caught.value.code, why
