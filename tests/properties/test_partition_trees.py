"""Invariants of partition trees: facets, sides, and trees that are moved or rebuilt."""

from collections import defaultdict
from fractions import Fraction
from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from bspcsg import bsp

_whole = st.integers(-4, 4)
_policies = st.sampled_from(bsp.POLICIES)


@st.composite
def scenes(draw: st.DrawFn) -> Any:
    """Return a few facets on a small grid in one to three dimensions, with many coincidences."""
    dimension = draw(st.integers(1, 3))
    point = st.tuples(*[_whole] * dimension)
    facet = st.lists(point, min_size=dimension, max_size=dimension).filter(_has_extent)
    facets = np.array(draw(st.lists(facet, min_size=1, max_size=10)), dtype=float)
    return facets.ravel() if dimension == 1 else facets


def _has_extent(corners: list[tuple[int, ...]]) -> bool:
    points = np.array(corners)
    return len(points) == 1 or bool(
        np.linalg.matrix_rank(points[1:] - points[0]) == len(points) - 1
    )


def size(piece: Any) -> float:
    if len(piece) < 3:
        return float(np.linalg.norm(piece[-1] - piece[0])) if len(piece) == 2 else 1.0
    arms = piece - piece[0]
    return float(np.linalg.norm(np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)) / 2)


@given(scenes(), _policies, st.sampled_from([0, 2]))
def test_fragments_make_up_their_facets(facets: Any, policy: bsp.Policy, top: int) -> None:
    tree = bsp.PartitionTree(facets, policy, top=top)
    sizes: dict[int, float] = defaultdict(float)
    for source, piece in zip(tree.fragments.source.tolist(), tree.fragments, strict=True):
        sizes[source] += size(piece)
    whole = facets.reshape(len(facets), -1, tree.dimension)
    assert np.allclose([sizes[k] for k in range(len(whole))], [size(facet) for facet in whole])


@given(scenes(), _policies, st.sampled_from([0, 2]))
def test_fragments_lie_on_their_sides(facets: Any, policy: bsp.Policy, top: int) -> None:
    tree = bsp.PartitionTree(facets, policy, top=top)
    for number, piece in enumerate(tree.fragments):
        node = tree.nodes[int(tree.fragments.node[number])]
        normal, offset = node.hyperplane
        assert np.allclose(piece @ normal, offset, atol=1e-7)
        while node.parent is not None:
            above = node.parent
            normal, offset = above.hyperplane
            sign = 1 if above.minus == node else -1
            assert (sign * (piece @ normal - offset) < 1e-7).all()
            node = above


@given(scenes(), _policies, st.integers(0, 3))
def test_a_tree_is_rebuilt_from_its_text(facets: Any, policy: bsp.Policy, seed: int) -> None:
    tree = bsp.PartitionTree(facets, policy, seed=seed)
    again = bsp.PartitionTree.from_json(tree.to_json())
    assert again == tree
    assert np.array_equal(again.fragments.vertices, tree.fragments.vertices)


def _parts_at_a_tie(one: bsp.PartitionTree, other: bsp.PartitionTree) -> bool:
    """Return true if two trees chose different pivots whose scores are equal up to rounding.

    Shares of volumes are doubles, so the last bit decides between candidates that are as good.
    """
    for ours, theirs in zip(one.trace(), other.trace(), strict=True):
        a, b = ([c.score for c in division.candidates] for division in (ours, theirs))
        assert np.allclose(a, b, rtol=0, atol=1e-12)
        if ours.pivot != theirs.pivot:
            return True
    return False


@given(scenes(), _policies)
def test_a_shift_changes_nothing(facets: Any, policy: bsp.Policy) -> None:
    there, here = (bsp.PartitionTree(f, policy, pitch=-6) for f in (facets + 8, facets))
    if policy == "least-cost" and _parts_at_a_tie(there, here):
        return
    assert there.arrays["cut"].tolist() == here.arrays["cut"].tolist()
    assert np.allclose(there.fragments.vertices, here.fragments.vertices + 8)


@given(scenes(), _policies)
def test_every_node_holds_a_fragment(facets: Any, policy: bsp.Policy) -> None:
    tree = bsp.PartitionTree(facets, policy)
    assert (tree.arrays["end"] > tree.arrays["start"]).all()
    assert len(tree.fragments) == len(facets) + len(tree.splits)


@given(scenes(), st.data())
def test_the_painter_paints_everything_once(facets: Any, data: st.DataObject) -> None:
    tree = bsp.PartitionTree(facets)
    eye = [data.draw(st.floats(-9, 9)) for _ in range(tree.dimension)]
    order = tree.back_to_front(eye=eye)
    assert sorted(order.source) == sorted(tree.fragments.source)
    places = {node: k for k, node in enumerate(order.node.tolist())}
    for node in tree.nodes:
        value = exact_side(node, tree.pitch, eye)
        for child, sign in ((node.minus, -1), (node.plus, 1)):
            if child is not None and value != 0:
                farther = value * sign < 0
                assert (places[child.index] < places[node.index]) == farther


def exact_side(node: bsp.Node, pitch: int, eye: list[float]) -> int:
    *normal, constant = node.coefficients
    steps = [Fraction(x) / Fraction(10) ** pitch for x in eye]
    value = sum((n * x for n, x in zip(normal, steps, strict=True)), Fraction(constant))
    return int(value > 0) - int(value < 0)
