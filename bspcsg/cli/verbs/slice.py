"""The verb `slice`, which draws the section of a solid by a plane."""

import math
from pathlib import Path
from typing import Any

import click

from ...errors import Finding
from ..console import output
from ..console.output import counted
from ..drawing_verb import DrawingVerb
from ..inputs.files import display_name
from ..options.patterns import file_argument
from ..options.shared import (
    common_options,
    drawing_options,
    numbers,
    reading_options,
    set_options,
    verb,
)

_EPILOG = """\b
Example:
  bspcsg slice part.stl -o layer.dxf --z 2.5
"""

_SUFFIXES = (".svg", ".dxf")
_UPWARDS = (0.0, 0.0, 1.0)


def _as_finite(
    context: click.Context, option: click.Parameter, value: float | None
) -> float | None:
    """Return a number unchanged; raise a usage error if it is infinite or NaN."""
    if value is not None and not math.isfinite(value):
        raise click.BadParameter(f"{value} is not a finite number.", context, option)
    return value


@verb("slice", short_help="Write the section of a solid by a plane.", epilog=_EPILOG)
@file_argument()
@drawing_options
@click.option(
    "--z", "height", type=float, metavar="HEIGHT", callback=_as_finite, help="Cut at this height."
)
@click.option(
    "--normal",
    metavar="NX,NY,NZ",
    callback=numbers("normal", "nx,ny,nz", "1,0,0"),
    help="Cut along nx x + ny y + nz z = d.",
)
@click.option(
    "--offset",
    type=float,
    metavar="D",
    callback=_as_finite,
    help="The d of --normal; 0 by default.",
)
@reading_options
@set_options
@common_options
def section(file: Path, target: Path, **given: Any) -> int:
    """Write the section of a solid by a plane as an SVG or DXF drawing.

    The normal points towards the viewer: the drawing has the coordinates (x, y) for the normal z,
    (y, z) for x, and (z, x) for y. A face in the plane counts as above it, so the section of a box
    standing on z = 0 is empty at z = 0 and full at its top. DXF needs the extra bspcsg[dxf].
    """
    return _Section(file, target, _SUFFIXES, **given).run()


class _Section(DrawingVerb):
    """The work of the verb `slice`: it draws the section of one solid by one plane."""

    def __init__(self, *paths: Any, **settings: Any) -> None:
        super().__init__(*paths, **settings)
        self._normal, self._offset = _plane(**{name: settings[name] for name in _PLANE})

    def drawn(self) -> tuple[bytes, str, dict[str, Any]]:
        solid = self.inputs.solid(self.file)
        region = solid.slice(self._offset, self._normal)
        self._tell_of_plane(solid.pitch)
        if region.is_empty:
            raise output.EmptyResultError(self._missed(), "empty_result")
        holes = sum(outline.is_hole for outline in region.outlines)
        count = len(region.outlines)
        values = {
            "normal": list(self._normal),
            "offset": self._offset,
            "area": region.area,
            "perimeter": region.perimeter,
            "outlines": count,
            "holes": holes,
            "bounds": None if region.bounds is None else region.bounds.tolist(),
        }
        words = f"{counted(count, 'outline')}, {counted(holes, 'hole')} among them"
        return self.data(region), f"area {region.area:.9g}  {words}", values

    def _tell_of_plane(self, pitch: int) -> None:
        """Print a note if the plane on the lattice differs from the requested plane."""
        from ...geometry.hyperplane import Hyperplane

        plane = Hyperplane.from_numbers(self._normal, self._offset).on_lattice(pitch)
        if plane.note is not None:
            finding = Finding("half_space_rounded", "note", plane.note, (), 1)
            self.out.finding(display_name(self.file), finding)

    def _missed(self) -> str:
        normal = ",".join(f"{number:g}" for number in self._normal)
        return (
            f"{display_name(self.file)}: the plane with normal {normal} and offset"
            f" {self._offset:g} does"
            " not cut it, so nothing was written; bspcsg info shows the bounds."
        )


_PLANE = ("height", "normal", "offset")


def _plane(
    height: float | None, normal: tuple[float, ...] | None, offset: float | None
) -> tuple[tuple[float, ...], float]:
    """Return normal and offset of the plane that the options describe."""
    if (height is None) == (normal is None):
        raise click.UsageError(
            "the cutting plane is missing, or given twice; give either --z HEIGHT or --normal"
            " NX,NY,NZ."
        )
    if height is None:
        return normal or _UPWARDS, offset or 0.0
    if offset is not None:
        raise click.UsageError(
            "--offset can only be used with --normal; with --z, the height is the offset already."
        )
    return _UPWARDS, height
