"""Printing of results, notes and errors by the command line, and its exit codes."""

import json
import sys
from dataclasses import asdict, dataclass
from typing import Any

import click

from ...errors import (
    BspcsgError,
    Finding,
    FormatError,
    InternalError,
    MissingPartError,
    without_control_characters,
)
from . import status_line, terminal

#: Version of the JSON documents.
SCHEMA = 1

DONE = 0
FOUND = 1
USAGE = 2
UNREADABLE = 3
REFUSED = 4
UNWRITABLE = 5
MISSING = 6
INTERNAL = 70
TIMED_OUT = 124
INTERRUPTED = 130
CLOSED_PIPE = 141


#: The largest number of faces or vertices that a message names.
_MAX_PLACES_NAMED = 3

#: Codes of errors which mean that an optional package or program is not installed.
_MISSING_CODES = frozenset({"missing_dependency", "missing_package", "missing_program"})

#: Codes of errors which mean that a file was not written.
_WRITING_CODES = frozenset({"unwritable", "write_mismatch"})

#: Codes of errors which mean that a time limit was exceeded.
_TIME_CODES = frozenset({"timed_out", "timeout"})


class EmptyResultError(BspcsgError):
    """An error: the result is empty, and ``--allow-empty`` was not given."""


@dataclass(frozen=True)
class Output:
    """Printing of a command's results, notes and warnings to standard output and error.

    Parameters
    ----------
    verbosity : int
        Below 0 without notes and warnings, above 0 with details.
    as_json : bool
        True if standard output gets one JSON document, and nothing else.
    taken : bool
        True if a mesh is written to standard output, so that results go to standard error.
    """

    verbosity: int = 0
    as_json: bool = False
    taken: bool = False

    @classmethod
    def of(cls, settings: dict[str, Any], taken: bool = False) -> "Output":
        """Return the output for the values of ``--verbose``, ``--quiet`` and ``--json``."""
        return cls(int(settings["verbose"]) - int(settings["quiet"]), settings["as_json"], taken)

    def result(self, line: str, document: dict[str, Any]) -> None:
        """Print a result: `document` as JSON if ``--json`` is given, else `line`."""
        if self.as_json:
            with status_line.hidden():
                click.echo(json.dumps({"schema": SCHEMA, **document}, allow_nan=False))
        elif line and not (self.taken and self.verbosity < 0):
            with status_line.hidden():
                click.echo(without_control_characters(line), err=self.taken)

    def detail(self, line: str) -> None:
        """Print a line on standard error, but only with ``--verbose``."""
        if self.verbosity > 0:
            with status_line.hidden():
                click.echo(without_control_characters(line), err=True)

    @property
    def advises(self) -> bool:
        """True if advice is printed: output goes to a terminal, and ``--quiet`` is not given."""
        return self.verbosity >= 0 and sys.stdout.isatty()

    def note(self, line: str) -> None:
        """Print a note on standard error, unless ``--quiet`` is given."""
        if self.verbosity >= 0:
            terminal.print_line("note", line)

    def warning(self, line: str) -> None:
        """Print a warning on standard error, unless ``--quiet`` is given."""
        if self.verbosity >= 0:
            terminal.print_line("warning", line)

    def finding(self, name: str, finding: Finding) -> None:
        """Print a finding about the file `name` on standard error; if ``--quiet``, only errors."""
        least = -1 if finding.severity == "error" else 0
        if self.verbosity >= least:
            said = f"{finding.message}{_element_numbers(finding)}"
            terminal.print_line(finding.severity, f"{name}: {said}")


def _element_numbers(finding: Finding) -> str:
    """Return text with the numbers of the first faces or vertices of a finding, after a colon.

    Return an empty string if the finding's message does not contain the word “these”.
    """
    if " these" not in finding.message or not finding.where:
        return ""
    first = ", ".join(map(str, finding.where[:_MAX_PLACES_NAMED]))
    return f": {first}, …" if finding.count > _MAX_PLACES_NAMED else f": {first}"


def exit_code_of(error: BspcsgError) -> int:
    """Return the exit code of the process for an error."""
    if isinstance(error, InternalError):
        return INTERNAL
    if isinstance(error, MissingPartError) or error.code in _MISSING_CODES:
        return MISSING
    if error.code in _TIME_CODES:
        return TIMED_OUT
    if isinstance(error, FormatError):
        return UNWRITABLE if error.code in _WRITING_CODES else UNREADABLE
    return REFUSED


def report_error(error: BspcsgError, as_json: bool) -> int:
    """Print an error on standard error, and as JSON if `as_json`; return the exit code."""
    code = exit_code_of(error)
    terminal.print_error(error.message)
    if as_json:
        print_error(error_values(error), code)
    return code


def print_error(values: dict[str, Any], code: int) -> None:
    """Print an error, given as JSON values, with the exit code as JSON on standard output."""
    click.echo(json.dumps({"schema": SCHEMA, "error": values, "exit": code}))


def error_values(error: BspcsgError) -> dict[str, Any]:
    """Return an error as JSON values."""
    return {"code": error.code, "message": error.message, "where": list(error.where)}


def finding_values(findings: tuple[Finding, ...]) -> list[dict[str, Any]]:
    """Return findings as JSON values."""
    return [asdict(finding) for finding in findings]


def grouped(number: int) -> str:
    """Return an integer as text, on a terminal with separated thousands."""
    return f"{number:,}".replace(",", terminal.thousands_separator())


def counted(number: int, one: str) -> str:
    """Return a count followed by a noun, in the singular or the plural, such as “2 files”."""
    return f"{grouped(number)} {one}{'' if number == 1 else 's'}"
