"""Docstrings say what a thing does or is, in the active voice: no question words at the start."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MODULES = sorted((ROOT / "bspcsg").rglob("*.py"))

_QUESTION = re.compile(r"(What|Whether|Which|Who|Whose|How|Where|When|Why)\b")


def first_words(module: str) -> Iterator[tuple[str, str]]:
    """Yield name and docstring of each class and function, nested ones too."""
    for node in ast.walk(ast.parse(module)):
        if isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.name, ast.get_docstring(node) or ""


@pytest.mark.parametrize("module", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_docstrings_say_what_things_do(module: Path) -> None:
    found = first_words(module.read_text(encoding="utf-8"))
    assert [name for name, text in found if _QUESTION.match(text)] == []


def test_a_question_is_noticed() -> None:
    [(name, text)] = first_words('def f():\n    """Whether it holds."""\n')
    assert name == "f" and _QUESTION.match(text)
