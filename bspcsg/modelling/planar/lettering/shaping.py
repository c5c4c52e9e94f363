"""The layout of the glyphs of a text by HarfBuzz, and their outlines."""

from typing import NamedTuple, TypeAlias

import numpy as np
import uharfbuzz

from ...._types import FloatArray
from ..curves import bezier_points

#: The control points of a part of a glyph's outline: 2 for a line, 3 or 4 for a Bézier curve.
_Stroke: TypeAlias = list[tuple[float, float]]


class Writing(NamedTuple):
    """The direction, language and script of a text.

    Parameters
    ----------
    direction : str
        ``"ltr"``, ``"rtl"``, ``"ttb"`` or ``"btt"``; empty to derive it from the text.
    language : str
        A language code such as ``"en"``, never empty.
    script : str
        A script code such as ``"Latn"``; empty to derive it from the text.
    """

    direction: str = ""
    language: str = "en"
    script: str = ""


class PlacedGlyph(NamedTuple):
    """A glyph of a line of text, in design units of its font.

    Parameters
    ----------
    glyph : int
        The number of the glyph in the font; 0 if the font lacks the letter.
    cluster : int
        The index in the text of the first letter that the glyph represents.
    offset, advance : (2,) float64
        Vectors from the pen's position to the glyph, and to the next position of the pen.
    """

    glyph: int
    cluster: int
    offset: FloatArray
    advance: FloatArray


def shaped_glyphs(
    font: uharfbuzz.Font, text: str, writing: Writing
) -> tuple[list[PlacedGlyph], bool]:
    """Return the glyphs of a line of text, and True if the line is horizontal."""
    buffer = uharfbuzz.Buffer()
    buffer.add_str(text)
    buffer.guess_segment_properties()
    if writing.direction:
        buffer.direction = writing.direction
    # Set the language, since HarfBuzz would take the machine's.
    buffer.language = writing.language
    if writing.script:
        buffer.script = writing.script
    uharfbuzz.shape(font, buffer)
    pairs = zip(buffer.glyph_infos, buffer.glyph_positions or (), strict=True)
    placed = [
        PlacedGlyph(
            info.codepoint,
            info.cluster,
            np.array([at.x_offset, at.y_offset], dtype=np.float64),
            np.array([at.x_advance, at.y_advance], dtype=np.float64),
        )
        for info, at in pairs
    ]
    return placed, buffer.direction in ("ltr", "rtl")


class Glyph:
    """The outlines of a glyph, in design units of its font.

    Parameters
    ----------
    font : uharfbuzz.Font
        The font that contains the glyph.
    number : int
        The number of the glyph in the font.
    """

    def __init__(self, font: uharfbuzz.Font, number: int) -> None:
        self._contours: list[list[_Stroke]] = []
        pen = uharfbuzz.DrawFuncs()
        pen.set_move_to_func(self._move)
        pen.set_line_to_func(self._line)
        pen.set_quadratic_to_func(self._quadratic)
        pen.set_cubic_to_func(self._cubic)
        font.draw_glyph(number, pen, None)

    @property
    def bounds(self) -> FloatArray:
        """The bounding box of the control points, (2, 2) float64; zeros if there are none.

        The rows are the least and the greatest coordinates.
        """
        points = [p for contour in self._contours for stroke in contour for p in stroke]
        if not points:
            return np.zeros((2, 2))
        return np.array([np.min(points, axis=0), np.max(points, axis=0)])

    def loops(self, steps: int) -> list[FloatArray]:
        """Return the corners of each outline, (n, 2), with `steps` chords for each curve."""
        loops = []
        for contour in self._contours:
            parts = [
                bezier_points(np.array(stroke, dtype=np.float64), steps)[1:]
                if len(stroke) > 2
                else np.array(stroke[1:], dtype=np.float64)
                for stroke in contour
            ]
            loop = np.concatenate(parts) if parts else np.zeros((0, 2))
            proper = loop[(loop != np.roll(loop, 1, axis=0)).any(axis=1)]
            if len(proper) >= 3:
                loops.append(proper)
        return loops

    def _move(self, x: float, y: float, _: object) -> None:
        self._contours.append([])
        self._first = self._last = (x, y)

    def _line(self, x: float, y: float, _: object) -> None:
        self._add((x, y))

    def _quadratic(self, cx: float, cy: float, x: float, y: float, _: object) -> None:
        self._add((cx, cy), (x, y))

    def _cubic(
        self, ax: float, ay: float, bx: float, by: float, x: float, y: float, _: object
    ) -> None:
        self._add((ax, ay), (bx, by), (x, y))

    def _add(self, *points: tuple[float, float]) -> None:
        self._contours[-1].append([self._last, *points])
        self._last = points[-1]
