"""Edges of solids, chamfers and fillets."""

import math
import pickle
from typing import Any, cast

import numpy as np
import pytest

import bspcsg as b
from bspcsg.modelling.making import blends

BOX = b.box(4, 3, 2)
STEP = b.box(4, 4, 2) - b.box(2, 2, 2).translate(2, 2, 0)
NOTCH = b.box(4, 4, 4) - b.box(2, 2, 5).translate(2, 2, 2)
STAR = b.loft([([(2, 0), (0.5, 0.5), (0, 2), (-0.5, 0.5), (-2, 0), (0, -0.5)], 0), [(0, 0, 3)]])
POST = b.box(6, 6, 1).translate(-3, -3, -1) | b.box(2, 2, 3).translate(-1, -1, 0)
FLUSH = b.box(6, 6, 1) | b.box(2, 2, 3).translate(0, 2, 1)
TURNS = [(0, 0, 0), (90, 0, 180), (10, 20, 30), (0, 0, 45)]


def segment(steps: int) -> float:
    """Return the area between a square's corner and the chords of its arc of radius 1."""
    return 1 - steps / 2 * math.sin(math.pi / 2 / steps)


# Selections


def test_edges_of_a_box() -> None:
    edges = BOX.edges()
    assert len(edges) == 12 and edges.is_convex.all()
    assert np.allclose(edges.angle, 90)
    assert sorted(edges.length.tolist()) == [2] * 4 + [3] * 4 + [4] * 4
    assert [len(edges.parallel(axis)) for axis in ("x", "y", "z", (1, 1, 0))] == [4, 4, 4, 0]
    assert len(edges.parallel("x") | edges.where(lambda e: e.length > 2.5)) == 8
    top = edges.where(lambda e: e.middle[:, 2] == 2)
    assert len(top) == 4 and (top.ends[:, :, 2] == 2).all()
    assert np.allclose(np.abs((top.normals * top.direction[:, None]).sum(axis=2)), 0)
    assert repr(top) == "EdgeSelection(4 of 12, length 3 to 4)"
    assert repr(edges.where(np.zeros(12, bool))) == "EdgeSelection(0 of 12)"


def test_edges_run_on_where_triangles_meet_them() -> None:
    # The bar's top is flush with the block's, so that one of its edges is cut in two triangles'
    # sides and another ends at the block.
    part = b.box(4, 2, 2) | b.box(2, 2, 2).translate(4, 0, 0)
    assert len(part.edges()) == 12
    assert sorted(part.edges().length.tolist()) == [2] * 8 + [6] * 4
    holed = b.box(4, 4, 1) - b.cylinder(3, 1, segments=6).translate(2, 2, -1)
    edges = holed.edges()
    assert len(edges) == 12 + 18
    assert np.allclose(edges.where(lambda e: e.length < 1.1).angle.max(), 240)


def test_concave_edges_have_angles_above_180() -> None:
    edges = STEP.edges()
    (inner,) = np.flatnonzero(~edges.is_convex)
    assert edges.angle[inner] == pytest.approx(270) and len(edges) == 18
    assert (b.cone(3, 2, segments=4).edges().angle < 180).all()
    assert len(b.Solid.empty().edges()) == 0


def test_selections_say_what_is_wrong_with_conditions() -> None:
    edges = BOX.edges()
    for condition in (lambda e: e.length, [True], lambda e: True):
        with pytest.raises(b.InvalidParameterError, match="one bool"):
            edges.where(condition)
    with pytest.raises(b.InvalidParameterError, match="axis"):
        edges.parallel("w")
    with pytest.raises(b.InvalidParameterError, match="different solids"):
        edges | b.cube(1).edges()
    with pytest.raises(b.UnboundedError):
        b.half_space((0, 0, 1)).edges()


BORED = b.box(30, 20, 10) - b.cylinder(10, d=8).translate(15, 10, 0)


# Found: a fillet of the upright edges of a box with a bore took the facets of the bore, too.
@pytest.mark.parametrize("turn", TURNS)
def test_facets_of_a_bore_have_no_edges_between_them(turn: Any) -> None:
    part = BORED.rotate(turn)
    edges = part.edges()
    assert len(edges) == 12 + 64 and len(part.edges(all=True)) == 12 + 64 + 32
    upright = edges.filter(lambda e: np.isclose(e.length, 10))
    assert len(upright) == 4
    soft = part.fillet(upright, 3)
    assert part.volume - soft.volume == pytest.approx(4 * 9 * 10 * segment(8), rel=1e-6)
    assert (
        len(soft.faces()) == 7 + 4
        and len(BORED.fillet(BORED.edges().parallel("z"), 3).faces) == 272
    )


def test_edges_bend_by_more_than_the_angle() -> None:
    """Sides of a circle of twelve bend by 30 degrees, however the body is turned."""
    for turn in TURNS:
        assert len(b.cylinder(5, r=1, segments=12).rotate(turn).edges()) == 24
        assert len(b.cylinder(5, r=1, segments=11).rotate(turn).edges()) == 33
    assert len(b.cylinder(5, r=1, segments=12).edges(angle=29.9)) == 36
    assert len(b.box(1, 2, 3).edges(angle=91)) == 0


@pytest.mark.parametrize("turn", TURNS)
def test_faces_are_flat_ones_and_round_ones(turn: Any) -> None:
    part = BORED.rotate(turn)
    faces = part.faces()
    assert len(faces) == 7 and len(part.faces(all=True)) == 6 + 32
    assert faces.area.sum() == pytest.approx(part.area)
    (bore,) = faces.filter(~faces.is_flat)
    assert bore.area[0] == pytest.approx(32 * 8 * math.sin(math.pi / 32) * 10)
    assert not bore.normal.any() and np.allclose(np.linalg.norm(faces.normal, axis=1).sum(), 6)
    assert len(part.edges().on(bore)) == 64 and len(faces.on(part.edges().on(bore))) == 3
    assert len(part.edges(all=True).on(bore)) == 96
    assert np.allclose(bore.middle, b.Solid(part.vertices, part.faces).centroid)


def test_faces_of_round_bodies() -> None:
    assert [len(body.faces()) for body in (b.sphere(5), b.torus(5, 1), b.cylinder(3, 1))] == [
        1,
        1,
        3,
    ]
    # A plane face and the round edge beside it bend as little as facets do, but are not as wide.
    body = b.cube(20)
    soft = body.fillet(body.edges(), 2).faces()
    flat = soft.filter(soft.is_flat)
    assert len(soft) == 26 and len(flat) == 6 and np.allclose(flat.area, 16**2)
    assert len(b.Solid.empty().faces()) == 0 == len(b.Solid.empty().faces().group_by("z"))


def test_selections_are_sorted_and_grouped() -> None:
    for things in (BORED.edges(), BORED.faces()):
        heights = [float(one.middle[0, 2]) for one in things.sort_by("z")]
        assert heights == sorted(heights) and len(heights) == len(things)
        groups = things.group_by("z")
        assert sum(map(len, groups)) == len(things) and len(groups) == 3
        assert np.allclose(groups[-1].middle[:, 2], 10)
        by_function = things.group_by(lambda some: some.middle[:, 2])
        assert [len(group) for group in by_function] == [len(group) for group in groups]
        assert len(things.sort_by((0, 0, -2))[:3]) == 3
    assert [len(group) for group in BORED.edges().group_by("length")] == [64, 4, 4, 4]
    assert BORED.faces().sort_by("area")[-1].normal.tolist() in ([[0, 0, 1]], [[0, 0, -1]])
    assert sorted(BORED.edges().group_by("angle")[0].angle.round(9)) == [90.0] * 76


def test_selections_lie_in_planes_and_are_combined() -> None:
    edges, faces = BORED.edges(), BORED.faces()
    assert len(edges.on("z", 10)) == 4 + 32 and len(edges.on((0, 0, -2), -20)) == 4 + 32
    assert len(faces.on("x", 30)) == 1 and len(faces.on("x", 29)) == 0
    assert len(faces.parallel("z")) == 2 and len(faces.parallel((1, 1, 0))) == 0
    top = edges.on(faces.sort_by("z")[-1])
    assert len(top) == 36 and len(top & edges.parallel("x")) == 2 and len(edges - top) == 40
    assert len(faces.parallel("x") | faces.parallel("y")) == 4
    with pytest.raises(TypeError):
        edges | faces


def test_triangles_know_their_solid_until_something_is_made_of_them() -> None:
    triangles = BORED.faces
    assert (triangles == BORED.to_mesh().faces).all() and not triangles.flags.writeable
    made: list[Any] = [triangles[:4], triangles + 1, pickle.loads(pickle.dumps(triangles))]
    for array in made:
        with pytest.raises(b.InvalidParameterError, match="does not know its solid any more"):
            array()


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: BOX.edges(angle=180), "angle"),
        (lambda: BOX.edges(all=cast("Any", 7)), "all"),
        (lambda: BOX.faces(angle=-1), "angle"),
        (lambda: BOX.edges().sort_by("size"), "Unknown key 'size'; known are x, y, z, length"),
        (lambda: BOX.faces().group_by("length"), "known are x, y, z, area"),
        (lambda: BOX.edges().sort_by(lambda e: e.ends), "one finite number for each of the 12"),
        (lambda: BOX.edges().group_by(lambda e: e.length * math.inf), "finite"),
        (lambda: BOX.edges().on("z"), "offset"),
        (lambda: BOX.edges().on(BOX.faces(), 3), "offset can only be given with a normal"),
        (lambda: BOX.edges().on(STEP.faces()), "different solids"),
        (lambda: BOX.edges() & STEP.edges(), "different solids"),
    ],
)
def test_selections_refuse_what_makes_no_sense(call: Any, word: str) -> None:
    with pytest.raises(b.InvalidParameterError, match=word):
        call()
    with pytest.raises(b.UnboundedError):
        b.half_space((0, 0, 1)).normalized().edges()


# Chamfers


@pytest.mark.parametrize("turn", TURNS)
def test_a_box_without_its_edges(turn: Any) -> None:
    box, d = BOX.rotate(turn), 0.25
    part = box.chamfer(box.edges(), d)
    # Pairs of cut off wedges share a third of d³ at a corner, all three of them a quarter.
    expected = 24 - 4 * 9 * d**2 / 2 + 8 * (3 / 3 - 1 / 4) * d**3
    assert part.volume == pytest.approx(expected, abs=1e-7)
    assert part.genus == 0 and part.to_mesh().certificate.ok
    if turn in TURNS[:2]:
        assert part.volume_exact == pytest.approx(expected)
        assert len(part.edges()) == 24 + 24


def test_one_edge_and_two() -> None:
    edges = BOX.edges()
    upright = BOX.chamfer(edges.parallel("z"), 0.5)
    assert upright == b.extrude([(0.5, 0), (3.5, 0), (4, 0.5), (4, 2.5), (3.5, 3), (0.5, 3), (0, 2.5), (0, 0.5)], 2)  # fmt: skip  # noqa: E501
    two = edges.where(lambda e: (e.ends.max(axis=1)[:, 1:] == [3, 2]).all(axis=1))
    one = two.parallel("x")
    assert len(one) == 1
    assert BOX.chamfer(one, 0.5).volume == 24 - 4 / 8
    assert BOX.chamfer(edges.where(lambda e: e.length < 0), 1) == BOX


@pytest.mark.parametrize("turn", TURNS)
def test_a_reflex_corner_is_mitred(turn: Any) -> None:
    part = STEP.rotate(turn)
    edges, top = part.edges(), STEP.edges().middle[:, 2] == 2
    bevelled = part.chamfer(edges.where(top) if turn == TURNS[0] else _like(edges, STEP, turn), 0.5)
    d = 0.5
    # Five corners count twice, the reflex one is missing twice.
    expected = 24 - 16 * d**2 / 2 + 5 * d**3 / 3 - d**3 / 3
    assert bevelled.volume == pytest.approx(expected, abs=1e-7)
    assert bevelled.genus == 0 and bevelled.to_mesh().certificate.ok


def _like(edges: b.EdgeSelection, original: b.Solid, turn: Any) -> b.EdgeSelection:
    """Return the edges that were at height 2 before the rotation `turn`."""
    top = original.edges().where(lambda e: e.middle[:, 2] == 2)
    middles = [b.cube(2e-3, center=True).translate(m).rotate(turn) for m in top.middle.tolist()]
    near = b.union(middles)
    return edges.where(near.classify(edges.middle) > 0)


@pytest.mark.parametrize("turn", [TURNS[0], TURNS[2]])
def test_cutters_do_not_reach_past_short_neighbours(turn: Any) -> None:
    # The rim of a hole of 24 sides, each shorter than what its chamfer's mitres reach.
    bore = b.cylinder(9, 3, segments=24, center=True)
    plate = (b.box(20, 20, 5, center=True) - bore).rotate(turn)
    side = 6 * math.sin(math.pi / 24)
    rims = plate.edges().where(lambda e: np.abs(e.length - side) < 1e-6)
    assert len(rims) == 48
    low, high = (12 * r * r * math.sin(math.pi / 12) for r in (3, 3 + 0.5 / math.cos(math.pi / 24)))
    ring = 0.5 / 3 * (low + high + math.sqrt(low * high)) - 0.5 * low
    part = plate.chamfer(rims, 0.5)
    assert plate.volume - part.volume == pytest.approx(2 * ring, abs=1e-6)
    assert part.genus == 1 and part.to_mesh().certificate.ok


def test_concave_edges_are_filled() -> None:
    inner = STEP.edges().where(lambda e: ~e.is_convex)
    filled = STEP.chamfer(inner, 0.5)
    assert filled.volume == 24 + 2 / 8
    foot = POST.edges().where(lambda e: ~e.is_convex)
    assert len(foot) == 4
    plinth = POST.chamfer(foot, 0.5)
    # Four bars, and at the corners what their mitres leave: a third of a cube each.
    assert plinth.volume == pytest.approx(36 + 12 + 8 * 0.125 + 4 * 0.125 / 3)
    assert plinth.genus == 0 and plinth.to_mesh().certificate.ok


def test_a_pyramid_s_apex() -> None:
    pyramid = b.cone(3, 2, segments=4)
    steep = pyramid.edges().where(lambda e: e.ends[:, :, 2].max(axis=1) == 3)
    part = pyramid.chamfer(steep, 0.2)
    assert len(steep) == 4 and part.genus == 0 and part.to_mesh().certificate.ok
    apart = 4 * 0.2**2 / 2 * math.sin(math.radians(steep.angle[0])) * math.hypot(2, 3)
    assert 0.9 * apart < pyramid.volume - part.volume < apart
    with pytest.raises(
        b.InvalidParameterError, match=r"At \(0, 0, 3\) the corner cannot be rounded"
    ):
        pyramid.fillet(steep, 0.2)


# Fillets


@pytest.mark.sampled(3)
@pytest.mark.parametrize("segments", [4, 8, 12, 32])
@pytest.mark.parametrize("r", [0.25, 0.5, 0.9])
def test_a_box_without_edges_is_the_round_box(segments: int, r: float) -> None:
    round_ = BOX.fillet(BOX.edges(), r, segments)
    assert round_ == b.rounded_box((4, 3, 2), r, segments=segments)
    assert round_.to_mesh().certificate.ok


@pytest.mark.parametrize("turn", TURNS)
def test_turned_boxes_get_as_round(turn: Any) -> None:
    box = BOX.rotate(turn)
    round_ = box.fillet(box.edges(), 0.5, 16)
    expected = b.rounded_box((4, 3, 2), 0.5, segments=16)
    assert round_.volume == pytest.approx(expected.volume, abs=1e-6)
    assert (round_ ^ expected.rotate(turn)).volume < 1e-6
    assert round_.genus == 0 and round_.to_mesh().certificate.ok


def test_cavities_get_round_corners_too() -> None:
    hollow = b.cube(6, center=True) - b.box(4, 3, 2).translate(-2, -1.5, -1)
    inner = hollow.edges().where(lambda e: ~e.is_convex)
    ball = b.rounded_box((4, 3, 2), 0.5, segments=16).translate(-2, -1.5, -1)
    assert hollow.fillet(inner, 0.5, 16) == b.cube(6, center=True) - ball


def test_a_pocket_and_a_step() -> None:
    inner = STEP.edges().where(lambda e: ~e.is_convex)
    assert STEP.fillet(inner, 0.5).volume == pytest.approx(24 + 2 * segment(8) / 4, abs=1e-8)
    upright = POST.edges().parallel("z").where(lambda e: e.middle[:, 2] > 0)
    part = POST.fillet(upright, 0.5)
    assert part.volume == pytest.approx(48 - 4 * 3 * segment(8) / 4, abs=1e-7)
    pocket = b.box(6, 6, 3) - b.box(4, 4, 3).translate(1, 1, 1)
    corners = pocket.edges().where(lambda e: ~e.is_convex)
    assert len(corners) == 8
    soft = pocket.fillet(corners, 1, 8)
    assert soft.genus == 0 and soft.to_mesh().certificate.ok
    core = b.rounded_box((4, 4, 9), 1, segments=8).translate(1, 1, 1)
    assert soft == b.box(6, 6, 3) - core


def test_blunt_and_sharp_edges() -> None:
    for sides in (3, 5, 8):
        prism = b.prism(sides, 3, 2)
        part = prism.fillet(prism.edges(), 0.2, 16)
        assert part.genus == 0 and part.to_mesh().certificate.ok
        assert part.volume < prism.volume
        # The round body lies within the prism, and holds the prism that is smaller by the radius.
        assert part <= prism
    cylinder = b.cylinder(3, 2, segments=24)
    rim = cylinder.edges().where(lambda e: e.ends[:, :, 2].min(axis=1) == 3)
    part = cylinder.chamfer(rim, 0.3)
    assert len(rim) == 24 and part.genus == 0 and part.to_mesh().certificate.ok


def test_first_the_concave_edges_then_the_others() -> None:
    soft = STEP.fillet(STEP.edges().where(lambda e: ~e.is_convex), 0.5, 8)
    top = soft.edges().where(lambda e: (e.ends[:, :, 2] == 2).all(axis=1))
    assert len(top) == 6 + 2
    part = soft.chamfer(top, 0.25)
    assert part.genus == 0 and part.to_mesh().certificate.ok
    assert part.volume < soft.volume


def round_prism(area: float, perimeter: float, height: float, r: float) -> float:
    """Return the volume of the sum of a plate and a ball of radius r, in total `height` high."""
    middle = (area + perimeter * r + math.pi * r * r) * (height - 2 * r)
    rims = 2 * area * r + perimeter * math.pi * r * r / 2
    return middle + rims + 4 / 3 * math.pi * r**3


def flare(side: float, r: float) -> float:
    """Return the volume of a fillet between a square column with round edges and a plane."""
    z = (np.arange(1000) + 0.5) * r / 1000
    out = r - np.sqrt(r * r - (r - z) ** 2)
    perimeter = 4 * (side - 2 * r) + 2 * math.pi * r
    return float((perimeter * out + math.pi * out**2).mean() * r)


def test_all_edges_of_a_step_are_round_in_one_call() -> None:
    part = STEP.fillet(STEP.edges(), 0.25, 16)
    assert part.genus == 0 and part.to_mesh().certificate.ok
    # What is farther than r from the outline: its corner, filled in, is an arc of 2 r.
    inner = (4 - 2 * 0.25) ** 2 - 4 + 0.5**2 * (1 - math.pi / 4)
    around = 4 * (4 - 2 * 0.25) - 2 * 0.5 + 0.5 * math.pi / 2
    smooth = round_prism(inner, around, 2, 0.25)
    chords = 0.25**2 * (math.pi / 4 - 4 * math.sin(math.pi / 8) / 2)
    assert abs(part.volume - smooth) < chords * STEP.edges().length.sum()
    assert smooth < STEP.volume - 7 * STEP.edges().length.sum() * chords


def test_a_post_and_its_plate_are_round_in_one_call() -> None:
    part = POST.fillet(POST.edges(), 0.25, 16)
    assert part.genus == 0 and part.to_mesh().certificate.ok
    plate = round_prism(5.5**2, 4 * 5.5, 1, 0.25)
    # The lower half of a post of twice the height has no lower rim.
    post = round_prism(1.5**2, 4 * 1.5, 2 * 3, 0.25) / 2 + flare(2, 0.25)
    chords = 0.25**2 * (math.pi / 4 - 4 * math.sin(math.pi / 8) / 2)
    assert abs(part.volume - plate - post) < chords * POST.edges().length.sum()


# Found: a fillet of all edges of a boss with eight sides ended in an `IndexError`.
@pytest.mark.sampled(2)
@pytest.mark.parametrize("sides", [8, 16])
def test_a_boss_of_many_sides_and_its_plate_are_round_in_one_call(sides: int) -> None:
    boss = b.cylinder(6, r=5, segments=sides).translate((10, 10, 3))
    part = b.box(20, 20, 3) | boss
    smooth = part.fillet(part.edges(), 0.25, segments=16)
    assert 2 < part.volume - smooth.volume < 3
    left = smooth.edges(all=True)
    bend = np.abs(np.asarray(left.angle)[np.asarray(left.length) > 1e-3] - 180)
    assert bend.max() < 30
    assert smooth.genus == 0 and smooth.to_mesh().certificate.ok


def test_two_kinds_that_wait_for_each_other_are_taken_by_few() -> None:
    part = FLUSH.chamfer(FLUSH.edges(), 0.25)
    assert part.genus == 0 and part.to_mesh().certificate.ok
    convex, wide = FLUSH.edges().is_convex, FLUSH.edges().length
    signs = np.where(convex, -1, 1)
    # The corners matter in the third power of the size.
    assert part.volume == pytest.approx(
        FLUSH.volume + 0.25**2 / 2 * (signs * wide).sum(), abs=len(signs) * 0.25**3
    )
    assert part.volume != pytest.approx(FLUSH.volume - 0.25**2 / 2 * wide.sum(), abs=0.3)


@pytest.mark.parametrize("part", [STEP, POST], ids=["concave-first", "convex-first"])
def test_turned_parts_lose_as_much(part: b.Solid) -> None:
    turned = part.rotate(x=10, y=20, z=30)
    loss = part.volume - part.chamfer(part.edges(), 0.25).volume
    soft = turned.chamfer(turned.edges(), 0.25)
    assert soft.genus == 0 and soft.to_mesh().certificate.ok
    assert turned.volume - soft.volume == pytest.approx(loss, rel=1e-6)


# Found: `fillet` of convex and concave edges at once failed on turned bodies, where slivers
# parted plane faces.
@pytest.mark.sampled(3)
@pytest.mark.parametrize("turn", [(30, "x"), (17, "z"), (17, (1, 2, 3)), (40, (3, 1, 2))])
@pytest.mark.parametrize("part", [NOTCH, STEP, POST], ids=["notch", "step", "post"])
def test_turned_parts_become_as_round(part: b.Solid, turn: Any) -> None:
    turned = part.rotate(*turn)
    soft = turned.fillet(turned.edges(), 0.2, 8)
    assert soft.genus == 0 and soft.to_mesh().certificate.ok
    assert soft.volume == pytest.approx(part.fillet(part.edges(), 0.2, 8).volume, rel=1e-6)


def test_attributes_stay_where_both_kinds_are_blended() -> None:
    part = NOTCH.tagged(layer=1).rotate(17, (1, 2, 3))
    assert list(part.chamfer(part.edges(), 0.2).to_mesh().face_attributes) == ["layer"]


def test_blends_count_once_in_a_block() -> None:
    with b.union() as u:
        part = b.cube(2)
        part.chamfer(part.edges(), 0.25)
    assert u.solid.volume < 8


# Closed chains


def rims(part: b.Solid) -> b.EdgeSelection:
    """Return the short edges, which are around bores and bosses."""
    return part.edges().filter(lambda e: e.length < 2.9)


# Found: each of 132 edges around four bosses was evaluated twice, which made the call ten times
# slower.
@pytest.mark.parametrize("verb", ["fillet", "chamfer"])
@pytest.mark.parametrize("turn", [TURNS[0], TURNS[2]])
@pytest.mark.parametrize(
    "body",
    [
        b.box(20, 20, 3) - b.cylinder(9, 4, segments=24).translate(10, 10, -3),
        b.box(20, 20, 3) | b.cylinder(9, 4, segments=24).translate(10, 10, 0),
        b.box(20, 20, 3) - b.cylinder(9, r1=5, r2=3, segments=17).translate(10, 10, -3),
        b.box(20, 20, 3) - b.cylinder(9, 4, segments=12).translate(10, 10, 1),
    ],
    ids=["bore", "boss", "cone", "pocket"],
)
def test_closed_chains_are_one_tool(
    body: b.Solid, turn: Any, verb: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    part = body.rotate(turn)
    each = getattr(part, verb)(rims(part), 0.4)
    with monkeypatch.context() as patch:
        patch.setattr(blends, "closed_chains", lambda *_: [])
        apart = getattr(part, verb)(rims(part), 0.4)
    assert each.volume == pytest.approx(apart.volume, abs=1e-6)
    assert (each.genus, each.surface_count) == (apart.genus, apart.surface_count)
    assert each.to_mesh().certificate.ok and len(each.faces) <= 1.1 * len(apart.faces)
    monkeypatch.delattr(blends._Blend, "cutter")
    assert getattr(part, verb)(rims(part), 0.4).volume == each.volume


def test_chains_whose_corners_are_no_mirror_images_are_taken_edge_by_edge() -> None:
    """The rim of a bore that leans: its angle changes from edge to edge."""
    bore = b.cylinder(40, 3, segments=9, center=True).rotate(20, "x")
    plate = b.box(20, 20, 4, center=True) - bore
    part = plate.chamfer(rims(plate), 0.2)
    assert part.genus == 1 and part.to_mesh().certificate.ok
    chamfered = plate.volume - part.volume
    around = rims(plate)
    wedges = 0.2**2 / 2 * np.sin(np.radians(around.angle)) * around.length
    assert chamfered == pytest.approx(wedges.sum(), rel=0.05)


# Faces on which edges vanish

HOUSE = b.Region([(0, 0), (4, 0), (4, 3), (3.8, 4), (0, 4)])


# Found: `chamfer` of the outline of a text by 0.3 had no room, for its curves have short edges.
@pytest.mark.parametrize("turn", TURNS)
def test_edges_may_vanish_where_all_of_a_face_are_blended(turn: Any) -> None:
    for figure in (HOUSE, b.text("e", size=10), HOUSE - HOUSE.scale(0.3).translate(0.8, 0.8)):
        body = figure.extrude(2)
        top = body.edges(all=True).on("z", 2)
        flat = body.chamfer(top, 0.3)
        for z in (1.71, 1.8, 1.99):
            assert flat.slice(z).area == pytest.approx(
                figure.offset(1.7 - z, "miter").area, abs=1e-3
            )
        turned = body.rotate(turn)
        faces = turned.faces()
        rim = turned.edges(all=True).on(faces.filter(np.isclose(faces.area, figure.area))[-1])
        assert len(rim) == len(top)
        made = turned.chamfer(rim, 0.3)
        assert made.volume == pytest.approx(flat.volume, abs=1e-6)
        assert made.to_mesh().certificate.ok and made.surface_count == body.surface_count
        assert made.genus == body.genus


def test_fillets_where_edges_vanish_have_the_profile_of_their_arc() -> None:
    body = HOUSE.extrude(2)
    made = body.fillet(body.edges().on("z", 2), 1.2, 16)
    assert made.genus == 0 and made.to_mesh().certificate.ok and not made.findings
    for angle in (22.5, 45, 67.5):
        inside = 1.2 * (1 - math.cos(math.radians(angle)))
        height = 2 - 1.2 + 1.2 * math.sin(math.radians(angle))
        section = made.slice(height)
        assert section.area == pytest.approx(HOUSE.offset(-inside, "miter").area, abs=1e-6)
    # In the floor of a pocket, the other way round.
    block = b.box(6, 6, 4).translate(-1, -1, -1)
    pocket = block - body.translate(0, 0, 1)
    floor = pocket.edges().on("z", 1)
    filled = pocket.fillet(floor, 1.2, 16)
    mirrored = made.scale((1, 1, -1)).translate(0, 0, 3)
    assert filled.volume == pytest.approx((block - mirrored).volume, abs=1e-6)


@pytest.mark.parametrize("turn", TURNS[1:])
def test_turned_faces_on_which_edges_vanish_leave_no_skins(turn: Any) -> None:
    outline = [(-5.088, 0.456), (3.177, -0.55), (-1.566, 5.359), (-1.739, 4.877), (-2.357, 4.58)]
    body = b.Region([outline]).extrude(3)
    part = body.rotate(turn)
    faces = part.faces()
    area = body.faces().on("z", 3).area
    rim = part.edges(all=True).on(faces.filter(np.isclose(faces.area, area))[-1])
    made = part.fillet(rim, 0.75, 21)
    assert made.genus == 0 and made.surface_count == 1 and made.to_mesh().certificate.ok
    left = made.edges(all=True)
    assert np.abs(left.angle - 180)[left.length > 1e-2].max() < 179
    straight = body.fillet(body.edges(all=True).on("z", 3), 0.75, 21)
    assert made.volume == pytest.approx(straight.volume, abs=1e-6)


def test_blends_leave_something_of_each_part_of_a_face() -> None:
    bars = (b.box(9, 1, 2) | b.box(1, 9, 2)).edges().on("z", 2)
    with pytest.raises(b.InvalidParameterError, match="too small for a blend or offset"):
        (b.box(9, 1, 2) | b.box(1, 9, 2)).chamfer(bars, 0.6)


# Refusals


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: BOX.chamfer(BOX.edges(), 1.01), r"faces at \("),
        (lambda: BOX.chamfer(BOX.edges(), 5), "too small"),
        (lambda: BOX.chamfer(BOX.edges().parallel("x"), 1.01), "too small"),
        (lambda: BOX.fillet(BOX.edges(), 1.01), "too small"),
        (lambda: BOX.fillet(BOX.edges().parallel("x"), 1.01), "too small"),
        (lambda: STAR.chamfer(STAR.edges(), 0.1), "more than three convex and concave"),
        (
            lambda: FLUSH.fillet(FLUSH.edges(), 0.25),
            r"faces at \(1\.82222, 2\.01192, 4\)",
        ),
        (lambda: BOX.chamfer(STEP.edges(), 0.1), "another solid"),
        (lambda: BOX.chamfer(cast("Any", [0]), 0.1), "selection"),
        (lambda: BOX.chamfer(BOX.edges(), 0), "above 0"),
        (lambda: BOX.chamfer(BOX.edges(), math.nan), "finite"),
        (lambda: BOX.fillet(BOX.edges(), -1), "above 0"),
        (lambda: BOX.fillet(BOX.edges(), 0.1, 3), "at least 4"),
        (lambda: STAR.chamfer(STAR.edges().where(lambda e: e.is_convex), 0.1), "more than three"),
    ],
)
def test_where_there_is_no_room(call: Any, word: str) -> None:
    with pytest.raises(b.InvalidParameterError, match=word):
        call()


def test_a_hole_near_an_edge_leaves_no_room() -> None:
    plate = b.box(10, 10, 2) - b.cylinder(4, 1, segments=8).translate(2, 5, -1)
    edge = plate.edges().where(lambda e: (e.middle[:, [0, 2]] == [0, 2]).all(axis=1))
    assert len(edge) == 1
    assert plate.chamfer(edge, 0.9).volume == pytest.approx(plate.volume - 0.9**2 / 2 * 10)
    with pytest.raises(b.InvalidParameterError, match=r"faces at \(0, 5, 2\)") as caught:
        plate.chamfer(edge, 1.1)
    assert caught.value.where


def test_many_edges_are_refused() -> None:
    ball = b.sphere(10, segments=160)
    with pytest.raises(b.LimitError, match="edges are selected"):
        ball.chamfer(ball.edges(all=True), 1e-4)


# Found: blends of bodies that end near the end of the lattice were refused: their cutters reach
# beyond it.
@pytest.mark.sampled(3)
@pytest.mark.parametrize(("size", "pitch"), [(8, -15), (8e6, None), (8e9, None)])
def test_blends_at_the_end_of_the_lattice(size: float, pitch: int | None) -> None:
    """Cutters reach beyond it, and doubles are as coarse as its steps."""
    boss = b.box(8, 8, 2) | b.cylinder(4, 2, segments=8).translate(4, 4, 0)
    for small in (b.cube(8), boss):
        corners = small.vertices * (size / 8)
        large = b.Solid(corners, small.faces, pitch=pitch)
        for blend, radius in [("chamfer", 0.25), ("fillet", 0.2)]:
            wanted = getattr(small, blend)(small.edges(), radius).volume
            found = getattr(large, blend)(large.edges(), radius * size / 8).volume
            assert found / (size / 8) ** 3 == pytest.approx(wanted, rel=1e-8)


# Found: `chamfer` and `fillet` of edges that are blended in two stages dropped all attributes, if
# the body was turned.
@pytest.mark.parametrize("turn", [0, 17])
def test_attributes_follow_edges_that_are_blended_in_two_stages(turn: float) -> None:
    part = (b.box(4, 4, 4) - b.box(2, 2, 5).translate(2, 2, 2)).tagged(layer=1)
    turned = part.rotate(turn, (1, 2, 3))
    assert 1 in turned.chamfer(turned.edges(), 0.2).to_mesh().face_attributes["layer"]


# Found: blends that leave nothing of a face were refused.
@pytest.mark.parametrize("verb", ["fillet", "chamfer"])
@pytest.mark.parametrize("share", [1, 1 - 1e-10])
def test_blends_may_take_all_of_a_face(verb: str, share: float) -> None:
    for sides in (3, 4, 6):
        body, room = b.cylinder(h=5, r=2, segments=sides), 2 * math.cos(math.pi / sides)
        rim = body.edges().where(lambda e: (e.middle[:, 2] > 5 - 1e-9) & (e.direction[:, 2] < 0.5))
        full = getattr(body, verb)(rim, room * share)
        nearly = getattr(body, verb)(rim, room * (1 - 1e-6))
        assert full.volume == pytest.approx(nearly.volume, rel=1e-5)
        assert full.surface_count == 1 and full.to_mesh().certificate.ok
        with pytest.raises(b.InvalidParameterError, match="too small"):
            getattr(body, verb)(rim, room * 1.001)


def test_a_bar_of_full_rounds() -> None:
    bar = b.cube(4)
    upright = bar.edges().parallel("z")
    assert bar.chamfer(upright, 2).volume == pytest.approx(32)
    assert bar.fillet(upright, 2, segments=64).volume == pytest.approx(
        4 * 32 * 4 * math.sin(math.pi / 32), rel=1e-9
    )


@pytest.mark.parametrize("size", [(2, 2, 2), (2, 3, 4), (2, 2, 5)])
@pytest.mark.parametrize("verb", ["fillet", "chamfer"])
def test_blends_of_all_edges_may_take_all_of_some_faces(verb: str, size: tuple[int, ...]) -> None:
    body = b.box(*size).rotate((10, 20, 30))
    full, nearly = (getattr(body, verb)(body.edges(), room) for room in (1, 1 - 1e-6))
    assert full.volume == pytest.approx(nearly.volume, rel=1e-5)
    assert full.surface_count == 1 and full.to_mesh().certificate.ok
