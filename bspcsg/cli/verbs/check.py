"""The verb that looks at files: check."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import BspcsgError
from ..console import output, terminal
from ..console.output import Output, counted, grouped
from ..console.tables import table_text
from ..inputs.files import STREAM, Inputs, repair_command, shown
from ..inputs.lengths import as_length
from ..options.patterns import files_argument
from ..options.shared import common, reading
from ..pages.written import PAGE, refuse_page, write_page

if TYPE_CHECKING:
    from ...formats.raw import RawMesh
    from ...repair.diagnosis import Diagnosis

#: Relative difference up to which two volumes are told as one.
_SAME = 1e-6

_EPILOG = """\b
Examples:
  bspcsg check parts/*.stl || echo "some are no solids"
  bspcsg check part.stl --html check.html --thin 0.8mm
"""


@click.command("check", epilog=_EPILOG)
@files_argument("FILE [...]")
@click.option("--strict", is_flag=True, help="Count warnings as failures too.")
@PAGE
@click.option(
    "--thin",
    metavar="LENGTH",
    callback=as_length,
    help="Mark walls of closed meshes that are thinner, as 0.8mm, in the page of --html.",
)
@reading
@common
def check(
    files: tuple[Path, ...], strict: bool, page: Path | None, thin: float | None, **given: Any
) -> int:
    """Say what is wrong with each file, and whether it is a solid.

    Names open edges, triangles turned round, edges with more than two triangles, triangles without
    area or over the same corners, faces that cross or overlap, and meshes that are inside out,
    with places. A file that overlaps itself still is a solid, and a warning says so.
    """
    from ...parameters import set_threads

    set_threads(given["threads"])
    out = Output.of(given)
    inputs = Inputs.of(out, given)
    _refuse_page(files, page, thin)
    results = [_examined(inputs, path) for path in files]
    codes = [_exit_code(found, strict) for _, found in results]
    documents = [_document(path, found) for path, found in results]
    for path, found in results:
        if page is not None and not isinstance(found, BspcsgError):
            _write_page(inputs.raw(path), found, path, page, thin)
    out.result("" if given["as_json"] else _text(results, out), {"files": documents})
    for path, found in results:
        if isinstance(found, BspcsgError):
            terminal.say_error(_named(path, found))
    return max(codes)


def _refuse_page(files: tuple[Path, ...], page: Path | None, thin: float | None) -> None:
    if page is None and thin is not None:
        raise click.UsageError("--thin marks walls in a page; say --html too.")
    if page is not None:
        if len(files) > 1:
            raise click.UsageError("--html is for one file; check each by itself.")
        if str(files[0]) == STREAM:
            raise click.UsageError("--html reads the mesh twice; save it to a file.")
        refuse_page(page)


def _write_page(
    raw: "RawMesh", found: "Diagnosis", path: Path, page: Path, thin: float | None
) -> None:
    from ...report.viewer.checked import checked_page

    write_page(page, checked_page(raw, found, path.name, thin))


def _examined(inputs: Inputs, path: Path) -> tuple[Path, "Diagnosis | BspcsgError"]:
    from ...repair.diagnosis import diagnose

    try:
        inputs.refuse_early([path])
        return path, diagnose(inputs.raw(path))
    except BspcsgError as error:
        return path, error


def _exit_code(found: "Diagnosis | BspcsgError", strict: bool) -> int:
    if isinstance(found, BspcsgError):
        return output.exit_code_of(found)
    warned = any(finding.severity == "warning" for finding in found.findings)
    return output.FOUND if not found.is_solid or (strict and warned) else output.DONE


def _document(path: Path, found: "Diagnosis | BspcsgError") -> dict[str, Any]:
    if isinstance(found, BspcsgError):
        return {"file": str(path), "verdict": "unreadable", "error": output.error_values(found)}
    return {"file": str(path), **found.to_dict()}


def _named(path: Path, error: BspcsgError) -> str:
    return error.message if error.message.startswith(str(path)) else f"{path}: {error.message}"


def _text(results: list[tuple[Path, "Diagnosis | BspcsgError"]], out: Output) -> str:
    """Return a table if there are several files, and what was found in each."""
    read = [(path, found) for path, found in results if not isinstance(found, BspcsgError)]
    blocks = [_table(read)] if len(read) > 1 else []
    blocks += [_details(path, found, out) for path, found in read]
    if len(results) > 1:
        bad = sum(1 for _, found in results if isinstance(found, BspcsgError) or not found.is_solid)
        blocks.append(_conclusion(bad, len(results)))
    return "\n".join(block for block in blocks if block)


def _conclusion(bad: int, count: int) -> str:
    if bad == 0:
        return f"All {count} files are solids."
    return f"{bad} of {count} files {'is not a solid' if bad == 1 else 'are not solids'}."


def _details(path: Path, found: "Diagnosis", out: Output) -> str:
    lines = [f"{shown(path)}: {_measures(found)}"]
    least = {"error": -1, "warning": 0, "note": 0}
    for finding in found.findings:
        if out.verbosity >= least[finding.severity]:
            lines.append(f"  {finding.severity}: {finding.message.rstrip('.')}.")
    if found.verdict == "not closed" and out.advises:
        lines.append(f"  Try: {repair_command(path)}")
    return "\n".join(lines)


def _measures(found: "Diagnosis") -> str:
    if found.triangles == 0:
        return found.verdict
    words = [
        found.verdict,
        counted(found.triangles, "triangle"),
        counted(found.surfaces, "surface"),
    ]
    if found.genus is not None:
        words.append(f"genus {found.genus}")
    words.append(f"area {found.area:.9g}")
    if found.volume is not None:
        words.append(f"volume {found.volume:.9g}")
    if found.volume is None or abs(found.volume - found.signed_volume) > _SAME * found.volume:
        words.append(f"signed volume {found.signed_volume:.9g}")
    return ", ".join(words)


def _table(read: list[tuple[Path, "Diagnosis"]]) -> str:
    rows = []
    for path, found in read:
        overlaps = "—" if found.self_overlapping is None else _yes(found.self_overlapping)
        flags = [_yes(found.closed), _yes(found.oriented), _yes(found.manifold), overlaps]
        rows.append((str(path), grouped(found.triangles), *flags, found.verdict))
    columns = ("file", "triangles", "closed", "oriented", "manifold", "overlaps", "verdict")
    return table_text(columns, rows, right=("triangles",))


def _yes(flag: bool) -> str:
    return "yes" if flag else "no"
