"""Docstrings and doc comments say what a thing does or is: no questions at the start."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MODULES = sorted((ROOT / "bspcsg").rglob("*.py"))
SOURCES = sorted(
    path
    for folder in ("core", "fuzz", "lecture")
    for path in (ROOT / folder).rglob("*.rs")
    if "target" not in path.parts
)

_QUESTION = re.compile(r"(What|Whether|Which|Who|Whose|How|Where|When|Why)\b")
_COMMENT = re.compile(r"\s*(//[/!]|#:) ?(.*)")


def first_words(module: str) -> Iterator[tuple[str, str]]:
    """Yield name and docstring of a module, and of its classes and functions, nested ones too."""
    for node in ast.walk(ast.parse(module)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield getattr(node, "name", "the module"), ast.get_docstring(node) or ""


@pytest.mark.parametrize("module", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_docstrings_say_what_things_do(module: Path) -> None:
    found = first_words(module.read_text(encoding="utf-8"))
    assert [name for name, text in found if _QUESTION.match(text)] == []


def comments(source: str) -> Iterator[str]:
    """Yield the first line of each doc comment of a source in Rust, or in Python."""
    before = ""
    for line in source.splitlines():
        found = _COMMENT.match(line)
        mark = found[1] if found else ""
        if found and mark != before:
            yield found[2]
        before = mark


@pytest.mark.parametrize("module", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_comments_of_python_say_what_things_are(module: Path) -> None:
    found = comments(module.read_text(encoding="utf-8"))
    assert [line for line in found if _QUESTION.match(line)] == []


def test_comments_of_rust_say_what_things_are() -> None:
    read = ((path, comments(path.read_text(encoding="utf-8"))) for path in SOURCES)
    found = [(path.name, line) for path, lines in read for line in lines if _QUESTION.match(line)]
    assert len(SOURCES) > 200 and found == []


def test_a_question_is_noticed() -> None:
    found = list(first_words('"""Trees."""\n\ndef f():\n    """Whether it holds."""\n'))
    assert found == [("the module", "Trees."), ("f", "Whether it holds.")]
    [(_, text)] = first_words('"""Which cases a name means."""')
    assert _QUESTION.match(text)
    assert list(comments("#: The end,\n#: which is far.\n_A = 1\n    #: How far.\n")) == [
        "The end,",
        "How far.",
    ]
    source = "//! Trees.\n\n/// The place.\n/// Where it ends.\n    /// Whether it holds.\n"
    assert list(comments(source)) == ["Trees.", "The place."]
    [line] = comments("    /// Whether it holds.\n    fn holds();")
    assert _QUESTION.match(line)
