"""Write paintings as PNG, painted with Pillow from back to front."""

import io
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray
from ...errors import BspcsgError, LimitError
from .clip import next_corners, polygon_of_corner
from .colours import ColourArray
from .painting import Painting

if TYPE_CHECKING:
    from PIL import Image, ImageDraw

#: The largest number of samples of a picture, before they are averaged to pixels: about a gigabyte.
_MAX_CANVAS_PIXELS = 300_000_000

_INK = (26, 28, 32)


def png(painting: Painting, background: ColourArray | None, line: float, samples: int) -> bytes:
    """Return a painting as the bytes of a PNG file.

    Parameters
    ----------
    painting : Painting
    background : (3,) uint8, optional
        The colour of the background; None for transparent.
    line : float
        The width of edges, in pixels.
    samples : int
        Each pixel is the mean of `samples` × `samples` samples.
    """
    buffer = io.BytesIO()
    image(painting, background, line, samples).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def image(
    painting: Painting, background: ColourArray | None, line: float, samples: int
) -> "Image.Image":
    """Return a painting as a Pillow image; parameters are those of `png`."""
    pillow = _pillow()
    large = canvas_size(painting.size, samples)
    back = (0, 0, 0, 0) if background is None else tuple(background.tolist())
    canvas = pillow.Image.new("RGBA" if background is None else "RGB", large, back)
    _paint(pillow.ImageDraw.Draw(canvas), painting, line_samples(line, samples), samples)
    return _reduced(canvas, samples)


def png_of_samples(
    nearest: IndexArray,
    fills: ColourArray,
    ink: BoolArray,
    background: ColourArray | None,
    samples: int,
) -> bytes:
    """Return the bytes of a PNG file, given each sample's triangle and ink (see `raster`)."""
    pillow = _pillow()
    if background is None:
        cover = ((nearest >= 0) | ink).astype(np.uint8) * 255
        pixels = np.dstack([np.zeros((*nearest.shape, 3), dtype=np.uint8), cover])
    else:
        pixels = np.tile(background, (*nearest.shape, 1))
    is_covered = nearest >= 0
    pixels[is_covered, :3] = fills[nearest[is_covered]]
    pixels[ink, :3] = _INK
    buffer = io.BytesIO()
    _reduced(pillow.Image.fromarray(pixels), samples).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def canvas_size(size: tuple[int, int], samples: int) -> tuple[int, int]:
    """Return the numbers of samples across and down, or raise an error if they are too many."""
    width, height = size
    if width * height * samples**2 > _MAX_CANVAS_PIXELS:
        message = (
            f"A picture of {width} x {height} pixels with {samples} x {samples} samples each"
            f" exceeds the limit of {_MAX_CANVAS_PIXELS} samples; choose fewer samples or a"
            " smaller size."
        )
        raise LimitError(message, "too_large")
    return samples * width, samples * height


def line_samples(line: float, samples: int) -> int:
    """Return the width of lines, given in pixels, as a number of samples."""
    return max(1, round(line * samples))


def _reduced(canvas: "Image.Image", samples: int) -> "Image.Image":
    """Return an image whose pixels are the means of `samples` × `samples` pixels of the canvas."""
    if canvas.mode == "RGBA":
        # Means are correct at the border of transparent areas only with premultiplied opacity.
        return canvas.convert("RGBa").reduce(samples).convert("RGBA")
    return canvas.reduce(samples)


def _pillow() -> Any:
    try:
        import PIL.Image
        import PIL.ImageDraw
    except ImportError as error:
        message = (
            "Writing PNG pictures needs the package Pillow, which is not installed. Try: pip"
            " install pillow"
        )
        raise BspcsgError(message, "missing_dependency") from error
    return PIL


def _paint(draw: "ImageDraw.ImageDraw", painting: Painting, width: int, samples: int) -> None:
    polygons = painting.polygons
    # Pillow takes only integer coordinates of pixels.
    places = np.floor(polygons.corners * samples)
    starts = polygons.offsets.tolist()
    flat = places.ravel().tolist()
    fills = _tuples(painting)
    lines = _lines(painting, places)
    for index, (start, end) in enumerate(pairwise(starts)):
        if fills is not None:
            corners = flat[2 * start : 2 * end]
            draw.polygon(corners, fill=fills[index])
            # The outline closes the gaps that rounding leaves between neighbouring polygons.
            draw.line(corners + corners[:2], fill=fills[index])
        for ends in lines.get(index, ()):
            _line(draw, ends, width)
    for ends in np.floor(painting.lines.reshape(-1, 4) * samples).tolist():
        _line(draw, ends, width)


def _line(draw: "ImageDraw.ImageDraw", ends: list[float], width: int) -> None:
    """Draw a line with round ends, so that lines with a common end leave no notch."""
    draw.line(ends, fill=_INK, width=width)
    if width > 2:
        half = (width - 1) / 2
        for x, y in (ends[:2], ends[2:]):
            draw.ellipse((x - half, y - half, x + half, y + half), fill=_INK)


def _tuples(painting: Painting) -> list[tuple[int, ...]] | None:
    fills = painting.fills
    return None if fills is None else [tuple(fill) for fill in fills.tolist()]


def _lines(painting: Painting, places: FloatArray) -> dict[int, list[list[float]]]:
    polygons = painting.polygons
    marked = np.flatnonzero(polygons.marked)
    ends = np.hstack([places[marked], places[next_corners(polygons.offsets)[marked]]]).tolist()
    found: dict[int, list[list[float]]] = {}
    for owner, pair in zip(polygon_of_corner(polygons.offsets)[marked].tolist(), ends, strict=True):
        found.setdefault(owner, []).append(pair)
    return found
