"""VTK and VTU files through meshio: faces of any kind are read, triangles written."""

import builtins
import sys
import zlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest

import bspcsg as b
from bspcsg.errors import FormatError, MissingPartError
from bspcsg.formats import vtk
from bspcsg.io import RawMesh, read, write
from support.io import cube_mesh, refusal, same_mesh

SUFFIXES = pytest.mark.parametrize("suffix", ["vtk", "vtu"])


@SUFFIXES
def test_every_double_is_kept(tmp_path: Path, suffix: str) -> None:
    mesh = cube_mesh(1 / 3)
    assert write(mesh, tmp_path / f"x.{suffix}") == ()
    same_mesh(read(tmp_path / f"x.{suffix}"), mesh)


@SUFFIXES
def test_concave_faces(tmp_path: Path, suffix: str) -> None:
    outline = [(2, 1), (1, 1), (1, 2), (0, 2), (0, 0), (2, 0)]
    points = np.array([(x, y, z) for z in (0.0, 1.0) for x, y in outline])
    sides = [[k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k] for k in range(6)]
    cells = [
        ("quad", np.array(sides)),
        ("polygon", np.array([list(range(6))[::-1], list(range(6, 12))])),
    ]
    meshio.Mesh(points, cells).write(tmp_path / f"x.{suffix}")
    raw = read(tmp_path / f"x.{suffix}")
    assert b.Solid(raw.vertices, raw.faces).volume_exact == 3
    assert raw.dropped == ("faces of more than three corners",)


def test_volumes_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.vtu"
    meshio.Mesh(np.eye(4)[:, :3], [("tetra", np.array([[0, 1, 2, 3]]))]).write(path)
    said = refusal(path, path.read_bytes(), "unsupported")
    assert "tetra" in said


@SUFFIXES
@pytest.mark.parametrize("part", [0.1, 0.5, 0.95])
def test_truncations(tmp_path: Path, suffix: str, part: float) -> None:
    path = tmp_path / f"x.{suffix}"
    write(RawMesh(*b.sphere(1, segments=12).normalized().to_mesh()), path)
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * part)])
    with pytest.raises(FormatError) as caught:
        read(path)
    assert caught.value.message.startswith(str(path))


def test_document_types_are_refused(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><VTKFile>&b;</VTKFile>'
    refusal(tmp_path / "x.vtu", bomb, "syntax")


def test_packed_bombs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(vtk, "_MAX_UNPACKED_BYTES", 1 << 10)
    path = tmp_path / "x.vtu"
    ball = b.sphere(1, segments=24).normalized().to_mesh()
    write(RawMesh(ball.vertices, ball.faces), path)
    assert "unpack to more than" in refusal(path, path.read_bytes(), "syntax")


def test_lzma_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.vtu"
    vertices, faces = cube_mesh().vertices, cube_mesh().faces
    meshio.vtu.write(path, meshio.Mesh(vertices, [("triangle", faces)]), compression="lzma")
    assert "LZMA" in refusal(path, path.read_bytes(), "syntax")


def test_huge_counts(tmp_path: Path) -> None:
    head = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    text = head + "POINTS 999999999999 double\n"
    refusal(tmp_path / "x.vtk", text, "syntax")


def test_without_meshio(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plain = builtins.__import__

    def refusing(name: str, *rest: Any, **more: Any) -> Any:
        if name == "meshio":
            raise ImportError(name)
        return plain(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", refusing)
    with pytest.raises(MissingPartError, match=r"pip install \"bspcsg\[vtk\]\""):
        write(cube_mesh(), tmp_path / "x.vtk")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("depth", [1000, 300_000])
def test_deep_xml_is_no_harm(tmp_path: Path, depth: int) -> None:
    deep = "<VTKFile>" * depth
    refusal(tmp_path / "open.vtu", deep, "syntax")
    refusal(tmp_path / "deep.vtu", deep + "</VTKFile>" * depth, "syntax")


# Found: two threads that read VTK files took the output of the process away; DXF written by
# several had other bytes.
def test_threads_may_read_and_write_at_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What meshio says is kept back, and nothing else; streams and zlib are those of before."""
    good, bad = tmp_path / "good.vtu", tmp_path / "bad.vtk"
    write(cube_mesh(1.0), good)
    bad.write_text("no grid")
    streams = sys.stdout, sys.stderr

    def work(number: int) -> None:
        assert len(read(good).faces) == 12
        write(cube_mesh(1.0), tmp_path / f"{number}.vtu")
        sys.stdout.write(f"<{number}>\n")
        with pytest.raises(FormatError):
            read(bad)

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(work, range(40)))
    assert (sys.stdout, sys.stderr) == streams
    from meshio.vtu import _vtu

    assert _vtu.zlib is zlib
    out, err = capsys.readouterr()
    assert sorted(out.split()) == sorted(f"<{number}>" for number in range(40)) and err == ""
