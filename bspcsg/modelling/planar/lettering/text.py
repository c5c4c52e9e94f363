"""A line of text as a plane region."""

import math
import os
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, get_args

import numpy as np

from ...._types import FloatArray, Scalar
from ....bsp import Region
from ....errors import InvalidParameterError, invalid_parameter
from ....parameters import SEGMENTS, positive, refuse_many_corners, shown, sides_around
from .fonts import FAMILY, FontFile, font_file, harfbuzz_font
from .shaping import Glyph, PlacedGlyph, Writing, shaped_glyphs

HorizontalAlignment: TypeAlias = Literal["left", "center", "right"]
VerticalAlignment: TypeAlias = Literal["baseline", "bottom", "center", "top"]
Direction: TypeAlias = Literal["ltr", "rtl", "ttb", "btt"]

#: The em of a font of size 1, in model units, as in OpenSCAD: a point of 1/72 inch at 100 dots per
#: inch.
EM = 100 / 72


@dataclass(frozen=True)
class Lettering:
    """The appearance of a line of text, apart from its font.

    Parameters
    ----------
    em : float
        The em of the font, in model units.
    halign, valign : str
        The alignment of the line with x = 0 and y = 0.
    spacing : float
        The factor by which the pen's steps between letters are multiplied.
    writing : Writing
        The direction, language and script.
    steps : int
        The number of chords of each curve of a glyph.
    ink : float
        The factor by which glyphs are enlarged.
    tightness : float
        The factor by which positions of glyphs, and the extent of the line, are multiplied.
    grid : float
        The step to which the extent of the line is rounded up; 0 for no rounding.
    """

    em: float
    halign: HorizontalAlignment
    valign: VerticalAlignment
    spacing: float
    writing: Writing
    steps: int
    ink: float = 1.0
    tightness: float = 1.0
    grid: float = 0.0

    def reach(self, distance: float) -> float:
        """Return the extent of a line to use for its alignment, given its measured extent."""
        steps = math.ceil(distance / self.grid) * self.grid if self.grid else distance
        return max(steps, 0.0) * self.tightness


def steps_of(segments: float) -> int:
    """Return the number of chords of a glyph's curves, given the segments of a full circle.

    By OpenSCAD's rule, it is an eighth of the segments plus one, at least two.
    """
    return max(int(segments // 8) + 1, 2)


def text(
    string: str,
    size: Scalar = 10.0,
    font: str | os.PathLike[str] = FAMILY,
    *,
    halign: HorizontalAlignment = "left",
    valign: VerticalAlignment = "baseline",
    spacing: Scalar = 1.0,
    direction: Direction | None = None,
    language: str = "en",
    script: str | None = None,
    segments: int = SEGMENTS,
) -> Region:
    """Return a line of text as a region, laid out by HarfBuzz.

    Parameters
    ----------
    string : str
        The text, without line breaks.
    size : float
        About the height of capitals, in model units; as in OpenSCAD, the em is 100/72 of it.
    font : str or path
        ``"Family"`` or ``"Family:style=Bold"`` of a font that fontconfig finds on this machine, or
        the path of a font file. "Liberation Sans", regular and bold, comes with the package. A
        missing font is replaced by one that fontconfig knows to have equal metrics.
    halign : {"left", "center", "right"}
        The part of the line that is at x = 0.
    valign : {"baseline", "bottom", "center", "top"}
        The part of the line that is at y = 0.
    spacing : float
        The factor by which distances between letters are multiplied, above 0.
    direction : {"ltr", "rtl", "ttb", "btt"}, optional
        The direction of writing; by default the direction of the text's script.
    language : str
        The language of the text, such as ``"en"``; fonts may have variants for a language.
    script : str, optional
        The script as four letters of ISO 15924, such as ``"Latn"``; by default it is derived from
        the text.
    segments : int
        The number of sides of a full circle. Each curve of a glyph gets an eighth of them plus one
        chord, at least two.

    Returns
    -------
    Region
        The union of the glyphs.

    Raises
    ------
    InvalidParameterError
        If there is no such font (code "unknown_font"), the font has no glyph for a letter
        ("missing_glyph"), the text has several lines, or a parameter is out of its range.
    FormatError
        If the file of the font cannot be read.
    LimitError
        If the glyphs would have too many corners.

    Examples
    --------
    >>> import bspcsg as csg
    >>> plate = csg.text("Ok", 8).extrude(2)
    >>> len(csg.text("Ok").decompose())
    2
    """
    line = _line(string)
    look = Lettering(
        positive(size, "size") * EM,
        _one_of(HorizontalAlignment, halign, "halign"),
        _one_of(VerticalAlignment, valign, "valign"),
        positive(spacing, "spacing"),
        _writing(direction, language, script),
        steps_of(sides_around(3, segments, "segments")),
    )
    region, missing = text_region(line, font_file(font), look)
    if missing:
        letters = " ".join(f"{letter} (U+{ord(letter):04X})" for letter in missing[:8])
        message = (
            f"The font {shown(os.fspath(font))} has no glyph for {letters}; choose another font,"
            " or other characters."
        )
        raise InvalidParameterError(message, "missing_glyph")
    return region


def text_region(string: str, file: FontFile, lettering: Lettering) -> tuple[Region, list[str]]:
    """Return a line of text in the font of a file, and the letters that the font lacks.

    Missing glyphs get the font's substitute, usually a box.
    """
    font = harfbuzz_font(file)
    placed, is_horizontal = shaped_glyphs(font, string, lettering.writing)
    glyphs = {one.glyph: Glyph(font, one.glyph) for one in placed}
    unit = lettering.em / font.face.upem
    loops = {
        key: [loop * (unit * lettering.ink) for loop in glyph.loops(lettering.steps)]
        for key, glyph in glyphs.items()
    }
    refuse_many_corners(sum(len(p) for one in placed for p in loops[one.glyph]), "This text")
    places = _places(placed, unit * lettering.tightness, lettering.spacing)
    boxes = np.array([glyphs[one.glyph].bounds for one in placed]).reshape(-1, 2, 2)
    anchor = _anchor(places[-1], boxes * (unit * lettering.ink), lettering, is_horizontal)
    parts = [
        Region([loop + (place + anchor) for loop in loops[one.glyph]], winding="nonzero")
        for one, place in zip(placed, places, strict=False)
    ]
    missing = [string[one.cluster] for one in placed if one.glyph == 0]
    return Region.compose(parts), list(dict.fromkeys(missing))


def _places(placed: Sequence[PlacedGlyph], unit: float, spacing: float) -> list[FloatArray]:
    """Return the position of each glyph in a line, (2,), and as last entry the pen's end.

    The pen starts at the origin; `unit` is the length of a design unit of the font.
    """
    pen, places = np.zeros(2), []
    for one in placed:
        places.append(pen + one.offset * unit)
        pen = pen + one.advance * (unit * spacing)
    return [*places, pen]


def _anchor(
    end: FloatArray, boxes: FloatArray, lettering: Lettering, is_horizontal: bool
) -> FloatArray:
    """Return the start position of the pen, (2,), that aligns a line by OpenSCAD's rules.

    The width of a horizontal line is the sum of its advances, and its height is the extent of the
    glyphs' control points. The height of a vertical line is the sum of its advances, downwards, and
    its width is the width of its widest glyph.
    """
    low, high = boxes[:, 0], boxes[:, 1]
    if is_horizontal:
        width, ascent = float(end[0]), lettering.reach(float(high[:, 1].max(initial=0.0)))
        descent = lettering.reach(float((-low[:, 1]).max(initial=0.0)))
    else:
        width, ascent = lettering.reach(float((high - low)[:, 0].max(initial=0.0))), float(end[1])
        descent = 0.0
    x = {"left": 0.0, "center": -width / 2, "right": -width}[lettering.halign]
    y = {"baseline": 0.0, "bottom": descent, "center": (descent - ascent) / 2, "top": -ascent}
    return np.array([x, y[lettering.valign]])


def _line(string: Any) -> str:
    if not isinstance(string, str):
        raise invalid_parameter(f"string must be a str, not {shown(string)}.")
    if any(unicodedata.category(letter) in ("Cc", "Cs") for letter in string):
        raise invalid_parameter(
            "string must be a single line, without line breaks and other control characters."
        )
    return string


def _writing(direction: Any, language: Any, script: Any) -> Writing:
    if direction is not None:
        _one_of(Direction, direction, "direction")
    if not isinstance(language, str) or not language.isascii():
        raise invalid_parameter(
            f"language must be a language code such as 'en', not {shown(language)}."
        )
    is_script = isinstance(script, str) and len(script) == 4 and script.isascii()
    if script is not None and not (is_script and script.isalpha()):
        raise invalid_parameter(
            f"script must be a script code of four letters such as 'Latn', not {shown(script)}."
        )
    return Writing(direction or "", language, script or "")


def _one_of(choices: Any, value: Any, name: str) -> Any:
    known = get_args(choices)
    if not isinstance(value, str) or value not in known:
        words = ", ".join(f'"{one}"' for one in known)
        raise invalid_parameter(f"{name} must be one of {words}, not {shown(value)}.")
    return value
