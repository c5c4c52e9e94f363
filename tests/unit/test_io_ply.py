"""PLY in its three forms, with all number types, polygons and additional properties."""

import struct
from pathlib import Path

import numpy as np
import pytest

from bspcsg.errors import not_none
from bspcsg.io import RawMesh, decoded, read, write
from support.io import cube_mesh, read_text, refusal, same_mesh, signed_area

OUTLINE = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
FACES = [(1, 2, 3, 0), (4, 5, 0), (0, 3, 4)]


def header(form: str, number: str = "double", lists: str = "uchar int", extra: str = "") -> str:
    axes = "".join(f"property {number} {axis}\n" for axis in "xyz")
    return (
        f"ply\nformat {form} 1.0\ncomment by hand\nobj_info x\nelement vertex 6\n{axes}{extra}"
        f"element face 3\nproperty list {lists} vertex_index\n"
    )


def binary(order: str, number: str = "d", count: str = "B", item: str = "i") -> bytes:
    points = b"".join(struct.pack(f"{order}3{number}", x, y, 0) for x, y in OUTLINE)
    faces = b"".join(
        struct.pack(f"{order}{count}{len(face)}{item}", len(face), *face) for face in FACES
    )
    return points + faces


def text_body() -> str:
    points = "".join(f"{x} {y} 0\n" for x, y in OUTLINE)
    return points + "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in FACES)


@pytest.mark.parametrize("text", [False, True])
def test_round_trip(tmp_path: Path, text: bool) -> None:
    write(cube_mesh(1 / 3), tmp_path / "cube.ply", text=text)
    same_mesh(read(tmp_path / "cube.ply"), cube_mesh(1 / 3))


@pytest.mark.parametrize(("order", "name"), [("<", "little"), (">", "big")])
@pytest.mark.parametrize(("number", "n"), [("double", "d"), ("float32", "f"), ("short", "h")])
@pytest.mark.parametrize(("count", "c"), [("uchar", "B"), ("int8", "b"), ("uint", "I")])
@pytest.mark.parametrize(("item", "i"), [("int", "i"), ("uint16", "H"), ("uchar", "B")])
def test_binary_types(
    tmp_path: Path,
    order: str,
    name: str,
    number: str,
    n: str,
    count: str,
    c: str,
    item: str,
    i: str,
) -> None:
    head = header(f"binary_{name}_endian", number, f"{count} {item}") + "end_header\n"
    raw = read_text(tmp_path / "x.ply", head.encode() + binary(order, n, c, i))
    assert (len(raw.faces), signed_area(raw), raw.findings) == (4, 3, ())


@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
def test_text(tmp_path: Path, line_end: str) -> None:
    text = (header("ascii") + "end_header\n" + text_body()).replace("\n", line_end)
    raw = read_text(tmp_path / "x.ply", text)
    assert (len(raw.faces), signed_area(raw)) == (4, 3)


def test_further_elements_and_properties(tmp_path: Path) -> None:
    head = (
        header("binary_big_endian", extra="property uchar red\n").replace(
            "element vertex",
            "element note 2\nproperty list uint float a\nproperty char b\nelement vertex",
        )
        + "property float quality\nelement edge 1\nproperty int a\nend_header\n"
    )
    notes = struct.pack(">I2fb", 2, 1.0, 2.0, 3) + struct.pack(">Ib", 0, 4)
    points = b"".join(struct.pack(">3dB", x, y, 0, 255) for x, y in OUTLINE)
    faces = b"".join(struct.pack(f">B{len(f)}if", len(f), *f, 0.5) for f in FACES)
    raw = read_text(tmp_path / "x.ply", head.encode() + notes + points + faces + bytes(4))
    assert (len(raw.faces), signed_area(raw), raw.findings) == (4, 3, ())


@pytest.mark.parametrize("cut", [1, 4, 12, 20, 60, 170])
def test_truncated_binary(tmp_path: Path, cut: int) -> None:
    data = (header("binary_little_endian") + "end_header\n").encode() + binary("<")
    message = refusal(tmp_path / "x.ply", data[:-cut], "truncated")
    assert f"at byte {len(data) - cut}" in message


def test_truncated_uniform_lists(tmp_path: Path) -> None:
    write(cube_mesh(), tmp_path / "cube.ply")
    data = (tmp_path / "cube.ply").read_bytes()
    assert "10 of 12" in refusal(tmp_path / "x.ply", data[:-20], "truncated")


@pytest.mark.parametrize("lines", [2, 3, 5, 9, 10])
def test_truncated_header(tmp_path: Path, lines: int) -> None:
    head = "\n".join(header("ascii").splitlines()[:lines])
    refusal(tmp_path / "x.ply", head, "truncated")


def test_truncated_text(tmp_path: Path) -> None:
    text = header("ascii") + "end_header\n" + "\n".join(text_body().splitlines()[:-1])
    assert "2 of the 3" in refusal(tmp_path / "x.ply", text, "truncated")


@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ("2 1 0", "2 nan 0", "non_finite"),
        ("2 1 0", "2 1", "syntax"),
        ("2 1 0", "2 1 x", "syntax"),
        ("4 1 2 3 0", "4 1 2 3 6", "index_out_of_range"),
        ("4 1 2 3 0", "4 1 2 3 -1", "index_out_of_range"),
        ("4 1 2 3 0", "5 1 2 3 0", "syntax"),
        ("4 1 2 3 0", "3 1 2 3 0", "syntax"),
        ("4 1 2 3 0", "-4 1 2 3 0", "syntax"),
        ("4 1 2 3 0", "4 1 2 3 0.5", "syntax"),
        ("4 1 2 3 0", "4 1 2 3 99999999999999999999", "syntax"),
        ("4 1 2 3 0", "1 1", "syntax"),
        ("format ascii", "format morse", "syntax"),
        ("element vertex 6", "element vertex many", "syntax"),
        ("element vertex 6", "element vertex \N{SUPERSCRIPT TWO}", "syntax"),
        ("element vertex 6", "element vertex 999999999999999", "truncated"),
        ("property double y", "property real y", "syntax"),
        ("property double y", "property double", "syntax"),
        ("property double y", "property double why", "syntax"),
        ("property list uchar int", "property list float int", "syntax"),
        ("property list uchar int", "property list uchar float", "syntax"),
        ("vertex_index", "corners", "syntax"),
        ("element face", "element polygons", "syntax"),
        ("comment by hand", "coment by hand", "syntax"),
        ("ply\n", "plx\n", "syntax"),
    ],
)
def test_errors(tmp_path: Path, old: str, new: str, code: str) -> None:
    text = header("ascii") + "end_header\n" + text_body()
    assert old in text
    refusal(tmp_path / "x.ply", text.replace(old, new, 1), code)


def test_binary_coordinate_that_is_not_finite(tmp_path: Path) -> None:
    head = (header("binary_little_endian") + "end_header\n").encode()
    data = bytearray(head + binary("<"))
    struct.pack_into("<d", data, len(head) + 24 * 4 + 8, float("inf"))
    assert "vertex 4" in refusal(tmp_path / "x.ply", bytes(data), "non_finite")


def test_negative_length_of_a_list(tmp_path: Path) -> None:
    head = (header("binary_little_endian", lists="char int") + "end_header\n").encode()
    data = bytearray(head + binary("<", count="b"))
    data[len(head) + 24 * 6] = 0xFF
    refusal(tmp_path / "x.ply", bytes(data), "syntax")


def test_huge_promises_cost_nothing(tmp_path: Path) -> None:
    head = header("binary_little_endian", lists="uint int") + "end_header\n"
    data = head.encode() + binary("<", count="I")[: 24 * 6] + struct.pack("<I", 2**32 - 1)
    refusal(tmp_path / "x.ply", data, "truncated")
    refusal(
        tmp_path / "y.ply", head.replace("face 3", "face 99999999999999999").encode(), "truncated"
    )


def test_data_after_the_end(tmp_path: Path) -> None:
    data = (header("binary_little_endian") + "end_header\n").encode() + binary("<")
    assert read_text(tmp_path / "x.ply", data + b"\n").findings == ()
    findings = read_text(tmp_path / "y.ply", data + b"more").findings
    assert [(finding.code, finding.count) for finding in findings] == [("extra_data", 4)]


def read_square(vertex: str, faces: str, rows: str, lines: str) -> RawMesh:
    """Return a square read from a PLY file with additional vertex properties and these faces."""
    corners = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"]
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    text = (
        f"ply\nformat ascii 1.0\nelement vertex 4\n{axes}{vertex}"
        f"element face {lines.count(chr(10))}\nproperty list uchar int vertex_indices\n{faces}"
        f"end_header\n{''.join(f'{corner} {rows}{chr(10)}' for corner in corners)}{lines}"
    )
    return decoded("x.ply", text.encode(), ".ply")


COLOUR = "property uchar red\nproperty uchar green\nproperty uchar blue\n"
PLACES = "property list uchar float texcoord\n"


# Found: colours of faces of a PLY whose vertices have colours, and lists that do not go with the
# corners, vanished while `convert` said that nothing was lost.
def test_colours_that_two_elements_have_are_told() -> None:
    raw = read_square(COLOUR, COLOUR, "255 0 0", "3 0 1 2 0 0 255\n3 0 2 3 0 0 255\n")
    assert not_none(raw.attributes, "said").vertex["color"].tolist() == [[255, 0, 0]] * 4
    assert raw.dropped == ("face properties red, green, blue",)


# Found: texture coordinates on polygons of a PLY were lost.
@pytest.mark.parametrize("quad", [(0, 1, 2, 3), (3, 0, 1, 2)])
def test_texture_coordinates_of_polygons_are_kept(quad: tuple[int, ...]) -> None:
    places = {0: "0 0", 1: "1 0", 2: "1 1", 3: "0 1"}
    line = f"4 {' '.join(map(str, quad))} 8 {' '.join(places[k] for k in quad)}\n"
    raw = read_square("", PLACES, "", line)
    uv = not_none(raw.attributes, "said").corner["uv"]
    np.testing.assert_array_equal(uv, raw.vertices[raw.faces][..., :2])
    assert raw.dropped == ("faces of more than three corners",)


@pytest.mark.parametrize(
    "lines", ["3 0 1 2 7 0 0 1 0 1 1 0\n", "3 0 1 2 6 0 0 1 0 1 1\n4 0 1 2 3 8 0 0 1 0 1 1 0 1\n"]
)
def test_lists_that_do_not_go_with_the_corners_are_told(lines: str) -> None:
    assert "face properties texcoord" in read_square("", PLACES, "", lines).dropped


# Found: `u` and `v` beside `s` and `t` vanished in silence.
def test_texture_coordinates_of_two_names_are_both_kept() -> None:
    columns = "".join(f"property float {name}\n" for name in "uvst")
    vertex = not_none(read_square(columns, "", "1 2 3 4", "3 0 1 2\n").attributes, "said").vertex
    assert vertex["uv"].tolist() == [[3, 4]] * 4
    assert (vertex["u"].tolist(), vertex["v"].tolist()) == ([1] * 4, [2] * 4)


# Found: a picture that a PLY names in a comment was passed by in silence.
def test_pictures_that_comments_name_are_told() -> None:
    raw = read_square("comment TextureFile my pic.png\n", "", "", "3 0 1 2\n")
    assert raw.dropped == ("the picture “my pic.png”",)


# Found: a binary PLY whose vertices have lists was said to have no vertices.
@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
def test_lists_of_vertices_are_refused_as_such(tmp_path: Path, form: str) -> None:
    text = header(form, extra="property list uchar int friends\n") + "end_header\n"
    body = "0 0 0 0\n" * 6 if form == "ascii" else "\0" * 25 * 6
    message = refusal(tmp_path / "x.ply", text + body + "3 0 1 2\n" * 3, "syntax")
    assert "the vertices have list properties, which are not supported" in message


# Found: of a PLY that has the faces or the vertices in two blocks, the first was lost in silence.
@pytest.mark.parametrize("name", ["vertex", "face"])
def test_an_element_of_two_blocks_is_refused(tmp_path: Path, name: str) -> None:
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    blocks = {
        "vertex": (f"element vertex 4\n{axes}", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"),
        "face": (
            "element face 2\nproperty list uchar int vertex_indices\n",
            "3 0 2 1\n3 0 1 3\n",
        ),
    }
    told = [blocks[one] for one in sorted(["vertex", "face", name], reverse=True)]
    heads, data = ("".join(parts) for parts in zip(*told, strict=True))
    text = f"ply\nformat ascii 1.0\n{heads}end_header\n{data}"
    assert name in refusal(tmp_path / "x.ply", text, "syntax")
