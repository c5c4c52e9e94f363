"""Docstrings and doc comments say what a thing does or is: no questions at the start.

Neither do the descriptions of parameters, of fields and of what is returned or raised.
"""

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

SCRIPTS = sorted(
    path
    for folder in ("bspcsg/report/assets/viewer", "bspcsg/report/assets/lecture", "docs/site")
    for path in (ROOT / folder).rglob("*.js")
    if path.name != "core.js"  # wasm-bindgen writes it
)

_QUESTION = re.compile(r"(What|Whether|Which|Who|Whose|How|Where|When|Why)\b")
_COMMENT = re.compile(r"\s*(//[/!]|#:) ?(.*)")
_COMMENT_OF_SCRIPT = re.compile(r"\s*(//|/\*\*?) ?(.*)")
_HEADINGS = re.compile(r"(Parameters|Attributes|Returns|Yields|Raises|Warns)\n-+\n")


def first_words(module: str) -> Iterator[tuple[str, str]]:
    """Yield name and docstring of a module, and of its classes and functions, nested ones too."""
    for node in ast.walk(ast.parse(module)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield getattr(node, "name", "the module"), ast.get_docstring(node) or ""


@pytest.mark.parametrize("module", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_docstrings_say_what_things_do(module: Path) -> None:
    found = first_words(module.read_text(encoding="utf-8"))
    assert [name for name, text in found if _QUESTION.match(text)] == []


def descriptions(docstring: str) -> Iterator[str]:
    """Yield the first line of each description in the sections of a docstring."""
    for section in _HEADINGS.split(docstring)[2::2]:
        before = ""
        for line in section.split("\n\n")[0].splitlines():
            if line.startswith(" ") and not before.startswith(" "):
                yield line.strip()
            before = line


def test_descriptions_of_parameters_say_what_things_are() -> None:
    texts = {path: first_words(path.read_text(encoding="utf-8")) for path in MODULES}
    found = [
        (str(path.relative_to(ROOT)), name, line)
        for path, named in texts.items()
        for name, text in named
        for line in descriptions(text)
    ]
    assert len(found) > 1000
    assert [each for each in found if _QUESTION.match(each[2])] == []


def comments(source: str, comment: re.Pattern[str] = _COMMENT) -> Iterator[str]:
    """Yield the first line of each doc comment of a source in Rust, in Python or in JavaScript."""
    before = ""
    for line in source.splitlines():
        found = comment.match(line)
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


def test_comments_of_scripts_say_what_things_are() -> None:
    read = ((p, comments(p.read_text(encoding="utf-8"), _COMMENT_OF_SCRIPT)) for p in SCRIPTS)
    found = [(path.name, line) for path, lines in read for line in lines if _QUESTION.match(line)]
    assert len(SCRIPTS) > 25 and found == []


def test_a_question_about_a_parameter_is_noticed() -> None:
    text = """Cut it.

Parameters
----------
deep : bool
    Whether to cut what lies below,
    which takes long.
far : float
    The distance.

Returns
-------
int
    How many were cut.

Notes
-----
Where nothing is, nothing is cut.
"""
    assert list(descriptions(text)) == [
        "Whether to cut what lies below,",
        "The distance.",
        "How many were cut.",
    ]
    assert list(
        comments("/** How far. */\n// Near,\n// which is not far.", _COMMENT_OF_SCRIPT)
    ) == [
        "How far. */",
        "Near,",
    ]


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
