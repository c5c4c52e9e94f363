"""Colours, labels and widths of terminal output, by the usual conventions (such as NO_COLOR)."""

import os
import shutil
import sys
from typing import TextIO

import click

from ...errors import without_control_characters
from . import status_line

#: The colour of each label with which a line on standard error may begin.
_COLOURS = {"error": "red", "warning": "yellow", "note": "cyan"}

#: The options that suppress notes, for notes that are printed before options are parsed.
QUIET = frozenset({"-q", "--quiet"})

#: The smallest width for which a table is laid out, in characters.
_MIN_TABLE_WIDTH = 40


def wants_colour(stream: TextIO) -> bool:
    """Say whether text for a stream is coloured.

    The variable `NO_COLOR` decides, else `FORCE_COLOR`, else whether the stream is a terminal.
    """
    if os.environ.get("NO_COLOR"):
        return False
    forced = os.environ.get("FORCE_COLOR")
    if forced:
        return forced != "0"
    return os.environ.get("TERM") != "dumb" and stream.isatty()


def labelled(label: str, line: str) -> str:
    """Return a line after a label such as "note:", coloured if standard error takes colours."""
    if wants_colour(sys.stderr):
        bold = label == "error"
        return f"{click.style(f'{label}:', fg=_COLOURS[label], bold=bold)} {line}"
    return f"{label}: {line}"


def print_line(label: str, line: str, before: str = "") -> None:
    """Print a line on standard error, after `before` and a label such as "note"."""
    with status_line.hidden():
        told = before + labelled(label, without_control_characters(line))
        click.echo(told, err=True, color=wants_colour(sys.stderr))


def print_error(message: str) -> None:
    """Print an error message on standard error."""
    print_line("error", message, "bspcsg: ")


def output_width() -> int | None:
    """Return the number of columns of standard output, or None if it is not a terminal."""
    if not sys.stdout.isatty():
        return None
    return max(_MIN_TABLE_WIDTH, shutil.get_terminal_size().columns)


def thousands_separator() -> str:
    """Return the separator of thousands: a no-break space on a terminal, nothing in a pipe."""
    return "\N{NO-BREAK SPACE}" if sys.stdout.isatty() else ""
