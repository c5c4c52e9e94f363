"""The verb that shows meshes in a browser: view."""

import os
import sys
import tempfile
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ...errors import FormatError
from .. import output
from ..files import Inputs, is_dropped, refuse_folder, shown
from ..options import common, reading
from ..output import Output, counted
from ..patterns import files_argument

if TYPE_CHECKING:
    from ...report.viewer.layer import Layer

_EPILOG = """\b
Examples:
  bspcsg view part.stl
  bspcsg view before.stl after.stl -o both.html --no-open
"""

_SUFFIXES = (".html", ".htm")

#: Bytes above which a page takes a browser seconds to open.
_LARGE = 20_000_000


@click.command("view", short_help="Show meshes in a browser, as one page.", epilog=_EPILOG)
@files_argument("FILE [...]")
@click.option(
    "-o",
    "--output",
    "target",
    metavar="FILE",
    type=click.Path(path_type=Path, readable=False),
    help="Page to write; by default one in the folder for temporary files.",
)
@click.option(
    "--open/--no-open", "opens", default=True, help="Open the page in a browser (default)."
)
@reading
@common
def view(files: tuple[Path, ...], target: Path | None, **given: Any) -> int:
    """Show meshes in a browser: turn, zoom, cut, edges on and off, a button for each file.

    The page is one file that needs no network and can be sent to others. Meshes need not be closed.
    Without a screen, as over ssh, it is only written.
    """
    return _Viewing(files, target, **given).run()


class _Viewing:
    """Meshes, and the page that shows them."""

    def __init__(self, files: tuple[Path, ...], target: Path | None, **settings: Any) -> None:
        self._files = files
        self._target = target
        self._settings = settings
        self._out = Output.of(settings)
        self._inputs = Inputs.of(self._out, settings)

    def run(self) -> int:
        from ...formats.atomic import write_file
        from ...report.viewer.view import view_page

        self._refuse_early()
        layers, unit = self._layers()
        title = ", ".join(layer.name for layer in layers)
        page = view_page(layers, title, unit=unit).encode("utf-8")
        target = self._target or _temporary(layers[0].name)
        write_file(target, [page])
        if len(page) > _LARGE:
            self._out.note(f"the page has {len(page) / 1e6:.0f} MB; browsers take a while for it.")
        opened = self._settings["opens"] and not is_dropped(target) and self._opened(target)
        self._tell(target, layers, len(page), opened)
        return output.DONE

    def _refuse_early(self) -> None:
        if self._target is not None and not is_dropped(self._target):
            if self._target.suffix.lower() not in _SUFFIXES:
                message = f"{shown(self._target)}: the name must end in .html."
                raise FormatError(message, "unknown_format")
            refuse_folder(self._target)
        self._inputs.refuse_early(self._files)

    def _layers(self) -> "tuple[list[Layer], str]":
        """Return a layer for each file, and the unit if all files have it."""
        from ...report.viewer.layer import COLOURS, RESULT, Layer

        layers, units = [], set()
        for number, path in enumerate(self._files):
            raw = self._inputs.raw(path)
            self._inputs.tell(path, raw.findings)
            if not len(raw.faces):
                self._out.warning(f"{shown(path)}: there is nothing in it to be seen.")
            colour = RESULT if len(self._files) == 1 else COLOURS[number % len(COLOURS)]
            layers.append(Layer(path.name, raw.vertices, raw.faces, colour))
            units.add(raw.unit)
        return layers, units.pop() if len(units) == 1 else ""

    def _opened(self, target: Path) -> bool:
        """Open the page, or say why not."""
        if not _has_screen():
            self._out.note("there is no screen here; open the page in a browser yourself.")
            return False
        if webbrowser.open(target.resolve().as_uri()):
            return True
        self._out.note("no browser could be started; open the page yourself.")
        return False

    def _tell(self, target: Path, layers: "list[Layer]", size: int, opened: bool) -> None:
        triangles = sum(len(layer.faces) for layer in layers)
        line = f"{shown(target)}  {counted(triangles, 'triangle')}  {size / 1000:.0f} kB"
        document = {
            "files": [str(path) for path in self._files],
            "output": str(target),
            "triangles": triangles,
            "bytes": size,
            "opened": opened,
        }
        self._out.result(line, document)


def _temporary(name: str) -> Path:
    """Return a name for a page in a folder of its own, which stays."""
    return Path(tempfile.mkdtemp(prefix="bspcsg-")) / f"{Path(name).stem or 'view'}.html"


def _has_screen() -> bool:
    """Whether a browser that is started here can be seen."""
    if os.environ.get("SSH_CONNECTION") or os.environ.get("SSH_TTY"):
        return False
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
