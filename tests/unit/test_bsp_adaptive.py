"""Adaptive and static trees: equal hits, and correct counters."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from bspcsg._types import FloatArray
from support.shapes import icosphere


def soup(dimension: int, count: int, seed: int = 0) -> FloatArray:
    """Return random facets that cross each other, (n, d, d), or (n,) in 1D."""
    rng = np.random.default_rng(seed)
    centres = rng.uniform(-10, 10, (count, 1, dimension))
    facets = centres + rng.normal(size=(count, dimension, dimension)) * 2
    return facets.reshape(-1) if dimension == 1 else facets


def rays(dimension: int, count: int, seed: int = 1) -> tuple[FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    origins = rng.uniform(-14, 14, (count, dimension))
    return origins, rng.uniform(-8, 8, (count, dimension)) - origins


def assert_same_hits(one: bsp.Hits, other: bsp.Hits) -> None:
    for name in ("facet", "t", "kind", "weights", "point", "normal"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_answers_are_the_static_ones_ray_by_ray(dimension: int) -> None:
    facets = soup(dimension, 120)
    origins, directions = rays(dimension, 3000)
    trees: list[bsp.StabTree] = [
        bsp.AdaptiveTree(facets, threshold=threshold) for threshold in (0, 5, 1000)
    ]
    trees += [bsp.StaticTree(facets, order=order, seed=7) for order in ("given", "random")]
    trees += [bsp.optimised_tree(facets, origins, directions)]
    caster = bsp.RayCaster(facets, pitch=trees[0].pitch)
    expected = caster.first_hit(origins, directions)
    for tree in trees:
        assert_same_hits(tree.test_ray(origins, directions).hits, expected)
    assert 0.3 < expected.hit.mean() <= 1


def test_answers_on_degenerate_rays() -> None:
    """Lattice rays through vertices, along edges and within faces of a solid and its walls."""
    rng = np.random.default_rng(3)
    solid = b.cube(4) - b.cube(2).translate(1, 1, 2)
    origins = rng.integers(-2, 7, (3000, 3)).astype(float)
    directions = rng.integers(-2, 3, (3000, 3)).astype(float)
    directions[(directions == 0).all(axis=1)] = (0, 0, 1)
    expected = bsp.RayCaster(solid).first_hit(origins, directions)
    adaptive = bsp.AdaptiveTree(solid, threshold=3)
    assert_same_hits(adaptive.test_ray(origins, directions).hits, expected)
    assert adaptive.stats().subdivisions > 5
    assert_same_hits(bsp.StaticTree(solid).test_ray(origins, directions).hits, expected)
    assert (np.bincount(expected.kind + 1) > 50).all()


def test_it_starts_as_one_leaf_and_divides_after_the_threshold() -> None:
    tree = bsp.AdaptiveTree(soup(3, 30), threshold=4)
    start = tree.stats()
    assert (start.nodes, start.leaves, start.depth, start.fragments) == (1, 1, 0, 30)
    outwards = [[0.0, 0.0, 0.0]] * 4, [0.3, 0.2, 1.0]
    four = tree.test_ray(*outwards)
    assert four.tests.tolist() == [30] * 4
    assert four.leaves.tolist() == [1] * 4
    assert len(tree) == 1
    tree.test_ray([0.0, 0.0, 0.0], [0.3, 0.2, 1.0])
    stats = tree.stats()
    assert (stats.nodes, stats.leaves, stats.depth, stats.subdivisions) == (3, 2, 1, 1)
    assert stats.rays == 5
    assert stats.fragments >= 30
    assert repr(tree).startswith("AdaptiveTree(3 nodes")


def test_the_facet_with_most_hits_becomes_the_cut() -> None:
    walls = [[[x, -5.0], [x, 5.0]] for x in (0.0, 1.0, 2.0, 3.0)]
    tree = bsp.AdaptiveTree(walls, threshold=3)
    # Upwards beside the others, from below the third: it alone is hit by the first rays.
    low = [[2.5, 0.0]] * 4, [-1.0, 0.0]
    short = bsp.AdaptiveTree([*walls[2:3], *walls[:2], *walls[3:]], threshold=3)
    for grown in (tree, short):
        grown.test_ray(*low)
    # Rays to the left hit walls at 2, 1 and 0 as lines: the first of the input wins the tie.
    right = tree.test_ray([-1.0, 0.0], [1.0, 0.0])
    assert right.hits.facet.tolist() == [0]
    assert right.tests[0] == 1
    assert short.test_ray([2.5, 0.0], [-1.0, 0.0]).nodes.tolist() == [2]


def test_counts_of_a_static_tree_are_those_of_the_notes() -> None:
    walls = [[[float(x), -1.0], [float(x), 1.0]] for x in range(8)]
    tree = bsp.StaticTree(walls, order="given")
    assert (tree.stats().nodes, tree.stats().depth) == (15, 7)
    # From the far side the ray visits all seven cuts down to the last leaf, hits there and stops.
    tests = tree.test_ray([9.0, 0.0], [-1.0, 0.0])
    assert tests.nodes.tolist() == [8]
    assert tests.leaves.tolist() == [1]
    assert tests.tests.tolist() == [1]
    whole = tree.test_ray([-1.0, 0.5], [1.0, 0.0])
    assert (whole.nodes[0], whole.leaves[0], whole.tests[0]) == (2, 1, 1)
    # C(T) = nodes visited ≤ depth · stabbed leaves, with the leaves' own visits counted.
    facets = soup(3, 60)
    tree = bsp.StaticTree(facets)
    tests = tree.test_ray(*rays(3, 500))
    assert (tests.nodes <= (tree.stats().depth + 1) * tests.leaves).all()


def test_a_skewed_distribution_pays_and_answers_stay() -> None:
    vertices, faces = icosphere(3)
    facets = np.concatenate([vertices[faces] + [3.0 * k, 0, 0] for k in range(3)])
    rng = np.random.default_rng(5)
    aims = np.array([0, 0, 1.0]) + rng.normal(size=(4000, 3)) * 0.05
    origins = aims + [0, 0, 5.0]
    tree = bsp.AdaptiveTree(facets, threshold=32)
    tests = tree.test_ray(origins, aims - origins)
    assert_same_hits(tests.hits, bsp.RayCaster(facets).first_hit(origins, aims - origins))
    assert tests.tests[-1000:].mean() < tests.tests[0] / 20
    assert tree.stats().nodes < len(facets)


def test_threads_share_a_tree_that_grows() -> None:
    facets = soup(3, 80)
    tree = bsp.AdaptiveTree(facets, threshold=2)
    caster = bsp.RayCaster(facets)
    batches = [rays(3, 200, seed) for seed in range(12)]
    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(lambda batch: tree.test_ray(*batch).hits, batches))
    for batch, answer in zip(batches, answers, strict=True):
        assert_same_hits(answer, caster.first_hit(*batch))
    assert tree.stats().rays == 2400
    nodes = tree.nodes
    # Every ray visits the root, and a node is visited through the one above it.
    assert nodes.visits[0] == 2400
    for node in range(len(nodes)):
        for child in (nodes.minus[node], nodes.plus[node]):
            assert child < 0 or nodes.visits[child] <= nodes.visits[node]


def test_long_lists_are_searched_and_counted_as_short_ones() -> None:
    # The same rays at facets alone and among others far off, which make the list a long one.
    few = soup(3, 40)
    many = np.concatenate([few + [1e4 * k, 0, 0] for k in range(120)])
    short, long = (bsp.AdaptiveTree(f, threshold=10**6, pitch=-9) for f in (few, many))
    origins, directions = rays(3, 300, 3)
    one, other = short.test_ray(origins, directions), long.test_ray(origins, directions)
    assert one.hits.facet.tolist() == other.hits.facet.tolist()
    assert (other.tests < one.tests).all()
    hits = {int(f): int(h) for f, h in zip(short.nodes.facets, short.nodes.hits, strict=True)}
    for facet, count in zip(long.nodes.facets, long.nodes.hits, strict=True):
        if facet < len(few):
            assert hits[int(facet)] == count


def test_scores_by_hand() -> None:
    walls = [[[0, 0], [0, 3]], [[0, 0], [1, 0]]]
    # Lengths 3 and 1 of 4; the ray has the direction (3, 4) / 5.
    found = bsp.scores(walls, [5, 5], [3, 4], weights=[2.0])
    np.testing.assert_allclose(found, [2 * 0.6 * 3 / 4, 2 * 0.8 / 4])
    np.testing.assert_allclose(bsp.scores([1.0, 2.0], [0.0, 0.0], [1.0, -5.0]), [0.5, 0.5])


def test_scores_are_the_sum_over_the_sample() -> None:
    facets, (origins, directions) = soup(3, 9), rays(3, 700)
    omega = np.random.default_rng(0).random(700)
    found = bsp.scores(facets, origins, directions, weights=omega)
    crosses = np.cross(facets[:, 1] - facets[:, 0], facets[:, 2] - facets[:, 0])
    areas = np.linalg.norm(crosses, axis=1) / 2
    expected = np.zeros(9)
    for weight, direction in zip(omega, directions, strict=True):
        along = np.abs(crosses @ direction) / np.linalg.norm(direction) / (2 * areas)
        expected += weight * along * areas / areas.sum()
    np.testing.assert_allclose(found, expected)
    uniform = bsp.scores(facets, origins, directions, density=lambda o, d: 700 * omega)
    np.testing.assert_allclose(uniform, expected)
    huge = bsp.scores(facets, origins, directions * 1e306, weights=omega)
    np.testing.assert_allclose(huge, expected)


def test_the_highest_score_is_cut_first() -> None:
    walls = [[[float(x), -(x + 1.0)], [float(x), x + 1.0]] for x in range(6)]
    tree = bsp.optimised_tree(walls, [9.0, 0.0], [-1.0, 0.0])
    # The longest wall, the last, is the root: from its far side the ray ends at it.
    tests = tree.test_ray([9.0, 0.0], [-1.0, 0.0])
    assert (tests.nodes[0], tests.tests[0]) == (2, 1)
    assert tests.hits.facet.tolist() == [5]


def test_an_order_is_the_order_of_cuts() -> None:
    walls = [[[float(x), -1.0], [float(x), 1.0]] for x in range(3)]
    order = [2, 0, 1]
    tree = bsp.StaticTree(walls, order=order)
    assert tree.test_ray([9.0, 0.0], [-1.0, 0.0]).nodes.tolist() == [2]
    with pytest.raises(b.LimitError):
        bsp.StaticTree(soup(3, 50), max_nodes=20)


BAD: list[tuple[Callable[[], object], str]] = [
    (lambda: bsp.AdaptiveTree(soup(3, 3), threshold=-1), "invalid_parameter"),
    (lambda: bsp.AdaptiveTree(soup(3, 3), threshold=1.5), "invalid_parameter"),  # type: ignore[arg-type]
    (lambda: bsp.AdaptiveTree([[[0, 0], [1, np.nan]]]), "non_finite"),
    (lambda: bsp.AdaptiveTree(soup(2, 3), pitch=-18), "too_large"),
    (lambda: bsp.AdaptiveTree(soup(3, 3)).test_ray([0, 0, 0], [0, 0, 0]), "bad_normal"),
    (lambda: bsp.StaticTree(soup(3, 3), order="best"), "invalid_parameter"),
    (lambda: bsp.StaticTree(soup(3, 3), order=[0, 1, 1]), "invalid_parameter"),
    (lambda: bsp.StaticTree(soup(3, 3), order=[0, 1]), "invalid_parameter"),
    (lambda: bsp.scores(soup(3, 3), [0, 0, 0], [0, 0, 0]), "bad_normal"),
    (lambda: bsp.scores(soup(3, 3), [0, 0, 0], [0, 0, np.inf]), "bad_normal"),
    (lambda: bsp.scores(soup(3, 3), [0, 0, 0], [0, 0, 1], weights=[-1]), "invalid_parameter"),
    (lambda: bsp.scores(soup(3, 3), [0, 0, 0], [0, 0, 1], weights=[1, 2]), "invalid_parameter"),
]


@pytest.mark.parametrize(("call", "code"), BAD)
def test_bad_input_is_refused(call: Callable[[], object], code: str) -> None:
    with pytest.raises(b.BspcsgError) as caught:
        call()
    assert caught.value.code == code


def test_nothing_to_hit() -> None:
    for tree in (bsp.AdaptiveTree(np.zeros((0, 3, 3))), bsp.StaticTree(np.zeros((2, 3, 3)))):
        tests = tree.test_ray([0, 0, 0], [1, 0, 0])
        assert tests.hits.facet.tolist() == [-1]
    single = bsp.AdaptiveTree([2.0], threshold=0)
    found = single.test_ray([[0.0]] * 9, [1.0])
    assert float(Fraction(2)) == found.hits.t[-1]
    assert len(single) == 1


# Found: the region of a ray tree without facets ended in a raw `ValueError`.
@pytest.mark.parametrize(("shape", "size"), [((0,), 2), ((0, 2, 2), 4), ((0, 3, 3), 6)])
def test_regions_of_trees_without_facets(shape: tuple[int, ...], size: int) -> None:
    for tree in (bsp.AdaptiveTree(np.zeros(shape)), bsp.StaticTree(np.zeros(shape))):
        region = tree.region(0)
        assert len(region) == size
        assert np.abs(np.array(region)).max() == pytest.approx(1)


# Found: fractions were cut off in the order of a `StaticTree`.
@pytest.mark.parametrize("order", [[0.9, 1.9], [0.0, 0.5], [False, True], [0, np.nan], [0, 2**70]])
def test_orders_are_of_whole_numbers(order: object) -> None:
    facets = [[[0, 0], [1, 0]], [[0, 1], [1, 1]]]
    with pytest.raises(b.InvalidParameterError, match=r"^order must "):
        bsp.StaticTree(facets, order=order)
    assert len(bsp.StaticTree(facets, order=[1.0, 0.0])) == 3
