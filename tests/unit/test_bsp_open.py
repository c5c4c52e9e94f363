"""Partition trees in detail: nodes, regions, leaf form, cuts and policies of the caller."""

import itertools
import pickle
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from bspcsg import bsp
from bspcsg.errors import BspcsgError, InvalidMeshError, InvalidParameterError
from bspcsg.geometry.polytope import Polytope

COMB = np.array([[[k, 0], [k, 5]] for k in range(8)], dtype=float)


def segments(seed: int, count: int = 20) -> Any:
    ends = np.random.default_rng(seed).integers(-9, 10, (4 * count, 2, 2))
    return ends[(ends[:, 0] != ends[:, 1]).any(axis=1)][:count].astype(float)


def grown(seed: int = 1, rays: int = 80) -> bsp.AdaptiveTree:
    tree = bsp.AdaptiveTree(segments(seed), threshold=2)
    random = np.random.default_rng(seed)
    tree.test_ray(random.uniform(-9, 9, (rays, 2)), random.normal(size=(rays, 2)))
    return tree


class TestStabTrees:
    def test_nodes_add_up_to_the_figures(self) -> None:
        tree = grown()
        nodes, stats = tree.nodes, tree.stats()
        assert len(nodes) == stats.nodes > 10
        assert nodes.visits.sum() == stats.visits
        assert len(nodes.facets) == stats.fragments
        assert nodes.depth.max() == stats.depth
        assert (nodes.minus < 0).sum() == stats.leaves == (len(nodes) + 1) // 2
        assert len(tree.trace()) == stats.subdivisions

    def test_children_lie_on_their_sides(self) -> None:
        nodes = grown().nodes
        for v in range(len(nodes)):
            assert (nodes.coefficients[v] == ()) == nodes.is_leaf(v)
            if not nodes.is_leaf(v):
                assert nodes.depth[nodes.minus[v]] == nodes.depth[nodes.plus[v]]
                assert nodes.depth[nodes.plus[v]] == nodes.depth[v] + 1

    def test_leaves_are_heaps_by_their_hits(self) -> None:
        nodes = grown().nodes
        for v in range(len(nodes)):
            counts = nodes.counts(v)
            for place in range(1, len(counts)):
                assert counts[place] <= counts[(place - 1) // 2]
        assert nodes.facet_hits(20).sum() == nodes.hits.sum()

    def test_a_facet_is_listed_where_it_meets_the_region(self) -> None:
        tree = grown()
        nodes = tree.nodes
        for v in range(len(nodes)):
            region = np.asarray(tree.region(v))
            middle = region.mean(axis=0)
            assert (np.isfinite(middle)).all()
            for facet in nodes.held(v) if nodes.is_leaf(v) else ():
                ends = segments(1)[facet]
                assert any(
                    inside(region, ends[0] + t * (ends[1] - ends[0]))
                    for t in np.linspace(0, 1, 999)
                )

    def test_regions_of_leaves_fill_the_root(self) -> None:
        for tree in (grown(), bsp.StaticTree(segments(3), seed=1)):
            nodes = tree.nodes
            areas = [area(tree.region(v)) for v in range(len(nodes)) if nodes.is_leaf(v)]
            assert sum(areas) == pytest.approx(area(tree.region(0)))
            assert min(areas) > 0

    def test_a_static_tree_is_a_partition_tree(self) -> None:
        for scene in (segments(2), np.arange(9.0), triangles(4)):
            static = bsp.StaticTree(scene, seed=3)
            tree = static.to_partition_tree()
            nodes = static.nodes
            leaves = [len(nodes.held(v)) for v in range(len(nodes)) if nodes.is_leaf(v)]
            assert max(leaves) <= 1
            assert len(tree) == (nodes.minus >= 0).sum() + sum(leaves)
            form = tree.leaf_form()
            assert tree.dimension == static.dimension
            assert len(form.inner) >= (nodes.minus >= 0).sum()
            signs = {
                tuple(sorted({row[:-1] + (-row[-1],), tuple(-x for x in row[:-1]) + (row[-1],)}))
                for row in nodes.coefficients
                if row
            }
            known = {
                tuple(sorted({node.coefficients, tuple(-x for x in node.coefficients)}))
                for node in tree.nodes
            }
            assert signs <= known

    def test_leaves_with_several_facets_have_no_partition_tree(self) -> None:
        with pytest.raises(InvalidParameterError, match="contains 8 facets"):
            bsp.AdaptiveTree(COMB).to_partition_tree()

    def test_what_is_no_node_is_refused(self) -> None:
        tree = grown()
        for ask in (tree.region, tree.nodes.held, tree.nodes.is_leaf):
            with pytest.raises(InvalidParameterError):
                ask(len(tree))


def triangles(seed: int, count: int = 6) -> Any:
    corners = np.random.default_rng(seed).integers(-5, 6, (4 * count, 3, 3)).astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return corners[normals.any(axis=1)][:count]


def area(polygon: Any) -> float:
    x, y = np.asarray(polygon).T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def inside(polygon: Any, point: Any) -> bool:
    edges = np.roll(polygon, -1, axis=0) - polygon
    arms = point - polygon
    return bool((edges[:, 0] * arms[:, 1] - edges[:, 1] * arms[:, 0] >= -1e-9).all())


class TestCasters:
    def test_nothing_is_divided_before_the_first_ray(self) -> None:
        scene = bsp.analysis.disjoint_segments(3000)
        caster = bsp.RayCaster(scene)
        assert (len(caster.nodes), caster.nodes.deferred.tolist()) == (1, [True])
        caster.first_hit([-20, 2.0**23], [1, 0])
        some = caster.nodes
        whole = bsp.RayCaster(scene, deferred=False).nodes
        assert 1 < len(some) < len(whole)
        assert some.deferred.any()
        assert not whole.deferred.any()

    def test_boxes_are_around_what_is_in_them(self) -> None:
        scene = bsp.analysis.disjoint_segments(3000)
        nodes = bsp.RayCaster(scene, deferred=False).nodes
        below = np.flatnonzero(nodes.parent >= 0)
        above = nodes.parent[below]
        assert (above < below).all()
        assert np.bincount(above).max() <= 8
        # Boxes are rounded to single precision, outward.
        slack = 2.0**-20 * np.ptp(scene.reshape(-1, 2), axis=0).max()
        assert (nodes.low[above] <= nodes.low[below] + slack).all()
        assert (nodes.high[above] >= nodes.high[below] - slack).all()
        assert sorted(nodes.facets.tolist()) == list(range(3000))
        for leaf in np.flatnonzero(np.diff(nodes.offsets)).tolist():
            corners = scene[nodes.held(leaf)].reshape(-1, 2)
            assert (nodes.low[leaf] <= corners.min(axis=0)).all()
            assert (nodes.high[leaf] >= corners.max(axis=0)).all()
            assert (corners.min(axis=0) - nodes.low[leaf] <= slack).all()


class TestSets:
    def test_hyperplanes_are_exact_and_the_rounded_ones_theirs(self) -> None:
        for tree in (
            bsp.ObjectTree([[0, 2], [5, 6]]),
            bsp.Region([[0, 0], [7, 1], [3, 8]]).tree,
            bsp.ObjectTree(
                np.array(
                    [
                        [[0, 0, 0], [0, 2, 1], [3, 0, 0]],
                        [[0, 0, 0], [3, 0, 0], [0, 0, 3]],
                        [[0, 0, 0], [0, 0, 3], [0, 2, 1]],
                        [[3, 0, 0], [0, 2, 1], [0, 0, 3]],
                    ],
                    float,
                )
            ),
        ):
            nodes = tree.nodes
            for row, exact in zip(nodes.hyperplanes, nodes.coefficients, strict=True):
                *normal, offset = map(float, exact)
                length = np.linalg.norm(normal)
                expected = [*(np.array(normal) / length), offset / length * 10.0**tree.pitch]
                assert row == pytest.approx(expected)


class TestLeafForm:
    @pytest.mark.parametrize("seed", range(5))
    def test_the_node_count_of_the_notes(self, seed: int) -> None:
        """Count #nodes = 2 #leaves - 1 ≤ 2 n̄ - 1, and follow where the difference comes from."""
        tree = bsp.PartitionTree(segments(seed))
        form, fragments = tree.leaf_form(), len(tree.fragments)
        assert form.nodes == 2 * form.leaves - 1
        assert form.fragments == fragments
        shared = fragments - len(tree)
        assert form.nodes == 2 * (fragments - shared - form.stored) + 1
        assert form.nodes <= 2 * fragments - 1

    def test_a_chain_has_exactly_as_many(self) -> None:
        for n in range(1, 9):
            form = bsp.PartitionTree(COMB[:n], "first").leaf_form()
            assert (form.nodes, form.stored) == (2 * n - 1, 1)

    def test_free_cuts_between_all_facets_have_exactly_as_many(self) -> None:
        for n in (2, 4, 8):
            cuts = [((1, 0), k + 0.5) for k in (3, 1, 5, 0, 2, 4, 6)]
            form = bsp.PartitionTree(COMB[:n], "first", cuts=cuts).leaf_form()
            assert (form.stored, form.nodes) == (n, 2 * n - 1)

    def test_links_lead_to_every_fragment_once(self) -> None:
        tree = bsp.PartitionTree(segments(7))
        form = tree.leaf_form()
        links = np.concatenate([form.minus, form.plus])
        stored = (-2 - links[links < -1]).tolist()
        assert len(set(stored)) == len(stored) == form.stored
        assert sorted(links[links >= 0]) == list(range(1, len(form.inner)))
        for fragment in stored:
            assert tree.fragments.node[fragment] not in form.inner

    def test_one_facet_is_one_leaf(self) -> None:
        form = bsp.PartitionTree(COMB[:1]).leaf_form()
        assert (form.nodes, form.leaves, form.stored) == (1, 1, 1)


class TestOwnHyperplanes:
    def test_they_come_first_and_are_kept(self) -> None:
        cuts = [((1, 0), 3.5), ((1, 1), 4)]
        tree = bsp.PartitionTree(COMB, "first", cuts=cuts)
        root = tree.nodes[0]
        assert (root.is_free, root.pivot, len(root.coplanar)) == (True, None, 0)
        assert root.hyperplane[0].tolist() == [1, 0]
        assert root.hyperplane[1] == 3.5
        assert tree.trace()[0].own == 0
        for again in (
            pickle.loads(pickle.dumps(tree)),
            bsp.PartitionTree.from_json(tree.to_json()),
            tree.with_cuts(tree.arrays["cut"]),
        ):
            assert again == tree
            assert again.own_hyperplanes == tree.own_hyperplanes
            assert again.fragments.vertices.tolist() == tree.fragments.vertices.tolist()
        assert tree != bsp.PartitionTree(COMB, "first", cuts=[((1, 0), 2.5), ((1, 1), 4)])

    def test_those_that_divide_nothing_are_left_out(self) -> None:
        tree = bsp.PartitionTree(COMB, "first", cuts=[((1, 0), 99), ((0, 1), -1)])
        assert not any(node.is_free for node in tree.nodes)

    @pytest.mark.parametrize("dimension", [1, 2, 3])
    def test_fragments_lie_on_their_sides(self, dimension: int) -> None:
        scene = {1: np.arange(12.0), 2: segments(3), 3: triangles(3)}[dimension]
        normal = [1, 2, -1][:dimension]
        tree = bsp.PartitionTree(scene, cuts=[(normal, 0.5), ([1, 0, 0][:dimension], 1)])
        arrays = tree.arrays
        for index in range(len(tree.fragments)):
            node = int(tree.fragments.node[index])
            while (parent := int(arrays["parent"][node])) >= 0:
                heights = tree.fragments[index] @ arrays["normal"][parent]
                heights = heights - arrays["offset"][parent]
                side = -1 if arrays["minus"][parent] == node else 1
                assert (side * heights >= -1e-7).all()
                node = parent

    @pytest.mark.parametrize("cut", [((1, 0, 0), 1), ((0, 0), 1), ((1, "x"), 1)])
    def test_what_is_no_hyperplane_is_refused(self, cut: Any) -> None:
        with pytest.raises((InvalidMeshError, InvalidParameterError)):
            bsp.PartitionTree(COMB, cuts=[cut])


class TestCallables:
    def test_a_policy_of_ones_own_rebuilds_a_named_one(self) -> None:
        def fewest(choice: bsp.Choice) -> int:
            return int(np.argmin(choice.splits))

        for seed in range(4):
            scene = segments(seed)
            own = bsp.PartitionTree(scene, fewest, sample=8)
            assert own == bsp.PartitionTree(scene, "least-splits", sample=8)

    def test_it_sees_the_region_and_its_candidates(self) -> None:
        seen = []

        def first(choice: bsp.Choice) -> int:
            seen.append((choice.depth, choice.count, len(choice)))
            return 0

        tree = bsp.PartitionTree(COMB, first, sample=3)
        assert seen[0] == (0, 8, 3)
        assert len(seen) == len(tree)
        assert {d.reason for d in tree.trace()} == {"given"}

    def test_it_may_return_hyperplanes(self) -> None:
        def halves(choice: bsp.Choice) -> Any:
            if choice.count < 2:
                return 0
            middle = float(np.mean(COMB[choice.pieces, 0, 0]))
            return (1, 0), np.floor(middle) + 0.5

        tree = bsp.PartitionTree(COMB, halves, sample=99)
        assert tree.stats().depth == 4
        assert tree.leaf_form().nodes == 2 * 8 - 1
        assert pickle.loads(pickle.dumps(tree)) == tree

    @pytest.mark.parametrize("answer", [8, -9, None, "x", ((1, 0), 99.0), ((1, 0),), ((0, 1), 2.5)])
    def test_bad_answers_are_refused(self, answer: Any) -> None:
        with pytest.raises(BspcsgError):
            bsp.PartitionTree(COMB, lambda _: answer)

    def test_what_it_raises_comes_out(self) -> None:
        def broken(_: bsp.Choice) -> int:
            raise ZeroDivisionError("mine")

        with pytest.raises(ZeroDivisionError, match="mine"):
            bsp.PartitionTree(np.tile(COMB, (500, 1, 1)), broken)

    def test_unknown_names_are_refused(self) -> None:
        with pytest.raises(InvalidParameterError, match="pass a function"):
            bsp.PartitionTree(COMB, "best")  # type: ignore[arg-type]


class TestEndPoints:
    def test_free_lines_go_through_two_end_points(self) -> None:
        tree = bsp.PartitionTree(segments(5), "end-points", sample=400)
        ends = {tuple(p) for p in (segments(5).reshape(-1, 2) * 10**9).astype(int).tolist()}
        own = [node for node in tree.nodes if node.is_free]
        assert own
        for node in own:
            a, b, c = node.coefficients
            assert sum(a * x + b * y + c == 0 for x, y in ends) >= 2

    def test_it_balances_what_supporting_lines_cannot(self) -> None:
        angles = np.linspace(0, 2 * np.pi, 33)[:-1]
        corners = np.round(100 * np.column_stack([np.cos(angles), np.sin(angles)]))
        ring = np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
        depth = [
            bsp.PartitionTree(ring, p, sample=99).stats().depth for p in ("balanced", "end-points")
        ]
        assert depth[1] < depth[0] == 32


class TestInsertion:
    @pytest.mark.parametrize("dimension", [1, 2, 3])
    def test_the_old_nodes_stay_and_the_new_facets_are_there(self, dimension: int) -> None:
        old, new = {
            1: (np.arange(6.0), np.arange(4.0) + 0.5),
            2: (segments(1, 8), segments(2, 8)),
            3: (triangles(1, 4), triangles(2, 4)),
        }[dimension]
        tree = bsp.PartitionTree(old, seed=2)
        both = tree.insert(new)
        whole = np.concatenate([old, new])
        assert set(both.fragments.source) == set(range(len(whole)))
        kept = {node.coefficients for node in tree.nodes}
        assert kept <= {node.coefficients for node in both.nodes}
        # The way down to each old node is the same.
        place = {0: 0}
        for node in tree.nodes:
            other = both.nodes[place[node.index]]
            assert other.coefficients == node.coefficients
            for side in ("minus", "plus"):
                child, twin = getattr(node, side), getattr(other, side)
                if child is not None:
                    place[child.index] = twin.index
        order = np.concatenate([old, new])
        assert fragment_sizes(both) == pytest.approx(fragment_sizes(bsp.PartitionTree(order)))
        assert pickle.loads(pickle.dumps(both)) == both

    def test_nothing_inserted_is_the_tree_itself(self) -> None:
        tree = bsp.PartitionTree(COMB)
        assert tree.insert(np.zeros((0, 2, 2))) == tree

    def test_an_empty_tree_grows_like_any_other(self) -> None:
        tree = bsp.PartitionTree(np.zeros((0, 2, 2)), pitch=-9).insert(COMB, "first")
        assert tree == bsp.PartitionTree(COMB, "first")

    def test_own_hyperplanes_stay(self) -> None:
        tree = bsp.PartitionTree(COMB, cuts=[((1, 0), 3.5)]).insert(segments(1))
        assert tree.nodes[0].is_free
        assert pickle.loads(pickle.dumps(tree)) == tree

    def test_another_dimension_is_refused(self) -> None:
        with pytest.raises(InvalidParameterError, match="dimension"):
            bsp.PartitionTree(COMB).insert([1.0, 2.0])


def fragment_sizes(tree: bsp.PartitionTree) -> list[float]:
    """Return for each facet the total length or area of its fragments."""
    sizes = np.zeros(tree.fragments.source.max() + 1)
    for index, corners in enumerate(tree.fragments):
        if tree.dimension == 1:
            size = 1.0
        elif tree.dimension == 2:
            size = float(np.linalg.norm(corners[1] - corners[0]))
        else:
            arms = corners - corners[0]
            size = float(np.linalg.norm(np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0)))
        sizes[tree.fragments.source[index]] += size
    return [float(size) for size in sizes]


class TestPolytopes:
    @pytest.mark.parametrize("dimension", [1, 2, 3])
    def test_halves_add_up(self, dimension: int) -> None:
        random = np.random.default_rng(dimension)
        whole = Polytope.box([-9] * dimension, [9] * dimension)
        assert whole.measure == 18**dimension
        parts = [whole]
        for _ in range(6):
            row = random.integers(-4, 5, dimension + 1).tolist()
            if not any(row[:-1]):
                continue
            cut = [part.clipped(row, side) for part in parts for side in (-1, 1)]
            parts = [part for part in cut if part is not None]
            assert sum((part.measure for part in parts), Fraction(0)) == 18**dimension
            assert all(part.measure > 0 for part in parts)

    def test_faces_look_outwards(self) -> None:
        part = Polytope.box([0, 0, 0], [4, 4, 4]).clipped([1, 1, 1, 5], -1)
        assert part is not None
        assert len(part.faces) == 7
        middle = np.mean([[float(x) for x in corner] for corner in part.corners], axis=0)
        for face in part.shape(1.0):
            normal = np.cross(face[1] - face[0], face[2] - face[0])
            assert normal @ (face[0] - middle) > 0

    def test_a_side_without_interior_is_nothing(self) -> None:
        box = Polytope.box([0, 0], [2, 2])
        assert box.clipped([1, 0, 0], -1) is None
        assert box.clipped([1, 0, 0], 1) is box
        assert all(box.clipped([1, 1, c], 1) for c, _ in itertools.product((1, 3), (0,)))
