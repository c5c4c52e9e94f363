"""Extrusions with twist, scale and taper."""

import math
from typing import Any

import pytest

import bspcsg as b

SQUARE = b.Region.rectangle(2, 2, center=True)
FRAME = b.Region.rectangle(10, 10) - b.Region.rectangle(2, 2).translate(4, 4)
#: A room of six with a mouth of one.
KEYHOLE = (
    b.Region.rectangle(10, 10)
    - b.Region.rectangle(6, 6).translate(2, 2)
    - b.Region.rectangle(4, 1).translate(7, 4.5)
)
#: A slot two wide and eight deep.
SLOTTED = b.Region.rectangle(10, 10) - b.Region.rectangle(2, 8).translate(4, 2)


@pytest.mark.parametrize(
    ("options", "volume"),
    [
        ({}, 12.0),
        ({"slices": 5}, 12.0),
        ({"scale": 0}, 4.0),
        ({"scale": (1, 0)}, 6.0),
        ({"scale": 0.5}, 7.0),
        ({"scale": (2, 1), "center": True}, 18.0),
        # Walls lean by 1/3 of the height on each side: a frustum of sides 2 and 4/3 or 8/3.
        ({"taper": math.degrees(math.atan(1 / 9))}, 3 * (4 + 16 / 9 + 8 / 3) / 3),
        ({"taper": -math.degrees(math.atan(1 / 9))}, 3 * (4 + 64 / 9 + 16 / 3) / 3),
    ],
)
def test_volumes_of_a_square(options: dict[str, Any], volume: float) -> None:
    solid = SQUARE.extrude(3, **options)
    assert solid.volume == pytest.approx(volume, rel=1e-8)
    assert b.extrude(SQUARE, 3, **options) == solid
    assert solid.to_manifold().volume() == pytest.approx(volume, rel=1e-8)


def test_a_twist_turns_clockwise_and_keeps_the_ends() -> None:
    solid = b.Region.rectangle(4, 1).extrude(2, twist=90)
    levels = {z: solid.vertices[solid.vertices[:, 2] == z, :2] for z in (0, 2)}
    assert levels[0].min(axis=0).tolist() == [0, 0] and levels[0].max(axis=0).tolist() == [4, 1]
    assert levels[2].min(axis=0).tolist() == [0, -4] and levels[2].max(axis=0).tolist() == [1, 0]
    # A slice for each 32nd of a turn: eight levels of four corners, and the first.
    assert len(solid.vertices) == 4 * 9
    assert len(b.Region.rectangle(4, 1).extrude(2, twist=90, slices=3).vertices) == 16


def test_holes_lean_into_the_material() -> None:
    solid = FRAME.extrude(1, taper=45)
    # The frustum between 10 and 8 less that between 2 and 4.
    assert solid.volume == pytest.approx((100 + 64 + 80 - 4 - 16 - 8) / 3)
    assert solid.genus == 1


# Found: scaled extrusions of contours that cross, or with unequal scales, were marked as trusted
# though their meshes crossed themselves, and had wrong or negative volumes; flat cones thinner than
# the lattice were not empty.
def test_contours_that_cross_are_united_as_they_shrink() -> None:
    two = [[(0, 0), (2, 0), (2, 2), (0, 2)], [(1, 1), (3, 1), (3, 3), (1, 3)]]
    bow = [(0, 0), (2, 2), (2, 0), (0, 2)]
    # A frustum of areas a and a/4 holds a (1 + 1/2 + 1/4) / 3.
    assert b.extrude(two, 1, scale=0.5).volume == pytest.approx(7 * 7 / 12)
    assert b.extrude(bow, 1, scale=0.5).volume == pytest.approx(1 * 7 / 12)


# Found: walls of extrusions that shrink unequally crossed each other.
def test_walls_that_shrink_unequally_are_united() -> None:
    corners = [(10, 0), (0, 10), (-10, 0), (0, -10)]
    fine = [
        (0.99 * (x * (8 - k) + z * k) / 8, 0.99 * (y * (8 - k) + w * k) / 8)
        for (x, y), (z, w) in zip(corners, corners[1:] + corners[:1], strict=True)
        for k in range(8)
    ]
    # The hole has more corners, and bulges through the walls around it.
    frame = b.extrude([corners, fine], 10, scale=(1, 0.1))
    assert frame.volume > 0
    assert frame == b.extrude(corners, 10, scale=(1, 0.1)) - b.extrude(fine, 10, scale=(1, 0.1))


def test_walls_that_meet_on_the_way_up_are_united() -> None:
    solid = KEYHOLE.extrude(1, taper=-45)
    # The mouth, one wide, is closed from half of the height on.
    assert [len(solid.slice(z).outlines) for z in (0.25, 0.75)] == [1, 2]
    assert solid.slice(0.75).area == pytest.approx(11.5**2 - 4.5**2)
    assert solid.to_manifold().volume() == pytest.approx(solid.volume)


# Found: `extrude(taper=45)` was refused where an edge vanishes.
def test_walls_that_vanish_end_in_a_roof() -> None:
    pyramid = b.Region.rectangle(2, 2).extrude(3, taper=45)
    assert pyramid.volume == pytest.approx(4 / 3) and pyramid.to_mesh().certificate.ok
    assert pyramid.vertices[:, 2].max() == pytest.approx(1)
    assert b.Region.rectangle(2, 2).extrude(3, taper=45, center=True).vertices[:, 2].min() == -1.5
    hip = b.Region.rectangle(4, 2).extrude(2, taper=30)
    slope = math.tan(math.radians(30))
    assert hip.volume == pytest.approx((2 * 4 - 4 / 3) / 2 / slope)
    # A short edge vanishes half way up, and the others go on.
    house = b.Region([(0, 0), (4, 0), (4, 3), (3.8, 4), (0, 4)])
    for z in (0.25, 0.75, 1.25):
        section = house.extrude(1.5, taper=45).slice(z)
        assert section.area == pytest.approx(house.offset(-z, "miter").area, abs=1e-6)


@pytest.mark.parametrize("taper", [-60, -45, -20])
def test_gaps_that_close_outwards(taper: float) -> None:
    for figure in (SLOTTED, SLOTTED.rotate(20)):
        solid = figure.extrude(3, taper=taper)
        assert solid.to_mesh().certificate.ok
        for z in (0.01, 1.4, 2.9):
            grown = figure.offset(z * math.tan(math.radians(-taper)), "miter")
            assert solid.slice(z).area == pytest.approx(grown.area, abs=1e-6)
    letter = b.text("e", size=10)
    solid = letter.extrude(3, taper=taper)
    assert solid.to_mesh().certificate.ok and (letter.extrude(3) - solid).volume < 1e-6
    grown = letter.offset(0.1 * math.tan(math.radians(-taper)), "miter")
    assert solid.slice(0.1).area == pytest.approx(grown.area, abs=1e-6)


@pytest.mark.parametrize(
    ("figure", "options", "words"),
    [
        (SQUARE, {"taper": 45, "twist": 10}, "too large at the corner"),
        (SLOTTED, {"taper": -60, "scale": 2}, "too large at the corner"),
        (SQUARE, {"taper": 90}, "taper must be"),
        (SQUARE, {"scale": -1}, "scale must be at least 0"),
        (SQUARE, {"scale": (1, 2, 3)}, "scale must be one number or a pair"),
        (SQUARE, {"slices": 0}, "slices must be"),
        (SQUARE, {"twist": math.inf}, "twist must be a finite"),
        (SQUARE, {"twist": 1, "slices": 10**9}, "corners"),
    ],
)
def test_what_makes_no_solid_is_refused(
    figure: b.Region, options: dict[str, Any], words: str
) -> None:
    with pytest.raises(b.BspcsgError, match=words):
        figure.extrude(3, **options)


@pytest.mark.parametrize("height", [0, -1, math.nan, "a"])
def test_a_height_is_a_number_above_zero(height: Any) -> None:
    with pytest.raises(b.InvalidParameterError):
        SQUARE.extrude(height)


def test_the_empty_region_makes_the_empty_solid() -> None:
    assert b.Region.empty().extrude(3, twist=90, taper=10).is_empty


# Found: `extrude` and `revolve` of the empty region ended in a `ValueError`.
def test_nothing_rises_to_nothing() -> None:
    nothing = b.cube(1).slice(9)
    assert nothing.is_empty
    for solid in (
        b.extrude(nothing, 1),
        b.extrude(nothing, 1, twist=30, taper=5),
        b.extrude(b.text(" "), 1),
        b.revolve(nothing),
        b.revolve(nothing, angle=90),
    ):
        assert solid.is_empty
    with pytest.raises(b.InvalidParameterError, match="no contour"):
        b.extrude([], 1)
