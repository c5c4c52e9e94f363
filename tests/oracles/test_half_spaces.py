"""Half-spaces against exact hyperplanes and points in fractions, without a lattice."""

import math
import random
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from support import drawn
from support.cli import Capture, put, ran
from support.planes import (
    Entry,
    Plane,
    corners,
    determinant,
    dot,
    entries,
    side,
    simplex_around,
    simplex_measure,
    vector,
)
from support.shapes import cuboid

STEP = Fraction(1, 10**9)

SMALL, DECIMALS = entries(20), entries(9999, 3)


def written(number: Fraction) -> bool:
    """Return true if a fraction is the shortest decimal of a double."""
    return Fraction(repr(float(number))) == number


def doubles(row: Sequence[Fraction]) -> list[float]:
    return [float(entry) for entry in row]


def half(plane: Plane) -> b.Solid:
    return b.half_space(doubles(plane[0]), float(plane[1]))


def solid_of(points: Sequence[Sequence[Any]]) -> b.Solid:
    """Return the tetrahedron with four given corners."""
    faces = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    edges = [[Fraction(x) - y for x, y in zip(p, points[0], strict=True)] for p in points[1:]]
    turned = faces if determinant(edges) > 0 else faces[:, ::-1]
    return b.Solid(np.array([doubles(p) for p in points]), turned)


def through(points: Sequence[Sequence[int]], inside: Sequence[int]) -> Plane:
    """Return the plane through three points, with a fourth point inside."""
    a = [Fraction(x) for x in points[0]]
    u, v = ([x - y for x, y in zip(p, a, strict=True)] for p in points[1:])
    normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    plane = normal, dot(normal, a)
    return plane if side(plane, [Fraction(x) for x in inside]) > 0 else turned(plane)


def turned(plane: Plane) -> Plane:
    return [-entry for entry in plane[0]], -plane[1]


def moved_by(solid: b.Solid) -> float:
    """Return the distance that a finding says a plane was moved, or 0 without a finding."""
    told = [found for found in solid.findings if found.code == "half_space_rounded"]
    words = " ".join(found.message for found in told).split()
    return float(words[words.index("most") + 1]) if told else 0.0


# Found: `half_space` was a plane other than that of its decimal numbers.
def test_the_unit_simplex() -> None:
    wanted = solid_of([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
    plane = b.half_space((1, 1, 1), 1)
    corner = b.box((1, 1, 1)) & plane
    assert corner.equals(wanted)
    assert corner.volume_exact == Fraction(1, 6)
    assert plane.classify([(1, 0, 0), (0.5, 0.25, 0.25), (0, 0, 1)]).tolist() == [0, 0, 0]
    assert corner.vertices.max() == 1


@pytest.mark.parametrize(
    ("normals", "points", "count"),
    [
        (SMALL, entries(50), 10_000),
        (entries(10**6), entries(10**6), 1000),
        (entries(10**9), entries(10**5), 1000),
        (DECIMALS, entries(9_999_999, 4), 1000),
        (entries(10**6, 9), entries(10**9, 9), 1000),
    ],
    ids=["small", "large", "larger", "decimals", "nine places"],
)
def test_points_on_planes(normals: Entry, points: Entry, count: int) -> None:
    beside = 0
    seeds = drawn(range(count), 3)
    for seed in seeds:
        rng = random.Random(seed)
        normal, point = vector(rng, normals), vector(rng, points)
        plane = normal, dot(normal, point)
        near = [[x + rng.randint(-1, 1) * STEP for x in point] for _ in range(3)]
        near = [p for p in near if all(map(written, p))]
        assert all(map(written, [*normal, *point, plane[1]]))
        found = half(plane).classify([doubles(p) for p in [point, *near]]).tolist()
        assert found == [0, *(side(plane, p) for p in near)]
        beside += sum(place != 0 for place in found)
    assert beside > len(seeds)


@pytest.mark.parametrize("size", [9, 1000, 10**5])
def test_tetrahedra_between_half_spaces(size: int) -> None:
    for seed in drawn(range(60), 3):
        rng = random.Random(size + seed)
        points = [[rng.randint(-size, size) for _ in range(3)] for _ in range(4)]
        volume = simplex_measure([[Fraction(x) for x in p] for p in points])
        if volume == 0:
            continue
        cut = b.box(2 * size + 2, center=True)
        for k, inside in enumerate(points):
            cut = cut & half(through(points[:k] + points[k + 1 :], inside))
        assert cut.equals(solid_of(points))
        assert cut.volume_exact == volume


WIDTHS = {
    "small": SMALL,
    "decimals": DECIMALS,
    "17 digits": entries(10**17, 16),
    "62 bits": entries(2**61 - 1),
    "106 bits": entries(2**104 - 1),
}


@pytest.mark.parametrize(
    ("dimension", "width"),
    # Lines have normals of at most 62 bits.
    [(d, w) for d in (1, 2, 3) for w in WIDTHS if (d, w) != (2, "106 bits")],
)
def test_simplices(dimension: int, width: str) -> None:
    """Lengths, areas and volumes are those of the hyperplanes that were asked for."""
    entry = WIDTHS[width]
    rng = random.Random(dimension)
    for _ in range(12):
        planes: list[Any] = simplex_around(rng, entry, dimension)
        common = bsp.ObjectTree.uniform(dimension, full=True)
        for normal, offset in planes:
            common = common & bsp.ObjectTree.half_space(normal, offset)
        assert common.measure == simplex_measure(corners(planes))
        if dimension == 3:
            solid = b.intersection(*(b.half_space(*plane) for plane in planes))
            assert solid.volume_exact == common.measure
            assert solid.findings == ()


#: Moves, and the rows of the affine maps they are.
MOVES: dict[str, tuple[Any, str]] = {
    "a shift": (
        lambda s: s.translate(0.1, -2.5, 0.007),
        "1 0 0 0.1, 0 1 0 -2.5, 0 0 1 0.007",
    ),
    "quarter turns": (
        lambda s: s.translate(0.3, 0, 0).rotate(90, "x").rotate(180, "z"),
        "-1 0 0 -0.3, 0 0 1 0, 0 1 0 0",
    ),
    "mirrors": (
        lambda s: s.mirror((0, 1, 0)).mirror((1, 1, 0)).mirror((0, 0, 1)),
        "0 1 0 0, -1 0 0 0, 0 0 -1 0",
    ),
    "a scale": (
        lambda s: s.scale((0.1, 3, -0.7)).translate(0.1, 0.2, 0.3),
        "0.1 0 0 0.1, 0 3 0 0.2, 0 0 -0.7 0.3",
    ),
    "a shear": (
        lambda s: s.transform([[1, 2, 0, 0.25], [0, 1, -3, 0], [1, 0, 1, 0.1]]),
        "1 2 0 0.25, 0 1 -3 0, 1 0 1 0.1",
    ),
    "a turn by odd angles": (
        lambda s: s.transform([[3, 4, 0, 1], [-4, 3, 0, 2], [0, 0, 5, 3]]).scale(0.2),
        "0.6 0.8 0 0.2, -0.8 0.6 0 0.4, 0 0 1 0.6",
    ),
}


@pytest.mark.parametrize(("move", "rows"), MOVES.values(), ids=MOVES)
def test_moved_half_spaces(move: Any, rows: str) -> None:
    """The images of points lie on the image's sides as the points did."""
    matrix = [[Fraction(entry) for entry in row.split()] for row in rows.split(",")]
    rng = random.Random(3)
    for _ in range(50):
        normal, point = vector(rng, DECIMALS), vector(rng, entries(99999, 3))
        plane = normal, dot(normal, point)
        points = [point, *([x + (i == k) for k, x in enumerate(point)] for i in range(3))]
        images = [[dot(row, [*p, Fraction(1)]) for row in matrix] for p in points]
        found = move(half(plane)).classify([doubles(p) for p in images]).tolist()
        assert found == [side(plane, p) for p in points]


def test_a_long_chain_of_moves_loses_nothing_that_shows() -> None:
    box, plane = b.cube(2, center=True), b.half_space((1, 2, 3), 0.5)
    volume = (box & plane).volume
    for _ in range(30):
        box, plane = box.rotate(17, (1, 2, 3)), plane.rotate(17, (1, 2, 3))
    part = box.translate(0, 0, 0) & (plane | b.Solid.empty())
    assert part.volume == pytest.approx(volume, rel=1e-8)
    assert 0 < moved_by(plane) < 1e-10


@pytest.mark.parametrize(
    ("normal", "offset"),
    [((1, 0, 0), 1 / 3), ((0, 2, 0), 1e-9), ((1, 1, 1), 0.1 + 0.2), ((3, 4, 0), 1e-13)],
)
def test_planes_off_the_lattice_say_how_far_they_were_moved(normal: Any, offset: float) -> None:
    plane = b.half_space(normal, offset) & b.box(3, center=True)
    steps = Fraction(repr(offset)) / STEP / math.gcd(*normal)
    length = Fraction(math.hypot(*normal)) / math.gcd(*normal)
    nearest = math.floor(steps + Fraction(1, 2))
    wanted = float(abs(steps - nearest) / length * STEP)
    assert 0 < wanted <= 0.5e-9
    assert moved_by(plane) == pytest.approx(wanted, rel=1e-3)


def test_half_spaces_alone_choose_a_finer_lattice() -> None:
    fine = b.half_space((1, 0, 0), 1.23456789012) & b.half_space((0, 3, 0), 0.3)
    assert fine.pitch == -11
    assert fine.findings == ()
    assert fine.classify([(1.23456789012, -1, 0), (1.23456789013, -1, 0)]).tolist() == [0, -1]
    assert b.half_space((1, 0, 0), 1 / 3).pitch == -9
    assert bsp.Region.half_plane((1, 0), 0.0123456789).pitch == -10


@pytest.mark.parametrize(
    "height", [1 / 3, 0.1 + 0.2, 1.2345678905, 0.0000000025, float(np.float32(0.1))]
)
def test_a_plane_at_a_coordinate_of_a_mesh_meets_its_face(height: float) -> None:
    """A plane that the lattice does not hold goes where the mesh's coordinates go."""
    box = b.box((1, 1, height))
    below = b.half_space((0, 0, 1), height)
    assert box <= below
    assert (box - below).is_empty
    assert (box & b.half_space((0, 0, -7), -7 * height)).is_empty
    assert not box.slice(height).is_empty


def test_planes_that_miss_every_lattice_are_refused() -> None:
    for normal, offset in [((1, 0, 0), 1e40), ((1, 1, 1), 1e40), ((1e-300, 0, 0), 1e300)]:
        with pytest.raises(b.LimitError) as raised:
            b.half_space(normal, offset).classify([(0, 0, 0)])
        assert raised.value.code == "too_large"
    with pytest.raises(b.LimitError):
        bsp.Region.half_plane((1, 0), 1e40)


@pytest.mark.parametrize("size", [1e8, 1e12, 1e30])
def test_planes_far_out_are_the_ones_that_were_asked_for(size: float) -> None:
    far = b.half_space((1, 0, 0), size)
    assert far.classify([(size, 0, 0), (size / 2, 0, 0), (1.25 * size, 0, 0)]).tolist() == [
        0,
        1,
        -1,
    ]
    slanted = b.half_space((1, 1, 1), size)
    assert slanted.classify([(size / 2, size / 4, size / 4), (size, 0, size / 8)]).tolist() == [
        0,
        -1,
    ]
    plane = bsp.Region.half_plane((1, 0), size)
    assert plane.classify([(size, 0), (0, 0), (1.25 * size, 0)]).tolist() == [0, 1, -1]
    # A corner of the lattice is farther out than its faces.
    assert (b.half_space((1, 1, 1), 2e7) & b.cube(1)).volume == 1


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_cuts_of_sets(dimension: int) -> None:
    for seed in drawn(range(200), 3):
        rng = random.Random(1000 * dimension + seed)
        normal, point = vector(rng, DECIMALS, dimension), vector(rng, DECIMALS, dimension)
        plane = normal, dot(normal, point)
        near = [[x + rng.randint(-1, 1) * STEP for x in point] for _ in range(3)]
        given = [point, *(p for p in near if all(map(written, p)))]
        rows = np.array([doubles(p) for p in given])
        inside = bsp.ObjectTree.half_space(doubles(normal), float(plane[1]))
        assert inside.classify(rows).tolist() == [side(plane, p) for p in given]
        whole = bsp.ObjectTree.uniform(dimension, full=True)
        minus, plus = whole.split(doubles(normal), float(plane[1]))
        assert minus.equals(inside)
        assert plus.classify(rows).tolist() == [-side(plane, p) for p in given]
        assert inside.split_case(doubles(normal), float(plane[1])) == "same"
        cut = inside.partitioned(doubles(normal), float(plane[1]))
        assert cut.equals(inside)


def test_first_cuts_of_sets() -> None:
    square = [[(0, 0), (2, 0)], [(2, 0), (2, 2)], [(2, 2), (0, 2)], [(0, 2), (0, 0)]]
    tree = bsp.ObjectTree(np.array(square, dtype=float), cuts=[((1, 1.5), 3.5)])
    assert tree.split_case((1, 1.5), 3.5) == "same"
    assert tree.split_case((-2, -3), -7) == "opposite"


# Found: `split`, `slice` and cuts of trees used a plane other than that of the given decimal
# numbers.
def test_sections() -> None:
    # The plane holds three corners of the box, and the section has no others.
    region = b.box(1).slice(1, (1, 1, 1))
    (corners,) = region.to_polygons()
    flat, slope = math.sqrt(1 / 2), math.sqrt(1 / 6)
    wanted = [(-flat, -slope), (flat, -slope), (0, 2 * slope)]
    assert sorted(corners.tolist()) == sorted(np.round(wanted, 9).tolist())
    assert region.equals(b.box(1).slice(0.1, (0.1, 0.1, 0.1)))
    assert region.equals(b.box(1).slice(normal=(1, 1, 1), origin=(0.3, 0.6, 0.1)))


def test_planes_of_the_command_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    put("box.ply", cuboid((0, 0, 0), (1, 1, 1)))
    split = ["split", "box.ply", "--no-check", "-o", "side-%.ply", "--plane"]
    code, _, said = ran(capsys, *split, "1,1,1,1")
    assert (code, said) == (0, "")
    assert b.load("side-1.ply").volume_exact == Fraction(1, 6)
    code, _, said = ran(capsys, *split, "0,0,1,0.12345678901")
    assert code == 0 and "note: box.ply: the plane" in said and "moved by at most 1.000e-11" in said
    code, _, said = ran(capsys, "slice", "box.ply", "-o", "x.svg", "--z", "0.12345678901")
    assert code == 0 and "note: box.ply: the plane" in said and "moved by at most 1.000e-11" in said


def test_halves_of_a_step_far_out() -> None:
    # Exactly 4503599629882812.5 steps, more than 2^52.
    far = 4503599.6298828125
    vertices, faces = (
        [(0, 0, 0), (far, 0, 0), (0, 1, 0), (0, 0, 1)],
        [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    )
    solid = b.Solid(vertices, faces, pitch=-9)
    assert solid.classify([(far, 0, 0)]).tolist() == [0]
    assert b.half_space((1, 0, 0), far).classify([(far, 0, 0)]).tolist() == [0]
