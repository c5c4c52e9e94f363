"""Exact identities of regions, for random outlines."""

from typing import Any

import hypothesis.strategies as st
import numpy as np
from hypothesis import given

from bspcsg import bsp

_POINTS = st.tuples(st.integers(-6, 6), st.integers(-6, 6))
_LOOPS = st.lists(st.lists(_POINTS, min_size=3, max_size=7), min_size=0, max_size=3)
_RULES: st.SearchStrategy[Any] = st.sampled_from(["positive", "nonzero", "even-odd"])


@st.composite
def regions(draw: st.DrawFn) -> bsp.Region:
    region = bsp.Region(draw(_LOOPS), winding=draw(_RULES))
    return ~region if draw(st.booleans()) else region


@st.composite
def bounded(draw: st.DrawFn) -> bsp.Region:
    return bsp.Region(draw(_LOOPS), winding=draw(_RULES))


@given(regions(), regions(), regions())
def test_set_laws(x: bsp.Region, y: bsp.Region, z: bsp.Region) -> None:
    assert (~(x | y)).equals(~x & ~y)
    assert (x & (y | z)).equals((x & y) | (x & z))
    assert ((x ^ y) ^ y).equals(x)
    assert (x - y).equals(x & ~y)
    assert (x & y) <= x <= (x | y)
    assert (x & ~x).is_empty
    assert (x | ~x).is_full


@given(bounded(), bounded())
def test_areas_add_up(x: bsp.Region, y: bsp.Region) -> None:
    assert (x | y).area_exact + (x & y).area_exact == x.area_exact + y.area_exact
    assert (x ^ y).area_exact == x.area_exact + y.area_exact - 2 * (x & y).area_exact
    minus, plus = x.split((3, 4), 1)
    assert minus.area_exact + plus.area_exact == x.area_exact


@given(bounded(), bounded())
def test_outlines_depend_on_the_set_alone(x: bsp.Region, y: bsp.Region) -> None:
    one, other = x | y, ~(~y - x)
    assert one.exact_outlines == other.exact_outlines
    assert [o.parent for o in one.outlines] == [o.parent for o in other.outlines]


@given(bounded(), bounded())
def test_outlines_are_simple_and_nested(x: bsp.Region, y: bsp.Region) -> None:
    region = x ^ y
    outlines = region.outlines
    total = sum(outline.area for outline in outlines)
    assert np.isclose(total, region.area, atol=1e-9)
    for loop, outline in zip(region.exact_outlines, outlines, strict=True):
        assert len(set(loop)) == len(loop) >= 3
        assert min(loop) == loop[0]
        parent = outlines[outline.parent] if outline.parent >= 0 else None
        assert outline.is_hole == (outline.area < 0)
        assert (parent is None) if not outline.is_hole and parent is None else parent is not None
        assert parent is None or parent.is_hole != outline.is_hole
        assert parent is None or abs(parent.area) > abs(outline.area) - 1e-9


@given(bounded())
def test_components_are_apart_and_make_the_region(x: bsp.Region) -> None:
    parts = x.components
    # Corners off the lattice are rounded when a part is made a region of its own.
    assert np.isclose(sum(part.area for part in parts), x.area, atol=1e-7)
    assert all(len([o for o in part.outlines if not o.is_hole]) == 1 for part in parts)


@given(bounded(), st.integers(-50, 50), st.integers(-50, 50), st.integers(0, 3))
def test_lattice_motions_are_exact(x: bsp.Region, dx: int, dy: int, turns: int) -> None:
    there = x.translate(dx / 8, dy / 8).rotate(90 * turns).mirror((1, 1))
    assert there.area_exact == x.area_exact
    back = there.mirror((1, 1)).rotate(-90 * turns).translate(-dx / 8, -dy / 8)
    assert back.exact_outlines == x.exact_outlines


@given(bounded())
def test_convex_parts_make_the_region(x: bsp.Region) -> None:
    parts = x.convex_parts()
    assert np.isclose(sum(bsp.Region([p]).area for p in parts), x.area, atol=1e-7)
    for corners in parts:
        along = np.roll(corners, -1, axis=0) - corners
        after = np.roll(along, -1, axis=0)
        assert (along[:, 0] * after[:, 1] - along[:, 1] * after[:, 0] > -1e-7).all()
