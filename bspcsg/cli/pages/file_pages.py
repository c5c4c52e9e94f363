"""The pages that a live server shows: one page of several files, or a page for each of a folder."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias
from urllib.parse import quote, unquote

from ...errors import BspcsgError
from ..inputs.scripts import SUFFIXES
from .live_server import Site, change_stamp

if TYPE_CHECKING:
    from ...report.viewer.layer import Layer

#: A function that reads files, and returns the layers of a view and their unit.
SceneReader: TypeAlias = Callable[[Sequence[Path]], "tuple[list[Layer], str]"]

_PART = "/part/"


def page_of(files: Sequence[Path], scene: SceneReader) -> str:
    """Return a page that shows files and reloads when they change, or a page with the error."""
    from ...report.assets import rendered
    from ...report.viewer.view_page import view_page

    title = ", ".join(path.name for path in files)
    try:
        layers, unit = scene(files)
    except BspcsgError as error:
        return rendered("live.html", title=title, error=error.message, folder="", files=())
    return view_page(layers, title, unit=unit, live=title)


def site_of_files(files: Sequence[Path], scene: SceneReader) -> Site:
    """Return a site of one page that shows all files together."""
    kept = _PageCache(lambda: change_stamp(files), lambda: change_stamp(folders_of(files)))

    def page(path: str) -> str | None:
        return kept.page(path, lambda: page_of(files, scene)) if path == "/" else None

    return Site(page, kept.state)


def site_of_folder(folder: Path, scene: SceneReader) -> Site:
    """Return a site with a list of the meshes and scripts in a folder, and a page for each."""
    kept = _PageCache(lambda: change_stamp([folder]), str)

    def page(path: str) -> str | None:
        names = mesh_names_in(folder)
        if path == "/":
            return kept.page(path, lambda: _list(folder, names))
        name = unquote(path.removeprefix(_PART))
        if not path.startswith(_PART) or name not in names:
            return None
        return kept.page(path, lambda: page_of([folder / name], scene))

    return Site(page, kept.state)


def mesh_names_in(folder: Path) -> list[str]:
    """Return the names of the meshes and scripts in a folder, sorted."""
    from ...formats.registry import FORMATS

    try:
        found = [path for path in folder.iterdir() if path.is_file()]
    except OSError:
        return []
    return sorted(p.name for p in found if p.suffix.lower() in {*FORMATS, *SUFFIXES})


def folders_of(files: Sequence[Path]) -> list[Path]:
    """Return the folders of the scripts among `files`, since a script may read files beside it."""
    return sorted({path.parent for path in files if path.suffix.lower() in SUFFIXES})


def _list(folder: Path, names: Sequence[str]) -> str:
    from ...report.assets import rendered

    files = [(name, _PART + quote(name)) for name in names]
    title = folder.resolve().name or str(folder)
    return rendered("live.html", title=title, error="", folder=str(folder), files=files)


class _PageCache:
    """A cache of the page that was made last, which is valid until a file changes.

    Parameters
    ----------
    own, around : callable
        Return the state of the files that are shown, and of the folders of scripts. A script may
        write files into its folder; such changes while a page is made do not make it invalid.
    """

    def __init__(self, own: Callable[[], str], around: Callable[[], str]) -> None:
        self._own = own
        self._around = around
        self._made_of = ("", "")
        self._pages: dict[str, str] = {}

    def state(self) -> str:
        """Return a text that changes whenever a file that pages depend on changes."""
        return "".join((self._own(), self._around()))

    def page(self, path: str, make: Callable[[], str]) -> str:
        """Return the page at a path from the cache, or made by `make` if a file has changed."""
        if self._made_of != (self._own(), self._around()):
            self._pages.clear()
        if path not in self._pages:
            own = self._own()
            self._pages = {path: make()}
            self._made_of = own, self._around()
        return self._pages[path]
