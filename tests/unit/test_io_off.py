"""OFF and its variants."""

from pathlib import Path

import pytest

from bspcsg.io import read, write
from support.io import cube_mesh, read_text, refusal, same_mesh, signed_area

BODY = "0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n6 5 0 1 2 3 4\n"


def test_round_trip(tmp_path: Path) -> None:
    write(cube_mesh(1 / 3), tmp_path / "cube.off")
    same_mesh(read(tmp_path / "cube.off"), cube_mesh(1 / 3))


@pytest.mark.parametrize(
    "head",
    [
        "OFF\n6 1 0\n",
        "OFF 6 1 0\n",
        "6 1 0\n",
        "OFF\n6 1\n",
        "# hm\n\noff # x\n# y\n 6 1 9 # z\n\n",
    ],
)
def test_headers_and_concave_polygon(tmp_path: Path, head: str) -> None:
    raw = read_text(tmp_path / "x.off", head + BODY)
    assert (len(raw.faces), signed_area(raw)) == (4, 3)


@pytest.mark.parametrize(
    ("keyword", "extra"),
    [
        ("COFF", "255 0 0 255"),
        ("NOFF", "0 0 1"),
        ("STOFF", ".5 .5"),
        ("STCNOFF", "1 1 1 1 0 0 1 0 0"),
    ],
)
def test_kin(tmp_path: Path, keyword: str, extra: str) -> None:
    points = "".join(f"{xyz} {extra}\n" for xyz in ("0 0 0", "1 0 0", "0 1 0"))
    raw = read_text(tmp_path / "x.off", f"{keyword}\n3 1 0\n{points}3 0 1 2 0.5 0.5 0.5 1.0\n")
    assert raw.faces.tolist() == [[0, 1, 2]]
    assert raw.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


@pytest.mark.parametrize(
    ("text", "line", "code"),
    [
        ("OFF\n7 1 0\n" + BODY, 9, "truncated"),
        ("OFF\n6 1 0\n" + BODY[:-14], 8, "truncated"),
        ("OFF\n", 1, "syntax"),
        ("OFF\n6\n" + BODY, 2, "syntax"),
        ("OFF\n-6 1 0\n" + BODY, 2, "syntax"),
        ("OFF\n999999999999999999999 1 0\n" + BODY, 9, "truncated"),
        ("ON\n6 1 0\n" + BODY, 1, "syntax"),
        ("4OFF\n6 1 0\n" + BODY, 1, "syntax"),
        ("nOFF\n6 1 0\n" + BODY, 1, "syntax"),
        ("OFF BINARY\n6 1 0\n" + BODY, 1, "syntax"),
        ("OFF\n6 1 0\n" + BODY.replace("2 1 0", "2 1"), 5, "syntax"),
        ("OFF\n6 1 0\n" + BODY.replace("2 1 0", "2 nan 0"), 5, "non_finite"),
        ("OFF\n6 1 0\n" + BODY.replace("6 5", "6 6"), 9, "index_out_of_range"),
        ("OFF\n6 1 0\n" + BODY.replace("6 5", "6 -1"), 9, "index_out_of_range"),
        ("OFF\n6 1 0\n" + BODY.replace("6 5", "6 9999999999999999999999"), 9, "index_out_of_range"),
        ("OFF\n6 1 0\n" + BODY.replace("6 5", "7 5"), 9, "syntax"),
        ("OFF\n6 1 0\n" + BODY.replace("6 5", "2 5"), 9, "syntax"),
        ("OFF\n6 1 0\n" + BODY.replace("6 5", "six 5"), 9, "syntax"),
    ],
)
def test_errors_name_the_line(tmp_path: Path, text: str, line: int, code: str) -> None:
    assert f"x.off:{line}:" in refusal(tmp_path / "x.off", text, code)


def test_lines_after_the_end_are_reported(tmp_path: Path) -> None:
    raw = read_text(tmp_path / "x.off", "OFF\n6 1 0\n" + BODY + "1 2 3\n")
    assert [(finding.code, finding.count) for finding in raw.findings] == [("extra_data", 1)]


def test_no_faces_is_a_mesh_of_none(tmp_path: Path) -> None:
    assert len(read_text(tmp_path / "x.off", "OFF\n0 0 0\n").faces) == 0


# Found: an OFF whose numbers are not on a line for each vertex and face was said to be cut off.
@pytest.mark.parametrize("between", [" ", "\n", "\n\n# x\n"])
@pytest.mark.parametrize("head", ["OFF 6 1 0", "OFF\n6 1 0", "6 1 0"])
def test_numbers_may_stand_on_any_lines(tmp_path: Path, head: str, between: str) -> None:
    raw = read_text(tmp_path / "x.off", f"{head}{between}{between.join(BODY.split())}\n")
    assert (len(raw.faces), signed_area(raw), raw.findings) == (4, 3, ())


@pytest.mark.parametrize("body", [BODY + "7", BODY[:-2], BODY.replace("6 5", "-6 5")])
def test_other_numbers_than_the_header_promises_are_refused(tmp_path: Path, body: str) -> None:
    refusal(tmp_path / "x.off", f"OFF\n6 1 0\n{' '.join(body.split())}\n", "truncated")


def test_kin_need_a_line_for_each_vertex(tmp_path: Path) -> None:
    refusal(tmp_path / "x.off", f"COFF\n6 1 0\n{' '.join(BODY.split())}\n", "truncated")
