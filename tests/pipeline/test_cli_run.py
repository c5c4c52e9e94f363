"""The command run: scripts at the command line."""

import json
import os
import shutil
from pathlib import Path

import pytest

import bspcsg as b
from support.cli import Capture, finished, ran

MOVED = "multmatrix([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, -1], [0, 0, 0, 1]])"
PLATE = f"difference() {{ cube([4, 3, 1]); {MOVED} cube([1, 1, 3]); }}"
PYTHON = "import bspcsg as b\nprint('made')\nresult = b.cube((4, 3, 1))\n"
OPEN = """cube(1);
polyhedron(points = [[5,0,0],[6,0,0],[5,1,0],[5,0,1]], faces = [[0,1,2],[0,3,1],[0,2,3]]);
"""


def test_csg(folder: Path, capsys: Capture) -> None:
    Path("plate.csg").write_text(PLATE)
    code, out, err = ran(capsys, "run", "plate.csg", "-o", "x.ply")
    assert (code, err) == (0, "") and b.load("x.ply").volume_exact == 11
    assert "volume 11" in out and "check: agree" in out


def test_csg_as_json(folder: Path, capsys: Capture) -> None:
    Path("plate.csg").write_text(PLATE)
    code, out, _ = ran(capsys, "run", "plate.csg", "-o", "x.ply", "--json")
    found = json.loads(out)
    assert code == 0 and found["operation"] == "run" and found["files"] == ["plate.csg"]
    assert found["volume_exact"] == "11" and found["genus"] == 1 and found["check"] is not None


def test_polish_says_how_far_corners_moved(folder: Path, capsys: Capture) -> None:
    matrix = "[[0.866025, -0.5, 0, {}], [0.5, 0.866025, 0, {}], [0, 0, 1, 0], [0, 0, 0, 1]]"
    text = f"multmatrix({matrix.format(0, 0)}) cube([30, 10, 10]);"
    Path("one.csg").write_text(text)
    Path("two.csg").write_text(f"{text} multmatrix({matrix.format(25.9808, 15)}) cube(10);")
    said = "polish: corners moved by 6.6e-05 at most, to a lattice of step 1e-04"
    for name, pitch, note in [("one", -9, "polish: no corners had to move"), ("two", -4, said)]:
        options = "run", f"{name}.csg", "-o", "x.ply", "--json"
        code, out, err = ran(capsys, *options, "--polish")
        assert code == 0 and json.loads(out)["pitch"] == pitch and err == f"note: {note}\n"
        code, out, err = ran(capsys, *options)
        assert code == 0 and json.loads(out)["pitch"] == -9 and err == ""


@pytest.mark.skipif(shutil.which("openscad") is None, reason="needs openscad")
def test_scad(folder: Path, capsys: Capture) -> None:
    Path("plate.scad").write_text(f"module plate() {PLATE}\nplate();")
    assert ran(capsys, "run", "plate.scad", "-o", "x.3mf")[0] == 0
    assert b.load("x.3mf").volume_exact == 11


# Found: a word that begins with a letter outside ASCII was refused.
@pytest.mark.parametrize("word", ["ab", "ä", "Ärger", "é1", "größe", "a\u0308rger", "日本", "x-y"])
def test_a_word_alone_is_a_text(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch, word: str
) -> None:
    Path("openscad").write_text('#!/bin/sh\necho "// $4" > "$3"\necho "cube(2);" >> "$3"\n'
                                'echo "$4" > asked\n')  # fmt: skip
    Path("openscad").chmod(0o755)
    monkeypatch.setenv("PATH", os.pathsep.join([str(folder), os.environ["PATH"]]))
    Path("part.scad").write_text('word = "x"; cube(2);')
    code, _, err = ran(capsys, "run", "part.scad", "-o", "x.ply", "-D", f"word={word}")
    assert (code, err) == (0, "")
    assert Path("asked").read_text("utf-8").strip() == f'-Dword="{word}"'


@pytest.mark.parametrize("text", ["-", "1a", "a b", "ä+b", "", "(ä)", "\u0308a"])
def test_an_expression_is_no_word(folder: Path, capsys: Capture, text: str) -> None:
    Path("part.scad").write_text("cube(2);")
    code, _, err = ran(capsys, "run", "part.scad", "-o", "x.ply", "-D", f"word={text}")
    assert code == 2 and "is not a value" in err


def test_openscad_that_is_missing_is_code_6(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("plate.scad").write_text(PLATE)
    monkeypatch.setenv("PATH", "")
    code, _, err = ran(capsys, "run", "plate.scad", "-o", "x.ply")
    assert code == 6 and "apt install openscad" in err and not Path("x.ply").exists()


def test_python_keeps_standard_output_free(folder: Path) -> None:
    Path("part.py").write_text(PYTHON)
    code, out, err = finished("run", "part.py", "-o", "x.off", "--json")
    assert code == 0 and json.loads(out)["volume_exact"] == "12" and b"made" in err
    assert b.load("x.off").volume_exact == 12


FORGED = """import bspcsg as b
from bspcsg.solid.leaf import TreeLeaf
result = b.cube(2) - b.cube(1).translate(1, 1, 1)
assert result.volume == 7
result._node.content = TreeLeaf(b.cube(2).tree, result._node.content.record)
"""


# Found: `--check` did nothing for Python scripts.
@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "result",
    [
        "b.cube(3) - b.cube(1)",
        "(b.cube(3) - b.cube(1)).translate(1, 2, 3).rotate(30)",
        "b.cube(3) - b.half_space((1, 1, 1), 2)",
        "b.intersection(b.cube(3) ^ b.half_space((1, 1, 1), 2),"
        " *(~b.half_space(n, -1) for n in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))).rotate(30)",
        "[b.cube(1), b.sphere(2)]",
    ],
)
def test_python_results_are_checked(folder: Path, capsys: Capture, result: str) -> None:
    Path("part.py").write_text(f"import bspcsg as b\nresult = {result}\n")
    code, out, _ = ran(capsys, "run", "part.py", "-o", "x.off")
    assert code == 0 and "check: agree" in out
    code, out, _ = ran(capsys, "run", "part.py", "-o", "x.off", "--no-check")
    assert code == 0 and "check" not in out


def test_wrong_python_results_are_found(folder: Path, capsys: Capture) -> None:
    Path("part.py").write_text(FORGED)
    code, out, _ = ran(capsys, "run", "part.py", "-o", "x.off")
    assert code == 1 and "check: DISAGREE" in out
    assert ran(capsys, "run", "part.py", "-o", "x.off", "--no-check")[0] == 0


def test_results_of_no_operation_are_not_called_checked(folder: Path, capsys: Capture) -> None:
    Path("part.py").write_text("import bspcsg as b\nresult = b.cube(1)\n")
    for arguments in ["run", "part.py"], ["eval", "a.off"]:
        code, out, _ = ran(capsys, *arguments, "-o", "x.off")
        assert code == 0 and "check: nothing to compare, for no operation made the result" in out
        assert json.loads(ran(capsys, *arguments, "-o", "x.off", "--json")[1])["check"] is None


def test_what_is_left_out_is_told(folder: Path, capsys: Capture) -> None:
    Path("open.csg").write_text(OPEN)
    code, _, err = ran(capsys, "run", "open.csg", "-o", "x.off")
    assert code == 4 and "open.csg:2:1: polyhedron()" in err and not Path("x.off").exists()
    code, _, err = ran(capsys, "run", "open.csg", "-o", "x.off", "--on-invalid", "warn", "--polish")
    assert code == 0 and err.count("warning: open.csg:2:1: polyhedron()") == 1
    assert b.load("x.off").volume_exact == 1


DRAWING = """<svg xmlns="http://www.w3.org/2000/svg">
<rect width="72" height="72"/><text>A</text></svg>"""


def test_what_drawings_lack_is_told(folder: Path, capsys: Capture) -> None:
    Path("a.svg").write_text(DRAWING)
    Path("a.csg").write_text('linear_extrude(height = 1) import(file = "a.svg");')
    code, _, err = ran(capsys, "run", "a.csg", "-o", "x.off")
    assert code == 0 and "warning: a.csg:1:28: import(): a.svg: left out: text (1)." in err
    assert "left out" not in ran(capsys, "run", "a.csg", "-o", "x.off", "-q")[2]
    Path("a.py").write_text('import bspcsg as b\nresult = b.Region.from_svg("a.svg").extrude(1)\n')
    code, _, said = finished("run", "a.py", "-o", "x.off")
    assert code == 0 and b"DrawingWarning: a.svg: left out: text (1)." in said


def test_scripts_read_no_other_folders_unless_allowed(folder: Path, capsys: Capture) -> None:
    Path("own").mkdir()
    Path("other").mkdir()
    Path("other/table.dat").write_text("1 1\n1 1\n")
    Path("own/x.csg").write_text('surface(file = "../other/table.dat");')
    code, _, err = ran(capsys, "run", "own/x.csg", "-o", "x.off")
    assert code == 3 and "own/x.csg:1:1: surface()" in err and "--allow-path" in err
    options = ("--allow-path", "own", "--allow-path", "other")
    assert ran(capsys, "run", "own/x.csg", "-o", "x.off", *options)[0] == 0
    assert b.load("x.off").volume == 1


def test_time_limits_are_code_124(folder: Path, capsys: Capture) -> None:
    Path("slow.py").write_text("import time\ntime.sleep(60)\n")
    code, _, err = ran(capsys, "run", "slow.py", "-o", "x.off", "--timeout", "0.5")
    assert code == 124 and "time limit of 0.5 seconds" in err


def test_nothing_is_refused_unless_allowed(folder: Path, capsys: Capture) -> None:
    Path("none.csg").write_text("difference() { cube(1); cube(2); }")
    code, _, err = ran(capsys, "run", "none.csg", "-o", "x.off")
    assert code == 4 and "--allow-empty" in err and not Path("x.off").exists()
    assert ran(capsys, "run", "none.csg", "-o", "x.off", "--allow-empty")[0] == 0


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["none.csg", "-o", "x.off"], 3, "none.csg: cannot read"),
        (["none.scad", "-o", "x.off"], 3, "none.scad: cannot read"),
        (["none.py", "-o", "x.off"], 3, "none.py: cannot read"),
        (["a.off", "-o", "x.off"], 3, "the file is not a script"),
        (["bad.csg", "-o", "x.off"], 3, "bad.csg:1:"),
        (["flat.csg", "-o", "x.off"], 3, "linear_extrude"),
        (["bad.py", "-o", "x.off"], 3, "bad.py:2: ZeroDivisionError"),
        (["bad.csg", "-o", "x.step"], 3, "curved surfaces"),
        (["bad.csg", "-o", "no/x.off"], 5, "does not exist or is not writable"),
        (["bad.py", "-o", "x.off", "--polish"], 2, "--polish cannot be used with .py"),
        (["bad.py", "-o", "x.off", "--allow-path", "."], 2, "--allow-path cannot be used with .py"),
        (["bad.csg", "-o", "x.off", "--allow-path", "no"], 2, "'no' does not exist"),
        (["bad.csg", "-o", "x.off", "--timeout", "1"], 2, "--timeout cannot be used with .csg"),
        (["bad.csg", "-o", "x.off", "--timeout", "0"], 2, "--timeout"),
    ],
)
def test_refusals(
    folder: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
    Path("bad.csg").write_text("cube(")
    Path("flat.csg").write_text("square(1);")
    Path("bad.py").write_text("x = 1\n1 / 0\n")
    before = sorted(os.listdir())
    found, out, err = ran(capsys, "run", *arguments)
    assert (found, out) == (code, "") and words in err
    assert sorted(os.listdir()) == before


def test_lenient_leaves_out_what_cannot_be_made(folder: Path, capsys: Capture) -> None:
    Path("bad.csg").write_text(f'{OPEN}tent();\nimport("none.stl");\n')
    code, _, err = ran(capsys, "run", "bad.csg", "-o", "x.ply")
    assert code == 4 and "bad.csg:2:1: polyhedron()" in err
    code, _, err = ran(capsys, "run", "bad.csg", "-o", "x.ply", "--lenient")
    assert code == 0 and b.load("x.ply").volume == 1
    for place in ("bad.csg:2:1: polyhedron()", "bad.csg:3:1: tent()", "bad.csg:4:1: import()"):
        assert place in err, err
    assert err.count("is left out") == 3
    Path("a.py").write_text(PYTHON)
    assert ran(capsys, "run", "a.py", "-o", "x.ply", "--lenient")[0] == 2
