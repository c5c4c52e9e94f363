"""Files of arguments: names, folders, and patterns that the shell did not expand.

Files that accompany meshes, such as textures, are skipped and counted, unless the user names them.
"""

import glob
import os
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import Any

import click

from ...errors import FormatError
from ..console import terminal
from .shared import PATH

#: Endings of what goes beside meshes: materials, pictures, data of glTF, words about them.
_BESIDE = frozenset(
    [".mtl", ".bin", ".txt", ".md", ".html", ".pdf", ".xml", ".csv", ".svg"]
    + [".png", ".jpg", ".jpeg", ".webp", ".gif", ".bmp", ".tga", ".tif", ".tiff", ".dds", ".ktx2"]
)

#: Where a context keeps how many files of which ending were skipped.
_SKIPPED = "bspcsg.skipped"


def files_argument(
    metavar: str, name: str = "files", *, opens: bool = True, also: Collection[str] = ()
) -> Callable[..., Any]:
    """Return the argument for one or more files, folders of them, or patterns.

    Parameters
    ----------
    metavar, name : str
    opens : bool
        True to replace a folder by the meshes in it; else the folder itself is returned.
    also : collection of str
        Suffixes of other files that folders and patterns include.
    """

    def found(
        context: click.Context, option: click.Parameter, values: tuple[Path, ...]
    ) -> tuple[Path, ...]:
        if context.resilient_parsing:
            return values
        skipped: Counter[str] = Counter()
        files = tuple(files_of(values, skipped, also, opens=opens))
        context.meta[_SKIPPED] = skipped
        if skipped and not terminal.QUIET.intersection(context.find_root().obj or ()):
            terminal.say("note", f"skipped {_counted(skipped)}.")
        return files

    return click.argument(name, nargs=-1, required=True, type=PATH, metavar=metavar, callback=found)


def skipped_files() -> dict[str, int]:
    """Return how many files of each suffix the running verb skipped."""
    return dict(click.get_current_context().meta.get(_SKIPPED, {}))


def file_argument(metavar: str = "FILE", name: str = "file") -> Callable[..., Any]:
    """Return the argument for one file, or a pattern that one matches."""
    return click.argument(name, type=PATH, metavar=metavar, callback=_only_match)


def files_of(
    values: Sequence[Path],
    skipped: Counter[str],
    also: Collection[str] = (),
    *,
    opens: bool = True,
) -> list[Path]:
    """Return the files that names, folders and patterns mean; count skipped files by suffix.

    A folder means the meshes in it and its subfolders, without hidden ones. A pattern with an open
    suffix means meshes. A name means itself; but a companion file, such as a texture, is skipped if
    other files are named too, as by a pattern that the shell expanded.

    Raises
    ------
    FormatError
        If no file is left; code ``"unreadable"``.
    """
    files: list[Path] = []
    for value in values:
        found = matches(value)
        inside = (file for path in found for file in _inside(path)) if opens else found
        for path in dict.fromkeys(inside):
            if _is_meant(path, value, also, alone=len(values) == 1):
                files.append(path)
            else:
                skipped[path.suffix.lower()] += 1
    if not files:
        only = f", only {_counted(skipped)}" if skipped else ""
        raise FormatError(f"{values[0]}: no mesh file was found{only}.", "unreadable")
    return files


def _is_meant(path: Path, value: Path, also: Collection[str], *, alone: bool) -> bool:
    """Say whether an argument that matches a file is meant to include it."""
    from ...formats.registry import FORMATS

    suffix = path.suffix.lower()
    if suffix in FORMATS or suffix in also:
        return True
    if path == value:
        return alone or suffix not in _BESIDE
    return suffix != "" and suffix == value.suffix.lower() and not value.is_dir()


def _inside(path: Path) -> Iterator[Path]:
    """Yield the files in a folder and its folders, by name; a file is itself."""
    if not path.is_dir():
        yield path
        return
    for file in sorted(path.rglob("*")):
        hidden = any(part.startswith(".") for part in file.relative_to(path).parts)
        if not hidden and file.is_file():
            yield file


def _counted(skipped: Counter[str]) -> str:
    """Return a text on how many files of each suffix are no meshes."""
    kinds = ", ".join(
        f"{count} {suffix or 'without an ending'}" for suffix, count in sorted(skipped.items())
    )
    total = skipped.total()
    return (
        f"{total}"
        f" {('file that is not a mesh' if total == 1 else 'files that are not meshes')}:"
        f" {kinds}"
    )


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


def _only_match(context: click.Context, option: click.Parameter, value: Path | None) -> Path | None:
    if context.resilient_parsing or value is None:
        return value
    found = matches(value)
    if len(found) > 1:
        message = (
            f"{value} matches {len(found)} files, but only one is allowed here; name one of them,"
            f" such as {found[0]}."
        )
        raise click.UsageError(message, context)
    return found[0]
