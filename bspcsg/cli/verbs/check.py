"""The verb `check`, which finds the defects of mesh files."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import BspcsgError
from ..console import output, terminal
from ..console.output import SCHEMA, Output, counted, grouped
from ..console.tables import table_text
from ..inputs.files import STREAM, Inputs, display_name, is_among, is_dropped, repair_command
from ..inputs.lengths import as_length
from ..options.patterns import files_argument, skipped_files
from ..options.shared import FilePath, common_options, reading_options, verb
from ..pages.page_output import refuse_page, write_page

if TYPE_CHECKING:
    from ...errors import Finding
    from ...repair.diagnosis import Diagnosis
    from ...report.check_page import CheckPage
    from ...report.junit import JUnitCase

#: The relative difference up to which volume and signed volume are printed as one.
_SAME = 1e-6

#: Suffixes of reports besides pages.
_JSON, _JUNIT = ".json", ".xml"

_EPILOG = """\b
Examples:
  bspcsg check parts/*.stl || echo "some are no solids"
  bspcsg check parts/ -o report.html -o junit.xml
  bspcsg check part.stl -o check.html --thin 0.8mm
"""


@verb("check", epilog=_EPILOG)
@files_argument("FILE|FOLDER [...]")
@click.option(
    "-o",
    "--output",
    "targets",
    metavar="FILE",
    multiple=True,
    type=FilePath(),
    help="Report to write, too: .html with a picture and a 3D view of each mesh and object, .json,"
    " or .xml, JUnit for CI; may be repeated.",
)
@click.option("--html", "page", type=FilePath(), hidden=True)
@click.option("--strict", is_flag=True, help="Count warnings as failures too.")
@click.option(
    "--thin",
    metavar="LENGTH",
    callback=as_length,
    help="Mark walls of closed meshes that are thinner, as 0.8mm, in the page.",
)
@reading_options
@common_options
def check(
    files: tuple[Path, ...],
    targets: tuple[Path, ...],
    page: Path | None,
    thin: float | None,
    **given: Any,
) -> int:
    """Say what is wrong with each file, and whether it is a solid.

    Finds open edges, reversed triangles, edges with more than two triangles, triangles without area
    or over the same corners, faces that cross or overlap, and meshes that are inside out, and
    prints where. A file that overlaps itself is a solid, with a warning. Each object of a file with
    several objects is checked by itself; objects may touch, and a warning names those that clash.
    """
    from ...parameters import set_threads

    set_threads(given["threads"])
    return _Checking(files, (*targets, *([page] if page else [])), thin, given).run()


@dataclass(frozen=True)
class _Checked:
    """A file with the diagnosis of it and of each of its objects, or the error of reading it."""

    path: Path
    found: "Diagnosis | BspcsgError"
    objects: "Sequence[tuple[str, Diagnosis]]" = ()

    @property
    def is_solid(self) -> bool:
        return not isinstance(self.found, BspcsgError) and self.found.is_solid

    @property
    def document(self) -> dict[str, Any]:
        if isinstance(self.found, BspcsgError):
            error = output.error_values(self.found)
            return {"file": str(self.path), "verdict": "unreadable", "error": error}
        objects = [{"name": name, **found.to_dict()} for name, found in self.objects]
        return {"file": str(self.path), **self.found.to_dict(), "objects": objects}


class _Checking:
    """The work of the verb `check`: it diagnoses files and writes reports."""

    def __init__(
        self,
        files: Sequence[Path],
        targets: Sequence[Path],
        thin: float | None,
        settings: dict[str, Any],
    ) -> None:
        self._files, self._targets, self._thin = files, targets, thin
        self._strict: bool = settings["strict"]
        self._out = Output.of(settings)
        self._inputs = Inputs.of(self._out, settings)
        self._is_page = any(_kind(path) == ".html" for path in targets)

    def run(self) -> int:
        self._refuse_early()
        page = self._page()
        results = [self._checked(path, page) for path in self._files]
        document = {
            "files": [one.document for one in results],
            "skipped": skipped_files(),
        }
        for path in self._targets:
            self._write(path, results, document, page)
        self._out.result("" if self._out.as_json else _text(results, self._out), document)
        for one in results:
            if isinstance(one.found, BspcsgError):
                terminal.print_error(_named(one.path, one.found))
        return max(self._exit_code(one) for one in results)

    def _refuse_early(self) -> None:
        if self._thin is not None and not self._is_page:
            raise click.UsageError("--thin marks thin walls in an HTML page; add -o check.html.")
        for path in self._targets:
            if str(path) == STREAM:
                raise click.UsageError(
                    "-o needs the name of a file, not “-”; --json prints the document."
                )
            refuse_page(path, _JSON, _JUNIT)
            if is_among(path, self._files) and not is_dropped(path):
                raise click.UsageError(f"-o would overwrite the input {path}; choose another name.")

    def _page(self) -> "CheckPage | None":
        if not self._is_page:
            return None
        from ...report.check_page import CheckPage

        return CheckPage(len(self._files), self._thin)

    def _checked(self, path: Path, page: "CheckPage | None") -> _Checked:
        from ...assembly.object_diagnosis import examine

        try:
            self._inputs.refuse_early([path])
            found = examine(self._inputs.raw(path))
        except BspcsgError as error:
            if page is not None:
                page.add_unreadable(display_name(path), _named(path, error))
            return _Checked(path, error)
        if page is not None:
            page.add(display_name(path), found)
        return _Checked(path, found.diagnosis, [(one.name, one.diagnosis) for one in found.objects])

    def _exit_code(self, one: _Checked) -> int:
        if isinstance(one.found, BspcsgError):
            return output.exit_code_of(one.found)
        return output.FOUND if _fails(one.found, self._strict) else output.DONE

    def _write(
        self,
        path: Path,
        results: Sequence[_Checked],
        document: dict[str, Any],
        page: "CheckPage | None",
    ) -> None:
        if _kind(path) == _JSON:
            told = {"schema": SCHEMA, **document}
            write_page(path, json.dumps(told, allow_nan=False, indent=1) + "\n")
        elif _kind(path) == _JUNIT:
            write_page(path, _junit(results, self._strict))
        elif page is not None:
            write_page(path, page.text())


def _kind(path: Path) -> str:
    suffix = path.suffix.lower()
    return suffix if suffix in (_JSON, _JUNIT) else ".html"


def _fails(found: "Diagnosis", strict: bool) -> bool:
    warned = any(finding.severity == "warning" for finding in found.findings)
    return not found.is_solid or (strict and warned)


def _junit(results: Sequence[_Checked], strict: bool) -> str:
    """Return JUnit XML with a suite for each file and a test case for each of its objects."""
    from ...report.junit import junit_of

    suites = {str(one.path): list(_cases(one, strict)) for one in results}
    return junit_of("bspcsg check", suites)


def _cases(one: _Checked, strict: bool) -> "Iterator[JUnitCase]":
    from ...report.junit import JUnitCase

    group = str(one.path)
    if isinstance(one.found, BspcsgError):
        said = _named(one.path, one.found)
        yield JUnitCase(group, one.path.name, "unreadable", "error", said, said)
        return
    for name, found in one.objects or [(one.path.name, one.found)]:
        lines = [_line(finding) for finding in found.findings]
        element = "failure" if _fails(found, strict) else ""
        reason, details = "".join(lines[:1]), "\n".join(lines)
        yield JUnitCase(group, name, found.verdict, element, reason, details, _measures(found))
    for clash in (finding for finding in one.found.findings if finding.code == "clash"):
        # A clash is a finding about two objects, so it is a test case of its own.
        element = "failure" if strict else ""
        yield JUnitCase(group, "objects together", "clash", element, _line(clash), _line(clash))


def _line(finding: "Finding") -> str:
    return f"{finding.severity}: {finding.message.rstrip('.')}."


def _named(path: Path, error: BspcsgError) -> str:
    return error.message if error.message.startswith(str(path)) else f"{path}: {error.message}"


def _text(results: Sequence[_Checked], out: Output) -> str:
    """Return a text with the findings of each file; for several files, a table comes first."""
    read = [(one, one.found) for one in results if not isinstance(one.found, BspcsgError)]
    blocks = [_table(read)] if len(read) > 1 else []
    blocks += [_details(one, found, out) for one, found in read]
    if len(results) > 1:
        bad = sum(not one.is_solid for one in results)
        blocks.append(_conclusion(bad, len(results)))
    return "\n".join(block for block in blocks if block)


def _conclusion(bad: int, count: int) -> str:
    if bad == 0:
        return f"All {count} files are solids."
    return f"{bad} of {count} files {'is not a solid' if bad == 1 else 'are not solids'}."


def _details(one: _Checked, found: "Diagnosis", out: Output) -> str:
    lines = [f"{display_name(one.path)}: {_measures(found, len(one.objects))}"]
    lines += [
        f"  {name}: {_measures(own)}"
        for name, own in one.objects
        if out.verbosity > 0 or not own.is_solid
    ]
    least = {"error": -1, "warning": 0, "note": 0}
    lines += [
        f"  {_line(finding)}"
        for finding in found.findings
        if out.verbosity >= least[finding.severity]
    ]
    if found.verdict == "not closed" and out.advises:
        lines.append(f"  Try: {repair_command(one.path)}")
    return "\n".join(lines)


def _measures(found: "Diagnosis", objects: int = 0) -> str:
    if found.triangles == 0:
        return found.verdict
    words = [
        found.verdict,
        *([counted(objects, "object")] if objects else []),
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


def _table(read: "list[tuple[_Checked, Diagnosis]]") -> str:
    rows = []
    for one, found in read:
        overlaps = "—" if found.self_overlapping is None else _yes(found.self_overlapping)
        flags = [_yes(found.closed), _yes(found.oriented), _yes(found.manifold), overlaps]
        rows.append((str(one.path), grouped(found.triangles), *flags, found.verdict))
    columns = ("file", "triangles", "closed", "oriented", "manifold", "overlaps", "verdict")
    return table_text(columns, rows, right=("triangles",))


def _yes(flag: bool) -> str:
    return "yes" if flag else "no"
