"""The command line as scripts use it: exit codes, streams, files, and no tracebacks."""

import json
import os
import signal
import subprocess
import time
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg.cli.main import _VERBS, run
from bspcsg.io import RawMesh, read, write
from bspcsg.operations.setops import OPERATIONS
from support.cli import Capture, process, put, ran
from support.shapes import Arrays, cube, cuboid, flipped, icosphere, joined, moved

VOLUMES = {"union": 15, "intersection": 1, "difference": 7, "xor": 14}


# Results


@pytest.mark.parametrize("op", VOLUMES)
@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "off"])
def test_operations(folder: Path, capsys: Capture, op: str, suffix: str) -> None:
    code, out, err = ran(capsys, op, "a.off", "c.stl", "-o", f"out.{suffix}")
    # The symmetric difference of the cubes touches itself, and a note says so.
    assert code == 0 and ("touches itself" in err) == (op == "xor")
    assert out.startswith(f"out.{suffix}  ") and "check: agree" in out
    assert b.load(f"out.{suffix}").volume_exact == VOLUMES[op]


def test_many_operands(folder: Path, capsys: Capture) -> None:
    put("d.ply", cuboid((2.5, 2.5, 2.5), (4, 4, 4)))
    assert ran(capsys, "difference", "c.stl", "a.off", "d.ply", "-o", "x.obj")[0] == 0
    assert b.load("x.obj").volume_exact == 8 - 1 - Fraction(1, 8)


def test_json_is_one_document(folder: Path, capsys: Capture) -> None:
    code, out, _ = ran(capsys, "xor", "a.off", "c.stl", "-o", "x.ply", "--json")
    found = json.loads(out)
    assert code == 0 and found["schema"] == 1
    assert (found["operation"], found["output"]) == ("xor", "x.ply")
    assert (found["volume"], found["volume_exact"]) == (14.0, "14")
    assert found["check"]["verdict"] == "agree"
    assert found["triangles"] == len(read("x.ply").faces)
    proof = found["certificate"]
    assert proof["ok"] and proof["triangles"] == found["triangles"]
    assert (proof["open_edges"], proof["crossings"], proof["flat"]) == (0, 0, 0)


@pytest.mark.parametrize(("depth", "compared"), [("quick", "measures"), ("full", "sets")])
def test_how_the_result_is_checked(
    folder: Path, capsys: Capture, depth: str, compared: str
) -> None:
    options = [f"--check={depth}", "--json"]
    code, out, _ = ran(capsys, "union", "a.off", "c.stl", "-o", "x.ply", *options)
    assert code == 0 and json.loads(out)["check"]["compared"] == compared
    code, _, err = ran(capsys, "union", "--check", "a.off", "c.stl", "-o", "x.ply")
    assert code == 2 and "'a.off' is not one of 'quick', 'full', 'off'" in err


def test_json_of_volumes_with_thousands_of_digits(folder: Path, capsys: Capture) -> None:
    put("ball.off", icosphere(4))
    put("other.off", moved(icosphere(4), (0.1, 0.2, 0.3)))
    _, out, _ = ran(capsys, "union", "ball.off", "other.off", "-o", "x.ply", "--json")
    found = json.loads(out)
    assert found["volume_exact"] is None and found["volume"] > 4


@pytest.mark.parametrize("flag", ["--no-validate", "--no-check"])
def test_results_are_not_validated_on_demand(folder: Path, capsys: Capture, flag: str) -> None:
    code, out, _ = ran(capsys, "union", "a.off", "c.stl", "-o", "x.ply", flag)
    assert code == 0 and "check" not in out
    code, out, _ = ran(capsys, "union", "a.off", "c.stl", "-o", "x.ply", flag, "--json")
    assert json.loads(out)["check"] is None


def test_winding_rules(folder: Path, capsys: Capture) -> None:
    put("twice.off", joined(cube(2), cuboid((0, 0, 0), (1, 2, 2))))
    put("far.off", moved(cube(), (9, 0, 0)))
    for rule, volume in (("positive", 9), ("nonzero", 9), ("even-odd", 5)):
        assert (
            ran(capsys, "union", "twice.off", "far.off", "-o", "x.ply", "--winding", rule)[0] == 0
        )
        assert b.load("x.ply").volume_exact == volume


def test_pitch_and_threads(folder: Path, capsys: Capture) -> None:
    options = ["--pitch", "-3", "--threads", "1", "--json"]
    code, out, _ = ran(capsys, "union", "a.off", "c.stl", "-o", "x.ply", *options)
    assert code == 0 and json.loads(out)["pitch"] == -3


def test_text_form(folder: Path, capsys: Capture) -> None:
    assert ran(capsys, "union", "a.off", "c.stl", "-o", "x.stl", "--ascii")[0] == 0
    assert Path("x.stl").read_bytes().startswith(b"solid")


def test_quiet_and_verbose(folder: Path, capsys: Capture) -> None:
    put("third.off", cube(1 / 3))
    _, out, err = ran(capsys, "union", "third.off", "c.stl", "-o", "x.stl")
    assert (
        "note: x.stl: binary STL stores coordinates in single precision" in err
        and out.count("\n") == 2
    )
    assert ran(capsys, "union", "third.off", "c.stl", "-o", "x.stl", "-q")[2] == ""
    assert "combine:" in ran(capsys, "union", "third.off", "c.stl", "-o", "x.stl", "-v")[2]


def test_output_may_replace_an_input(folder: Path, capsys: Capture) -> None:
    assert ran(capsys, "union", "a.off", "c.stl", "-o", "a.off")[0] == 0
    assert b.load("a.off").volume_exact == 15
    assert sorted(os.listdir()) == ["a.off", "c.stl"]


def test_empty_results_must_be_meant(folder: Path, capsys: Capture) -> None:
    code, out, err = ran(capsys, "difference", "a.off", "a.off", "-o", "x.off")
    assert (code, out) == (4, "") and "--allow-empty" in err and not Path("x.off").exists()
    code, out, _ = ran(capsys, "difference", "a.off", "a.off", "-o", "x.off", "--allow-empty")
    assert code == 0 and "empty" in out and len(read("x.off").faces) == 0


# What the check finds


def test_disagreement_is_exit_code_1(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(OPERATIONS, "union", lambda *solids: solids[0])
    code, out, _ = ran(capsys, "union", "a.off", "c.stl", "-o", "x.off")
    assert code == 1 and "check: DISAGREE" in out and Path("x.off").exists()


def test_what_fails_by_itself_is_not_written(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(b.Mesh, "open_edges", 7)
    code, out, _ = ran(capsys, "union", "a.off", "c.stl", "-o", "x.off")
    assert code == 1 and "not written" in out and "7 open edges" in out
    assert not Path("x.off").exists()


# Bad input


def broken_cube(**changes: Any) -> str:
    vertices, faces = cube(5)
    lines = [" ".join(map(str, row)) for row in vertices.tolist()]
    lines += ["3 " + " ".join(map(str, row)) for row in faces.tolist()]
    for at, text in changes.items():
        lines[int(at[1:])] = text
    return "\n".join(["OFF", "8 12 0", *lines, ""])


def stl_bytes(mesh: Arrays, folder: Path) -> bytes:
    write(RawMesh(*mesh), folder / "whole.stl")
    return (folder / "whole.stl").read_bytes()


BAD: dict[str, tuple[str, int, str]] = {
    "empty.off": ("", 3, "the file is empty"),
    "nan.off": (broken_cube(_3="nan 0 0"), 3, "nan.off:6:"),
    "inf.off": (broken_cube(_3="0 -inf 0"), 3, "inf.off:6:"),
    "index.off": (broken_cube(_9="3 0 1 8"), 3, "index.off:12:"),
    "negative.off": (broken_cube(_9="3 0 1 -1"), 3, "negative.off:12:"),
    "rubbish.ply": ("no mesh at all", 3, "the file is not a PLY mesh"),
    "open.off": ("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 4, "not closed"),
    "turned.off": (broken_cube(_9="3 0 2 3"), 4, "not closed"),
    "huge.off": (broken_cube(_3="1e308 0 0"), 4, "huge.off: "),
    "none.off": ("OFF\n0 0 0\n", 4, "none.off: "),
    "faceless.off": ("OFF\n1 0 0\n1 2 3\n", 4, "faceless.off: "),
    "missing.off": ("", 3, "No such file"),
}


@pytest.mark.parametrize("name", BAD)
@pytest.mark.parametrize("first", [True, False])
def test_bad_files_are_refused(folder: Path, capsys: Capture, name: str, first: bool) -> None:
    text, expected, words = BAD[name]
    if name != "missing.off":
        Path(name).write_text(text)
    before = sorted(os.listdir())
    files = [name, "a.off"] if first else ["a.off", name]
    code, out, err = ran(capsys, "union", *files, "-o", "x.stl")
    assert (code, out) == (expected, "")
    assert err.startswith(f"bspcsg: error: {name}") and words in err
    assert sorted(os.listdir()) == before


@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_named_by_check(folder: Path, capsys: Capture, name: str) -> None:
    text, expected, _ = BAD[name]
    if name != "missing.off":
        Path(name).write_text(text)
    code, out, err = ran(capsys, "check", name, "a.off")
    assert code == (1 if expected == 4 else 3)
    assert name in out + err and "a.off: solid" in out and "1 of 2 files is not a solid." in out


def test_errors_are_json_too(folder: Path, capsys: Capture) -> None:
    Path("bad.off").write_text(BAD["nan.off"][0])
    code, out, err = ran(capsys, "union", "bad.off", "a.off", "-o", "x.stl", "--json")
    found = json.loads(out)
    assert code == found["exit"] == 3 and err
    assert (found["error"]["code"], found["error"]["where"]) == ("non_finite", [6])


@pytest.mark.parametrize("size", [0, 40, 84, 300, 683])
def test_truncated_stl(folder: Path, capsys: Capture, size: int) -> None:
    Path("cut.stl").write_bytes(stl_bytes(cube(), folder)[:size])
    code, out, err = ran(capsys, "union", "cut.stl", "a.off", "-o", "x.stl")
    assert (code, out) == (3, "") and "cut.stl" in err and not Path("x.stl").exists()


def test_inverted_files_are_empty_with_a_warning(folder: Path, capsys: Capture) -> None:
    put("inverted.off", flipped(cuboid((-5, -5, -5), (9, 9, 9))))
    code, _, err = ran(capsys, "union", "inverted.off", "a.off", "-o", "x.off")
    assert code == 0 and "warning: inverted.off:" in err and "inside out" in err
    assert b.load("x.off").volume_exact == 8
    code, out, _ = ran(capsys, "check", "inverted.off")
    assert code == 1 and "inside out" in out


def test_faces_without_area_are_a_note(folder: Path, capsys: Capture) -> None:
    vertices, faces = cube(2)
    put("flat.off", (vertices, np.concatenate([faces, [[0, 1, 1], [2, 2, 2]]])))
    code, _, err = ran(capsys, "union", "flat.off", "c.stl", "-o", "x.off")
    assert code == 0 and "flat.off: " in err
    assert b.load("x.off").volume_exact == 15


def test_files_that_overlap_themselves(folder: Path, capsys: Capture) -> None:
    put("double.off", joined(cuboid((0, 0, 0), (2, 2, 2)), cuboid((1, 1, 1), (3, 3, 3))))
    put("far.off", moved(cube(), (9, 0, 0)))
    code, out, err = ran(capsys, "union", "double.off", "far.off", "-o", "x.off", "-v")
    assert code == 0 and "check: agree" in out and "operand 1 overlaps itself" in err
    assert b.load("x.off").volume_exact == 16


# The verb that looks


def test_check_of_a_solid(folder: Path, capsys: Capture) -> None:
    code, out, err = ran(capsys, "check", "a.off")
    assert (code, err) == (0, "")
    assert out == "a.off: solid, 12 triangles, 1 surface, genus 0, area 24, volume 8\n"


def test_check_names_defects_with_places(folder: Path, capsys: Capture) -> None:
    vertices, faces = cube()
    put("open.off", (vertices, faces[1:]))
    put("touching.off", joined(cube(), moved(cube(), (1, 1, 0))))
    code, out, _ = ran(capsys, "check", "a.off", "open.off", "touching.off")
    assert code == 1
    assert (
        "error: 3 edges with only one triangle (open edges), around 1 hole; the first from (" in out
    )
    assert "warning: 1 edge with more than two triangles; the first from (1, 1, 0) to" in out
    assert out.endswith("1 of 3 files is not a solid.\n")


def test_strict_counts_warnings(folder: Path, capsys: Capture) -> None:
    put("double.off", joined(cube(), moved(cube(), (0.5, 0.5, 0.5))))
    assert ran(capsys, "check", "double.off")[0] == 0
    assert ran(capsys, "check", "double.off", "--strict")[0] == 1


def test_check_as_json(folder: Path, capsys: Capture) -> None:
    Path("bad.off").write_text("no")
    put("huge.off", moved(cube(), (1e308, 0, 0)))
    code, out, _ = ran(capsys, "check", "a.off", "bad.off", "huge.off", "--json")
    found = json.loads(out)["files"]
    assert code == 3
    assert [entry["verdict"] for entry in found] == ["solid", "unreadable", "refused"]
    assert found[0]["volume"] == 8.0


# Usage and the process around it


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["slice"],
        ["union"],
        ["union", "a.off"],
        ["union", "a.off", "-o", "x.off"],
        ["union", "a.off", "c.stl"],
        ["union", "a.off", "c.stl", "-o", "x.off", "--winding", "odd"],
        ["union", "a.off", "c.stl", "-o", "x.off", "--pitch", "fine"],
        ["union", "a.off", "c.stl", "-o", "x.off", "--threads", "-1"],
        ["check"],
        ["--nonsense"],
    ],
)
def test_wrong_usage(folder: Path, capsys: Capture, arguments: list[str]) -> None:
    code, out, err = ran(capsys, *arguments)
    assert (code, out) == (2, "") and err


@pytest.mark.parametrize("name", ["x.step", "x", "x.amf"])
def test_unknown_output_comes_before_any_work(folder: Path, capsys: Capture, name: str) -> None:
    code, _, err = ran(capsys, "union", "none.off", "nothing.off", "-o", name)
    assert code == 3 and name in err and "none.off" not in err


def test_output_into_a_missing_folder(folder: Path, capsys: Capture) -> None:
    code, _, err = ran(capsys, "union", "a.off", "c.stl", "-o", "no/x.off")
    assert code == 5 and "does not exist or is not writable" in err


def test_output_that_is_a_folder(folder: Path, capsys: Capture) -> None:
    Path("x.off").mkdir()
    assert ran(capsys, "union", "a.off", "c.stl", "-o", "x.off")[0] == 5


def test_defects_say_so_without_a_traceback(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise ZeroDivisionError("by zero")

    monkeypatch.setitem(OPERATIONS, "union", fail)
    code, _, err = ran(capsys, "union", "a.off", "c.stl", "-o", "x.off")
    assert code == 70 and "defect of bspcsg" in err
    with pytest.raises(ZeroDivisionError):
        run(["union", "a.off", "c.stl", "-o", "x.off", "--debug"])


@pytest.mark.parametrize("verb", ["", *_VERBS])
def test_help_has_an_example(capsys: Capture, verb: str) -> None:
    code, out, _ = ran(capsys, *filter(None, [verb]), "--help")
    assert code == 0 and "Example" in out and f"bspcsg {verb}" in out


def test_version(capsys: Capture) -> None:
    assert ran(capsys, "--version")[:2] == (0, f"bspcsg {b.__version__}\n")


def test_the_program_itself(folder: Path) -> None:
    done = process("union", "a.off", "c.stl", "-o", "x.ply", stdout=subprocess.PIPE)
    out, _ = done.communicate(timeout=60)
    assert done.returncode == 0 and b"15" in out
    assert process("union", "a.off", "no.off", "-o", "x.ply").wait(timeout=60) == 3


def test_closed_pipes_are_quiet(folder: Path) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    running = process("check", "a.off", stdout=writer, stderr=subprocess.PIPE)
    os.close(writer)
    _, err = running.communicate(timeout=60)
    assert (running.returncode, err) == (141, b"")


@pytest.mark.skipif(os.name != "posix", reason="signals as POSIX has them")
def test_interruption_is_quiet_and_leaves_nothing(folder: Path) -> None:
    sphere = icosphere(6)
    put("s.ply", sphere)
    put("t.ply", moved(sphere, (0.001, 0.002, 0.003)))
    files = ["s.ply", "t.ply"] * 20
    running = process("union", *files, "-o", "x.ply", "-v", stderr=subprocess.PIPE)
    assert running.stderr is not None
    assert b"s.ply" in running.stderr.readline()
    time.sleep(0.1)
    running.send_signal(signal.SIGINT)
    began = time.monotonic()
    try:
        _, err = running.communicate(timeout=60)
    finally:
        running.kill()
    assert running.returncode == 130
    assert time.monotonic() - began < 3
    assert b"Traceback" not in err and not Path("x.ply").exists()
