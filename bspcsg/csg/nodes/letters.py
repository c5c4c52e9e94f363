"""Text as plane figures: text."""

from typing import Any, get_args

from ...bsp import Region
from ...errors import InvalidParameterError
from ...modelling.planar.lettering.fonts import (
    FAMILY,
    FontFile,
    font_file,
    stand_in,
    wants_whole_pixels,
)
from ...modelling.planar.lettering.shaping import Writing
from ...modelling.planar.lettering.text import (
    EM,
    Direction,
    HorizontalAlignment,
    Lettering,
    VerticalAlignment,
    lettered,
    steps_of,
)
from ..making.tessellation import Fineness
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .signature import Signature

#: OpenSCAD 2021.01 takes a pixel of FreeType for this part of the size where it draws glyphs…
_PIXEL = 64 / 100_000

#: … and for a 1600th of it where it measures lines and moves from letter to letter.
_TIGHTNESS = 1000 / 1024


_TEXT = Signature(
    ("text", "size", "font"), ("halign", "valign", "spacing", "direction", "language", "script")
)


@node("text", takes=_TEXT)
def text(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Write a line of text; missing fonts are replaced by the package's own."""
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
        _ink(file),
        _TIGHTNESS,
        _PIXEL * size,
    )
    region, missing = lettered(string, file, look)
    if missing:
        run.warn(owner, f"the font has no glyph for {' '.join(missing[:8])}")
    return region


def _ink(file: FontFile) -> float:
    """Return FreeType's scale factor for a font whose em must be a whole number of pixels."""
    pixels = EM / _PIXEL
    return round(pixels) / pixels if wants_whole_pixels(file) else 1.0


def _font(owner: Node, arguments: Arguments, run: Evaluation) -> FontFile:
    name = arguments.text("font", "")
    try:
        return font_file(name, paths=False)
    except InvalidParameterError:
        run.warn(owner, f"the font “{name}” is not installed; {FAMILY} is used instead")
        return stand_in(name)


def _choice(
    owner: Node, arguments: Arguments, run: Evaluation, name: str, default: str, known: Any
) -> Any:
    """Return an argument that must be one of some words; any other value counts as the default."""
    word = arguments.text(name, default)
    if word == "default":  # which dumps of OpenSCAD have since 2024
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
