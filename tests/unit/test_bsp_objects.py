"""Object trees in one, two and three dimensions: the same laws in each."""

import itertools
import pickle
from fractions import Fraction
from typing import Any, get_args

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from bspcsg.bsp.sets.pieces import SplitCase

DIMENSIONS = (1, 2, 3)
SIDE = 4
OPS: dict[Any, Any] = {
    "union": np.logical_or,
    "intersection": np.logical_and,
    "difference": lambda a, b: a & ~b,
    "xor": np.logical_xor,
}


def box_facets(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return the boundary of a box as facets of its dimension."""
    if len(low) == 1:
        return np.array([[low[0], high[0]]])
    if len(low) == 2:
        corners = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
        return np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)
    vertices, faces = b.box(1).to_mesh()
    triangles: np.ndarray = (vertices * (high - low) + low)[faces]
    return triangles


def random_set(dimension: int, seed: int) -> tuple[bsp.ObjectTree, np.ndarray]:
    """Return a random union of lattice boxes as a tree, and as a boolean array of unit cells."""
    rng = np.random.default_rng(seed)
    cells = np.zeros((SIDE,) * dimension, dtype=bool)
    tree = bsp.ObjectTree.uniform(dimension, full=False)
    for _ in range(3):
        ends = np.sort(np.array([rng.choice(SIDE + 1, 2, replace=False) for _ in range(dimension)]))
        low, high = ends.T.astype(float)
        cells[tuple(slice(a, z) for a, z in ends)] = True
        tree = tree | bsp.ObjectTree(box_facets(low, high), pitch=-9)
    return tree, cells


def centres(dimension: int) -> np.ndarray:
    return np.array(list(itertools.product(np.arange(SIDE) + 0.5, repeat=dimension)))


@pytest.mark.parametrize("dimension", DIMENSIONS)
@pytest.mark.parametrize("op", OPS)
@pytest.mark.parametrize("seed", range(6))
def test_operations_against_a_grid(dimension: int, op: Any, seed: int) -> None:
    (a, x), (c, y) = random_set(dimension, seed), random_set(dimension, seed + 100)
    result = bsp.merge(a, c, op)
    cells = OPS[op](x, y)
    assert np.array_equal(result.classify(centres(dimension)) > 0, cells.ravel())
    assert result.measure == cells.sum()
    assert result.condensed().equals(result)


@pytest.mark.parametrize("dimension", DIMENSIONS)
@pytest.mark.parametrize("seed", range(5))
def test_both_halves_of_a_split(dimension: int, seed: int) -> None:
    tree, cells = random_set(dimension, seed)
    normal = [1.0, 2.0, -1.0][:dimension]
    minus, plus = bsp.split_tree(tree, (normal, 2.0))
    half = bsp.ObjectTree.half_space(normal, 2.0)
    assert minus.equals(tree & half)
    assert plus.equals(tree - half)
    assert (minus | plus).equals(tree)
    assert minus.measure + plus.measure == cells.sum()
    rooted = bsp.partition_tree(tree, (normal, 2.0))
    assert rooted.equals(tree)
    unit = np.array(normal) / np.linalg.norm(normal)
    assert np.allclose(rooted.nodes.hyperplanes[0, :dimension], unit)


@pytest.mark.parametrize("dimension", DIMENSIONS)
@pytest.mark.parametrize(
    ("sign", "offset", "expected"),
    [
        (1, 0, "same"),
        (-1, 0, "opposite"),
        (1, -1, "minus-plus"),
        (-1, 1, "minus-minus"),
        (1, 1, "plus-minus"),
        (-1, -1, "plus-plus"),
    ],
)
def test_cases_of_parallel_hyperplanes(
    dimension: int, sign: int, offset: int, expected: str
) -> None:
    first = np.eye(dimension)[0]
    tree = bsp.ObjectTree.half_space(first, 0)
    assert tree.split_case(sign * first, offset) == expected
    minus, plus = tree.split(sign * first, offset)
    half = bsp.ObjectTree.half_space(sign * first, offset)
    assert minus.equals(tree & half)
    assert plus.equals(tree - half)


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_cases_of_leaves_and_crossings(dimension: int) -> None:
    first = np.eye(dimension)[0]
    assert bsp.ObjectTree.uniform(dimension, full=True).split_case(first, 3) == "leaf"
    if dimension > 1:
        crossing = np.ones(dimension)
        assert bsp.ObjectTree.half_space(first, 0).split_case(crossing, 3) == "crossing"


def test_the_tests_above_reach_every_case() -> None:
    reached = {"leaf", "crossing", "same", "opposite"}
    reached |= {"minus-plus", "minus-minus", "plus-minus", "plus-plus"}
    assert reached == set(get_args(SplitCase))


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_merged_tree_lists_its_nodes_in_preorder(dimension: int) -> None:
    tree, _ = random_set(dimension, 3)
    nodes = tree.nodes
    assert len(nodes) == tree.stats()["nodes"]
    children = np.concatenate([nodes.minus, nodes.plus])
    inner = np.sort(children[children >= 0])
    assert inner.tolist() == list(range(1, len(nodes)))
    assert (children < 0).sum() == tree.stats()["leaves"]
    assert np.allclose(np.linalg.norm(nodes.hyperplanes[:, :-1], axis=1), 1)


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_walk_by_the_node_table_is_the_tree(dimension: int) -> None:
    tree, cells = random_set(dimension, 4)
    nodes = tree.nodes
    for point, inside in zip(centres(dimension), cells.ravel(), strict=True):
        at = 0
        while at >= 0:
            *normal, offset = nodes.hyperplanes[at]
            at = int((nodes.minus if np.dot(normal, point) < offset else nodes.plus)[at])
        assert (at == nodes.IN) == inside


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_boundary_measures_the_set(dimension: int) -> None:
    tree, _ = random_set(dimension, 5)
    pieces = tree.boundary()
    assert len(pieces) == len(pieces.offsets) - 1
    assert pieces.offsets[-1] == len(pieces.vertices)
    assert (tree.classify(pieces.vertices) == 0).all()
    assert set(pieces.owner.tolist()) <= set(range(tree.stats()["nodes"]))
    if dimension == 2:
        ends = np.array([pieces[k] for k in range(len(pieces))])
        (x, y), (u, v) = ends[:, 0].T, ends[:, 1].T
        assert float(tree.measure) == pytest.approx(((x * v - u * y) / 2).sum())


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_nearest_boundary_points(dimension: int) -> None:
    cube = bsp.ObjectTree(box_facets(np.zeros(dimension), np.full(dimension, 4.0)))
    points = np.random.default_rng(1).uniform(-3, 7, (60, dimension))
    nearest, distance = cube.nearest(points)
    inside = cube.classify(points) > 0
    # Inside a box the nearest wall, outside the point clamped to it.
    clamped = np.linalg.norm(points - np.clip(points, 0, 4), axis=1)
    wall = np.minimum(points, 4 - points).min(axis=1)
    assert np.allclose(distance, np.where(inside, wall, clamped))
    assert np.allclose(np.linalg.norm(points - nearest, axis=1), distance)
    assert 0 < inside.sum() < 60
    with pytest.raises(b.InvalidMeshError):
        bsp.ObjectTree.uniform(dimension, full=False).nearest(points)


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_cells_are_convex_and_fill_the_set(dimension: int) -> None:
    tree, cells = random_set(dimension, 6)
    pieces = tree.cells()
    total = Fraction(0)
    for cell in range(int(pieces.owner.max()) + 1):
        corners = np.concatenate([pieces[int(k)] for k in np.flatnonzero(pieces.owner == cell)])
        low, high = corners.min(axis=0), corners.max(axis=0)
        assert (tree.classify((low + high)[None] / 2) == 1).all()
        # All cuts are axis-parallel here, so that the cells are boxes.
        total += Fraction(float(np.prod(high - low)))
    assert total == cells.sum()


@pytest.mark.parametrize("policy", ["balanced", "random", "first", "fewest-splits"])
@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_every_policy_makes_the_same_set(policy: Any, dimension: int) -> None:
    facets = box_facets(np.zeros(dimension), np.full(dimension, 2.0))
    twice = np.concatenate([facets, facets + 1])
    tree = bsp.ObjectTree(twice, policy=policy, seed=5)
    assert tree.equals(bsp.ObjectTree(facets) | bsp.ObjectTree(facets + 1))


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_partitioned_building(dimension: int) -> None:
    facets = box_facets(np.zeros(dimension), np.full(dimension, 4.0))
    cuts = [(axis, 1.0) for axis in np.eye(dimension)]
    tree = bsp.ObjectTree(facets, cuts=cuts)
    assert tree.equals(bsp.ObjectTree(facets))
    assert np.allclose(tree.nodes.hyperplanes[0], [*np.eye(dimension)[0], 1.0])


def test_winding_rules() -> None:
    twice = [[0, 4], [1, 3]]
    backwards = [[4, 0]]
    assert bsp.ObjectTree(twice).measure == 4
    assert bsp.ObjectTree(twice, winding="even-odd").measure == 2
    assert bsp.ObjectTree(backwards).is_empty
    assert bsp.ObjectTree(backwards, winding="nonzero").measure == 4


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_pickle_and_copy(dimension: int) -> None:
    tree, _ = random_set(dimension, 7)
    again = pickle.loads(pickle.dumps(tree))
    assert again.equals(tree)
    assert again.pitch == tree.pitch
    restore, (kind, data) = tree.__reduce__()
    for end in range(0, len(data), 7):
        with pytest.raises(b.BspcsgError):
            restore(kind, data[:end])


def test_pitch_is_refined_exactly() -> None:
    coarse = bsp.ObjectTree([[0, 3]], pitch=0)
    fine = bsp.ObjectTree([[0.5, 1]], pitch=-3)
    assert (coarse - fine).measure == Fraction(5, 2)
    assert (coarse - fine).pitch == -3


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_empty_and_full_sets_fit_every_lattice(dimension: int) -> None:
    far = bsp.ObjectTree(box_facets(np.zeros(dimension), np.full(dimension, 1e12)))
    assert far.pitch > -9
    for uniform in (bsp.ObjectTree.uniform(dimension, full=full) for full in (True, False)):
        assert (uniform & far).equals(far if uniform.is_full else uniform)
        assert (far ^ uniform).equals(~far if uniform.is_full else far)


@pytest.mark.parametrize(
    ("facets", "code"),
    [
        ([], "invalid_parameter"),
        ([[0, float("nan")]], "non_finite"),
        ([[0, float("inf")]], "non_finite"),
        ([[0, 1e30]], "too_large"),
        ([[[0, 0], [1, 0]], [[1, 0], [0, 1]]], "not_closed"),
        ([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], "not_closed"),
        ([1, 2, 3], "shape"),
        ("circle", "shape"),
    ],
)
def test_bad_boundaries(facets: Any, code: str) -> None:
    with pytest.raises(b.BspcsgError) as caught:
        bsp.ObjectTree(facets, pitch=-9)
    assert caught.value.code == code


def test_bad_hyperplanes_and_operands() -> None:
    tree = bsp.ObjectTree([[0, 1]])
    for normal, offset in [((0,), 1), ((float("nan"),), 0), ((1, 1), 0), ("x", 0)]:
        with pytest.raises(b.InvalidMeshError):
            tree.split(normal, offset)
    with pytest.raises(b.InvalidMeshError):
        tree | bsp.ObjectTree.uniform(2, full=True)
    with pytest.raises(TypeError):
        tree | 3
    with pytest.raises(b.UnboundedError):
        (~tree).measure  # noqa: B018
    with pytest.raises(b.UnboundedError):
        (~tree).cells()
    with pytest.raises(b.InvalidMeshError):
        tree.classify([[1, 2]])


SETS: list[bsp.Intervals | bsp.Region] = [bsp.Intervals([(0, 2)]), bsp.Region.rectangle(2)]


@pytest.mark.parametrize("made", SETS, ids=["line", "plane"])
def test_sets_of_one_dimension_have_a_tree(made: bsp.Intervals | bsp.Region) -> None:
    assert type(made.tree) is bsp.ObjectTree
    assert made.tree.dimension == made.dimension
    assert made.tree.measure == made.measure == 2**made.dimension
    assert (~made).tree == ~made.tree
    assert made == made.tree and made.tree == made and made.tree <= made <= made.tree
    assert type(made | made.tree) is type(made) and type(made.tree | made) is bsp.ObjectTree


@pytest.mark.parametrize("made", SETS, ids=["line", "plane"])
def test_trees_of_other_dimensions_cannot_become_such_a_set(
    made: bsp.Intervals | bsp.Region,
) -> None:
    makers = [name for name, value in vars(bsp.ObjectTree).items() if type(value) is classmethod]
    assert {"half_space", "uniform", "from_mesh"} < set(makers)
    assert [name for name in makers if hasattr(made, name) and not name.startswith("_")] == []
    other = SETS[made.dimension % 2]
    with pytest.raises(b.InvalidMeshError, match="cannot be combined") as caught:
        made | other
    assert caught.value.code == "invalid_parameter"


# Found: constructors inherited from a base class made objects of another dimension.
def test_constructors_of_other_dimensions_are_not_inherited() -> None:
    """A maker of sets of any dimension would make another one than the class it is asked for."""
    for kind in (bsp.Region, bsp.Intervals):
        assert not any(hasattr(kind, name) for name in ("half_space", "from_mesh"))
