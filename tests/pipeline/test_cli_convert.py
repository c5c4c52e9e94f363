"""The command convert: files that are written, losses that are reported, and refusals."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg.io import RawMesh, read, write
from support.cli import Capture, put, ran
from support.shapes import cube, icosphere, joined, moved

SUFFIXES = ["stl", "obj", "ply", "off", "3mf", "glb", "vtk", "vtu"]


@pytest.mark.parametrize("source", SUFFIXES)
def test_any_format_to_any(folder: Path, capsys: Capture, source: str) -> None:
    put(f"in.{source}", cube(2.5))
    for suffix in SUFFIXES:
        target = f"out.{suffix}"
        code, out, _ = ran(capsys, "convert", f"in.{source}", "-o", target, "--fail-on-loss")
        assert code == 0 and "nothing lost" in out, target
        assert b.load(target).equals(b.cube(2.5)), target


def test_losses_are_told_and_can_fail(folder: Path, capsys: Capture) -> None:
    put("ball.ply", icosphere(2))
    code, out, _ = ran(capsys, "convert", "ball.ply", "-o", "x.stl")
    assert code == 0 and "lost: coordinates changed by up to" in out
    assert ran(capsys, "convert", "ball.ply", "-o", "x.stl", "--fail-on-loss")[0] == 1
    assert ran(capsys, "convert", "ball.ply", "-o", "x.stl", "--ascii", "--fail-on-loss")[0] == 0


def test_losses_as_json(folder: Path, capsys: Capture) -> None:
    objects = (("lid", 12), ("body", 12))
    write(RawMesh(*joined(cube(), moved(cube(), (3, 0, 0))), objects=objects), "x.3mf")
    code, out, _ = ran(capsys, "convert", "x.3mf", "-o", "x.off", "--json")
    found = json.loads(out)["files"][0]
    assert code == 0 and found["lost"]["names"] == ["lid", "body"] and found["lost"]["any"]
    assert found["lost"]["shift"] == 0 and found["lost"]["volume"] == [2.0, 2.0]


def test_open_meshes_are_converted_as_they_are(folder: Path, capsys: Capture) -> None:
    put("open.off", (cube()[0], cube()[1][1:]))
    code, out, _ = ran(capsys, "convert", "open.off", "-o", "x.3mf")
    assert code == 0 and "nothing lost" in out and len(read("x.3mf").faces) == 11


def test_units(folder: Path, capsys: Capture) -> None:
    _, _, err = ran(capsys, "convert", "a.off", "-o", "x.3mf")
    assert "a.off has no length unit, so mm is assumed; --unit in changes it" in err
    code, _, err = ran(capsys, "convert", "a.off", "-o", "x.3mf", "--unit", "in")
    assert code == 0 and "no length unit" not in err
    assert read("x.3mf").vertices.max() == 50.8
    # What states its unit keeps it.
    assert ran(capsys, "convert", "x.3mf", "-o", "y.stl", "--unit", "ft")[0] == 0
    assert read("y.stl").vertices.max() == pytest.approx(50.8)
    assert ran(capsys, "convert", "a.off", "-o", "x.glb")[2].count("metres with the y axis up") == 1


def test_many_files(folder: Path, capsys: Capture) -> None:
    Path("out").mkdir()
    code, out, _ = ran(capsys, "convert", "a.off", "c.stl", "--to", "ply", "--outdir", "out")
    assert code == 0 and sorted(os.listdir("out")) == ["a.ply", "c.ply"] and out.count("\n") == 2
    assert ran(capsys, "convert", "a.off", "c.stl", "-o", "out/%-new.obj")[0] == 0
    assert sorted(os.listdir("out"))[1::2] == ["a.ply", "c.ply"]


def test_one_bad_file_of_many(folder: Path, capsys: Capture) -> None:
    Path("bad.stl").write_text("nothing")
    code, out, err = ran(capsys, "convert", "bad.stl", "a.off", "--to", "ply", "--outdir", ".")
    assert code == 3 and "bad.stl" in err and out.startswith("a.ply")
    assert Path("a.ply").exists() and not Path("bad.ply").exists()


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["a.off"], 2, "-o FILE or --outdir"),
        (["a.off", "-o", "x.ply", "--outdir", "."], 2, "-o FILE or --outdir"),
        (["a.off", "--outdir", "."], 2, "--to"),
        (["a.off", "c.stl", "-o", "x.ply"], 2, "must contain a %"),
        (["a.off", "./a.off", "--to", "ply", "--outdir", "."], 2, "both be written"),
        (["a.off", "-o", "x.ply", "--unit", "parsec"], 2, "parsec"),
        (["a.off", "-o", "x.step"], 3, "so meshes cannot be written to them; write 3MF or STL"),
        (["a.off", "-o", "x.gltf"], 3, ".gltf files cannot be written; write GLB, which"),
        (["part.stp", "-o", "x.stl"], 3, "STEP files contain curved surfaces"),
        (["part.amf", "-o", "x.stl"], 3, "export 3MF instead"),
        (["part.gltf", "-o", "x.stl"], 3, "one GLB file"),
        (["none.stl", "-o", "x.ply"], 3, "No such file"),
        (["a.off", "-o", "x.3mf", "--ascii"], 3, "no text form"),
        (["a.off", "-o", "no/x.ply"], 5, "does not exist or is not writable"),
    ],
)
def test_refusals(
    folder: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
    before = sorted(os.listdir())
    found, out, err = ran(capsys, "convert", *arguments)
    assert (found, out) == (code, "") and words in err
    assert sorted(os.listdir()) == before


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("part", [0.0, 0.3, 0.9])
def test_truncated_files(folder: Path, capsys: Capture, suffix: str, part: float) -> None:
    put(f"ball.{suffix}", icosphere(1))
    data = Path(f"ball.{suffix}").read_bytes()
    # An OBJ has no end, so only a line that is cut says that it was.
    Path(f"cut.{suffix}").write_bytes(data[: int(len(data) * part)] + b"\nf 1" * (suffix == "obj"))
    code, out, err = ran(capsys, "convert", f"cut.{suffix}", "-o", "x.ply")
    assert (code, out) == (3, "") and err.startswith(f"bspcsg: error: cut.{suffix}")
    assert len(err.splitlines()) == 1 and not Path("x.ply").exists()


def test_a_missing_part_is_code_6(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "meshio", None)
    code, _, err = ran(capsys, "convert", "a.off", "-o", "x.vtu")
    assert code == 6 and 'pip install "bspcsg[vtk]"' in err


def test_objects_of_one_name_stay(folder: Path, capsys: Capture) -> None:
    objects = (("lid", 12), ("lid", 12))
    write(RawMesh(*joined(cube(), moved(cube(), (3, 0, 0))), objects=objects), "x.3mf")
    for name in ("x.glb", "x.obj"):
        code, out, _ = ran(capsys, "convert", "x.3mf", "-o", name, "--fail-on-loss")
        assert code == 0 and "nothing lost" in out and read(name).objects == objects


def test_a_file_that_is_not_the_mesh_is_not_put_in_place(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    put("a.off", cube())
    put("x.off", cube(2))
    before = Path("x.off").read_bytes()
    monkeypatch.setattr(os, "fsync", lambda handle: os.ftruncate(handle, 60))
    for verb in (("convert", "a.off"), ("union", "a.off", "a.off")):
        code, out, err = ran(capsys, *verb, "-o", "x.off", "--json")
        said = json.loads(out)
        assert code == 5 and "differs from the mesh" in err
        assert said["error"]["code"] == "write_mismatch" and said["exit"] == 5
        assert Path("x.off").read_bytes() == before and not list(Path().glob(".*.part"))


# Found: triangles lost their area in single precision, and `check` still called the file a solid.
def test_what_single_precision_destroys_is_told(folder: Path, capsys: Capture) -> None:
    put("a.ply", moved(icosphere(2), (0, 0, 1e7)))
    code, out, err = ran(capsys, "convert", "a.ply", "-o", "x.stl", "--json")
    findings = json.loads(out)["files"][0]["findings"]
    counts = {finding["code"]: finding["count"] for finding in findings}
    assert code == 0 and counts["flattened_by_rounding"] > 0 and counts["merged_by_rounding"] > 0
    assert f"removes the area of {counts['flattened_by_rounding']} triangles" in err
    ran(capsys, "union", "a.ply", "a.ply", "-o", "y.stl", "--json")
    code, out, err = ran(capsys, "union", "a.ply", "a.ply", "-o", "y.stl", "--json", "--no-check")
    codes = [finding["code"] for finding in json.loads(out)["findings"]]
    assert code == 0 and {"single_precision", "flattened_by_rounding"} <= set(codes)
    assert "removes the area of" in err


# Found: `convert` wrote over an input that it had not read yet.
def test_an_input_that_is_not_read_yet_stays(folder: Path, capsys: Capture) -> None:
    Path("x-a.off").write_bytes(Path("a.off").read_bytes())
    code, _, err = ran(capsys, "convert", "a.off", "x-a.off", "-o", "x-%.off")
    assert code == 2 and "is also an input" in err
    # A file may take its own place.
    assert ran(capsys, "convert", "a.off", "x-a.off", "-o", "%.off")[0] == 0


# Found: opaque colours of four numbers, which many programs write, were lost in OBJ.
def test_opaque_colours_lose_nothing_in_an_obj(folder: Path, capsys: Capture) -> None:
    vertices, faces = b.cube(1).to_mesh()
    colors = np.full((8, 4), (9, 8, 7, 255), np.uint8)
    b.Solid(vertices, faces, vertex_attributes={"color": colors}).save("ball.glb")
    code, out, err = ran(capsys, "convert", "ball.glb", "-o", "ball.obj", "--fail-on-loss")
    assert code == 0 and "nothing lost" in out, err
    colors[:, 3] = 128
    b.Solid(vertices, faces, vertex_attributes={"color": colors}).save("ball.glb")
    code, out, err = ran(capsys, "convert", "ball.glb", "-o", "ball.obj", "--fail-on-loss")
    assert code == 1 and "lost: attributes: “color”" in out
    assert "OBJ cannot store the opacity of the attribute “color”" in err


# Found: 3MF, which holds colours, was said to have no room for attributes.
def test_what_is_lost_is_told_in_true_words(folder: Path, capsys: Capture) -> None:
    b.cube(1).tagged(color="red", layer=3).save("x.ply")
    code, out, err = ran(capsys, "convert", "x.ply", "-o", "x.3mf")
    assert code == 0 and "lost: attributes: “layer”" in out
    assert "3MF cannot store “layer” of faces, which was left out." in err
