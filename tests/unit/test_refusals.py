"""Each public function refuses invalid arguments at once, with an error that has a code.

Every parameter of every function gets every bad value, with all other arguments valid. A function
that is missing here fails the test of completeness.
"""

import inspect
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import Region, Solid
from support.refusals import Row, assert_refused_at_once, methods_of, missing_parameters

SQUARE = [(0, 0), (2, 0), (2, 2), (0, 2)]
UNIT = b.cube(1).to_mesh()
S, OTHER = b.box(1, 2, 3), b.cube(1).translate(5, 0, 0)
R = Region.rectangle(2, 3)
EDGES = S.edges()
TOP = S.faces().sort_by("z")[-1]
DRILLED = {"face": TOP, "at": (0.5, 1, 3), "d": 0.4, "r": None, "depth": 1, "segments": 8}
A = b.Assembly("all", [b.Assembly("one", b.cube(1)), b.Assembly("two", OTHER)])
SCRIPT = Path(__file__).parents[1] / "corpus" / "csg" / "pyramid.csg"


def in_order(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function of keyword arguments that passes their values in order."""
    return lambda **given: function(*given.values())


def watched(tell: Any, every: Any, of: Any) -> None:
    """Enter and leave a `progress` context with these arguments."""
    with b.progress(tell, every=every, of=of):
        pass


#: A name, what is called, and arguments that it takes.
ROWS: dict[str, Row] = {
    "arc": (b.arc, {"center": (0, 0), "r": 1, "start": 0, "stop": 90, "tolerance": 0.1}),
    "bezier": (b.bezier, {"points": [(0, 0), (1, 1), (2, 0)], "tolerance": 0.1}),
    "boolean": (
        b.boolean,
        {"va": UNIT.vertices, "fa": UNIT.faces, "vb": UNIT.vertices, "fb": UNIT.faces, "op": "xor"},
    ),
    "box": (b.box, {"size": 1, "y": 2, "z": 3, "center": False}),
    "box of three": (b.box, {"size": (1, 2, 3)}),
    "cone": (b.cone, {"h": 1, "r": 1, "segments": 8, "center": False}),
    "cone by d": (b.cone, {"h": 1, "d": 1}),
    "cube": (b.cube, {"size": 1, "y": 2, "z": 3, "center": True}),
    "cylinder": (b.cylinder, {"h": 1, "r": 1, "segments": 8, "center": True}),
    "cylinder by r1": (b.cylinder, {"h": 1, "r1": 1, "r2": 2}),
    "cylinder by d1": (b.cylinder, {"h": 1, "d1": 1, "d2": 2}),
    "cylinder by d": (b.cylinder, {"h": 1, "d": 1}),
    **{
        name: (in_order(getattr(b, name)), {"one": S, "two": OTHER})
        for name in ("union", "intersection", "difference", "xor", "hull")
    },
    "hull of points": (in_order(b.hull), {"points": UNIT.vertices}),
    "minkowski": (b.minkowski, {"a": S, "b": OTHER}),
    "minkowski of regions": (b.minkowski, {"a": R, "b": R}),
    "extrude": (
        b.extrude,
        {"polygon": SQUARE, "h": 1, "center": False, "twist": 9, "scale": 0.5, "slices": 3},
    ),
    "extrude with taper": (b.extrude, {"polygon": SQUARE, "h": 1, "taper": 0.1}),
    "grid": (b.grid, {"shape": S, "counts": (2, 2), "steps": (5, 5), "center": True}),
    "half_space": (b.half_space, {"normal": (0, 0, 1), "offset": 1}),
    "helix": (b.helix, {"r": 1, "lead": 1, "turns": 2, "r2": 2, "segments": 8}),
    "helix by pitch": (b.helix, {"r": 1, "pitch": 1, "turns": 2}),
    "level_set": (
        b.level_set,
        {
            "f": lambda p: 1 - np.linalg.norm(p, axis=1),
            "bounds": [(-2, -2, -2), (2, 2, 2)],
            "edge_length": 0.5,
            "level": 0,
        },
    ),
    "linear_pattern": (b.linear_pattern, {"shape": S, "count": 2, "step": (5, 0, 0)}),
    "linear_pattern of a region": (b.linear_pattern, {"shape": R, "count": 2, "step": (5, 0)}),
    "load": (b.load, {"path": SCRIPT}),
    "loft": (b.loft, {"profiles": [(SQUARE, 0), (SQUARE, 1)], "closed": False}),
    "pipe": (b.pipe, {"path": [(0, 0, 0), (0, 0, 2)], "r": 1, "inner": 0.5, "segments": 8}),
    "pipe by d": (b.pipe, {"path": [(0, 0, 0), (0, 0, 2)], "d": 1, "inner_d": 0.5}),
    "polar_pattern": (
        b.polar_pattern,
        {"shape": S, "count": 3, "angle": 90, "axis": "x", "center": (9, 0, 0)},
    ),
    "prism": (b.prism, {"sides": 5, "h": 1, "r": 1, "center": True}),
    "prism by d": (b.prism, {"sides": 5, "h": 1, "d": 1}),
    "progress": (watched, {"tell": lambda told: None, "every": 1.0, "of": 2}),
    "revolve": (b.revolve, {"polygon": SQUARE, "angle": 90, "segments": 8}),
    "rounded_box": (b.rounded_box, {"size": (1, 2, 3), "r": 0.1, "segments": 8, "center": True}),
    "rounded_box of three": (in_order(b.rounded_box), {"x": 1, "y": 2, "z": 3, "r": 0.1}),
    "save": (b.save, {"solid": S, "path": "x.ply", "text": False}),
    "set_threads": (b.set_threads, {"n": 0}),
    "show": (in_order(b.show), {"one": S}),
    "sphere": (b.sphere, {"r": 1, "segments": 8}),
    "sphere by d": (b.sphere, {"d": 1}),
    "spline": (
        b.spline,
        {"points": [(0, 0, 0), (1, 1, 0), (2, 0, 0)], "segments": 4, "closed": False},
    ),
    "surface": (b.surface, {"heights": [[1, 2], [3, 4]], "cell": 1, "floor": 0, "center": True}),
    "sweep": (
        b.sweep,
        {"profile": SQUARE, "path": [(0, 0, 0), (9, 0, 0)], "twist": 9, "scale": 0.5}
        | {"frame": "parallel", "segments": 8},
    ),
    "text": (
        b.text,
        {"string": "a", "size": 10, "font": "Liberation Sans", "halign": "left", "valign": "top"}
        | {"spacing": 1, "direction": "ltr", "language": "en", "script": "Latn", "segments": 8},
    ),
    "torus": (b.torus, {"r": 3, "tube": 1, "segments": 8, "tube_segments": 8}),
    "torus by d": (b.torus, {"d": 3, "tube_d": 1}),
    "validate": (in_order(b.validate), {"op": "union", "one": S, "two": OTHER}),
    "Solid": (
        Solid,
        {"vertices": UNIT.vertices, "faces": UNIT.faces, "pitch": -9, "trusted": False}
        | {"winding": "positive", "vertex_attributes": {"a": np.zeros(8)}}
        | {"corner_attributes": {"c": np.zeros((12, 3))}, "face_attributes": {"f": np.zeros(12)}}
        | {"materials": {"red": b.Material((1, 0, 0))}},
    ),
    "Solid.from_mesh": (
        Solid.from_mesh,
        {"mesh": (UNIT.vertices, UNIT.faces), "tolerance": 0.01},
    ),
    "Solid.load": (Solid.load, {"path": SCRIPT}),
    "Solid.align": (S.align, {"x": "min", "y": "center", "z": "max", "to": (1, 2, 3)}),
    "Solid.chamfer": (S.chamfer, {"edges": EDGES, "size": 0.1}),
    "Solid.fillet": (S.fillet, {"edges": EDGES.parallel("z"), "radius": 0.1, "segments": 8}),
    "Solid.classify": (S.classify, {"points": [(0, 0, 0)]}),
    **{
        f"Solid.{name}": (getattr(S, name), {"other": OTHER})
        for name in ("closest_points", "equals", "intersects", "isdisjoint", "min_gap")
    },
    "Solid.exact_volume": (S.exact_volume, {"most_digits": 1000}),
    "Solid.mirror": (S.mirror, {"normal": (1, 0, 0), "about": (1, 2, 3)}),
    "Solid.normals": (S.normals, {"sharp_angle": 30}),
    "Solid.offset": (S.offset, {"r": 0.1, "segments": 8}),
    "Solid.ray_cast": (S.ray_cast, {"origin": (0, 0, 0), "direction": (1, 1, 1)}),
    "Solid.refine": (S.refine, {"n": 2}),
    "Solid.refine by length": (S.refine, {"edge_length": 0.5}),
    "Solid.rotate": (S.rotate, {"angle": 10, "axis": "z", "about": (1, 2, 3)}),
    "Solid.rotate by axes": (S.rotate, {"x": 10, "y": 20, "z": 30}),
    "Solid.rounded": (S.rounded, {"r": 0.1, "segments": 8, "inside": True}),
    "Solid.save": (S.save, {"path": "x.ply"}),
    "Solid.scale": (S.scale, {"factor": 2, "about": (1, 2, 3)}),
    "Solid.simplify": (S.simplify, {"tolerance": 0.1}),
    "Solid.slice": (S.slice, {"offset": 1, "normal": (0, 0, 1)}),
    "Solid.slice at": (S.slice, {"normal": (0, 0, 1), "origin": (0, 0, 1)}),
    "Solid.smooth": (S.smooth, {"n": 2, "sharp_angle": 60}),
    "Solid.split": (S.split, {"normal": (0, 0, 1), "offset": 1}),
    "Solid.tagged": (S.tagged, {"name": "x"}),
    "Solid.to_csg": (S.to_csg, {"flat": True}),
    "Solid.transform": (S.transform, {"matrix": np.eye(4)}),
    "Solid.translate": (in_order(S.translate), {"x": 1, "y": 2, "z": 3}),
    "Solid.translate by a vector": (in_order(S.translate), {"offset": (1, 2, 3)}),
    "Solid.trim": (S.trim, {"normal": (0, 0, 1), "offset": 1}),
    "Solid.warp": (S.warp, {"f": lambda p: p * 2, "winding": "positive"}),
    **{
        f"{kind}.{name} by numbers": (in_order(getattr(shape, name)), given)
        for kind, shape, given in (
            ("Solid", S, {"x": 3, "y": 2, "z": 1}),
            ("Assembly", A, {"x": 3, "y": 2, "z": 1}),
            ("Region", R, {"x": 3, "y": 2}),
        )
        for name in ("scale", "mirror")
    },
    **{
        f"{kind}.{name} by axes": (getattr(shape, name), dict.fromkeys(axes, 2))
        for kind, shape, axes in (("Solid", S, "xyz"), ("Assembly", A, "xyz"), ("Region", R, "xy"))
        for name in ("translate", "scale", "mirror")
    },
    **{
        f"{kind}.{name}": (in_order(getattr(one, name)), {"one": other, "two": other})
        for kind, one, other in (("Solid", S, OTHER), ("Region", R, R))
        for name in ("union", "intersection", "difference", "symmetric_difference")
    },
    "Region": (Region, {"outlines": [SQUARE], "winding": "positive", "pitch": -9}),
    "Region.cast": (R.cast, {"origin": (0, 0), "direction": (1, 0)}),
    "Region.circle": (Region.circle, {"r": 1, "segments": 8}),
    "Region.circle by d": (Region.circle, {"d": 1}),
    "Region.classify": (R.classify, {"points": [(0, 0)]}),
    "Region.compose": (Region.compose, {"regions": [R, R]}),
    "Region.equals": (R.equals, {"other": R}),
    "Region.isdisjoint": (R.isdisjoint, {"other": R}),
    "Region.extrude": (
        R.extrude,
        {"height": 1, "center": True, "twist": 20, "scale": 0.5, "slices": 4},
    ),
    "Region.extrude with taper": (R.extrude, {"height": 1, "taper": 1}),
    "Region.from_dxf": (Region.from_dxf, {"path": "good.dxf"}),
    "Region.from_svg": (Region.from_svg, {"path": SCRIPT.with_name("drawing.svg")}),
    "Region.from_segments": (
        Region.from_segments,
        {"segments": [[(0, 0), (1, 0)], [(1, 0), (0, 1)], [(0, 1), (0, 0)]]}
        | {"winding": "positive", "pitch": -9},
    ),
    "Region.half_plane": (Region.half_plane, {"normal": (1, 0), "offset": 1, "pitch": -9}),
    "Region.mirror": (R.mirror, {"normal": (1, 0), "about": (1, 2)}),
    "Region.nearest": (R.nearest, {"points": [(0, 0)]}),
    "Region.offset": (R.offset, {"delta": 1, "join": "miter", "segments": 8, "miter_limit": 4}),
    "Region.polygon": (Region.polygon, {"points": SQUARE, "pitch": -9}),
    "Region.project": (R.project, {"points": [(0, 0)]}),
    "Region.rectangle of two": (Region.rectangle, {"width": (1, 2)}),
    "Region.rectangle": (Region.rectangle, {"width": 1, "height": 2, "center": True}),
    "Region.revolve": (R.revolve, {"angle": 90, "segments": 8}),
    "Region.rotate": (R.rotate, {"angle": 10, "about": (1, 2)}),
    "Region.scale": (R.scale, {"factor": 2, "about": (1, 2)}),
    "Region.simplify": (R.simplify, {"tolerance": 0.1}),
    "Region.split": (R.split, {"normal": (1, 0), "offset": 1}),
    "Region.to_dxf": (R.to_dxf, {"path": "x.dxf"}),
    "Region.save": (R.save, {"path": "x.svg"}),
    "Region.to_svg": (R.to_svg, {"path": "x.svg"}),
    "Region.transform": (R.transform, {"matrix": np.eye(3)}),
    "Region.translate": (in_order(R.translate), {"x": 1, "y": 2}),
    "Region.warp": (R.warp, {"function": lambda p: p * 2}),
    "EdgeSelection.parallel": (EDGES.parallel, {"axis": "z"}),
    "EdgeSelection.where": (EDGES.where, {"condition": lambda e: e.length > 1}),
    **{
        f"{kind}.{name}": (getattr(things, name), arguments)
        for kind, things in (("EdgeSelection", EDGES), ("FaceSelection", S.faces()))
        for name, arguments in (
            ("filter", {"condition": np.ones(len(things), bool)}),
            ("on", {"place": "z", "offset": 2}),
            ("sort_by", {"key": "z"}),
            ("group_by", {"key": (0, 0, 1)}),
        )
    },
    "FaceSelection.parallel": (S.faces().parallel, {"axis": "z"}),
    "FaceSelection.where": (S.faces().where, {"condition": lambda f: f.area > 1}),
    "Solid.hole": (
        S.hole,
        {**DRILLED, "d": None, "r": 0.2},
    ),
    "Solid.counterbore": (
        S.counterbore,
        {
            **DRILLED,
            "head_d": None,
            "head_r": 0.3,
            "head_depth": 0.1,
        },
    ),
    "Solid.countersink": (
        S.countersink,
        {
            **DRILLED,
            "head_d": 0.8,
            "head_r": None,
            "angle": 90,
        },
    ),
    "Region.fillet": (
        R.fillet,
        {"r": 0.1, "corners": lambda p: p[:, 0] > 0, "segments": 8},
    ),
    "Region.chamfer": (R.chamfer, {"size": 0.1, "corners": lambda p: p[:, 0] > 0}),
    "Region.regular_polygon": (Region.regular_polygon, {"sides": 6, "r": 1, "d": None}),
    "Region.regular_polygon by flats": (Region.regular_polygon, {"sides": 6, "flats": 1}),
    "Region.slot": (Region.slot, {"length": 5, "r": 1, "d": None, "segments": 8}),
    "Solid.edges": (S.edges, {"all": True, "angle": 30}),
    "Assembly": (b.Assembly, {"name": "x", "content": S, "color": (1, 0, 0), "density": 2}),
    "Assembly.clashes": (A.clashes, {"clearance": 0.1}),
    "Assembly.load": (b.Assembly.load, {"path": SCRIPT}),
    "Assembly.mirror": (A.mirror, {"normal": (1, 0, 0), "about": (1, 2, 3)}),
    "Assembly.rotate": (A.rotate, {"angle": 10, "axis": "z", "about": (1, 2, 3)}),
    "Assembly.rotate by axes": (A.rotate, {"x": 10, "y": 20, "z": 30}),
    "Assembly.save": (A.save, {"path": "x.3mf"}),
    "Assembly.scale": (A.scale, {"factor": 2, "about": (1, 2, 3)}),
    "Assembly.transform": (A.transform, {"matrix": np.eye(4)}),
    "Assembly.translate": (in_order(A.translate), {"offset": (1, 2, 3)}),
    "Material": (b.Material, {"color": (1, 0, 0)}),
}

#: Functions tested elsewhere: a script takes a process of its own, options are those of others.
ELSEWHERE = {"run_script", "Solid.check", "Solid.validate"}

#: Parameters that take numbers which are none: what is said of faces may be anything.
TAKEN = {("Solid.tagged", "name"): True}


@pytest.fixture(autouse=True)
def _elsewhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", lambda _: True)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    if "from_dxf" in request.node.name:
        R.to_dxf("good.dxf")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield
    b.set_threads(0)


@pytest.mark.parametrize("name", ROWS)
def test_good_arguments_are_taken_and_bad_ones_refused_at_once(name: str) -> None:
    call, good = ROWS[name]
    call(**good)
    assert_refused_at_once(name, ROWS[name], TAKEN)


def test_no_public_function_is_missing() -> None:
    functions = {name for name in b.__all__ if inspect.isfunction(getattr(b, name))}
    assert len(functions) > 35
    methods = methods_of(Solid, Region, b.EdgeSelection, b.FaceSelection, b.Assembly)
    assert len(methods) > 60
    told = {name.split()[0] for name in ROWS}
    assert functions | methods <= told | ELSEWHERE


def test_no_parameter_is_missing() -> None:
    apart = {"self", "options", "values", "texture", "format"}
    assert missing_parameters(ROWS, b, apart) == []
