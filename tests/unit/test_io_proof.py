"""Files are verified before they are renamed: after damage of any kind the old file remains."""

import dataclasses
import io
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from bspcsg.errors import FormatError
from bspcsg.formats.blocks import ROWS_PER_FILE_BLOCK
from bspcsg.formats.registry import MAKERS, Form
from bspcsg.io import FORMATS, RawMesh, encoded, read, write
from bspcsg.mesh.mesh import Mesh
from support.io import cube_mesh
from support.shapes import cube, icosphere, joined, moved

FORMS = [(suffix, False) for suffix in FORMATS] + [(".stl", True), (".ply", True)]
NAMED = [(".stl", True), (".obj", False), (".3mf", False), (".glb", False)]

Chunks = Iterator[bytes]
Written = Mesh | RawMesh


def assembly() -> RawMesh:
    """Return three bodies, two of which have one name; the ball's corners are no short decimals."""
    bodies = joined(icosphere(1), moved(cube(0.3), (3, 0, 0)), moved(cube(), (0.1, 5, 0)))
    return RawMesh(*bodies, objects=(("lid", 80), ("body", 12), ("lid", 12)))


def form_of(suffix: str, text: bool) -> Form:
    form = FORMATS[suffix].text if text else FORMATS[suffix].binary or FORMATS[suffix].text
    assert form is not None
    return form


def encode_with(
    monkeypatch: pytest.MonkeyPatch, suffix: str, text: bool, encode: Callable[[Written], Chunks]
) -> None:
    """Replace the function that encodes a format."""
    form, known = form_of(suffix, text), FORMATS[suffix]
    other = dataclasses.replace(form, encode=encode)
    is_text = text or known.binary is None
    text_form, binary = (other, known.binary) if is_text else (known.text, other)
    changed = dataclasses.replace(known, text=text_form, binary=binary)
    monkeypatch.setitem(MAKERS, suffix, lambda: changed)


def changed_mesh(edit: Callable[[RawMesh], RawMesh]) -> Callable[[Form], Callable[..., Chunks]]:
    return lambda form: lambda mesh: form.encode(edit(mesh))


def changed_bytes(edit: Callable[[bytes], bytes]) -> Callable[[Form], Callable[..., Chunks]]:
    return lambda form: lambda mesh: iter([edit(b"".join(form.encode(mesh)))])


def with_faces(mesh: RawMesh, faces: "np.ndarray[tuple[int, int], np.dtype[np.int64]]") -> RawMesh:
    return dataclasses.replace(mesh, faces=faces)


def without_triangle(mesh: RawMesh) -> RawMesh:
    objects = (("lid", 80), ("body", 11), ("lid", 12))
    return RawMesh(mesh.vertices, np.delete(mesh.faces, 85, axis=0), objects=objects)


def without_object(mesh: RawMesh) -> RawMesh:
    return RawMesh(mesh.vertices, mesh.faces[:92], objects=mesh.objects[:2])


def flipped(mesh: RawMesh) -> RawMesh:
    faces = mesh.faces.copy()
    faces[90] = faces[90, ::-1]
    return with_faces(mesh, faces)


def repeated(mesh: RawMesh) -> RawMesh:
    faces = mesh.faces.copy()
    faces[90] = faces[91]
    return with_faces(mesh, faces)


def nudged(mesh: RawMesh) -> RawMesh:
    vertices = mesh.vertices.copy()
    vertices[3, 1] = np.nextafter(np.float32(vertices[3, 1]), np.float32(9))
    return dataclasses.replace(mesh, vertices=vertices)


FAULTS = {
    "a triangle less": changed_mesh(without_triangle),
    "an object less": changed_mesh(without_object),
    "a triangle turned round": changed_mesh(flipped),
    "a triangle twice": changed_mesh(repeated),
    "a coordinate off by one place": changed_mesh(nudged),
    "cut off": changed_bytes(lambda data: data[: len(data) * 2 // 3]),
    "cut off at the end": changed_bytes(lambda data: data[:-30]),
    "nothing": changed_bytes(lambda data: b""),
    "no triangles": changed_mesh(lambda mesh: with_faces(mesh, mesh.faces[:0])),
}


@pytest.mark.parametrize(("suffix", "text"), FORMS)
@pytest.mark.parametrize("fault", FAULTS)
def test_faults_are_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str, text: bool, fault: str
) -> None:
    path = tmp_path / f"x{suffix}"
    path.write_bytes(b"as it was")
    encode_with(monkeypatch, suffix, text, FAULTS[fault](form_of(suffix, text)))
    with pytest.raises(FormatError) as caught:
        write(assembly(), path, text=text)
    expected = {"write_mismatch", "unwritable"} if fault == "no triangles" else {"write_mismatch"}
    assert caught.value.code in expected
    assert caught.value.message.startswith((str(path), "The mesh has no faces"))
    assert path.read_bytes() == b"as it was" and list(tmp_path.iterdir()) == [path]


class Watched(io.BytesIO):
    """A file that records how many bytes are read at once."""

    def __init__(self, data: bytes) -> None:
        super().__init__(data)
        self.pieces: list[int] = []

    def read(self, count: int | None = -1, /) -> bytes:
        data = super().read(count)
        self.pieces.append(len(data))
        return data


@pytest.mark.parametrize("more", [b"7", b"f 1 2 3\n", b"3 0 1 2\n"])
@pytest.mark.parametrize(("suffix", "text"), FORMS)
def test_files_end_where_the_mesh_ends(suffix: str, text: bool, more: bytes) -> None:
    made = encoded(assembly(), "x", suffix, text)
    data = b"".join(made.chunks)
    if suffix in (".3mf", ".glb"):  # which say themselves where they end
        made.prove(io.BytesIO(data + more))
        return
    with pytest.raises(FormatError) as caught:
        made.prove(io.BytesIO(data + more))
    assert caught.value.code == "write_mismatch"


@pytest.mark.parametrize("suffix", [".off", ".ply"])
def test_text_is_read_once_and_in_pieces(suffix: str) -> None:
    """A file that is compared while it is written never lies in memory as a whole."""
    made = encoded(RawMesh(*icosphere(6)), "x", suffix, text=True)
    file = Watched(b"".join(made.chunks))
    made.prove(file)
    size = file.seek(0, io.SEEK_END)
    assert size < sum(file.pieces) < size + 2 * max(file.pieces)
    assert max(file.pieces) < size / 8


@pytest.mark.parametrize(("suffix", "text"), NAMED)
def test_objects_that_change_places_are_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str, text: bool
) -> None:
    def renamed(mesh: RawMesh) -> RawMesh:
        return dataclasses.replace(mesh, objects=(("lid", 80), ("lid", 12), ("body", 12)))

    def regrouped(mesh: RawMesh) -> RawMesh:
        return dataclasses.replace(mesh, objects=(("lid", 80), ("body", 13), ("lid", 11)))

    for edit, words in ((renamed, "is called “lid”"), (regrouped, "13 triangles in “body”")):
        with monkeypatch.context() as patch:
            encode_with(patch, suffix, text, changed_mesh(edit)(form_of(suffix, text)))
            with pytest.raises(FormatError, match=words) as caught:
                write(assembly(), tmp_path / f"x{suffix}", text=text)
        assert caught.value.code == "write_mismatch" and not list(tmp_path.iterdir())


@pytest.mark.parametrize(("suffix", "text"), FORMS)
def test_every_byte_of_the_triangles_is_read(suffix: str, text: bool) -> None:
    """A change of any byte leaves the very same arrays, or is found."""
    mesh = cube_mesh(0.1)
    made = encoded(mesh, "x", suffix, text)
    data = b"".join(made.chunks)
    made.prove(io.BytesIO(data))
    found = 0
    for at in range(0, len(data), 7):
        changed = bytearray(data)
        changed[at] ^= 2
        try:
            made.prove(io.BytesIO(changed))
        except FormatError as error:
            assert error.code == "write_mismatch"
            found += 1
    assert found > len(data) // 7 * {".stl": 0.6, ".glb": 0.4, ".vtk": 0.4, ".vtu": 0.3}.get(
        suffix, 0.7
    )


@pytest.mark.parametrize("suffix", [".ply", ".vtk"])
def test_files_in_binary_are_read_once_and_in_pieces(suffix: str) -> None:
    """What is read fits into a processor's cache: fresh memory takes longer than the proof."""
    mesh = RawMesh(*icosphere(7))
    made = encoded(mesh, "x", suffix)
    file = Watched(b"".join(made.chunks))
    made.prove(file)
    size = file.seek(0, io.SEEK_END)
    lines = 1 << 14
    assert size < sum(file.pieces) < size + lines
    assert max(file.pieces) <= 24 * ROWS_PER_FILE_BLOCK < size / 4


def test_the_first_triangle_that_differs_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    encode_with(monkeypatch, ".off", False, changed_mesh(flipped)(form_of(".off", False)))
    with pytest.raises(FormatError) as caught:
        write(assembly(), tmp_path / "x.off")
    assert caught.value.where == (90,)


@pytest.mark.parametrize("suffix", FORMATS)
@pytest.mark.parametrize(
    ("vertices", "faces", "code"),
    [
        ([(0, 0, 0), (1, 0, 0), (0, float("nan"), 0)], [(0, 1, 2)], "non_finite"),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 3)], "index_out_of_range"),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, -1)], "index_out_of_range"),
    ],
)
def test_what_no_file_can_hold(
    tmp_path: Path,
    suffix: str,
    vertices: list[tuple[float, ...]],
    faces: list[tuple[int, ...]],
    code: str,
) -> None:
    mesh = RawMesh(np.array(vertices, dtype=np.float64), np.array(faces, dtype=np.int64))
    with pytest.raises(FormatError) as caught:
        write(mesh, tmp_path / f"x{suffix}")
    assert caught.value.code == code and not list(tmp_path.iterdir())


@pytest.mark.parametrize(("suffix", "text"), FORMS)
def test_sizes_at_the_ends_of_what_a_format_holds(tmp_path: Path, suffix: str, text: bool) -> None:
    is_single = suffix == ".glb" or (suffix == ".stl" and not text)
    for size in (3e38, 1e-45) if is_single else (1.7e308, 5e-324, 1e-7, 123456789.123):
        mesh = RawMesh(np.array([(size, 0, 0), (0, -size, 0), (0, 0, 0.0)]), np.array([[0, 1, 2]]))
        write(mesh, tmp_path / f"x{suffix}", text=text)
        if suffix != ".glb":  # whose metres become millimetres by a product
            kept = mesh.vertices.astype(np.float32) if is_single else mesh.vertices
            assert read(tmp_path / f"x{suffix}").vertices.tolist() == kept.tolist()
