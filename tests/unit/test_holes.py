"""Holes in faces: plain ones, counterbores and countersinks."""

import math
from typing import Any

import numpy as np
import pytest

import bspcsg as b

PLATE = b.box(30, 20, 5)
TURNS = [(0, 0, 0), (90, 0, 180), (10, 20, 30)]


def disc(r: float, sides: int = 32) -> float:
    return sides / 2 * math.sin(math.tau / sides) * r * r


@pytest.mark.parametrize("turn", TURNS)
def test_holes_take_what_they_should(turn: Any) -> None:
    part = PLATE.rotate(turn)
    top = part.faces().filter(np.isclose(part.faces().area, 600))[0]
    cases: list[tuple[b.Solid, float, int]] = [
        (part.hole(top, d=4), 5 * disc(2), 1),
        (part.hole(top, r=2, depth=3), 3 * disc(2), 0),
        (part.counterbore(top, d=4, head_d=8, head_depth=2), 3 * disc(2) + 2 * disc(4), 1),
        (part.counterbore(top, d=4, head_r=4, head_depth=2, depth=4), 2 * (disc(2) + disc(4)), 0),
        # A cone of 90 degrees is as deep as it is wider than the hole.
        (part.countersink(top, d=4, head_d=8), 3 * disc(2) + 2 * disc(1) * (4 + 8 + 16) / 3, 1),
        (part.countersink(top, d=4, head_d=8, angle=2 * math.degrees(math.atan(2))),
         4 * disc(2) + disc(1) * (4 + 8 + 16) / 3, 1),
    ]  # fmt: skip
    for made, loss, ways in cases:
        assert part.volume - made.volume == pytest.approx(loss, rel=1e-6)
        assert made.genus == ways and made.surface_count == 1
        assert made.to_mesh().certificate.ok
        assert not made.findings or turn == TURNS[-1]


def test_holes_begin_at_points_of_the_face() -> None:
    top = PLATE.faces().sort_by("z")[-1]
    points = [(5, 5, 5), (25, 5, 5), (15, 15, 5)]
    made = PLATE.hole(top, points, d=4)
    assert made == PLATE - b.union(b.cylinder(9, d=4).translate(x, y, -1) for x, y, _ in points)
    assert PLATE.hole(top, d=4) == PLATE.hole(top, (15, 10, 5), d=4)
    assert PLATE.hole(top, np.zeros((0, 3)), d=4) == PLATE
    below = PLATE.faces().sort_by("z")[0]
    assert (5, 5, 1.5) in PLATE.hole(below, (5, 5, 0), d=4, depth=1)
    assert (5, 5, 0.5) not in PLATE.hole(below, (5, 5, 0), d=4, depth=1)


def test_a_hole_in_a_pocket_leaves_what_is_above_alone() -> None:
    channel = b.box(10, 10, 10) - b.box(12, 6, 6).translate(-1, 2, 2)
    floor = channel.faces().on("z", 2)
    made = channel.hole(floor, d=3)
    assert channel.volume - made.volume == pytest.approx(2 * disc(1.5)) and made.genus == 2


def test_holes_follow_each_other_on_one_face() -> None:
    top = PLATE.faces().sort_by("z")[-1]
    made = PLATE.hole(top, (5, 5, 5), d=4).hole(top, (25, 5, 5), d=4)
    assert made == PLATE.hole(top, [(5, 5, 5), (25, 5, 5)], d=4)
    with pytest.raises(
        b.InvalidParameterError, match=r"no face in the plane of the hole at the point \(5, 5, 5\)"
    ):
        made.hole(top, (5, 5, 5), d=6)


def test_a_hole_counts_once_in_a_block() -> None:
    with b.union() as u:
        part = b.box(30, 20, 5)
        part.hole(part.faces().sort_by("z")[-1], d=4)
    assert u.solid.genus == 1


TOP = PLATE.faces().sort_by("z")[-1]
BORE = PLATE.hole(TOP, d=4).faces().filter(lambda f: ~f.is_flat)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: PLATE.hole(TOP), "A hole needs a radius or a diameter"),
        (lambda: PLATE.hole(TOP, d=4, r=2), "give one of them"),
        (lambda: PLATE.hole(TOP, d=-4), "d must be at least 0"),
        (lambda: PLATE.hole(TOP, d=4, depth=0), "depth must be above 0"),
        (lambda: PLATE.hole(PLATE.faces(), d=4), "Exactly one face must be selected, but 6 are"),
        (lambda: PLATE.hole(BORE, d=4), "The selected face is curved"),
        (lambda: PLATE.hole(PLATE.edges(), d=4), "face must be a selection"),  # type: ignore[arg-type]
        (lambda: b.cube(5).hole(TOP, d=4), "no face in the plane of the hole at the point"),
        (lambda: PLATE.hole(TOP, (5, 5, 4), d=4), r"at the point \(5, 5, 4\)"),
        (lambda: PLATE.hole(TOP, (31, 5, 5), d=4), r"point \(31, 5, 5\)"),
        (lambda: PLATE.hole(TOP, (5, 5), d=4), "three finite numbers"),
        (lambda: PLATE.counterbore(TOP, d=4, head_d=4, head_depth=1), "head must be wider"),
        (lambda: PLATE.counterbore(TOP, d=4, head_depth=1), "exactly one of head_r and head_d"),
        (lambda: PLATE.counterbore(TOP, d=4, head_d=8, head_depth=2, depth=2), "depth must be"),
        (lambda: PLATE.countersink(TOP, d=4, head_d=8, angle=180), "between 0 and 180"),
        (lambda: PLATE.countersink(TOP, d=4, head_d=8, depth=1), "depth must be greater"),
    ],
)  # fmt: skip
def test_holes_refuse_what_makes_no_sense(call: Any, word: str) -> None:
    with pytest.raises(b.InvalidParameterError, match=word):
        call()


@pytest.mark.parametrize("scale", [1e-7, 1e-4, 1, 1e6])
def test_sizes_make_no_difference(scale: float) -> None:
    part = b.box(30 * scale, 20 * scale, 5 * scale)
    made = part.hole(part.faces().sort_by("z")[-1], d=8 * scale)
    assert made.bounds is not None and part.bounds is not None
    assert made.bounds.tolist() == part.bounds.tolist() and made.genus == 1
    assert len(made.edges().on("z", 5 * scale)) == 4 + 32
    assert made.volume / scale**3 == pytest.approx(3000 - 5 * disc(4), rel=1e-4)
