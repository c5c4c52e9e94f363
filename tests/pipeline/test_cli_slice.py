"""The command slice: sections of meshes."""

import json
import os
import sys
from pathlib import Path

import pytest

from bspcsg.bsp import Region
from support.cli import Capture, put, ran
from support.shapes import cuboid


@pytest.mark.parametrize("name", ["x.svg", "x.dxf"])
def test_a_ring(folder: Path, capsys: Capture, name: str) -> None:
    put("hole.off", cuboid((0.5, 0.5, -1), (1.5, 1, 3)))
    assert ran(capsys, "difference", "a.off", "hole.off", "-o", "ring.off")[0] == 0
    code, out, _ = ran(capsys, "slice", "ring.off", "-o", name, "--z", "0.25")
    assert code == 0 and out.startswith(f"{name}  area 3.5  2 outlines, 1 hole among them  ")
    read = Region.from_svg(name) if name == "x.svg" else Region.from_dxf(name)
    assert read.equals(Region.rectangle(2, 2) - Region.rectangle(1, 0.5).translate(0.5, 0.5))


def test_a_slanted_plane_as_json(folder: Path, capsys: Capture) -> None:
    command = ["slice", "a.off", "-o", "x.svg", "--normal", "1,1,1", "--offset", "1"]
    code, out, _ = ran(capsys, *command, "--json")
    found = json.loads(out)
    # The triangle with its corners at 1 on the axes.
    assert code == 0 and found["area"] == pytest.approx(3**0.5 / 2)
    assert found["perimeter"] == pytest.approx(3 * 2**0.5)
    assert (found["outlines"], found["holes"]) == (1, 0)
    assert found["normal"] == [1, 1, 1] and found["offset"] == 1 and Path("x.svg").exists()


@pytest.mark.parametrize("plane", [["--z", "0"], ["--z", "7"], ["--normal", "1,0,0"]])
def test_planes_that_miss(folder: Path, capsys: Capture, plane: list[str]) -> None:
    code, out, err = ran(capsys, "slice", "a.off", "-o", "x.svg", *plane)
    assert (code, out) == (4, "") and "does not cut it" in err and not Path("x.svg").exists()
    code, out, _ = ran(capsys, "slice", "a.off", "-o", "x.svg", *plane, "--json")
    assert code == 4 and json.loads(out)["error"]["code"] == "empty_result"


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["none.stl", "-o", "x.svg", "--z", "1"], 3, "none.stl: cannot read"),
        (["part.step", "-o", "x.svg", "--z", "1"], 3, "STEP"),
        (["a.off", "-o", "x.png", "--z", "1"], 3, "end in .svg or .dxf"),
        (["a.off", "-o", "no/x.svg", "--z", "1"], 5, "does not exist or is not writable"),
        (["a.off", "-o", "x.svg"], 2, "either --z"),
        (["a.off", "-o", "x.svg", "--z", "1", "--normal", "0,0,1"], 2, "either --z"),
        (
            ["a.off", "-o", "x.svg", "--z", "1", "--offset", "2"],
            2,
            "--offset can only be used with",
        ),
        (["a.off", "-o", "x.svg", "--z", "nan"], 2, "not a finite number"),
        (["a.off", "-o", "x.svg", "--normal", "0,0,0"], 2, "is not a normal"),
        (["a.off", "-o", "x.svg", "--normal", "0,1"], 2, "is not a normal"),
    ],
)
def test_refusals(
    folder: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
    before = sorted(os.listdir())
    found, out, err = ran(capsys, "slice", *arguments)
    assert (found, out) == (code, "") and words in err
    assert sorted(os.listdir()) == before


def test_a_missing_part_is_code_6(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    code, _, err = ran(capsys, "slice", "a.off", "-o", "x.dxf", "--z", "1")
    assert code == 6 and 'pip install "bspcsg[dxf]"' in err and not Path("x.dxf").exists()
