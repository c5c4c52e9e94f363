"""The verb that writes the connected parts of files apart: explode."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import output
from ..console.output import Output
from ..inputs.files import Inputs, Target, expanded, is_dropped, refuse_inputs, shown
from ..job import mesh_values, summary
from ..options.patterns import files_argument
from ..options.shared import PATH, common, reading, sets, verb, writing

if TYPE_CHECKING:
    from ...mesh.mesh import Mesh

_EPILOG = """\b
Example:
  bspcsg explode plates.stl lids.3mf -o 'parts/%.stl'
"""


@verb("explode", short_help="Write each connected part of files to its own.", epilog=_EPILOG)
@files_argument("A [B ...]")
@click.option(
    "-o",
    "--output",
    "target",
    required=True,
    metavar="FILE",
    type=PATH,
    help="Files to write; % stands for the name and the number of each part.",
)
@writing
@reading
@sets
@common
def explode(files: tuple[Path, ...], target: Path, **given: Any) -> int:
    """Write each connected part of files to a file of its own, the largest of each file first.

    A part of plates.stl is called plates-1, plates-2 and so on; cavities stay with what is around
    them. See split for parts of one file under a name of your choice, and for cuts.
    """
    if str(target) == "-":
        raise click.UsageError("several files cannot go to standard output; give -o a name.")
    return _Exploding(files, target, given).run()


class _Exploding:
    """Files, and the files for their parts."""

    def __init__(self, files: tuple[Path, ...], pattern: Path, settings: dict[str, Any]) -> None:
        self._files = files
        self._pattern = pattern
        self._settings = settings
        self._out = Output.of(settings)
        self._inputs = Inputs.of(self._out, settings)

    def run(self) -> int:
        """Do it, and return the exit code."""
        from ...parameters import set_threads

        set_threads(self._settings["threads"])
        self._refuse_early()
        parts = [self._parts(path) for path in self._files]
        for path, meshes in zip(self._files, parts, strict=True):
            targets = (self._target(path, number).path for number in range(1, len(meshes) + 1))
            refuse_inputs(path, targets, self._files)
        documents = [
            self._write(path, number, mesh)
            for path, meshes in zip(self._files, parts, strict=True)
            for number, mesh in enumerate(meshes, 1)
        ]
        self._out.result("", {"files": [str(path) for path in self._files], "parts": documents})
        return output.DONE

    def _parts(self, path: Path) -> "list[Mesh]":
        from ...operations.parts import connected_parts

        meshes = connected_parts(self._inputs.solid(path))
        if not meshes:
            message = f"{shown(path)}: there is nothing in it, so nothing was written."
            raise output.EmptyResultError(message, "empty_result")
        return meshes

    def _refuse_early(self) -> None:
        self._inputs.refuse_early(self._files)
        names = [self._target(path, 1).path for path in self._files]
        if len(set(names)) < len(names) and not is_dropped(self._pattern):
            raise click.UsageError("two of the files have one name, and so would their parts.")
        for path in self._files:
            self._target(path, 1).refuse_early()

    def _write(self, path: Path, number: int, mesh: "Mesh") -> dict[str, Any]:
        target = self._target(path, number)
        lost = target.write(mesh)
        for finding in lost:
            self._out.finding(shown(target.path), finding)
        if not self._out.as_json:
            self._out.result(summary(shown(target.path), mesh, False), {})
        document = {"file": str(path), "output": str(target.path), **mesh_values(mesh)}
        return {**document, "findings": output.finding_values(lost)}

    def _target(self, path: Path, number: int) -> Target:
        name = "input" if str(path) == "-" else path.stem
        return Target.of(expanded(self._pattern, f"{name}-{number}"), self._settings)
