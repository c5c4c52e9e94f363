"""The verb `lecture`, which writes the interactive lecture on partition trees."""

from pathlib import Path
from typing import Any

import click

from ...browsing import open_page, temporary_page
from ..console import output
from ..console.output import Output
from ..inputs.files import display_name
from ..options.shared import FilePath, common_options, verb
from ..pages.page_output import refuse_page, write_page

_EPILOG = """\b
Examples:
  bspcsg lecture
  bspcsg lecture -o lecture.html
"""


@verb("lecture", short_help="Write the interactive lecture on partition trees.", epilog=_EPILOG)
@click.option(
    "-o",
    "--output",
    "target",
    metavar="FILE",
    type=FilePath(),
    help="Page to write, ending in .html; by default a temporary one, opened in a browser.",
)
@common_options
def lecture(target: Path | None, **given: Any) -> int:
    """Write one page that explains partition trees with figures to drag and to step through.

    It needs no network: the figures call the core of bspcsg, compiled to WebAssembly, in the page.
    """
    from ...report.lecture.page import CHAPTERS, lecture_page

    out = Output.of(given)
    page = temporary_page("lecture") if target is None else target
    refuse_page(page)
    size = write_page(page, lecture_page())
    reason = open_page(page.as_uri()) if target is None else ""
    if reason:
        out.note(reason)
    line = f"{display_name(page)}  {len(CHAPTERS)} chapters"
    document = {"output": str(page), "chapters": len(CHAPTERS), "bytes": size}
    out.result(line, document)
    return output.DONE
