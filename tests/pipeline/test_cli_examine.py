"""The commands that examine and compare files: info, compare, split, repair, doctor."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg.attributes.attributes import Attributes
from bspcsg.io import RawMesh, write
from support.cli import Capture, put, ran
from support.shapes import cube, cuboid, flipped, joined, moved

# info


def test_info(folder: Path, capsys: Capture) -> None:
    code, out, err = ran(capsys, "info", "a.off")
    assert (code, err) == (0, "")
    found = dict(line.strip().split("  ", 1) for line in out.splitlines()[2:])
    values = {name: value.strip() for name, value in found.items()}
    assert values["triangles"] == "12" and values["volume"] == "8" and values["area"] == "24"
    assert values["unit"] == "not stated" and values["size"] == "2 × 2 × 2"
    assert values["verdict"] == "solid" and values["genus"] == "0"


def test_info_of_units_and_names(folder: Path, capsys: Capture) -> None:
    objects = (("lid", 12), ("body", 12))
    write(RawMesh(*joined(cube(), moved(cube(), (3, 0, 0))), objects=objects), "x.3mf")
    _, out, _ = ran(capsys, "info", "x.3mf")
    assert "2 mm³" in out and "2 objects: lid, body" in out
    found = json.loads(ran(capsys, "info", "x.3mf", "--json")[1])["files"][0]
    assert found["unit"] == "mm" and found["objects"][1] == {"name": "body", "triangles": 12}
    assert found["bounds"] == [[0, 0, 0], [4, 1, 1]] and found["volume"] == 2


def test_info_of_what_is_no_solid(folder: Path, capsys: Capture) -> None:
    put("open.off", (cube()[0], cube()[1][1:]))
    code, out, _ = ran(capsys, "info", "open.off", "a.off")
    assert code == 0 and "not closed" in out and "error: 3 edges" in out


def test_info_of_unreadable_files(folder: Path, capsys: Capture) -> None:
    Path("bad.ply").write_text("ply\n")
    code, out, err = ran(capsys, "info", "bad.ply", "a.off")
    assert code == 3 and "a.off" in out and err.startswith("bspcsg: error: bad.ply")
    code, out, _ = ran(capsys, "info", "bad.ply", "a.off", "--json")
    assert code == 3 and "error" in json.loads(out)["files"][0]


def test_what_to_type_for_a_repair(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    put("an open.off", (cube()[0], cube()[1][1:]))
    assert "Try:" not in ran(capsys, "check", "an open.off")[1]
    # On a terminal there is somebody to advise.
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    code, out, _ = ran(capsys, "check", "an open.off")
    assert code == 1 and "Try: bspcsg repair 'an open.off' -o 'an open-fixed.off'" in out
    code, _, err = ran(capsys, "union", "an open.off", "a.off", "-o", "x.ply")
    assert code == 4 and "Try: bspcsg repair 'an open.off'" in err


# compare


def test_equal_sets(folder: Path, capsys: Capture) -> None:
    halves = joined(cuboid((0, 0, 0), (1, 2, 2)), cuboid((1, 0, 0), (2, 2, 2)))
    put("halves.ply", halves)
    code, out, _ = ran(capsys, "compare", "a.off", "halves.ply")
    assert code == 0 and out.endswith("The sets are equal, exactly.\n")


def test_different_sets(folder: Path, capsys: Capture) -> None:
    code, out, _ = ran(capsys, "compare", "a.off", "c.stl")
    assert code == 1 and "symmetric difference: volume 14" in out
    assert "Hausdorff distance: at least" in out and out.endswith("The sets differ.\n")


def test_differences_as_json(folder: Path, capsys: Capture) -> None:
    put("longer.off", cuboid((0, 0, 0), (2, 2, 2.5)))
    code, out, _ = ran(capsys, "compare", "a.off", "longer.off", "--json", "--samples", "100")
    found = json.loads(out)
    assert code == 1 and (found["same"], found["equal"]) == (False, False)
    assert found["hausdorff"] == pytest.approx(0.5) and found["difference"]["volume"] == 2.0


def test_a_tolerance(folder: Path, capsys: Capture) -> None:
    put("longer.off", cuboid((0, 0, 0), (2, 2, 2.001)))
    assert ran(capsys, "compare", "a.off", "longer.off", "--tolerance", "1e-4")[0] == 1
    code, out, _ = ran(capsys, "compare", "a.off", "longer.off", "--tolerance", "0.01")
    assert code == 0 and out.endswith("The sets differ, within the tolerance.\n")


def test_the_tolerance_has_its_old_name_and_units(folder: Path, capsys: Capture) -> None:
    put("longer.off", cuboid((0, 0, 0), (2, 2, 2.001)))
    for given in (
        ["--tol", "0.01"],
        ["--tol=0.01"],
        ["--tolerance", "0.1um"],
        ["--tolerance", "1m"],
    ):
        code = ran(capsys, "compare", "a.off", "longer.off", *given)[0]
        assert code == (given[-1] == "0.1um")
    _, out, _ = ran(capsys, "compare", "--help")
    assert "--tolerance LENGTH" in out and "--tol " not in out


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["a.off"], 2, "Missing argument"),
        (["a.off", "c.stl", "--tolerance", "-1"], 2, "--tol"),
        (["a.off", "c.stl", "--tolerance", "1", "--samples", "0"], 2, "--samples"),
        (["a.off", "none.stl"], 3, "none.stl"),
        (["a.off", "open.off"], 4, "not closed"),
    ],
)
def test_compare_refusals(
    folder: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
    put("open.off", (cube()[0], cube()[1][1:]))
    found, out, err = ran(capsys, "compare", *arguments)
    assert (found, out) == (code, "") and words in err


# split


def test_components(folder: Path, capsys: Capture) -> None:
    put("two.ply", joined(cube(), cuboid((5, 0, 0), (7, 2, 2))))
    code, out, _ = ran(capsys, "split", "two.ply", "-o", "part-%.off")
    assert code == 0 and out.startswith("part-1.off  12 triangles")
    assert [b.load(f"part-{k}.off").volume_exact for k in (1, 2)] == [8, 1]
    assert ran(capsys, "split", "two.ply", "-o", "p.off")[0] == 0
    assert Path("p-1.off").exists() and Path("p-2.off").exists()


@pytest.mark.parametrize("plane", ["z,0.5", "Z, 0.5", "0,0,1,0.5"])
def test_a_plane_across_an_axis(folder: Path, capsys: Capture, plane: str) -> None:
    code, out, _ = ran(capsys, "split", "a.off", "--plane", plane, "-o", "s%.off", "--json")
    assert code == 0 and [one["volume"] for one in json.loads(out)["parts"]] == [2, 6]


def test_a_plane(folder: Path, capsys: Capture) -> None:
    code, out, _ = ran(capsys, "split", "a.off", "--plane", "0,0,1,0.5", "-o", "s%.off", "--json")
    parts = json.loads(out)["parts"]
    assert code == 0 and [part["volume"] for part in parts] == [2.0, 6.0]
    assert [part["check"] for part in parts] == ["agree", "agree"]
    assert b.load("s1.off").bounds.tolist() == [[0, 0, 0], [2, 2, 0.5]]  # type: ignore[union-attr]


def test_another_solid(folder: Path, capsys: Capture) -> None:
    assert ran(capsys, "split", "a.off", "--by", "c.stl", "-o", "s%.off")[0] == 0
    assert [b.load(f"s{k}.off").volume_exact for k in (1, 2)] == [7, 1]


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["a.off", "-o", "-"], 2, "standard output"),
        (["a.off", "-o", "x.off", "--plane", "1,2,3"], 2, "is not a plane"),
        (["a.off", "-o", "x.off", "--plane", "z:1"], 2, "x, y and z are axes"),
        (["a.off", "-o", "x.off", "--plane", "0,0,0,1"], 2, "is not a plane"),
        (["a.off", "-o", "x.off", "--plane", "nan,0,1,1"], 2, "is not a plane"),
        (["a.off", "-o", "x.off", "--plane", "0,0,1,1", "--by", "c.stl"], 2, "cannot be combined"),
        (["a.off", "-o", "x.step"], 3, "STEP"),
        (["none.off", "-o", "x.off"], 3, "none.off"),
        (["a.off", "-o", "x.off", "--plane", "0,0,1,9"], 4, "on one side"),
        (["inverted.off", "-o", "x.off"], 4, "the solid is empty"),
        (["a.off", "-o", "no/x.off"], 5, "does not exist or is not writable"),
    ],
)
def test_split_refusals(
    folder: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
    put("inverted.off", flipped(cube()))
    found, out, err = ran(capsys, "split", *arguments)
    assert (found, out) == (code, "") and words in err
    assert not list(folder.glob("x*"))


# repair


def test_repair(folder: Path, capsys: Capture) -> None:
    put("open.off", (cube(2)[0], cube(2)[1][1:]))
    code, out, _ = ran(capsys, "repair", "open.off", "-o", "closed.off")
    assert code == 0 and out.endswith("closed.off: a solid\n")
    rows = {line.strip().split("  ")[0]: line.split()[-2:] for line in out.splitlines()}
    assert rows["triangles"] == ["11", "12"] and rows["open edges"] == ["3", "0"]
    assert b.load("closed.off").volume_exact == 8


def test_nothing_is_not_repaired(folder: Path, capsys: Capture) -> None:
    Path("none.off").write_text("OFF\n0 0 0\n")
    code, out, err = ran(capsys, "repair", "none.off", "-o", "x.off")
    assert (code, out) == (4, "") and not Path("x.off").exists()
    assert err == "bspcsg: error: none.off: no triangles are left, so nothing was written.\n"


# Found: `repair` and `--on-invalid repair` lost all attributes in silence.
def test_repair_tells_what_it_loses(folder: Path, capsys: Capture) -> None:
    vertices, faces = joined(cube(), moved(cube(), (3, 0, 0)))
    said = Attributes(faces, corner={"color": np.full((24, 3, 4), 0.5)})
    objects = (("lid", 12), ("body", 12))
    write(RawMesh(vertices, faces, objects=objects, attributes=said), "two.3mf")
    code, out, err = ran(capsys, "repair", "two.3mf", "-o", "x.3mf", "--json")
    assert code == 0 and "“color” were left out" in err
    codes = [finding["code"] for finding in json.loads(out)["findings"]]
    assert codes == ["attributes_left_out"]
    assert b.io.read("x.3mf").objects == objects
    write(RawMesh(cube()[0], cube()[1][1:], objects=(("lid", 11),)), "open.3mf")
    code, _, err = ran(capsys, "repair", "open.3mf", "-o", "x.3mf")
    assert (code, err) == (0, "") and b.io.read("x.3mf").objects == (("lid", 12),)


# Found: where a lid rests on a body, `repair` joined them, and their triangles overlapped.
def test_objects_are_repaired_by_themselves(folder: Path, capsys: Capture) -> None:
    lid, body = moved(cube(), (0, 0, 1)), (cube()[0], cube()[1][1:])
    objects = (("lid", 12), ("body", 11))
    write(RawMesh(*joined(lid, body), objects=objects), "two.3mf")
    code, out, _ = ran(capsys, "repair", "two.3mf", "-o", "x.3mf", "--json")
    after = json.loads(out)["after"]
    assert (code, after["manifold"], after["triangles"], after["volume"]) == (0, True, 24, 2)
    assert b.io.read("x.3mf").objects == (("lid", 12), ("body", 12))
    ran(capsys, "union", "two.3mf", "two.3mf", "-o", "u.3mf", "--on-invalid", "repair")
    assert b.load("u.3mf").volume == 2


def test_a_folder_is_repaired(folder: Path, capsys: Capture) -> None:
    Path("in").mkdir()
    put("in/open.off", (cube(2)[0], cube(2)[1][1:]))
    stray = np.array([[9.0, 9, 9], [9, 9, 8], [9, 8, 9]]), np.array([[0, 1, 2]])
    put("in/stray.ply", joined(cube(2), stray))
    Path("in/bad.ply").write_text("ply\n")
    Path("in/a.png").touch()
    code, out, err = ran(capsys, "repair", "in", "--outdir", "new/out")
    assert code == 3 and "error: in/bad.ply" in err and "skipped 1 file" in err
    assert out.splitlines() == [
        "new/out/open.off: a solid; 11 triangles became 12",
        "new/out/stray.ply: a solid; 13 triangles became 12, 1 stray ones removed",
    ]
    assert [b.load(f"new/out/{name}").volume for name in ("open.off", "stray.ply")] == [8, 8]
    code, out, _ = ran(capsys, "repair", "in", "--outdir", "new", "--to", "stl", "--json")
    files = json.loads(out)["files"]
    assert [one.get("dropped") for one in files] == [None, 0, 1] and "error" in files[0]
    assert sorted(path.name for path in Path("new").glob("*.stl")) == ["open.stl", "stray.stl"]


@pytest.mark.parametrize("verb", ["repair", "convert"])
def test_two_inputs_of_one_output_are_refused_first(
    folder: Path, capsys: Capture, verb: str
) -> None:
    for place in ("in", "in/deep"):
        Path(place).mkdir()
        put(f"{place}/a.off", cube(2))
    code, out, err = ran(capsys, verb, "in", "--outdir", "new", "--to", "off")
    assert (code, out) == (2, "") and not Path("new").exists()
    assert "in/a.off and in/deep/a.off would both be written to new/a.off;" in err
    code, _, err = ran(capsys, verb, "in", "--outdir", "in", "--to", "off")
    assert code == 2 and "in/deep/a.off would overwrite in/a.off, which is also an input" in err


def test_repairs_of_inputs_tell_what_they_lose(folder: Path, capsys: Capture) -> None:
    vertices, faces = cube()
    said = Attributes(faces[1:], vertex={"color": np.full((8, 4), 0.5)})
    write(RawMesh(vertices, faces[1:], attributes=said), "open.ply")
    arguments = ("union", "open.ply", "a.off", "-o", "x.ply", "--on-invalid", "repair")
    code, _, err = ran(capsys, *arguments)
    assert code == 0 and "“color” were left out" in err


def test_repair_as_json(folder: Path, capsys: Capture) -> None:
    put("inverted.off", flipped(cube(2)))
    code, out, _ = ran(capsys, "repair", "inverted.off", "-o", "x.off", "--json")
    found = json.loads(out)
    assert code == 0 and found["turned"] == 12
    verdicts = found["before"]["verdict"], found["after"]["verdict"]
    assert verdicts == ("inside out", "solid")


def test_what_cannot_be_repaired_is_code_1(folder: Path, capsys: Capture) -> None:
    put("open.off", (cube(2)[0], cube(2)[1][1:]))
    code, out, _ = ran(capsys, "repair", "open.off", "-o", "x.off", "--steps", "weld,orient")
    assert code == 1 and "still no solid: not closed" in out and Path("x.off").exists()


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["a.off"], 2, "either -o FILE or --outdir DIR"),
        (["a.off", "c.stl", "-o", "x.off"], 2, "or give --outdir"),
        (["a.off", "-o", "x.off", "--steps", "weld,polish"], 2, "'polish' is not a repair step"),
        (["a.off", "-o", "x.off", "--steps", ","], 2, "at least one"),
        (["a.off", "-o", "x.off", "--max-hole", "2"], 2, "--max-hole"),
        (["none.off", "-o", "x.off"], 3, "none.off"),
        (["a.off", "-o", "no/x.off"], 5, "does not exist or is not writable"),
        (["a.off", "-o", "x.off", "--timeout", "0.001"], 124, "time limit of 0.001 s"),
    ],
)
def test_repair_refusals(
    folder: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
    found, out, err = ran(capsys, "repair", *arguments)
    assert (found, out) == (code, "") and words in err and not Path("x.off").exists()


def test_repair_needs_a_part(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "pymeshlab.py").write_text("raise ImportError('libGL.so.1: cannot open')")
    monkeypatch.setenv("PYTHONPATH", str(folder))
    code, _, err = ran(capsys, "repair", "a.off", "-o", "x.off")
    assert code == 6 and "apt-get install" in err and "libgl1 libopengl0" in err


# doctor


def test_doctor(capsys: Capture) -> None:
    code, out, err = ran(capsys, "doctor")
    assert (code, err) == (0, "") and b.__version__ in out and "manifold3d" in out
    found = json.loads(ran(capsys, "doctor", "--json")[1])
    assert found["complete"]
    assert {"numpy", "pymeshlab", "meshio"} <= {part["name"] for part in found["parts"]}


def test_doctor_names_what_is_missing(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "pymeshlab.py").write_text("plugin_number = lambda: 49")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("bspcsg.cli.verbs.doctor.find_spec", lambda name: name != "meshio" or None)
    code, out, _ = ran(capsys, "doctor")
    assert code == 0 and "49 of 58 plug-ins" in out and "libgl1 libopengl0" in out
    # What is missing has the line to type below the sentence.
    said = "meshio is missing; it is needed for VTK and VTU files. Try:\n  pip install"
    assert f'{said} "bspcsg[vtk]"\n' in out
    assert "openscad is missing" in out and out.endswith("\n  apt-get install openscad\n")


def test_doctor_fails_without_what_is_required(
    capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("bspcsg.cli.verbs.doctor.find_spec", lambda name: name != "rich" or None)
    code, out, _ = ran(capsys, "doctor", "--json")
    assert code == 6 and not json.loads(out)["complete"]


@pytest.mark.parametrize("suffix", [".3mf", ".glb"])
@pytest.mark.parametrize(("height", "code"), [(1.0, 0), (0.75, 1)])
def test_check_and_clash_agree(
    folder: Path, capsys: Capture, suffix: str, height: float, code: int
) -> None:
    body, lid = b.box((3, 2, 1)), b.box((3, 2, 0.5)).translate(0, 0, height)
    name = f"box{suffix}"
    b.Assembly("box", [b.Assembly("body", body), b.Assembly("lid", lid)]).save(name)
    assert ran(capsys, "clash", name)[0] == code
    assert ran(capsys, "check", name)[0] == 0
    assert ran(capsys, "check", name, "--strict")[0] == code
    told = ran(capsys, "check", name, "-v")[1]
    assert "box" in told and "\n  lid: solid, 12 triangles" in told
    assert ("volume in common" in told) == bool(code)
    assert ("volume in common" in ran(capsys, "info", name)[1]) == bool(code)


# Found: `check` did not report the files that follow a script with a bad mesh.
def test_check_of_a_bad_script_tells_of_the_others(folder: Path, capsys: Capture) -> None:
    Path("bad.csg").write_text('import("open.stl");')
    b.save(b.cube(1), "good.stl")
    whole = Path("good.stl").read_bytes()
    # Its twelfth triangle is missing.
    Path("open.stl").write_bytes(whole[:80] + (11).to_bytes(4, "little") + whole[84 : 84 + 11 * 50])
    code, out, _ = ran(capsys, "check", "good.stl", "bad.csg", "good.stl", "--json")
    files = json.loads(out)["files"]
    assert code != 0
    assert [one["verdict"] for one in files] == ["solid", "unreadable", "solid"]
    assert files[1]["error"]["code"] == "not_closed"


# Found: `bspcsg --` ended in an `IndexError`.
def test_no_command_behind_two_hyphens(capsys: Capture) -> None:
    code, _, err = ran(capsys, "--")
    assert code == 2 and "Missing command" in err
