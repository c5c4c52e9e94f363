"""Sets of points on the line."""

import math
import pickle
from fractions import Fraction
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import bspcsg as b
from bspcsg import bsp

INF = math.inf


@st.composite
def intervals(draw: st.DrawFn) -> bsp.Intervals:
    ends = st.integers(-6, 6).map(float)
    pair = st.tuples(ends, ends).filter(lambda p: p[0] < p[1])
    pairs: list[tuple[float, float]] = draw(st.lists(pair, max_size=4))
    ways: list[list[tuple[float, float]]] = [[], [(-INF, -5)], [(5, INF)], [(-INF, -5), (5, INF)]]
    unbounded = draw(st.sampled_from(ways))
    return bsp.Intervals([*pairs, *unbounded])


@given(intervals(), intervals(), intervals())
def test_laws(x: bsp.Intervals, y: bsp.Intervals, z: bsp.Intervals) -> None:
    assert (~(x | y)).equals(~x & ~y)
    assert (x & (y | z)).equals((x & y) | (x & z))
    assert (x ^ y).equals((x - y) | (y - x))
    assert (x & y) <= x
    assert x.equals(bsp.Intervals(x.pairs))


@given(intervals(), intervals())
def test_points_between(x: bsp.Intervals, y: bsp.Intervals) -> None:
    points = np.arange(-8, 8) + 0.5
    inside = [s.classify(points) > 0 for s in (x, y, x | y, x & y, x - y, x ^ y)]
    u, v, union, intersection, difference, xor = inside
    assert (union == (u | v)).all()
    assert (intersection == (u & v)).all()
    assert (difference == (u & ~v)).all()
    assert (xor == (u ^ v)).all()


def test_touching_intervals_are_one() -> None:
    assert bsp.Intervals([(0, 1), (1, 2)]).pairs.tolist() == [[0, 2]]
    assert (bsp.Intervals([(0, 1)]) & bsp.Intervals([(1, 2)])).is_empty


def test_measures() -> None:
    s = bsp.Intervals([(0, 1), (0.1, 0.3), (4, 6)])
    assert s.measure == 3
    assert s.length == 3.0
    assert s.centroid == pytest.approx((0.5 + 10) / 3)
    assert list(s.bounds or ()) == [0, 6]
    assert [part.pairs.tolist() for part in s.components] == [[[0, 1]], [[4, 6]]]
    assert s.classify([0, 0.5, 1, 2]).tolist() == [0, 1, 0, -1]
    nearest, distance = s.nearest([2, 3, -5, 0.4])
    assert nearest[:, 0].tolist() == [1, 4, 0, 0]
    assert distance.tolist() == [1, 1, 5, 0.4]
    assert bsp.Intervals([(0, 0.1)]).measure == Fraction(1, 10)
    assert math.isnan(bsp.Intervals().centroid)
    assert bsp.Intervals().bounds is None


def test_moves() -> None:
    s = bsp.Intervals([(0, 0.1), (1, INF)])
    assert s.translate(0.3).pairs.tolist() == [[0.3, 0.4], [1.3, INF]]
    assert s.scale(-2).pairs.tolist() == [[-INF, -2], [-0.2, 0]]
    assert s.translate(1 / 3).translate(-1 / 3).equals(s)


def test_many_intervals() -> None:
    ends = np.arange(40_000, dtype=float).reshape(-1, 2)
    s = bsp.Intervals(ends)
    assert s.measure == 20_000
    assert s.tree.stats()["depth"] < 40
    assert (bsp.Intervals.full() - s).pairs[1:-1].tolist() == ends.ravel()[1:-1].reshape(
        -1, 2
    ).tolist()


def test_value() -> None:
    s = bsp.Intervals([(0, 1)])
    assert repr(s) == "Intervals((0, 1))"
    assert repr(bsp.Intervals()) == "Intervals()"
    assert repr(bsp.Intervals.full()) == "Intervals((-inf, inf))"
    assert pickle.loads(pickle.dumps(s)).equals(s)
    assert isinstance(s | s, bsp.Intervals)


@pytest.mark.parametrize(
    "pairs", [[(1, 0)], [(1, 1)], [(0, math.nan)], [(INF, INF)], [(0, 1, 2)], "ab", [("a", "b")]]
)
def test_bad_pairs(pairs: Any) -> None:
    with pytest.raises(b.InvalidMeshError):
        bsp.Intervals(pairs)


def test_bad_questions() -> None:
    with pytest.raises(b.InvalidMeshError):
        bsp.Intervals().nearest([1])
    with pytest.raises(b.InvalidMeshError):
        bsp.Intervals([(0, 1)]).nearest([math.nan])
    with pytest.raises(b.InvalidMeshError):
        bsp.Intervals([(0, 1)]).scale(0)
    with pytest.raises(b.LimitError):
        bsp.Intervals([(0, 1e9)], pitch=-9)


# Found: the centroid of short intervals far out lay outside of them.
def test_the_centroid_of_a_short_interval_far_out_lies_in_it() -> None:
    for low, width in ((5e6, 1e-6), (100.0, 1e-6), (-5e6, 1e-9)):
        short = bsp.Intervals([(low, low + width)])
        assert short.centroid == pytest.approx(low + width / 2, rel=2e-16)
        line = bsp.SubHyperplane((0, 1), 0, short)
        assert abs(line.centroid[0]) == abs(short.centroid)


# Found: intervals that were moved or scaled forgot their lattice, so that short ones were lost;
# far enough they became unbounded.
def test_intervals_keep_their_lattice_wherever_they_are_moved() -> None:
    s = bsp.Intervals([(0, 1e-10), (5, 6)], pitch=-12)
    assert s.translate(1 + 1e-13) == s.translate(1)
    assert s.scale(1.5) == bsp.Intervals([(0, 1.5e-10), (7.5, 9)], pitch=-12)
    assert bsp.Intervals([(0, 1)], pitch=-15).scale(1000).pairs.tolist() == [[0, 1000]]
    assert bsp.Intervals([(0, 1)], pitch=-1).scale(0.01).pairs.tolist() == [[0, 0.01]]


def test_intervals_beyond_all_doubles_are_refused() -> None:
    s = bsp.Intervals([(0, 1e10), (1e11, INF)])
    for factor in (1e300, -1e300):
        with pytest.raises(b.LimitError):
            s.scale(factor)
    with pytest.raises(b.LimitError):
        s.translate(1e300)
