"""The option --simplify: lengths, messages, and the commands that have it."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg.attributes.attributes import Attributes
from bspcsg.io import read, write
from support.cli import Capture, ran

MODEL = "near.off"


@pytest.fixture
def near(folder: Path) -> Path:
    """Return the folder, with a cube that has a bump 0.0001 high: 28 triangles, 20 without it."""
    (b.cube(1) | b.cube(0.5).translate(0.5001, 0.25, 0.25)).save(MODEL)
    return folder


@pytest.mark.parametrize("length", ["0.001mm", "0.001", "1e-3", "1 um", "1e-6m", "0.0001cm"])
def test_lengths(near: Path, capsys: Capture, length: str) -> None:
    code, out, err = ran(capsys, "convert", MODEL, "-o", "x.stl", "--simplify", length)
    assert code == 0 and "20 triangles" in out
    assert "note: near.off: short edges and slivers were removed" in err
    assert b.load("x.stl").equals(b.cube(1))


@pytest.mark.parametrize("length", ["-1mm", "1 parsec", "mm", "inf", "nan", "1e999", ""])
def test_lengths_that_make_no_sense(near: Path, capsys: Capture, length: str) -> None:
    code, _, err = ran(capsys, "convert", MODEL, "-o", "x.stl", f"--simplify={length}")
    assert code == 2 and "is not a length" in err and "0.01mm" in err
    assert not Path("x.stl").exists()


VERBS = [
    ("union", MODEL, MODEL, "-o", "x.ply"),
    ("intersection", MODEL, MODEL, "-o", "x.ply"),
    ("eval", MODEL, "-o", "x.ply"),
    ("run", "x.py", "-o", "x.ply"),
    ("split", MODEL, "-o", "x.ply"),
]


@pytest.mark.parametrize("verb", VERBS, ids=lambda verb: verb[0])
def test_verbs(near: Path, capsys: Capture, verb: tuple[str, ...]) -> None:
    Path("x.py").write_text(f'import bspcsg\nresult = bspcsg.load("{MODEL}")\n')
    code, out, err = ran(capsys, *verb, "--simplify", "0.001")
    written = "x-1.ply" if verb[0] == "split" else "x.ply"
    assert code == 0 and "20 triangles" in out and "which left 20 triangles of 28" in err
    assert b.load(written).equals(b.cube(1))


def test_as_json(near: Path, capsys: Capture) -> None:
    code, out, _ = ran(capsys, "union", MODEL, MODEL, "-o", "x.off", "--simplify", "1um", "--json")
    found = json.loads(out)
    assert code == 0 and found["triangles"] == 20 and found["volume"] == 1
    assert "simplified" in [finding["code"] for finding in found["findings"]]
    # The check is about the operation: what was removed afterwards is no disagreement.
    assert found["check"]["verdict"] == "agree"


@pytest.mark.parametrize("verb", [("convert", MODEL), ("union", MODEL, MODEL)])
def test_nothing_to_remove(near: Path, capsys: Capture, verb: tuple[str, ...]) -> None:
    code, out, err = ran(capsys, *verb, "-o", "x.off", "--simplify", "0.01um")
    assert (
        code == 0
        and "small enough to be simplified within the tolerance" in err
        and "28 triangles" in out
    )


# Found: `convert --simplify` failed on meshes with attributes.
def test_attributes_of_simplified_meshes_are_lost(near: Path, capsys: Capture) -> None:
    raw = read(MODEL)
    colours = Attributes(raw.faces, face={"color": np.ones((len(raw.faces), 3))})
    write(replace(raw, attributes=colours), "x.ply")
    line = ["convert", "x.ply", "-o", "y.ply", "--simplify", "1um", "--fail-on-loss"]
    code, out, err = ran(capsys, *line)
    assert code == 1 and "20 triangles  lost: attributes: “color”" in out, err
    assert b.load("y.ply").equals(b.cube(1))


# Found: `convert --simplify` claimed that nothing was lost although names of objects and warnings
# of the reader were.
def test_names_of_objects_that_became_one_are_lost(near: Path, capsys: Capture) -> None:
    raw = read(MODEL)
    write(replace(raw, objects=(("bump", 10), ("rest", len(raw.faces) - 10))), "x.obj")
    line = ["convert", "x.obj", "-o", "y.obj", "--simplify", "1um", "--fail-on-loss"]
    code, out, _ = ran(capsys, *line)
    assert code == 1 and "lost: names of objects: “rest”" in out


def test_open_meshes_are_refused(folder: Path, capsys: Capture) -> None:
    Path("open.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    code, _, err = ran(capsys, "convert", "open.off", "-o", "x.stl", "--simplify", "1mm")
    assert code == 4 and "not closed" in err and not Path("x.stl").exists()
