"""The verb that writes the interactive lecture: lecture."""

from pathlib import Path
from typing import Any

import click

from ..console import output
from ..console.output import Output
from ..inputs.files import shown
from ..options.shared import FilePath, common, verb
from ..pages.written import refuse_page, write_page

_EPILOG = """\b
Example:
  bspcsg lecture -o lecture.html
"""


@verb("lecture", short_help="Write the interactive lecture on partition trees.", epilog=_EPILOG)
@click.option(
    "-o",
    "--output",
    "target",
    required=True,
    metavar="FILE",
    type=FilePath(),
    help="Page to write, ending in .html.",
)
@common
def lecture(target: Path, **given: Any) -> int:
    """Write one page that explains partition trees with figures to drag and to step through.

    It needs no network: the figures call the core of bspcsg, compiled to WebAssembly, in the page.
    Open it in a browser.
    """
    from ...report.lecture.page import CHAPTERS, lecture_page

    refuse_page(target)
    size = write_page(target, lecture_page())
    line = f"{shown(target)}  {len(CHAPTERS)} chapters"
    document = {"output": str(target), "chapters": len(CHAPTERS), "bytes": size}
    Output.of(given).result(line, document)
    return output.DONE
