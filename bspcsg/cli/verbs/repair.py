"""The verb `repair`, which closes and orients meshes."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..batch import process_each, targets_of
from ..console import output
from ..console.output import Output, counted, grouped
from ..console.tables import table_text
from ..inputs.files import Inputs, Target, display_name, make_folder
from ..options.patterns import files_argument
from ..options.shared import (
    TIMEOUT,
    FiniteRange,
    common_options,
    per_file_options,
    reading_options,
    verb,
    writing_options,
)

if TYPE_CHECKING:
    from ...repair.diagnosis import Diagnosis
    from ...repair.repair import Repair

_EPILOG = """\b
Examples:
  bspcsg repair scan.stl -o closed.ply
  bspcsg repair scans/ --outdir closed
"""

#: The names, in the printed table, of findings by their codes.
_DEFECTS = {
    "open_edges": "open edges",
    "orientation": "edges with faces turned round",
    "non_manifold": "edges with more than two faces",
    "degenerate": "triangles without area",
    "duplicate": "repeated triangles",
}


@verb("repair", short_help="Close and orient meshes with pymeshlab.", epilog=_EPILOG)
@files_argument("FILE|FOLDER [...]")
@per_file_options
@writing_options
@click.option(
    "--steps",
    metavar="STEPS",
    default="weld,dedup,drop,split,orient,fill",
    show_default=True,
    help="Steps to take, separated by commas.",
)
@click.option(
    "--weld",
    metavar="DISTANCE",
    type=FiniteRange(min=0),
    default=0.0,
    help="Join vertices up to this distance, in model units; equal ones are joined anyway.",
)
@click.option(
    "--max-hole",
    metavar="N",
    type=click.IntRange(min=3),
    default=1000,
    show_default=True,
    help="Edges around the largest hole to fill.",
)
@TIMEOUT
@reading_options
@common_options
def repair(files: tuple[Path, ...], target: Path | None, outdir: Path | None, **given: Any) -> int:
    """Close and orient meshes with pymeshlab, and say what changed.

    The steps: weld joins vertices; dedup removes repeated and flat triangles; drop removes stray
    fragments, which enclose nothing, such as a loose triangle beside a closed shell; split divides
    edges with more than two triangles; orient gives triangles a common orientation; fill closes
    holes. Each object of a file with several objects is repaired by itself, if it has a defect. The
    file is written even if it is still no solid; then the exit code is 1. Attributes, such as
    colours, are lost, with a warning.
    """
    return _Repairing(files, target, outdir, **given).run()


class _Repairing:
    """The work of the verb `repair`: it repairs each file, with a diagnosis before and after."""

    def __init__(
        self, files: tuple[Path, ...], target: Path | None, outdir: Path | None, **settings: Any
    ) -> None:
        self._settings = settings
        self._outdir = outdir
        to_format = settings["to_format"]
        self._pairs = [
            (path, Target.of(where, settings))
            for path, where in targets_of(files, target, outdir, to_format, keeps_format=True)
        ]
        self._out = Output.of(settings, any(where.is_stream for _, where in self._pairs))
        self._inputs = Inputs.of(self._out, settings)
        self._is_single = len(self._pairs) == 1 and outdir is None

    def run(self) -> int:
        from ...parameters import set_threads

        set_threads(self._settings["threads"])
        steps = self._steps()
        self._inputs.refuse_early([path for path, _ in self._pairs])
        if self._outdir is not None:
            make_folder(self._outdir)
        for _, target in self._pairs:
            target.refuse_early(self._out.as_json)

        def doing(path: Path, target: Target) -> tuple[dict[str, Any], int]:
            return self._repaired(path, target, steps)

        documents, code = process_each(self._pairs, self._out, doing, "repairing")
        if self._out.as_json:
            self._out.result("", documents[0] if self._is_single else {"files": documents})
        return code

    def _repaired(self, path: Path, target: Target, steps: list[str]) -> tuple[dict[str, Any], int]:
        """Repair one file; return its JSON document and the exit code."""
        from ...assembly.object_diagnosis import examine
        from ...assembly.object_repair import repaired_objects

        raw = self._inputs.raw(path)
        self._inputs.print_findings(path, raw.findings)
        if len(raw.faces) == 0:
            message = f"{display_name(path)}: no triangles are left, so nothing was written."
            raise output.EmptyResultError(message, "empty_result")
        before = examine(raw)
        limits = {name: self._settings[name] for name in ("weld", "max_hole", "timeout")}
        made = repaired_objects(before, steps=steps, **limits)
        after = examine(target.rounded(made.mesh)[0]).diagnosis
        lost = target.write(made.mesh)
        self._inputs.print_findings(path, made.lost)
        for finding in lost:
            self._out.finding(display_name(target.path), finding)
        for step, reason in made.failed.items():
            self._out.warning(f"{display_name(path)}: the repair step {step} failed: {reason}")
        if not self._out.as_json:
            text = _text if self._is_single else _line
            self._out.result(text(before.diagnosis, after, made, target), {})
        document = {
            "file": str(path),
            "output": str(target.path),
            "before": before.diagnosis.to_dict(),
            "after": after.to_dict(),
            "steps_failed": made.failed,
            "turned": made.turned,
            "dropped": made.dropped,
            "findings": output.finding_values((*raw.findings, *made.lost, *lost)),
        }
        return document, output.DONE if after.is_solid else output.FOUND

    def _steps(self) -> list[str]:
        from ...repair.repair import STEPS

        steps = [step.strip() for step in self._settings["steps"].split(",") if step.strip()]
        for step in steps:
            if step not in STEPS:
                message = f"--steps: {step!r} is not a repair step; known are {', '.join(STEPS)}."
                raise click.UsageError(message)
        if not steps:
            raise click.UsageError(f"--steps needs at least one of {', '.join(STEPS)}.")
        return steps


def _text(before: "Diagnosis", after: "Diagnosis", made: "Repair", target: Target) -> str:
    """Return a table of the measures and findings before and after a repair, and its result."""
    rows = [(name, *pair) for name, *pair in _rows(before, after)]
    lines = [table_text(("", "before", "after"), rows, right=("before", "after"))]
    if made.turned:
        lines.append(f"{counted(made.turned, 'triangle')} faced inwards and were reversed.")
    if made.dropped:
        lines.append(f"Removed {counted(made.dropped, 'triangle')} of stray fragments.")
    return "\n".join([*lines, f"{display_name(target.path)}: {_verdict(after)}"])


def _line(before: "Diagnosis", after: "Diagnosis", made: "Repair", target: Target) -> str:
    """Return one line on a repair: the output, the verdict, and the changes of triangles."""
    words = [f"{counted(before.triangles, 'triangle')} became {grouped(after.triangles)}"]
    words += [f"{grouped(made.turned)} reversed"] if made.turned else []
    words += [f"{grouped(made.dropped)} stray ones removed"] if made.dropped else []
    return f"{display_name(target.path)}: {_verdict(after)}; {', '.join(words)}"


def _verdict(after: "Diagnosis") -> str:
    return "a solid" if after.is_solid else f"still no solid: {after.verdict}"


def _rows(before: "Diagnosis", after: "Diagnosis") -> list[tuple[str, str, str]]:
    pair = (before, after)
    counts = [{finding.code: finding.count for finding in one.findings} for one in pair]

    def row(name: str, *values: str) -> tuple[str, str, str]:
        return name, values[0], values[1]

    rows = [
        row("triangles", *(grouped(one.triangles) for one in pair)),
        row("vertices", *(grouped(one.vertices) for one in pair)),
        row("surfaces", *(grouped(one.surfaces or 0) for one in pair)),
    ]
    rows += [
        row(name, *(grouped(found.get(code, 0)) for found in counts))
        for code, name in _DEFECTS.items()
    ]
    rows += [
        row("area", *(f"{one.area:.9g}" for one in pair)),
        row("signed volume", *(f"{one.signed_volume:.9g}" for one in pair)),
        row("verdict", *(one.verdict for one in pair)),
    ]
    return rows
