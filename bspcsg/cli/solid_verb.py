"""The base class of verbs that make a solid: it reads, checks, writes and reports."""

import dataclasses
import time
from abc import ABC, abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .console import clock, output, status_line
from .console.output import Output, counted
from .inputs.files import Inputs, Target, display_name

if TYPE_CHECKING:
    from ..errors import Finding
    from ..mesh.mesh import Mesh
    from ..solid.solid import Solid
    from ..verify.check import CheckReport

#: The exact volume is printed for at most this many triangles, and bits of numerator or
#: denominator: otherwise its digits fill pages.
_MAX_EXACT_FACES, _MAX_EXACT_BITS = 500, 10_000


#: The largest number of crossings that the JSON document lists.
_MAX_CROSSINGS_NAMED = 8


class SolidVerb(ABC):
    """A verb's work of making a solid from files and writing it; subclasses implement `combined`.

    Parameters
    ----------
    op : str
        The name of the operation.
    target : Path
        The output.
    **settings
        All other options of the verb, by name.
    """

    def __init__(self, op: str, target: Path, **settings: Any) -> None:
        self.op = op
        self.settings = settings
        self.target = Target.of(target, settings)
        self.out = Output.of(settings, self.target.is_stream)
        self.inputs = Inputs.of(self.out, settings)
        self.seconds: dict[str, float] = {"start": round(clock.elapsed(), 4)}
        self._lost: tuple[Finding, ...] = ()
        self._noticed: tuple[Finding, ...] = ()
        self._last = time.perf_counter()

    @abstractmethod
    def combined(self) -> "Solid":
        """Read the files and return the result of the operation."""

    def compared(self, result: "Solid") -> "CheckReport | None":
        """Compare the result with manifold3d's; return None if no set operation made the result."""
        from ..verify.check import check_result

        if result.last_operation is None:
            return None
        return check_result(result, depth=self.settings["check"])

    @abstractmethod
    def paths(self) -> Sequence[Path]:
        """Return the input files."""

    def refuse_inputs(self) -> None:
        """Raise an error if reading is certain to fail, and print a note about missing units."""
        self.inputs.refuse_early(self.paths())
        self.inputs.note_missing_units((path, self.target) for path in self.paths())

    @property
    def name(self) -> str:
        """The name of the output in messages."""
        return display_name(self.target.path)

    def run(self) -> int:
        """Read, combine, check and write; report the result and return the exit code."""
        from ..parameters import set_threads

        set_threads(self.settings["threads"])
        self.target.refuse_early(self.out.as_json)
        self.refuse_inputs()
        status_line.set_text(f"{self.op}: evaluating")
        result = self.made = self.combined()
        mesh = self._mesh_of(result)
        self.lap("combine")
        for line in result.profile().lines():
            self.out.detail(f"  {line}")
        is_checked = self.settings["check"] != "off"
        status_line.set_text(f"{self.op}: comparing with manifold3d" if is_checked else self.op)
        report = self.compared(result) if is_checked else None
        self.lap("check")
        if report is not None and report.verdict == "subject failed":
            self._tell(result, mesh, report, written=False)
            return output.FOUND
        if self.settings["tolerance"]:
            result, mesh = self._simplified(result, mesh)
        status_line.set_text(f"{self.op}: writing {display_name(self.target.path)}")
        self._lost = self._write(result, mesh)
        for finding in self._lost:
            self.out.finding(display_name(self.target.path), finding)
        self.lap("write")
        self._tell(result, mesh, report, written=True)
        return output.DONE if report is None or report.ok else output.FOUND

    def cutters(self) -> "Sequence[Solid]":
        """Return the subtracted solids; the names of their objects are not given to the result."""
        return ()

    def _write(self, result: "Solid", mesh: "Mesh") -> "tuple[Finding, ...]":
        """Write a result, as named parts if inputs and output have names; return the losses."""
        if self.target.names_objects and len(mesh.faces):
            target = self.target
            parted = self.inputs.objects.parted(result, self.cutters(), target.is_single)
            if parted is not None:
                return (*parted[1], *self.target.write(parted[0]))
        return self.target.write(mesh)

    def _simplified(self, result: "Solid", mesh: "Mesh") -> "tuple[Solid, Mesh]":
        """Return a result without short edges and slivers, as a solid and as a mesh."""
        self._noticed = result.normalized().findings
        simple = result.simplify(self.settings["tolerance"])
        if simple is result:
            self.out.note(
                f"{display_name(self.target.path)}: no edge or triangle is small enough to be"
                " simplified"
                " within the tolerance"
            )
            self._noticed = ()
        else:
            mesh = self._mesh_of(simple)
        self.lap("simplify")
        return simple, mesh

    def _findings(self, result: "Solid") -> "tuple[Finding, ...]":
        """Return the findings about a result, including those about it before simplification."""
        return self._noticed + result.normalized().findings

    def _mesh_of(self, result: "Solid") -> "Mesh":
        mesh = result.normalized().to_mesh()
        if len(mesh.faces) == 0 and not self.settings["allow_empty"]:
            raise output.EmptyResultError(
                f"{display_name(self.target.path)}: the result is empty, so nothing was written;"
                " --allow-empty writes an empty file.",
                "empty_result",
            )
        return mesh

    def _tell(
        self, result: "Solid", mesh: "Mesh", report: "CheckReport | None", written: bool
    ) -> None:
        name = self.name
        for finding in self._findings(result):
            if finding not in self.inputs.noticed_findings:
                self.out.finding(name, finding)
        for note in () if report is None else report.notes:
            self.out.detail(f"note: {note}")
        line = summary(name, mesh, True)
        if report is not None:
            line = f"{line}\n  check: {report.summary()}"
        elif self.settings["check"] != "off":
            line = f"{line}\n  check: nothing to compare, for no operation made the result"
        if not written:
            line = f"{name}: not written\n  check: {report.summary() if report else ''}"
        as_json = self.out.as_json
        self.out.result(line, self._document(result, mesh, report, written) if as_json else {})

    def _document(
        self, result: "Solid", mesh: "Mesh", report: "CheckReport | None", written: bool
    ) -> dict[str, Any]:
        return {
            "operation": self.op,
            "files": [str(path) for path in self.paths()],
            "output": str(self.target.path) if written else None,
            "winding": self.settings.get("winding"),
            "pitch": result.pitch,
            **mesh_values(mesh),
            "volume": result.volume,
            "volume_exact": _exact_volume(result, mesh),
            "findings": output.finding_values(self._findings(result) + self._lost),
            "check": None if report is None else report.to_dict(),
            "certificate": certificate_values(mesh),
            "seconds": {**self.seconds, "total": round(clock.elapsed(), 4)},
            "profile": dataclasses.asdict(result.profile()),
        }

    def lap(self, name: str) -> None:
        """Record and print the seconds since the previous call as the time of the step `name`."""
        now = time.perf_counter()
        self.seconds[name] = round(now - self._last, 4)
        self._last = now
        self.out.detail(f"{name}: {self.seconds[name]:.3f} s")


def mesh_values(mesh: "Mesh") -> dict[str, Any]:
    """Return the measures of a mesh as JSON values."""
    return {
        "triangles": len(mesh.faces),
        "vertices": len(mesh.vertices),
        "surfaces": mesh.surface_count if len(mesh.faces) else 0,
        "genus": mesh.genus if len(mesh.faces) else 0,
        "volume": mesh.volume,
        "area": mesh.area,
        "bounds": None if (bounds := mesh.bounds) is None else bounds.tolist(),
    }


def certificate_values(mesh: "Mesh") -> dict[str, Any]:
    """Return the exact check of a mesh as JSON values: counts of defects, and first crossings."""
    proof = mesh.certificate
    return {
        "ok": proof.ok,
        "precision": proof.precision,
        "triangles": proof.triangles,
        "open_edges": proof.open_edges,
        "crossings": len(proof.crossings),
        "flat": len(proof.flat),
        "where": [list(pair) for pair in proof.crossings[:_MAX_CROSSINGS_NAMED]],
    }


def _exact_volume(result: "Solid", mesh: "Mesh") -> str | None:
    """Return the exact volume as a fraction like ``"1/3"``; None if it has too many digits."""
    if len(mesh.faces) > _MAX_EXACT_FACES:
        return None
    volume = result.volume_exact
    longest = max(volume.numerator.bit_length(), volume.denominator.bit_length())
    return str(volume) if longest <= _MAX_EXACT_BITS else None


def summary(name: str, mesh: "Mesh", timed: bool) -> str:
    """Return one line about a written mesh, with the running time of the command if `timed`."""
    words = [name, "empty"]
    if len(mesh.faces):
        triangles, surfaces = (
            counted(len(mesh.faces), "triangle"),
            counted(mesh.surface_count, "surface"),
        )
        measures = [f"genus {mesh.genus}", f"volume {mesh.volume:.9g}", "closed"]
        words = [name, triangles, surfaces, *measures]
    return "  ".join([*words, f"{clock.elapsed():.2f} s"] if timed else words)
