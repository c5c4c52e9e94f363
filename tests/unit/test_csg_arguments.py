"""The arguments of nodes: those that each node knows, and warnings for others."""

import math
import warnings

import numpy as np
import pytest

import bspcsg as b
from bspcsg import csg
from bspcsg.csg.nodes.registry import NODE_KINDS
from support.scripts import moved, region, volume

SQUARE = "square(size = [2, 2], center = true);"


def told(text: str) -> list[str]:
    """Return the warnings of evaluating a script."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        csg.evaluate(csg.parse(text, "part.csg"))
    return [str(one.message) for one in caught]


# Found: no node reported arguments that it does not know.
@pytest.mark.parametrize("name", csg.node_names())
def test_every_node_tells_of_arguments_that_it_does_not_know(name: str) -> None:
    [complaint] = NODE_KINDS[name].takes.complaints(csg.parse(f"{name}(raduis = 3);").nodes[0])
    assert "no argument “raduis”" in complaint
    count = len(NODE_KINDS[name].takes.order)
    unnamed = csg.parse(f"{name}({', '.join('123456789'[: count + 1])});").nodes[0]
    assert any("unnamed" in one for one in NODE_KINDS[name].takes.complaints(unnamed))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            "circle(radius = 3);",
            "no argument “radius”, so this argument is ignored; its arguments are r, d",
        ),
        ('sphere(r = 1, style = "octa");', "no argument “style”"),
        ("projection(cutt = true) cube(2);", "no argument “cutt”"),
        ("rotate_extrude(angel = 90) square(1);", "no argument “angel”"),
        (
            "group(size = 3) cube(1);",
            "no argument “size”, so this argument is ignored; it has no arguments",
        ),
        ("circle(1, $fm = 8);", "no argument “$fm”"),
        ("cube(1, true, 5);", "1 of its unnamed arguments are ignored"),
        ("cube(1, size = 5);", "its size is given 2 times; the last value is used"),
        ("cylinder(h = 1, r = 1, d = 5, $fn = 4);", "its r is ignored in favour of d"),
        ("cylinder(h = 1, r1 = 1, d1 = 5, r2 = 2);", "its r1 is ignored in favour of d1"),
        ("cylinder(h = 1, d = 1, r1 = 5, r2 = 2);", "its d is ignored in favour of r1 and r2"),
        ("sphere(r = 1, d = 5);", "its r is ignored in favour of d"),
        ("offset(r = 1, delta = 2) square(1);", "its delta is ignored in favour of r"),
        ("offset(r = 1, chamfer = true) square(1);", "its chamfer is ignored in favour of r"),
        (
            f"linear_extrude(height = 2, h = 5) {SQUARE}",
            "its h is ignored in favour of height",
        ),
        (
            "rotate_extrude(angle = 90, a = 5) square(1);",
            "its a is ignored in favour of angle",
        ),
    ],
)
def test_arguments_that_do_not_count_are_told_with_their_place(text: str, says: str) -> None:
    [message] = told("group();\n  " + text)
    assert message.startswith("part.csg:2:3: ") and says in message


@pytest.mark.parametrize(
    "text",
    [
        "cube(1, center = false, convexity = 2);",
        "group($fn = 8, $fa = 12, $fs = 2, $fe = 0.1) sphere(1);",
        "cylinder(h = 1, r = 2, r1 = 1, $fn = 8);",
        "circle(r = 2, d = undef);",
        "offset(r = 1, chamfer = false) square(1);",
        "color([1, 0, 0, 1]) cube(1);",
        "render(convexity = 4) cube(1);",
        "polygon(points = [[0, 0], [1, 0], [0, 1]], paths = undef, convexity = 1);",
        'text(text = "A", size = 10, spacing = 1, font = "", direction = "default",'
        ' language = "en", script = "Latn", halign = "default", valign = "default");',
    ],
)
def test_what_dumps_of_openscad_hold_is_not_told(text: str) -> None:
    assert told(text) == []


def test_each_place_is_told() -> None:
    messages = told("circle(radius = 3);\ncircle(radius = 3);")
    assert [message[:12] for message in messages] == ["part.csg:1:1", "part.csg:2:1"]


def test_default_is_the_default_of_texts() -> None:
    plain = region('text("Ag");')
    assert region('text("Ag", halign = "default", valign = "default");').equals(plain)


# Turns


@pytest.mark.parametrize("angle", [360, 90, -90, 200])
@pytest.mark.parametrize("x", [5, -6])
@pytest.mark.parametrize("start", [0, 180, 45, 90, -30, 405])
def test_turns_begin_where_they_start(angle: float, x: float, start: float) -> None:
    turn = f"rotate_extrude(angle = {angle}, start = {start}, $fn = 7)"
    solid = csg.loads(f"{turn} {moved(x, 0, 0)} square([1, 2]);")
    far = 6 if x > 0 else -6
    for degrees in (start, start + angle):
        way = math.radians(degrees)
        corner = far * math.cos(way), far * math.sin(way)
        assert (np.abs(solid.vertices[:, :2] - corner).max(axis=1) < 1e-6).any()
    plain = csg.loads(f"rotate_extrude(angle = {angle}, $fn = 7) {moved(x, 0, 0)} square([1, 2]);")
    assert solid.volume == pytest.approx(plain.volume)


def test_turns_without_a_start_are_those_of_openscad_2021() -> None:
    for angle, start in ((360, 180), (90, 0), (-90, 0)):
        given, left = (
            csg.loads(f"rotate_extrude(a = {angle}, {more}$fn = 5) {moved(2, 0, 0)} square(1);")
            for more in (f"start = {start}, ", "")
        )
        assert given.equals(left)


# Extrusions


@pytest.mark.parametrize(
    ("arguments", "box"),
    [
        ("h = 5", [[-1, -1, 0], [1, 1, 5]]),
        ("height = 10, v = [-0, -0, -1]", [[-1, -1, -10], [1, 1, 0]]),
        ("height = 10, v = [0, 0, -2], center = true", [[-1, -1, -5], [1, 1, 5]]),
        ("height = 10, v = [0.6, 0, 0.8]", [[-1, -1, 0], [7, 1, 8]]),
        ("h = 10, v = [3, 0, -4], center = true", [[-4, -1, -4], [4, 1, 4]]),
        ("v = [0, 3, 4]", [[-1, -1, 0], [1, 4, 4]]),
        ("4, [0, 0, 1], [1, 1], true", [[-1, -1, -2], [1, 1, 2]]),
    ],
)
def test_extrusions_go_along_their_way(arguments: str, box: list[list[float]]) -> None:
    solid = csg.loads(f"linear_extrude({arguments}) {SQUARE}")
    assert solid.bounds is not None
    np.testing.assert_allclose(solid.bounds, np.array(box), atol=1e-9)
    assert solid.volume == pytest.approx(4 * (box[1][2] - box[0][2]))


def test_extrusions_without_height_are_empty() -> None:
    for arguments in ("v = [1, 0, 0]", "v = [0, 0, 0]", "h = -5", "h = 0, v = [0, 0, 1]"):
        assert csg.loads(f"linear_extrude({arguments}) {SQUARE}").is_empty


def test_twists_that_go_down_are_mirror_images() -> None:
    up, down = (
        csg.loads(f"linear_extrude(h = 3, v = [0, 0, {z}], twist = 90, slices = 5) {SQUARE}")
        for z in (1, -1)
    )
    assert down.equals(up.mirror((0, 0, 1)))


def test_segments_divide_the_sides_of_twisted_extrusions() -> None:
    twisted = f"linear_extrude(height = 10, twist = 180, slices = 4, segments = {{}}) {SQUARE}"
    plain = volume(f"linear_extrude(height = 10, twist = 180, slices = 4) {SQUARE}")
    assert plain == volume(twisted.format(0)) == volume(twisted.format(4))
    # One of the two ways to cut the quadrilaterals of a wall, worked out by hand.
    assert 35.51 < volume(twisted.format(64)) < 36.69
    assert len(csg.loads(twisted.format(64)).faces) > 4 * 64 * 2
    # Four edges that are alike are divided together or not at all.
    assert volume(twisted.format(7)) == plain != volume(twisted.format(8))
    assert volume(f"linear_extrude(h = 3, segments = 50) {SQUARE}") == 12
    tapered = f"linear_extrude(h = 3, scale = [1, 2], segments = 9) {SQUARE}"
    assert volume(tapered) == pytest.approx(18, rel=0.01)


def test_segments_divide_the_longest_sides_first() -> None:
    bar = "linear_extrude(h = 1, twist = 90, slices = 1, segments = {}) square([9, 1]);"
    corners = [len(csg.loads(bar.format(count)).vertices) for count in (4, 6, 8)]
    assert corners == [8, 12, 16]
    hole = f"difference() {{ square(9, center = true); {SQUARE} }}"
    ring = csg.loads(f"linear_extrude(h = 1, twist = 30, slices = 2, segments = 8) {hole}")
    assert ring.genus == 1 and len(ring.vertices) == 3 * 16


def test_too_many_segments_are_refused() -> None:
    with pytest.raises(b.FormatError, match="corners"):
        csg.loads(f"linear_extrude(h = 1, twist = 9, segments = 1e9) {SQUARE}")


# Fineness


@pytest.mark.parametrize("r", [0.5, 10, 400])
def test_sides_stay_within_the_error_allowed(r: float) -> None:
    sides = len(region(f"circle(r = {r}, $fe = 0.001);").outlines[0].points)
    error = [r * (1 - math.cos(math.pi / n)) for n in (sides, sides - 1)]
    assert error[0] <= 0.001 < error[1]
    assert len(region(f"circle(r = {r}, $fe = 0.001, $fn = 8);").outlines[0].points) == 8


def test_the_error_allowed_has_its_limits() -> None:
    for allowed, sides in ((50, 5), (0, 30), (1e-9, 30)):
        assert len(region(f"circle(r = 10, $fe = {allowed});").outlines[0].points) == sides
    inner = region("group($fe = 0.001) circle(r = 10);")
    assert inner.equals(region("circle(r = 10, $fe = 0.001);"))
    twisted = f"linear_extrude(h = 1, twist = 360{{}}) {moved(9, 0, 0)} {SQUARE}"
    fine, coarse = (csg.loads(twisted.format(more)) for more in (", $fe = 0.001", ""))
    assert len(fine.faces) > 4 * len(coarse.faces)
