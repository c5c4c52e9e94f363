"""Extrusions, hulls, sums, projections and offsets of scripts."""

import math
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg import csg
from bspcsg.bsp import Region
from support.scripts import moved, region, volume
from support.timing import seconds

# Sweeps and hulls


def test_straight_and_tapered_extrusions() -> None:
    assert volume("linear_extrude(height = 3, center = true) square(2);") == 12
    pyramid = "linear_extrude(height = 3, scale = 0) square(2, center = true);"
    assert volume(pyramid) == pytest.approx(4)
    assert csg.loads("linear_extrude(height = -3) square(2);").is_empty
    assert csg.loads("linear_extrude(height = 3) group();").is_empty


def test_turned_extrusions() -> None:
    ring = f"rotate_extrude({{}}$fn = 4) {moved(2, 0, 0)} square(1);"
    assert volume(ring.format("")) == pytest.approx(10)
    assert volume(ring.format("angle = 400, ")) == pytest.approx(10)
    assert volume(ring.format("angle = 90, ")) == pytest.approx(2.5)
    assert csg.loads(ring.format("angle = 0, ")).is_empty
    bounds = csg.loads(ring.format("angle = -90, ")).bounds
    np.testing.assert_array_equal(bounds, [[0, -3, 0], [3, 0, 1]])


def test_hulls() -> None:
    assert volume(f"hull() {{ cube(1); {moved(0, 0, 4)} cube(1); }}") == 5
    assert region(f"hull() {{ square(1); {moved(4, 0, 0)} square(1); }}").area == 5
    assert csg.loads("hull();").is_empty
    assert csg.loads("hull() { group(); cube(size = [0, 1, 1]); }").is_empty


def test_minkowski_sums() -> None:
    assert volume("minkowski() { cube(2); cube(1); cube(1); }") == 64
    assert region("minkowski() { square(2); square([1, 3]); }").area == 15
    corner = f"difference() {{ cube(4); {moved(1, 1, -1)} cube(9); }}"
    assert volume(f"minkowski() {{ {corner} cube(1); }}") == 5 * (25 - 9)


# Found: a Minkowski sum with an empty operand was empty.
@pytest.mark.parametrize(
    ("children", "expected"),
    [
        ("cube(2); cube(0);", 8),
        ("cube(0); cube(2);", 8),
        ("cube(2); group(); cube(1);", 27),
        ("cube(0);", 0),
        ("cube(0); sphere(0);", 0),
    ],
)
def test_minkowski_leaves_empty_solids_out(children: str, expected: float) -> None:
    assert volume(f"minkowski() {{ {children} }}") == expected


@pytest.mark.parametrize(
    ("children", "area"),
    [
        ("square(2);", 4),
        ("square(0);", 0),
        ("square(2); square(0);", 0),
        ("square(0); square(2);", 0),
        ("square(2); group();", 0),
        ("square(2); square(1); square(0);", 9),
        ("square(2); square(0); square(1);", 9),
    ],
)
def test_minkowski_in_the_plane_keeps_openscads_rule(children: str, area: float) -> None:
    assert region(f"minkowski() {{ {children} }}").area == area


# Found: an intersection of a solid and a plane figure was the solid.
@pytest.mark.filterwarnings("ignore::bspcsg.csg.CsgWarning")
def test_intersections_of_both_dimensions_are_empty() -> None:
    assert csg.loads("intersection() { cube(5); circle(2); }").is_empty
    assert region("intersection() { circle(2); cube(5); }").is_empty
    assert volume("difference() { cube(5); circle(2); }") == 125
    assert volume("union() { cube(5); circle(2); }") == 125
    with pytest.warns(csg.CsgWarning, match="partly 2D and partly 3D"):
        csg.loads("intersection() { cube(5); circle(2); }")


def test_minkowski_of_what_is_far_from_convex() -> None:
    ball = "difference() { sphere(r = 20, $fn = 80); cube(3); }"
    with pytest.raises(
        b.FormatError, match=r":1:1: minkowski\(\): neither solid is convex"
    ) as caught:
        csg.loads(f"minkowski() {{ {ball} {ball} }}")
    assert caught.value.code == "too_large"


# Found: `resize` of fewer than three sizes was refused.
def test_sizes() -> None:
    assert volume("resize(newsize = [4, 0, 0]) cube(2);") == 16
    assert volume("resize([4, 6]) cube(2);") == volume("resize([4, 6, 0]) cube(2);") == 48
    assert volume("resize([]) cube(2);") == volume("resize() cube(2);") == 8
    assert volume("resize(newsize = [4, 0, 0], auto = [0, 1, 0]) cube(2);") == 32
    assert volume("resize(newsize = [4, 0, 6], auto = true) cube(2);") == 4 * 6 * 6
    assert volume("resize(newsize = [2, 0, 0], auto = [1, 1, 1, 1]) cube(1);") == 8


# Found: `resize` of a plane figure with `auto` followed the size along z, and `auto` of four
# entries ended in a `ValueError`.
def test_sizes_in_the_plane_are_two() -> None:
    assert region("resize(newsize = [4, 6, 9]) square(2);").area == 24
    assert region("resize(newsize = [4, 0, 9], auto = true) square(2);").area == 16


def test_projections() -> None:
    ball = moved(0, 0, 3) + " cube(2, center = true);"
    assert region(f"projection() {ball}").area == 4
    assert region(f"projection(cut = true) {ball}").is_empty
    assert region("projection(cut = true) cube(2);").area == 4
    with pytest.warns(csg.CsgWarning, match="2D children are ignored"):
        assert csg.evaluate(csg.parse("projection() square(1);")) is None


def test_offsets() -> None:
    assert region("offset(delta = 1) square(2);").area == 16
    assert region("offset(delta = -0.5) square(2);").area == 1
    assert region("offset(delta = -5) square(2);").is_empty
    assert region("offset(r = 1, $fn = 4) square(2);").area == pytest.approx(4 + 8 + 2)
    with pytest.warns(csg.CsgWarning, match="3D children are ignored"):
        assert csg.evaluate(csg.parse("offset(r = 1) cube(1);")) is None


# Found: offsets of unions of rotated figures widened hairs that rounding had left.
@pytest.mark.parametrize("hair", [1e-5, 1e-4])
@pytest.mark.parametrize("around", ["union()", "group() union()", "union() { union()"])
def test_offsets_do_not_widen_what_six_digits_part(hair: float, around: str) -> None:
    parts = f"square(10); {moved(10 + hair, 0, 0)} square(10); {moved(5, 5, 0)} square(10);"
    figure = f"{around} {{ {parts} }}" + " }" * around.count("{")
    inner = region(f"offset(delta = -0.3) {{ {figure} }}")
    # Two rectangles, and 0.3 off all around.
    assert inner.area == pytest.approx(19.4 * 9.4 + 9.4 * 5, abs=2 * hair * 30)


def test_offsets_do_not_draw_out_what_six_digits_leave_over() -> None:
    sliver = "polygon([[0, 0], [20, 0], [0, 0.0002]]);"
    assert region(f"offset(delta = 0.5) {{ square(10); {sliver} }}").area == pytest.approx(
        121, abs=0.001 * 40
    )


def test_fine_figures_are_grown_as_they_are() -> None:
    ring = region("circle(r = 0.0005, $fn = 100);")
    grown = region("offset(delta = 0.0005) circle(r = 0.0005, $fn = 100);")
    assert grown.area == pytest.approx(4 * ring.area, rel=2e-3)
    assert len(grown.outlines[0].points) == 100


# Polish


def test_round_pens_have_openscads_corners(tmp_path: Path) -> None:
    line = '<path d="m 10,30 25,-20 25,20" fill="none" stroke="black" stroke-width="12" {}/>'
    styles = ["", 'stroke-linecap="round"', 'stroke-linejoin="round"', 'stroke-linejoin="bevel"']
    areas = []
    for style in styles:
        (tmp_path / "a.svg").write_text(f"<svg>{line.format(style)}</svg>")
        found = csg.evaluate(csg.parse('import("a.svg");', folder=tmp_path))
        assert isinstance(found, Region)
        areas.append(found.area)
        assert len(found.outlines[0].points) < 2000
    plain, cap, joint, bevel = areas
    # Two half discs in place of two half squares, and a sector in place of a kite.
    assert plain - cap == pytest.approx(144 - 36 * math.pi, rel=1e-4)
    turn = 2 * math.atan(20 / 25)
    assert plain - joint == pytest.approx(36 * (math.tan(turn / 2) - turn / 2), rel=1e-3)
    assert joint < plain and bevel < plain


# Children of the other dimension, and figures that vanish


# Found: a solid before the plane figures of `linear_extrude`, `rotate_extrude` or `offset`, or a
# figure before the solids of `projection`, left nothing of the others.
@pytest.mark.parametrize(
    ("text", "size"),
    [
        ("linear_extrude(height = 1) { cube(1); square(2); }", 4),
        ("offset(delta = 1) { cube(1); square(2); }", 16),
        ("projection() { square(9); cube(2); }", 4),
        ("projection(cut = true) { square(9); cube(2); }", 4),
        ("hull() { cube(0); square(1); }", 0),
    ],
)
def test_children_of_the_other_dimension_may_come_first(text: str, size: float) -> None:
    with pytest.warns(csg.CsgWarning) as told:
        made = csg.evaluate(csg.parse(text))
    assert made is not None
    assert size == (made.volume if isinstance(made, b.Solid) else made.area)
    assert len(told) == 1


# Found: `offset` of several figures ended in an error where one vanishes, and the process where
# they are far out.
def test_figures_that_vanish_add_nothing_to_an_offset() -> None:
    assert region("offset(delta = 1) { square(0); square(1); }").area == 9
    assert region("offset(delta = 1) { square(10); square(1e-5); }").area == 144
    assert region("offset(delta = 1) { square(0); square(1e-5); }").is_empty


@pytest.mark.parametrize(
    "text", ["offset(delta = 1) { square(1e14); square(2e14); }", "offset(delta = 1e13) square(1);"]
)
def test_offsets_that_cannot_be_counted_are_refused(text: str) -> None:
    with pytest.raises(b.LimitError) as refused:
        csg.loads(text)
    assert refused.value.code == "too_large"


# Found: `offset(r=…, delta=…)` took `delta`.
def test_a_radius_goes_before_a_distance() -> None:
    with pytest.warns(csg.CsgWarning, match="its delta is ignored in favour of r"):
        round_corners = region("offset(r = 2, delta = 1) square(10);")
    assert round_corners.equals(region("offset(r = 2) square(10);"))


# Found: revolutions with segments of half a turn or more were empty or inside out.
def test_turns_are_divided_below_half_turns() -> None:
    plate = "polygon([[1, 0], [2, 0], [2, 1], [1, 1]]);"
    assert volume(f"rotate_extrude(angle = 200, $fn = 3) {plate}") > 2
    for angle in (180, 200):
        with pytest.raises(b.InvalidParameterError, match="at least 2"):
            b.revolve([(1, 0), (2, 0), (2, 1)], angle=angle, segments=1)


# Found: plane figures were subtracted one by one, in time quadratic in their number.
def test_many_plane_figures_are_taken_away_at_once() -> None:
    def rest(count: int) -> b.Region:
        circles = "".join(f"{moved(2 * k, 0, 0)} circle(r=1, $fn=24);" for k in range(count))
        return region(f"difference() {{ square({2 * count}); {circles} }}")

    assert rest(40).area == pytest.approx(6_400 - 39.5 * 12 * math.sin(math.tau / 24) / 2)
    assert seconds(lambda: rest(1_000), 2) < 7 * seconds(lambda: rest(250), 2)


# Where OpenSCAD 2021.01 is wrong: docs/compare.md shows these two.
@pytest.mark.parametrize(
    ("scale", "square"),
    [
        ("[1, 0]", "square([1, 3]);"),
        ("[0, 1]", "square([1, 3]);"),
        ("[1, 0]", "square([3, 1], center = true);"),
        ("[0, 1]", f"{moved(7, -2, 0)} square([3, 1]);"),
    ],
)
def test_extrusions_that_end_in_an_edge_are_half_of_a_box(scale: str, square: str) -> None:
    wedge = csg.loads(f"linear_extrude(height = 3, scale = {scale}) {square}")
    assert wedge.volume == pytest.approx(4.5)


@pytest.mark.parametrize("sides", [5, 6, 7, 8, 10, 11])
def test_sums_of_a_union_are_unions_of_sums(sides: int) -> None:
    bodies = [
        f"{moved(5, 0, 0)} cylinder(h = 10, r = 5, center = true, $fn = {sides});",
        f"cylinder(h = 5, r = 10, center = true, $fn = {sides});",
    ]
    both = csg.loads(f"minkowski() {{ cube(0.1); union() {{ {' '.join(bodies)} }} }}")
    each = [csg.loads(f"minkowski() {{ cube(0.1); {body} }}") for body in bodies]
    assert both.volume == pytest.approx((each[0] | each[1]).volume)
    pen = Region.rectangle(0.1, 0.1)
    thin = b.minkowski(Region.circle(5, sides).translate(5, 0), pen)
    wide = b.minkowski(Region.circle(10, sides), pen)
    by_hand = 10.1 * thin.area + 5.1 * wide.area - 5.1 * (thin & wide).area
    assert both.volume == pytest.approx(by_hand)
