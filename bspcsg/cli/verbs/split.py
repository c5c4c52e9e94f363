"""The verb `split`, which writes the connected parts of solids, or both sides of a cut."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import Finding
from ..console import output
from ..console.output import Output
from ..inputs.files import Inputs, Target, display_name, expanded, is_dropped, refuse_inputs
from ..options.patterns import files_argument
from ..options.shared import (
    PATH,
    SIMPLIFY,
    check_depth,
    common_options,
    numbers,
    reading_options,
    set_options,
    verb,
    writing_options,
)
from ..solid_verb import mesh_values, summary

if TYPE_CHECKING:
    from ...mesh.mesh import Mesh
    from ...solid.solid import Solid

_EPILOG = """\b
Examples:
  bspcsg split plates.stl -o 'plate-%.stl'
  bspcsg split plates.stl lids.3mf -o 'parts/%.stl'
  bspcsg split part.stl --plane 0,0,1,2.5 -o 'half-%.ply'
  bspcsg split part.stl --by cutter.stl -o 'side-%.ply'
"""

#: The former verb that put the name of the file into the names of its parts, even for one file.
_FORMER = "explode"


@verb(
    "split",
    short_help="Write the connected parts of solids, or both sides of a cut.",
    epilog=_EPILOG,
)
@files_argument("FILE [...]")
@click.option(
    "-o",
    "--output",
    "target",
    required=True,
    metavar="FILE",
    type=PATH,
    help="Files to write; % stands for the number of each part, after the name of several files.",
)
@click.option(
    "--plane",
    metavar="NX,NY,NZ,D",
    callback=numbers("plane", "nx,ny,nz,d", "0,0,1,2.5"),
    help="Cut along nx x + ny y + nz z = d; z,D is short for 0,0,1,D.",
)
@click.option(
    "--by", "cutter", metavar="FILE", type=PATH, help="Cut along the surface of another solid."
)
@writing_options
@SIMPLIFY
@check_depth
@reading_options
@set_options
@common_options
@click.pass_context
def split(context: click.Context, /, files: tuple[Path, ...], target: Path, **given: Any) -> int:
    """Write each connected component of solids to a file of its own, the largest first.

    With --plane, part 1 is the side with nx x + ny y + nz z below d, part 2 the side above. With
    --by, part 1 is outside the solid of --by, part 2 inside. Both sides of a cut are closed, and
    their union is exactly the whole.

    The % in the name of -o stands for 1, 2 and so on, or with several files for plates-1, plates-2
    after plates.stl. Without a %, this is added before the suffix.
    """
    if given["plane"] and given["cutter"]:
        raise click.UsageError("--plane and --by cannot be combined; give one of them.")
    if str(target) == "-":
        raise click.UsageError(
            "several parts cannot be written to standard output; give -o a file name with %."
        )
    by_name = len(files) > 1 or context.info_name == _FORMER
    return _Splitting(files, target, by_name, given).run()


@dataclass
class _Parts:
    """The parts of a file, and the verdict of each one's comparison with manifold3d, if any."""

    file: Path
    meshes: "list[Mesh]"
    verdicts: list[str] = field(default_factory=list)


class _Splitting:
    """The work of the verb `split`: it divides solids and writes their parts."""

    def __init__(
        self, files: tuple[Path, ...], pattern: Path, by_name: bool, settings: dict[str, Any]
    ) -> None:
        self._files = files
        self._pattern = pattern
        self._by_name = by_name
        self._settings = settings
        self._out = Output.of(settings)
        self._inputs = Inputs.of(self._out, settings)

    def run(self) -> int:
        """Split all files, write the parts, and return the exit code."""
        from ...parameters import set_threads

        set_threads(self._settings["threads"])
        self._refuse_early()
        found = [self._parts(file) for file in self._files]
        failed = [one.file for one in found if "subject failed" in one.verdicts]
        for file in failed:
            self._out.result(
                f"{display_name(file)}: not written, because the check of the parts failed", {}
            )
        if failed:
            return output.FOUND
        self._write(found)
        verdicts = [verdict for one in found for verdict in one.verdicts]
        return output.FOUND if "DISAGREE" in verdicts else output.DONE

    def _read(self) -> list[Path]:
        """Return the files that are read: the inputs, and the solid of ``--by``."""
        cutter = self._settings["cutter"]
        return [*self._files, cutter] if cutter else list(self._files)

    def _refuse_early(self) -> None:
        names = [self._target(file, 1).path for file in self._files]
        if len(set(names)) < len(names) and not is_dropped(self._pattern):
            raise click.UsageError(
                "two of the input files have the same name, so their parts would overwrite each"
                " other; split them separately."
            )
        for file in self._files:
            self._target(file, 1).refuse_early()
        self._inputs.refuse_early(self._read())

    def _parts(self, file: Path) -> _Parts:
        from ...operations.parts import connected_parts, sides_of_plane

        solid = self._inputs.solid(file)
        plane, cutter = self._settings["plane"], self._settings["cutter"]
        if not plane and not cutter:
            meshes = connected_parts(self._simplified(file, solid))
            self._refuse_less_than(1, file, meshes)
            return _Parts(file, meshes)
        if plane:
            sides: Sequence[Solid] = sides_of_plane(solid, plane[:3], plane[3])
            self._tell_of_plane(file, sides[0])
        else:
            other = self._inputs.solid(cutter)
            sides = (solid - other, solid & other)
        meshes = [self._simplified(file, side).normalized().to_mesh() for side in sides]
        self._refuse_less_than(2, file, [mesh for mesh in meshes if len(mesh.faces)])
        depth = self._settings["check"]
        checked = sides if depth != "off" else ()
        return _Parts(file, meshes, [str(s.validate(depth=depth).verdict) for s in checked])

    def _simplified(self, file: Path, solid: "Solid") -> "Solid":
        """Return a solid, without short edges and slivers if ``--simplify`` is given."""
        tolerance = self._settings["tolerance"]
        simple = solid.simplify(tolerance) if tolerance else solid
        if simple is not solid:
            self._inputs.print_findings(file, simple.normalized().findings)
        return simple

    def _tell_of_plane(self, file: Path, side: "Solid") -> None:
        """Print a note if the plane on the lattice differs from the requested plane."""
        found = [Finding.from_core(finding) for finding in side.tree.findings]
        self._inputs.print_findings(
            file, [one for one in found if one not in self._inputs.noticed_findings]
        )

    def _refuse_less_than(self, least: int, file: Path, meshes: "list[Mesh]") -> None:
        if len(meshes) >= least:
            return
        what = "the solid is empty" if least == 1 else "the whole solid lies on one side of the cut"
        message = f"{display_name(file)}: {what}, so nothing was written."
        raise output.EmptyResultError(message, "empty_result")

    def _write(self, found: list[_Parts]) -> None:
        for one in found:
            numbers_of = range(1, len(one.meshes) + 1)
            targets = (self._target(one.file, number).path for number in numbers_of)
            refuse_inputs(one.file, targets, self._read())
        documents = [document for one in found for document in self._written(one)]
        files = [str(file) for file in self._files]
        whole = {"file": files[0]} if len(files) == 1 else {}
        self._out.result("", {**whole, "files": files, "parts": documents})

    def _written(self, parts: _Parts) -> Iterator[dict[str, Any]]:
        """Write the parts of a file, print a line for each, and yield their JSON documents."""
        for number, mesh in enumerate(parts.meshes, 1):
            target = self._target(parts.file, number)
            lost = target.write(mesh)
            for finding in lost:
                self._out.finding(display_name(target.path), finding)
            verdict = parts.verdicts[number - 1] if parts.verdicts else None
            line = summary(display_name(target.path), mesh, False)
            line += f"\n  check: {verdict}" if verdict else ""
            if not self._out.as_json:
                self._out.result(line, {})
            document = {"file": str(parts.file), "output": str(target.path), **mesh_values(mesh)}
            yield {**document, "check": verdict, "findings": output.finding_values(lost)}

    def _target(self, file: Path, number: int) -> Target:
        stem = "input" if str(file) == "-" else file.stem
        name = f"{stem}-{number}" if self._by_name else str(number)
        return Target.of(expanded(self._pattern, name), self._settings)
