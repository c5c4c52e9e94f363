"""Pages that verbs write beside what they say."""

from pathlib import Path

import click

from ...errors import FormatError
from ..inputs.files import is_dropped, refuse_folder, shown
from ..options.shared import FilePath

_SUFFIXES = (".html", ".htm")

PAGE = click.option(
    "-o",
    "--output",
    "--html",
    "page",
    metavar="FILE",
    type=FilePath(),
    help="Write a page, too, that shows it in 3D in a browser.",
)


def refuse_page(path: Path, *others: str) -> None:
    """Refuse what can be known to be no page, or file of another ending, that can be written.

    Raises
    ------
    FormatError
        If the name has no such ending, or its folder cannot be written to.
    """
    if is_dropped(path):
        return
    if path.suffix.lower() not in (*_SUFFIXES, *others):
        known = " or ".join([", ".join([".html", *others[:-1]]), *others[-1:]])
        raise FormatError(f"{shown(path)}: the name must end in {known}.", "unknown_format")
    refuse_folder(path)


def write_page(path: Path, text: str) -> int:
    """Write a page, and return how many bytes it has."""
    from ...formats.atomic import write_file

    # Names of files need not be text.
    data = text.encode("utf-8", "replace")
    write_file(path, [data])
    return len(data)
