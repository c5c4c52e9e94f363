"""Partition trees over facets: forms of input, nodes, regions, traversals, files."""

import json
import xml.etree.ElementTree as ET
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp

CROSS = [[[-5, 0], [5, 0]], [[0, -5], [0, 5]]]
L_SHAPE = [[0, 0, 0], [4, 0, 0], [4, 1, 0], [1, 1, 0], [1, 4, 0], [0, 4, 0]]
TRIANGLE = [[0, 0, 1], [4, 0, 1], [0, 4, 1.5]]


def wheel() -> Any:
    """Return four segments in a cycle, in which each one's line cuts the next segment."""
    return np.array(
        [[[-1, -3], [-1, 1]], [[-3, 1], [1, 1]], [[1, 3], [1, -1]], [[3, -1], [-1, -1]]]
    )


def area(polygon: Any) -> float:
    x, y = np.asarray(polygon).T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def area_vector(face: Any) -> Any:
    arms = face - face[0]
    return np.cross(arms, np.roll(arms, -1, axis=0)).sum(axis=0) / 2


class TestInput:
    def test_the_shape_names_the_dimension(self) -> None:
        assert bsp.PartitionTree([1.0, 2.0]).dimension == 1
        assert bsp.PartitionTree(CROSS).dimension == 2
        assert bsp.PartitionTree([TRIANGLE]).dimension == 3
        assert bsp.PartitionTree([TRIANGLE, L_SHAPE]).dimension == 3

    @pytest.mark.parametrize("shape", [(0,), (0, 2, 2), (0, 3, 3)])
    def test_no_facets_make_an_empty_tree(self, shape: tuple[int, ...]) -> None:
        tree = bsp.PartitionTree(np.zeros(shape))
        assert (len(tree), tree.root, len(tree.fragments), tree.cost()) == (0, None, 0, 0.0)
        assert [type(place) for place in tree.walk()] == [bsp.Leaf]
        assert len(tree.back_to_front(eye=np.ones(tree.dimension))) == 0
        assert bsp.PartitionTree.from_json(tree.to_json()) == tree
        # The ends of an interval, the corners of a square, the faces of a cube.
        assert len(tree.region()) == 2 * tree.dimension

    @pytest.mark.parametrize(
        ("facets", "code", "where"),
        [
            ([], "shape", ()),
            ([[1.0, 2.0]], "shape", ()),
            ("text", "shape", ()),
            (None, "shape", ()),
            ([[[0, 0, 0], [1, 0, 0]]], "shape", ()),
            ([np.nan], "non_finite", (0,)),
            ([[[0, 0], [np.inf, 0]]], "non_finite", (1,)),
            ([[[0, 0], [1, 0]], [[2, 2], [2, 2]]], "degenerate", (1,)),
            ([[[0, 0], [1e-13, 0]], [[0, 0], [1, 1]]], "degenerate", (0,)),
            ([[[0, 0, 0], [1, 1, 1], [2, 2, 2]]], "degenerate", (0,)),
            ([[[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]]], "non_planar", (0,)),
            ([[[0, 0, 0], [4, 4, 0], [5, 1, 0], [0, 4, 0]]], "not_simple", (0,)),
        ],
    )
    def test_bad_facets_are_refused(self, facets: Any, code: str, where: tuple[int, ...]) -> None:
        with pytest.raises(b.InvalidMeshError) as caught:
            bsp.PartitionTree(facets)
        assert (caught.value.code, caught.value.where) == (code, where)

    def test_coordinates_beyond_the_lattice_are_refused(self) -> None:
        with pytest.raises(b.LimitError):
            bsp.PartitionTree([[[0, 0], [1e9, 0]]], pitch=-9)
        with pytest.raises(b.LimitError):
            bsp.PartitionTree([0.0, 1e300])

    @pytest.mark.parametrize(
        "options",
        [
            {"policy": "best"},
            {"seed": -1},
            {"sample": 0},
            {"alpha": 1.5},
            {"alpha": np.nan},
            {"top": -1},
            {"top": 0.5},
            {"non_planar": "ignore"},
            {"degenerate": "ignore"},
            {"margin": np.nan},
        ],
    )
    def test_bad_parameters_are_refused(self, options: dict[str, Any]) -> None:
        with pytest.raises(b.InvalidMeshError):
            bsp.PartitionTree(CROSS, **options)

    def test_the_pitch_suits_the_size(self) -> None:
        assert bsp.PartitionTree(np.array(CROSS) * 100).pitch == -9
        assert bsp.PartitionTree(np.array(CROSS) * 1e9).pitch == -6

    def test_a_polygon_that_is_not_planar_is_taken_apart_on_request(self) -> None:
        bent = [[[0, 0, 0], [1, 0, 0], [1, 1, 0.1], [0, 1, 0]]]
        tree = bsp.PartitionTree(bent, non_planar="triangulate")
        assert tree.fragments.source.tolist() == [0, 0]
        assert bsp.PartitionTree.from_json(tree.to_json()) == tree

    def test_a_mesh_need_not_be_closed(self) -> None:
        cube = b.cube(1).to_mesh()
        closed, open_ = (
            bsp.PartitionTree.from_mesh((cube.vertices, faces))
            for faces in (cube.faces, cube.faces[:-1])
        )
        assert len(closed.fragments) == 12
        assert len(open_.fragments) == 11
        assert bsp.PartitionTree.from_mesh(b.cube(1)) == closed

    def test_flat_triangles_of_a_mesh_are_left_out(self) -> None:
        points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]], dtype=float)
        faces = [[0, 1, 2], [0, 1, 3], [1, 1, 2]]
        tree = bsp.PartitionTree.from_mesh((points, faces))
        assert tree.fragments.source.tolist() == [1]
        assert bsp.PartitionTree.from_json(tree.to_json()) == tree
        with pytest.raises(b.InvalidMeshError):
            bsp.PartitionTree.from_mesh((points, faces), degenerate="error")

    def test_a_mesh_with_wrong_indices_is_refused(self) -> None:
        with pytest.raises(b.InvalidMeshError, match="vertex index"):
            bsp.PartitionTree.from_mesh((np.eye(3), [[0, 1, 3]]))


class TestNodes:
    def test_crossing_segments(self) -> None:
        tree = bsp.PartitionTree(CROSS, "first")
        root = tree.root
        assert root is not None and root.minus is not None and root.plus is not None
        assert [node.index for node in tree.nodes] == [0, 1, 2]
        assert (root.pivot, root.depth, root.parent, root.is_free) == (0, 0, None, False)
        assert root.minus.parent == root
        assert tree.splits.tolist() == [[0, 1]]
        normal, offset = root.hyperplane
        # The minus side is the left of (-5, 0) → (5, 0).
        assert (normal.tolist(), offset) == ([0, -1], 0)
        assert root.coplanar.source.tolist() == [0]
        assert root.minus.coplanar[0].tolist() == [[0, 0], [0, 5]]
        assert tree.fragments.original.tolist() == [True, True, False, True, True, False]

    def test_coefficients_are_exact(self) -> None:
        tree = bsp.PartitionTree([[[0.1, 0.2, 0.3], [7, 0.2, 0.3], [0.1, 9, 0.4]]])
        assert tree.root is not None
        *normal, constant = tree.root.coefficients
        corners, _ = tree.core.lattice()
        values = [sum(n * x for n, x in zip(normal, p, strict=True)) for p in corners.tolist()]
        assert {value + constant for value in values} == {0}

    def test_coplanar_facets_share_a_node_whichever_way_they_face(self) -> None:
        there, back = [[0, 1], [2, 1]], [[5, 1], [3, 1]]
        tree = bsp.PartitionTree([there, back], "first")
        assert len(tree) == 1
        assert tree.fragments.flipped.tolist() == [False, True]

    def test_a_concave_polygon_has_one_source_and_its_own_edges(self) -> None:
        tree = bsp.PartitionTree([L_SHAPE])
        assert set(tree.fragments.source.tolist()) == {0}
        assert sum(area_vector(piece)[2] for piece in tree.fragments) == pytest.approx(7)
        edges = set()
        for number, piece in enumerate(tree.fragments):
            start = int(tree.fragments.offsets[number])
            for k, corner in enumerate(piece):
                if tree.fragments.original[start + k]:
                    edges.add((tuple(corner[:2]), tuple(piece[(k + 1) % len(piece)][:2])))
        ring = [tuple(map(float, corner[:2])) for corner in L_SHAPE]
        assert edges == set(zip(ring, ring[1:] + ring[:1], strict=True))

    def test_free_cuts_come_from_no_facet(self) -> None:
        tree = bsp.PartitionTree(np.arange(16.0), "first", top=1)
        free = [node for node in tree.nodes if node.is_free]
        assert free and all(node.pivot is None for node in free)
        assert sorted(tree.fragments.vertices.ravel()) == list(range(16))

    def test_regions_of_children_make_up_their_parents(self) -> None:
        random = np.random.default_rng(3)
        tree = bsp.PartitionTree(random.uniform(0, 1, (12, 2, 2)))
        for node in tree.nodes:
            parts = [area(child.region) for child in node.children]
            assert sum(parts) == pytest.approx(area(node.region), rel=1e-9)
        assert sum(
            area(leaf.region) for leaf in tree.walk() if isinstance(leaf, bsp.Leaf)
        ) == pytest.approx(area(tree.region()))

    def test_regions_in_space_are_closed(self) -> None:
        tree = bsp.PartitionTree.from_mesh(b.sphere(1, segments=8), top=0)
        for place in list(tree.walk())[::7]:
            faces = tree.region(place)
            assert np.allclose(sum(area_vector(face) for face in faces), 0)
        assert tree.root is not None
        assert len(tree.root.region) == 6

    def test_regions_on_the_line_are_intervals(self) -> None:
        tree = bsp.PartitionTree([1.0, 3.0], "first", margin=1)
        assert tree.root is not None
        assert tree.root.region == pytest.approx([0, 4])
        ends = [list(map(float, leaf.region)) for leaf in tree.walk("in") if leaf is not tree.root]
        assert [0, 1] in ends and [1, 3] in ends and [3, 4] in ends

    def test_the_span_is_the_cut_inside_the_region(self) -> None:
        tree = bsp.PartitionTree(CROSS, "first", margin=1)
        spans = [sorted(map(tuple, node.span.tolist())) for node in tree.nodes]
        assert spans == [[(-6, 0), (6, 0)], [(0, 0), (0, 6)], [(0, -6), (0, 0)]]


class TestTraversal:
    def test_orders_of_walking(self) -> None:
        tree = bsp.PartitionTree(CROSS, "first")
        names = {
            order: ["n" if isinstance(p, bsp.Node) else "l" for p in tree.walk(order)]
            for order in ("pre", "in", "post")
        }
        assert "".join(names["pre"]) == "nnllnll"
        assert "".join(names["in"]) == "lnlnlnl"
        assert "".join(names["post"]) == "llnllnn"
        with pytest.raises(b.InvalidMeshError):
            list(tree.walk("level"))  # type: ignore[arg-type]

    def test_visitors_meet_everything(self) -> None:
        class Count:
            def __init__(self) -> None:
                self.nodes = self.leaves = 0

            def node(self, node: bsp.Node) -> None:
                self.nodes += 1

            def leaf(self, leaf: bsp.Leaf) -> None:
                self.leaves += 1

        count = Count()
        tree = bsp.PartitionTree(CROSS)
        tree.visit(count)
        assert (count.nodes, count.leaves) == (3, 4)

    def test_near_to_far_starts_around_the_eye(self) -> None:
        tree = bsp.PartitionTree(CROSS, "first")
        for eye in ([3, 2], [-3, 2], [3, -2], [-3, -2]):
            near = list(tree.near_to_far(eye=eye))
            first = near[0]
            assert isinstance(first, bsp.Leaf)
            corners = np.asarray(first.region)
            assert (corners.min(axis=0) <= eye).all() and (corners.max(axis=0) >= eye).all()
            far = list(tree.far_to_near(eye=eye))
            assert far == near[::-1]

    def test_a_deep_tree_is_no_problem(self) -> None:
        tree = bsp.PartitionTree(np.arange(5000.0), "first")
        assert tree.stats().depth == 5000
        assert sum(1 for _ in tree.walk("post")) == 10001
        assert tree.back_to_front(eye=2.5).vertices[-1] in (2.0, 3.0)

    @pytest.mark.parametrize(
        "view",
        [
            {},
            {"eye": [0, 0], "direction": [1, 0]},
            {"direction": [0, 0]},
            {"eye": [np.nan, 0]},
            {"direction": [np.inf, 0]},
            {"eye": [0, 0, 0]},
            {"eye": "here"},
        ],
    )
    def test_bad_viewpoints_are_refused(self, view: dict[str, Any]) -> None:
        with pytest.raises(b.InvalidMeshError):
            bsp.PartitionTree(CROSS).back_to_front(**view)


class TestFragments:
    def test_take_keeps_what_belongs_together(self) -> None:
        tree = bsp.PartitionTree([L_SHAPE, TRIANGLE])
        order = np.array([3, 0, 4])
        taken = tree.fragments.take(order)
        assert all(np.array_equal(taken[i], tree.fragments[int(k)]) for i, k in enumerate(order))
        assert len(taken.take(np.zeros(0, dtype=np.int64))) == 0

    def test_indices_are_checked(self) -> None:
        fragments = bsp.PartitionTree(CROSS).fragments
        assert np.array_equal(fragments[-1], fragments[2])
        with pytest.raises(IndexError):
            fragments[3]


class TestDumps:
    @pytest.mark.parametrize("policy", bsp.POLICIES)
    @pytest.mark.parametrize("top", [0, 3])
    def test_json_makes_an_equal_tree(self, policy: bsp.Policy, top: int) -> None:
        random = np.random.default_rng(1)
        for shape in ((20,), (20, 2, 2), (20, 3, 3)):
            tree = bsp.PartitionTree(random.uniform(-1, 1, shape), policy, top=top, seed=4)
            again = bsp.PartitionTree.from_json(tree.to_json())
            assert again == tree and hash(again) == hash(tree)
            assert again.arrays["minus"].tolist() == tree.arrays["minus"].tolist()
            assert np.array_equal(again.fragments.vertices, tree.fragments.vertices)
            assert again.cost() == tree.cost()

    def test_files(self, tmp_path: Path) -> None:
        tree = bsp.PartitionTree(CROSS)
        tree.save(tmp_path / "tree.json")
        assert bsp.PartitionTree.load(tmp_path / "tree.json") == tree
        with pytest.raises(b.FormatError, match="No such file"):
            bsp.PartitionTree.load(tmp_path / "none.json")
        with pytest.raises(b.FormatError, match="does not exist"):
            tree.save(tmp_path / "none" / "tree.json")
        assert tree != bsp.PartitionTree(CROSS[:1])
        assert tree != "tree"

    @pytest.mark.parametrize(
        "change",
        [
            {"format": "other"},
            {"version": 3},
            {"version": 4},
            {"cuts": []},
            {"cuts": [[-1, 0], [-1, 1], [-1, 1], [-1, 1]]},
            {"cuts": [[-1, 9], [-1, 1], [-1, 1]]},
            {"cuts": [[7, 0], [-1, 1], [-1, 1]]},
            {"cuts": [[-1, 0, 0]]},
            {"corners": [[0, 0], [0, 0], [0, 1], [1, 0]]},
            {"corners": [[0.5, 0], [1, 0], [0, 1], [1, 0]]},
            {"corners": [[2**62, 0], [1, 0], [0, 1], [1, 0]]},
            {"corners": [[2**70, 0], [1, 0], [0, 1], [1, 0]]},
            {"offsets": [0, 2, 5]},
            {"offsets": [0, 4, 2]},
            {"offsets": []},
            {"dimension": 4},
            {"pitch": 99},
            {"pitch": None},
            {"margin": "wide"},
        ],
    )
    def test_forged_json_is_refused(self, change: dict[str, Any]) -> None:
        content = json.loads(bsp.PartitionTree(CROSS, "first").to_json())
        content.pop("checksum")
        content |= change
        checksum = zlib.crc32(json.dumps(content, separators=(",", ":"), sort_keys=True).encode())
        with pytest.raises(b.FormatError):
            bsp.PartitionTree.from_json(json.dumps({**content, "checksum": checksum}))

    def test_damaged_json_is_refused(self) -> None:
        tree = bsp.PartitionTree(CROSS, "first")
        content = json.loads(tree.to_json())
        with pytest.raises(b.FormatError, match="checksum"):
            bsp.PartitionTree.from_json(json.dumps({**content, "margin": 3.0}))
        del content["checksum"]
        with pytest.raises(b.FormatError, match="checksum"):
            bsp.PartitionTree.from_json(json.dumps(content))
        # The first version had none.
        assert bsp.PartitionTree.from_json(json.dumps({**content, "version": 1})) == tree

    @pytest.mark.parametrize("text", ["", "[]", "{}", "3", "{", '{"format": 1}'])
    def test_other_text_is_refused(self, text: str) -> None:
        with pytest.raises(b.FormatError):
            bsp.PartitionTree.from_json(text)

    def test_dot_names_every_node(self) -> None:
        text = bsp.PartitionTree(CROSS, "first").to_dot()
        assert text.startswith("digraph")
        assert text.count("shape=point") == 4
        assert text.count("->") == 6

    def test_svg_draws_every_fragment_and_cut(self) -> None:
        tree = bsp.PartitionTree(CROSS)
        lines = list(ET.fromstring(tree.to_svg()).iter("{http://www.w3.org/2000/svg}line"))
        assert len(lines) == len(tree) + len(tree.fragments)
        with pytest.raises(b.InvalidMeshError):
            bsp.PartitionTree([1.0]).to_svg()


class TestPerfect:
    def test_a_wheel_has_none_but_any_three_of_it_have_one(self) -> None:
        assert bsp.PartitionTree.perfect(wheel()) is None
        for left_out in range(4):
            tree = bsp.PartitionTree.perfect(np.delete(wheel(), left_out, axis=0))
            assert tree is not None
            assert len(tree.splits) == 0
            assert len(tree.fragments) == 3

    def test_the_limit(self) -> None:
        rows = np.array([[[0, y], [9, y]] for y in range(25)])
        tree = bsp.PartitionTree.perfect(rows[:24])
        assert tree is not None and len(tree) == 24
        with pytest.raises(b.LimitError, match="24"):
            bsp.PartitionTree.perfect(rows)

    def test_the_answer_is_that_of_all_trees(self) -> None:
        """Against a search without memory, over scenes of both kinds."""
        random = np.random.default_rng(8)
        answers = set()
        for _ in range(60):
            segments = random.integers(0, 7, (6, 2, 2))
            if (segments[:, 0] == segments[:, 1]).all(axis=1).any():
                continue
            found = bsp.PartitionTree.perfect(segments) is not None
            assert found == has_perfect([s.tolist() for s in segments])
            answers.add(found)
        assert answers == {True, False}


def has_perfect(segments: list[Any]) -> bool:
    """Return true if an order of pivots cuts no segment, by trying all orders."""

    def side(pivot: Any, point: Any) -> int:
        (x, y), (u, v) = pivot
        value = (u - x) * (point[1] - y) - (v - y) * (point[0] - x)
        return int(value > 0) - int(value < 0)

    if not segments:
        return True
    for pivot in segments:
        sides = [{side(pivot, end) for end in s} - {0} for s in segments]
        if not any(len(s) == 2 for s in sides) and all(
            has_perfect([s for s, where in zip(segments, sides, strict=True) if where == {sign}])
            for sign in (-1, 1)
        ):
            return True
    return False


# Found: the error for a polygon in the shape of a bow-tie was “no area on the lattice”.
def test_a_polygon_that_crosses_itself_is_called_that() -> None:
    # The halves of the second are of one size, so that its normal vanishes.
    for bow in (
        [[0, 0, 0], [4, 4, 0], [5, 1, 0], [0, 4, 0]],
        [[0, 0, 0], [4, 4, 0], [4, 0, 0], [0, 4, 0]],
    ):
        for degenerate in ("error", "drop"):
            with pytest.raises(b.InvalidMeshError, match="crosses") as caught:
                bsp.PartitionTree([bow], degenerate=degenerate)
            assert caught.value.code == "not_simple"


# Found: assigning to the arrays of nodes and fragments changed a partition tree.
def test_nobody_writes_into_a_tree() -> None:
    tree = bsp.PartitionTree(CROSS)
    assert tree.root is not None and not isinstance(tree.root, bsp.Leaf)
    kept = [*tree.arrays.values(), *vars(tree.fragments).values(), tree.root.hyperplane[0]]
    for array in [*kept, tree.fragments[0]]:
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 1
