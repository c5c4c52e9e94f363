"""One parser reads colours everywhere."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from bspcsg.attributes.colours import color_of, colors_of
from support.cli import Capture, ran

ORANGE = (255, 136, 0)


@pytest.mark.parametrize(
    "given",
    [
        "#ff8800",
        "#FF8800",
        "#f80",
        "ff8800",
        "#f80f",
        "#ff8800ff",
        " #f80 ",
        ORANGE,
        [*ORANGE, 255],
        np.array(ORANGE),
        np.array(ORANGE, np.uint8),
        np.array(ORANGE, np.uint16) * np.uint16(257),
        (1.0, 136 / 255, 0.0),
        np.array([1, 136 / 255, 0, 1], np.float32),
    ],
)
def test_all_ways_to_write_a_colour_are_one(given: Any) -> None:
    assert color_of(given) == pytest.approx((1, 136 / 255, 0, 1))
    told = b.Material(given).color, b.Assembly("x", b.cube(1), color=given).color
    assert told == (color_of(given),) * 2
    said = b.cube(1).tagged(color=given).to_mesh().face_attributes["color"]
    assert [color_of(one) for one in said] == [color_of(given)] * 12
    fills = bsp.picture(b.cube(1).to_mesh(), colors=given, style="shaded").painting.fills
    assert fills is not None and (fills[:, 2] == 0).all() and fills[:, 0].any()


@pytest.mark.parametrize(
    ("given", "meant"),
    [
        ("Orange", (255, 165, 0, 255)),
        ("rebeccapurple", (102, 51, 153, 255)),
        ("grey", (128, 128, 128, 255)),
        ("transparent", (0, 0, 0, 0)),
        ("#ff000080", (255, 0, 0, 128)),
        ((1, 0, 0), (255, 0, 0, 255)),
        ((1, 0, 0, 0), (255, 0, 0, 0)),
        ((2, 0, 0), (2, 0, 0, 255)),
        (np.array([1, 0, 0], np.uint8), (1, 0, 0, 255)),
        ((255, 0, 0, 1), (255, 0, 0, 1)),
    ],
)
def test_what_colours_mean(given: Any, meant: tuple[int, ...]) -> None:
    assert tuple(round(255 * value) for value in color_of(given)) == meant


@pytest.mark.parametrize(
    "given",
    ["", "blue-ish", "#12", "#12345", "fed", (1, 0), (0, 0, 256), (0, -1, 0), (0.0, 2, 0), 7]
    + [(float("nan"), 0, 0), (True, False, False), None, [["red"]], {}, (1, 0, 0, 0, 0)],
)
def test_what_is_no_colour_is_refused(given: Any) -> None:
    for take in (color_of, b.Material, lambda one: b.cube(1).tagged(color=one)):
        with pytest.raises(
            b.InvalidParameterError, match="must be a colour name or code such as 'orange'"
        ):
            take(given)


def test_colours_come_one_for_each() -> None:
    mixed = colors_of(["red", "#00ff0080", (0, 0, 255)])
    assert mixed.tolist() == [[255, 0, 0, 255], [0, 255, 0, 128], [0, 0, 255, 255]]
    assert colors_of([(1, 0, 0), (0, 0, 2)]).tolist() == [[1, 0, 0], [0, 0, 2]]
    vertices, faces = b.cube(1).to_mesh()
    names = ["red"] * 11 + ["blue"]
    for given in (names, np.array(names), [(255, 0, 0)] * 11 + [(0, 0, 255)]):
        said = b.Solid(vertices, faces, face_attributes={"color": given}).to_mesh()
        assert said.face_attributes["color"][[0, 11]].tolist() == [[255, 0, 0], [0, 0, 255]]
    for kind in ("vertex", "corner", "face"):
        options: dict[str, Any] = {f"{kind}_attributes": {"color": "red"}}
        said = b.Solid(vertices, faces, **options).to_mesh()
        assert (said.attributes.at_corners("color") == (255, 0, 0)).all()
    with pytest.raises(b.InvalidMeshError, match="must be a colour name or code such as"):
        b.Solid(vertices, faces, face_attributes={"color": ["no"] * 12})


def test_pictures_refuse_colours_that_let_something_through() -> None:
    with pytest.raises(b.InvalidParameterError, match="opaque"):
        bsp.picture(b.cube(1).to_mesh(), colors="#ff000080")


@pytest.mark.parametrize(
    ("call", "meant"),
    [
        ('"red"', (1, 0, 0, 1)),
        ('c = "#00f"', (0, 0, 1, 1)),
        ('"red", 0.5', (1, 0, 0, 0.5)),
        ("[1, 0, 0], alpha = 0.5", (1, 0, 0, 0.5)),
        ("[0, 1, 0, 0.25]", (0, 1, 0, 0.25)),
        ("[255, 0, 0]", None),
        ("undef", None),
    ],
)
def test_colours_in_scripts(tmp_path: Path, call: str, meant: Any) -> None:
    (tmp_path / "x.csg").write_text(f"color({call}) cube(1); sphere(1);")
    assert b.Assembly.load(tmp_path / "x.csg").parts[0].color == meant


def test_the_command_line_takes_names(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    b.cube(1).save("x.off")
    code, _, err = ran(
        capsys, "render", "x.off", "-o", "x.svg", "--colours", "orange", "--background", "navy"
    )
    assert code == 0, err
    assert 'height="100%" fill="#000080"' in Path("x.svg").read_text()
