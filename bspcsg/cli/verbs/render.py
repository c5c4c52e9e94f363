"""The verb that makes pictures: render."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import BspcsgError
from ..drawing import Drawing
from ..files import shown
from ..options import common, drawing, reading
from ..output import counted
from ..patterns import file_argument

if TYPE_CHECKING:
    from ...bsp import Picture

_EPILOG = """\b
Examples:
  bspcsg render part.stl -o part.png --view front --size 1200x900
  bspcsg render part.stl -o - --to svg | display
"""

_SUFFIXES = (".svg", ".png")
_VIEWS = ("iso", "front", "back", "left", "right", "top", "bottom")
_STYLES = ("shaded", "hidden", "edges")

#: The background that lets through what is behind the picture.
_TRANSPARENT = "none"


def _as_size(context: click.Context, option: click.Parameter, value: str) -> tuple[int, int]:
    """Return width and height in pixels."""
    from ...bsp.painting.picture import checked_size

    words = value.lower().split("x")
    if len(words) != 2 or not all(word.isdecimal() for word in words):
        wanted = "width and height in pixels, as in 800x600"
        raise click.BadParameter(f"{value!r} is no size; it takes {wanted}.", context, option)
    try:
        return checked_size([int(word) for word in words])
    except BspcsgError as error:
        raise click.BadParameter(error.message, context, option) from None


def _as_colour(context: click.Context, option: click.Parameter, value: str) -> str | None:
    """Return a colour that pictures take, or None for transparent."""
    from ...bsp.painting.colours import colour

    if value == _TRANSPARENT:
        return None
    try:
        colour(value)
    except BspcsgError:
        wanted = f"white, black, {_TRANSPARENT} or a colour like '#3070b0'"
        raise click.BadParameter(f"{value!r} is not {wanted}.", context, option) from None
    return value


@click.command("render", short_help="Write a picture of a mesh.", epilog=_EPILOG)
@file_argument()
@drawing
@click.option(
    "--view",
    type=click.Choice(_VIEWS),
    default="iso",
    show_default=True,
    help="From where; z is up, front looks along +y.",
)
@click.option(
    "--size",
    metavar="WxH",
    default="800x600",
    show_default=True,
    callback=_as_size,
    help="Width and height in pixels.",
)
@click.option(
    "--style",
    type=click.Choice(_STYLES),
    default="shaded",
    show_default=True,
    help="Light and edges, a drawing with hidden lines removed, or all edges.",
)
@click.option(
    "--background",
    metavar="COLOUR",
    default="white",
    show_default=True,
    callback=_as_colour,
    help="white, black, a colour like '#3070b0', or none for transparent.",
)
@reading
@common
def render(file: Path, target: Path, **given: Any) -> int:
    """Write a picture of a mesh as SVG or PNG, painted from back to front.

    The mesh need not be closed. PNG needs Pillow; bspcsg doctor says whether it is there.
    """
    return _Rendering(file, target, _SUFFIXES, **given).run()


class _Rendering(Drawing):
    """One mesh, seen from somewhere."""

    def drawn(self) -> tuple[bytes, str, dict[str, Any]]:
        picture = self._picture()
        width, height = self.settings["size"]
        polygons = len(picture.painting.source)
        values = {
            "view": self.settings["view"],
            "style": self.settings["style"],
            "size": [width, height],
            "polygons": polygons,
        }
        data = picture.svg.encode() if self.suffix == ".svg" else picture.png
        return data, f"{width} x {height} pixels  {counted(polygons, 'polygon')}", values

    def _picture(self) -> "Picture":
        from ...bsp.painting.picture import picture

        raw = self.inputs.raw(self.file)
        self.inputs.tell(self.file, raw.findings)
        if not len(raw.faces):
            self.out.warning(f"{shown(self.file)}: there is nothing in it to be seen.")
        names = ("view", "size", "style", "background")
        looks = {name: self.settings[name] for name in names}
        return picture((raw.vertices, raw.faces), **looks)
