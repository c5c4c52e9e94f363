"""The verbs that combine files: union, difference, intersection, xor."""

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import Finding, FormatError
from . import output
from .options import common
from .output import Output, counted

if TYPE_CHECKING:
    from ..check import CheckReport
    from ..mesh import Mesh
    from ..solid import Solid

_HELP = {
    "union": "Write what is inside at least one of the files.",
    "difference": "Write what is inside the first file and none of the others.",
    "intersection": "Write what is inside all of the files.",
    "xor": "Write what is inside an odd number of the files.",
}

_EXAMPLES = {
    "union": "bspcsg union body.stl lid.stl -o closed.stl",
    "difference": "bspcsg difference plate.stl hole1.obj hole2.obj -o plate.ply",
    "intersection": "bspcsg intersection a.off b.off -o common.off --json",
    "xor": "bspcsg xor old.stl new.stl -o changed.ply",
}

#: Triangles and bits up to which the exact volume is printed; of more, its digits fill pages.
_EXACT_FACES, _EXACT_BITS = 500, 10_000

_PATH = click.Path(path_type=Path)


def _verb(op: str) -> click.Command:
    """Return the command of an operation."""

    @click.pass_context
    def run(context: click.Context, /, **given: Any) -> int:
        return _Job(op, **given).run()

    command: Any = click.argument(
        "files", nargs=-1, required=True, type=_PATH, metavar="A B [C ...]"
    )(common(run))
    for option in reversed(_OPTIONS):
        command = option(command)
    epilog = f"\b\nExample:\n  {_EXAMPLES[op]}"
    made: click.Command = click.command(op, help=_HELP[op], epilog=epilog)(command)
    return made


_OPTIONS = [
    click.option(
        "-o", "--output", "target", required=True, type=_PATH, help="File to write, by its suffix."
    ),
    click.option(
        "--check/--no-check", default=True, help="Compare the result with manifold3d's (default)."
    ),
    click.option(
        "--winding",
        type=click.Choice(["positive", "nonzero", "even-odd"]),
        default="positive",
        help="Which winding numbers are inside a file that overlaps itself.",
    ),
    click.option(
        "--pitch",
        type=click.IntRange(-30, 30),
        help="Lattice step 10^PITCH units; by default -9, or what the size asks for.",
    ),
    click.option("--ascii", "text", is_flag=True, help="Write STL and PLY as text."),
    click.option("--allow-empty", is_flag=True, help="Write a file even if nothing is left."),
]


class _Job:
    """One operation on files.

    Parameters
    ----------
    op : str
    files : tuple of Path
    target : Path
    **settings
        The other options, by their names.
    """

    def __init__(self, op: str, files: tuple[Path, ...], target: Path, **settings: Any) -> None:
        self.op = op
        self.files = files
        self.target = target
        self.settings = settings
        verbosity = int(settings["verbose"]) - int(settings["quiet"])
        self.out = Output(verbosity, settings["as_json"])
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def run(self) -> int:
        """Do it, and return the exit code."""
        self._refuse_early()
        solids = [self._loaded(path) for path in self.files]
        self._lap("read")
        result, mesh = self._combined(solids)
        self._lap("combine")
        report = self._checked(result, solids)
        self._lap("check")
        if report is not None and report.verdict == "subject failed":
            self._tell(result, mesh, report, written=False)
            return output.FOUND
        self._write(mesh)
        self._lap("write")
        self._tell(result, mesh, report, written=True)
        return output.DONE if report is None or report.ok else output.FOUND

    def _refuse_early(self) -> None:
        """Refuse what can be known to fail before anything is read."""
        from ..io import encoder_of, format_of

        if len(self.files) < 2:
            raise click.UsageError(
                f"{self.op} needs at least two files.", click.get_current_context()
            )
        encoder_of(self.target, self.settings["text"])
        for path in self.files:
            format_of(path)
        folder = self.target.parent
        if not folder.is_dir() or not os.access(folder, os.W_OK):
            message = f"{self.target}: there is no folder {folder} that can be written to."
            raise FormatError(message, "unwritable")

    def _loaded(self, path: Path) -> "Solid":
        from ..io import read, solid_of

        raw = read(path)
        winding, pitch = self.settings["winding"], self.settings["pitch"]
        solid = solid_of(raw, path, winding=winding, pitch=pitch)
        noticed = [Finding.from_core(found) for found in solid.tree.findings]
        for finding in (*raw.findings, *noticed):
            self.out.finding(str(path), finding)
        self.out.detail(f"{path}: {counted(len(raw.faces), 'triangle')}")
        return solid

    def _combined(self, solids: list["Solid"]) -> tuple["Solid", "Mesh"]:
        from .. import set_threads
        from ..check import COMBINE

        set_threads(self.settings["threads"])
        result = COMBINE[self.op](*solids)
        mesh = result.normalized().to_mesh()
        if len(mesh.faces) == 0 and not self.settings["allow_empty"]:
            raise output.EmptyResultError(
                f"{self.target}: nothing is left, so nothing was written;"
                " say --allow-empty if that is meant.",
                "empty_result",
            )
        return result, mesh

    def _checked(self, result: "Solid", solids: list["Solid"]) -> "CheckReport | None":
        from ..check import check_result

        if not self.settings["check"]:
            return None
        return check_result(result, self.op, solids)  # type: ignore[arg-type]

    def _write(self, mesh: "Mesh") -> None:
        from ..io import write

        for finding in write(mesh, self.target, text=self.settings["text"]):
            self.out.finding(str(self.target), finding)

    def _tell(
        self, result: "Solid", mesh: "Mesh", report: "CheckReport | None", written: bool
    ) -> None:
        for finding in result.normalized().findings:
            self.out.finding(str(self.target), finding)
        for note in () if report is None else report.notes:
            self.out.detail(f"note: {note}")
        line = _summary(self.target, mesh, sum(self.seconds.values()))
        if report is not None:
            line = f"{line}\n  check: {report.summary()}"
        if not written:
            line = f"{self.target}: not written\n  check: {report.summary() if report else ''}"
        as_json = self.out.as_json
        self.out.result(line, self._document(result, mesh, report, written) if as_json else {})

    def _document(
        self, result: "Solid", mesh: "Mesh", report: "CheckReport | None", written: bool
    ) -> dict[str, Any]:
        return {
            "operation": self.op,
            "files": [str(path) for path in self.files],
            "output": str(self.target) if written else None,
            "winding": self.settings["winding"],
            "pitch": result.pitch,
            "triangles": len(mesh.faces),
            "vertices": len(mesh.vertices),
            "surfaces": mesh.components if len(mesh.faces) else 0,
            "genus": mesh.genus if len(mesh.faces) else 0,
            "volume": result.volume,
            "volume_exact": _exact_volume(result, mesh),
            "area": mesh.area,
            "bounds": None if (bounds := mesh.bounds) is None else bounds.tolist(),
            "findings": output.finding_values(result.normalized().findings),
            "check": None if report is None else report.to_dict(),
            "seconds": self.seconds,
        }

    def _lap(self, name: str) -> None:
        now = time.perf_counter()
        self.seconds[name] = round(now - self._last, 4)
        self._last = now
        self.out.detail(f"{name}: {self.seconds[name]:.3f} s")


def _exact_volume(result: "Solid", mesh: "Mesh") -> str | None:
    """Return a fraction like ``"1/3"``, unless it is unwieldy."""
    if len(mesh.faces) > _EXACT_FACES:
        return None
    volume = result.volume_exact
    longest = max(volume.numerator.bit_length(), volume.denominator.bit_length())
    return str(volume) if longest <= _EXACT_BITS else None


def _summary(target: Path, mesh: "Mesh", seconds: float) -> str:
    if len(mesh.faces) == 0:
        return f"{target}  empty  {seconds:.2f} s"
    return (
        f"{target}  {counted(len(mesh.faces), 'triangle')}  {counted(mesh.components, 'surface')}"
        f"  genus {mesh.genus}  volume {mesh.volume:.9g}  closed  {seconds:.2f} s"
    )


union = _verb("union")
difference = _verb("difference")
intersection = _verb("intersection")
xor = _verb("xor")
