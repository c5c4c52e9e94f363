"""Offsets, hulls, simplification, warps and curves of regions."""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import Region

SQUARE = Region.rectangle(10, 10)
RING = SQUARE - Region.rectangle(6, 6).translate(2, 2)


# Offset


@pytest.mark.parametrize(
    ("join", "area"),
    [
        ("miter", 144.0),
        ("bevel", 144 - 4 * 0.5),
        # The corner of a square join is cut off at the distance one from the old corner.
        ("square", 144 - 4 * (math.sqrt(2) - 1) ** 2),
        ("round", 140 + 32 / 2 * math.sin(math.tau / 32)),
    ],
)
def test_joins_of_a_square(join: Any, area: float) -> None:
    assert SQUARE.offset(1, join).area == pytest.approx(area, abs=1e-8)


def test_an_offset_moves_holes_the_other_way() -> None:
    assert RING.offset(1, "miter") == Region.rectangle(12, 12).translate(-1, -1) - (
        Region.rectangle(4, 4).translate(3, 3)
    )
    assert RING.offset(-1, "miter").is_empty
    # Round corners of the hole leave what no circle reaches.
    assert RING.offset(-1).area == pytest.approx(4 - math.pi, rel=0.03)
    assert RING.offset(3.5, "miter").area == 17**2


def test_what_an_offset_leaves_as_it_is() -> None:
    for region in (SQUARE, Region.empty(), Region.full()):
        assert region.offset(0) == region
    assert Region.full().offset(1).is_full and Region.empty().offset(1).is_empty
    assert SQUARE.offset(-5, "miter").is_empty


def test_the_outside_grows_where_the_inside_shrinks() -> None:
    assert (~SQUARE).offset(1, "miter") == ~SQUARE.offset(-1, "miter")
    with pytest.raises(b.UnboundedError):
        Region.half_plane((1, 0)).offset(1)


def test_long_mitres_can_be_cut() -> None:
    needle = Region([(0, 0), (10, 0), (0, 1)])
    long, short = needle.offset(1, "miter"), needle.offset(1, "miter", miter_limit=2)
    assert long.bounds is not None and short.bounds is not None
    assert long.bounds[1, 0] > 30 and short.bounds[1, 0] < 12


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"delta": math.nan}, "delta must be a finite"),
        ({"delta": "a"}, "delta must be a number"),
        ({"join": "pointed"}, "join must be one of round, miter, square, bevel"),
        ({"segments": 2}, "segments"),
        ({"miter_limit": 0.5}, "miter_limit must be at least 1"),
        ({"delta": 1e300}, "too large for a region"),
    ],
)
def test_bad_offsets_are_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(b.BspcsgError, match=words):
        SQUARE.offset(**{"delta": 1, **given})


def test_arcs_beyond_all_measure_are_refused() -> None:
    comb = Region.compose(Region.rectangle(1, 1).translate(2 * k, 0) for k in range(100))
    with pytest.raises(b.LimitError, match="This offset would have"):
        comb.offset(0.1, segments=60_000)


# Hull


def test_a_hull_holds_what_it_is_of_and_no_more_corners() -> None:
    rng = np.random.default_rng(5)
    for _ in range(20):
        figure = Region.compose(
            Region.rectangle(*size).translate(*place)
            for size, place in zip(rng.random((4, 2)) + 0.1, rng.random((4, 2)) * 9, strict=True)
        )
        hull = figure.hull()
        assert figure <= hull and hull.hull() == hull
        [outline] = hull.exact_outlines
        corners = {corner for loop in figure.exact_outlines for corner in loop}
        assert set(outline) <= corners


def test_hulls_are_exact_where_doubles_are_not() -> None:
    # As doubles, (0.1, 0.1), (0.2, 0.2), (0.3, 0.3) are not on one line.
    figure = Region([[(0.9, 0.1), (0.3, 0.3), (0.2, 0.2), (0.1, 0.1)]])
    [outline] = figure.hull().exact_outlines
    tenth = Fraction(1, 10)
    assert set(outline) == {(tenth, tenth), (3 * tenth, 3 * tenth), (9 * tenth, tenth)}


# Found: each side of a turned grid got corners, beside it by rounding.
@pytest.mark.parametrize("size", [1e-7, 1 / 3, 1.0, 1e8])
def test_hulls_have_no_corners_that_rounding_makes(size: float) -> None:
    grid = np.array([(x, y) for x in range(9) for y in range(9)]) * size
    for turn in np.random.default_rng(1).uniform(0, 6, 20):
        c, s = np.cos(turn), np.sin(turn)
        turned = grid @ np.array([(c, s), (-s, c)])
        [outline] = b.hull(turned).to_polygons()
        assert len(outline) == 4
        assert np.sort(outline, axis=0) == pytest.approx(np.sort(turned[[0, 8, 72, 80]], axis=0))
        assert b.hull(turned[:9]).is_empty


def test_fine_arcs_keep_the_corners_that_they_need() -> None:
    turns = np.linspace(0, 2 * np.pi, 200_000, endpoint=False)
    ring = np.column_stack([np.cos(turns), np.sin(turns)])
    [outline] = b.hull(ring).to_polygons()
    assert 1000 < len(outline) < len(ring)
    # No corner that is left out lies farther outside than rounding, wherever it is.
    heights = [1 - (outline @ way).max() for way in ring[::1999]]
    assert max(heights) < 4e-9


def test_hulls_of_nothing_and_of_too_much() -> None:
    assert Region.empty().hull().is_empty
    with pytest.raises(b.UnboundedError):
        Region.full().hull()


def test_hulls_of_several_figures_and_of_points() -> None:
    left, right = SQUARE, SQUARE.translate(20, 0)
    assert b.hull(left, right) == b.hull([left, right]) == Region.rectangle(30, 10)
    assert b.hull(left, [(30, 0), (30, 10)]) == Region.rectangle(30, 10)
    assert b.hull([(0, 0), (4, 0), (0, 4), (1, 1)]).area == 8
    assert b.hull(np.zeros((0, 2))).is_empty and b.hull([(0, 0), (1, 1), (2, 2)]).is_empty
    with pytest.raises(b.InvalidParameterError, match="regions and points in the plane"):
        b.hull(SQUARE, b.cube(1))
    with pytest.raises(b.InvalidMeshError, match="not finite"):
        b.hull([(0, 0), (4, 0), (0, math.nan)])


def test_sums_of_regions() -> None:
    assert b.minkowski(SQUARE, Region.rectangle(1, 2)) == Region.rectangle(11, 12)
    # A frame thickened until its hole is gone.
    assert b.minkowski(RING, Region.rectangle(6, 6)) == Region.rectangle(16, 16)
    assert b.minkowski(RING, Region.rectangle(2, 2)).area == 144 - 16
    assert b.minkowski(SQUARE, Region.empty()).is_empty
    with pytest.raises(b.InvalidParameterError, match="two solids or two regions"):
        b.minkowski(SQUARE, b.cube(1))  # type: ignore[call-overload]
    with pytest.raises(b.UnboundedError):
        b.minkowski(SQUARE, Region.full())
    comb = Region.compose(Region.rectangle(1, 1).translate(2 * k, 0) for k in range(200))
    with pytest.raises(b.LimitError, match="40,000 pairs"):
        b.minkowski(comb, comb)


# Simplify


def distance(points: np.ndarray, loops: list[np.ndarray]) -> float:
    """Return the largest distance of the points from the outlines."""
    start = np.concatenate(loops)
    along = np.concatenate([np.roll(loop, -1, axis=0) for loop in loops]) - start
    offset = points[:, None] - start
    part = np.clip((offset * along).sum(-1) / (along**2).sum(-1), 0, 1)
    return float(np.linalg.norm(offset - part[..., None] * along, axis=-1).min(axis=1).max())


@pytest.mark.parametrize("tolerance", [0.01, 0.1, 0.5])
def test_simpler_outlines_stay_within_the_tolerance(tolerance: float) -> None:
    turn = np.linspace(0, math.tau, 400, endpoint=False)
    radius = 9 + np.sin(7 * turn) + 0.05 * np.sin(90 * turn)
    wavy = Region(np.column_stack([radius * np.cos(turn), radius * np.sin(turn)]))
    figure = wavy - Region.circle(3, 200)
    simple = figure.simplify(tolerance)
    before, after = figure.to_polygons(), simple.to_polygons()
    assert len(after) == 2 and sum(map(len, after)) < sum(map(len, before))
    assert distance(np.concatenate(before), after) <= tolerance * (1 + 1e-6)
    middles = [(loop + np.roll(loop, -1, axis=0)) / 2 for loop in after]
    assert distance(np.concatenate(middles), before) <= tolerance * (1 + 1e-6)
    assert {tuple(p) for loop in after for p in loop} <= {tuple(p) for loop in before for p in loop}


# Found: `Region.simplify` of a region that is unbounded on both sides ended in a RecursionError.
def test_what_simplifying_leaves_as_it_is() -> None:
    assert RING.simplify(0) == RING and RING.simplify(0.1) == RING
    assert Region.empty().simplify(1).is_empty and Region.full().simplify(1).is_full
    assert (~RING).simplify(0.1) == ~RING
    assert Region.rectangle(10, 0.1).simplify(1).is_empty
    with pytest.raises(b.UnboundedError):
        (Region.half_plane((7, 3)) | RING).simplify(1)
    with pytest.raises(b.InvalidParameterError):
        RING.simplify(-1)


# Warp


def test_a_warp_moves_corners() -> None:
    assert RING.warp(lambda p: p) == RING
    assert RING.warp(lambda p: p * (-1, 1)) == RING.mirror((1, 0))
    assert RING.warp(lambda p: p + (1, 2)) == RING.translate(1, 2)
    assert RING.warp(lambda p: p * 0).is_empty
    assert Region.empty().warp(lambda p: p).is_empty
    # Folded along x = 5, where either half covers the other.
    hexagon = Region([(0, 0), (5, -1), (10, 0), (10, 10), (5, 11), (0, 10)])
    assert hexagon.warp(lambda p: np.abs(p - (5, 0))).is_empty


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (lambda p: p[:2], r"that it is given, \(8, 2\)"),
        (lambda p: None, r"that it is given, \(8, 2\)"),
        (lambda p: "abc", r"that it is given, \(8, 2\)"),
        (lambda p: p / 0, "must return finite coordinates, but does not for the point"),
    ],
)
def test_bad_warps_are_refused(function: Callable[[Any], Any], words: str) -> None:
    with np.errstate(all="ignore"), pytest.raises(b.InvalidParameterError, match=words):
        RING.warp(function)


def test_errors_of_a_warp_are_the_callers() -> None:
    def fails(points: np.ndarray) -> np.ndarray:
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        RING.warp(fails)
    with pytest.raises(b.UnboundedError):
        Region.full().warp(lambda p: p)


# Parts and fill rules


def test_parts_come_with_their_holes() -> None:
    parts = (RING | Region.rectangle(2, 2).translate(4, 4)).decompose()
    assert [part.area for part in parts] == [64.0, 4.0]
    assert Region.compose(parts) == RING | Region.rectangle(2, 2).translate(4, 4)
    assert Region.compose([]).is_empty and Region.empty().decompose() == []


def test_the_negative_rule_takes_what_runs_clockwise() -> None:
    square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    assert Region(square, winding="negative").is_empty
    assert Region(square[::-1], winding="negative").area == 16
    with pytest.raises(b.InvalidParameterError, match="Unknown winding rule"):
        Region(square, winding="odd")  # type: ignore[arg-type]


# Curves


def test_arcs_keep_within_the_tolerance() -> None:
    for tolerance in (1.0, 0.1, 0.001):
        points = b.arc((3, 4), 5, 20, 310, tolerance=tolerance)
        assert np.allclose(np.hypot(*(points - (3, 4)).T), 5)
        middles = (points[1:] + points[:-1]) / 2
        assert (5 - np.hypot(*(middles - (3, 4)).T)).max() <= tolerance * (1 + 1e-12)
        # One chord fewer would be too few.
        fewer = len(points) - 2
        assert 5 * (1 - math.cos(math.radians(290) / fewer / 2)) > tolerance
    np.testing.assert_allclose(b.arc((0, 0), 1, 90, 0)[[0, -1]], [[0, 1], [1, 0]], atol=1e-15)
    assert len(b.arc((0, 0), 1, 5, 5)) == 2


def test_curves_keep_within_the_tolerance() -> None:
    for controls in ([(0, 0), (1, 5), (6, 0)], [(0, 0, 0), (9, 0, 1), (0, 9, 2), (5, 5, 5)]):
        fine = b.bezier(controls, tolerance=1e-6)
        for tolerance in (1.0, 0.1, 0.001):
            points = b.bezier(controls, tolerance=tolerance)
            assert points[0].tolist() == list(controls[0])
            assert points[-1].tolist() == list(controls[-1])
            start, along = points[:-1], np.diff(points, axis=0)
            offset = fine[:, None] - start
            part = np.clip((offset * along).sum(-1) / (along**2).sum(-1), 0, 1)
            away = np.linalg.norm(offset - part[..., None] * along, axis=-1).min(axis=1)
            assert away.max() <= tolerance
    assert b.bezier([(0, 0), (3, 4)]).tolist() == [[0, 0], [3, 4]]


@pytest.mark.parametrize(
    "call",
    [
        lambda: b.arc((0, 0), 0, 0, 90),
        lambda: b.arc((0, 0), 1, 0, math.inf),
        lambda: b.arc((0, 0), 1, 0, 90, tolerance=0),
        lambda: b.arc((0, 0), 1, 0, 90, tolerance=1e-30),
        lambda: b.arc((0,), 1, 0, 90),
        lambda: b.bezier([(0, 0)]),
        lambda: b.bezier([(0, 0)] * 33),
        lambda: b.bezier([(0, math.nan), (1, 1)]),
        lambda: b.bezier("abc"),
        lambda: b.bezier([(0, 0), (1e300, 0), (0, 0)]),
        lambda: b.bezier([(0, 0), (1, 0), (0, 0)], tolerance=-1),
    ],
)
def test_bad_curves_are_refused(call: Callable[[], Any]) -> None:
    with pytest.raises(b.BspcsgError):
        call()


# Shadows


def test_shadows_of_solids() -> None:
    assert b.cube(2).project() == Region.rectangle(2, 2)
    ring = b.torus(3, 1, segments=16, tube_segments=8)
    assert ring.project().area == pytest.approx(16 / 2 * math.sin(math.tau / 16) * (16 - 4))
    assert len(ring.project().outlines) == 2 and len(ring.rotate(90, "x").project().outlines) == 1
    stairs = b.box((1, 1, 5)) | b.box((2, 1, 1)).translate(0, 0, 9)
    assert stairs.project() == Region.rectangle(2, 1)
    assert b.Solid.empty().project().is_empty
    with pytest.raises(b.UnboundedError):
        b.half_space((0, 0, 1)).project()


def test_shadows_are_those_of_manifold() -> None:
    rng = np.random.default_rng(3)
    for _ in range(10):
        solid = b.cylinder(3, 1, segments=7).rotate(rng.random(3) * 360) | b.cube(1)
        assert solid.project().area == pytest.approx(solid.to_manifold().project().area())
