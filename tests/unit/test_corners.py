"""Rounded and chamfered corners of regions; regular polygons and slots."""

import math
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import Region

ELL = Region.rectangle(10, 10) - Region.rectangle(5, 5)
FRAME = Region.rectangle(10, 10) - Region.rectangle(2, 2).translate(4, 4)


def lost(r: float, turn: float, segments: int) -> float:
    """Return the area between a corner that turns by an angle and the chords of its arc."""
    steps = max(math.ceil(segments * turn / math.tau - 1e-9), 1)
    return r * r * (math.tan(turn / 2) - steps / 2 * math.sin(turn / steps))


@pytest.mark.parametrize("angle", [0, 17])
@pytest.mark.parametrize("segments", [4, 8, 32])
def test_convex_corners_lose_and_concave_ones_gain(angle: float, segments: int) -> None:
    for figure, convex in ((ELL, 5 - 1), (FRAME, 4 - 4)):
        turned = figure.rotate(angle)
        assert turned.area - turned.fillet(0.5, segments=segments).area == pytest.approx(
            convex * lost(0.5, math.pi / 2, segments), abs=1e-6
        )
        assert turned.area - turned.chamfer(0.5).area == pytest.approx(convex * 0.125, abs=1e-6)


@pytest.mark.parametrize("sides", [3, 5, 8])
def test_corners_of_any_angle(sides: int) -> None:
    figure = Region.regular_polygon(sides, 10)
    soft = figure.fillet(1, segments=32)
    assert figure.area - soft.area == pytest.approx(sides * lost(1, math.tau / sides, 32), abs=1e-6)
    assert (soft - figure).area < 1e-7 and len(soft.outlines) == 1


def test_some_corners_and_those_of_curves() -> None:
    right = ELL.fillet(1, lambda p: p[:, 0] > 9, segments=4)
    assert ELL.area - right.area == pytest.approx(2 * 0.5)
    assert Region.circle(5, 32).fillet(1) == Region.circle(5, 32)
    # A round corner bends little, so that the next call leaves it alone.
    once = ELL.fillet(1, lambda p: p[:, 0] > 9)
    both = once.fillet(1, lambda p: p[:, 0] < 1)
    assert both == ELL.fillet(1, lambda p: (p[:, 0] > 9) | (p[:, 0] < 1))
    assert (~(~ELL).fillet(1)) == ELL.fillet(1) and Region.empty().fillet(1).is_empty


def test_rounds_may_take_all_of_an_edge() -> None:
    square = Region.rectangle(4, 4)
    assert square.chamfer(2).area == 8
    assert square.fillet(2, segments=64).area == pytest.approx(32 * 4 * math.sin(math.tau / 64))


def test_regular_polygons_and_slots() -> None:
    assert Region.regular_polygon(4, 1).area == 2 and Region.regular_polygon(4, d=2).area == 2
    assert Region.regular_polygon(6, flats=13).area == pytest.approx(13**2 * math.sqrt(3) / 2)
    nut = Region.regular_polygon(6, flats=13).to_polygons()[0]
    assert (nut[:, 0].min(), nut[:, 0].max()) == (-6.5, 6.5)
    assert Region.regular_polygon(4, flats=2).area == pytest.approx(4)
    slot = Region.slot(10, d=4)
    assert slot.area == pytest.approx(6 * 4 + 16 * 4 * math.sin(math.tau / 32))
    assert np.abs(slot.to_polygons()[0]).max(axis=0).tolist() == [5, 2]
    assert Region.slot(4, 2) == Region.circle(2, 32)
    assert len(Region.slot(10, 2, segments=5).outlines[0].points) == 6 + 2


@pytest.mark.parametrize("scale", [1e-7, 1e-5, 1e-3, 1, 1e3, 1e6])
def test_sizes_make_no_difference(scale: float) -> None:
    hole = Region.rectangle(scale).translate(0.6 * scale, 0.6 * scale)
    figure = Region.rectangle(10 * scale) - hole

    def first(points: Any) -> Any:
        return (points == 0).all(axis=1)

    assert figure.chamfer(scale, first).area == pytest.approx(98.5 * scale**2, rel=1e-4)
    for size in (2.5, 5.0):
        for call in (figure.chamfer, figure.fillet):
            with pytest.raises(b.InvalidParameterError, match="cross another outline"):
                call(size * scale, first)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: ELL.fillet(2.6), r"edges at the corner \(0, 5\)"),
        (lambda: ELL.chamfer(6), "too short"),
        (lambda: (ELL - Region.circle(0.5, 16).translate(9.2, 9.2)).fillet(2), "cross"),
        (lambda: ELL.fillet(0), "above 0"),
        (lambda: ELL.fillet(1, segments=3), "at least 4"),
        (lambda: ELL.fillet(1, lambda p: p), "one bool for each of 6 points"),
        (lambda: ELL.chamfer(1, "all"), "function"),  # type: ignore[arg-type]
        (lambda: Region.slot(3, d=4), "must be at least its width"),
        (lambda: Region.slot(3), "needs a radius or a diameter"),
        (lambda: Region.regular_polygon(2, 1), "at least 3"),
        (lambda: Region.regular_polygon(6, 1, flats=2), "exactly one"),
        (lambda: Region.regular_polygon(6), "needs a radius or a diameter"),
    ],
)  # fmt: skip
def test_corners_refuse_what_makes_no_sense(call: Any, word: str) -> None:
    with pytest.raises(b.InvalidParameterError, match=word):
        call()
    with pytest.raises(b.UnboundedError):
        Region.half_plane((1, 0)).fillet(1)
