"""Options that several commands have in common, command by command."""

import io
import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import bspcsg as b
from bspcsg import csg
from bspcsg.cli.main import run
from bspcsg.io import read
from support.cli import Capture, put, ran
from support.shapes import cube

TURNED = b.box((1, 2, 3))

#: For each verb that writes a file, a command line without the output file.
WRITERS = {
    "union": ["union", "a.off", "c.stl"],
    "eval": ["eval", "a.off - c.stl"],
    "split": ["split", "a.off"],
    "slice": ["slice", "a.off", "--z", "1"],
    "render": ["render", "a.off"],
    "convert": ["convert", "a.off"],
    "run": ["run", "m.csg"],
    "tree": ["tree", "m.csg"],
}
SUFFIXES = {"slice": ".svg", "render": ".svg", "tree": ".json"}


@pytest.fixture
def opened(folder: Path) -> Path:
    """Return the folder, with a unit cube without one face in open.off."""
    put("open.off", (cube()[0], cube()[1][1:]))
    return folder


# --on-invalid


def test_invalid_files_are_refused_with_what_to_type(opened: Path, capsys: Capture) -> None:
    code, _, err = ran(capsys, "union", "a.off", "open.off", "-o", "x.off")
    assert code == 4 and "open.off: the mesh is not closed: 3 edges" in err
    assert "\n  Try: bspcsg repair open.off -o open-fixed.off\n" in err
    assert "\n  --on-invalid repair closes the mesh; --on-invalid warn leaves it out.\n" in err


# Found: `convert --simplify`, `render --section` and others advised `--on-invalid`, which they do
# not have.
@pytest.mark.parametrize(
    "arguments",
    [
        ["convert", "open.off", "-o", "x.off", "--simplify", "0.1mm"],
        ["render", "open.off", "-o", "x.svg", "--section", "0,0,1,0.5"],
    ],
)
def test_advice_names_only_options_of_the_verb(
    opened: Path, capsys: Capture, arguments: list[str]
) -> None:
    code, _, err = ran(capsys, *arguments)
    assert code == 4 and "open.off: the mesh is not closed" in err
    assert "Try: bspcsg repair open.off" in err and "--on-invalid" not in err


@pytest.mark.parametrize(
    ("arguments", "volume"),
    [
        (["union", "a.off", "open.off"], 8),
        (["difference", "a.off", "open.off"], 8),
        (["eval", "a.off - open.off"], 8),
    ],
)
def test_invalid_files_left_out(
    opened: Path, capsys: Capture, arguments: list[str], volume: float
) -> None:
    code, _, err = ran(capsys, *arguments, "-o", "x.off", "--on-invalid", "warn")
    assert code == 0 and b.load("x.off").volume == volume
    assert err.startswith("warning: open.off: the mesh is not closed") and "left out" in err


def test_nothing_but_invalid_files_is_an_empty_result(opened: Path, capsys: Capture) -> None:
    command = ["difference", "open.off", "a.off", "-o", "x.off", "--on-invalid", "warn"]
    code, _, err = ran(capsys, *command)
    assert code == 4 and "the result is empty" in err and not Path("x.off").exists()


@pytest.mark.parametrize(
    ("arguments", "target"),
    [
        (["difference", "a.off", "open.off"], "x.off"),
        (["split", "open.off"], "x.off"),
        (["slice", "open.off", "--z", "0.5"], "x.svg"),
    ],
)
def test_invalid_files_repaired(
    opened: Path, capsys: Capture, arguments: list[str], target: str
) -> None:
    pytest.importorskip("pymeshlab")
    code, _, err = ran(capsys, *arguments, "-o", target, "--on-invalid", "repair")
    assert code == 0 and "warning: open.off was not closed and was repaired: 11 triangles" in err
    if arguments[0] == "difference":
        assert b.load("x.off").volume == 7


def test_compare_takes_invalid_files_as_well(opened: Path, capsys: Capture) -> None:
    b.cube(1).save("whole.off")
    pytest.importorskip("pymeshlab")
    assert ran(capsys, "compare", "open.off", "whole.off", "--on-invalid", "repair")[0] == 0
    assert ran(capsys, "compare", "open.off", "whole.off")[0] == 4


def test_repairs_that_close_nothing(
    opened: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    from bspcsg.repair.repair import Repair

    monkeypatch.setattr("bspcsg.assembly.object_repair.repair", lambda raw: Repair(raw, {}, 0))
    code, _, err = ran(capsys, "union", "a.off", "open.off", "-o", "x", "--to", "off",
                       "--on-invalid", "repair")  # fmt: skip
    assert (
        code == 4
        and "The automatic repair could not close the mesh" in err
        and not Path("x").exists()
    )


def test_invalid_meshes_in_scripts(opened: Path, capsys: Capture) -> None:
    Path("m.csg").write_text('cube(1); import(file = "open.off");')
    pytest.importorskip("pymeshlab")
    command = ["run", "m.csg", "-o", "x.off"]
    assert ran(capsys, *command)[0] == 4
    code, _, err = ran(capsys, *command, "--on-invalid", "repair")
    assert code == 0 and "m.csg:1:10: import(): " in err and "This mesh is repaired" in err
    assert b.load("x.off").volume == 1


# --digits


def test_digits(folder: Path, capsys: Capture) -> None:
    third = b.cube(1).scale(1 / 3)
    third.save("third.off")
    code, _, err = ran(capsys, "union", "third.off", "third.off", "-o", "x.obj", "--digits", "4")
    assert (
        code == 0
        and "rounding to 4 significant digits changed coordinates by up to 3.33e-05" in err
    )
    assert set(read("x.obj").vertices.ravel().tolist()) == {0, 0.3333}
    code, out, _ = ran(capsys, "convert", "third.off", "-o", "x.ply", "--digits", "2")
    assert code == 0 and "lost: " in out and read("x.ply").vertices.max() == 0.33
    code, out, err = ran(capsys, "convert", "a.off", "-o", "x.ply", "--digits", "2")
    assert code == 0 and "nothing lost" in out


@pytest.mark.parametrize("digits", ["0", "18", "many"])
def test_digits_that_make_no_sense(folder: Path, capsys: Capture, digits: str) -> None:
    assert ran(capsys, "convert", "a.off", "-o", "x.ply", "--digits", digits)[0] == 2


def test_seventeen_digits_change_nothing(folder: Path, capsys: Capture) -> None:
    b.sphere(1 / 3, segments=7).rotate(20, "x").save("ball.off")
    assert ran(capsys, "convert", "ball.off", "-o", "x.off", "--digits", "17")[0] == 0
    assert np.array_equal(read("x.off").vertices, read("ball.off").vertices)


# --overwrite


@pytest.mark.parametrize("verb", WRITERS)
def test_files_are_kept_if_asked_to(folder: Path, capsys: Capture, verb: str) -> None:
    Path("m.csg").write_text("cube(1);")
    target = f"x{SUFFIXES.get(verb, '.off')}"
    command = [*WRITERS[verb], "-o", target, "--no-overwrite"]
    written = "x-1.off" if verb == "split" else target
    assert ran(capsys, *command)[0] == 0 and Path(written).is_file()
    Path(written).write_text("mine")
    code, out, err = ran(capsys, *command)
    assert (code, out) == (5, "") and Path(written).read_text("utf-8") == "mine"
    assert f"{written}: this file exists already; --overwrite replaces it." in err
    assert (
        ran(capsys, *command, "--overwrite")[0] == 0 and Path(written).read_text("utf-8") != "mine"
    )


def test_a_dangling_link_is_there_as_well(folder: Path, capsys: Capture) -> None:
    os.symlink("nowhere.off", "x.off")
    assert ran(capsys, "convert", "a.off", "-o", "x.off", "--no-overwrite")[0] == 5


# Found: `--no-overwrite` replaced an MTL file.
@pytest.mark.parametrize("words", [["convert", "in.3mf"], ["union", "in.3mf", "in.3mf"]])
def test_files_beside_are_kept_as_well(folder: Path, capsys: Capture, words: list[str]) -> None:
    mesh = b.cube(1).to_mesh()
    faces: dict[str, Any] = {"material": np.full(12, "a")}
    red = {"a": b.Material((1, 0, 0))}
    b.Solid(mesh.vertices, mesh.faces, face_attributes=faces, materials=red).save("in.3mf")
    Path("new.mtl").write_text("mine")
    command = [*words, "-o", "new.obj", "--no-overwrite"]
    code, _, err = ran(capsys, *command)
    assert code == 5 and "new.mtl: this file exists already; --overwrite replaces it." in err
    assert Path("new.mtl").read_text("utf-8") == "mine" and not Path("new.obj").exists()
    Path("new.mtl").unlink()
    assert ran(capsys, *command)[0] == 0 and Path("new.mtl").is_file()


# Numbers


# Found: numbers of options that were not finite, and seconds that no system call takes, were
# accepted or ended as a defect.
# Found: `compare --samples` of very many points ended as a defect.
@pytest.mark.parametrize(
    "line",
    [
        "compare a.off c.stl --tolerance nan",
        "compare a.off c.stl --samples 99999999999999999999",
        "crosscheck a.off c.stl --samples 99999999999999999999",
        "repair a.off -o x.ply --timeout nan",
        "repair a.off -o x.ply --timeout inf",
        "repair a.off -o x.ply --timeout 1e10",
        "repair a.off -o x.ply --weld nan",
        "render a.off -o x.gif --frames 2 --seconds inf",
        "render a.off -o x.gif --frames 2 --seconds 2000",
        "render a.off -o x.svg --azimuth nan",
        "crosscheck a.off c.stl --timeout nan",
        "bench --memory inf",
        "bench --limit nan",
        "bench --budget inf",
    ],
)
def test_numbers_that_make_no_sense(folder: Path, capsys: Capture, line: str) -> None:
    code, out, err = ran(capsys, *line.split())
    assert (code, out) == (2, "") and line.split()[-2] in err


# --up


def turned_bounds(name: str) -> list[float]:
    raw = read(name)
    return [round(size, 6) for size in np.ptp(raw.vertices, axis=0).tolist()]


@pytest.mark.parametrize(
    ("options", "size"),
    [
        ([], [1, 2, 3]),
        (["--up", "y"], [1, 3, 2]),
        (["--from-up", "y"], [1, 3, 2]),
        (["--up", "y", "--from-up", "y"], [1, 2, 3]),
        (["--up", "z"], [1, 2, 3]),
    ],
)
def test_up(folder: Path, capsys: Capture, options: list[str], size: list[float]) -> None:
    TURNED.save("t.off")
    code, out, _ = ran(capsys, "convert", "t.off", "-o", "x.obj", *options)
    assert code == 0 and turned_bounds("x.obj") == size and "nothing lost" in out
    made = b.load("x.obj")
    assert made.volume == 6  # turned, not mirrored


def test_up_means_the_way_it_stands(folder: Path, capsys: Capture) -> None:
    b.cube(1).translate(0, 0, 5).save("high.off")
    assert ran(capsys, "convert", "high.off", "-o", "x.off", "--up", "y")[0] == 0
    assert read("x.off").vertices[:, 1].min() == 5
    assert ran(capsys, "convert", "x.off", "-o", "y.off", "--from-up", "y")[0] == 0
    assert b.load("y.off").equals(b.load("high.off"))


@pytest.mark.parametrize(
    ("options", "size"), [([], [1, 3, 2]), (["--up", "z"], [1, 2, 3]), (["--up", "y"], [1, 3, 2])]
)
def test_up_in_glb(folder: Path, capsys: Capture, options: list[str], size: list[float]) -> None:
    import trimesh

    TURNED.save("t.off")
    assert ran(capsys, "convert", "t.off", "-o", "x.glb", *options)[0] == 0
    metres = trimesh.load_mesh("x.glb").extents * 1000
    assert metres.round(6).tolist() == size
    # Reading it with the same word gives the model back.
    told = ["--from-up", options[1]] if options else []
    assert ran(capsys, "convert", "x.glb", "-o", "back.off", *told)[0] == 0
    assert turned_bounds("back.off") == [1, 2, 3]


# -o - for drawings


@pytest.mark.parametrize(
    ("arguments", "form", "start"),
    [
        (["render", "a.off"], "svg", b"<svg"),
        (["render", "a.off", "--size", "40x30"], "png", b"\x89PNG"),
        (["slice", "a.off", "--z", "1"], "svg", b"<svg"),
        (["slice", "a.off", "--z", "1"], "DXF", b"  0\nSECTION"),
    ],
)
def test_drawings_as_streams(
    folder: Path,
    capsysbinary: pytest.CaptureFixture[bytes],
    arguments: list[str],
    form: str,
    start: bytes,
) -> None:
    assert run([*arguments, "-o", "-", "--to", form]) == 0
    out, err = capsysbinary.readouterr()
    assert out.startswith(start) and err.startswith(b"-  ")
    if form == "png":
        assert Image.open(io.BytesIO(out)).size == (40, 30)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["-o", "-"], "give the format with --to .svg or .png"),
        (["-o", "-", "--to", "jpg"], "'jpg' is not a drawing format; use .svg or .png"),
        (["-o", "-", "--to", "svg", "--json"], "--json and a drawing cannot both"),
    ],
)
def test_streams_of_drawings_that_cannot_be(
    folder: Path, capsys: Capture, arguments: list[str], said: str
) -> None:
    code, out, err = ran(capsys, "render", "a.off", *arguments)
    assert (code, "error" in out) == (2, "--json" in arguments) and said in err


def test_a_name_may_be_anything_if_the_format_is_said(folder: Path, capsys: Capture) -> None:
    assert ran(capsys, "slice", "a.off", "--z", "1", "-o", "layer", "--to", ".svg")[0] == 0
    assert Path("layer").read_text("utf-8").startswith("<svg")


# Other names


def test_cut_is_the_difference(folder: Path, capsys: Capture) -> None:
    assert ran(capsys, "cut", "a.off", "c.stl", "-o", "x.off")[0] == 0
    assert b.load("x.off").volume == 7
    assert "  cut " not in ran(capsys, "--help")[1]
    assert "Also called cut" in ran(capsys, "cut", "--help")[1]


@pytest.mark.parametrize("name", ["-j", "--jobs", "--threads"])
def test_threads_have_three_names(folder: Path, capsys: Capture, name: str) -> None:
    assert ran(capsys, "union", "a.off", "c.stl", "-o", "x.off", name, "1")[0] == 0
    assert ran(capsys, "union", "a.off", "c.stl", "-o", "x.off", name, "-1")[0] == 2


# run: -D, --list-nodes, .json


def test_nodes_are_listed(capsys: Capture) -> None:
    code, out, err = ran(capsys, "run", "--list-nodes")
    assert (code, err) == (0, "") and out.split() == list(csg.node_names())


def test_trees_as_json_are_run(folder: Path, capsys: Capture) -> None:
    Path("m.json").write_text(csg.to_json(csg.parse("cube(2);")))
    assert ran(capsys, "run", "m.json", "-o", "x.off")[0] == 0
    assert b.load("x.off").volume == 8


def test_variables_of_python_scripts(folder: Path, capsys: Capture) -> None:
    Path("m.py").write_text(
        "import bspcsg as b\nsize = 1\nword = sure = said = count = known = None\n"
        "assert word == 'plain' and sure is True and said == 'a b'\n"
        "assert list(range(count)) == [0, 1] and known == {'a': (True, None)}\n"
        "result = b.box(size)\n"
    )
    values = ["-D", "size=[1, 2, 3.5]", "-D", "word=plain", "-D", "sure=true", "-D", 'said="a b"']
    values += ["-D", "count=2", "-D", "known={'a': (True, None)}"]
    code, _, err = ran(capsys, "run", "m.py", "-o", "x.off", *values)
    assert (code, err) == (0, "") and b.load("x.off").volume == 7
    code, _, err = ran(capsys, "run", "m.py", "-o", "x.off", "-D", "sise=2")
    assert code == 3 and "m.py: the script does not assign the variable sise" in err
    assert "Is size meant? It assigns size, word, sure, said, count, known, result." in err


@pytest.mark.skipif(shutil.which("openscad") is None, reason="needs openscad")
def test_variables_of_openscad(folder: Path, capsys: Capture) -> None:
    Path("m.scad").write_text("w = 1; cube([w, 2, 3]);")
    assert ran(capsys, "run", "m.scad", "-o", "x.off", "-D", "w=4")[0] == 0
    assert b.load("x.off").volume == 24


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["m.py", "-D", "w"], "'w' is not of the form NAME=VALUE"),
        (["m.py", "-D", "1=2"], "'1=2' is not of the form NAME=VALUE"),
        (["m.py", "-D", "w=2*3"], "'2*3' is not a value"),
        (["m.csg", "-D", "w=2"], "-D cannot be used with .csg files"),
        (["m.py", "--on-invalid", "warn"], "--on-invalid cannot be used with .py files"),
    ],
)
def test_variables_that_cannot_be(
    folder: Path, capsys: Capture, arguments: list[str], said: str
) -> None:
    code, _, err = ran(capsys, "run", *arguments, "-o", "x.off")
    assert code == 2 and said in err


def test_every_verb_tells_its_options(capsys: Capture) -> None:
    shown = {verb: ran(capsys, verb, "--help")[1] for verb in WRITERS}
    assert all("--no-overwrite" in text and "--jobs" in text for text in shown.values())
    rounding = {verb for verb, text in shown.items() if "--digits" in text}
    assert rounding == {"convert", "eval", "run", "split", "union"}


# options that would do nothing


# Found: `--frames`, `--seconds` and `--port` were taken where they do nothing.
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (
            ["render", "a.off", "-o", "x.svg", "--frames", "36"],
            "--frames can only be used when the output is a .gif file.",
        ),
        (
            ["render", "a.off", "-o", "x.png", "--seconds", "4"],
            "--seconds can only be used when the output is a .gif file.",
        ),
        (
            ["view", "a.off", "-o", "x.html", "--port", "0"],
            "--port can only be used with --live or",
        ),
        (["run", "m.csg", "-o", "x.off", "--port", "8000"], "--port can only be used with --view."),
        (
            ["run", "m.csg", "-o", "x.off", "--watch", "--port", "1"],
            "--port can only be used with --view",
        ),
    ],
)
def test_options_without_use_are_refused(
    folder: Path, capsys: Capture, arguments: list[str], words: str
) -> None:
    code, out, err = ran(capsys, *arguments)
    assert (code, out) == (2, "") and words in err
    assert not list(folder.glob("x.*"))
