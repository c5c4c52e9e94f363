"""The look of the terminal: colours and widths by the conventions of the command line."""

import os
import shutil
import sys
from typing import TextIO

import click

from ...errors import harmless
from . import status

#: Colours of what a line begins with.
_COLOURS = {"error": "red", "warning": "yellow", "note": "cyan"}

#: The options that silence notes, for what is said before options are read.
QUIET = frozenset({"-q", "--quiet"})

#: The smallest width that a table is fitted to, in characters.
_MIN_TABLE_WIDTH = 40


def wants_colour(stream: TextIO) -> bool:
    """Say whether a stream gets colours, by `NO_COLOR`, then `FORCE_COLOR`, then its kind."""
    if os.environ.get("NO_COLOR"):
        return False
    forced = os.environ.get("FORCE_COLOR")
    if forced:
        return forced != "0"
    return os.environ.get("TERM") != "dumb" and stream.isatty()


def labelled(label: str, line: str) -> str:
    """Return a line after a label such as "note", for standard error."""
    if wants_colour(sys.stderr):
        bold = label == "error"
        return f"{click.style(f'{label}:', fg=_COLOURS[label], bold=bold)} {line}"
    return f"{label}: {line}"


def say(label: str, line: str, before: str = "") -> None:
    """Print a line with its label on standard error."""
    with status.hidden():
        told = before + labelled(label, harmless(line))
        click.echo(told, err=True, color=wants_colour(sys.stderr))


def say_error(message: str) -> None:
    """Print an error message on standard error."""
    say("error", message, "bspcsg: ")


def width() -> int | None:
    """Return the number of columns of standard output, or None if it is not a terminal."""
    if not sys.stdout.isatty():
        return None
    return max(_MIN_TABLE_WIDTH, shutil.get_terminal_size().columns)


def thousands() -> str:
    """Return the separator of thousands: a no-break space on a terminal, nothing in a pipe."""
    return "\N{NO-BREAK SPACE}" if sys.stdout.isatty() else ""
