"""Scripts are accepted by every command that takes meshes."""

import json
from pathlib import Path

import pytest

import bspcsg as b
from support.cli import Capture, ran

#: A plate with a square hole, of volume 48, and a ball of Python that stands on it.
PLATE = """difference() {
  cube([4, 4, 4]);
  multmatrix([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, -1], [0, 0, 0, 1]]) cube([2, 2, 9]);
}
"""
BALL = "import bspcsg as b\nresult = b.box(2, 2, 1).translate(1, 1, 2)\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("plate.csg").write_text(PLATE)
    Path("plug.py").write_text(BALL)
    return tmp_path


# Found: scripts were refused by most verbs.
@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("line", "volume"),
    [
        ("union plate.csg plug.py -o x.ply", 52),
        ("difference plate.csg plug.py -o x.ply", 48),
        ("hull plate.csg plug.py -o x.ply", 64),
        ("convert plate.csg -o x.ply", 48),
        ("convert plate.csg -o x.ply --unit cm", 48_000),
        ("union plug.py plug.py -o x.ply --unit cm", 4_000),
        ("repair plate.csg -o x.ply", 48),
        ("simplify plug.py -o x.ply --tolerance 0.001mm", 4),
    ],
)
def test_scripts_become_meshes(folder: Path, capsys: Capture, line: str, volume: float) -> None:
    code, _, err = ran(capsys, *line.split())
    assert code == 0, err
    assert b.load("x.ply").volume_exact == volume


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "line",
    [
        "check plate.csg",
        "info plate.csg plug.py",
        "compare plate.csg plate.csg",
        "slice plate.csg --z 1 -o x.svg",
        "project plug.py -o x.svg",
        "split plate.csg --plane 0,0,1,2 -o x-%.ply",
        "split plate.csg -o x-%.ply",
        "clash plate.csg plug.py",
        "render plug.py -o x.svg",
        "view plate.csg -o x.html",
    ],
)
def test_scripts_are_looked_at(folder: Path, capsys: Capture, line: str) -> None:
    code, out, err = ran(capsys, *line.split())
    assert code == 0 and "error" not in err and out


def test_what_a_script_leaves_out_is_told(folder: Path, capsys: Capture) -> None:
    Path("odd.csg").write_text('cube(1); import("none.stl");')
    code, out, err = ran(capsys, "info", "odd.csg", "--json")
    assert code == 0 and "none.stl" in err and json.loads(out)["files"][0]["triangles"] == 12


def test_what_a_script_leaves_out_is_told_though_it_is_refused(
    folder: Path, capsys: Capture
) -> None:
    Path("mixed.csg").write_text("union() { square(size = [1, 1]); cube(size = [1, 1, 1]); }")
    code, _, err = ran(capsys, "run", "mixed.csg", "-o", "x.stl")
    assert code == 3 and "the model is two-dimensional" in err
    assert "the 3D children are ignored" in err


def test_scripts_that_fail_name_their_place(folder: Path, capsys: Capture) -> None:
    Path("bad.csg").write_text("cube(;")
    code, _, err = ran(capsys, "union", "plate.csg", "bad.csg", "-o", "x.ply")
    assert code == 3 and "bad.csg:1:6: expected" in err
    assert ran(capsys, "union", "plate.csg", "none.py", "-o", "x.ply")[0] == 3
