"""The verb `report`, which makes a page, or JUnit XML, of the results of `crosscheck`."""

import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import FormatError
from ..console import clock, output, standard_streams, status_line
from ..console.output import Output, counted
from ..inputs.files import STREAM, display_name, is_among, is_dropped, refuse_folder
from ..options.patterns import files_argument
from ..options.shared import PATH, common_options, verb

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    from ...campaign.record import CaseRecord, Results, RunRecord

_EPILOG = """\b
Examples:
  bspcsg report results.jsonl -o report.html
  bspcsg report results-*.jsonl -o - --format md >> "$GITHUB_STEP_SUMMARY"
"""

#: The format of a report by the suffix of the output.
_SUFFIXES = {".html": "html", ".htm": "html", ".md": "md", ".json": "json", ".xml": "junit"}
_FORMATS = ("html", "md", "json", "junit")


@verb("report", short_help="Make a page, or JUnit, of what crosscheck found.", epilog=_EPILOG)
@files_argument("RESULTS.jsonl [...]", opens=False, also=(".jsonl",))
@click.option(
    "-o",
    "--output",
    "target",
    required=True,
    metavar="FILE",
    type=PATH,
    help="File to write; - for standard output.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(_FORMATS),
    help="By default what the suffix of the output says.",
)
@click.option(
    "--cards",
    metavar="N",
    type=click.IntRange(0),
    default=40,
    show_default=True,
    help="Cases shown with pictures and all numbers, failures first.",
)
@click.option(
    "--title",
    metavar="TITLE",
    default="Validation report",
    show_default=True,
    help="Title of the page.",
)
@common_options
def report(files: tuple[Path, ...], target: Path, **given: Any) -> int:
    """Make one page of the results of bspcsg crosscheck; nothing is computed again.

    Several files, such as the shards of one campaign, become one report; their order does not
    matter. The page is one file that needs no network: a table to sort and filter, and pictures and
    3D views of the cases whose meshes were kept.
    """
    return _Reporting(files, target, **given).run()


class _Reporting:
    """The work of the verb `report`: it merges results files and writes a report."""

    def __init__(self, files: tuple[Path, ...], target: Path, **settings: Any) -> None:
        self._files = files
        self._target = target
        self._settings = settings
        self._is_stream = str(target) == STREAM
        self._out = Output.of(settings)
        suffix = ".html" if is_dropped(target) else target.suffix.lower()
        self._form = settings["form"] or _SUFFIXES.get(suffix)

    def run(self) -> int:
        from ...campaign.record import is_failure
        from ...parameters import set_threads
        from ...report.merging import merged

        set_threads(self._settings["threads"])
        self._refuse_early()
        results = merged(self._files)
        text = self._text(results)
        # Case names need not be valid Unicode.
        self._put(text.encode("utf-8", "replace"))
        if self._is_stream:
            return output.DONE
        failures = sum(map(is_failure, results.cases.values()))
        seconds = clock.elapsed()
        line = (
            f"{display_name(self._target)}  {counted(len(results.cases), 'case')}"
            f"  {counted(failures, 'failure')}  {len(text) / 1000:.0f} kB  {seconds:.2f} s"
        )
        document = {
            "files": [str(path) for path in self._files],
            "output": str(self._target),
            "format": self._form,
            "cases": len(results.cases),
            "failures": failures,
            "seconds": round(seconds, 4),
        }
        self._out.result(line, document)
        return output.DONE

    def _refuse_early(self) -> None:
        if self._form is None:
            known = ", ".join(_SUFFIXES)
            if self._is_stream:
                raise click.UsageError(
                    "to write to standard output, give the format, such as --format md."
                )
            message = (
                f"{display_name(self._target)}: the format is unknown; the output name must end in"
                f" one of {known}, or give --format."
            )
            raise FormatError(message, "unknown_format")
        if self._is_stream and self._out.as_json:
            raise click.UsageError(
                "--json and a report cannot both go to standard output; give -o a file name, or"
                " leave out --json."
            )
        if self._is_stream:
            return
        refuse_folder(self._target)
        if is_among(self._target, self._files):
            message = f"the report would overwrite the input {self._target}; choose another name."
            raise click.UsageError(message)

    def _text(self, results: "Results") -> str:
        if self._form == "html":
            from ...report.campaign_page import report_page

            with _progress(self._out) as watch:
                settings = self._settings
                return report_page(results, settings["cards"], settings["title"], watch)
        if self._form == "json":
            from ...report.merging import document

            return document(results)
        from ...report.merging import ordered

        return self._summary()(ordered(results), results.runs)

    def _summary(self) -> "Callable[[Sequence[CaseRecord], Sequence[RunRecord]], str]":
        if self._form == "md":
            from ...report.markdown import markdown_text

            return markdown_text
        from ...report.junit import junit_text

        return junit_text

    def _put(self, data: bytes) -> None:
        from ...formats.atomic import write_file

        if self._is_stream:
            standard_streams.write_bytes([data])
        else:
            write_file(self._target, [data])


@contextmanager
def _progress(out: Output) -> "Iterator[Callable[[list[CaseRecord]], Iterable[CaseRecord]]]":
    """Yield a function that iterates over cases, and shows a progress bar on a terminal."""
    if not sys.stderr.isatty() or out.verbosity < 0:
        yield iter
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeElapsedColumn

    status_line.end()
    columns = ("drawing", BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        yield bar.track
