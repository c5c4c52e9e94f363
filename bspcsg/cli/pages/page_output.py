"""Writing of HTML pages by verbs, in addition to their printed results."""

from pathlib import Path

import click

from ...errors import FormatError
from ..inputs.files import display_name, is_dropped, refuse_folder
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
    """Raise an error if the path of a page has the wrong suffix or cannot be written.

    Raises
    ------
    FormatError
        If the name has no suffix of a page or of `others`, or its folder is not writable.
    """
    if is_dropped(path):
        return
    if path.suffix.lower() not in (*_SUFFIXES, *others):
        known = " or ".join([", ".join([".html", *others[:-1]]), *others[-1:]])
        raise FormatError(
            f"{display_name(path)}: the format is unknown; the output name must end in {known}.",
            "unknown_format",
        )
    refuse_folder(path)


def write_page(path: Path, text: str) -> int:
    """Write a page as UTF-8, and return the number of its bytes."""
    from ...formats.atomic import write_file

    # File names need not be valid Unicode.
    data = text.encode("utf-8", "replace")
    write_file(path, [data])
    return len(data)
