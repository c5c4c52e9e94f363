"""The table of the lecture names functions, tests and pictures that are there."""

import re
from functools import reduce
from pathlib import Path

import pytest

from bspcsg import bsp

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "lecture.md").read_text(encoding="utf-8")
TEMPLATES = ROOT / "bspcsg" / "report" / "templates" / "lecture"
ROWS = [
    [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
    for line in PAGE.partition("## The systems")[0].splitlines()
    if line.startswith("| ") and not line.startswith(("| notes", "| ---"))
]
FIGURES = {
    name
    for path in TEMPLATES.glob("*.html")
    for name in re.findall(r'figure\("(fig-\w+)"', path.read_text(encoding="utf-8"))
}


def _quoted(cell: str) -> str:
    found = re.fullmatch(r"`([^`]+)`", cell)
    assert found is not None, cell
    return found[1]


def test_no_cell_is_empty() -> None:
    assert len(ROWS) > 40
    assert all(len(row) == 4 and all(row) for row in ROWS)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row[0])
def test_names_are_there(row: list[str]) -> None:
    _, function, test, picture = row
    assert reduce(getattr, _quoted(function).split("."), bsp) is not None
    path, *names = _quoted(test).split("::")
    text = (ROOT / path).read_text(encoding="utf-8")
    assert all(re.search(rf"^ *(?:class|def|fn) {name}\b", text, re.M) for name in names)
    shown = _quoted(picture)
    assert shown in FIGURES or (ROOT / "examples" / shown).is_file()


def test_every_figure_of_the_page_belongs_to_a_line() -> None:
    assert {_quoted(row[3]) for row in ROWS} >= FIGURES
