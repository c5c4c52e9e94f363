"""DXF files: curves within their tolerance, blocks, and ends that nearly meet."""

import math
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import Region, bsp
from bspcsg.bsp.drawings import dxf_curves
from support import DEEP, draw

ezdxf = pytest.importorskip("ezdxf")

Draw = Callable[[Any], Any]


def region_of(folder: Path, draw: Draw, **options: Any) -> Region:
    """Return the region read from a DXF file that `draw` has filled."""
    document = ezdxf.new()
    draw(document.modelspace())
    document.saveas(folder / "x.dxf")
    return Region.from_dxf(folder / "x.dxf", **options)


def square(space: Any, x: float = 0, y: float = 0, **options: Any) -> None:
    corners = [(x, y), (x + 10, y), (x + 10, y + 10), (x, y + 10)]
    space.add_lwpolyline(corners, close=True, dxfattribs=options)


def circle(space: Any, radius: float) -> None:
    space.add_circle((0, 0), radius)


def two_bulges(space: Any, radius: float) -> None:
    space.add_lwpolyline([(-radius, 0, 1), (radius, 0, 1)], format="xyb", close=True)


def old_bulges(space: Any, radius: float) -> None:
    space.add_polyline2d([(-radius, 0, -1), (radius, 0, -1)], format="xyb", close=True)


def arcs(space: Any, radius: float) -> None:
    space.add_arc((0, 0), radius, 80, 20)
    space.add_arc((0, 0), radius, 20, 80)


def ellipse(space: Any, radius: float) -> None:
    space.add_ellipse((0, 0), (radius, 0), 1.0)


# Found: DXF: circles were farther off than the tolerance, large ones refused as open.
@pytest.mark.parametrize("draw", [circle, two_bulges, old_bulges, arcs, ellipse])
@pytest.mark.parametrize("radius", [1, 1000, 100_000])
@pytest.mark.parametrize("tolerance", [0.05, 0.001])
def test_curves_stay_within_their_tolerance(
    tmp_path: Path, draw: Any, radius: float, tolerance: float
) -> None:
    (corners,) = region_of(
        tmp_path, lambda space: draw(space, radius), tolerance=tolerance
    ).to_polygons()
    rounding = radius * 1e-12 + 1e-8
    assert np.abs(np.hypot(*corners.T) - radius).max() < rounding
    middles = (corners + np.roll(corners, 1, axis=0)) / 2
    assert radius - np.hypot(*middles.T).min() <= tolerance + rounding
    # As few as need be, but for a curve that is halved until it fits.
    assert len(corners) <= 8 + 2 * math.pi / math.acos(1 - tolerance / radius)


def test_circles_are_as_wide_as_they_should_be(tmp_path: Path) -> None:
    region = region_of(tmp_path, lambda space: space.add_circle((5, 3), 2))
    assert region.bounds is not None
    assert np.allclose(region.bounds, [[3, 1], [7, 5]], atol=1e-9)


@pytest.mark.parametrize("bulge", [0.3, -0.3, 2.0, 1e-9])
def test_bulges_of_any_sign(tmp_path: Path, bulge: float) -> None:
    region = region_of(
        tmp_path,
        lambda space: space.add_lwpolyline(
            [(0, 0, bulge), (4, 0, 0), (4, 3, 0)], format="xyb", close=True
        ),
        tolerance=1e-6,
    )
    turn = 4 * math.atan(bulge)
    radius = 4 / (2 * math.sin(abs(turn) / 2))
    segment = radius**2 / 2 * (abs(turn) - math.sin(abs(turn)))
    expected = 6 + math.copysign(segment, bulge)
    assert region.area == pytest.approx(expected, abs=1e-4)


def test_entities_seen_from_behind(tmp_path: Path) -> None:
    behind = {"extrusion": (0, 0, -1)}
    region = region_of(tmp_path, lambda space: space.add_circle((5, 1), 2, dxfattribs=behind))
    assert region.bounds is not None
    assert np.allclose(region.bounds, [[-7, -1], [-3, 3]])
    region = region_of(tmp_path, lambda space: square(space, 1, 2, **behind))
    assert region.bounds is not None
    assert np.allclose(region.bounds, [[-11, 2], [-1, 12]])


def test_polylines_in_space_and_splines(tmp_path: Path) -> None:
    corners = [(0, 0, 1), (4, 0, 2), (4, 3, 0)]
    region = region_of(tmp_path, lambda space: space.add_polyline3d(corners, close=True))
    assert region.area == 6
    # Its ends differ by a rounding.
    ends = [(0, 0), (4, 0), (4, 3), (0, 0)]
    assert region_of(tmp_path, lambda space: space.add_spline(ends)).area > 6
    with pytest.warns(bsp.DrawingWarning, match=r"left out: POLYLINE \(1\)\. The region is empty"):
        region_of(tmp_path, lambda space: space.add_polymesh((3, 3)))


# Blocks


def block(space: Any, name: str = "block", **options: Any) -> None:
    content = space.doc.blocks.new(name)
    square(content)
    square(content, 20, 0, layer="own")
    space.add_blockref(name, (5, 5), dxfattribs=options)


# Found: DXF: inserted blocks were left out in silence.
@pytest.mark.parametrize(
    ("options", "area", "bounds"),
    [
        ({}, 200, [[5, 5], [35, 15]]),
        ({"rotation": 90}, 200, [[-5, 5], [5, 35]]),
        ({"xscale": -2, "yscale": 3}, 1200, [[-55, 5], [5, 35]]),
        (
            {"row_count": 2, "column_count": 3, "row_spacing": 20, "column_spacing": 40},
            1200,
            [[5, 5], [115, 35]],
        ),
    ],
)
def test_blocks_are_what_they_hold(
    tmp_path: Path, options: dict[str, Any], area: float, bounds: list[list[float]]
) -> None:
    region = region_of(tmp_path, lambda space: block(space, **options))
    assert region.area == pytest.approx(area) and region.bounds is not None
    assert np.allclose(region.bounds, bounds)


def test_blocks_in_blocks(tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        inner, outer = space.doc.blocks.new("inner"), space.doc.blocks.new("outer")
        inner.add_lwpolyline([(0, 0, 1), (2, 0, 1)], format="xyb", close=True)
        outer.add_blockref("inner", (1, 1), dxfattribs={"xscale": 2, "yscale": 1})
        space.add_blockref("outer", (0, 0), dxfattribs={"yscale": -3})

    region = region_of(tmp_path, draw, tolerance=1e-5)
    assert region.area == pytest.approx(6 * math.pi, rel=1e-4) and region.bounds is not None
    assert np.allclose(region.bounds, [[1, -6], [5, 0]], atol=1e-4)


@pytest.mark.filterwarnings("ignore::bspcsg.bsp.DrawingWarning")
def test_layers_of_blocks(tmp_path: Path) -> None:
    """What is on layer 0 of a block lies on the layer of its insertion."""
    boxes = {
        layer: region_of(tmp_path, lambda space: block(space, layer="there"), layers=[layer]).bounds
        for layer in ("there", "own", "0")
    }
    found = {layer: None if box is None else box.round(9).tolist() for layer, box in boxes.items()}
    assert found == {"there": [[5, 5], [15, 15]], "own": [[25, 5], [35, 15]], "0": None}


def in_itself(space: Any) -> None:
    space.doc.blocks.new("loop").add_blockref("loop", (1, 1))
    space.add_blockref("loop", (0, 0))


def many(space: Any) -> None:
    square(space.doc.blocks.new("0"))
    for level in range(1, 7):
        content = space.doc.blocks.new(str(level))
        for place in range(4):
            content.add_blockref(str(level - 1), (place, 0))
    space.add_blockref("6", (0, 0))


def grid(space: Any) -> None:
    square(space.doc.blocks.new("one"))
    counts = {"row_count": 32_000, "column_count": 32_000, "row_spacing": 1, "column_spacing": 1}
    space.add_blockref("one", (0, 0), dxfattribs=counts)


@pytest.mark.parametrize(
    ("draw", "words"),
    [
        (in_itself, "nested deeper"),
        (many, "contain more than"),
        (grid, "contain more than"),
        (lambda space: space.add_blockref("nothing", (0, 0)), "the block “nothing”"),
        (lambda space: space.add_circle((0, 0), 1e12), "larger tolerance"),
    ],
)
def test_what_has_no_bound_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, draw: Draw, words: str
) -> None:
    monkeypatch.setattr(dxf_curves, "MAX_BLOCK_ENTITIES", 3000)
    with pytest.raises(b.FormatError, match=words):
        region_of(tmp_path, draw)


# Ends


def sides(space: Any, corners: Sequence[tuple[float, float]], gap: float) -> None:
    """Draw the sides of a polygon, with gaps of this width at the corners."""
    for (x, y), end in zip(corners, [*corners[1:], corners[0]], strict=True):
        space.add_line((x + gap, y), (end[0] - gap, end[1]))


# Found: DXF: ends that nearly meet were open, at some places.
@pytest.mark.parametrize("gap", [0, 1e-13, 4e-5])
def test_ends_that_nearly_meet_are_joined_wherever_they_lie(tmp_path: Path, gap: float) -> None:
    for place in range(40) if DEEP else range(draw("places of ends", 4), 40, 4):
        x = (place + 0.5) * 1e-4 / 4
        corners = [(0, 0), (100, 0), (100, 100), (x, 100)]
        region = region_of(tmp_path, partial(sides, corners=corners, gap=gap))
        assert region.area == pytest.approx(10_000, rel=1e-5)


def test_ends_that_do_not_meet_are_told(tmp_path: Path) -> None:
    corners = [(0, 0), (100, 0), (100, 100), (0, 100)]
    with pytest.raises(b.FormatError, match="open at"):
        region_of(tmp_path, lambda space: sides(space, corners, 1e-2))


def test_pieces_may_be_shorter_than_what_is_joined(tmp_path: Path) -> None:
    corners = [(0, 0), (100, 0), (100, 1e-5), (100, 100), (0, 100)]
    assert region_of(tmp_path, lambda space: sides(space, corners, 0)).area == 10_000


# Found: full ellipses of DXF that begin beside their axis vanished in silence.
@pytest.mark.parametrize("start", [0, 1, -math.pi, math.pi / 2, math.tau])
def test_full_ellipses_begin_anywhere(tmp_path: Path, start: float) -> None:
    found = region_of(
        tmp_path, lambda space: space.add_ellipse((1, 2), (5, 0), 0.5, start, start + math.tau)
    )
    assert found.area == pytest.approx(12.5 * math.pi, rel=1e-2)
    np.testing.assert_allclose(found.centroid, (1, 2), atol=1e-6)


@pytest.mark.parametrize("start", [0, 1])
def test_full_ellipses_have_eight_chords_at_least(tmp_path: Path, start: float) -> None:
    found = region_of(
        tmp_path,
        lambda space: space.add_ellipse((0, 0), (5, 0), 0.5, start, start + math.tau),
        tolerance=9,
    )
    assert [len(outline) for outline in found.to_polygons()] == [8]


# Found: layers of a DXF in other letters or another case than the reader took gave the empty
# region in silence.
@pytest.mark.parametrize(("version", "name"), [("R2000", "Löcher"), ("R12", "Ø"), ("R2010", "孔")])
def test_names_of_layers_in_any_letters_and_case(tmp_path: Path, version: str, name: str) -> None:
    document = ezdxf.new(version)
    document.layers.add(name)
    document.modelspace().add_circle((5, 5), 1)
    document.modelspace().add_circle((0, 0), 1, dxfattribs={"layer": name})
    document.saveas(tmp_path / "x.dxf")
    for written in (name, name.upper(), name.lower()):
        region = Region.from_dxf(tmp_path / "x.dxf", layers=[written])
        assert region.area == pytest.approx(math.pi, rel=0.05)


# Found: layers that a DXF has not gave the empty region in silence.
def test_layers_that_a_file_lacks_are_refused(tmp_path: Path) -> None:
    with pytest.raises(
        b.FormatError, match=r"no layer 'nope'; its layers are .*'there'"
    ) as refusal:
        region_of(tmp_path, lambda space: square(space, layer="there"), layers=["there", "nope"])
    assert refusal.value.code == "unknown_name"
    with pytest.warns(bsp.DrawingWarning, match="no closed outline"):
        assert region_of(tmp_path, square, layers=["Defpoints"]).is_empty
