"""Views in the cells of a notebook, of which one holds the viewer for all.

Each view is a frame with a picture of its own. Its page asks the page around it for the viewer,
and that answers as soon as the cell is there that holds it, also in a notebook that was saved and
opened again.
"""

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import sha256
from typing import Any

from ..assets import asset, bundle

#: Frontends whose outputs are pages apart, which cannot ask each other.
_APART = ("google.colab",)


@dataclass(frozen=True)
class Cell:
    """One run of a cell in a notebook.

    Parameters
    ----------
    place : str
        What the cell is known by; it stays when the cell runs again.
    run : str
    """

    place: str
    run: str


class Notebook:
    """A notebook, and the cell of it that holds the viewer."""

    def __init__(self) -> None:
        self._holder: Cell | None = None

    def script(self, cell: Cell) -> str:
        """Return the viewer for all frames, where a cell is the first, or has to hold it again."""
        holder = self._holder
        if holder is not None and (holder.place != cell.place or holder.run == cell.run):
            return ""
        self._holder = cell
        text = asset("sharing.js").replace("VIEWER_NAME", viewer_name())
        return f"<script>{text.replace('VIEWER_CODE', bundle())}</script>"


#: That of this process, which is the kernel of one notebook.
NOTEBOOK = Notebook()


def viewer_name() -> str:
    """Return what frames ask for: notebooks may hold viewers of several versions."""
    return f"bspcsg-{sha256(bundle().encode()).hexdigest()[:12]}"


def running_cell() -> Cell | None:
    """Return the cell that is running, if this is a notebook whose cells are on one page."""
    shell = _shell()
    if shell is None or any(name in sys.modules for name in _APART):
        return None
    parent: Any = getattr(shell, "get_parent", dict)()
    told = parent if isinstance(parent, Mapping) else {}
    place, run = told.get("metadata", {}).get("cellId"), told.get("header", {}).get("msg_id")
    # Frontends that give cells no names are known by what is written in them.
    written = getattr(shell, "user_ns", {}).get("In") or [""]
    return Cell(str(place or written[-1]), str(run or getattr(shell, "execution_count", "")))


def is_notebook() -> bool:
    """Say whether this is the kernel of a notebook, which shows what it is given."""
    return _shell() is not None


def _shell() -> Any:
    """Return IPython's shell in a kernel; whoever runs one has imported it."""
    ipython: Any = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return shell if getattr(shell, "kernel", None) is not None else None
