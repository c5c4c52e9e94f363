"""The command eval: formulas over files."""

from fractions import Fraction
from pathlib import Path

import pytest

import bspcsg as b
from support.cli import Capture, put, ran
from support.shapes import cube, cuboid, moved

VOLUMES = {
    "a.off | c.stl": 15,
    "a.off + c.stl": 15,
    "a.off & c.stl": 1,
    "a.off - c.stl": 7,
    "a.off ^ c.stl": 14,
    "(a.off - c.stl) | c.stl": 15,
    "a.off - (a.off - c.stl)": 1,
    "~(~a.off | ~c.stl)": 1,
    "a.off & ~c.stl": 7,
    "a.off": 8,
}


@pytest.mark.parametrize("formula", VOLUMES)
def test_formulas(folder: Path, capsys: Capture, formula: str) -> None:
    code, out, _ = ran(capsys, "eval", formula, "-o", "x.ply")
    assert code == 0 and b.load("x.ply").volume_exact == VOLUMES[formula]
    assert ("check: agree" in out) == (formula != "a.off")


def test_names_with_blanks_and_signs(folder: Path, capsys: Capture) -> None:
    put("the hole.off", cuboid((0, 0, 0), (1, 1, 0.5)))
    put("knob-2.off", moved(cube(), (9, 0, 0)))
    formula = "(a.off - 'the hole.off') | knob-2.off"
    assert ran(capsys, "eval", formula, "-o", "x.ply")[0] == 0
    assert b.load("x.ply").volume_exact == 8 - Fraction(1, 2) + 1


def test_errors_point_at_the_column(folder: Path, capsys: Capture) -> None:
    code, out, err = ran(capsys, "eval", "(a.off - ) | c.stl", "-o", "x.ply")
    assert (code, out) == (2, "")
    assert err == (
        "bspcsg: error: formula:10: expected a file name or “(”, found “)”.\n"
        "  (a.off - ) | c.stl\n"
        "           ^\n"
        "  Try: bspcsg eval --help\n"
    )


def test_a_sign_taken_for_a_part_of_the_name(folder: Path, capsys: Capture) -> None:
    code, _, err = ran(capsys, "eval", "c.stl | a.off-c.stl", "-o", "x.ply")
    assert code == 3 and "a.off-c.stl: cannot read" in err and "blanks around" in err
    assert err.endswith("  c.stl | a.off-c.stl\n          ^\n")


@pytest.mark.parametrize(
    ("formula", "code", "words"),
    [
        ("~a.off", 4, "unbounded"),
        ("a.off - a.off", 4, "--allow-empty"),
        ("a.off | none.stl", 3, "none.stl: cannot read"),
        ("a.off | x.step", 3, "STEP"),
        ("a.off | nosuffix", 3, "there is no such file or folder"),
        ("", 2, "is empty"),
    ],
)
def test_refusals(folder: Path, capsys: Capture, formula: str, code: int, words: str) -> None:
    found, out, err = ran(capsys, "eval", formula, "-o", "x.ply")
    assert (found, out) == (code, "") and words in err and not Path("x.ply").exists()
