"""The verb that takes a solid apart: split."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import Finding
from ..console import output
from ..console.output import Output
from ..inputs.files import Inputs, Target, expanded, refuse_inputs, shown
from ..job import mesh_values, summary
from ..options.patterns import file_argument
from ..options.shared import (
    PATH,
    SIMPLIFY,
    check_depth,
    common,
    numbers,
    reading,
    sets,
    verb,
    writing,
)

if TYPE_CHECKING:
    from ...mesh.mesh import Mesh
    from ...solid.solid import Solid

_EPILOG = """\b
Examples:
  bspcsg split plates.stl -o 'plate-%.stl'
  bspcsg split part.stl --plane 0,0,1,2.5 -o 'half-%.ply'
  bspcsg split part.stl --by cutter.stl -o 'side-%.ply'
"""


@verb(
    "split",
    short_help="Write the connected parts of a solid, or both sides of a cut.",
    epilog=_EPILOG,
)
@file_argument()
@click.option(
    "-o",
    "--output",
    "target",
    required=True,
    metavar="FILE",
    type=PATH,
    help="Files to write; % stands for the number of each, else it goes before the suffix.",
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
@writing
@SIMPLIFY
@check_depth
@reading
@sets
@common
def split(file: Path, target: Path, **given: Any) -> int:
    """Write each connected component of a solid to a file of its own, the largest first.

    With --plane, number 1 is the side with nx x + ny y + nz z below d, number 2 the other. With
    --by, number 1 is what is outside the other solid, number 2 what is inside. A cut closes both
    sides, and together they are the whole again, exactly.
    """
    if given["plane"] and given["cutter"]:
        raise click.UsageError("--plane and --by exclude each other.")
    return _Splitting(file, target, **given).run()


class _Splitting:
    """One solid, and the files for its parts."""

    def __init__(self, file: Path, target: Path, **settings: Any) -> None:
        self._file = file
        self._pattern = target
        self._settings = settings
        self._out = Output.of(settings)
        self._inputs = Inputs.of(self._out, settings)
        if str(target) == "-":
            raise click.UsageError("several files cannot go to standard output; give -o a name.")

    def run(self) -> int:
        from ...parameters import set_threads

        set_threads(self._settings["threads"])
        self._target("1").refuse_early()
        self._inputs.refuse_early(self._read())
        solid = self._inputs.solid(self._file)
        meshes, verdicts = self._parts(solid)
        if "subject failed" in verdicts:
            self._out.result(f"{shown(self._file)}: not written; check: subject failed", {})
            return output.FOUND
        self._write(meshes, verdicts)
        return output.FOUND if "DISAGREE" in verdicts else output.DONE

    def _read(self) -> list[Path]:
        """Return the files that are read."""
        cutter = self._settings["cutter"]
        return [self._file, cutter] if cutter else [self._file]

    def _parts(self, solid: "Solid") -> tuple[list["Mesh"], list[str]]:
        """Return the parts, and manifold3d's verdict on each if there is one."""
        from ...operations.parts import connected_parts, sides_of_plane

        plane, cutter = self._settings["plane"], self._settings["cutter"]
        if not plane and not cutter:
            meshes = connected_parts(self._simplified(solid))
            self._refuse_less_than(1, meshes)
            return meshes, []
        if plane:
            sides: Sequence[Solid] = sides_of_plane(solid, plane[:3], plane[3])
            self._tell_of_plane(sides[0])
        else:
            other = self._inputs.solid(cutter)
            sides = (solid - other, solid & other)
        meshes = [self._simplified(side).normalized().to_mesh() for side in sides]
        self._refuse_less_than(2, [mesh for mesh in meshes if len(mesh.faces)])
        depth = self._settings["check"]
        checked = sides if depth != "off" else ()
        return meshes, [str(side.validate(depth=depth).verdict) for side in checked]

    def _simplified(self, solid: "Solid") -> "Solid":
        """Return a solid without short edges and slivers, if that is asked for."""
        tolerance = self._settings["tolerance"]
        simple = solid.simplify(tolerance) if tolerance else solid
        if simple is not solid:
            self._inputs.tell(self._file, simple.normalized().findings)
        return simple

    def _tell_of_plane(self, side: "Solid") -> None:
        """Say whether the plane is another one than was asked for."""
        found = [Finding.from_core(finding) for finding in side.tree.findings]
        self._inputs.tell(self._file, [one for one in found if one not in self._inputs.noticed])

    def _refuse_less_than(self, least: int, meshes: list["Mesh"]) -> None:
        if len(meshes) >= least:
            return
        what = "there is nothing in it" if least == 1 else "all of it lies on one side"
        message = f"{shown(self._file)}: {what}, so nothing was split and nothing was written."
        raise output.EmptyResultError(message, "empty_result")

    def _write(self, meshes: list["Mesh"], verdicts: list[str]) -> None:
        documents = []
        targets = (self._target(str(number)).path for number in range(1, len(meshes) + 1))
        refuse_inputs(self._file, targets, self._read())
        for number, mesh in enumerate(meshes, 1):
            target = self._target(str(number))
            lost = target.write(mesh)
            for finding in lost:
                self._out.finding(shown(target.path), finding)
            verdict = verdicts[number - 1] if verdicts else None
            line = summary(shown(target.path), mesh, False)
            line += f"\n  check: {verdict}" if verdict else ""
            document = {"output": str(target.path), **mesh_values(mesh), "check": verdict}
            documents.append({**document, "findings": output.finding_values(lost)})
            if not self._out.as_json:
                self._out.result(line, {})
        if self._out.as_json:
            self._out.result("", {"file": str(self._file), "parts": documents})

    def _target(self, number: str) -> Target:
        return Target.of(expanded(self._pattern, number), self._settings)
