"""The graph of files by their uses, in both languages: circles, upward arrows, sizes of rooms.

A room is a folder of the package or of the crate, or a file beside them. Its floor is the one that
`pyproject.toml` (import-linter) or `core/tests/layering.rs` gives it. What annotations alone name
is no arrow.
"""

import re
import sys
import tomllib
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import TypeAlias

import grimp
import networkx as nx

ROOT = Path(__file__).resolve().parent.parent

#: Floors from the top; rooms on one of them are independent of each other.
Floors: TypeAlias = list[list[str]]


def python_floors(root: Path = ROOT) -> Floors:
    """Return the floors of the package."""
    settings = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))
    layers = settings["tool"]["importlinter"]["contracts"][0]["layers"]
    return [re.split(r" *[|:] *", layer) for layer in layers]


def rust_floors(root: Path = ROOT) -> Floors:
    """Return the floors of the crate."""
    text = (root / "core" / "tests" / "layering.rs").read_text(encoding="utf-8")
    listed = re.search(r"const LAYERS[^=]*= \[(.*?)\]", text, re.S)
    return [] if listed is None else [[name] for name in re.findall(r'"(\w+)"', listed[1])[::-1]]


def python_graph(root: Path = ROOT) -> nx.DiGraph:
    """Return the imports among the package's files, named as modules."""
    sys.path.insert(0, str(root))
    imports = grimp.build_graph("bspcsg", exclude_type_checking_imports=True, cache_dir=None)
    del sys.path[0]
    graph = nx.DiGraph()
    for path in sorted((root / "bspcsg").rglob("*.py")):
        name = ".".join(path.relative_to(root).with_suffix("").parts).removesuffix(".__init__")
        graph.add_node(name, lines=_lines(path))
        used = imports.find_modules_directly_imported_by(name)
        graph.add_edges_from((name, other) for other in sorted(used))
    return graph


def rust_graph(root: Path = ROOT) -> nx.DiGraph:
    """Return which of the crate's files names which, tests in them left out."""
    source = root / "core" / "src"
    modules = {
        tuple(
            p for p in path.relative_to(source).with_suffix("").parts if p not in ("mod", "lib")
        ): path
        for path in source.rglob("*.rs")
    }
    codes = {name: code_of(path) for name, path in modules.items()}
    graph = nx.DiGraph()
    for name, code in codes.items():
        graph.add_node("::".join(name), lines=_lines(modules[name]))
        for path in _paths(code, name):
            found = _home(path, codes)
            if found and found != name and found[: len(name)] != name:
                graph.add_edge("::".join(name), "::".join(found))
    return graph


def code_of(path: Path) -> str:
    """Return a Rust file without comments and without the tests at its end."""
    text = re.sub(r"//.*", "", path.read_text(encoding="utf-8"))
    return re.split(r"#\[cfg\(test\)\]\s*mod ", text)[0]


def _paths(code: str, module: tuple[str, ...]) -> Iterator[tuple[str, ...]]:
    """Yield the paths that start at the crate or climb out of a module, groups taken apart."""
    for found in re.finditer(r"\b(crate|super)((?:::super)*)::", code):
        climbs = 1 + found[2].count("super")
        base = () if found[1] == "crate" else module[: max(len(module) - climbs, 0)]
        yield from (base + tail for tail in _tails(code, found.end())[0])


def _tails(code: str, at: int) -> tuple[list[tuple[str, ...]], int]:
    """Return the paths that begin at a place, such as `a::{b, c}`, and where it ends."""
    if code[at : at + 1] != "{":
        word = re.compile(r"\w*").match(code, at)
        name, end = (word[0], word.end()) if word else ("", at)
        if code[end : end + 2] != "::":
            return [(name,)], end
        tails, end = _tails(code, end + 2)
        return [(name, *tail) for tail in tails], end
    found: list[tuple[str, ...]] = []
    at += 1
    while code[at] != "}":
        inner, end = _tails(code, at)
        found += [tail for tail in inner if tail != ("",)]
        at = max(end, at + 1) if inner != [("",)] else at + 1
    return found, at + 1


def _home(path: tuple[str, ...], codes: dict[tuple[str, ...], str]) -> tuple[str, ...]:
    """Return the file that a path leads to, through what a folder's file hands on."""
    home = next((path[:n] for n in range(len(path), 0, -1) if path[:n] in codes), ())
    rest = path[len(home) :]
    if home and rest:
        for given in re.finditer(r"pub(?:\([^)]*\))? use (?:self::)?(?!crate|super)", codes[home]):
            for tail in _tails(codes[home], given.end())[0]:
                if len(tail) > 1 and tail[-1] == rest[0] and home + tail[:-1] in codes:
                    return _home(home + tail, codes)
    return home


def _lines(path: Path) -> int:
    return len(path.read_text(encoding="utf-8").splitlines())


def circles(graph: nx.DiGraph) -> list[list[str]]:
    """Return the files that need each other, circle by circle."""
    return sorted(sorted(part) for part in nx.strongly_connected_components(graph) if len(part) > 1)


def room_of(name: str) -> str:
    """Return the room of a file."""
    return re.split(r"\.|::", name.removeprefix("bspcsg."))[0]


def upward(graph: nx.DiGraph, floors: Floors) -> list[str]:
    """Return the arrows from a lower floor to a higher one."""
    height = {room: -number for number, rooms in enumerate(floors) for room in rooms}
    return [
        f"{a} -> {b}"
        for a, b in graph.edges
        if height.get(room_of(a), 0) < height.get(room_of(b), -len(floors))
    ]


def rooms(graph: nx.DiGraph) -> tuple[Counter[str], Counter[str]]:
    """Return how many files, and lines, each room has."""
    files, lines = Counter[str](), Counter[str]()
    for name, data in graph.nodes(data=True):
        files[room_of(name)] += 1
        lines[room_of(name)] += data["lines"]
    return files, lines


def main() -> None:
    """Print what there is to know."""
    for title, graph, floors in (
        ("Python", python_graph(), python_floors()),
        ("Rust", rust_graph(), rust_floors()),
    ):
        files, lines = rooms(graph)
        print(f"{title}: {len(graph)} files, {len(graph.edges)} arrows")
        print(
            *(f"  {name:16}{files[name]:4} files {lines[name]:6} lines" for name in files), sep="\n"
        )
        print("  upward:", *(upward(graph, floors) or ["none"]))
        print(
            "  circles:", *(" ".join(names) for names in circles(graph) or [["none"]]), sep="\n    "
        )


if __name__ == "__main__":
    main()
