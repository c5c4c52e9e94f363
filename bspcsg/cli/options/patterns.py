"""Patterns where files are asked for: those that the shell left as they are are matched here."""

import glob
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from ...errors import FormatError
from .shared import PATH


def files_argument(metavar: str, name: str = "files") -> Callable[..., Any]:
    """Return the argument for one or more files, or patterns of them."""
    return click.argument(
        name, nargs=-1, required=True, type=PATH, metavar=metavar, callback=_all_matches
    )


def file_argument(metavar: str = "FILE", name: str = "file") -> Callable[..., Any]:
    """Return the argument for one file, or a pattern that one matches."""
    return click.argument(name, type=PATH, metavar=metavar, callback=_only_match)


def matches(path: Path) -> list[Path]:
    """Return the files that a pattern such as ``parts/*.stl`` means, by name; a name is itself.

    Raises
    ------
    FormatError
        If no file matches; code ``"unreadable"``.
    """
    text = str(path)
    if not glob.has_magic(text) or os.path.lexists(path):
        return [path]
    found = sorted(glob.glob(text, recursive=True))
    if not found:
        raise FormatError(f"{text}: no file matches this pattern.", "unreadable")
    return [Path(name) for name in found]


def _all_matches(
    context: click.Context, option: click.Parameter, values: tuple[Path, ...]
) -> tuple[Path, ...]:
    if context.resilient_parsing:
        return values
    return tuple(path for value in values for path in matches(value))


def _only_match(context: click.Context, option: click.Parameter, value: Path | None) -> Path | None:
    if context.resilient_parsing or value is None:
        return value
    found = matches(value)
    if len(found) > 1:
        message = f"{value} matches {len(found)} files; name one of them, as {found[0]}."
        raise click.UsageError(message, context)
    return found[0]
