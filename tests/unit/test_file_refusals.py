"""Functions of files and scripts refuse invalid arguments at once, by errors that have a code."""

import inspect
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import bspcsg as b
from bspcsg import csg, io
from support.refusals import Row, assert_refused_at_once, missing_parameters

S = b.box(1, 2, 3)
RAW = io.RawMesh(S.to_mesh().vertices, S.to_mesh().faces)
SCRIPT = "difference() { cube(2); cube(1); }"
TREE = csg.parse(SCRIPT)
DATA = b"".join(io.encoded(RAW, "x.stl", ".stl").chunks)


def ignored(polish: Any) -> None:
    """Receive the result of polishing, and ignore it."""


#: How scripts are evaluated.
EVALUATION: dict[str, Any] = {
    "polish": True,
    "on_polish": ignored,
    "on_invalid": "warn",
    "allow_paths": (".",),
    "lenient": True,
}

#: A name, what is called, and arguments that it takes.
ROWS: dict[str, Row] = {
    "io.decoded": (
        io.decoded,
        {"name": "x.stl", "data": DATA, "suffix": ".stl", "files": None},
    ),
    "io.encoded": (io.encoded, {"mesh": RAW, "path": "x.stl", "suffix": ".stl", "text": False}),
    "io.form_of": (io.form_of, {"path": "x.stl", "text": False}),
    "io.format_of": (io.format_of, {"path": "x.stl"}),
    "io.load": (io.load, {"path": "good.stl"}),
    "io.loads": (io.loads, {"data": DATA, "suffix": ".stl"}),
    "io.read": (io.read, {"path": "good.stl"}),
    "io.read_as": (io.read_as, {"path": "good.stl", "suffix": ".stl"}),
    "io.save": (io.save, {"solid": S, "path": "x.stl", "text": True}),
    "io.write": (io.write, {"mesh": RAW, "path": "x.stl", "text": True}),
    "csg.dump": (csg.dump, {"model": S, "path": "x.csg", "flat": True}),
    "csg.dumps": (csg.dumps, {"model": S, "flat": True}),
    "csg.evaluate": (csg.evaluate, {"tree": TREE, **EVALUATION}),
    "csg.from_json": (csg.from_json, {"text": csg.to_json(TREE), "name": "x", "folder": "."}),
    "csg.graph": (csg.graph, {"tree": TREE}),
    "csg.load": (csg.load, {"path": "good.csg", **EVALUATION}),
    "csg.loads": (
        csg.loads,
        {"text": SCRIPT, **EVALUATION, "folder": ".", "name": "x", "form": "csg"},
    ),
    "csg.outline": (csg.outline, {"tree": TREE}),
    "csg.parse": (csg.parse, {"text": SCRIPT, "name": "x", "folder": "."}),
    "csg.read_tree": (csg.read_tree, {"path": "good.csg"}),
    "csg.simplified": (csg.simplified, {"tree": TREE}),
    "csg.to_json": (csg.to_json, {"tree": TREE, "indent": 1}),
    "csg.tree_of": (csg.tree_of, {"solid": S, "flat": True}),
    "csg.value_of": (csg.value_of, {"text": "1"}),
    "csg.written": (csg.written, {"tree": TREE, "scad": True}),
}

#: It needs the program openscad.
ELSEWHERE = {"csg.read_scad"}


@pytest.fixture(autouse=True)
def _elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    Path("good.stl").write_bytes(DATA)
    Path("good.csg").write_text(SCRIPT, encoding="utf-8")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


# Found: files and scripts took words that mean nothing, as `on_invalid="repiar"`, in silence.
@pytest.mark.parametrize("name", ROWS)
def test_good_arguments_are_taken_and_bad_ones_refused_at_once(name: str) -> None:
    call, good = ROWS[name]
    call(**good)
    assert_refused_at_once(name, ROWS[name], {})


def test_nothing_is_missing() -> None:
    functions = {
        f"{module.__name__.rpartition('.')[2]}.{name}"
        for module in (io, csg)
        for name in module.__all__
        if inspect.isfunction(getattr(module, name))
        and inspect.signature(getattr(module, name)).parameters
    }
    assert len(functions) > 20
    assert functions <= {*ROWS, *ELSEWHERE}
    assert missing_parameters(ROWS, b, {"options"}) == []
