"""Drawings as pixels, and the comparison of pictures with stored ones."""

import os
from pathlib import Path
from typing import TypeAlias

import numpy as np
import svgelements
from ezdxf.entities.lwpolyline import LWPolyline
from ezdxf.filemanagement import readfile
from PIL import Image, ImageChops, ImageDraw

GOLDEN = Path(__file__).resolve().parents[1] / "golden"

#: With this variable set, pictures are kept instead of compared.
KEEP = "BSPCSG_KEEP_PICTURES"

#: Two pixels are the same if no channel differs by more than this: renderers shade edges
#: differently.
_MAX_CHANNEL_DIFFERENCE = 48

#: The largest number of pixels in a thousand that may differ: a line may lie a pixel beside its
#: place.
_MAX_DIFFERING_PER_MILLE = 5

#: Drawings are rasterised so many times larger, and shrunk, so that their edges are smooth.
_FINE = 4

_WIDTH = 160


#: Red, green and blue, or nothing is drawn.
Colour: TypeAlias = tuple[int, int, int] | None


def assert_as_kept(picture: Image.Image, name: str, folder: Path) -> None:
    """Compare a picture with the stored one; on failure write both and their difference.

    If the environment variable `KEEP` is set, store the picture instead.
    """
    path = GOLDEN / f"{name}.png"
    if KEEP in os.environ:
        picture.convert("RGB").save(path, optimize=True)
        return
    with Image.open(path) as file:
        kept = file.convert("RGB")
    found = picture.convert("RGB")
    count = differing(kept, found)
    if not are_alike(kept, found):
        off = ImageChops.difference(found, kept)
        side_by_side(kept, found, off).save(folder / f"{name}.png")
        raise AssertionError(
            f"{count} pixels of {name} differ; {folder / name}.png shows the kept picture, this one"
            f" and their difference. If this one is right, run the test again with {KEEP}=1."
        )


def are_alike(one: Image.Image, other: Image.Image) -> bool:
    """Return true if at most five pixels in a thousand of two pictures differ."""
    return differing(one, other) * 1000 <= _MAX_DIFFERING_PER_MILLE * one.width * one.height


def differing(one: Image.Image, other: Image.Image) -> int:
    """Return the number of pixels that differ between two pictures."""
    assert one.size == other.size
    off = ImageChops.difference(one.convert("RGB"), other.convert("RGB"))
    return int((np.asarray(off).max(axis=2) > _MAX_CHANNEL_DIFFERENCE).sum())


def side_by_side(*pictures: Image.Image) -> Image.Image:
    """Return one picture with pictures of equal size in a row."""
    width, height = pictures[0].size
    row = Image.new("RGB", (width * len(pictures), height))
    for place, picture in enumerate(pictures):
        row.paste(picture, (place * width, 0))
    return row


def of_svg(text: str, folder: Path) -> Image.Image:
    """Return an SVG drawing of filled and stroked paths as a picture."""
    path = folder / "drawing.svg"
    path.write_text(text, encoding="utf-8")
    drawing = svgelements.SVG.parse(path)
    box = drawing.viewbox
    scale = _FINE * _WIDTH / drawing.width
    size = (_FINE * _WIDTH, round(scale * drawing.height))
    assert box is not None
    image = Image.new("RGB", size, "white")
    for element in drawing.elements():
        if isinstance(element, svgelements.Path):
            loops = [
                [(scale * piece.end.x, scale * piece.end.y) for piece in svgelements.Path(loop)]
                for loop in element.as_subpaths()
            ]
            _fill(image, loops, _colour(element.fill))
            _stroke(image, loops, _colour(element.stroke), scale * element.stroke_width)
    return _shrunk(image)


def of_dxf(path: Path) -> Image.Image:
    """Return the polylines of a DXF drawing as a picture."""
    lines = [
        [(x, -y) for x, y in entity.get_points("xy")]
        for entity in readfile(path).modelspace()
        if isinstance(entity, LWPolyline)
    ]
    points = np.array([point for line in lines for point in line])
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.05 * (high - low).max()
    scale = _FINE * _WIDTH / (high[0] - low[0] + 2 * margin)
    image = Image.new(
        "RGB", (_FINE * _WIDTH, round(scale * (high[1] - low[1] + 2 * margin))), "white"
    )
    loops = [[tuple(scale * (np.array(p) - low + margin)) for p in line] for line in lines]
    _stroke(image, [[*loop, loop[0]] for loop in loops], (0, 0, 0), _FINE)
    return _shrunk(image)


def _shrunk(image: Image.Image) -> Image.Image:
    return image.resize((image.width // _FINE, image.height // _FINE), Image.Resampling.BOX)


def _colour(colour: svgelements.Color) -> Colour:
    return None if colour.value is None else (colour.red, colour.green, colour.blue)


def _fill(image: Image.Image, loops: list[list[tuple[float, float]]], colour: Colour) -> None:
    """Fill the pixels that an odd number of loops encloses."""
    if colour is None:
        return
    mask = Image.new("1", image.size)
    for loop in loops:
        one = Image.new("1", image.size)
        if len(loop) > 2:
            ImageDraw.Draw(one).polygon(loop, fill=1)
        mask = ImageChops.logical_xor(mask, one)
    image.paste(colour, mask=mask)


def _stroke(
    image: Image.Image, loops: list[list[tuple[float, float]]], colour: Colour, width: float
) -> None:
    if colour is not None:
        for loop in loops:
            ImageDraw.Draw(image).line(loop, fill=colour, width=max(1, round(width)))
