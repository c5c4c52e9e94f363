"""Comparisons of solids, regions, intervals and trees, with one meaning for all."""

import operator
import pickle
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from bspcsg.solid.point_set import PointSet


@dataclass(frozen=True)
class Kind:
    """The functions that make boxes, half-spaces and empty sets of one class."""

    dimension: int
    box: Callable[[float, float], Any]
    half: Callable[[float], Any]
    empty: Callable[[], Any]


def tree_box(dimension: int) -> Callable[[float, float], bsp.ObjectTree]:
    def make(low: float, high: float) -> bsp.ObjectTree:
        sides = [
            bsp.ObjectTree.half_space(sign * axis, sign * at)
            for axis in np.eye(dimension)
            for sign, at in ((1, high), (-1, low))
        ]
        whole = bsp.ObjectTree.uniform(dimension, full=True)
        for side in sides:
            whole &= side
        return whole

    return make


def tree_kind(dimension: int) -> Kind:
    return Kind(
        dimension,
        tree_box(dimension),
        lambda at: bsp.ObjectTree.half_space(np.eye(dimension)[0], at),
        lambda: bsp.ObjectTree.uniform(dimension, full=False),
    )


KINDS = {
    "Solid": Kind(
        3,
        lambda low, high: b.cube(high - low).translate([low] * 3),
        lambda at: b.half_space((1, 0, 0), at),
        b.Solid.empty,
    ),
    "Region": Kind(
        2,
        lambda low, high: bsp.Region.rectangle(high - low).translate(low, low),
        lambda at: bsp.Region.half_plane((1, 0), at),
        bsp.Region.empty,
    ),
    "Intervals": Kind(
        1,
        lambda low, high: bsp.Intervals([(low, high)]),
        lambda at: bsp.Intervals([(-np.inf, at)]),
        bsp.Intervals.empty,
    ),
    **{f"ObjectTree {d}D": tree_kind(d) for d in (1, 2, 3)},
}
every_kind = pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)


def same(kind: Kind) -> list[Any]:
    """Return one set, made in many ways."""
    box = kind.box
    whole = box(0, 4)
    return [
        whole,
        box(0, 4),
        (whole - kind.half(1)) | (whole & kind.half(1)),
        ~~whole,
        ~(~box(0, 5) | ~box(-1, 4)),
        pickle.loads(pickle.dumps(whole)),
        (whole ^ box(1, 2)) ^ box(1, 2),
    ]


# Found: regions compared by identity only.
@every_kind
def test_equal_sets_are_equal_however_they_were_made(kind: Kind) -> None:
    for a in same(kind):
        for c in same(kind):
            assert a == c
            assert c.equals(a)
            assert not a != c  # noqa: SIM202
            assert hash(a) == hash(c)
            assert a <= c
            assert a >= c
            assert not a < c
            assert not a > c
    assert len(set(same(kind))) == 1
    assert {same(kind)[0]: 1}[same(kind)[2]] == 1


@every_kind
def test_unbounded_sets(kind: Kind) -> None:
    outside = [~one for one in same(kind)]
    assert len(set(outside)) == 1
    assert hash(outside[0]) != hash(same(kind)[0])
    half = kind.half(1)
    assert half == kind.half(2) & half == ~~half
    assert hash(half) == hash(kind.half(2) & half)
    assert half != kind.half(2)
    assert half < kind.half(2)
    assert ~half > ~kind.half(2)
    assert half | ~half == ~kind.empty()
    assert hash(half | ~half) == hash(~kind.empty())


@every_kind
def test_the_lattice_does_not_count(kind: Kind) -> None:
    coarse = kind.box(0, 4)
    fine = pitched(kind)
    assert fine.pitch != coarse.pitch
    assert fine == coarse
    assert hash(fine) == hash(coarse)
    assert hash(~fine) == hash(~coarse)


def pitched(kind: Kind) -> Any:
    box = kind.box(0, 4)
    if isinstance(box, b.Solid):
        return b.Solid(*box.to_mesh(), pitch=-12)
    if isinstance(box, bsp.Region):
        return bsp.Region(box.to_polygons(), pitch=-12)
    if isinstance(box, bsp.Intervals):
        return bsp.Intervals(box.pairs, pitch=-12)
    fine = bsp.ObjectTree.half_space(np.eye(kind.dimension)[0], 1, pitch=-12)
    return (box & fine) | (box - fine)


@every_kind
def test_order(kind: Kind) -> None:
    small, large, apart = kind.box(1, 2), kind.box(0, 4), kind.box(5, 6)
    assert small < large
    assert small <= large
    assert large > small
    assert large >= small
    assert not large <= small
    assert not large < small
    assert small != large
    for one, other in ((small, apart), (apart, small)):
        assert not (one <= other or one < other or one >= other or one > other or one == other)
    assert kind.empty() < small < ~kind.empty()
    assert small.isdisjoint(apart)


@every_kind
def test_membership(kind: Kind) -> None:
    box = kind.box(0, 4)

    def point(x: float) -> Any:
        return x if kind.dimension == 1 else [x] * kind.dimension

    assert point(2) in box
    assert point(0) in box  # sets are closed
    assert point(4.0) in box
    assert point(4.0000001) not in box
    assert point(5) in ~box
    assert point(0) in ~box
    assert np.full(kind.dimension, 1.0)[0 if kind.dimension == 1 else slice(None)] in box
    for nonsense in (box, "a", None, [1.0] * (kind.dimension + 1), [[1.0] * kind.dimension] * 2):
        with pytest.raises(b.BspcsgError):
            nonsense in box  # noqa: B015


@every_kind
def test_other_things_are_not_equal_and_have_no_order(kind: Kind) -> None:
    box = kind.box(0, 4)
    others: list[Any] = [4, "box", None, [box], bsp.PartitionTree([0.0, 1.0])]
    for other in others:
        assert box != other
        assert not box == other  # noqa: SIM201
        for compare in (operator.le, operator.lt, operator.ge, operator.gt):
            with pytest.raises(TypeError):
                compare(box, other)


def test_sets_of_different_spaces_are_different() -> None:
    boxes = [kind.box(0, 4) for kind in KINDS.values()]
    for k, a in enumerate(boxes):
        for m, c in enumerate(boxes):
            alike = isinstance(a, b.Solid) == isinstance(c, b.Solid) and (
                isinstance(a, b.Solid) or a.dimension == c.dimension
            )
            assert (a == c) == alike, (k, m)
            if alike:
                assert hash(a) == hash(c)
            else:
                with pytest.raises(TypeError):
                    a <= c  # noqa: B015


def test_all_kinds_of_sets_are_tested() -> None:
    def below(kind: type) -> set[type]:
        return {kind}.union(*map(below, kind.__subclasses__()))

    public = {kind for kind in below(PointSet) if kind.__name__ in (*b.__all__, *bsp.__all__)}
    assert public == {b.Solid, bsp.ObjectTree, bsp.Region, bsp.Intervals}
    for kind in public:
        assert not {"__eq__", "__hash__", "__le__", "__lt__", "__contains__"} & {*vars(kind)}


def test_comparing_counts_nothing_in_a_block() -> None:
    with b.union() as made:
        a, c = b.cube(2), b.cube(1)
        assert c < a != c
        assert (1, 1, 1) in a
        assert len({a, c}) == 2
    assert made.solid == a


def test_partition_trees_are_equal_if_facets_and_cuts_are() -> None:
    facets = np.array([[[0, 0], [4, 0]], [[2, -1], [2, 1]]], dtype=np.float64)
    one, other = bsp.PartitionTree(facets, "first"), bsp.PartitionTree(facets, "first")
    assert one == other
    assert hash(one) == hash(other)
    assert one != bsp.PartitionTree(facets[::-1], "first")
    assert one != bsp.PartitionTree(facets, "first", pitch=-6)
    assert len({one, other}) == 1


# Found: `() in` a set raised an `IndexError`.
@every_kind
def test_nothing_is_no_point(kind: Kind) -> None:
    with pytest.raises(b.InvalidParameterError, match="A point must be one tuple of coordinates"):
        _ = () in kind.box(0, 1)
