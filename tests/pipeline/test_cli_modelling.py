"""The commands that shape and take apart: hull, simplify, project, explode, clash."""

import json
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg.bsp import Region
from support.cli import Capture, put, ran
from support.shapes import cuboid, joined


def test_a_hull_of_files(folder: Path, capsys: Capture) -> None:
    code, out, err = ran(capsys, "hull", "a.off", "c.stl", "-o", "x.ply")
    assert (code, err) == (0, "") and out.startswith("x.ply  ") and "check" not in out
    assert b.load("x.ply") == b.hull(b.cube(2), b.cube(2).translate(1, 1, 1))
    code, out, _ = ran(capsys, "hull", "a.off", "-o", "y.off", "--json")
    assert code == 0 and json.loads(out)["operation"] == "hull" and json.loads(out)["volume"] == 8


def test_a_simple_file(folder: Path, capsys: Capture) -> None:
    put("bump.off", joined(cuboid((0, 0, 0), (2, 2, 2)), cuboid((0.5, 0.5, 1), (1, 1, 2.0001))))
    command = ["simplify", "bump.off", "-o", "x.off", "--tolerance", "0.01mm"]
    code, out, err = ran(capsys, *command)
    assert code == 0 and "short edges and slivers were removed" in err
    assert b.load("x.off").volume == pytest.approx(8, abs=1e-3) and "volume 8" in out
    code, _, err = ran(capsys, "simplify", "a.off", "-o", "y.off", "--tolerance", "0.01")
    assert code == 0 and "small enough to be simplified" in err and b.load("y.off") == b.cube(2)


@pytest.mark.parametrize("name", ["x.svg", "x.dxf"])
def test_a_shadow(folder: Path, capsys: Capture, name: str) -> None:
    put("two.off", joined(cuboid((0, 0, 0), (2, 2, 2)), cuboid((1, 1, 5), (3, 3, 6))))
    code, out, _ = ran(capsys, "project", "two.off", "-o", name)
    assert code == 0 and out.startswith(f"{name}  area 7  1 outline, 0 holes among them  ")
    read = Region.from_svg(name) if name == "x.svg" else Region.from_dxf(name)
    assert read == Region.rectangle(2, 2) | Region.rectangle(2, 2).translate(1, 1)
    code, out, _ = ran(capsys, "project", "two.off", "-o", name, "--json")
    assert json.loads(out)["bounds"] == [[0, 0], [3, 3]]


def test_parts_of_several_files(folder: Path, capsys: Capture) -> None:
    put("two.off", joined(cuboid((0, 0, 0), (1, 1, 1)), cuboid((5, 0, 0), (7, 2, 2))))
    code, out, _ = ran(capsys, "split", "two.off", "a.off", "-o", "part-%.stl")
    assert code == 0 and [line.split()[0] for line in out.splitlines()] == [
        "part-two-1.stl",
        "part-two-2.stl",
        "part-a-1.stl",
    ]
    assert [b.load(f"part-two-{k}.stl").volume for k in (1, 2)] == [8, 1]
    code, out, _ = ran(
        capsys, "split", "two.off", "a.off", "--plane", "z,0.5", "-o", "%.ply", "--json"
    )
    parts = json.loads(out)["parts"]
    assert code == 0 and [part["volume"] for part in parts] == [2.5, 6.5, 2, 6]
    assert [part["file"] for part in parts] == ["two.off"] * 2 + ["a.off"] * 2


def test_the_former_name_of_split_keeps_its_names_of_files(folder: Path, capsys: Capture) -> None:
    put("two.off", joined(cuboid((0, 0, 0), (1, 1, 1)), cuboid((5, 0, 0), (7, 2, 2))))
    code, out, err = ran(capsys, "explode", "two.off", "-o", "%.ply", "--json")
    assert (
        code == 0 and err.startswith("note: explode is now called split;") and err.count("\n") == 1
    )
    assert [part["output"] for part in json.loads(out)["parts"]] == ["two-1.ply", "two-2.ply"]


# Found: `split` overwrote its inputs with parts.
def test_parts_do_not_replace_inputs(folder: Path, capsys: Capture) -> None:
    put("two.off", joined(cuboid((0, 0, 0), (1, 1, 1)), cuboid((5, 0, 0), (7, 2, 2))))
    put("two-2.off", cuboid((0, 0, 0), (3, 1, 1)))
    code, out, err = ran(capsys, "split", "two.off", "two-2.off", "-o", "%.off")
    assert (code, out) == (2, "") and not Path("two-1.off").exists()
    assert "part 2 of two.off would overwrite two-2.off, which is also an input" in err
    code, out, err = ran(capsys, "split", "two-2.off", "-o", "two-%.off", "--plane", "x,1")
    assert (code, out) == (2, "") and not Path("two-1.off").exists()
    assert "part 2 of two-2.off would overwrite two-2.off, which is also an input" in err
    assert b.load("two-2.off").volume == 3


def test_nothing_is_written_if_a_file_has_no_parts(folder: Path, capsys: Capture) -> None:
    Path("none.off").write_text("OFF\n0 0 0\n")
    code, out, err = ran(capsys, "split", "a.off", "none.off", "-o", "x-%.stl")
    assert code == 4 and out == "" and "none.off" in err and not list(Path().glob("x-*"))


def test_who_is_in_whose_way(folder: Path, capsys: Capture) -> None:
    put("far.off", cuboid((5, 0, 0), (6, 1, 1)))
    put("beside.off", cuboid((2, 0, 0), (3, 1, 1)))
    files = ["a.off", "c.stl", "far.off", "beside.off"]
    code, out, err = ran(capsys, "clash", *files)
    assert (code, err) == (1, "") and "a.off, c.stl" in out and "far.off" not in out
    assert out.endswith("6 pairs of files, 1 in each other's way.\n")
    code, out, _ = ran(capsys, "clash", *files, "--clearance", "2.5mm", "--json")
    found = {tuple(one["files"]): one for one in json.loads(out)["clashes"]}
    assert code == 1 and set(found) == {
        ("a.off", "c.stl"),
        ("a.off", "beside.off"),
        ("c.stl", "far.off"),
        ("c.stl", "beside.off"),
        ("far.off", "beside.off"),
    }
    common = found["a.off", "c.stl"]
    assert (common["volume"], common["gap"], common["place"]) == (1, 0, [1.5, 1.5, 1.5])
    gap = found["far.off", "beside.off"]
    assert (gap["volume"], gap["gap"], gap["place"][0]) == (0, 2, 4)


def boxes() -> b.Assembly:
    nut = b.box(2, 2, 2)
    moved = b.Assembly("nut", nut).translate(1, 1, 1)
    return b.Assembly(
        "all", [b.Assembly("nut", nut), moved, b.Assembly("rod", nut.translate(9, 0, 0))]
    )


@pytest.mark.parametrize("name", ["all.3mf", "all.glb", "all.obj"])
def test_objects_of_one_file_are_in_each_others_way(
    name: str, folder: Path, capsys: Capture
) -> None:
    boxes().save(name)
    code, out, err = ran(capsys, "clash", name, "--json")
    (found,) = json.loads(out)["clashes"]
    assert (code, err) == (1, "") and found["volume"] == pytest.approx(1)
    assert sorted(Path(one).name for one in found["objects"]) == ["nut", "nut (2)"]
    code, out, err = ran(capsys, "clash", name)
    assert out.endswith("3 pairs of objects, 1 in each other's way.\n")
    unit = ["--unit", "cm", "--clearance", "8cm"]
    code, out, err = ran(capsys, "clash", name, *unit, "--json")
    volumes = [one["volume"] for one in json.loads(out)["clashes"]]
    assert len(volumes) == 3
    assert max(volumes) == pytest.approx(1000 if name == "all.obj" else 1)


def test_parts_of_one_script_are_in_each_others_way(folder: Path, capsys: Capture) -> None:
    Path("two.csg").write_text("cube(2); multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0]]) cube(2);")
    code, out, _ = ran(capsys, "clash", "two.csg")
    assert code == 1 and "1 pair of objects, 1 in each other's way" in out


# Found: `clash` of one file ignored `--from`.
@pytest.mark.parametrize("suffix", ["3mf", "glb", "obj", "csg"])
def test_objects_of_one_file_of_another_name_clash(
    suffix: str, folder: Path, capsys: Capture
) -> None:
    boxes().save(f"all.{suffix}")
    Path(f"all.{suffix}").rename("all.part")
    code, out, err = ran(capsys, "clash", "all.part", "--from", suffix)
    assert (code, err) == (1, "") and "3 pairs of objects, 1 in each other's way" in out
    code, _, err = ran(capsys, "clash", "all.part", "--from", "json")
    assert code == 2 and "ends in .json" in err


def test_one_object_cannot_clash(folder: Path, capsys: Capture) -> None:
    code, _, err = ran(capsys, "clash", "a.off")
    assert code == 2 and "a.off contains one object only" in err
    boxes().save("all.3mf")
    code, _, err = ran(capsys, "clash", "all.3mf", "--on-invalid", "repair")
    assert code == 2 and "several closed objects" in err


def test_nobody_is_in_the_way(folder: Path, capsys: Capture) -> None:
    put("far.off", cuboid((5, 0, 0), (6, 1, 1)))
    code, out, _ = ran(capsys, "clash", "a.off", "far.off")
    assert (code, out) == (0, "1 pair of files, none clashes.\n")
    code, out, _ = ran(capsys, "clash", "a.off", "far.off", "--clearance", "3", "--json")
    assert code == 0 and json.loads(out)["clashes"] == []


# Found: `repair --digits` called a file a solid although rounding had broken it.
def test_repair_judges_what_it_writes(folder: Path, capsys: Capture) -> None:
    small = (b.cube(0.3).translate(1, 1, 1)).to_mesh()
    b.save(b.Solid(small.vertices, small.faces), "dig.ply")
    assert ran(capsys, "repair", "dig.ply", "-o", "kept.ply")[0] == 0
    # All corners become (1, 1, 1).
    assert ran(capsys, "repair", "dig.ply", "-o", "dig1.ply", "--digits", "1")[0] == 1
    assert ran(capsys, "check", "dig1.ply")[0] == 1
