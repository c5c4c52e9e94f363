"""The verb `convert`, which writes meshes in other formats."""

import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import click

from ...errors import Finding
from ..batch import process_each, targets_of
from ..console import output
from ..console.output import Output, counted
from ..inputs.files import Inputs, Target, display_name, make_folder
from ..inputs.lengths import MILLIMETRES
from ..options.patterns import files_argument
from ..options.shared import (
    SIMPLIFY,
    common_options,
    per_file_options,
    reading_options,
    verb,
    writing_options,
)

if TYPE_CHECKING:
    from ...formats.raw import RawMesh
    from ...verify.roundtrip import Losses

_EPILOG = """\b
Examples:
  bspcsg convert part.3mf -o part.ply --fail-on-loss
  bspcsg convert parts/ --to glb --outdir web
  bspcsg convert part.stl --unit in --to-unit cm -o part-cm.ply
"""


@verb("convert", epilog=_EPILOG)
@files_argument("FILE|FOLDER [...]")
@per_file_options
@writing_options
@SIMPLIFY
@click.option(
    "--to-unit",
    type=click.Choice(list(MILLIMETRES)),
    help="Unit of the coordinates that are written, by default mm; 3MF and GLB have their own.",
)
@click.option(
    "--up",
    type=click.Choice(["y", "z"]),
    help="Which axis is to be up in the output; y in GLB by default, z in all others.",
)
@click.option(
    "--from-up",
    type=click.Choice(["y", "z"]),
    help="Which axis is up in the inputs; y in GLB by default, z in all others.",
)
@click.option("--fail-on-loss", is_flag=True, help="Exit with 1 if anything was lost.")
@reading_options
@common_options
def convert(files: tuple[Path, ...], **given: Any) -> int:
    """Write meshes in other formats, and say what was lost.

    Every file is read back and compared. Meshes need not be closed, unless they are to be
    simplified; nothing is repaired. 3MF and GLB state their unit: meshes in other formats are taken
    as millimetres unless --unit says otherwise, and GLB is written in metres with y upwards. Where
    --up and --from-up differ, the model is rotated by a quarter turn about x.
    """
    return _Conversion(files, **given).run()


class _Conversion:
    """The work of the verb `convert`: it converts each file and compares it with the original."""

    def __init__(
        self, files: tuple[Path, ...], target: Path | None, outdir: Path | None, **settings: Any
    ) -> None:
        self._settings = settings
        self._outdir = outdir
        self._pairs = [
            (path, Target.of(where, settings))
            for path, where in targets_of(files, target, outdir, settings["to_format"])
        ]
        self._out = Output.of(settings, any(where.is_stream for _, where in self._pairs))
        self._inputs = Inputs.of(self._out, settings)
        self._told: set[str] = set()

    def run(self) -> int:
        self._refuse_early()
        documents, code = process_each(self._pairs, self._out, self._converted, "converting")
        if self._out.as_json:
            self._out.result("", {"files": documents})
        return code

    def _refuse_early(self) -> None:
        self._inputs.refuse_early([path for path, _ in self._pairs])
        if self._outdir is not None:
            make_folder(self._outdir)
        for _, target in self._pairs:
            self._refuse_unit(target)
            target.refuse_early(self._out.as_json)
        self._inputs.note_missing_units(self._pairs)

    def _refuse_unit(self, target: Target) -> None:
        """Raise a usage error if ``--to-unit`` is given for a format that states its unit."""
        from ...formats.registry import FORMATS

        known = FORMATS.get(target.suffix.lower())
        if self._settings["to_unit"] is not None and known is not None and known.unit:
            said = f"{target.suffix.removeprefix('.').upper()} files have a fixed or stored unit"
            raise click.UsageError(
                f"--to-unit: {said}, so no other can be given; leave out --to-unit."
            )

    def _converted(self, path: Path, target: Target) -> tuple[dict[str, Any], int]:
        """Convert one file; return its JSON document and the exit code."""
        from ...formats.files import decoded, encoded
        from ...verify.roundtrip import losses_between

        began = time.perf_counter()
        raw = meant = self._turned(path, target)
        self._inputs.print_findings(path, raw.findings)
        if self._settings["tolerance"]:
            raw = self._simplified(raw, path)
            # Simplifying loses everything but the shape: names, attributes and so on.
            meant = replace(meant, vertices=raw.vertices, faces=raw.faces)
        shortened, _ = target.rounded(raw)
        made = encoded(shortened, display_name(target.path), target.suffix, target.text)
        found: list[Losses] = []

        def compare(file: BinaryIO) -> None:
            made.prove(file)
            file.seek(0)
            again = decoded(display_name(target.path), file.read(), target.suffix, made.files)
            found.append(losses_between(meant, again))

        target.put(made, compare)
        lost = found[0]
        for finding in made.findings:
            self._tell(target, finding)
        seconds = time.perf_counter() - began
        if not self._out.as_json:
            self._out.result(_line(raw, target, lost, seconds), {})
        document = {
            "file": str(path),
            "output": str(target.path),
            "triangles": len(raw.faces),
            "findings": output.finding_values(made.findings),
            "lost": lost.to_dict(),
            "seconds": round(seconds, 4),
        }
        is_bad = lost.any and self._settings["fail_on_loss"]
        return document, output.FOUND if is_bad else output.DONE

    def _simplified(self, raw: "RawMesh", path: Path) -> "RawMesh":
        """Return a mesh as one object without short edges, slivers and attributes.

        If there is nothing to simplify, the mesh is returned unchanged.
        """
        solid = self._inputs.as_solid(raw, path)
        simple = solid.simplify(self._settings["tolerance"])
        if simple is solid:
            self._out.note(
                f"{display_name(path)}: no edge or triangle is small enough to be simplified"
                " within the"
                " tolerance"
            )
            return raw
        mesh = simple.normalized().to_mesh()
        self._inputs.print_findings(path, simple.normalized().findings)
        bare = replace(raw, findings=(), objects=(), attributes=None)
        return replace(bare, vertices=mesh.vertices, faces=mesh.faces)

    def _turned(self, path: Path, target: Target) -> "RawMesh":
        """Read a file, and rotate it so that the requested axis is up in the output."""
        from ...formats.registry import FORMATS
        from ...formats.up_axis import rotated_about_x

        raw = self._inputs.raw(path)
        usual_in = self._inputs.up_axis_of(path)
        usual_out = FORMATS[target.suffix.lower()].up
        # Reading and writing already rotate by the convention of each format, so only the
        # differences between the options and these conventions count.
        told_in = self._settings["from_up"] or usual_in
        told_out = self._settings["up"] or usual_out
        quarters = (told_in == "y") - (usual_in == "y") - (told_out == "y") + (usual_out == "y")
        return rotated_about_x(self._in_unit(raw), quarters)

    def _in_unit(self, raw: "RawMesh") -> "RawMesh":
        """Convert a mesh from millimetres to the unit of ``--to-unit``."""
        from ...formats.mesh_placement import rescaled

        return rescaled(raw, 1, MILLIMETRES[self._settings["to_unit"] or "mm"])

    def _tell(self, target: Target, finding: Finding) -> None:
        """Print a finding about an output; one about its format's unit is printed only once."""
        if finding.code == "single_precision":  # reported with the losses, as measured
            return
        if finding.code == "unit" and finding.message in self._told:
            return
        self._told.add(finding.message)
        self._out.finding(display_name(target.path), finding)


def _line(raw: "RawMesh", target: Target, lost: "Losses", seconds: float) -> str:
    words = "; ".join(lost.sentences())
    return (
        f"{display_name(target.path)}  {counted(len(raw.faces), 'triangle')}"
        f"  {'lost: ' + words if words else 'nothing lost'}  {seconds:.2f} s"
    )
