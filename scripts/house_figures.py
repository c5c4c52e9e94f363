"""Figures of a checkout that tell how its code is kept: sizes, comments, examples, rooms, circles.

Blank lines count nowhere. A line is a comment if it holds nothing else; docstrings are comments.
"""

import ast
import doctest
import io
import re
import tokenize
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TypeAlias

from import_graph import (
    circles,
    python_floors,
    python_graph,
    rust_floors,
    rust_graph,
    upward,
)

#: How many lines of files are code, comments and tests, and how many examples are run.
Lines: TypeAlias = Counter[str]


def figures(root: Path) -> list[tuple[str, str, str]]:
    """Return the figures of a checkout: the title, that of Python, and that of Rust."""
    python = sum_of(python_lines(path) for path in (root / "bspcsg").rglob("*.py"))
    rust = sum_of(rust_lines(path) for path in (root / "core" / "src").rglob("*.rs"))
    python += Counter(tests=code_in(root / "tests", "*.py"))
    rust += Counter(tests=code_in(root / "core" / "tests", "*.rs"))
    lines = (python, rust)
    graphs = (python_graph(root), rust_graph(root))
    floors = (python_floors(root), rust_floors(root))
    arrows = zip(graphs, floors, strict=True)
    tops = (root / "bspcsg", root / "core" / "src")
    return [
        _row("files", map(len, graphs)),
        _row("lines of code", (each["code"] for each in lines)),
        _row("comments, of all lines", map(_share, lines)),
        _row("lines of tests to one of code", map(_ratio, lines)),
        _row("examples that are run", (each["examples"] for each in lines)),
        _row("files in circles", (sum(map(len, circles(graph))) for graph in graphs)),
        _row("arrows that point up", (len(upward(graph, rows)) for graph, rows in arrows)),
        _row("files in the largest folder", map(_largest_folder, tops)),
        _row("public names of `Solid`", (len(public_names(tops[0], "Solid")), "")),
    ]


def _row(title: str, values: Iterable[object]) -> tuple[str, str, str]:
    python, rust = values
    return title, str(python), str(rust)


def sum_of(parts: Iterator[Lines]) -> Lines:
    return sum(parts, start=Counter())


def _share(lines: Lines) -> str:
    return f"{lines['comments'] / (lines['code'] + lines['comments']):.0%}"


def _ratio(lines: Lines) -> str:
    return f"{lines['tests'] / lines['code']:.2f}"


def _largest_folder(top: Path) -> str:
    suffixes = (".py", ".rs")
    files = Counter(path.parent for path in top.rglob("*") if path.suffix in suffixes)
    folder, count = max(files.items(), key=lambda item: (item[1], item[0].as_posix()))
    return f"{count} (`{folder.relative_to(top.parent).as_posix()}`)"


def python_lines(path: Path) -> Lines:
    """Count the lines of a module."""
    text = path.read_text(encoding="utf-8")
    said = set[int]()
    examples = 0
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        if docstring := ast.get_docstring(node):
            said.update(range(node.body[0].lineno, (node.body[0].end_lineno or 0) + 1))
            examples += bool(doctest.DocTestParser().get_examples(docstring))
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT and token.line.lstrip().startswith("#"):
            said.add(token.start[0])
    full = {n for n, line in enumerate(text.splitlines(), 1) if line.strip()}
    return Counter(code=len(full - said), comments=len(full & said), examples=examples)


#: Where the tests in a file begin; tests in a file of their own are only named.
_TESTS = r"#\[cfg\(test\)\]\s*(?=(?:pub(?:\([\w: ]+\))? )?mod \w+ \{)"


def rust_lines(path: Path) -> Lines:
    """Count the lines of a file, with the tests at its end apart."""
    text, *tests = re.split(_TESTS, path.read_text(encoding="utf-8"), maxsplit=1)
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    said = [line for line in lines if line.startswith("//")]
    fences = re.findall(r"^\s*//[/!] ```(\w*)$", text, re.MULTILINE)
    if _is_test(path):
        return Counter(tests=len(lines))
    tested = sum(bool(line.strip()) for part in tests for line in part.splitlines())
    examples = sum(language in ("", "rust") for language in fences[::2])
    code = len(lines) - len(said)
    return Counter(code=code, comments=len(said), tests=tested, examples=examples)


def _is_test(path: Path) -> bool:
    """Say whether the folder's file includes a file only when tests are built."""
    folder = path.parent / "mod.rs"
    text = folder.read_text(encoding="utf-8") if folder.exists() else ""
    included = rf"#\[cfg\(test\)\]\s*(pub(\(\w+\))? )?mod {path.stem};"
    return path.name == "tests.rs" or re.search(included, text) is not None


def code_in(folder: Path, pattern: str) -> int:
    """Count the lines in a folder that are not blank."""
    texts = (path.read_text(encoding="utf-8") for path in folder.rglob(pattern))
    return sum(bool(line.strip()) for text in texts for line in text.splitlines())


def public_names(package: Path, name: str) -> set[str]:
    """Return the public names in the body of a class and of the package's classes below it."""
    classes = {
        node.name: node
        for path in package.rglob("*.py")
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ClassDef)
    }
    found, open_ = set[str](), [name]
    while open_:
        node = classes.get(open_.pop())
        if node:
            open_ += [base.id for base in node.bases if isinstance(base, ast.Name)]
            found.update(_names_in(node))
    return {name for name in found if not name.startswith("_")}


def _names_in(node: ast.ClassDef) -> Iterator[str]:
    for line in node.body:
        if isinstance(line, ast.FunctionDef):
            yield line.name
        elif isinstance(line, ast.Assign):
            yield from (target.id for target in line.targets if isinstance(target, ast.Name))


def table(root: Path) -> str:
    """Return the figures as a table in Markdown."""
    rows = [("", "Python", "Rust"), ("---", "---", "---"), *figures(root)]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows) + "\n"
