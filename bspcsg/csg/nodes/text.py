"""Evaluation of the node text."""

from typing import Any, get_args

from ...bsp import Region
from ...errors import InvalidParameterError
from ...modelling.planar.lettering.fonts import (
    FAMILY,
    FontFile,
    font_file,
    substitute_font,
    wants_whole_pixels,
)
from ...modelling.planar.lettering.shaping import Writing
from ...modelling.planar.lettering.text import (
    EM,
    Direction,
    HorizontalAlignment,
    Lettering,
    VerticalAlignment,
    steps_of,
    text_region,
)
from ..making.tessellation import Fineness
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .signature import Signature

#: The width of a FreeType pixel relative to the text's size, where OpenSCAD 2021.01 draws glyphs.
_PIXEL = 64 / 100_000

#: The ratio of the unit in which OpenSCAD 2021.01 measures lines and advances from letter to letter
#: to the unit in which it draws glyphs.
_TIGHTNESS = 1000 / 1024


_TEXT = Signature(
    ("text", "size", "font"), ("halign", "valign", "spacing", "direction", "language", "script")
)


@node("text", takes=_TEXT)
def text(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return a line of text as a region; a missing font is replaced by the package's font."""
    del children
    arguments = run.arguments(owner)
    string, size = arguments.text("text", ""), arguments.number("size", 10.0)
    if not string or size <= 0:
        return Region.empty()
    spacing = arguments.number("spacing", 1.0)
    file = _font(owner, arguments, run)
    look = Lettering(
        size * EM,
        _choice(owner, arguments, run, "halign", "left", HorizontalAlignment),
        _choice(owner, arguments, run, "valign", "baseline", VerticalAlignment),
        spacing,
        _writing(owner, arguments, run),
        steps_of(arguments.sides(Fineness.of(arguments).fragments(size), "this text")),
        _glyph_scale(file),
        _TIGHTNESS,
        _PIXEL * size,
    )
    region, missing = text_region(string, file, look)
    if missing:
        run.warn(owner, f"the font has no glyph for {' '.join(missing[:8])}")
    return region


def _glyph_scale(file: FontFile) -> float:
    """Return the factor by which FreeType scales glyphs to make the em a whole number of pixels.

    It is 1 for a font that does not ask for that.
    """
    pixels = EM / _PIXEL
    return round(pixels) / pixels if wants_whole_pixels(file) else 1.0


def _font(owner: Node, arguments: Arguments, run: Evaluation) -> FontFile:
    name = arguments.text("font", "")
    try:
        return font_file(name, paths=False)
    except InvalidParameterError:
        run.warn(owner, f"the font “{name}” is not installed; {FAMILY} is used instead")
        return substitute_font(name)


def _choice(
    owner: Node, arguments: Arguments, run: Evaluation, name: str, default: str, known: Any
) -> Any:
    """Return an argument that is one of the `known` texts; else warn and return `default`."""
    word = arguments.text(name, default)
    if word == "default":  # written by OpenSCAD since 2024
        return default
    if word in get_args(known):
        return word
    run.warn(
        owner, f"its {name} “{word}” is unknown and ignored; known are {', '.join(get_args(known))}"
    )
    return default


def _writing(owner: Node, arguments: Arguments, run: Evaluation) -> Writing:
    direction = arguments.text("direction", "")
    if direction:
        direction = _choice(owner, arguments, run, "direction", "ltr", Direction)
    script, language = arguments.text("script", ""), arguments.text("language", "en")
    known = len(script) == 4 and script.isascii() and script.isalpha()
    return Writing(
        direction, language if language.isascii() and language else "en", script if known else ""
    )
