"""The empty set in files: our own files are read back; other files without faces are refused."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg.errors import InvalidMeshError
from bspcsg.io import FORMATS, RawMesh, read, write
from support.cli import Capture, put, ran
from support.shapes import cube

FORMS = [(suffix, False) for suffix in FORMATS] + [(".stl", True), (".ply", True)]


# Found: `load` could not read the file that `save` had written of an empty solid.
@pytest.mark.parametrize(("suffix", "text"), FORMS)
def test_save_and_load(tmp_path: Path, suffix: str, text: bool) -> None:
    path = tmp_path / f"x{suffix}"
    (b.cube(2) - b.cube(3)).save(path, text=text)
    assert b.load(path).is_empty and b.Solid.from_mesh(path).is_empty
    assert b.Solid.from_mesh(path.read_bytes(), format=suffix).is_empty
    raw = read(path)
    assert raw.is_empty_set and [finding.code for finding in raw.findings] == ["empty"]


@pytest.mark.parametrize(("suffix", "text"), FORMS)
def test_what_is_not_the_whole_file_is_refused(tmp_path: Path, suffix: str, text: bool) -> None:
    path = tmp_path / f"x{suffix}"
    b.Solid.empty().save(path, text=text)
    data = path.read_bytes()
    for size in range(len(data)):
        path.write_bytes(data[:size])
        with pytest.raises(b.BspcsgError) as caught:
            b.load(path)
        assert caught.value.code not in ("internal", "write_mismatch")


@pytest.mark.parametrize("suffix", [".stl", ".ply", ".off", ".3mf", ".glb"])
def test_a_mesh_that_lost_its_faces_is_not_the_empty_set(tmp_path: Path, suffix: str) -> None:
    write(RawMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64)), tmp_path / f"x{suffix}")
    assert not read(tmp_path / f"x{suffix}").is_empty_set
    with pytest.raises(InvalidMeshError) as caught:
        b.load(tmp_path / f"x{suffix}")
    assert caught.value.code == "empty_mesh"


# Found: an assembly without volume, or a mesh without vertices, was written as an OBJ that cannot
# be read.
def test_an_obj_of_nothing_is_not_written(tmp_path: Path) -> None:
    path = tmp_path / "x.obj"
    nothing = RawMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    assembly = b.Assembly("a", [b.Assembly("part", b.Solid.empty())])
    with pytest.raises(b.FormatError) as of_mesh:
        write(nothing, path)
    with pytest.raises(b.FormatError) as of_assembly:
        assembly.save(path)
    assert of_mesh.value.code == of_assembly.value.code == "empty" and not path.exists()


# Found: an empty mesh of trimesh was not the empty set.
def test_meshes_of_other_libraries() -> None:
    manifold3d, trimesh = pytest.importorskip("manifold3d"), pytest.importorskip("trimesh")
    meshes: list[Any] = [trimesh.Trimesh(), manifold3d.Manifold(), ([], [])]
    for mesh in meshes:
        assert b.Solid.from_mesh(mesh).is_empty
    cloud = trimesh.Trimesh(cube()[0], np.zeros((0, 3), np.int64), process=False)
    with pytest.raises(InvalidMeshError) as caught:
        b.Solid.from_mesh(cloud)
    assert caught.value.code == "empty_mesh"


@pytest.mark.parametrize("suffix", FORMATS)
def test_on_the_command_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture, suffix: str
) -> None:
    monkeypatch.chdir(tmp_path)
    put("a.off", cube())
    name = f"e{suffix}"
    assert ran(capsys, "difference", "a.off", "a.off", "-o", name, "--allow-empty")[0] == 0
    code, _, err = ran(capsys, "union", "a.off", name, "-o", "u.ply")
    assert code == 0 and f"note: {name}: this file represents the empty set" in err
    assert b.load("u.ply").equals(b.Solid(*cube()))
    for other in FORMATS:
        assert ran(capsys, "convert", name, "-o", f"c{other}")[0] == 0
        assert b.load(f"c{other}").is_empty


def test_in_scripts(tmp_path: Path) -> None:
    b.Solid.empty().save(tmp_path / "e.stl")
    (tmp_path / "x.csg").write_text('union() { cube(2); import(file = "e.stl"); }')
    assert b.load(tmp_path / "x.csg").volume == 8


def test_files_without_faces_can_be_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    put("a.off", cube())
    Path("none.off").write_text("OFF\n0 0 0\n")
    given = ("union", "a.off", "none.off", "-o", "u.ply", "--on-invalid", "warn")
    code, _, err = ran(capsys, *given)
    assert code == 0 and "left out" in err and b.load("u.ply").volume == 1
