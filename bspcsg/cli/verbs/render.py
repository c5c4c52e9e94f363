"""The verb `render`, which draws pictures of meshes."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import BspcsgError
from ..console.output import counted
from ..drawing_verb import DrawingVerb
from ..options.camera import camera_of, refuse_contradictions, view_options
from ..options.patterns import files_argument
from ..options.shared import (
    SECONDS,
    common_options,
    drawing_options,
    is_given,
    numbers,
    rare_option,
    reading_options,
    verb,
)
from ..pages.file_layers import layers_of

if TYPE_CHECKING:
    from ..._types import FloatArray
    from ...bsp import PartitionTree, Picture
    from ...report.viewer.layer import Layer

_EPILOG = """\b
Examples:
  bspcsg render part.stl -o part.png --view front --size 1200x900
  bspcsg render a.stl b.stl -o both.png --azimuth 30 --elevation 20
  bspcsg render part.py -o inside.png --section 1,0,0,5 --colours origin
  bspcsg render part.stl -o turning.gif --frames 48
  bspcsg render part.stl -o - --to svg | display
"""

_SUFFIXES = (".svg", ".png", ".gif")
_STYLES = ("shaded", "hidden", "edges")

#: The value of ``--background`` for a transparent picture.
_TRANSPARENT = "none"

_TEXTURES = (
    "each face is drawn in one colour, that of its texture in the middle of the face; bspcsg"
    " view shows the full texture."
)

#: The largest and the default number of pictures of one turn, in a GIF.
_MAX_FRAMES, _DEFAULT_FRAMES = 360, 36

#: The longest time for which a GIF can show a picture, in seconds: two bytes count hundredths.
_MAX_FRAME_SECONDS = 655

#: The number of points on the circle along which a corner of the bounding box turns.
_AROUND = 72


def _as_size(context: click.Context, option: click.Parameter, value: str) -> tuple[int, int]:
    """Convert a text such as “800x600” to width and height in pixels."""
    from ...bsp.painting.picture import checked_size

    words = value.lower().split("x")
    if len(words) != 2 or not all(word.isdecimal() for word in words):
        wanted = "width and height in pixels, as in 800x600"
        raise click.BadParameter(
            f"{value!r} is not a picture size; give {wanted}.", context, option
        )
    try:
        return checked_size([int(word) for word in words])
    except BspcsgError as error:
        raise click.BadParameter(error.message, context, option) from None


def _as_colour(context: click.Context, option: click.Parameter, value: str) -> str | None:
    """Return a valid name or code of a colour unchanged; “none” becomes None, for transparent."""
    from ...bsp.painting.colours import colour

    if value == _TRANSPARENT:
        return None
    try:
        colour(value)
    except BspcsgError:
        wanted = f"{_TRANSPARENT} or a colour like orange or '#3070b0'"
        raise click.BadParameter(f"{value!r} is not {wanted}.", context, option) from None
    return value


def _as_colours(context: click.Context, option: click.Parameter, value: str | None) -> str | None:
    """Return the value of ``--colours``; raise a usage error for an invalid code such as “#12”."""
    from ...bsp.painting.colours import colour

    if value is None or not value.startswith("#"):
        return value
    try:
        colour(value)
        return value
    except BspcsgError as error:
        raise click.BadParameter(error.message, context, option) from None


def _is_colour(word: str) -> bool:
    from ...bsp.painting.colours import colour

    try:
        colour(word)
    except BspcsgError:
        return False
    return True


def _is_paint(word: str, layers: "list[Layer]") -> bool:
    return any(paint.name == word for layer in layers for paint in layer.paints)


@verb("render", short_help="Write a picture of meshes.", epilog=_EPILOG)
@files_argument("FILE [...]")
@drawing_options
@view_options
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
    "--colours",
    "--colors",
    "colours",
    metavar="WHAT",
    callback=_as_colours,
    help="part, origin (which operand of a script), the name of an attribute, or a colour like"
    " orange or '#3070b0'; by default the file's own.",
)
@click.option(
    "--section",
    metavar="NX,NY,NZ,D",
    callback=numbers("section", "nx,ny,nz,d", "0,0,1,2.5"),
    help="Show only what has nx x + ny y + nz z up to d, closed where it is cut.",
)
@click.option(
    "--background",
    metavar="COLOUR",
    default="white",
    show_default=True,
    callback=_as_colour,
    help="A colour like orange or '#3070b0', or none for transparent.",
)
@rare_option(
    "--frames",
    metavar="N",
    type=click.IntRange(2, _MAX_FRAMES),
    default=_DEFAULT_FRAMES,
    show_default=True,
    help="Pictures of one turn around z, in a GIF.",
)
@rare_option(
    "--seconds",
    metavar="T",
    type=SECONDS,
    default=4.0,
    show_default=True,
    help="How long one turn takes, in a GIF.",
)
@reading_options
@common_options
def render(files: tuple[Path, ...], target: Path, **given: Any) -> int:
    """Write a picture of meshes as SVG or PNG, or pictures of one turn around z as GIF.

    Faces are painted from back to front. Meshes need not be closed, except for --section. PNG and
    GIF need Pillow; bspcsg doctor says whether it is installed.
    """
    return _Rendering(files, target, _SUFFIXES, **given).run()


class _Rendering(DrawingVerb):
    """The work of the verb `render`: it draws a picture of meshes, or several in a GIF."""

    def __init__(self, files: tuple[Path, ...], *paths: Any, **settings: Any) -> None:
        super().__init__(files[0], *paths, **settings)
        refuse_contradictions(settings)
        if self.suffix != ".gif":
            for name in ("frames", "seconds"):
                if is_given(name):
                    raise click.UsageError(
                        f"--{name} can only be used when the output is a .gif file."
                    )
        elif settings["seconds"] > _MAX_FRAME_SECONDS * settings["frames"]:
            message = (
                f"--seconds: each frame of a GIF can last at most {_MAX_FRAME_SECONDS} s;"
                " raise --frames, or lower --seconds."
            )
            raise click.UsageError(message)
        self._files = files

    def sources(self) -> tuple[Path, ...]:
        return self._files

    def drawn(self) -> tuple[bytes, str, dict[str, Any]]:
        width, height = self.settings["size"]
        layers, _ = layers_of(self.inputs, self._files, self.settings["section"])
        names = ("view", "style")
        values = {**{name: self.settings[name] for name in names}, "size": [width, height]}
        if self.suffix == ".gif":
            data, more, words = self._turn(layers)
        else:
            picture = self._picture(layers)
            data = picture.svg.encode() if self.suffix == ".svg" else picture.png
            polygons = picture.polygons
            more, words = {"polygons": polygons}, counted(polygons, "polygon")
        return data, f"{width} x {height} pixels  {words}", {**values, **more}

    def _looks(self, layers: "list[Layer]") -> dict[str, Any]:
        names = ("size", "style", "background")
        looks = {name: self.settings[name] for name in names}
        return {**looks, "colors": self._colours(layers)}

    def _colours(self, layers: "list[Layer]") -> Any:
        """Return a colour for each face, one colour for all faces, or None for the default."""
        from ...report.viewer.face_colours import are_textured, face_colours

        given = self.settings["colours"]
        if given is not None and given.startswith("#"):
            return given
        if given is not None and _is_colour(given) and not _is_paint(given, layers):
            return given
        if given is None and len(layers) == 1 and not layers[0].paints:
            return None
        try:
            colours = face_colours(layers, given)
        except BspcsgError as error:
            raise click.UsageError(f"--colours: {error.message}") from None
        if given is None and are_textured(layers):
            self.out.note(_TEXTURES)
        return colours if len(colours) else None

    def _picture(self, layers: "list[Layer]") -> "Picture":
        from ...bsp.painting.picture import picture
        from ...report.viewer.face_colours import joined

        mesh = joined(layers)
        width, height = self.settings["size"]
        camera = camera_of(self.settings, mesh[0][_used(mesh[1])], width / height)
        return picture(mesh, camera=camera, **self._looks(layers))

    def _turn(self, layers: "list[Layer]") -> tuple[bytes, dict[str, Any], str]:
        from ...bsp import PartitionTree
        from ...bsp.painting.turntable import gif
        from ...report.viewer.face_colours import joined

        frames = self.settings["frames"]
        vertices, faces = joined(layers)
        # One tree is enough for all points of view.
        tree = PartitionTree(vertices[faces], "random", top=16, degenerate="drop")
        pictures = self._turning(layers, tree, vertices[_used(faces)])
        data = gif(pictures, self.settings["seconds"])
        return data, {"frames": frames}, counted(frames, "frame")

    def _turning(
        self, layers: "list[Layer]", tree: "PartitionTree", points: "FloatArray"
    ) -> "Iterator[Picture]":
        from ...bsp.painting.picture import picture

        width, height = self.settings["size"]
        looks = self._looks(layers)
        room = _room_to_turn(points)
        for frame in range(self.settings["frames"]):
            turn = 360 * frame / self.settings["frames"]
            camera = camera_of(self.settings, room, width / height, turn)
            yield picture(tree, camera=camera, **looks)


def _used(faces: Any) -> Any:
    from ...formats.raw import compacted

    return compacted(faces)[0]


def _room_to_turn(points: "FloatArray") -> "FloatArray":
    """Return points around the bounding box of `points` in all its rotations about its z axis."""
    import numpy as np

    if not len(points):
        return points
    low, high = points.min(axis=0), points.max(axis=0)
    angles = np.arange(_AROUND) * (2 * np.pi / _AROUND)
    radius = np.hypot(*(high - low)[:2]) / 2
    circle = np.column_stack([np.cos(angles), np.sin(angles)]) * radius + (low + high)[:2] / 2
    rings = [np.column_stack([circle, np.full(_AROUND, z)]) for z in (low[2], high[2])]
    room: FloatArray = np.concatenate(rings)
    return room
