"""Pivot policies, and the costs of their trees against brute force."""

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp

#: A chance below this is taken for impossible.
FAILURE = 1e-6


def hoeffding(width: float, count: int) -> float:
    """Return how far a mean of `count` values may be off, except with probability FAILURE."""
    return width * math.sqrt(math.log(2 / FAILURE) / (2 * count))


def scene(dimension: int, count: int = 10, seed: int = 0) -> Any:
    random = np.random.default_rng(seed)
    shape = (count,) if dimension == 1 else (count, dimension, dimension)
    return random.uniform(-1, 1, shape)


class TestPolicies:
    @pytest.mark.parametrize("policy", bsp.POLICIES)
    @pytest.mark.parametrize("dimension", [1, 2, 3])
    def test_the_same_call_makes_the_same_tree(self, policy: bsp.Policy, dimension: int) -> None:
        facets = scene(dimension, 30)
        trees = [bsp.PartitionTree(facets, policy, seed=7) for _ in range(2)]
        assert trees[0].to_json() == trees[1].to_json()

    def test_first_takes_facets_in_the_order_given(self) -> None:
        tree = bsp.PartitionTree(scene(2, 30), "first")
        for node in tree.nodes:
            below = [node.coplanar.source[0]]
            parent = node.parent
            while parent is not None:
                below.append(parent.pivot)
                parent = parent.parent
            assert below == sorted(below, reverse=True)

    def test_random_depends_on_the_seed_alone(self) -> None:
        facets = scene(2, 30)
        roots = {
            node.pivot
            for seed in range(40)
            if (node := bsp.PartitionTree(facets, "random", seed=seed).root)
        }
        # That 40 draws of 30 all fall on less than 10 has a chance below 1e-11.
        assert len(roots) >= 10

    def test_all_pivots_are_equally_likely(self) -> None:
        count, orders = 5, 4000
        roots = [
            bsp.PartitionTree(np.arange(5.0), "random", seed=seed).arrays["cut"][0, 1]
            for seed in range(orders)
        ]
        shares = np.bincount(roots, minlength=count) / orders
        assert np.abs(shares - 1 / count).max() < hoeffding(1, orders) * 1.1

    def test_least_splits_finds_what_cuts_nothing(self) -> None:
        # The first line cuts the two others, whose own lines cut nothing.
        facets = [[[0, 0], [1, 0]], [[3, -1], [3, 1]], [[5, -2], [5, 2]]]
        assert len(bsp.PartitionTree(facets, "first").splits) == 2
        assert len(bsp.PartitionTree(facets, "least-splits").splits) == 0

    def test_balanced_halves_points(self) -> None:
        tree = bsp.PartitionTree(np.arange(127.0), "balanced", sample=127)
        assert tree.stats().depth == 7
        assert tree.stats().balance == 1

    def test_weights_lead_from_splits_to_balance(self) -> None:
        facets = scene(2, 60)
        trees = [
            bsp.PartitionTree(facets, "weighted", alpha=alpha, sample=60) for alpha in (0.0, 1.0)
        ]
        assert trees[0] == bsp.PartitionTree(facets, "least-splits", sample=60)
        assert trees[1] == bsp.PartitionTree(facets, "balanced", sample=60)
        assert len(trees[0].splits) < len(trees[1].splits)
        assert trees[0].stats().depth > trees[1].stats().depth

    def test_least_cost_cuts_off_empty_space_first(self) -> None:
        # A crowd on the left; the line at 5 leaves nine tenths of the length empty.
        points = [*np.linspace(0, 4, 9), 5.0, 50.0]
        costs = {
            policy: bsp.PartitionTree(points, policy, sample=11).cost()
            for policy in ("least-cost", "balanced")
        }
        assert costs["least-cost"] < costs["balanced"]

    @pytest.mark.parametrize("policy", bsp.POLICIES)
    def test_a_convex_body_is_a_chain_without_axis_cuts(self, policy: bsp.Policy) -> None:
        corners = np.array([[k, k * k] for k in range(-50, 51)], dtype=float)
        outline = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
        chain = bsp.PartitionTree(outline, policy)
        assert chain.stats().depth == len(chain) == 101
        assert bsp.PartitionTree(outline, policy, top=4).stats().depth < 15

    def test_axis_cuts_leave_no_more_facets_than_asked(self) -> None:
        tree = bsp.PartitionTree(np.arange(200.0), "first", top=4)
        for node in tree.nodes:
            if not node.is_free and (node.parent is None or node.parent.is_free):
                below = sum(1 for other in tree.nodes if _is_below(other, node))
                assert below <= 4


def _is_below(node: bsp.Node | None, other: bsp.Node) -> bool:
    while node is not None and node != other:
        node = node.parent
    return node is not None


def exact_cost(tree: bsp.PartitionTree, node: bsp.Node | None, polygon: Any) -> Fraction:
    """Return the expected cost C(T) of a tree by its definition, with exact areas."""
    if node is None:
        return Fraction(0)
    step = Fraction(10) ** tree.pitch
    a, c, d = (Fraction(k) for k in node.coefficients)
    sides = [clipped(polygon, (a * s, c * s, d * s * step)) for s in (1, -1)]
    shares = [area(side) / area(polygon) for side in sides]
    below = [exact_cost(tree, *pair) for pair in zip((node.minus, node.plus), sides, strict=True)]
    return 1 + shares[0] * below[0] + shares[1] * below[1]


def exact_cost_of(tree: bsp.PartitionTree) -> Fraction:
    corners, _ = tree.core.lattice()
    step = Fraction(10) ** tree.pitch
    reach = max(round(tree.margin / float(step)), 1)
    (x, y), (u, v) = corners.min(axis=0) - reach, corners.max(axis=0) + reach
    square = [(x, y), (u, y), (u, v), (x, v)]
    polygon = [(int(p) * step, int(q) * step) for p, q in square]
    return exact_cost(tree, tree.root, polygon)


def clipped(polygon: Any, line: Any) -> Any:
    a, c, d = line
    values = [a * x + c * y + d for x, y in polygon]
    kept = []
    for k, (p, value) in enumerate(zip(polygon, values, strict=True)):
        q, other = polygon[(k + 1) % len(polygon)], values[(k + 1) % len(polygon)]
        if value <= 0:
            kept.append(p)
        if value * other < 0:
            t = value / (value - other)
            kept.append(tuple(s + t * (e - s) for s, e in zip(p, q, strict=True)))
    return kept


def area(polygon: Any) -> Fraction:
    pairs = zip(polygon, [*polygon[1:], *polygon[:1]], strict=True)
    return sum(((x * v - u * y) for (x, y), (u, v) in pairs), Fraction(0)) / 2


class TestCost:
    @pytest.mark.parametrize("policy", bsp.POLICIES)
    def test_against_rational_areas(self, policy: bsp.Policy) -> None:
        tree = bsp.PartitionTree(scene(2, 8), policy)
        assert tree.cost("point") == pytest.approx(float(exact_cost_of(tree)), rel=1e-12)

    def test_a_known_tree_on_the_line(self) -> None:
        tree = bsp.PartitionTree([1.0, 3.0], "first", margin=1)
        # The second cut is met in three quarters of the interval from 0 to 4.
        assert tree.cost("point") == 1.75
        assert tree.cost("ray") == 2
        assert tree.cost("point", margin=3) == 1 + 5 / 8

    def test_a_known_tree_in_space(self) -> None:
        square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
        tree = bsp.PartitionTree([square, square + [0, 0, 1]], "first", margin=1)
        # The box is 3×3×3, the second cut is met in its upper two thirds.
        assert tree.cost("point") == pytest.approx(1 + 2 / 3, rel=1e-12)
        assert tree.cost("ray") == pytest.approx(1 + (2 * 9 + 4 * 6) / 54, rel=1e-12)

    @pytest.mark.parametrize("dimension", [1, 2, 3])
    def test_random_points_visit_as_many_nodes(self, dimension: int) -> None:
        tree = bsp.PartitionTree(scene(dimension, 12), "random", seed=5)
        low, high = box_of(tree)
        random = np.random.default_rng(6)
        count = 20000
        visits = np.zeros(count)
        points = random.uniform(low, high, (count, dimension))
        normal, offset = tree.arrays["normal"], tree.arrays["offset"]
        reached = {0: np.arange(count)}
        for node in range(len(tree)):
            here = reached.get(node, np.zeros(0, dtype=int))
            visits[here] += 1
            inside = points[here] @ normal[node] < offset[node]
            reached[int(tree.arrays["minus"][node])] = here[inside]
            reached[int(tree.arrays["plus"][node])] = here[~inside]
        bound = hoeffding(tree.stats().depth, count)
        assert visits.mean() == pytest.approx(tree.cost("point"), abs=bound)

    @pytest.mark.parametrize("dimension", [2, 3])
    def test_random_lines_visit_as_many_nodes(self, dimension: int) -> None:
        tree = bsp.PartitionTree(scene(dimension, 5), "random", seed=5)
        low, high = box_of(tree)
        random = np.random.default_rng(9)
        middle, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
        visits: list[int] = []
        while len(visits) < 5000:
            along = random.normal(size=dimension)
            along /= np.linalg.norm(along)
            # Lines of even density meet the ball evenly spread over the disc across them.
            foot = across(along, random) * radius
            ends = sorted_ends(middle + foot, along, low, high)
            if ends is not None:
                visits.append(visited(tree, middle + foot, along, ends))
        bound = hoeffding(len(tree), len(visits))
        assert np.mean(visits) == pytest.approx(tree.cost("ray"), abs=bound)
        assert tree.cost("ray") > tree.cost("point") + bound

    def test_bad_queries_are_refused(self) -> None:
        tree = bsp.PartitionTree([1.0])
        with pytest.raises(b.InvalidMeshError):
            tree.cost("box")  # type: ignore[arg-type]
        with pytest.raises(b.InvalidMeshError):
            tree.cost("point", margin=math.inf)


def across(along: Any, random: np.random.Generator) -> Any:
    """Return a random point of the unit disc (interval in 2D) perpendicular to a direction."""
    if len(along) == 2:
        return np.array([-along[1], along[0]]) * random.uniform(-1, 1)
    first = np.linalg.svd(along[None])[2][1:]
    turn, reach = random.uniform(0, 2 * np.pi), math.sqrt(random.uniform())
    return reach * (math.cos(turn) * first[0] + math.sin(turn) * first[1])


def box_of(tree: bsp.PartitionTree) -> tuple[Any, Any]:
    region = tree.region()
    corners = np.concatenate(region) if isinstance(region, list) else np.asarray(region)
    corners = corners.reshape(-1, tree.dimension)
    return corners.min(axis=0), corners.max(axis=0)


def sorted_ends(start: Any, along: Any, low: Any, high: Any) -> tuple[float, float] | None:
    walls = np.sort(np.stack([(low - start) / along, (high - start) / along]), axis=0)
    first, last = float(walls[0].max()), float(walls[1].min())
    return (first, last) if first < last else None


def visited(tree: bsp.PartitionTree, start: Any, along: Any, ends: tuple[float, float]) -> int:
    """Return the number of nodes whose regions a line meets, by clipping the line."""
    pending, count = [(0, ends)], 0
    while pending:
        node, (first, last) = pending.pop()
        count += 1
        normal, offset = tree.arrays["normal"][node], tree.arrays["offset"][node]
        slope, value = normal @ along, normal @ start - offset
        values = value + slope * first, value + slope * last
        minus, plus = int(tree.arrays["minus"][node]), int(tree.arrays["plus"][node])
        if values[0] * values[1] >= 0:
            child = minus if sum(values) < 0 else plus
            pending += [(child, (first, last))] if child >= 0 else []
            continue
        at = -value / slope
        near, far = (minus, plus) if values[0] < 0 else (plus, minus)
        pending += [(near, (first, at))] if near >= 0 else []
        pending += [(far, (at, last))] if far >= 0 else []
    return count


class TestStats:
    def test_a_known_tree(self) -> None:
        tree = bsp.PartitionTree([[[-5, 0], [5, 0]], [[0, -5], [0, 5]]], "first")
        assert tree.stats() == bsp.Stats(
            facets=2, nodes=3, leaves=4, fragments=3, splits=1, depth=2, mean_depth=2, balance=1
        )

    @pytest.mark.parametrize("dimension", [1, 2, 3])
    def test_counts_agree_with_each_other(self, dimension: int) -> None:
        tree = bsp.PartitionTree(scene(dimension, 40))
        figures = tree.stats()
        ends = [place.depth for place in tree.walk() if isinstance(place, bsp.Leaf)]
        assert figures.leaves == len(ends) == len(tree) + 1
        assert figures.depth == max(ends)
        assert figures.mean_depth == pytest.approx(np.mean(ends))
        assert figures.fragments == 40 + figures.splits

    def test_a_comparison_is_a_table(self) -> None:
        table = bsp.compare_policies(scene(2, 30), ["random", "balanced"], seed=3)
        assert [row.policy for row in table] == ["random", "balanced"]
        assert table[0].fragments == bsp.PartitionTree(scene(2, 30), seed=3).stats().fragments
        lines = str(table).splitlines()
        assert len(lines) == 3 and len({len(line) for line in lines}) == 1
        assert lines[0].split()[0] == "policy"
