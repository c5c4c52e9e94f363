"""Imports go one way, file by file."""

import ast
from pathlib import Path

import networkx as nx
import pytest

import bspcsg
from import_graph import (
    ROOT,
    circles,
    python_floors,
    python_graph,
    rust_floors,
    rust_graph,
    upward,
)
from import_graph import _tails as tails
from rooms import PICTURE, picture

#: Modules with imports inside functions, and why; those of the command line start only what their
#: verb needs.
DEFERRED = {
    "bspcsg/io.py": "mesh files are read without the scripts' evaluator",
    "bspcsg/formats/registry.py": "a format is imported when a file has its suffix",
    "bspcsg/bench/engines.py": "an engine is imported by the process that measures it",
    "bspcsg/bench/real.py": "cases are listed without the package",
}


@pytest.fixture(scope="module")
def python() -> nx.DiGraph:
    return python_graph()


@pytest.fixture(scope="module")
def rust() -> nx.DiGraph:
    return rust_graph()


def test_no_files_of_the_package_need_each_other(python: nx.DiGraph) -> None:
    assert len(python) > 200
    assert circles(python) == []


def test_no_import_of_the_package_leads_upwards(python: nx.DiGraph) -> None:
    assert upward(python, python_floors()) == []


def test_no_path_of_the_crate_leads_upwards(rust: nx.DiGraph) -> None:
    assert len(rust.edges) > 500
    assert upward(rust, rust_floors()) == []


def test_no_files_of_the_crate_need_each_other(rust: nx.DiGraph) -> None:
    assert circles(rust) == []


def test_a_circle_and_an_upward_arrow_are_found() -> None:
    graph = nx.DiGraph([("low.a", "low.b"), ("low.b", "low.a"), ("low.b", "high.c")])
    assert circles(graph) == [["low.a", "low.b"]]
    assert upward(graph, [["high"], ["low"]]) == ["low.b -> high.c"]


def test_groups_in_rust_paths_are_taken_apart() -> None:
    code = "a::{b, c::{D, self}, e::F};"
    assert tails(code, 0)[0] == [
        ("a", "b"),
        ("a", "c", "D"),
        ("a", "c", "self"),
        ("a", "e", "F"),
    ]


def test_the_picture_of_the_rooms_is_the_code_s() -> None:
    assert PICTURE.read_text(encoding="utf-8") == picture(), "run scripts/rooms"


def has_deferred_imports(path: Path) -> bool:
    """Say whether a function imports something of the package."""
    functions = [
        node
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
    ]
    return any(
        isinstance(node, ast.ImportFrom)
        and (node.level or (node.module or "").startswith("bspcsg"))
        for function in functions
        for node in ast.walk(function)
    )


def test_imports_inside_functions_have_a_reason() -> None:
    found = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "bspcsg").rglob("*.py")
        if has_deferred_imports(path)
    }
    assert {name for name in found if not name.startswith("bspcsg/cli/")} == set(DEFERRED)


def test_no_module_hides_a_public_name() -> None:
    # An import of `bspcsg.name` would put the module where the name was.
    beside = {path.stem for path in (ROOT / "bspcsg").iterdir()}
    assert beside & set(bspcsg.__all__) <= set(bspcsg._PARTS)
