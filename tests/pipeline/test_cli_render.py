"""Pictures at the command line."""

import json
import os
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

from support.cli import Capture, put, ran
from support.shapes import cube


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


@pytest.mark.parametrize("style", ["shaded", "hidden", "edges"])
def test_svg_as_json(folder: Path, capsys: Capture, style: str) -> None:
    command = ["render", "a.off", "-o", "x.svg", "--style", style, "--background", "#102030"]
    code, out, _ = ran(capsys, *command, "--json")
    found = json.loads(out)
    assert code == 0 and found["output"] == "x.svg" and found["style"] == style
    assert found["size"] == [800, 600] and found["view"] == "iso" and found["polygons"] >= 3
    assert ElementTree.parse("x.svg").getroot().get("width") == "800"
    assert "#102030" in Path("x.svg").read_text()


def test_open_meshes_can_be_seen(folder: Path, capsys: Capture) -> None:
    put("open.off", (cube()[0], cube()[1][1:]))
    assert ran(capsys, "render", "open.off", "-o", "x.svg")[0] == 0


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["none.stl", "-o", "x.svg"], 3, "none.stl: cannot read"),
        (["part.step", "-o", "x.svg"], 3, "STEP"),
        (["a.off", "-o", "x.jpg"], 3, "end in .svg or .png"),
        (["a.off", "-o", "x"], 3, "end in .svg or .png"),
        (["a.off", "-o", "no/x.svg"], 5, "no folder"),
        (["a.off", "-o", "x.svg", "--size", "800"], 2, "'800' is no size"),
        (["a.off", "-o", "x.svg", "--size", "0x600"], 2, "width"),
        (["a.off", "-o", "x.svg", "--size", "99999x600"], 2, "at most"),
        (["a.off", "-o", "x.svg", "--view", "behind"], 2, "behind"),
        (["a.off", "-o", "x.svg", "--background", "sky"], 2, "'sky' is not"),
        (["a.off"], 2, "-o"),
    ],
)
def test_refusals(
    folder: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
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
    assert code == 6 and "pip install 'bspcsg[pictures]'" in err and not Path("x.png").exists()
    assert ran(capsys, "render", "a.off", "-o", "x.svg")[0] == 0


def test_doctor_knows_what_pictures_need(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("bspcsg.cli.verbs.doctor.find_spec", lambda name: name != "PIL" or None)
    code, out, _ = ran(capsys, "doctor", "--json")
    parts = {part["name"]: part for part in json.loads(out)["parts"]}
    assert code == 0 and parts["pillow"]["found"] == ""
    assert parts["pillow"]["remedy"] == 'pip install "bspcsg[pictures]"'
    assert parts["ezdxf"]["found"]
