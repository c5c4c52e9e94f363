"""STL in both forms: detection, exact welding, and refusals."""

import struct
from pathlib import Path

import numpy as np
import pytest

from bspcsg.errors import FormatError
from bspcsg.io import RawMesh, read, write
from support.io import cube_mesh, read_text, refusal, same_mesh


def binary_stl(corners: object, header: bytes = b"", promised: int | None = None) -> bytes:
    triangles = np.asarray(corners, dtype="<f4").reshape(-1, 9)
    count = len(triangles) if promised is None else promised
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *row, 0) for row in triangles.tolist())
    return header.ljust(80, b"\0") + struct.pack("<I", count) + body


def cube_corners() -> object:
    mesh = cube_mesh()
    return mesh.vertices[mesh.faces]


@pytest.mark.parametrize("text", [False, True])
def test_round_trip(tmp_path: Path, text: bool) -> None:
    path = tmp_path / "cube.stl"
    assert write(cube_mesh(), path, text=text) == ()
    same_mesh(read(path), cube_mesh())


def test_text_keeps_every_digit(tmp_path: Path) -> None:
    mesh = cube_mesh(1 / 3)
    write(mesh, tmp_path / "cube.stl", text=True)
    same_mesh(read(tmp_path / "cube.stl"), mesh)


def test_binary_that_begins_with_solid(tmp_path: Path) -> None:
    path = tmp_path / "cube.stl"
    path.write_bytes(binary_stl(cube_corners(), b"solid made by somebody"))
    raw = read(path)
    assert (len(raw.vertices), len(raw.faces), raw.name) == (8, 12, "solid made by somebody")


def test_truncated_binary_that_begins_with_solid(tmp_path: Path) -> None:
    message = refusal(tmp_path / "cut.stl", binary_stl(cube_corners(), b"solid")[:-70], "truncated")
    assert "ends in triangle 10" in message and "says 12" in message


@pytest.mark.parametrize("size", [1, 79, 83, 84, 133, 683])
def test_truncated_binary(tmp_path: Path, size: int) -> None:
    refusal(tmp_path / "cut.stl", binary_stl(cube_corners())[:size], "truncated")


def test_count_of_zero_with_data(tmp_path: Path) -> None:
    refusal(tmp_path / "zero.stl", binary_stl(cube_corners(), promised=0), "syntax")


def test_bytes_after_the_end_are_reported(tmp_path: Path) -> None:
    path = tmp_path / "cube.stl"
    path.write_bytes(binary_stl(cube_corners()) + b"colour table")
    (finding,) = read(path).findings
    assert (finding.code, finding.count) == ("extra_data", 12)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_not_finite(tmp_path: Path, value: float) -> None:
    corners = np.asarray(cube_corners()).copy()
    corners[7, 1, 2] = value
    assert "triangle 7" in refusal(tmp_path / "bad.stl", binary_stl(corners), "non_finite")


def test_zeros_of_both_signs_are_one_vertex(tmp_path: Path) -> None:
    corners = np.asarray(cube_corners()).copy()
    corners[::2][corners[::2] == 0] = -0.0
    path = tmp_path / "zeros.stl"
    path.write_bytes(binary_stl(corners))
    raw = read(path)
    assert len(raw.vertices) == 8
    assert not np.signbit(raw.vertices[raw.vertices == 0]).any()


def test_nearly_equal_is_not_equal(tmp_path: Path) -> None:
    corners = np.asarray(cube_corners(), dtype=np.float32).copy()
    corners[0, 0, 0] = np.nextafter(np.float32(corners[0, 0, 0]), np.float32(9))
    path = tmp_path / "near.stl"
    path.write_bytes(binary_stl(corners))
    assert len(read(path).vertices) == 9


ONE_FACET = b"""solid part one
 facet normal 0 0 nan
  OUTER LOOP
   vertex 0 0 0
   vertex 1 0 0
   vertex 0 1e0 0.
  endloop
 endfacet
endsolid part one
"""


def test_several_solids_are_one_mesh(tmp_path: Path) -> None:
    path = tmp_path / "two.stl"
    path.write_bytes(ONE_FACET + ONE_FACET.replace(b"0 0 0", b"0 0 5").replace(b"\n", b"\r\n"))
    raw = read(path)
    assert (len(raw.vertices), len(raw.faces), raw.name) == (4, 2, "part one")


@pytest.mark.parametrize("lines", [1, 2, 3, 5, 6, 7, 8])
def test_truncated_text(tmp_path: Path, lines: int) -> None:
    cut = b"\n".join(ONE_FACET.splitlines()[:lines])
    assert f"cut.stl:{lines}:" in refusal(tmp_path / "cut.stl", cut, "truncated")


@pytest.mark.parametrize(
    ("old", "new", "line", "code"),
    [
        (b"1 0 0", b"1 0", 5, "syntax"),
        (b"1 0 0", b"1 zero 0", 5, "syntax"),
        (b"1 0 0", b"1 nan 0", 5, "non_finite"),
        (b"1 0 0", b"1 1e999 0", 5, "non_finite"),
        (b"  endloop", b"  vertex 1 1 0", 7, "syntax"),
        (b" endfacet\n", b"", 8, "syntax"),
    ],
)
def test_errors_name_the_line(tmp_path: Path, old: bytes, new: bytes, line: int, code: str) -> None:
    assert f":{line}:" in refusal(tmp_path / "bad.stl", ONE_FACET.replace(old, new), code)


def test_no_stl_at_all(tmp_path: Path) -> None:
    refusal(tmp_path / "page.stl", b"<html>not found</html>", "truncated")


def test_single_precision_is_reported(tmp_path: Path) -> None:
    (finding,) = write(cube_mesh(0.1), tmp_path / "cube.stl")
    assert finding.code == "single_precision"


def test_merging_by_rounding_is_reported(tmp_path: Path) -> None:
    mesh = cube_mesh()
    vertices = mesh.vertices.copy()
    vertices[vertices[:, 0] > 0, 0] = 1e-9
    findings = write(RawMesh(vertices + 1000, mesh.faces), tmp_path / "thin.stl")
    assert [finding.code for finding in findings] == [
        "single_precision",
        "merged_by_rounding",
        "flattened_by_rounding",
    ]
    # Four corners merge with the other four; the triangles of four sides are left as lines.
    assert [finding.count for finding in findings[1:]] == [4, 8]


def test_beyond_single_precision(tmp_path: Path) -> None:
    with pytest.raises(FormatError) as caught:
        write(cube_mesh(1e300), tmp_path / "huge.stl")
    assert caught.value.code == "too_large"
    assert list(tmp_path.iterdir()) == []


# Found: the colour of the whole in the header of a binary STL was lost in silence, and became
# part of the name.
@pytest.mark.parametrize("title", [b"", b"part "])
def test_the_colour_in_a_header_is_told(tmp_path: Path, title: bytes) -> None:
    path = tmp_path / "x.stl"
    path.write_bytes(binary_stl(cube_corners(), title + b"COLOR=\xff\x80\x80\xff,MATERIAL="))
    raw = read(path)
    assert (raw.name, raw.dropped) == (title.decode().strip() or "x", ("colours",))


def test_names_of_solids_that_are_no_utf_8_stay_apart(tmp_path: Path) -> None:
    write(cube_mesh(), tmp_path / "x.stl", text=True)
    one = (tmp_path / "x.stl").read_bytes()
    two = b"".join(one.replace(b"cube", name) for name in (b"\xe4", b"\xf6"))
    raw = read_text(tmp_path / "y.stl", two)
    assert raw.objects == (("ä", 12), ("ö", 12))


def with_bytes(sizes: list[int], said: list[int] | None = None) -> bytes:
    """Return a binary STL cube with attribute bytes after its triangles, and stated counts."""
    plain = binary_stl(cube_corners())
    rows = [plain[84 + 50 * k : 132 + 50 * k] for k in range(12)]
    counts = sizes if said is None else said
    told = [struct.pack("<H", count) for count in counts]
    parts = (row + count + b"x" * size for row, count, size in zip(rows, told, sizes, strict=True))
    return plain[:84] + b"".join(parts)


# Found: triangles that attribute bytes follow, as the format has it, were read at wrong places.
@pytest.mark.parametrize(
    "sizes",
    [
        [2] * 12,
        [7] * 12,
        [50] * 12,
        [10] + [0] * 11,
        [0] * 11 + [10],
        [0] * 5 + [50] + [0] * 6,
        [*range(12)],
        [*range(12, 0, -1)],
        [65535] + [0] * 11,
        [0, 1] * 6,
    ],
)
def test_attribute_bytes(tmp_path: Path, sizes: list[int]) -> None:
    raw = read_text(tmp_path / "cube.stl", with_bytes(sizes))
    same_mesh(raw, cube_mesh())
    assert (raw.findings, raw.dropped) == ((), ("attribute bytes",))


@pytest.mark.parametrize(
    ("sizes", "said"),
    [
        ([0] * 11 + [7], [31] * 12),
        ([0] * 11 + [7], [0] * 11 + [6]),
        ([0] * 11 + [7], [0] * 11 + [8]),
        ([0] * 12, [31] * 12),
    ],
)
def test_colours_are_no_lengths(tmp_path: Path, sizes: list[int], said: list[int]) -> None:
    raw = read_text(tmp_path / "cube.stl", with_bytes(sizes, said))
    same_mesh(raw, cube_mesh())
    assert raw.dropped == ("colours",)
    assert [found.count for found in raw.findings] == [7] * any(sizes)


def test_bad_numbers_behind_attribute_bytes_are_told_where_they_are(tmp_path: Path) -> None:
    data = bytearray(with_bytes([3] * 12))
    start = 84 + 53 * 7
    data[start + 12 : start + 16] = struct.pack("<f", np.nan)
    message = refusal(tmp_path / "cube.stl", bytes(data), "non_finite")
    assert f"at byte {start}: triangle 7" in message
