"""Regions as values: making, measuring, moving, and conversion from and to solids."""

import copy
import math
import pickle
import time
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp

R = bsp.Region
STAR = [(math.cos(a), math.sin(a)) for a in np.arange(5) * 4 * math.pi / 5]


def plate() -> bsp.Region:
    """Return a plate with two holes, one of which has an island."""
    holes = R.rectangle(2).translate(1, 1) | R.rectangle(3).translate(4, 0.5)
    return (R.rectangle(8, 4) - holes) | R.rectangle(1).translate(5, 1.5)


def test_measures() -> None:
    region = plate()
    assert region.area_exact == 32 - 4 - 9 + 1
    assert region.perimeter == 24 + 8 + 12 + 4
    assert region.bounds is not None
    assert region.bounds.tolist() == [[0, 0], [8, 4]]
    x = Fraction(32 * 4 - 4 * 2 + 1 * Fraction(11, 2)) - 9 * Fraction(11, 2)
    assert region.centroid_exact == (x / 20, Fraction(32 * 2 - 4 * 2 - 9 * 2 + 1 * 2) / 20)
    assert R.rectangle(3, 2, center=True).centroid.tolist() == [0, 0]
    assert R.rectangle(0.1).area_exact == Fraction(1, 100)


def test_nested_outlines() -> None:
    outlines = plate().outlines
    assert [o.is_hole for o in outlines] == [False, True, True, False]
    assert [o.parent for o in outlines] == [-1, 0, 0, 2]
    assert [o.area for o in outlines] == [32, -4, -9, 1]
    assert not outlines[0].points.flags.writeable
    first, second = plate().components
    assert (first.area, second.area) == (19, 1)


def test_empty_full_and_half_planes() -> None:
    assert R.empty().is_empty
    assert R.full().is_full
    assert R.empty().outlines == ()
    assert R.empty().area == 0
    assert R.empty().bounds is None
    assert np.isnan(R.empty().centroid).all()
    assert R.empty().components == ()
    half = R.half_plane((0, 1), 2)
    assert (plate() & half).area_exact + (plate() - half).area_exact == 20
    assert not half.is_bounded
    for ask in ("area", "outlines", "centroid", "bounds", "perimeter", "exact_outlines"):
        with pytest.raises(b.UnboundedError):
            getattr(half, ask)
    assert half.translate(0, 1).equals(R.half_plane((0, 1), 3))
    assert half.rotate(90).equals(R.half_plane((-1, 0), 2))
    with pytest.raises(b.UnboundedError):
        half.rotate(45)
    assert (~plate()).rotate(45).equals(~plate().rotate(45))


def test_touching_corners() -> None:
    diagonal = R.rectangle(1) | R.rectangle(1).translate(1, 1)
    assert [len(o.points) for o in diagonal.outlines] == [4, 4]
    assert len(diagonal.components) == 2
    pinched = R.rectangle(4) - R([(2, 4), (1, 2), (3, 2)], winding="nonzero")
    shell, hole = pinched.outlines
    # The hole's corner is a corner of the shell as well: no loose end on a side.
    assert len(shell.points) == 5
    assert hole.parent == 0
    assert pinched.area_exact == 14


def test_self_crossing_outlines() -> None:
    assert len(R(STAR).outlines) == 1
    assert len(R(STAR, winding="even-odd").components) == 5
    eight = [(0, 0), (2, 2), (2, 0), (0, 2)]
    assert R(eight).area_exact == 1
    assert R(eight, winding="nonzero").area_exact == 2
    assert R([eight[::-1]]).area_exact == 1
    assert R([(0, 0), (1, 0), (2, 0)]).is_empty


def test_moves() -> None:
    region = plate()
    assert region.rotate(90).area_exact == 20
    assert region.rotate(30).area == pytest.approx(20)
    assert region.scale(2).area_exact == 80
    assert region.scale((2, 1)).area_exact == 40
    assert region.mirror((1, 0)).bounds is not None
    assert region.mirror((1, 0)).area_exact == 20
    assert region.transform([[1, 1, 0], [0, 1, 0], [0, 0, 1]]).area_exact == 20
    assert region.transform([[0, 1, 3], [1, 0, 0]]).area_exact == 20
    assert region.translate((1, 2)).equals(region.translate(1, 2))
    assert region.translate(1e10, 0).area == pytest.approx(20, rel=1e-3)


def test_value() -> None:
    region = plate() - R(STAR)
    assert pickle.loads(pickle.dumps(region)).exact_outlines == region.exact_outlines
    assert copy.copy(region) is region
    assert copy.deepcopy(region) is region
    assert repr(plate()) == "Region(4 outlines, 16 corners, area 20)"
    assert repr(R.empty()) == "Region(empty)"
    assert repr(R.half_plane((1, 0))) == "Region(unbounded)"
    assert bool(region)
    assert not R.empty()
    assert R(region.to_polygons(), winding="positive").area == pytest.approx(region.area)


# Found: reading shapes of shapely took quadratic time.
def test_shapely_in_and_out() -> None:
    pytest.importorskip("shapely")
    shape = plate().to_shapely()
    assert shape.is_valid
    assert shape.area == 20
    assert R(shape).equals(plate())
    assert R(R.empty().to_shapely()).is_empty


def test_questions() -> None:
    region = plate()
    assert region.classify([(0.5, 0.5), (1, 2), (2, 2), (9, 9)]).tolist() == [1, 0, -1, -1]
    assert region.cast((0, 2), (2, 0)).tolist() == [[0, 0.5], [1.5, 2], [2.5, 3], [3.5, 4]]
    # Along the lower side of a hole: boundary, not inside.
    assert region.cast((0, 1), (1, 0)).tolist() == [[0, 1], [3, 4], [7, 8]]
    assert (~region).cast((0, 10), (1, 1)).tolist() == [[-math.inf, math.inf]]
    assert region.cast((0, -1), (1, 0)).shape == (0, 2)
    nearest, distance = region.nearest([(2, 1.9), (-3, -4)])
    assert nearest.tolist() == [[2, 1], [0, 0]]
    assert distance.tolist() == pytest.approx([0.9, 5])


# Found: a section at the height on which a box stands is empty: it is the limit from below, and
# stays so.
def test_prisms_and_sections() -> None:
    region = plate() - R.circle(0.7, 24).translate(3.5, 3)
    solid = region.extrude(5)
    assert solid.volume == pytest.approx(5 * region.area)
    for z in (0.001, 2.5, math.pi, 5):
        assert solid.slice(z).equals(solid.slice(2.5))
        assert solid.slice(z).area == pytest.approx(region.area, abs=1e-8)
    assert solid.slice(0).is_empty
    assert solid.slice(5.001).is_empty
    assert plate().extrude(5).slice(1.234567).equals(plate())
    assert region.extrude(4, center=True).slice(0).area == pytest.approx(region.area)
    assert R.empty().extrude(1).is_empty
    assert b.extrude(plate(), 2).volume == 40


def test_frames_of_sections() -> None:
    solid = b.box((2, 3, 4))
    sizes = {(1, 0, 0): (3, 4), (0, 1, 0): (4, 2), (0, 0, 1): (2, 3)}
    for normal, size in sizes.items():
        assert solid.slice(1, normal).bounds.tolist() == [[0, 0], list(size)]  # type: ignore[union-attr]
        turned = solid.slice(-1, [-n for n in normal]).bounds
        assert turned.tolist() == [[0, 0], list(size[::-1])]  # type: ignore[union-attr]
        assert (solid.slice(2, [2 * n for n in normal])).equals(solid.slice(1, normal))
    for normal in [(1, 2, 3), (0, 1, 1), (-1, 0, 0), (0, 0, -2), (3, -1, 0)]:
        u, v = bsp.plane_frame(normal)
        assert np.allclose(np.cross(u, v), np.array(normal) / np.linalg.norm(normal))
    hexagon = b.cube(2).slice(normal=(1, 1, 1), origin=(1, 1, 1))
    assert len(hexagon.outlines[0].points) == 6
    assert hexagon.area == pytest.approx(3 * math.sqrt(3))


def test_section_agrees_with_the_solid() -> None:
    solid = (b.sphere(3, segments=16) - b.torus(2, 0.5)) | b.cube(2).rotate((10, 20, 30))
    for z in (-1.25, 0.3, 1.0):
        section = solid.slice(z)
        points = np.random.default_rng(1).uniform(-3.2, 3.2, (500, 2))
        heights = np.column_stack([points, np.full(500, z)])
        assert np.array_equal(section.classify(points), solid.classify(heights))


def test_revolved() -> None:
    ring = R.rectangle(1, 2).translate(3, 0).revolve(segments=64)
    assert ring.genus == 1
    assert ring.slice(1).area == pytest.approx(R.circle(4, 64).area - R.circle(3, 64).area)
    assert R.empty().revolve().is_empty
    with pytest.raises(b.InvalidMeshError):
        R.rectangle(2, center=True).revolve()


@pytest.mark.parametrize("count", [10_000])
def test_long_convex_outlines_stay_fast(count: int) -> None:
    start = time.perf_counter()
    circle = R.circle(10, count)
    lens = circle & circle.translate(5, 0)
    assert lens.tree.stats()["depth"] < 60
    assert len(lens.outlines) == 1
    exact = 2 * 100 * math.acos(0.25) - 2.5 * math.sqrt(400 - 25)
    assert lens.area == pytest.approx(exact, rel=1e-6)
    # About one second; a chain of this depth takes minutes.
    assert time.perf_counter() - start < 20


def test_long_chains_of_operations_keep_trees_small() -> None:
    region = R.rectangle(30, 30)
    square = R.rectangle(1)
    for k in range(200):
        hole = square.translate(1 + 2 * (k % 14), 1 + 2 * (k // 14 % 14))
        region = region - hole if k % 2 else (region - hole) | hole
    assert region.area_exact == 900 - 98
    assert region.tree.stats()["nodes"] < 3000


@pytest.mark.parametrize(
    ("outlines", "code"),
    [
        ([(0, 0), (1, 1)], "shape"),
        ([[(0, 0), (1, 1), (2, 0)], [(1, 2, 3)]], "shape"),
        ([(0, 0), (1, 0), (0, math.nan)], "non_finite"),
        (5, "invalid_parameter"),
        ([["a", "b"]], "shape"),
        ([(0, 0), (1e300, 0), (0, 1)], "too_large"),
    ],
)
def test_bad_outlines(outlines: Any, code: str) -> None:
    with pytest.raises(b.BspcsgError) as caught:
        R(outlines)
    assert caught.value.code == code


def test_bad_parameters() -> None:
    calls: list[Any] = [
        lambda: R.rectangle(0),
        lambda: R.circle(-1),
        lambda: R.circle(1, 2),
        lambda: R(STAR, winding="left"),  # type: ignore[arg-type]
        lambda: R.half_plane((0, 0), 1),
        lambda: R.half_plane((1, 0, 0), 1),
        lambda: plate().cast((0, 0), (0, 0)),
        lambda: plate().cast((0, math.inf), (1, 0)),
        lambda: plate().nearest([(math.nan, 0)]),
        lambda: plate().nearest([1, 2, 3]),
        lambda: R.full().nearest([(0, 0)]),
        lambda: plate().transform(np.zeros((3, 3))),
        lambda: plate().scale(0),
        lambda: plate().translate(1, 2, 3),
        lambda: plate().extrude(0),
        lambda: b.cube(1).slice(0, (0, 0, 0)),
        lambda: b.cube(1).slice(math.nan),
        lambda: R.from_segments([[(0, 0), (1, 0)]]),
    ]
    for call in calls:
        with pytest.raises(b.InvalidMeshError):
            call()
    with pytest.raises(b.UnboundedError):
        b.half_space((0, 0, 1)).slice(-1)
    with pytest.raises(b.LimitError):
        R.rectangle(1e8) | R([(0, 0), (1e-14, 0), (0, 1)], pitch=-15)


# Found: the perimeter of a complement was refused, although it is finite.
def test_the_perimeter_of_a_complement_is_that_of_the_region() -> None:
    assert (~plate()).perimeter == plate().perimeter
    assert R.full().perimeter == 0
    for endless in (R.half_plane((1, 0)), R.half_plane((1, 0)) - plate()):
        with pytest.raises(b.UnboundedError):
            endless.perimeter  # noqa: B018


def test_named_operations_take_regions() -> None:
    bars = [R.rectangle(2, 2).translate(k, 0) for k in range(5)]
    assert b.union(bars) == R.rectangle(6, 2)
    assert b.union(bars[0], bars[4:]) == bars[0] | bars[4]
    assert b.intersection(bars[:2]) == bars[0] & bars[1]
    assert b.difference(bars) == R.rectangle(1, 2)
    assert b.difference(bars[0]) == bars[0]
    assert b.xor(bars) == bars[0] ^ bars[1] ^ bars[2] ^ bars[3] ^ bars[4]


@pytest.mark.parametrize("other", [b.cube(1), 1, None, bsp.Intervals([(0, 1)])])
@pytest.mark.parametrize("operation", [b.union, b.intersection, b.difference, b.xor])
def test_named_operations_refuse_a_mixture(operation: Any, other: Any) -> None:
    for operands in [(R.rectangle(1, 1), other), (other, R.rectangle(1, 1))]:
        with pytest.raises(b.InvalidParameterError):
            operation(*operands)


def test_nearest_points_have_their_old_name() -> None:
    for one in (plate(), plate().tree, bsp.Intervals([(0, 1)])):
        with pytest.warns(
            DeprecationWarning, match=r"project will be removed .* use nearest"
        ) as warned:
            found = one.project([[0.5, 0.5][: one.dimension]])
        assert warned[0].filename == __file__
        assert (found[0] == one.nearest([[0.5, 0.5][: one.dimension]])[0]).all()


def test_the_suffix_chooses_how_a_drawing_is_saved(tmp_path: Path) -> None:
    region = R.rectangle(2, 1)
    for name in ("x.svg", "x.DXF"):
        region.save(tmp_path / name)
    assert R.from_svg(tmp_path / "x.svg") == R.from_dxf(tmp_path / "x.DXF") == region
    with pytest.raises(b.FormatError, match=r"ends in \.svg or \.dxf"):
        region.save(tmp_path / "x.png")
