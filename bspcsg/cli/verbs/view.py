"""The verb `view`, which shows meshes in a browser."""

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...browsing import open_page, temporary_page
from ..console import output
from ..console.output import Output, counted
from ..inputs.files import STREAM, Inputs, display_name, is_dropped
from ..options.patterns import files_argument
from ..options.shared import PORT, FilePath, common_options, is_given, reading_options, verb
from ..pages.file_layers import layers_of
from ..pages.page_output import refuse_page, write_page

if TYPE_CHECKING:
    from ...report.viewer.layer import Layer

_EPILOG = """\b
Examples:
  bspcsg view part.stl
  bspcsg view before.stl after.stl -o both.html --no-open
  bspcsg view part.py --live
  bspcsg view parts/
"""

#: The largest number of bytes of a page that browsers open quickly; a longer one takes seconds.
_MAX_QUICK_PAGE_BYTES = 20_000_000


@verb("view", short_help="Show meshes in a browser, as one page.", epilog=_EPILOG)
@files_argument("FILE [...]", opens=False)
@click.option(
    "-o",
    "--output",
    "target",
    metavar="FILE",
    type=FilePath(),
    help="Page to write; by default one in the folder for temporary files.",
)
@click.option(
    "--open/--no-open", "opens", default=True, help="Open the page in a browser (default)."
)
@click.option(
    "--thickness", is_flag=True, help="Offer to colour faces by how thick the part is there."
)
@click.option(
    "--live", is_flag=True, help="Serve the page on this machine; it follows the files' changes."
)
@PORT
@reading_options
@common_options
def view(files: tuple[Path, ...], target: Path | None, **given: Any) -> int:
    """Show meshes in a browser: turn, zoom, cut, measure, make transparent, hide each part.

    Faces have the colours and textures of the file, or can be coloured by the operand of a script
    from which they come. The page is one file that needs no network and can be sent to others.
    Meshes need not be closed. Without a screen, as over ssh, the page is written, but not opened.

    With --live, and always for a folder, a server, which only this machine can reach, shows the
    page, and updates it when a file changes, until Ctrl-C.
    """
    return _Viewing(files, target, **given).run()


class _Viewing:
    """The work of the verb `view`: it writes or serves a page that shows meshes."""

    def __init__(self, files: tuple[Path, ...], target: Path | None, **settings: Any) -> None:
        self._files = files
        self._target = target
        self._settings = settings
        self._out = Output.of(settings)
        self._inputs = Inputs.of(self._out, settings)

    def run(self) -> int:
        from ...report.viewer.view_page import view_page

        self._refuse_early()
        if self._settings["live"] or self._folder is not None:
            return self._served()
        layers, unit = self._scene(self._files)
        title = ", ".join(layer.name for layer in layers)
        page = view_page(layers, title, unit=unit)
        first = self._files[0]
        stem = "view" if str(first) == STREAM else first.stem
        target = self._target or temporary_page(stem)
        size = write_page(target, page)
        if size > _MAX_QUICK_PAGE_BYTES:
            self._out.note(
                f"the page has {size / 1000000.0:.0f} MB, so it opens slowly in a browser."
            )
        opens = self._settings["opens"] and not is_dropped(target)
        is_open = opens and self._opened(target.resolve().as_uri())
        self._tell(target, layers, size, is_open)
        return output.DONE

    @property
    def _folder(self) -> Path | None:
        """The folder to show, if the only input is a folder, else None."""
        return self._files[0] if len(self._files) == 1 and self._files[0].is_dir() else None

    def _scene(self, files: Sequence[Path]) -> "tuple[list[Layer], str]":
        from ...report.viewer.layer_making import with_thickness

        layers, unit = layers_of(self._inputs, files)
        if self._settings["thickness"]:
            layers = [with_thickness(layer) for layer in layers]
        return layers, unit

    def _served(self) -> int:
        """Serve the page until Ctrl-C, and return the exit code."""
        from ..pages.file_pages import site_of_files, site_of_folder
        from ..pages.live_server import LiveServer

        folder = self._folder
        site = (
            site_of_files(self._files, self._scene)
            if folder is None
            else site_of_folder(folder, self._scene)
        )
        server = LiveServer(site, self._settings["port"])
        is_open = self._settings["opens"] and self._opened(server.address)
        files = [str(path) for path in self._files]
        document = {"files": files, "address": server.address, "opened": is_open}
        self._out.result(f"{server.address}  until Ctrl-C", document)
        sys.stdout.flush()
        server.serve()
        return output.DONE

    def _refuse_early(self) -> None:
        serves = self._settings["live"] or self._folder is not None
        if serves and self._target is not None:
            raise click.UsageError(
                "a page that is served live is not written to a file; leave out -o."
            )
        if not serves and is_given("port"):
            raise click.UsageError("--port can only be used with --live or a folder.")
        if self._folder is not None:
            return
        if self._settings["live"] and any(str(path) == STREAM for path in self._files):
            raise click.UsageError("--live needs files, not standard input.")
        if self._target is not None:
            refuse_page(self._target)
        self._inputs.refuse_early(self._files)

    def _opened(self, address: str) -> bool:
        """Open an address in a browser; return False and print the reason if that fails."""
        reason = open_page(address)
        if reason:
            self._out.note(reason)
        return not reason

    def _tell(self, target: Path, layers: "list[Layer]", size: int, is_open: bool) -> None:
        triangles = sum(len(layer.faces) for layer in layers)
        line = f"{display_name(target)}  {counted(triangles, 'triangle')}  {size / 1000:.0f} kB"
        document = {
            "files": [str(path) for path in self._files],
            "output": str(target),
            "triangles": triangles,
            "bytes": size,
            "opened": is_open,
        }
        self._out.result(line, document)
