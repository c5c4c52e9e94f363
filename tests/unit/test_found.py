"""The table of what hard looks have found names tests that are there."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "tests" / "found.md").read_text(encoding="utf-8")
ROWS = [
    [cell.strip() for cell in line.split("|")[1:-1]]
    for line in PAGE.splitlines()
    if line.startswith("| ") and not line.startswith(("| |", "| ---"))
]


def is_there(test: str) -> bool:
    """Return whether a file has a test of this name, which is not always skipped."""
    path, _, name = test.partition("::")
    if not (ROOT / path).is_file():
        return False
    text = (ROOT / path).read_text(encoding="utf-8")
    defined = re.search(rf"^((?: *@.*\n)*) *def {name}\(", text, re.M)
    if path.endswith(".rs"):
        return re.search(rf"#\[test\]\n(?:\s*#.*\n)*\s*fn {name}\(", text) is not None
    return defined is not None and "mark.skip(" not in defined[1]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row[0]} {row[1]}")
def test_what_was_found_has_tests(row: list[str]) -> None:
    who, what, tests = row
    assert re.match(r"(R|U|L|C\d*|H|later)\b", who) and what
    named = re.findall(r"`([^`]+\.(?:py|rs)::\w+)`", tests)
    assert bool(named) != tests.startswith("—: ")
    assert [test for test in named if not is_there(test)] == []


def test_everything_that_was_found_is_in_the_table() -> None:
    known = [f"R A{k}" for k in range(1, 14)] + [f"L {k}" for k in range(1, 8)]
    known += [f"C{k}" for k in range(1, 11)] + ["R B", "U", "L", "C", "H"]
    told = {name.strip() for who, *_ in ROWS for name in who.split(",")}
    assert set(known) <= told


def test_a_missing_test_is_noticed() -> None:
    assert not is_there("tests/unit/test_found.py::test_that_nobody_wrote")
    assert not is_there("tests/unit/test_nobody_wrote.py::test_at_all")
    assert not is_there("core/tests/crowds.rs::any_terms")
    assert is_there("core/tests/crowds.rs::an_expression_is_what_its_two_parts_make")
