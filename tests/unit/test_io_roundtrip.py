"""Files read back as they were written: sets, names, units; losses are reported."""

import zipfile
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg.io import FORMATS, RawMesh, read, write
from bspcsg.verify.roundtrip import losses_between
from support.io import cube_mesh, read_text, same_mesh
from support.shapes import cube, icosphere, joined, moved

EXACT = [(suffix, False) for suffix in FORMATS if suffix not in (".stl", ".glb")] + [(".stl", True)]


@pytest.mark.parametrize(("suffix", "text"), EXACT)
def test_exact_formats_give_the_same_set(tmp_path: Path, suffix: str, text: bool) -> None:
    part = (b.sphere(10 / 3, segments=12) - b.cube(2).rotate(30)).normalized().to_mesh()
    path = tmp_path / f"x{suffix}"
    assert write(part, path, text=text) == ()
    assert b.load(path).equals(b.Solid(part.vertices, part.faces))
    assert not losses_between(RawMesh(part.vertices, part.faces), read(path)).any


@pytest.mark.parametrize("suffix", [".stl", ".glb"])
def test_single_formats_give_the_rounded_set(tmp_path: Path, suffix: str) -> None:
    part = (b.sphere(10 / 3, segments=12) - b.cube(2).rotate(30)).normalized().to_mesh()
    rounded = part.vertices.astype(np.float32).astype(np.float64)
    path = tmp_path / f"x{suffix}"
    write(part, path)
    assert b.load(path).equals(b.Solid(rounded, part.faces))
    lost = losses_between(RawMesh(part.vertices, part.faces), read(path))
    assert lost.shift is not None and 0 < lost.shift < 1e-6
    assert len(lost.sentences()) == 1 and "coordinates changed" in lost.sentences()[0]


@pytest.mark.parametrize("suffix", [".3mf", ".glb", ".obj", ".stl"])
def test_names_of_objects(tmp_path: Path, suffix: str) -> None:
    objects = (('<lid> & "body"', 12), ("zweites Stück", 12))
    mesh = RawMesh(*joined(cube(), moved(cube(), (3, 0, 0))), objects=objects)
    write(mesh, tmp_path / f"x{suffix}", text=suffix == ".stl")
    assert read(tmp_path / f"x{suffix}").objects == objects


def test_names_that_are_gone_are_told(tmp_path: Path) -> None:
    objects = (("lid", 12), ("body", 12))
    mesh = RawMesh(*joined(cube(), moved(cube(), (3, 0, 0))), objects=objects)
    write(mesh, tmp_path / "x.ply")
    lost = losses_between(mesh, read(tmp_path / "x.ply"))
    assert lost.names == ("lid", "body") and lost.any
    assert lost.sentences() == ["names of objects: “lid”, “body”"]


def test_3mf_says_millimetres_and_nothing_else(tmp_path: Path) -> None:
    write(cube_mesh(25.4), tmp_path / "x.3mf")
    with zipfile.ZipFile(tmp_path / "x.3mf") as archive:
        xml = archive.read("3D/3dmodel.model").decode()
        assert archive.testzip() is None
    assert 'unit="millimeter"' in xml and "transform" not in xml
    raw = read(tmp_path / "x.3mf")
    same_mesh(raw, cube_mesh(25.4))
    assert raw.unit == "mm"


def test_3mf_is_the_same_every_time(tmp_path: Path) -> None:
    for name in ("x.3mf", "y.3mf"):
        write(cube_mesh(), tmp_path / name)
    assert (tmp_path / "x.3mf").read_bytes() == (tmp_path / "y.3mf").read_bytes()


def test_3mf_as_trimesh_reads_it(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("lxml")
    write(RawMesh(*icosphere(1)), tmp_path / "x.3mf")
    scene = trimesh.load_scene(tmp_path / "x.3mf")
    assert scene.to_mesh().volume == pytest.approx(b.Solid(*icosphere(1)).volume, rel=1e-8)


def test_3mf_has_no_repeated_corners(tmp_path: Path) -> None:
    vertices, faces = cube()
    mesh = RawMesh(vertices, np.concatenate([faces, [[0, 1, 1]]]))
    assert [finding.code for finding in write(mesh, tmp_path / "x.3mf")] == ["degenerate"]
    raw = read(tmp_path / "x.3mf")
    assert len(raw.faces) == 12
    assert "12 triangles instead of 13" in losses_between(mesh, raw).sentences()


def test_names_xml_cannot_hold(tmp_path: Path) -> None:
    mesh = RawMesh(*cube(), name="a\x00\ud800b")
    write(mesh, tmp_path / "x.3mf")
    assert read(tmp_path / "x.3mf").objects == (("a\ufffd\ufffdb", 12),)


OBJ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


@pytest.mark.parametrize(
    ("name", "text", "dropped"),
    [
        (
            "x.obj",
            OBJ + "f 1 2 3\nl 1 2\np 1\n",
            "lines points",
        ),
        ("x.obj", OBJ + "f 1 2 3 4\n", "faces of more than three corners"),
        ("x.obj", OBJ.replace("0 0 0\n", "0 0 0 1 0 0\n") + "f 1 2 3\n", "colours"),
        ("x.off", "NOFF\n3 1 0\n0 0 0 1 0 0\n1 0 0 1 0 0\n0 1 0 1 0 0\n3 0 1 2\n", "vertices"),
        ("x.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0\n", "colours of faces"),
    ],
)
def test_what_triangles_do_not_keep(tmp_path: Path, name: str, text: str, dropped: str) -> None:
    raw = read_text(tmp_path / name, text)
    said = " ".join(raw.dropped)
    assert all(word in said for word in dropped.split())
    assert losses_between(raw, raw).any


def test_triangles_alone_lose_nothing(tmp_path: Path) -> None:
    raw = read_text(tmp_path / "x.obj", OBJ + "f 1 2 3\nf 1 3 4\n")
    assert raw.dropped == () and not losses_between(raw, raw).any


def test_a_solid_that_is_none_any_more() -> None:
    vertices, faces = cube()
    lost = losses_between(RawMesh(vertices, faces), RawMesh(vertices, faces[1:]))
    assert lost.solid == (True, False) and "no longer a solid" in lost.sentences()
    assert lost.shift is None and lost.volume[0] == 1


@pytest.mark.parametrize(("suffix", "word"), [("step", "STEP"), ("igs", "IGES"), ("amf", "3MF")])
def test_formats_not_for_us_get_a_sentence(tmp_path: Path, suffix: str, word: str) -> None:
    with pytest.raises(b.FormatError) as caught:
        read(tmp_path / f"x.{suffix}")
    assert caught.value.code == "unknown_format" and word in caught.value.message
