"""OBJ: references of all kinds, polygons, continued lines, and what is refused."""

import math
from pathlib import Path

import numpy as np
import pytest

from bspcsg.errors import held
from bspcsg.io import read, write
from support.io import area, cube_mesh, read_text, refusal, same_mesh, signed_area

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def test_round_trip(tmp_path: Path) -> None:
    write(cube_mesh(1 / 3), tmp_path / "cube.obj")
    same_mesh(read(tmp_path / "cube.obj"), cube_mesh(1 / 3))


@pytest.mark.parametrize(
    "face",
    [
        "f 1 2 3",
        "f 1/7 2/8 3/9",
        "f 1//7 2//8 3//9",
        "f 1/7/7 2/8/8 3/9/9",
        "f -4 -3 -2",
        "f -4/-1/-1 2 -2//-1",
        "\tf   1 2\\\n 3",
        "f 1 \\\n2 \\\n3  # said in three lines",
    ],
)
def test_references(tmp_path: Path, face: str) -> None:
    text = f"# a comment\nmtllib x.mtl\no thing\ng a b\ns off\n{SQUARE}vn 0 0 1\nvt 0 0\n{face}\n"
    raw = read_text(tmp_path / "x.obj", text)
    assert raw.faces.tolist() == [[0, 1, 2]]
    assert raw.name == "thing"


def test_negative_references_count_from_where_they_stand(tmp_path: Path) -> None:
    triangle = "v {0} 0 0\nv {0} 1 0\nv {0} 0 1\nf -3 -2 -1\n"
    raw = read_text(tmp_path / "x.obj", triangle.format(0) + triangle.format(1))
    assert raw.faces.tolist() == [[0, 1, 2], [3, 4, 5]]


def test_negative_references_to_texture_and_normal_count_from_where_they_stand(
    tmp_path: Path,
) -> None:
    rows = "v {0} 0 0\nv {0} 1 0\nv {0} 0 1\nvt {0} 0\nvt {0} 1\nvn {0} 0 1\n"
    face = "f -3/-2/-1 -2/-1/-1 -1/-3/-1\n"  # the third names no texture the first time
    texts = (rows.format(number) + face for number in (0, 5))
    corner = held(read_text(tmp_path / "x.obj", "".join(texts)).attributes, "said").corner
    nowhere = [math.nan, math.nan]
    expected = [[[0, 0], [0, 1], nowhere], [[5, 0], [5, 1], [0, 1]]]
    np.testing.assert_array_equal(corner["uv"], expected)
    np.testing.assert_array_equal(corner["normal"][:, 0, 0], [0, 5])


def test_colours_and_weights_are_passed_by(tmp_path: Path) -> None:
    text = "v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 1 1 0 .1 .2 .3 1\nf 1 2 3\n"
    assert read_text(tmp_path / "x.obj", text).vertices.shape == (3, 3)


@pytest.mark.parametrize("start", range(6))
@pytest.mark.parametrize("backwards", [False, True])
def test_concave_polygon_from_any_corner(tmp_path: Path, start: int, backwards: bool) -> None:
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    corners = [*range(start, 6), *range(start)]
    corners = corners[::-1] if backwards else corners
    text = "".join(f"v {x} {y} 0\n" for x, y in outline)
    raw = read_text(tmp_path / "l.obj", text + "f " + " ".join(str(c + 1) for c in corners))
    assert len(raw.faces) == 4
    assert signed_area(raw) == (-3 if backwards else 3)
    assert area(raw) == 3


def test_concave_quad(tmp_path: Path) -> None:
    # An arrow head: only the diagonal through the notch lies inside.
    text = "v 0 0 0\nv 2 -1 0\nv 1 0 0\nv 2 1 0\n"
    for start in range(4):
        face = " ".join(str((start + k) % 4 + 1) for k in range(4))
        raw = read_text(tmp_path / "arrow.obj", f"{text}f {face}\n")
        assert (signed_area(raw), area(raw)) == (1, 1)


def test_polygons_far_out_keep_their_shape(tmp_path: Path) -> None:
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    text = "".join(f"v {x + 1e9} {y + 3e9} 7e8\n" for x, y in outline)
    raw = read_text(tmp_path / "far.obj", text + "f 2 3 4 5 6 1\n")
    assert (signed_area(raw), area(raw)) == (3, 3)


def test_mixed_polygons_keep_their_order(tmp_path: Path) -> None:
    raw = read_text(tmp_path / "x.obj", SQUARE + "f 1 2 3 4\nf 1 2 3\nf 4 3 2 1\n")
    assert len(raw.faces) == 5
    assert raw.faces[2].tolist() == [0, 1, 2]


@pytest.mark.parametrize(
    ("text", "line", "code"),
    [
        (SQUARE + "f 1 2 5\n", 5, "index_out_of_range"),
        (SQUARE + "f 1 2 0\n", 5, "index_out_of_range"),
        (SQUARE + "f -1 -2 -5\n", 5, "index_out_of_range"),
        (SQUARE + "f 1 2 99999999999999999999999\n", 5, "index_out_of_range"),
        (SQUARE + "f 1 2\n", 5, "syntax"),
        (SQUARE + "f\n", 5, "syntax"),
        (SQUARE + "f 1 2 x\n", 5, "syntax"),
        (SQUARE + "f 1 2 1.5\n", 5, "syntax"),
        ("v 0 0\nf 1 1 1\n", 1, "syntax"),
        ("v 0 0 zero\n", 1, "syntax"),
        ("v 0 0 0\nv 0 nan 0\n", 2, "non_finite"),
        ("v 0 0 0\nv 0 -inf 0\n", 2, "non_finite"),
        (SQUARE + "f 1 2 3 \\", 5, "truncated"),
    ],
)
def test_errors_name_the_line(tmp_path: Path, text: str, line: int, code: str) -> None:
    assert f"x.obj:{line}:" in refusal(tmp_path / "x.obj", text, code)


def test_no_mesh_at_all(tmp_path: Path) -> None:
    refusal(tmp_path / "x.obj", "# only a comment\n", "syntax")


def test_curves_are_reported(tmp_path: Path) -> None:
    raw = read_text(tmp_path / "x.obj", SQUARE + "cstype bezier\nf 1 2 3\n")
    assert [finding.code for finding in raw.findings] == ["curves_ignored"]
