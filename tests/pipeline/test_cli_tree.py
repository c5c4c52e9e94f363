"""The command tree: trees of scripts printed, simplified and converted."""

import io
import json
import shutil
import sys
from pathlib import Path

import pytest

from bspcsg import csg
from support.cli import Capture, ran

MOVED = "multmatrix([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, -1], [0, 0, 0, 1]])"
STILL = "multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])"
PLATE = f"""group() {{
  difference() {{ cube([4, 3, 1], center=false); {MOVED} {{ cube([1, 1, 3]); group(); }} }}
  {STILL} union() {{ %sphere(r = 3); group() cube(1); union() {{ cube(2); cube(3); }} }}
}}
"""
OUTLINE = """plate.csg
├─ difference()
│  ├─ cube([4, 3, 1], center = false)
│  └─ multmatrix([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, -1], [0, 0, 0, 1]])
│     └─ cube([1, 1, 3])
├─ cube(1)
├─ cube(2)
└─ cube(3)
"""


@pytest.fixture
def plate(folder: Path) -> Path:
    Path("plate.csg").write_text(PLATE)
    return folder


def test_an_outline_is_shown(plate: Path, capsys: Capture) -> None:
    code, out, err = ran(capsys, "tree", "plate.csg", "--simplify")
    assert (code, out, err) == (0, OUTLINE, "")
    full = ran(capsys, "tree", "plate.csg")[1]
    assert full.count("\n") == 15 and "%sphere(r = 3)" in full and "│     └─ group()" in full


def test_simplified_trees_are_of_the_same_solid(plate: Path, capsys: Capture) -> None:
    assert ran(capsys, "tree", "plate.csg", "--simplify", "-o", "less.csg")[0] == 0
    assert csg.load("less.csg").equals(csg.load("plate.csg"))
    again = ran(capsys, "tree", "less.csg", "--simplify", "--to", "csg")[1]
    assert again == Path("less.csg").read_text("utf-8")


@pytest.mark.parametrize("suffix", [".csg", ".json", ".scad"])
def test_conversions_keep_the_tree(plate: Path, capsys: Capture, suffix: str) -> None:
    code, out, _ = ran(capsys, "tree", "plate.csg", "-o", f"x{suffix}")
    assert (code, out) == (0, f"x{suffix}  14 nodes\n")
    text = Path(f"x{suffix}").read_text("utf-8")
    read = csg.from_json(text) if suffix == ".json" else csg.parse(text)
    assert read == csg.parse(PLATE)


def test_infinity_in_the_language_of_openscad(folder: Path, capsys: Capture) -> None:
    Path("odd.csg").write_text("cube(size = inf); sphere(-inf); cylinder(h = [nan]);")
    out = ran(capsys, "tree", "odd.csg", "--to", "scad")[1]
    assert out == "cube(size = 1 / 0);\nsphere(-1 / 0);\ncylinder(h = [0 / 0]);\n"
    assert ran(capsys, "tree", "odd.csg", "--to", "csg")[1].startswith("cube(size = inf);")


def test_graphs(plate: Path, capsys: Capture) -> None:
    Path("said.csg").write_text('difference() { cube(1); text("a\\"b\\n"); }')
    code, out, err = ran(capsys, "tree", "said.csg", "--to", "dot")
    assert code == 0 and "n0 -> n2;" in out and "n1 -> n2" not in out
    assert 'label="text(\\"a\\\\\\"b\\\\n\\")"' in out
    assert err == ""
    Path("odd.csg").write_text("import_dxf();")
    odd = ran(capsys, "tree", "odd.csg", "--to", "dot")[2]
    assert odd == "note: odd.csg: bspcsg run cannot evaluate import_dxf\n"


def test_json_tells_the_kinds(plate: Path, capsys: Capture) -> None:
    Path("more.csg").write_text(PLATE + "text(); minkowsky() cube(1);")
    code, out, _ = ran(capsys, "tree", "more.csg", "--json")
    found = json.loads(out)
    assert code == 0 and found["nodes"] == 17 and found["output"] is None
    assert found["kinds"]["cube"] == 6 and "minkowsky" in found["unsupported"]
    code, out, _ = ran(capsys, "tree", "more.csg", "--json", "-o", "x.txt")
    assert code == 0 and json.loads(out)["output"] == "x.txt" and Path("x.txt").is_file()


def test_streams(folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    def asked(data: bytes, *arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))
        return ran(capsys, "tree", "-", *arguments)

    code, out, err = asked(PLATE.encode(), "--to", "json")
    assert (code, err) == (0, "") and csg.from_json(out) == csg.parse(PLATE)
    code, text, _ = asked(out.encode(), "--from", "json", "-o", "-", "--to", "csg")
    assert code == 0 and csg.parse(text) == csg.parse(PLATE)
    code, _, err = asked(b"\xff")
    assert code == 3 and "byte 0 cannot be decoded" in err


# Found: `tree` sent escape sequences of a script to the terminal, and left colours out of what it
# wrote to a pipe.
def test_scripts_do_not_steer_the_terminal(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = 'text("\x1b[31mred\x1b]0;title\x07");\n'
    Path("red.csg").write_text(text)
    assert ran(capsys, "tree", "red.csg", "--to", "csg")[1] == text
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    out = ran(capsys, "tree", "red.csg", "--to", "csg")[1]
    assert out == 'text("\ufffd[31mred\ufffd]0;title\ufffd");\n'


@pytest.mark.skipif(shutil.which("openscad") is None, reason="needs openscad")
def test_the_language_of_openscad(folder: Path, capsys: Capture) -> None:
    Path("a.scad").write_text("for (k = [1, 2]) translate([k, 0, 0]) cube(k);")
    code, out, _ = ran(capsys, "tree", "a.scad", "--simplify", "--to", "scad", "--timeout", "60")
    assert code == 0 and out.count("cube(") == 2 and out.count("multmatrix(") == 2


def test_trees_of_any_depth(folder: Path, capsys: Capture) -> None:
    Path("deep.csg").write_text("difference() {" * 4_000 + "cube(1);" + "}" * 4_000)
    code, out, _ = ran(capsys, "tree", "deep.csg")
    lines = out.splitlines()
    assert code == 0 and lines[-1].endswith("└─ (4001) cube(1)") and len(lines[-1]) < 150
    assert ran(capsys, "tree", "deep.csg", "--simplify", "-o", "x.dot")[0] == 0
    code, _, err = ran(capsys, "tree", "deep.csg", "--to", "json")
    assert code == 3 and "deeper than 200 levels; write .csg" in err


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (
            ["a.off"],
            3,
            "the file is not a script with a tree; its name must end in one of .csg, .json, .scad",
        ),
        (["plate.csg", "-o", "x.stl"], 3, "must end in one of .csg, .json"),
        (["plate.csg", "-o", "no/x.csg"], 5, "does not exist or is not writable"),
        (["plate.csg", "--json", "--to", "csg"], 2, "cannot both go"),
        (["plate.csg", "--timeout", "3"], 2, "--timeout cannot be used with .csg"),
        (["none.csg"], 3, "none.csg: cannot read"),
        (["bad.csg"], 3, "bad.csg:1:6: expected"),
    ],
)
def test_wrong_use(
    plate: Path, capsys: Capture, arguments: list[str], code: int, said: str
) -> None:
    Path("bad.csg").write_text("cube(;")
    got, out, err = ran(capsys, "tree", *arguments)
    assert (got, "error" in out) == (code, "--json" in arguments) and said in err
