"""The files that a verb's arguments mean: names, folders, and patterns that the shell has left.

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

#: Suffixes of files that accompany meshes: materials, pictures, data of glTF, texts about them.
_COMPANION_SUFFIXES = frozenset(
    [".mtl", ".bin", ".txt", ".md", ".html", ".pdf", ".xml", ".csv", ".svg"]
    + [".png", ".jpg", ".jpeg", ".webp", ".gif", ".bmp", ".tga", ".tif", ".tiff", ".dds", ".ktx2"]
)

#: The key in click's context of the count of skipped files by suffix.
_SKIPPED = "bspcsg.skipped"


def files_argument(
    metavar: str, name: str = "files", *, opens: bool = True, also: Collection[str] = ()
) -> Callable[..., Any]:
    """Return a click argument for one or more files, folders of files, or patterns.

    Parameters
    ----------
    metavar, name : str
    opens : bool
        True to replace a folder by the meshes in it; else the folder itself is returned.
    also : collection of str
        Suffixes, besides those of meshes, of files that folders and patterns include.
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
            terminal.print_line("note", f"skipped {_counted(skipped)}.")
        return files

    return click.argument(name, nargs=-1, required=True, type=PATH, metavar=metavar, callback=found)


def skipped_files() -> dict[str, int]:
    """Return the number of files that the running verb has skipped, by suffix."""
    return dict(click.get_current_context().meta.get(_SKIPPED, {}))


def file_argument(metavar: str = "FILE", name: str = "file") -> Callable[..., Any]:
    """Return a click argument for one file, or for a pattern that exactly one file matches."""
    return click.argument(name, type=PATH, metavar=metavar, callback=_only_match)


def files_of(
    values: Sequence[Path],
    skipped: Counter[str],
    also: Collection[str] = (),
    *,
    opens: bool = True,
) -> list[Path]:
    """Return the files that names, folders and patterns mean; count skipped files by suffix.

    A folder means the meshes in it and its subfolders, without hidden files. A pattern without a
    fixed suffix means meshes. A name means itself; but a companion file, such as a texture, is
    skipped if other files are named too, as by a pattern that the shell expanded.

    Raises
    ------
    FormatError
        If the arguments mean no file; code ``"unreadable"``.
    """
    files: list[Path] = []
    for value in values:
        found = matches(value)
        inside = (file for path in found for file in _files_in(path)) if opens else found
        for path in dict.fromkeys(inside):
            if _is_selected(path, value, also, alone=len(values) == 1):
                files.append(path)
            else:
                skipped[path.suffix.lower()] += 1
    if not files:
        only = f", only {_counted(skipped)}" if skipped else ""
        raise FormatError(f"{values[0]}: no mesh file was found{only}.", "unreadable")
    return files


def _is_selected(path: Path, value: Path, also: Collection[str], *, alone: bool) -> bool:
    """Say whether a file that an argument `value` matches is to be processed, not skipped.

    True for meshes and suffixes in `also`; for a named file unless it accompanies meshes and is not
    `alone`; for a pattern with a fixed suffix.
    """
    from ...formats.registry import FORMATS

    suffix = path.suffix.lower()
    if suffix in FORMATS or suffix in also:
        return True
    if path == value:
        return alone or suffix not in _COMPANION_SUFFIXES
    return suffix != "" and suffix == value.suffix.lower() and not value.is_dir()


def _files_in(path: Path) -> Iterator[Path]:
    """Yield the files in a folder and its subfolders, sorted; for a file, the file itself."""
    if not path.is_dir():
        yield path
        return
    for file in sorted(path.rglob("*")):
        hidden = any(part.startswith(".") for part in file.relative_to(path).parts)
        if not hidden and file.is_file():
            yield file


def _counted(skipped: Counter[str]) -> str:
    """Return a text with the number of skipped files, in total and by suffix."""
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
    """Return the files that match a pattern such as ``parts/*.stl``, sorted; for a name, itself.

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
