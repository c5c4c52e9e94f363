"""The verb `project`, which draws the shadow of a solid on the plane z = 0."""

from pathlib import Path
from typing import Any

from ..console import output
from ..console.output import counted
from ..drawing_verb import DrawingVerb
from ..inputs.files import display_name
from ..options.patterns import file_argument
from ..options.shared import common_options, drawing_options, reading_options, set_options, verb

_EPILOG = """\b
Example:
  bspcsg project part.stl -o outline.dxf
"""

_SUFFIXES = (".svg", ".dxf")


@verb("project", short_help="Write the outline of a solid seen from above.", epilog=_EPILOG)
@file_argument()
@drawing_options
@reading_options
@set_options
@common_options
def project(file: Path, target: Path, **given: Any) -> int:
    """Write the shadow of a solid on the plane z = 0 as an SVG or DXF drawing.

    The shadow consists of the points (x, y) with a point of the solid above or below them. DXF
    needs the extra bspcsg[dxf].
    """
    return _Projection(file, target, _SUFFIXES, **given).run()


class _Projection(DrawingVerb):
    """The work of the verb `project`: it draws the region below and above a solid."""

    def drawn(self) -> tuple[bytes, str, dict[str, Any]]:
        region = self.inputs.solid(self.file).project()
        if region.is_empty:
            message = (
                f"{display_name(self.file)}: the solid is empty, so its projection is empty and"
                " nothing"
                " was written."
            )
            raise output.EmptyResultError(message, "empty_result")
        holes = sum(outline.is_hole for outline in region.outlines)
        count = len(region.outlines)
        values = {
            "area": region.area,
            "perimeter": region.perimeter,
            "outlines": count,
            "holes": holes,
            "bounds": None if region.bounds is None else region.bounds.tolist(),
        }
        words = f"{counted(count, 'outline')}, {counted(holes, 'hole')} among them"
        return self.data(region), f"area {region.area:.9g}  {words}", values
