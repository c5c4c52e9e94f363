"""Suffixes, missing and unwritable files, atomic writing, and real files."""

import csv
import dataclasses
import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from bspcsg.errors import FormatError
from bspcsg.formats.atomic import write_file
from bspcsg.formats.registry import MAKERS
from bspcsg.io import FORMATS, RawMesh, decoded, read, write
from bspcsg.mesh.weld import welded
from support import DEEP, draw
from support.io import cube_mesh


@pytest.mark.parametrize("name", ["x.stp", "x", "x.stl.gz", ".stl"])
def test_unknown_suffix_comes_before_any_work(tmp_path: Path, name: str) -> None:
    with pytest.raises(FormatError) as caught:
        read(tmp_path / name)
    assert caught.value.code == "unknown_format"
    with pytest.raises(FormatError) as caught:
        write(cube_mesh(), tmp_path / name)
    assert caught.value.code == "unknown_format"
    assert list(tmp_path.iterdir()) == []


def test_suffix_in_capitals(tmp_path: Path) -> None:
    write(cube_mesh(), tmp_path / "CUBE.STL")
    assert read(tmp_path / "CUBE.STL").name == "bspcsg"


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "off", "3mf"])
def test_empty_and_missing_files(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"x.{suffix}"
    with pytest.raises(FormatError) as caught:
        read(path)
    assert caught.value.code == "unreadable"
    path.touch()
    with pytest.raises(FormatError) as caught:
        read(path)
    assert caught.value.code == "empty_file"


POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:%s\nsize 4213\n" % (b"0f" * 32)


def refused_pointer(call: Callable[[], object], name: object) -> None:
    with pytest.raises(FormatError) as caught:
        call()
    assert caught.value.code == "unreadable"
    assert caught.value.message.startswith(f"{name}: the file is a Git LFS pointer")
    assert "git lfs pull" in caught.value.message


# Found: a pointer file of Git LFS was reported as a truncated mesh, or as an OBJ without vertices.
@pytest.mark.parametrize("suffix", FORMATS)
@pytest.mark.parametrize(
    "data", [POINTER, POINTER.replace(b"\n", b"\r\n"), POINTER.replace(b"git-lfs", b"hawser")]
)
def test_pointers_of_git_lfs_are_named(tmp_path: Path, suffix: str, data: bytes) -> None:
    path = tmp_path / f"x{suffix}"
    path.write_bytes(data)
    refused_pointer(lambda: read(path), path)
    refused_pointer(lambda: decoded("-", data, suffix), "-")


@pytest.mark.parametrize(
    ("name", "load"),
    [
        ("x.csg", b.load),
        ("x.svg", bsp.load_svg),
        ("x.dxf", bsp.load_dxf),
        ("x.json", bsp.PartitionTree.load),
        ("x.3mf", b.Assembly.load),
        ("x.glb", b.Assembly.load),
        ("x.obj", b.Assembly.load),
    ],
)
def test_pointers_in_place_of_scripts_and_drawings(
    tmp_path: Path, name: str, load: Callable[[Path], object]
) -> None:
    path = tmp_path / name
    path.write_bytes(POINTER)
    refused_pointer(lambda: load(path), path)


def test_materials_that_are_pointers_are_told(tmp_path: Path) -> None:
    text = "mtllib x.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n"
    (tmp_path / "x.obj").write_text(text)
    (tmp_path / "x.mtl").write_bytes(POINTER)
    (told,) = read(tmp_path / "x.obj").passed_by
    assert "x.mtl" in told


def test_what_begins_as_a_pointer_does_may_be_a_mesh(tmp_path: Path) -> None:
    write(cube_mesh(), tmp_path / "x.stl")
    data = (tmp_path / "x.stl").read_bytes()
    head = POINTER[: len(POINTER) // 2].ljust(80)[:80]
    data = head + data[80:84] + data[84:] + bytes(1000)
    assert len(decoded("x.stl", data, ".stl").faces) == 12


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply", "off", "3mf"])
def test_rubbish_is_refused(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"x.{suffix}"
    rng = np.random.default_rng(1)
    for size in (1, 7, 84, 500):
        path.write_bytes(rng.bytes(size))
        with pytest.raises(FormatError):
            read(path)


def test_a_folder_is_no_file(tmp_path: Path) -> None:
    folder = tmp_path / "x.stl"
    folder.mkdir()
    with pytest.raises(FormatError) as caught:
        read(folder)
    assert caught.value.code == "unreadable"
    with pytest.raises(FormatError) as caught:
        write(cube_mesh(), folder)
    assert caught.value.code == "unwritable"


def test_no_such_folder(tmp_path: Path) -> None:
    with pytest.raises(FormatError) as caught:
        write(cube_mesh(), tmp_path / "no" / "x.stl")
    assert caught.value.code == "unwritable"


def test_failure_leaves_the_old_file(tmp_path: Path) -> None:
    def chunks() -> Iterator[bytes]:
        yield b"half"
        raise KeyboardInterrupt

    path = tmp_path / "x.off"
    path.write_bytes(b"old")
    with pytest.raises(KeyboardInterrupt):
        write_file(path, chunks())
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["x.off"]


def test_a_file_is_proved_while_it_is_written(tmp_path: Path) -> None:
    path, made = tmp_path / "x", []

    def chunks() -> Iterator[bytes]:
        for number in range(5):
            made.append(number)
            yield bytes([number]) * 10_000

    def prove(file: BinaryIO) -> None:
        assert file.read(5) == bytes(5) and made == [0]
        file.seek(25_000)
        assert file.read(2) == bytes([2, 2]) and made[-1] < 4
        assert file.seek(0, os.SEEK_END) == 50_000 and file.tell() == 50_000
        file.seek(0)
        assert file.read() == b"".join(bytes([number]) * 10_000 for number in range(5))

    write_file(path, chunks(), prove)
    assert made == list(range(5)) and path.stat().st_size == 50_000


def test_what_no_proof_reads_is_written(tmp_path: Path) -> None:
    write_file(tmp_path / "x", [b"a", b"b" * 100_000, b"c"], lambda file: None)
    assert (tmp_path / "x").read_bytes() == b"a" + b"b" * 100_000 + b"c"


@pytest.mark.parametrize("error", [OSError(28, "no room"), ValueError("no"), KeyboardInterrupt()])
def test_what_stops_the_writing_is_no_fault_of_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    def chunks(mesh: object) -> Iterator[bytes]:
        yield b"ply\n"
        raise error

    known = FORMATS[".ply"]
    assert known.binary is not None
    changed = dataclasses.replace(known, binary=dataclasses.replace(known.binary, encode=chunks))
    monkeypatch.setitem(MAKERS, ".ply", lambda: changed)
    kind = FormatError if isinstance(error, OSError) else type(error)
    with pytest.raises(kind) as caught:
        write(cube_mesh(), tmp_path / "x.ply")
    assert getattr(caught.value, "code", "unwritable") == "unwritable"
    assert not list(tmp_path.iterdir())


def test_a_file_that_changes_on_its_way_to_the_disk_is_proved_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def flip(handle: int) -> None:
        # Longer than the clock of file systems takes for a step.
        time.sleep(0.05)
        os.lseek(handle, 300, os.SEEK_SET)
        os.write(handle, b"\xff")

    monkeypatch.setattr(os, "fsync", flip)
    with pytest.raises(FormatError) as caught:
        write(cube_mesh(), tmp_path / "x.ply")
    assert caught.value.code == "write_mismatch" and not list(tmp_path.iterdir())


def test_mode_and_link_are_kept(tmp_path: Path) -> None:
    target, link = tmp_path / "target.off", tmp_path / "link.off"
    target.touch(mode=0o640)
    target.chmod(0o640)
    link.symlink_to(target)
    write(cube_mesh(), link)
    assert link.is_symlink()
    assert target.stat().st_mode & 0o777 == 0o640
    assert len(read(target).faces) == 12


def test_new_files_follow_the_mask(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        write(cube_mesh(), tmp_path / "x.off")
    finally:
        os.umask(before)
    assert (tmp_path / "x.off").stat().st_mode & 0o777 == 0o640


@pytest.mark.parametrize("suffix", ["obj", "ply", "off"])
def test_extreme_doubles_survive(tmp_path: Path, suffix: str) -> None:
    values = [5e-324, 1.7976931348623157e308, -0.0, 0.1, 1 / 3, 1e16 + 2, 2**53 + 2.0, -1e-7, 1e22]
    mesh = RawMesh(np.array(values).reshape(3, 3), np.array([[0, 1, 2]]))
    write(mesh, tmp_path / f"x.{suffix}")
    assert read(tmp_path / f"x.{suffix}").vertices.tobytes() == mesh.vertices.tobytes()


def test_welding_keeps_the_first_of_each() -> None:
    points = np.array([(1.0, 0, 0), (0.0, 0, 0), (1.0, 0, 0), (-0.0, 0, 0), (0, 0, 1)])
    vertices, which = welded(points)
    assert vertices.tolist() == [[1, 0, 0], [0, 0, 0], [0, 0, 1]]
    assert which.tolist() == [0, 1, 0, 1, 2]


def test_real_files(shared_meshes: Path) -> None:
    with open(shared_meshes / "MANIFEST.tsv", newline="") as table:
        rows = list(csv.DictReader(table, delimiter="\t"))
    assert len(rows) > 100
    for row in rows if DEEP else rows[draw("real files", 4) :: 4]:
        raw = read(shared_meshes / row["file"])
        found = len(raw.vertices), len(raw.faces)
        assert found == (int(row["n_vertices"]), int(row["n_triangles"])), row["file"]


# Found: writing to `/dev/stdout` and other open pipes by name was refused as “No such file or
# directory”.
@pytest.mark.skipif(not Path("/dev/fd").is_dir(), reason="needs names of open files")
def test_open_pipes_are_no_ordinary_files() -> None:
    read_end, write_end = os.pipe()
    try:
        with pytest.raises(FormatError, match="does not name an ordinary file"):
            write_file(f"/dev/fd/{write_end}", [b"x"])
    finally:
        os.close(read_end)
        os.close(write_end)
