"""Solids made from solids: hulls, sums, cuts."""

from collections.abc import Callable
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg._types import FloatArray, IndexArray
from bspcsg.modelling.bodies import surface_sweep
from bspcsg.modelling.bodies.hulls import hull_of
from bspcsg.modelling.bodies.polyhedra import in_steps, in_units, polyhedron_of
from bspcsg.modelling.bodies.sums import convex_parts, is_convex
from bspcsg.modelling.bodies.surface_sweep import swept_mesh
from support.checks import assert_sound
from support.small import random_set, random_shapes


def corners(solid: b.Solid) -> set[tuple[float, ...]]:
    return set(map(tuple, solid.vertices.tolist()))


def frame() -> b.Solid:
    return b.box((4, 4, 1)) - b.box((2, 2, 1)).translate(1, 1, 0)


# Hulls


def test_a_hull_has_the_corners_of_its_input_and_encloses_it() -> None:
    rng = np.random.default_rng(1)
    for count in (4, 5, 30, 300):
        points = rng.normal(size=(count, 3)).round(rng.integers(1, 9))
        whole = b.hull(points)
        assert_sound(whole)
        assert corners(whole) <= set(map(tuple, points.tolist()))
        assert (whole.classify(points) >= 0).all() and whole.genus == 0


def test_a_hull_is_exact_where_points_lie_in_common_planes() -> None:
    grid = np.stack(np.meshgrid(*[np.arange(6) * 0.1] * 3), axis=-1).reshape(-1, 3)
    whole = b.hull(grid)
    assert whole == b.cube(0.5) and len(whole.vertices) == 8
    # A plane that no double coordinates hold exactly.
    slanted = [(x / 10, y / 10, (3 - x - y) / 10) for x in range(4) for y in range(4)]
    assert b.hull([*slanted, (0, 0, -1)]).volume_exact == b.hull(slanted, (0, 0, -1)).volume_exact
    assert b.hull(slanted).is_empty


def test_hulls_of_solids_points_and_lists_of_them() -> None:
    pair = [b.cube(1), b.cube(1).translate(0, 0, 4)]
    assert b.hull(pair) == b.hull(*pair) == b.hull(one for one in pair) == b.box((1, 1, 5))
    assert b.hull(frame()) == b.box((4, 4, 1))
    assert (
        b.hull([b.cube(1), (1, 1, 2)], (0, 0, 1)).volume_exact
        == b.hull(b.cube(1), [(1, 1, 2)]).volume_exact
    )


@pytest.mark.parametrize(
    "flat",
    [
        [],
        [(0, 0, 0)],
        [(0, 0, 0)] * 9,
        [(0, 0, 0), (1, 1, 1), (3, 3, 3), (2, 2, 2)],
        [(0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1, 1), (5, 5, 1)],
    ],
)
def test_what_is_flat_has_an_empty_hull(flat: Any) -> None:
    assert b.hull(flat).is_empty and b.hull().is_empty and b.hull(b.Solid.empty()).is_empty


@pytest.mark.parametrize(
    ("given", "kind", "code"),
    [
        (7, b.InvalidParameterError, "invalid_parameter"),
        ("abc", b.InvalidParameterError, "invalid_parameter"),
        ([(0, 0, 0, 0)] * 4, b.InvalidMeshError, "shape"),
        ([(0, 0, float("nan"))] * 4, b.InvalidMeshError, "non_finite"),
        ([(0, 0, 1e300), (0, 0, 0), (1, 0, 0), (0, 1, 0)], b.LimitError, "too_large"),
        (~b.cube(1), b.UnboundedError, "unbounded"),
    ],
)
def test_hulls_refuse(given: Any, kind: type[b.BspcsgError], code: str) -> None:
    with pytest.raises(kind) as caught:
        b.hull(given)
    assert caught.value.code == code


# Sums


def test_sums_of_boxes_are_boxes() -> None:
    assert b.minkowski(b.box((1, 2, 3)), b.box((0.1, 0.2, 0.3))) == b.box((1.1, 2.2, 3.3))
    assert b.minkowski(b.cube(1), b.cube(1).translate(5, 0, 0)) == b.cube(2).translate(5, 0, 0)
    assert b.minkowski(b.cube(1), b.Solid.empty()).is_empty
    assert b.minkowski(b.Solid.empty(), b.cube(1)).is_empty


def test_sums_of_what_is_not_convex() -> None:
    thick = b.minkowski(frame(), b.cube(0.5))
    assert thick == b.box((4.5, 4.5, 1.5)) - b.box((1.5, 1.5, 1.5)).translate(1.5, 1.5, 0)
    assert b.minkowski(b.cube(0.5), frame()) == thick


def test_complements_are_made_thinner() -> None:
    tool = b.box((1, 2, 1)).translate(-0.5, 0, 0)
    # All x at which the mirror image of the tool fits: from -2 to 0 in y.
    thin = ~b.minkowski(~b.cube(4), tool)
    assert thin == b.box((3, 2, 3)).translate(0.5, 2, 1)
    ring = ~b.minkowski(~frame(), b.cube(0.25, center=True))
    grown = b.box((2.25, 2.25, 1)).translate(0.875, 0.875, 0)
    assert ring == (b.box((3.75, 3.75, 0.75)).translate(0.125, 0.125, 0.125) - grown)
    assert (~b.minkowski(~b.cube(1), b.cube(2))).is_empty
    assert b.minkowski(b.Solid.full(), b.cube(1)) == b.Solid.full()


def test_sums_refuse_what_is_unbounded_or_too_large() -> None:
    with pytest.raises(b.UnboundedError):
        b.minkowski(b.half_space((0, 0, 1)), b.cube(1))
    with pytest.raises(b.UnboundedError):
        b.minkowski(b.cube(1), ~b.cube(1))
    far = b.sphere(10, segments=80) - b.cube(1)
    with pytest.raises(b.LimitError, match="neither solid is convex") as caught:
        b.minkowski(far, far)
    assert caught.value.code == "too_large"


def test_sums_refuse_what_would_take_all_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(surface_sweep, "_MAX_PIECE_FACES", 100)
    with pytest.raises(b.LimitError, match="choose solids with fewer faces") as caught:
        b.minkowski(frame(), b.cube(1))
    assert caught.value.code == "too_large"


# Found: sums of solids with more than 2 000 faces were refused.
def test_sums_of_many_faces() -> None:
    ball = b.hull(b.sphere(10, segments=80))
    sum_of_hollow = b.minkowski(ball - b.cube(2), b.cube(1))
    assert sum_of_hollow == b.minkowski(ball, b.cube(1)) - b.cube(1).translate(1, 1, 1)


def bodies(random: Random) -> list[b.Solid]:
    """Return a block with random boxes and tetrahedra added and removed, and a disc with a hole."""
    block = b.cube(4)
    for size in (1.5, 2, 3):
        at = [random.randint(-1, 3) for _ in range(3)]
        block = block | b.cube(size).translate(at)
        corners = [[random.randint(0, 5) for _ in range(3)] for _ in range(5)]
        block = block - b.hull(corners)
    ring = b.cylinder(h=1, r=2, segments=7) - b.cylinder(h=3, r=0.25, segments=5, center=True)
    return [solid for solid in (block, ring) if not solid.is_empty]


TOOLS = {
    "box": b.box(0.5, 0.25, 0.75, center=True),
    "far": b.box(0.5, 0.1, 0.3).translate(0.2, 0.4, -1),
    "ball": b.sphere(0.4, segments=8),
    "corner": b.hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]),
    "frame": frame(),
}


def on_lattice(solid: b.Solid, pitch: int) -> tuple[FloatArray, IndexArray]:
    mesh = solid.to_mesh()
    steps = np.rint(in_steps(mesh.vertices, pitch)).astype(np.int64)
    return in_units(steps, pitch), mesh.faces


def touched(corners: FloatArray, part: b.Solid, pitch: int) -> b.Solid:
    """Return the union of the sums of a convex tool with each of the triangles."""
    ends, _ = on_lattice(part, pitch)
    sums = (triangle[:, None] + ends for triangle in corners)
    return b.union(hull_of(np.round(each.reshape(-1, 3), -pitch), pitch) for each in sums)


# The mesh of all that the tool touches, against the sums of each triangle, one by one.
@pytest.mark.parametrize("tool", TOOLS)
@pytest.mark.parametrize("seed", range(3))
def test_sums_hold_what_the_tool_touches(seed: int, tool: str) -> None:
    parts = [b.hull(corners) for corners in convex_parts(TOOLS[tool])]
    for given in bodies(Random(seed)):
        pitch = min(given.pitch, TOOLS[tool].pitch)
        vertices, faces = on_lattice(given, pitch)
        solid = b.Solid.from_mesh((vertices, faces), pitch=pitch)
        larger, smaller = [], []
        for part in parts:
            rim, at = touched(vertices[faces], part, pitch), on_lattice(part, pitch)[0][0]
            larger.append(solid.translate(at) | rim)
            smaller.append(solid.translate(at) - rim)
        assert b.minkowski(solid, TOOLS[tool]) == b.union(larger)
        assert ~b.minkowski(~solid, TOOLS[tool]) == b.intersection(smaller)


def test_edges_without_length_and_faces_without_area_change_no_sum() -> None:
    plain = (b.cube(4) - b.cube(2)).to_mesh()
    ball = b.sphere(0.5, segments=8).to_mesh()
    points, ends = (np.rint(mesh.vertices * 1e6).astype(np.int64) for mesh in (plain, ball))
    a, c, d = plain.faces[0]
    # A corner in the middle of an edge for the face on one side only, and one corner twice.
    middle, twin = len(points), len(points) + 1
    more = np.vstack([points, (points[a] + points[c]) // 2, points[a]])
    faces = np.vstack(
        [
            plain.faces[1:],
            [(a, middle, d), (middle, c, d), (twin, c, middle), (a, twin, middle), (a, c, twin)],
        ]
    )
    tool = polyhedron_of(ends, ball.faces)
    sums = [
        b.Solid.from_mesh(swept_mesh(polyhedron_of(*mesh), tool), pitch=0)
        for mesh in ((points, plain.faces), (more, faces))
    ]
    assert sums[0] == sums[1]


# A solid whose corners all come to lie on a line, or in a point, on the lattice.
@pytest.mark.parametrize(("length", "highest"), [(7, 9), (0, 3)])
def test_specks_count_in_sums(length: int, highest: int) -> None:
    speck, box = b.cube(1).to_mesh(), b.cube(4, center=True).to_mesh()
    line = (np.arange(8) * length // 7)[:, None].repeat(3, axis=1)
    tool = polyhedron_of(box.vertices.astype(np.int64), box.faces)
    touched = b.Solid.from_mesh(swept_mesh(polyhedron_of(line, speck.faces), tool), pitch=0)
    assert touched.bounds is not None
    assert touched.bounds.tolist() == [[-2] * 3, [highest] * 3]
    assert touched > b.cube(4, center=True)


# Found: an offset inwards of a plate took a second for each hole.
def test_what_is_touched_grows_with_the_surface() -> None:
    ball = b.sphere(0.1, segments=8).to_mesh()
    tool = polyhedron_of(np.rint(ball.vertices * 1e6).astype(np.int64), ball.faces)
    counts = []
    for holes in (3, 6):
        drills = (b.prism(6, h=3, r=1).translate(4 * i, 0, 0) for i in range(holes))
        mesh = (b.box(4 * holes, 4, 2).translate(-2, -2, 0.5) - b.union(drills)).to_mesh()
        points = np.rint(mesh.vertices * 1e6).astype(np.int64)
        counts.append(
            [
                len(swept_mesh(polyhedron_of(points, f), tool)[1])
                for f in (mesh.faces, mesh.faces[:, ::-1])
            ]
        )
    (few, few_inside), (many, many_inside) = counts
    assert many < 2.1 * few and many_inside < 2.1 * few_inside and many_inside < many


# Cuts


def test_both_sides_of_a_plane_and_of_a_solid() -> None:
    whole = b.cube(2) - b.sphere(1, segments=8)
    below, over = whole.split((1, 1, 1), 2.5)
    assert (below | over) == whole and below.isdisjoint(over)
    assert over == whole.trim((1, 1, 1), 2.5) and below == whole.trim((-1, -1, -1), -2.5)
    inside, outside = whole.split(b.cube(1))
    assert inside == whole & b.cube(1) and outside == whole - b.cube(1)
    assert b.cube(1).split((0, 0, 1), 7)[1].is_empty


def test_parts_of_a_solid_the_largest_first() -> None:
    parts = [b.cube(side).translate(5 * side, 0, 0) for side in (1, 3, 2)]
    found = b.union(parts).decompose()
    assert [part.volume_exact for part in found] == [27, 8, 1]
    assert b.union(found) == b.union(parts)
    assert b.Solid.empty().decompose() == []
    one = b.cube(1)
    assert one.decompose() == [one]


# Found: `decompose` ended in an error, or returned empty parts, where a part is thinner than a
# step of the lattice.
@pytest.mark.sampled(4)
@pytest.mark.parametrize("seed", range(150))
def test_no_part_is_lost_on_a_coarse_lattice(seed: int) -> None:
    """Of parts thinner than a step of it rounding could leave nothing."""
    random = Random(seed)
    shapes = random_shapes(random)
    state = random.getstate()
    fine = random_set(random, [b.Solid(*shape) for shape in shapes])
    random.setstate(state)
    coarse = random_set(random, [b.Solid(*shape, pitch=0) for shape in shapes])
    parts = coarse.decompose()
    assert len(parts) == len(fine.decompose())
    assert not any(part.is_empty for part in parts)


@pytest.mark.parametrize(
    "verb",
    [
        lambda s: s.split((0, 0, 0), 1),
        lambda s: s.split((0, 0, 1), float("inf")),
        lambda s: s.split("w"),
        lambda s: s.trim((0, 0), 1),
        lambda s: s.trim((0, 0, float("nan"))),
        lambda s: s.rotate(30, z=30),
        lambda s: s.rotate(x="a"),
        lambda s: s.rotate(z=30, about=(0, 0)),
        lambda s: s.scale(0, about=(1, 1, 1)),
        lambda s: s.mirror((0, 0, 0), about=(1, 1, 1)),
    ],
)
def test_bad_parameters_are_refused(verb: Callable[[b.Solid], Any]) -> None:
    with pytest.raises(b.InvalidMeshError):
        verb(b.cube(1))


# Placing


# Found: `rotate(x=, y=, z=)` was missing.
def test_rotations_by_name() -> None:
    body = b.box((1, 2, 3))
    assert body.rotate(z=30) == body.rotate(30)
    assert body.rotate(x=10, y=20, z=30) == body.rotate((10, 20, 30))
    assert body.rotate() == body
    assert body.rotate(z=90, about=(1, 0, 0)) == body.translate(-1, 0, 0).rotate(90).translate(
        1, 0, 0
    )


def test_a_point_that_stays() -> None:
    body = b.cube(1)
    assert body.scale(3, about=(1, 1, 1)) == b.cube(3).translate(-2, -2, -2)
    assert body.mirror((1, 0, 0), about=(1, 0, 0)) == body.translate(1, 0, 0)
    assert body.scale(2, about=(0, 0, 0)) == b.cube(2)
    assert body.rotate(z=180, about=(0.5, 0.5, 0)).volume_exact == Fraction(1)


def test_places_that_meet() -> None:
    body = b.box((1, 2, 3)).translate(7, 8, 9)
    assert body.align(x="min", y="center", z="max") == b.box((1, 2, 3)).translate(0, -1, -3)
    assert body.align() == body and body.align(x="min", to=(7, 0, 0)) == body
    table = b.box((8, 8, 1))
    lamp = b.cube(2).align(x="center", y="max", z=("min", "max"), to=table)
    assert lamp == b.cube(2).translate(3, 6, 1)
    for bad in ({"x": "middle"}, {"y": 3}, {"z": ("min",)}, {"x": "min", "to": b.Solid.empty()}):
        with pytest.raises(b.InvalidParameterError):
            body.align(**bad)


# Offsets


def notch() -> b.Solid:
    return b.cube(10) - b.cube(5)


def test_flat_faces_move_by_the_offset() -> None:
    assert b.cube(4).offset(-1) == b.cube(2).translate(1, 1, 1)
    grown = b.cube(4).offset(1)
    assert_sound(grown)
    assert grown & b.box((2, 2, 99), center=True).translate(2, 2, 0) == b.box((2, 2, 6)).translate(
        1, 1, -1
    )
    assert b.cube(4).offset(0) == b.cube(4) and b.cube(1).offset(-0.5).is_empty
    assert b.cube(4).offset(1, segments=5) == b.cube(4).offset(1, segments=8)


@pytest.mark.parametrize("r", [0.25, 1])
def test_offsets_are_between_what_balls_allow(r: float) -> None:
    body = notch()
    grown, thin = body.offset(r, segments=8), body.offset(-r, segments=8)
    for made in (grown, thin):
        assert_sound(made)
    assert thin < body < grown
    dot = b.cube(0.001, center=True)
    far = [body.min_gap(dot.translate(p.round(9))) for p in grown.vertices[::5]]
    assert 0.9 * r < max(far) <= r
    # But for corners that were rounded to the lattice on the way.
    assert (thin.offset(r, segments=8) - body).volume < 1e-6
    assert (body - grown.offset(-r, segments=8)).volume < 1e-6
    assert (~body).offset(-r, segments=8) == ~grown


def test_round_edges() -> None:
    die = b.cube(10).rounded(1)
    assert_sound(die)
    assert (
        die < b.cube(10) and die.bounds is not None and die.bounds.tolist() == [[0] * 3, [10] * 3]
    )
    # Eight corners and twelve edges of a ball of radius one, but for the polyhedron.
    quarters = 12 * 8 * (1 - np.pi / 4) + 8 * (1 - np.pi / 6)
    assert 1000 - die.volume == pytest.approx(quarters, rel=0.1)
    filled = notch().rounded(1, segments=8, inside=True)
    assert notch() < filled and filled < b.cube(10)
    assert b.cube(1).rounded(0.6).is_empty


# Found: `offset(0)` did not check `segments`, and the error of `offset(1e-25)` named a mesh that
# nobody had given.
@pytest.mark.parametrize(
    "verb",
    [
        lambda s: s.offset(float("nan")),
        lambda s: s.offset("1"),
        lambda s: s.offset(1, segments=3),
        lambda s: s.offset(0, segments="x"),
        lambda s: s.offset(1e-25),
        lambda s: s.rounded(0),
        lambda s: s.rounded(-1),
    ],
)
def test_offsets_refuse(verb: Callable[[b.Solid], Any]) -> None:
    with pytest.raises(b.InvalidParameterError):
        verb(b.cube(1))
    with pytest.raises(b.LimitError):
        b.cube(1).offset(1, segments=1 << 20)
    with pytest.raises(b.UnboundedError):
        b.half_space((0, 0, 1)).offset(1)


# Found: sums and offsets filled small holes of large bodies in silence.
def test_small_holes_in_large_bodies_count() -> None:
    # By volume, the body is its hull but for a part in four thousand millions.
    block = b.cube(1000) - b.box(0.5, 0.5, 2).translate(500, 500, 999)
    within, past = [500.2, 500.2, 999.5], [500.2, 500.2, 998.5]
    assert b.minkowski(block, b.cube(0.01)).classify([within, past]).tolist() == [-1, 1]
    assert block.offset(0.01, segments=8).classify([within, past]).tolist() == [-1, 1]
    beside = [499.995, 500.2, 999.5]
    assert (
        block.classify([beside]) == 1 and block.offset(-0.01, segments=8).classify([beside]) == -1
    )
    groove = b.cube(1000) - b.box(1000, 0.01, 0.01).translate(0, 500, 999.99)
    assert b.minkowski(groove, b.cube(0.001)).classify([[5, 500.005, 999.9955]]) == -1


@pytest.mark.parametrize("seed", range(6))
def test_turned_and_cut_convex_bodies_are_convex(seed: int) -> None:
    turn = tuple(np.random.default_rng(seed).uniform(0, 360, 3))
    ball = b.sphere(3, segments=24).rotate(turn)
    for body in (
        ball,
        ball & b.half_space((1, 2, 3), 1.2345),
        b.cylinder(9, 2, segments=90).rotate(turn),
    ):
        assert is_convex(body)
