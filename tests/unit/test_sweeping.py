"""Sweeps, pipes, lofts and paths: known volumes, topology, and refusals."""

import math
from typing import Any, cast

import numpy as np
import pytest
from manifold3d import Manifold

import bspcsg as b

SQUARE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
PLATE = [(-1, -0.2), (1, -0.2), (1, 0.2), (-1, 0.2)]
ELBOW = [(0, 0, 0), (10, 0, 0), (10, 10, 0)]


def knot(count: int) -> Any:
    t = np.linspace(0, 2 * np.pi, count + 1)
    x, y = np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t)
    return 5 * np.column_stack([x, y, -np.sin(3 * t)])


def test_a_straight_sweep_is_the_extrusion() -> None:
    path = [(0, 0, 0), (0, 0, 5), (0, 0, 10)]
    assert b.sweep(SQUARE, path) == b.extrude(SQUARE, 10)
    assert b.sweep(SQUARE, path, scale=0.5) == b.extrude(SQUARE, 10, scale=0.5)
    twisted = b.sweep(SQUARE, path[::2], twist=90)
    assert twisted.volume == pytest.approx(b.extrude(SQUARE, 10, twist=90).volume, rel=1e-9)


def test_twists_turn_as_those_of_extrusions_do() -> None:
    flag = [(0, 0), (3, 0), (3, 1), (0, 1)]
    both = [b.sweep(flag, [(0, 0, 0), (0, 0, 1)], twist=60), b.extrude(flag, 1, twist=60, slices=6)]
    assert (both[0] ^ both[1]).volume < 0.05 * both[1].volume


def test_mitred_corners_keep_the_section() -> None:
    # A quadratic bar along the middle of its corners has the volume of section times length.
    assert b.sweep(SQUARE, ELBOW).volume == 80
    skew = b.sweep(SQUARE, [(0, 0, 0), (10, 0, 0), (18, 6, 0), (18, 6, 9)])
    assert skew.volume == pytest.approx(4 * (10 + 10 + 9), rel=1e-9)
    assert skew.slice(5, (1, 0, 0)).area == pytest.approx(4, rel=1e-9)


def test_closed_paths_close_without_a_seam() -> None:
    ring = b.sweep(SQUARE, [(0, 0, 0), (9, 0, 0), (9, 9, 0), (0, 9, 0), (0, 0, 0)])
    assert (ring.volume, ring.genus) == (4 * 36, 1)
    tied = b.sweep(SQUARE, knot(120))
    assert tied.genus == 1 and tied.to_mesh().certificate.ok
    assert len(tied.vertices) == 120 * 4


def test_a_band_with_half_a_twist_is_moebius_s() -> None:
    circle = b.helix(10, 0, 1, segments=384)
    band = b.sweep(PLATE, circle, twist=180)
    assert band.genus == 1
    assert band.volume == pytest.approx(0.8 * 20 * math.pi, rel=0.01)
    with pytest.raises(b.InvalidParameterError, match="return to its initial orientation"):
        b.sweep(PLATE, circle, twist=90)
    with pytest.raises(b.InvalidParameterError, match="return to its initial orientation"):
        b.sweep(PLATE, circle, scale=0.5)


def test_a_fixed_frame_stays_upright_on_a_helix() -> None:
    path = b.helix(10, 4, 3, segments=64)
    coil = b.sweep(SQUARE, path, frame="fixed")
    assert coil.volume == pytest.approx(4 * 3 * math.hypot(20 * math.pi, 4), rel=0.01)
    assert coil.bounds is not None
    assert coil.bounds[1, 2] == pytest.approx(12 + math.cos(math.atan2(4, 20 * math.pi)), abs=1e-3)


def test_what_crosses_itself_is_united() -> None:
    path = [(0, 0, 0), (20, 0, 0), (20, 10, 0), (10, 10, 0), (10, -10, 0)]
    crossing = b.sweep(SQUARE, path)
    legs = [
        b.sweep(SQUARE, path[:4]),
        b.box((2, 21, 2)).translate(9, -10, -1),
    ]
    assert crossing == legs[0] | legs[1]
    assert crossing.genus == 1


def test_tight_bends_lose_nothing_that_straight_parts_hold() -> None:
    bend = b.pipe([(-20, 0, 0), *np.pad(b.arc((0, 1), 1, -90, 0), ((0, 0), (0, 1))), (1, 20, 0)], 3)
    assert bend.genus == 0 and bend.volume > math.pi * 9 * 35
    assert bend.normalized().to_mesh().certificate.ok


@pytest.mark.parametrize("sign", [1, -1])
def test_functions_say_what_happens_along_the_way(sign: int) -> None:
    path = [(0, 0, 0), (0, 0, sign * 3)]
    waist = b.sweep(SQUARE, path, scale=lambda t: 1 + t * t, segments=128)
    exact = 4 * 3 * (1 + 2 / 3 + 1 / 5)
    assert waist.volume == pytest.approx(exact, rel=1e-4)
    assert b.sweep(SQUARE, path, twist=lambda t: 0 * t, segments=4) == b.sweep(SQUARE, path)
    assert b.sweep(SQUARE, path, scale=0).volume == 4


def test_pipes_are_hollow() -> None:
    pipe = b.pipe(ELBOW, 2, inner=1, segments=4)
    assert pipe.volume == pytest.approx(6 * 20) and pipe.genus == 1
    assert b.pipe([(0, 0), (3, 0)], 1, segments=4).volume == pytest.approx(6)


def test_empty_regions_sweep_nothing() -> None:
    assert b.sweep(b.Region.empty(), ELBOW).is_empty


@pytest.mark.parametrize(
    ("call", "word", "where"),
    [
        (lambda: b.sweep(SQUARE, [(0, 0, 0)]), "two different points", ()),
        (lambda: b.sweep(SQUARE, [(1, 1, 1)] * 4), "two different points", ()),
        (lambda: b.sweep(SQUARE, "ab"), "array of points", ()),
        (lambda: b.sweep(SQUARE, [(0, 0, math.nan), (1, 1, 1)]), "finite", ()),
        (lambda: b.sweep(SQUARE, [0, 1]), "shape", ()),
        (lambda: b.sweep(SQUARE, [(0, 0), (1, 0), (0, 0.01)]), "turns back", (1,)),
        (lambda: b.sweep(SQUARE, [(0, 0, 0), (0, 0, 1)], frame="fixed"), "vertical", (0, 1)),
        (lambda: b.sweep(SQUARE, ELBOW, frame=cast("Any", "other")), "frame must be", ()),
        (lambda: b.sweep(SQUARE, ELBOW, scale=-1), "scale", ()),
        (lambda: b.sweep(SQUARE, ELBOW, twist=math.inf), "twist", ()),
        (lambda: b.sweep(SQUARE, ELBOW, scale=lambda t: t[:2]), "one number for each number", ()),
        (lambda: b.sweep(SQUARE, ELBOW, scale=lambda t: math.nan * t), "finite", ()),
        (lambda: b.pipe(ELBOW, 1, inner=1), "smaller than its outer radius", ()),
        (lambda: b.pipe(ELBOW, 0), "above 0", ()),
        (lambda: b.helix(1, 1, 0), "turns", ()),
        (lambda: b.helix(1, turns=1), "lead must be a number", ()),
        (lambda: b.helix(-1, 1, 1), "above 0", ()),
        (lambda: b.spline([(0, 0)]), "2 points", ()),
        (lambda: b.spline([(0, 0), (1, 1), (1, 1)]), "are equal", (1,)),
        (lambda: b.spline([(0, 0), (1, math.inf)]), "finite", ()),
    ],
)
def test_what_is_no_sweep_is_refused(call: Any, word: str, where: tuple[int, ...]) -> None:
    with pytest.raises(b.InvalidParameterError, match=word) as caught:
        call()
    assert caught.value.where == where


def test_sizes_are_bounded() -> None:
    calls: list[Any] = [
        lambda: b.sweep(SQUARE, ELBOW, twist=1e9),
        lambda: b.helix(1, 1, 1e9),
        lambda: b.helix(1, 1, 1e300),
        lambda: b.spline([(0, 0), (1, 1)], segments=10**9),
        lambda: b.loft([(np.random.default_rng(1).random((3000, 2)), 0), (SQUARE * 1000, 1)]),
    ]
    for call in calls:
        with pytest.raises((b.LimitError, b.InvalidParameterError)):
            call()


# Paths


def test_helices_rise_and_turn_as_told() -> None:
    path = b.helix(5, 2, 2.5, segments=8)
    assert len(path) == 21 and path[0].tolist() == [5, 0, 0]
    assert np.allclose(np.hypot(path[:, 0], path[:, 1]), 5)
    assert path[-1].tolist() == [-5, 0, 5]
    assert path[1, 1] > 0 > b.helix(5, 2, -1)[1, 1]
    assert b.helix(5, 2, -1)[-1, 2] == 2
    cone = b.helix(5, 0, 1, r2=2)
    assert cone[-1].tolist() == [2, 0, 0]


def test_splines_pass_through_their_points_smoothly() -> None:
    given = np.array([(0, 0, 0), (10, 0, 5), (20, 5, 0), (20, 15, 2)])
    path = b.spline(given, segments=10)
    assert np.array_equal(path[::10], given)
    steps = np.diff(path, axis=0)
    steps /= np.linalg.norm(steps, axis=1)[:, None]
    assert (steps[1:] * steps[:-1]).sum(axis=1).min() > 0.9
    ring = b.spline([(0, 0), (4, 0), (4, 4), (0, 4)], closed=True, segments=8)
    assert np.array_equal(ring[0], ring[-1]) and len(ring) == 33
    # A quarter turn of the square turns the curve onto itself.
    assert np.allclose(ring[8:16, 0], 4 - ring[:8, 1]) and np.allclose(ring[8:16, 1], ring[:8, 0])


# Lofts


def test_lofts_of_two_points_and_squares() -> None:
    tip = [(0, 0, 3)]
    assert b.loft([(SQUARE, 0), tip]).volume == 4
    assert b.loft([tip, (SQUARE, 0)]).volume == 4
    assert b.loft([(SQUARE, 0), (SQUARE, 3)]) == b.extrude(SQUARE, 3)
    assert b.loft([(SQUARE, 3), (SQUARE, 0)]) == b.extrude(SQUARE, 3)
    spindle = b.loft([[(0, 0, -3)], (SQUARE, 0), tip])
    assert (spindle.volume, len(spindle.vertices)) == (8, 6)
    small = [(x / 2, y / 2) for x, y in SQUARE]
    assert b.loft([(SQUARE, 0), (small, 3)]) == b.extrude(SQUARE, 3, scale=0.5)


def test_a_square_goes_to_a_circle_symmetrically() -> None:
    duct = b.loft([(b.Region.rectangle(4, center=True), 0), (b.Region.circle(1, 64), 5)])
    mesh = duct.to_mesh()
    assert mesh.certificate.ok and duct.genus == 0
    assert len(mesh.faces) == 64 + 4 + 62 + 2
    # It is the hull of its ends, as they are convex and each corner of the square has a quarter.
    assert duct.volume == pytest.approx(Manifold.hull_points(duct.vertices).volume(), rel=1e-6)


def test_regions_begin_where_they_fit() -> None:
    straight = b.loft([(b.Region.circle(2, 60), 0), (b.Region.circle(2, 60), 3)])
    for turn in (6, 30, 90, 174):
        turned = b.Region.circle(2, 60).rotate(turn)
        body = b.loft([(b.Region.circle(2, 60), 0), (turned, 3)])
        assert body.volume == pytest.approx(straight.volume, rel=1e-6)


def test_holes_go_to_holes() -> None:
    round_, square = b.Region.circle(5) - b.Region.circle(4), b.Region.rectangle(12, center=True)
    duct = b.loft([(round_, 0), (square - b.Region.rectangle(10, center=True), 10)])
    assert duct.genus == 1 and duct.to_mesh().certificate.ok
    two = b.Region.circle(1).translate(-3, 0) | b.Region.circle(1).translate(3, 0)
    legs = b.loft([(two, 0), (two.rotate(20), 5)])
    assert legs.to_mesh().surface_count == 2


def test_closed_lofts_have_a_hole() -> None:
    angles = np.arange(12) * math.pi / 6
    places = [
        [(math.cos(a), 0, -math.sin(a), 0), (math.sin(a), 0, math.cos(a), 0), (0, 1, 0, 0)]
        for a in angles
    ]
    ring = b.Region.rectangle(2, center=True).translate(5, 0)
    tyre = b.loft([(ring, place) for place in places], closed=True)
    assert tyre.volume == pytest.approx(4 * 5 * 12 * math.sin(math.pi / 6), rel=1e-6)
    assert tyre.genus == 1


def test_loops_in_space_need_not_be_plane() -> None:
    saddle = [(2, 0, 1), (0, 2, 0), (-2, 0, 1), (0, -2, 0)]
    body = b.loft([saddle, [(x, y, z + 3) for x, y, z in saddle]])
    assert body.volume == pytest.approx(8 * 3)


@pytest.mark.parametrize(
    ("profiles", "word", "where"),
    [
        ([(SQUARE, 0)], "2 profiles", ()),
        ([], "2 profiles", ()),
        (3, "list of profiles", ()),
        ([(SQUARE, 0), (SQUARE, 0)], "has no volume", ()),
        ([(SQUARE, 0), [(0, 0, 1)], (SQUARE, 2)], "only for the first and last profile", (1,)),
        ([(SQUARE, 0), [(1, 2)]], "must be a pair", (1,)),
        ([(SQUARE, 0), ([], 1)], "no contour", ()),
        ([(b.Region.empty(), 0), (SQUARE, 1)], "empty", (0,)),
        ([(SQUARE, 0), (b.Region.circle(2) - b.Region.circle(1), 1)], "outlines and holes", (1,)),
        ([(SQUARE, 0), (SQUARE, math.nan)], "finite", ()),
        ([(SQUARE, 0), (SQUARE, np.zeros((4, 4)))], "row of a transform", ()),
        ([(SQUARE, 0), [(0, 0, 1), (1, 0, math.inf), (1, 1, 1)]], "finite", (1,)),
    ],
)
def test_what_is_no_loft_is_refused(profiles: Any, word: str, where: tuple[int, ...]) -> None:
    with pytest.raises(b.InvalidParameterError, match=word) as caught:
        b.loft(profiles)
    assert caught.value.where == where


# Found: sweeps along tiny or huge paths ended in a raw `ValueError`, and splines of huge ones in
# NaN.
@pytest.mark.parametrize("far", [1e-200, 1e200])
def test_paths_that_doubles_cannot_measure_are_refused(far: float) -> None:
    square = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    with pytest.raises(b.LimitError, match="too close together"):
        b.sweep(square, [(0, 0, 0), (far, 0, 0)])
    with pytest.raises(b.LimitError, match="too close together"):
        b.spline([(0, 0), (far, 0), (0, 1)])


def test_the_lead_of_a_helix_has_its_old_name() -> None:
    with pytest.warns(DeprecationWarning, match=r"use lead\.$") as warned:
        path = b.helix(5, pitch=2, turns=1)
    assert warned[0].filename == __file__
    assert (path == b.helix(5, lead=2, turns=1)).all()
