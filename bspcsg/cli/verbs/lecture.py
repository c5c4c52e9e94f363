"""The verb that writes the interactive lecture: lecture."""

from pathlib import Path
from typing import Any

import click

from ...errors import FormatError
from ..console import output
from ..console.output import Output
from ..inputs.files import refuse_folder, shown
from ..options.shared import common

_EPILOG = """\b
Example:
  bspcsg lecture -o lecture.html
"""

_SUFFIXES = (".html", ".htm")


@click.command(
    "lecture", short_help="Write the interactive lecture on partition trees.", epilog=_EPILOG
)
@click.option(
    "-o",
    "--output",
    "target",
    required=True,
    metavar="FILE",
    type=click.Path(path_type=Path, readable=False),
    help="Page to write, ending in .html.",
)
@common
def lecture(target: Path, **given: Any) -> int:
    """Write one page that explains partition trees with figures to drag and to step through.

    It needs no network: the figures call the core of bspcsg, compiled to WebAssembly, in the page.
    Open it in a browser.
    """
    from ...formats.atomic import write_file
    from ...report.lecture.page import CHAPTERS, lecture_page

    if target.suffix.lower() not in _SUFFIXES:
        message = f"{shown(target)}: the name must end in .html."
        raise FormatError(message, "unknown_format")
    refuse_folder(target)
    page = lecture_page().encode("utf-8")
    write_file(target, [page])
    line = f"{shown(target)}  {len(CHAPTERS)} chapters"
    document = {"output": str(target), "chapters": len(CHAPTERS), "bytes": len(page)}
    Output.of(given).result(line, document)
    return output.DONE
