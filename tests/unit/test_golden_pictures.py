"""The renderers' drawings against the pictures in `tests/golden`.

A picture may differ in a few pixels. `support.rasters` compares and stores them.
"""

import io
from pathlib import Path

import pytest
from PIL import Image, ImageDraw

import bspcsg as b
from bspcsg import bsp
from support import rasters
from support.rasters import are_alike, assert_as_kept, of_dxf, of_svg

SIZE = (160, 120)


@pytest.fixture(scope="module")
def part() -> b.Solid:
    """Return a block with a hole, a notch and a ball at a corner."""
    hole = b.cylinder(h=9, r=0.8, segments=16, center=True).translate(1.5, 1.5, 1)
    notch = b.box(1, 3, 1, center=True).translate(3, 2.5, 2)
    return (b.box(4, 3, 2) - hole - notch) | b.sphere(0.9, 16).translate(4, 0, 2)


def png(picture: bsp.Picture) -> Image.Image:
    return Image.open(io.BytesIO(picture.png))


@pytest.mark.parametrize("style", ["shaded", "hidden", "edges"])
def test_the_painter_s_svg(part: b.Solid, style: str, tmp_path: Path) -> None:
    picture = bsp.picture(part, size=SIZE, style=style)  # type: ignore[arg-type]
    assert_as_kept(of_svg(picture.svg, tmp_path), f"painter-{style}", tmp_path)


@pytest.mark.parametrize("view", ["iso", "front", "bottom"])
def test_the_painter_s_pixels(part: b.Solid, view: str, tmp_path: Path) -> None:
    picture = bsp.picture(part, view, size=SIZE)  # type: ignore[arg-type]
    assert_as_kept(png(picture), f"render-{view}", tmp_path)


def test_both_of_the_painter_s_outputs_are_the_same_picture(part: b.Solid, tmp_path: Path) -> None:
    picture = bsp.picture(part, size=SIZE)
    assert are_alike(png(picture), of_svg(picture.svg, tmp_path))


def test_a_panorama(tmp_path: Path) -> None:
    walls = [[[0, 0], [4, 1]], [[1, 2], [3, 4]], [[5, 0], [2, 5]], [[0, 1], [0, 4]]]
    picture = bsp.panorama(walls, eye=(1, 1), size=SIZE)
    assert_as_kept(png(picture), "panorama", tmp_path)


@pytest.mark.parametrize("suffix", ["svg", "dxf"])
def test_sections(part: b.Solid, suffix: str, tmp_path: Path) -> None:
    region, path = part.slice(1.75), tmp_path / f"section.{suffix}"
    getattr(region, f"to_{suffix}")(path)
    drawn = of_dxf(path) if suffix == "dxf" else of_svg(path.read_text("utf-8"), tmp_path)
    assert_as_kept(drawn, f"section-{suffix}", tmp_path)


def test_a_picture_that_changed_is_noticed_and_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(rasters.KEEP, raising=False)
    with Image.open(rasters.GOLDEN / "render-iso.png") as file:
        picture = file.convert("RGB")
    assert_as_kept(picture, "render-iso", tmp_path)
    ImageDraw.Draw(picture).rectangle((70, 50, 85, 65), fill="red")
    with pytest.raises(AssertionError, match="256 pixels of render-iso differ"):
        assert_as_kept(picture, "render-iso", tmp_path)
    with Image.open(tmp_path / "render-iso.png") as shown:
        assert shown.size == (3 * picture.width, picture.height)
