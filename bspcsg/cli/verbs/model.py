"""The verbs `hull` and `simplify`, which make one solid of files without a set operation."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..inputs.lengths import as_length
from ..options.patterns import file_argument, files_argument
from ..options.shared import (
    ALLOW_EMPTY,
    OUTPUT,
    SIMPLIFY,
    common_options,
    reading_options,
    set_options,
    verb,
    writing_options,
)
from ..solid_verb import SolidVerb

if TYPE_CHECKING:
    from ...solid.solid import Solid

_HULL_EPILOG = """\b
Example:
  bspcsg hull left.stl right.stl -o around.stl
"""

_SIMPLIFY_EPILOG = """\b
Example:
  bspcsg simplify scan.stl -o small.stl --tolerance 0.05mm
"""


@verb("hull", short_help="Write the convex hull of all files together.", epilog=_HULL_EPILOG)
@files_argument("A [B ...]")
@OUTPUT
@writing_options
@SIMPLIFY
@ALLOW_EMPTY
@reading_options
@set_options
@common_options
def hull(files: tuple[Path, ...], **given: Any) -> int:
    """Write the convex hull of all files together, exactly.

    Each vertex of the hull is a vertex of a file, and but for rounding no vertex of a file is
    outside the hull.
    """
    return _Hull(files, **given).run()


@verb(
    "simplify", short_help="Write a solid without short edges and slivers.", epilog=_SIMPLIFY_EPILOG
)
@file_argument()
@OUTPUT
@click.option(
    "--tolerance",
    metavar="LENGTH",
    required=True,
    callback=as_length,
    help="Remove edges and slivers up to this, as 0.01mm, moving no surface farther.",
)
@writing_options
@ALLOW_EMPTY
@reading_options
@set_options
@common_options
def simplify(file: Path, **given: Any) -> int:
    """Write a solid without short edges and slivers.

    Every point of the old surface is within the tolerance of the new one, and the other way round.
    Changed triangles cross no others, and the numbers of parts, handles and cavities stay the same.
    """
    return _Simplified((file,), **given).run()


class _OfFiles(SolidVerb):
    """A job that makes a solid of files, without comparing the result with manifold3d's."""

    def __init__(self, op: str, files: tuple[Path, ...], **settings: Any) -> None:
        super().__init__(op, check="off", **settings)
        self._files = files

    def paths(self) -> Sequence[Path]:
        return self._files

    def _solids(self) -> "list[Solid]":
        solids = [self.inputs.solid(path) for path in self._files]
        self.lap("read")
        return solids


class _Hull(_OfFiles):
    """The work of the verb `hull`: it makes the convex hull of all files together."""

    def __init__(self, files: tuple[Path, ...], **settings: Any) -> None:
        super().__init__("hull", files, **settings)

    def combined(self) -> "Solid":
        from ...modelling.bodies.hulls import hull as hull_of

        solid: Solid = hull_of(self._solids())
        return solid


class _Simplified(_OfFiles):
    """The work of the verb `simplify`: the solid of one file, which `SolidVerb.run` simplifies."""

    def __init__(self, files: tuple[Path, ...], **settings: Any) -> None:
        super().__init__("simplify", files, **settings)

    def combined(self) -> "Solid":
        return self._solids()[0]
