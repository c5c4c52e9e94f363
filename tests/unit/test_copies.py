"""All public values can be pickled and copied, and the copies are equal."""

import copy
import importlib
import inspect
import pickle
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp, csg
from bspcsg.io import RawMesh

SEGMENTS = np.array([[[0, 0], [4, 0]], [[2, -1], [2, 1]], [[1, -2], [1, 2]]], dtype=np.float64)
STARTS = np.column_stack([np.full(40, -1.0), np.linspace(-0.9, 0.9, 40)])
ALONG = [1.0, 0.01]
TREE = bsp.PartitionTree(SEGMENTS, "first", margin=0.5)
SHAPE = b.cube(2) - b.cube(1)
CASTER = bsp.RayCaster(SHAPE)
ORIGINS, UP = [[0.5, 0.5, -1.0], [1.5, 0.25, -1.0]], [0.0, 0.0, 1.0]
SCRIPT = csg.parse("union() { cube(size = [1, 2, 3], center = true); }")
OBJECT = bsp.ObjectTree([[0, 2], [5, 6]])
OTHER = bsp.ObjectTree([[1, 3]])
LABELLED: bsp.AttributeTree[str] = bsp.AttributeTree(1, "all").insert(3.0, ("low", "high"))
TREE_BY_COUNT = bsp.PartitionTree(SEGMENTS, "least-splits")


def grown(threshold: int = 3) -> bsp.AdaptiveTree:
    tree = bsp.AdaptiveTree(SEGMENTS, threshold=threshold)
    tree.test_ray(STARTS, ALONG)
    return tree


def choice() -> bsp.Choice:
    seen: list[bsp.Choice] = []

    def first(shown: bsp.Choice) -> int:
        seen.append(shown)
        return 0

    bsp.PartitionTree(SEGMENTS, first)
    return seen[0]


def merging(kind: type) -> Any:
    return next(step for step in OBJECT.trace_merge(OTHER, "xor") if isinstance(step, kind))


def leaf() -> bsp.Leaf:
    return next(place for place in TREE.walk() if isinstance(place, bsp.Leaf))


def failure(kind: type[b.BspcsgError]) -> Callable[[], b.BspcsgError]:
    return lambda: kind("A sentence.", "a_code", [3, 1])


#: An example of each public class.
EXAMPLES: dict[type, Callable[[], Any]] = {
    b.CheckReport: (b.cube(2) - b.cube(1)).validate,
    b.EdgeSelection: lambda: b.box(1, 2, 3).edges().parallel("z"),
    b.FaceSelection: lambda: b.box(1, 2, 3).faces().parallel("z"),
    b.Finding: lambda: b.Finding("code", "note", "A sentence.", (1, 2), 5),
    b.Assembly: lambda: b.Assembly("a", [b.cube(1)], color=(1, 0, 0)),
    b.Material: lambda: b.Material((1, 0.5, 0)),
    b.LossWarning: lambda: b.LossWarning("something"),
    b.Mesh: SHAPE.to_mesh,
    b.Solid: lambda: SHAPE.rotate(30),
    b.Verdict: lambda: next(iter(b.Verdict)),
    bsp.AdaptiveTree: grown,
    bsp.AttributeTree: lambda: LABELLED,
    bsp.LabelledRegion: lambda: next(iter(LABELLED)),
    bsp.BoundaryPath: lambda: bsp.boundary_paths(bsp.Region.half_plane((1, 2), 3))[0],
    bsp.SubHyperplane: lambda: bsp.SubHyperplane((1, 2), 3, bsp.Intervals([(0, 1)])),
    bsp.SphericalRegion: lambda: bsp.SphericalRegion.arc([1, 0], [1, 2]),
    bsp.Candidate: lambda: TREE_BY_COUNT.trace()[0].candidates[0],
    bsp.CasterNodes: lambda: CASTER.nodes,
    bsp.Choice: choice,
    bsp.Construction: TREE_BY_COUNT.trace,
    bsp.Division: lambda: TREE.trace()[1],
    bsp.MergeHalves: lambda: merging(bsp.MergeHalves),
    bsp.MergeJoin: lambda: merging(bsp.MergeJoin),
    bsp.LeafDivision: lambda: grown().trace()[0],
    bsp.LeafForm: TREE.leaf_form,
    bsp.MergeTrace: lambda: OBJECT.trace_merge(OTHER, "xor"),
    bsp.MergePair: lambda: merging(bsp.MergePair),
    bsp.PointTrace: lambda: TREE.trace_point((0.5, 0.25)),
    bsp.RayCosts: lambda: TREE.test_ray(STARTS, ALONG),
    bsp.RayStep: lambda: TREE.trace_ray(STARTS[0], ALONG).steps[0],
    bsp.RayTrace: lambda: TREE.trace_ray(STARTS[0], ALONG),
    bsp.MergeSplit: lambda: merging(bsp.MergeSplit),
    bsp.StabNodes: lambda: grown().nodes,
    bsp.StabStep: lambda: grown().trace_ray(STARTS[0], ALONG).steps[0],
    bsp.StabTrace: lambda: grown().trace_ray(STARTS[0], ALONG),
    bsp.Camera: lambda: bsp.Camera.orthographic((0, 1, 0)),
    bsp.Comparison: lambda: bsp.compare_policies(SEGMENTS, policies=["first", "random"]),
    bsp.Fragments: lambda: TREE.fragments,
    bsp.HitLists: lambda: CASTER.all_hits(ORIGINS, UP),
    bsp.Hits: lambda: CASTER.first_hit(ORIGINS, UP),
    bsp.InsideSpans: lambda: CASTER.intervals(ORIGINS, UP),
    bsp.Intervals: lambda: bsp.Intervals([(0, 1), (5, np.inf)]),
    bsp.Leaf: leaf,
    bsp.Node: lambda: TREE.nodes[1],
    bsp.NodeTable: lambda: OBJECT.nodes,
    bsp.ObjectTree: lambda: OBJECT,
    bsp.Outline: lambda: bsp.Region.circle(1, 5).outlines[0],
    bsp.PartitionTree: lambda: TREE,
    bsp.Picture: lambda: bsp.picture(SHAPE, size=(40, 30)),
    bsp.Pieces: OBJECT.boundary,
    bsp.PolicyRow: lambda: EXAMPLES[bsp.Comparison]()[0],
    bsp.RayCaster: lambda: CASTER,
    bsp.Region: lambda: bsp.Region.circle(2, 7) - bsp.Region.rectangle(1),
    bsp.StabStats: lambda: grown().stats(),
    bsp.StaticTree: lambda: bsp.StaticTree(SEGMENTS, seed=2),
    bsp.Stats: TREE.stats,
    bsp.Tests: lambda: grown().test_ray(STARTS, ALONG),
    csg.Argument: lambda: SCRIPT.nodes[0].children[0].arguments[0],
    csg.CsgTree: lambda: SCRIPT,
    bsp.DrawingWarning: lambda: bsp.DrawingWarning("something"),
    csg.CsgWarning: lambda: csg.CsgWarning("something"),
    csg.Node: lambda: SCRIPT.nodes[0],
    csg.Polish: lambda: csg.Polish(-4, 5e-5),
    csg.Place: lambda: SCRIPT.nodes[0].place,
    RawMesh: lambda: RawMesh(SHAPE.vertices, SHAPE.faces, "part", unit="mm"),
}

#: Made as one of the classes below it only.
ABSTRACT = {bsp.StabTree}


def public_classes() -> set[type]:
    found = set()
    for name in ("bspcsg", "bspcsg.bsp", "bspcsg.csg", "bspcsg.io", "bspcsg.errors"):
        module = importlib.import_module(name)
        for public in getattr(module, "__all__", vars(module)):
            value = getattr(module, public)
            own = inspect.isclass(value) and value.__module__.startswith("bspcsg.")
            if own and not public.startswith("_"):
                found.add(value)
    return found


def example(kind: type) -> Any:
    if issubclass(kind, b.BspcsgError):
        return failure(kind)()
    return EXAMPLES[kind]()


CLASSES = sorted(public_classes() - ABSTRACT, key=lambda kind: f"{kind.__module__}.{kind.__name__}")
NAMES = [f"{kind.__module__}.{kind.__name__}" for kind in CLASSES]


def assert_same(a: Any, c: Any) -> None:
    """Assert that two values are equal in everything that is visible."""
    assert type(a) is type(c)
    if isinstance(a, np.ndarray):
        assert a.dtype == c.dtype
        assert np.array_equal(a, c, equal_nan=a.dtype.kind == "f")
    elif isinstance(a, BaseException):
        assert a.args == c.args
    elif isinstance(a, b.Assembly):
        assert [(p.path, p.color, p.solid) for p in a] == [(p.path, p.color, p.solid) for p in c]
    elif isinstance(a, b.EdgeSelection):
        assert_same([a.ends, a.normals, a.angle], [c.ends, c.normals, c.angle])
    elif isinstance(a, b.FaceSelection):
        assert_same([a.middle, a.normal, a.area], [c.middle, c.normal, c.area])
    elif isinstance(a, bsp.StabTree):
        assert (a.stats(), a.pitch, a.dimension) == (c.stats(), c.pitch, c.dimension)
    elif isinstance(a, bsp.RayCaster):
        assert (len(a), a.pitch) == (len(c), c.pitch)
        assert_same(a.all_hits(ORIGINS, UP), c.all_hits(ORIGINS, UP))
        assert_same(a.intervals(ORIGINS, UP), c.intervals(ORIGINS, UP))
    elif isinstance(a, (list, tuple)) and not hasattr(a, "_fields"):
        assert len(a) == len(c)
        for one, other in zip(a, c, strict=True):
            assert_same(one, other)
    elif isinstance(a, Mapping):
        assert list(a) == list(c)
        for key in a:
            assert_same(a[key], c[key])
    elif is_dataclass(a):
        for field in fields(a):
            assert_same(getattr(a, field.name), getattr(c, field.name))
    else:
        assert a == c
    assert repr(a) == repr(c)


def pickled(one: Any) -> Any:
    return pickle.loads(pickle.dumps(one))


# Found: trees and casters could not be pickled.
def test_no_class_is_forgotten() -> None:
    errors = {kind for kind in public_classes() if issubclass(kind, b.BspcsgError)}
    assert public_classes() == {*EXAMPLES, *errors, *ABSTRACT}


@pytest.mark.parametrize("kind", CLASSES, ids=NAMES)
def test_pickles_hold_all(kind: type) -> None:
    one = example(kind)
    assert type(one) is kind
    for protocol in (2, pickle.HIGHEST_PROTOCOL):
        data = pickle.dumps(one, protocol)
        assert_same(pickle.loads(data), one)


@pytest.mark.parametrize("kind", CLASSES, ids=NAMES)
def test_copies_hold_all(kind: type) -> None:
    one = example(kind)
    assert_same(copy.copy(one), one)
    assert_same(copy.deepcopy(one), one)
    assert_same(copy.deepcopy([one])[0], one)


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy, pickled])
@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_trees_grow_on_where_they_were(duplicate: Callable[[Any], Any], dimension: int) -> None:
    rng = np.random.default_rng(7)
    shape = (60,) if dimension == 1 else (60, dimension, dimension)
    facets = rng.integers(-9, 10, shape).astype(float)
    rays = [rng.integers(-12, 13, (400, dimension)).astype(float) for _ in range(4)]
    for directions in rays[1::2]:
        directions[~directions.any(axis=1)] = 1
    tree = bsp.AdaptiveTree(facets, threshold=5)
    tree.test_ray(*rays[:2])
    assert tree.stats().subdivisions > 3
    before = tree.stats()
    other = duplicate(tree)
    assert_same(tree.test_ray(*rays[2:]), other.test_ray(*rays[2:]))
    assert tree.stats() == other.stats() != before
    # Each grows by itself.
    tree.test_ray(*rays[:2])
    assert tree.stats() != other.stats()


def test_static_trees_keep_their_order_of_cuts() -> None:
    for order in ("given", "random", [2, 0, 1]):
        tree = bsp.StaticTree(SEGMENTS, order=order, seed=5)
        tree.test_ray(STARTS, ALONG)
        other = pickle.loads(pickle.dumps(tree))
        assert_same(tree.test_ray(STARTS, ALONG), other.test_ray(STARTS, ALONG))


def test_damaged_trees_are_refused_or_are_trees() -> None:
    tree = grown()
    data = tree._tree.dump()
    assert len(data) > 20
    rng = np.random.default_rng(1)
    broken = [data[:k] for k in range(len(data))]
    for _ in range(400):
        changed = bytearray(data)
        changed[rng.integers(len(data))] = rng.integers(256)
        broken.append(bytes(changed))
    refused = 0
    rebuild, (kind, facets, pitch, threshold, _) = tree.__reduce__()
    for bad in broken:
        try:
            other = rebuild(kind, facets, pitch, threshold, bad)
        except b.FormatError as error:
            assert error.code == "bad_snapshot"
            refused += 1
        else:
            hits = other.test_ray(STARTS, ALONG).hits
            assert_same(hits, bsp.RayCaster(SEGMENTS).first_hit(STARTS, ALONG))
    assert refused > len(data)
    with pytest.raises(b.FormatError):
        rebuild(kind, bsp.AdaptiveTree(SEGMENTS[:1])._facets, pitch, threshold, data)


def test_solids_keep_sets_without_bounds() -> None:
    for endless in (b.half_space((1, 2, 3), 4), ~SHAPE, b.Solid.full(), b.Solid.empty()):
        assert_same(pickle.loads(pickle.dumps(endless)) == endless, True)
