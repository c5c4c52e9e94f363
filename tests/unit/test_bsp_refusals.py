"""Trees, sets and rays refuse invalid arguments at once, with an error that has a code.

Every parameter of every function and method of `bspcsg.bsp` gets every bad value, with all other
arguments valid. A function that is missing here fails the test of completeness.
"""

import inspect
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bspcsg import Region, box, bsp
from support.refusals import Row, assert_refused_at_once, methods_of, missing_parameters

S, R, LINE = box(1, 2, 3), Region.rectangle(2, 3), bsp.Intervals([(0, 1)])
EDGES = np.array([[[0, 0], [1, 0]], [[1, 0], [0, 1]], [[0, 1], [0, 0]]], dtype=np.float64)
TRIANGLES = np.array(
    [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 1], [1, 0, 1], [0, 1, 1]]], dtype=np.float64
)
PLANAR, SPATIAL = bsp.PartitionTree(EDGES), bsp.PartitionTree(TRIANGLES)
FIRST, SECOND = bsp.ObjectTree(EDGES), bsp.ObjectTree(EDGES + 0.25)
GROWING, FIXED = bsp.AdaptiveTree(EDGES), bsp.StaticTree(EDGES)
CASTER = bsp.RayCaster(S)
START, AHEAD = [0.5, 0.5, -1.0], [0.0, 0.0, 1.0]
CAP = bsp.SphericalRegion.hemisphere([0, 0, 1])
CUT = bsp.SubHyperplane((1, 0), 0.5, LINE)
CAMERA = bsp.Camera.perspective((5, 5, 5), (0, 0, 0))
LABELLED: bsp.AttributeTree[str] = bsp.AttributeTree(2, "a")
TEXT = SPATIAL.to_json()


class Visitor:
    """A visitor that does nothing."""

    def node(self, node: Any) -> None:
        """Ignore a node."""

    def leaf(self, leaf: Any) -> None:
        """Ignore a leaf."""


def _with(method: Callable[..., Any]) -> Callable[..., Any]:
    """Return a method that takes any number of sets as a function of one set, by name."""

    def called(others: Any) -> Any:
        return method(others)

    return called


#: A name, what is called, and arguments that it takes.
ROWS: dict[str, Row] = {
    "AdaptiveTree": (bsp.AdaptiveTree, {"facets": EDGES, "threshold": 3, "pitch": -9}),
    "AdaptiveTree.region": (GROWING.region, {"node": 0, "margin": 1.0}),
    "AdaptiveTree.test_ray": (GROWING.test_ray, {"origins": [[-1, 0.2]], "directions": [[1, 0]]}),
    "AdaptiveTree.trace_ray": (GROWING.trace_ray, {"origin": [-1, 0.2], "direction": [1, 0]}),
    "AttributeTree": (bsp.AttributeTree, {"dimension": 2, "label": "a", "pitch": -9}),
    "AttributeTree.insert": (LABELLED.insert, {"facet": EDGES[0], "rule": ("x", "y")}),
    "AttributeTree.insert_hyperplane": (
        LABELLED.insert_hyperplane,
        {"normal": (1, 0), "offset": 0.5, "rule": ("x", "y")},
    ),
    "AttributeTree.label_at": (LABELLED.label_at, {"point": (0, 0)}),
    "AttributeTree.labels_at": (LABELLED.labels_at, {"point": (0, 0)}),
    "AttributeTree.mapped": (LABELLED.mapped, {"function": str}),
    "Camera.fitted": (CAMERA.fitted, {"points": TRIANGLES[0], "aspect": 1.0, "margin": 0.1}),
    "Camera.named": (
        bsp.Camera.named,
        {
            "view": "iso",
            "points": TRIANGLES[0],
            "aspect": 1.0,
            "field_of_view": 30.0,
            "margin": 0.1,
        },
    ),
    "Camera.orthographic": (
        bsp.Camera.orthographic,
        {"direction": (1, 0, 0), "up": (0, 0, 1), "scale": 1.0, "target": (0, 0, 0)},
    ),
    "Camera.perspective": (
        bsp.Camera.perspective,
        {"eye": (5, 5, 5), "target": (0, 0, 0), "up": (0, 0, 1), "field_of_view": 30.0},
    ),
    "Camera.project": (CAMERA.project, {"points": TRIANGLES[0]}),
    "Intervals": (bsp.Intervals, {"pairs": [(0, 1)], "pitch": -9}),
    "Intervals.classify": (LINE.classify, {"points": [0.5]}),
    "Intervals.equals": (LINE.equals, {"other": LINE}),
    "Intervals.isdisjoint": (LINE.isdisjoint, {"other": LINE}),
    "Intervals.project": (LINE.project, {"points": [0.5]}),
    "Intervals.scale": (LINE.scale, {"factor": 2}),
    "Intervals.difference": (_with(LINE.difference), {"others": LINE}),
    "Intervals.intersection": (_with(LINE.intersection), {"others": LINE}),
    "Intervals.symmetric_difference": (_with(LINE.symmetric_difference), {"others": LINE}),
    "Intervals.union": (_with(LINE.union), {"others": LINE}),
    "Intervals.nearest": (LINE.nearest, {"points": [0.5]}),
    "Intervals.split": (LINE.split, {"normal": [1], "offset": 0.5}),
    "Intervals.translate": (LINE.translate, {"offset": 2}),
    "ObjectTree": (
        bsp.ObjectTree,
        {
            "facets": EDGES,
            "winding": "positive",
            "pitch": -9,
            "policy": "random",
            "seed": 1,
            "cuts": [((1, 0), 0.5)],
        },
    ),
    "ObjectTree.classify": (FIRST.classify, {"points": [(0.1, 0.1)]}),
    "ObjectTree.equals": (FIRST.equals, {"other": SECOND}),
    "ObjectTree.from_mesh": (bsp.ObjectTree.from_mesh, {"mesh": S}),
    "ObjectTree.half_space": (
        bsp.ObjectTree.half_space,
        {"normal": (1, 0), "offset": 0.5, "pitch": -9},
    ),
    "ObjectTree.isdisjoint": (FIRST.isdisjoint, {"other": SECOND}),
    "ObjectTree.nearest": (FIRST.nearest, {"points": [(0.1, 0.1)]}),
    "ObjectTree.partitioned": (FIRST.partitioned, {"normal": (1, 0), "offset": 0.5}),
    "ObjectTree.project": (FIRST.project, {"points": [(0.1, 0.1)]}),
    "ObjectTree.difference": (_with(FIRST.difference), {"others": SECOND}),
    "ObjectTree.intersection": (_with(FIRST.intersection), {"others": SECOND}),
    "ObjectTree.symmetric_difference": (_with(FIRST.symmetric_difference), {"others": SECOND}),
    "ObjectTree.union": (_with(FIRST.union), {"others": SECOND}),
    "ObjectTree.split": (FIRST.split, {"normal": (1, 0), "offset": 0.5}),
    "ObjectTree.split_case": (FIRST.split_case, {"normal": (1, 0), "offset": 0.5}),
    "ObjectTree.trace_merge": (FIRST.trace_merge, {"other": SECOND, "op": "union"}),
    "ObjectTree.uniform": (bsp.ObjectTree.uniform, {"dimension": 2, "full": True, "pitch": -9}),
    "PartitionTree": (
        bsp.PartitionTree,
        {
            "facets": TRIANGLES,
            "policy": "random",
            "seed": 1,
            "top": 1,
            "sample": 3,
            "alpha": 0.5,
            "cuts": [((1, 0, 0), 0.5)],
            "pitch": -9,
            "non_planar": "error",
            "degenerate": "drop",
            "margin": 1.0,
        },
    ),
    "PartitionTree.back_to_front": (SPATIAL.back_to_front, {"eye": (5, 5, 5)}),
    "PartitionTree.back_to_front direction": (SPATIAL.back_to_front, {"direction": (5, 5, 5)}),
    "PartitionTree.front_to_back direction": (SPATIAL.front_to_back, {"direction": (5, 5, 5)}),
    "PartitionTree.far_to_near direction": (
        lambda **k: list(SPATIAL.far_to_near(**k)),
        {"direction": (5, 5, 5)},
    ),
    "PartitionTree.near_to_far direction": (
        lambda **k: list(SPATIAL.near_to_far(**k)),
        {"direction": (5, 5, 5)},
    ),
    "PartitionTree.front_to_back": (SPATIAL.front_to_back, {"eye": (5, 5, 5)}),
    "PartitionTree.far_to_near": (lambda **k: list(SPATIAL.far_to_near(**k)), {"eye": (5, 5, 5)}),
    "PartitionTree.near_to_far": (lambda **k: list(SPATIAL.near_to_far(**k)), {"eye": (5, 5, 5)}),
    "PartitionTree.cost": (SPATIAL.cost, {"query": "point", "margin": 1.0}),
    "PartitionTree.from_json": (bsp.PartitionTree.from_json, {"text": TEXT}),
    "PartitionTree.from_mesh": (
        bsp.PartitionTree.from_mesh,
        {"mesh": S, "policy": "random", "top": 3},
    ),
    "PartitionTree.insert": (
        SPATIAL.insert,
        {"facets": TRIANGLES + 5, "policy": "random", "seed": 1, "sample": 3, "alpha": 0.5},
    ),
    "PartitionTree.load": (bsp.PartitionTree.load, {"path": "good.tree"}),
    "PartitionTree.locate": (SPATIAL.locate, {"point": (1, 2, 3)}),
    "PartitionTree.moved": (SPATIAL.moved, {"axes": (1, 2, 3), "offset": (1, 0, 0), "scale": 2}),
    "PartitionTree.perfect": (bsp.PartitionTree.perfect, {"facets": TRIANGLES}),
    "PartitionTree.region": (SPATIAL.region, {"of": None, "margin": 1.0}),
    "PartitionTree.save": (SPATIAL.save, {"path": "x.tree"}),
    "PartitionTree.test_ray": (SPATIAL.test_ray, {"origins": [START], "directions": [AHEAD]}),
    "PartitionTree.to_svg": (PLANAR.to_svg, {"size": 100}),
    "PartitionTree.trace_point": (SPATIAL.trace_point, {"point": (1, 2, 3)}),
    "PartitionTree.trace_ray": (SPATIAL.trace_ray, {"origin": START, "direction": AHEAD}),
    "PartitionTree.visit": (SPATIAL.visit, {"visitor": Visitor(), "order": "pre"}),
    "PartitionTree.walk": (lambda **k: list(SPATIAL.walk(**k)), {"order": "pre"}),
    "PartitionTree.with_cuts": (SPATIAL.with_cuts, {"cuts": SPATIAL.arrays["cut"]}),
    "RayCaster": (bsp.RayCaster, {"facets": TRIANGLES, "pitch": -9, "deferred": True}),
    "RayCaster.all_hits": (
        CASTER.all_hits,
        {"origins": [START], "directions": [AHEAD], "merge": True, "threads": 1},
    ),
    "RayCaster.first_facet": (
        CASTER.first_facet,
        {"origins": [START], "directions": [AHEAD], "threads": 1},
    ),
    "RayCaster.first_hit": (
        CASTER.first_hit,
        {"origins": [START], "directions": [AHEAD], "threads": 1},
    ),
    "RayCaster.intervals": (
        CASTER.intervals,
        {"origins": [START], "directions": [AHEAD], "winding": "positive", "threads": 1},
    ),
    "RayCaster.occluded": (CASTER.occluded, {"origins": [START], "targets": [AHEAD], "threads": 1}),
    "RayCaster.occluded along": (
        CASTER.occluded,
        {"origins": [START], "directions": [AHEAD], "max_t": 3.0, "threads": 1},
    ),
    "RayCaster.refitted": (CASTER.refitted, {"facets": S}),
    "SphericalRegion": (
        bsp.SphericalRegion,
        {"cone": bsp.ObjectTree.uniform(3, full=True, pitch=0)},
    ),
    "SphericalRegion.arc": (bsp.SphericalRegion.arc, {"start": (1, 0), "end": (0, 1)}),
    "SphericalRegion.classify": (CAP.classify, {"directions": [(1, 0, 0)]}),
    "SphericalRegion.empty": (bsp.SphericalRegion.empty, {"dimension": 3}),
    "SphericalRegion.full": (bsp.SphericalRegion.full, {"dimension": 3}),
    "SphericalRegion.hemisphere": (bsp.SphericalRegion.hemisphere, {"axis": (1, 0, 0)}),
    "SphericalRegion.polygon": (
        bsp.SphericalRegion.polygon,
        {"corners": [(1, 0, 0), (0, 1, 0), (0, 0, 1)]},
    ),
    "StaticTree": (
        bsp.StaticTree,
        {"facets": TRIANGLES, "order": "random", "seed": 1, "pitch": -9, "max_nodes": 1000},
    ),
    "StaticTree.region": (FIXED.region, {"node": 0, "margin": 1.0}),
    "StaticTree.test_ray": (FIXED.test_ray, {"origins": [[-1, 0.2]], "directions": [[1, 0]]}),
    "StaticTree.trace_ray": (FIXED.trace_ray, {"origin": [-1, 0.2], "direction": [1, 0]}),
    "SubHyperplane": (bsp.SubHyperplane, {"normal": (1, 0), "offset": 0.5, "part": LINE}),
    "SubHyperplane.inside": (
        bsp.SubHyperplane.inside,
        {"points": R, "normal": (1, 0), "offset": 0.5},
    ),
    "SubHyperplane.of_boundary": (bsp.SubHyperplane.of_boundary, {"points": R}),
    "SubHyperplane.project": (CUT.project, {"points": [(1, 2)]}),
    "SubHyperplane.nearest": (CUT.nearest, {"points": [(0.1, 0.1)]}),
    "SubHyperplane.split": (CUT.split, {"normal": (0, 1), "offset": 0.5}),
    "SubHyperplane.transform": (CUT.transform, {"matrix": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]}),
    "Picture.save": (bsp.picture(S, size=(64, 64)).save, {"path": "x.png"}),
    "boundary_paths": (bsp.boundary_paths, {"region": R}),
    "compare_policies": (
        bsp.compare_policies,
        {"facets": TRIANGLES, "policies": ("first", "random")},
    ),
    "load_dxf": (
        bsp.load_dxf,
        {"path": "good.dxf", "tolerance": 0.1, "layers": ["0"], "winding": "even-odd", "pitch": -9},
    ),
    "load_svg": (
        bsp.load_svg,
        {"path": "good.svg", "tolerance": 0.1, "winding": "even-odd", "pitch": -9},
    ),
    "merge": (bsp.merge, {"a": FIRST, "b": SECOND, "op": "union"}),
    "optimised_tree": (
        bsp.optimised_tree,
        {
            "facets": EDGES,
            "origins": [[-1, 0.2]],
            "directions": [[1, 0]],
            "weights": [1.0],
            "pitch": -9,
            "max_nodes": 100,
        },
    ),
    "optimised_tree density": (
        bsp.optimised_tree,
        {
            "facets": EDGES,
            "origins": [[-1, 0.2]],
            "directions": [[1, 0]],
            "density": lambda o, d: np.ones(len(o)),
        },
    ),
    "panorama": (
        bsp.panorama,
        {
            "scene": EDGES,
            "eye": (5, 5),
            "size": (64, 64),
            "colors": "#ff0000",
            "background": "white",
            "samples": 1,
        },
    ),
    "panorama direction": (bsp.panorama, {"scene": EDGES, "direction": (5, 5), "size": (64, 64)}),
    "partition_tree": (bsp.partition_tree, {"tree": FIRST, "hyperplane": ((1, 0), 0.5)}),
    "picture": (
        bsp.picture,
        {
            "scene": S,
            "view": "iso",
            "size": (64, 64),
            "style": "shaded",
            "edges": "feature",
            "crease": 20.0,
            "colors": "#ff0000",
            "background": "white",
            "cull": True,
            "line_width": 1.0,
            "samples": 1,
        },
    ),
    "picture camera": (bsp.picture, {"scene": S, "camera": CAMERA, "size": (64, 64)}),
    "plane_frame": (bsp.plane_frame, {"normal": (1, 2, 3)}),
    "save_dxf": (bsp.save_dxf, {"region": R, "path": "x.dxf"}),
    "save_svg": (bsp.save_svg, {"region": R, "path": "x.svg", "fill": "#fff", "margin": 0.1}),
    "scores": (
        bsp.scores,
        {"facets": EDGES, "origins": [[-1, 0.2]], "directions": [[1, 0]], "weights": [1.0]},
    ),
    "scores density": (
        bsp.scores,
        {
            "facets": EDGES,
            "origins": [[-1, 0.2]],
            "directions": [[1, 0]],
            "density": lambda o, d: np.ones(len(o)),
        },
    ),
    "slice_solid": (bsp.slice_solid, {"solid": S, "offset": 0.5, "normal": (0, 0, 1)}),
    "slice_solid origin": (
        bsp.slice_solid,
        {"solid": S, "normal": (0, 0, 1), "origin": (0, 0, 0.5)},
    ),
    "split_tree": (bsp.split_tree, {"tree": FIRST, "hyperplane": ((1, 0), 0.5)}),
    "visibility_polygon": (
        bsp.visibility_polygon,
        {"segments": EDGES, "eye": (5, 5), "low": (-9, -9), "high": (9, 9)},
    ),
    "visibility_volume": (
        bsp.visibility_volume,
        {"triangles": TRIANGLES, "eye": (5, 5, 5), "low": (-9, -9, -9), "high": (9, 9, 9)},
    ),
    "visible_sky": (bsp.visible_sky, {"facets": EDGES, "eye": (5, 5)}),
}

#: Labels may be anything, two lists, too.
TAKEN = {
    ("AttributeTree", "label"): True,
    ("AttributeTree.insert", "rule"): True,
    ("AttributeTree.insert_hyperplane", "rule"): True,
}

#: The classes whose constructors users call; objects of other classes are returned by functions.
KINDS = (
    *(bsp.AdaptiveTree, bsp.AttributeTree, bsp.Camera, bsp.Intervals, bsp.ObjectTree),
    *(bsp.PartitionTree, bsp.Picture, bsp.RayCaster, bsp.SphericalRegion, bsp.StaticTree),
    bsp.SubHyperplane,
)

#: Methods that only this package calls, with arguments that it has checked.
WITHIN = {"Camera.facing", "Camera.flatten", "Camera.place", "PartitionTree.from_core"}


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    R.to_dxf("good.dxf")
    R.to_svg("good.svg")
    SPATIAL.save("good.tree")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


# Found: many functions of trees and sets in `bspcsg.bsp` took values that make no sense, or
# raised whatever numpy or Python raised.
@pytest.mark.parametrize("name", ROWS)
def test_good_arguments_are_taken_and_bad_ones_refused_at_once(name: str) -> None:
    call, good = ROWS[name]
    call(**good)
    assert_refused_at_once(name, ROWS[name], TAKEN)


def test_no_public_function_is_missing() -> None:
    functions = {name for name in bsp.__all__ if inspect.isfunction(getattr(bsp, name))}
    assert len(functions) > 15
    methods = methods_of(*KINDS)
    assert len(methods) > 60
    assert functions | methods <= {name.split()[0] for name in ROWS} | WITHIN


def test_no_parameter_is_missing() -> None:
    # Options are those of the constructors.
    assert missing_parameters(ROWS, bsp, {"self", "options"}) == []
