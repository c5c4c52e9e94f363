"""The command render: pictures of meshes."""

import io
import json
import os
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

import bspcsg as b
from support.cli import Capture, put, ran
from support.shapes import cube, cuboid


def test_png(folder: Path, capsys: Capture) -> None:
    code, out, err = ran(capsys, "render", "a.off", "-o", "x.png", "--size", "90x60")
    assert (code, err) == (0, "") and out.startswith("x.png  90 x 60 pixels")
    with Image.open("x.png") as image:
        pixels = np.asarray(image)
    assert pixels.shape == (60, 90, 3)
    assert (pixels[0, 0] == 255).all() and (pixels[30, 45] < 230).any()


def test_front_of_a_cube_is_a_square(folder: Path, capsys: Capture) -> None:
    command = ["render", "a.off", "-o", "x.png", "--size", "100x100", "--view", "front"]
    assert ran(capsys, *command, "--background", "none")[0] == 0
    with Image.open("x.png") as image:
        cover = np.asarray(image)[:, :, 3] > 0
    # The margin is 4 % on each side, plus half the width of the border.
    columns, rows = (np.flatnonzero(cover.any(axis=axis)) for axis in (0, 1))
    assert 3 <= columns[0] <= 5 and 95 <= columns[-1] <= 97
    assert (columns[0], columns[-1]) == (rows[0], rows[-1])
    assert cover[np.ix_(columns[1:-1], rows[1:-1])].all()


def _seen(capsys: Capture, *arguments: str) -> "np.ndarray[Any, Any]":
    """Return the pixels of the picture that the command renders, without edges."""
    code, _, err = ran(capsys, "render", *arguments, "-o", "seen.png", "--background", "none")
    assert (code, err) == (0, "")
    with Image.open("seen.png") as image:
        return np.asarray(image.convert("RGBA")).astype(int)


def _size(pixels: "np.ndarray[Any, Any]") -> tuple[int, int]:
    """Return width and height of the part of a picture that is not transparent."""
    rows, columns = (np.flatnonzero((pixels[:, :, 3] > 0).any(axis=axis)) for axis in (1, 0))
    return int(np.ptp(columns)) + 1, int(np.ptp(rows)) + 1


def test_angles_say_what_the_views_do(folder: Path, capsys: Capture) -> None:
    put("bar.off", cuboid((0, 0, 0), (4, 2, 1)))
    angles = {
        "front": ("0", "0"),
        "right": ("90", "0"),
        "back": ("180", "0"),
        "left": ("-90", "0"),
        "top": ("0", "90"),
        "bottom": ("0", "-90"),
    }
    for view, (azimuth, elevation) in angles.items():
        named = _seen(capsys, "bar.off", "--view", view)
        found = _seen(capsys, "bar.off", "--azimuth", azimuth, "--elevation", elevation)
        assert (named == found).all(), view
    width, height = _size(_seen(capsys, "bar.off", "--azimuth", "0", "--elevation", "0"))
    assert width / height == pytest.approx(4, abs=0.1)


def test_an_eye_sees_in_perspective(folder: Path, capsys: Capture) -> None:
    put("bar.off", cuboid((0, 0, 0), (2, 40, 2)))
    near = _size(_seen(capsys, "bar.off", "--eye", "1,-10,1", "--size", "400x400"))
    far = _size(_seen(capsys, "bar.off", "--eye", "1,-30,1", "--size", "400x400"))
    assert near[0] == pytest.approx(3 * far[0], abs=6)
    aside = _seen(capsys, "bar.off", "--eye", "1,-30,1", "--target", "9,0,1", "--size", "400x400")
    columns = np.flatnonzero((aside[:, :, 3] > 0).any(axis=0))
    assert columns.max() < 180
    lying = ["--eye", "1,-30,1", "--up", "1,0,0", "--size", "400x200"]
    assert _size(_seen(capsys, "bar.off", *lying))[0] > 0
    flat = _seen(capsys, "a.off", "--azimuth", "0", "--elevation", "0")
    deep = _seen(capsys, "a.off", "--azimuth", "0", "--elevation", "20", "--perspective=60")
    assert _size(flat) != _size(deep)


def test_parts_have_colours_of_their_own(folder: Path, capsys: Capture) -> None:
    put("far.off", cuboid((5, 0, 0), (7, 2, 2)))
    seen = _seen(capsys, "a.off", "far.off", "--view", "front")
    left, right = seen[300, 150, :3], seen[300, 650, :3]
    assert left[2] > left[0] + 20 and right[0] > right[2] + 20
    one = _seen(capsys, "a.off", "far.off", "--view", "front", "--colours", "#30a040")
    assert (one[300, 150] == one[300, 650]).all() and one[300, 150, 1] > one[300, 150, 0] + 30


def test_faces_say_which_operand_they_are_from(folder: Path, capsys: Capture) -> None:
    Path("part.py").write_text(
        "import bspcsg as b\nresult = b.cube(4) - b.cube(2).translate(3, -1, 3)\n"
    )
    plain = _seen(capsys, "part.py")
    coloured = _seen(capsys, "part.py", "--colours", "origin")
    changed = (np.abs(plain - coloured)[:, :, :3] > 12).any(axis=2)
    assert 0.05 < changed.mean() < 0.6
    cut = ["part.py", "--colours", "origin", "--section", "0,0,1,3.5", "--view", "right"]
    seen = _seen(capsys, *cut)
    width, height = _size(seen)
    assert width / height == pytest.approx(4 / 3.5, abs=0.02)
    # Below the notch the cube's face, in the notch that of what was taken away.
    assert np.abs(seen[400, 400] - seen[60, 150]).max() > 12


def test_colours_of_a_file_are_its_own(folder: Path, capsys: Capture) -> None:
    vertices, faces = cube()
    colours = np.tile(np.array([[200, 10, 10, 255]], dtype=np.uint8), (len(faces), 1))
    b.Solid(vertices, faces, face_attributes={"color": colours}).save("red.ply")
    red = _seen(capsys, "red.ply", "--view", "front")[300, 400]
    assert red[0] > 100 and red[1:3].max() < 30
    own = _seen(capsys, "red.ply", "--view", "front", "--colours", "part")[300, 400]
    assert own[1] > 100


def test_a_section_is_closed(folder: Path, capsys: Capture) -> None:
    b.Solid(*cube()).save("c.off")
    ball = b.sphere(r=1, segments=32) - b.sphere(r=0.6, segments=32)
    ball.save("shell.off")
    cut = ["shell.off", "--section", "0,0,1,0", "--view", "top", "--size", "400x400"]
    seen = _seen(capsys, *cut)
    # The ring of the cut is flat: one colour from the middle's hole to the border.
    ring = seen[200, 30:80, :3]
    assert (np.ptp(ring, axis=0) <= 2).all() and (seen[200, 200, :3] != ring[30]).any()


def test_a_turn_as_gif(folder: Path, capsys: Capture) -> None:
    put("bar.off", cuboid((0, 0, 0), (4, 1, 1)))
    command = ["render", "bar.off", "-o", "x.gif", "--size", "120x90", "--frames", "8"]
    code, out, _ = ran(capsys, *command, "--seconds", "2", "--elevation", "0", "--json")
    assert code == 0 and json.loads(out)["frames"] == 8
    widths = []
    with Image.open("x.gif") as image:
        assert (
            image.size == (120, 90)
            and getattr(image, "n_frames", 1) == 8
            and image.info["loop"] == 0
        )
        for frame in range(8):
            image.seek(frame)
            assert image.info["duration"] == 250
            dark = np.asarray(image.convert("L")) < 250
            widths.append(np.ptp(np.flatnonzero(dark.any(axis=0))))
    # From iso's azimuth of 45 degrees on: the bar is longest from the front, shortest from aside.
    assert np.argmin(widths) in (1, 5) and np.argmax(widths) in (3, 7)
    assert widths[:4] == pytest.approx(widths[4:], abs=1)


@pytest.mark.parametrize("style", ["shaded", "hidden", "edges"])
def test_svg_as_json(folder: Path, capsys: Capture, style: str) -> None:
    command = ["render", "a.off", "-o", "x.svg", "--style", style, "--background", "#102030"]
    code, out, _ = ran(capsys, *command, "--json")
    found = json.loads(out)
    assert code == 0 and found["output"] == "x.svg" and found["style"] == style
    assert found["size"] == [800, 600] and found["view"] == "iso" and found["polygons"] >= 3
    assert ElementTree.parse("x.svg").getroot().get("width") == "800"
    assert "#102030" in Path("x.svg").read_text("utf-8")


def test_open_meshes_can_be_seen(folder: Path, capsys: Capture) -> None:
    put("open.off", (cube()[0], cube()[1][1:]))
    assert ran(capsys, "render", "open.off", "-o", "x.svg")[0] == 0


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["none.stl", "-o", "x.svg"], 3, "none.stl: cannot read"),
        (["part.step", "-o", "x.svg"], 3, "STEP"),
        (["a.off", "-o", "x.jpg"], 3, "end in .svg or .png or .gif"),
        (["a.off", "-o", "x"], 3, "end in .svg or .png or .gif"),
        (["a.off", "-o", "no/x.svg"], 5, "does not exist or is not writable"),
        (["a.off", "-o", "x.svg", "--size", "800"], 2, "'800' is not a picture size"),
        (["a.off", "-o", "x.svg", "--size", "0x600"], 2, "width"),
        (["a.off", "-o", "x.svg", "--size", "99999x600"], 2, "at most"),
        (["a.off", "-o", "x.svg", "--view", "behind"], 2, "behind"),
        (["a.off", "-o", "x.svg", "--background", "sky"], 2, "'sky' is not"),
        (["a.off"], 2, "-o"),
        (["a.off", "-o", "x.svg", "--eye", "1,2"], 2, "'1,2' is not a point"),
        (["a.off", "-o", "x.svg", "--eye", "1,1,1", "--target", "1,1,1"], 2, "same point"),
        (
            ["a.off", "-o", "x.svg", "--eye", "9,9,9", "--view", "top"],
            2,
            "--view cannot be combined",
        ),
        (
            ["a.off", "-o", "x.svg", "--eye", "9,9,9", "--azimuth", "3"],
            2,
            "--azimuth cannot be combined",
        ),
        (["a.off", "-o", "x.svg", "--view", "top", "--elevation", "3"], 2, "--elevation cannot"),
        (["a.off", "-o", "x.svg", "--target", "0,0,0"], 2, "--target needs --eye"),
        (["a.off", "-o", "x.svg", "--up", "0,0,0"], 2, "not a direction"),
        (["a.off", "-o", "x.svg", "--view", "front", "--up", "0,1,0"], 2, "must not be parallel"),
        (["a.off", "-o", "x.svg", "--perspective=200"], 2, "200"),
        (
            ["a.off", "-o", "x.svg", "--colours", "origin"],
            2,
            "no colours or attributes with the name 'origin'",
        ),
        (["a.off", "-o", "x.svg", "--colours", "#12"], 2, "must be a colour name or code such as"),
        (["a.off", "-o", "x.svg", "--section", "0,0,0,1"], 2, "not a section"),
        (["open.off", "-o", "x.svg", "--section", "0,0,1,1"], 4, "not closed"),
        (["a.off", "-o", "x.gif", "--frames", "1"], 2, "--frames"),
    ],
)
def test_refusals(
    folder: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
    put("open.off", (cube()[0], cube()[1][1:]))
    before = sorted(os.listdir())
    found, out, err = ran(capsys, "render", *arguments)
    assert (found, out) == (code, "") and words in err
    assert sorted(os.listdir()) == before


def test_a_missing_part_is_code_6(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "PIL", None)
    code, _, err = ran(capsys, "render", "a.off", "-o", "x.png")
    assert code == 6 and "pip install pillow" in err and not Path("x.png").exists()
    assert ran(capsys, "render", "a.off", "-o", "x.svg")[0] == 0


def test_doctor_knows_what_pictures_need(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("bspcsg.cli.verbs.doctor.find_spec", lambda name: name != "PIL" or None)
    code, out, _ = ran(capsys, "doctor", "--json")
    parts = {part["name"]: part for part in json.loads(out)["parts"]}
    assert code == 6 and parts["pillow"]["found"] == ""
    assert parts["pillow"]["remedy"] == "pip install pillow"
    assert parts["ezdxf"]["found"]


# Found: a textured file was drawn without a warning that the texture is missing.
def test_one_colour_of_a_texture_is_said(folder: Path, capsys: Capture) -> None:
    data = io.BytesIO()
    Image.fromarray(np.full((4, 4, 3), (255, 0, 0), dtype=np.uint8)).save(data, "PNG")
    cube = b.cube(2).to_mesh()
    textured = b.Solid(
        cube.vertices,
        cube.faces,
        vertex_attributes={"uv": np.full((8, 2), 0.5)},
        face_attributes={"material": ["red"] * 12},
        materials={"red": b.Material((1, 1, 1), texture=data.getvalue())},
    )
    textured.save("red.glb")
    code, _, err = ran(capsys, "render", "red.glb", "-o", "x.png", "--background", "white")
    assert code == 0 and "each face is drawn in one colour" in err
    _, green, blue = np.asarray(Image.open("x.png").convert("RGB"))[200, 400]
    assert green == blue == 0
    assert "texture" not in ran(capsys, "render", "a.off", "-o", "x.png")[2]
    assert "texture" not in ran(capsys, "render", "red.glb", "-o", "x.png", "--colours", "part")[2]


def test_very_many_triangles_are_drawn_by_a_buffer(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("bspcsg.bsp.painting.picture._MAX_TRIANGLES_ORDERED", 0)
    monkeypatch.setattr("bspcsg.bsp.painting.picture.painting_of", None)
    code, out, _ = ran(capsys, "render", "a.off", "c.stl", "-o", "x.png", "--view", "top")
    assert code == 0 and "24 polygons" in out and Path("x.png").stat().st_size > 500
