"""Options that several verbs share."""

from collections.abc import Callable
from typing import Any, TypeVar

import click

_Command = TypeVar("_Command", bound=Callable[..., Any])

#: Threads beyond which nobody's machine goes.
_MOST_THREADS = 1024

_COMMON = [
    click.option("--json", "as_json", is_flag=True, help="Print one JSON document instead."),
    click.option(
        "-j",
        "--threads",
        type=click.IntRange(0, _MOST_THREADS),
        default=0,
        help="Number of threads; 0, the default, for all cores.",
    ),
    click.option("-q", "--quiet", is_flag=True, help="Say nothing but results and errors."),
    click.option("-v", "--verbose", is_flag=True, help="Say more about what is done."),
    click.option("--debug", is_flag=True, help="Show where an error comes from."),
]


def common(command: _Command) -> _Command:
    """Add the options that every verb has."""
    for option in reversed(_COMMON):
        command = option(command)
    return command
