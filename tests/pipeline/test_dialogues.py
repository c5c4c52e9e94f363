"""The exact messages of the command line in the situations that users meet first."""

import io
import json
import sys
from pathlib import Path

import numpy as np
import pytest

from bspcsg.cli.main import run
from bspcsg.io import read
from support.cli import Capture, put, ran
from support.shapes import cuboid, flipped, icosphere, joined


@pytest.fixture(autouse=True)
def files(folder: Path) -> None:
    """Add an open mesh to the two valid files."""
    del folder
    vertices, faces = cuboid((0, 0, 0), (2, 2, 2))
    put("open.stl", (vertices, faces[1:]))


#: Commands, exit codes, and what appears on standard error, in order.
ERRORS = [
    (["unoin"], 2, "there is no command 'unoin'. Is union meant?\n  Try: bspcsg --help"),
    (["diff"], 2, "there is no command 'diff'. Is difference meant?\n  Try: bspcsg --help"),
    (["subtract"], 2, "there is no command 'subtract'. Is difference meant?\n  Try: bspcsg --help"),
    (["add"], 2, "there is no command 'add'. Is union meant?\n  Try: bspcsg --help"),
    (
        ["intersect"],
        2,
        "there is no command 'intersect'. Is intersection meant?\n  Try: bspcsg --help",
    ),
    (["boolean"], 2, "there is no command 'boolean'.\n  Try: bspcsg --help"),
    (
        ["union", "a.off", "-o", "x.ply"],
        2,
        "union needs at least two files.\n  Try: bspcsg union --help",
    ),
    (
        ["union", "a.off", "c.stl"],
        2,
        "Missing option '-o' / '--output'.\n  Try: bspcsg union --help",
    ),
    (
        ["eval", "a.off -", "-o", "x.ply"],
        2,
        "formula:8: expected a file name or “(”, found the end.\n  a.off -\n         ^\n"
        "  Try: bspcsg eval --help",
    ),
    (["eval", " ", "-o", "x.ply"], 2, "formula:1: the formula is empty;"),
    (
        ["union", "none.stl", "a.off", "-o", "x.ply"],
        3,
        "none.stl: cannot read this file: No such file or directory.",
    ),
    (
        ["slice", ".", "--z", "1", "-o", "x.svg"],
        3,
        ".: this is a folder, and a file is needed; name the files in it, as in *.stl.",
    ),
    (
        ["convert", "big.step", "-o", "out.stl"],
        3,
        "big.step: STEP files contain curved surfaces, and bspcsg reads triangle meshes only."
        " Convert the file to a mesh first, for example with FreeCAD, Gmsh or the Python package"
        " cascadio.",
    ),
    (
        ["union", "a.off", "open.stl", "-o", "x.ply"],
        4,
        "open.stl: the mesh is not closed: 3 edges have no matching opposite; the first belongs to"
        " face 0 and runs from ",
    ),
    (
        ["difference", "a.off", "a.off", "-o", "x.ply"],
        4,
        "x.ply: the result is empty, so nothing was written; --allow-empty writes an empty file.",
    ),
    (
        ["eval", "~a.off", "-o", "x.ply"],
        4,
        "the solid is unbounded and has no mesh; intersect it with a box first.",
    ),
    (
        ["union", "a.off", "c.stl", "-o", "no/x.ply"],
        5,
        "no/x.ply: the folder no does not exist or is not writable.",
    ),
]


@pytest.mark.parametrize(("arguments", "code", "said"), ERRORS)
def test_errors(capsys: Capture, arguments: list[str], code: int, said: str) -> None:
    found, out, err = ran(capsys, *arguments)
    assert (found, out) == (code, "")
    assert err.startswith(f"bspcsg: error: {said}"), err


def test_an_open_file_gets_a_line_to_type(capsys: Capture) -> None:
    _, _, err = ran(capsys, "union", "a.off", "open.stl", "-o", "x.ply")
    command = err.splitlines()[1].removeprefix("  Try: bspcsg ")
    assert command == "repair open.stl -o open-fixed.stl"
    assert ran(capsys, *command.split())[0] == 0
    assert ran(capsys, "union", "a.off", "open-fixed.stl", "-o", "x.ply")[0] == 0


@pytest.mark.parametrize(
    ("script", "said"),
    [
        (
            "union() {\n  minkowsky() { cube(1); } }",
            "m.csg:2:3: minkowsky() is not supported. Supported: circle color cube ",
        ),
        (
            "linear_extrude(height = 2)\n  text(a);",
            "m.csg:2:9: expected “=” after a, found “)”.\n",
        ),
        ("cube(1", "m.csg:1:7: expected “,” or “)”, found the end of the file."),
        ("cube(size = [1, 2]);", "m.csg:1:1: cube(): size must be 3 numbers"),
        ("import(file = 3);", "m.csg:1:1: import(): file must be a string, not 3."),
    ],
)
def test_scripts_name_line_and_column(capsys: Capture, script: str, said: str) -> None:
    Path("m.csg").write_text(script)
    code, out, err = ran(capsys, "run", "m.csg", "-o", "x.ply")
    assert (code, out) == (3, "")
    assert err.startswith(f"bspcsg: error: {said}"), err


def test_a_result_in_one_line(capsys: Capture) -> None:
    code, out, err = ran(capsys, "difference", "a.off", "c.stl", "-o", "x.ply", "--no-check")
    assert (code, err) == (0, "")
    # The whole line but for the time.
    assert out[: out.rindex("  ")] == ("x.ply  24 triangles  1 surface  genus 0  volume 7  closed")
    assert out.endswith(" s\n")


def test_a_missing_unit_is_told_where_the_output_states_one(capsys: Capture) -> None:
    note = "note: a.off and 1 more have no length unit, so mm is assumed; --unit in changes it\n"
    assert ran(capsys, "union", "a.off", "c.stl", "-o", "x.3mf", "-j", "1")[2] == note
    assert ran(capsys, "union", "a.off", "c.stl", "-o", "x.3mf", "--unit", "mm")[2] == ""
    assert ran(capsys, "union", "a.off", "c.stl", "-o", "x.3mf", "-q")[2] == ""
    assert ran(capsys, "union", "x.3mf", "x.3mf", "-o", "y.3mf")[2] == ""
    assert "unit" not in ran(capsys, "union", "a.off", "c.stl", "-o", "x.ply")[2]


def test_check_of_several_files(capsys: Capture) -> None:
    code, out, err = ran(capsys, "check", "a.off", "open.stl")
    assert (code, err) == (1, "")
    lines = out.splitlines()
    assert lines[0].split() == [
        "file",
        "triangles",
        "closed",
        "oriented",
        "manifold",
        "overlaps",
        "verdict",
    ]
    assert lines[2].split() == ["a.off", "12", "yes", "yes", "yes", "no", "solid"]
    assert lines[3].split() == ["open.stl", "11", "no", "yes", "yes", "—", "not", "closed"]
    assert any(
        "3 edges with only one triangle (open edges), around 1 hole" in line for line in lines
    )
    assert lines[-1] == "1 of 2 files is not a solid."


def test_advice_at_a_terminal(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    _, out, _ = ran(capsys, "check", "open.stl")
    assert "  Try: bspcsg repair open.stl -o open-fixed.stl\n" in out


def test_progress_at_a_terminal_only(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    for number in range(12):
        put(f"p{number}.off", cuboid((0, 0, 0), (1, 1, 1)))
    names = [f"p{number}.off" for number in range(12)]
    line = ["convert", *names, "--to", "stl", "--outdir", "."]
    assert "converting" not in ran(capsys, *line)[2]
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert "converting" in ran(capsys, *line)[2]
    assert "converting" not in ran(capsys, *line, "-q")[2]


def test_no_mesh_on_a_terminal(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    code, out, err = ran(capsys, "convert", "a.off", "-o", "-", "--to", "stl")
    assert (code, out) == (2, "") and "mesh data is not written to a terminal; redirect" in err


@pytest.mark.parametrize("verb", ["info", "check"])
def test_json_is_all_there_is_on_standard_output(capsys: Capture, verb: str) -> None:
    code, out, _ = ran(capsys, verb, "a.off", "none.stl", "open.stl", "--json")
    document = json.loads(out)
    assert code == 3 and document["schema"] == 1
    assert [entry["file"] for entry in document["files"]] == ["a.off", "none.stl", "open.stl"]
    assert document["files"][1]["error"]["code"] == "unreadable"


@pytest.mark.parametrize("verb", ["union", "eval", "convert", "compare", "slice", "render", "run"])
def test_json_of_errors(capsys: Capture, verb: str) -> None:
    lines = {
        "union": ["none.stl", "a.off", "-o", "x.ply"],
        "eval": ["none.stl", "-o", "x.ply"],
        "convert": ["none.stl", "-o", "x.ply"],
        "compare": ["none.stl", "a.off"],
        "slice": ["none.stl", "--z", "1", "-o", "x.svg"],
        "render": ["none.stl", "-o", "x.svg"],
        "run": ["none.csg", "-o", "x.ply"],
    }
    code, out, err = ran(capsys, verb, *lines[verb], "--json")
    said = json.loads(out)
    assert code == said["exit"] == 3 and said["error"]["code"] == "unreadable"
    assert said["error"]["message"] in err


def test_warnings_do_not_fail(capsys: Capture) -> None:
    put("two.ply", flipped(icosphere(1)))
    code, _, err = ran(capsys, "union", "two.ply", "a.off", "-o", "x.ply")
    assert code == 0 and err.startswith("warning: two.ply: ")
    assert ran(capsys, "union", "two.ply", "a.off", "-o", "x.ply", "-q")[2] == ""


def test_a_note_names_the_places_and_is_told_once(capsys: Capture) -> None:
    put("touching.off", joined(cuboid((0, 0, 0), (1, 1, 1)), cuboid((1, 1, 0), (2, 2, 1))))
    vertices, faces = read("touching.off").vertices, read("touching.off").faces
    shared, indices = np.unique(vertices, axis=0, return_inverse=True)
    put("touching.off", (shared, indices.ravel()[faces]))
    _, _, err = ran(capsys, "union", "touching.off", "a.off", "-o", "x.ply")
    notes = [line for line in err.splitlines() if "share an edge" in line]
    assert len(notes) == 1
    named = notes[0].rpartition(": ")[2].split(", ")
    assert shared[[int(number) for number in named]][:, :2].tolist() == [[1, 1]] * len(named)


def test_what_holds_for_a_format_is_told_once(capsys: Capture) -> None:
    _, _, err = ran(capsys, "convert", "a.off", "c.stl", "--to", "glb", "--outdir", ".")
    assert err.count("GLB uses metres") == 1


def test_an_error_after_json_was_asked_for_wrongly(capsys: Capture) -> None:
    code, out, err = ran(capsys, "union", "--json")
    assert code == 2 and err.startswith("bspcsg: error: Missing argument")
    said = json.loads(out)
    assert (said["exit"], said["error"]["code"]) == (2, "usage")
    assert said["error"]["message"] in err


def test_a_stream_that_is_no_mesh(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    class Stream:
        buffer = io.BytesIO(b"<html>")

    monkeypatch.setattr(sys, "stdin", Stream())
    assert run(["info", "-", "--from", "stl"]) == 3
    said = capsys.readouterr()
    assert said.out == "" and said.err.startswith(
        "bspcsg: error: -: at byte 6: the file is not an STL"
    )
