"""The verb that closes meshes: repair."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..console import output
from ..console.output import Output, counted, grouped
from ..console.tables import table_text
from ..inputs.files import Inputs, Target, shown
from ..options.patterns import file_argument
from ..options.shared import OUTPUT, TIMEOUT, FiniteRange, common, reading, writing

if TYPE_CHECKING:
    from ...errors import Finding
    from ...repair.diagnosis import Diagnosis
    from ...repair.repair import Repair

_EPILOG = """\b
Example:
  bspcsg repair scan.stl -o closed.ply
"""

#: Kinds of findings with what to call them in the table.
_DEFECTS = {
    "open_edges": "open edges",
    "orientation": "edges with faces turned round",
    "non_manifold": "edges with more than two faces",
    "degenerate": "triangles without area",
    "duplicate": "repeated triangles",
}


@click.command("repair", short_help="Close and orient a mesh with pymeshlab.", epilog=_EPILOG)
@file_argument()
@OUTPUT
@writing
@click.option(
    "--steps",
    metavar="STEPS",
    default="weld,dedup,drop,split,orient,fill",
    show_default=True,
    help="Which steps to take, apart by commas.",
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
@reading
@common
def repair(file: Path, target: Path, **given: Any) -> int:
    """Close and orient a mesh with pymeshlab, and say what changed.

    The steps: weld joins vertices; dedup drops repeated and flat triangles; drop takes away stray
    fragments, which bound nothing, such as a loose triangle beside a closed shell; split takes
    edges with more than two triangles apart; orient turns triangles the same way round; fill closes
    holes.
    The file is written even if it still is no solid; then the exit code is 1. The names of several
    objects and all attributes, such as colours, are lost, which is said.
    """
    return _Repairing(file, target, **given).run()


class _Repairing:
    """One file, before and after."""

    def __init__(self, file: Path, target: Path, **settings: Any) -> None:
        self._file = file
        self._target = Target.of(target, settings)
        self._settings = settings
        self._out = Output.of(settings, self._target.is_stream)
        self._inputs = Inputs.of(self._out, settings)

    def run(self) -> int:
        from ...parameters import set_threads
        from ...repair.diagnosis import diagnose
        from ...repair.repair import repair as repaired

        set_threads(self._settings["threads"])
        steps = self._steps()
        self._target.refuse_early(self._out.as_json)
        self._inputs.refuse_early([self._file])
        raw = self._inputs.raw(self._file)
        limits = {name: self._settings[name] for name in ("weld", "max_hole", "timeout")}
        self._inputs.tell(self._file, raw.findings)
        if len(raw.faces) == 0:
            message = f"{shown(self._file)}: there is nothing in it, so nothing was written."
            raise output.EmptyResultError(message, "empty_result")
        before = diagnose(raw)
        made = repaired(raw, steps, **limits)
        after = diagnose(self._target.rounded(made.mesh)[0])
        lost = self._target.write(made.mesh)
        self._inputs.tell(self._file, made.lost)
        for finding in lost:
            self._out.finding(shown(self._target.path), finding)
        self._tell(before, after, made, (*raw.findings, *made.lost, *lost))
        return output.DONE if after.is_solid else output.FOUND

    def _steps(self) -> list[str]:
        from ...repair.repair import STEPS

        steps = [step.strip() for step in self._settings["steps"].split(",") if step.strip()]
        for step in steps:
            if step not in STEPS:
                message = f"--steps: {step!r} is no step; there are {', '.join(STEPS)}."
                raise click.UsageError(message)
        if not steps:
            raise click.UsageError(f"--steps needs at least one of {', '.join(STEPS)}.")
        return steps

    def _tell(
        self,
        before: "Diagnosis",
        after: "Diagnosis",
        made: "Repair",
        findings: "tuple[Finding, ...]",
    ) -> None:
        for step, reason in made.failed.items():
            self._out.warning(f"the step {step} could not be taken: {reason}")
        document = {
            "file": str(self._file),
            "output": str(self._target.path),
            "before": before.to_dict(),
            "after": after.to_dict(),
            "steps_failed": made.failed,
            "turned": made.turned,
            "dropped": made.dropped,
            "findings": output.finding_values(findings),
        }
        self._out.result(self._text(before, after, made), document)

    def _text(self, before: "Diagnosis", after: "Diagnosis", made: "Repair") -> str:
        rows = [(name, *pair) for name, *pair in _rows(before, after)]
        lines = [table_text(("", "before", "after"), rows, right=("before", "after"))]
        if made.turned:
            lines.append(f"{counted(made.turned, 'triangle')} faced inwards and were turned round.")
        if made.dropped:
            lines.append(f"{counted(made.dropped, 'triangle')} of stray fragments were dropped.")
        told = "a solid" if after.is_solid else f"still no solid: {after.verdict}"
        lines.append(f"{shown(self._target.path)}: {told}")
        return "\n".join(lines)


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
