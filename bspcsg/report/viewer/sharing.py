"""Views in the cells of a notebook, where one cell holds the viewer for all.

Each view is a frame with its own picture. Its page asks the enclosing page for the viewer, which
answers as soon as the cell with the viewer is present, also in a notebook that was saved and
reopened.
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
        The identity of the cell, which stays when the cell runs again.
    run : str
    """

    place: str
    run: str


class Notebook:
    """A notebook, with the cell that holds the viewer."""

    def __init__(self) -> None:
        self._holder: Cell | None = None

    def script(self, cell: Cell) -> str:
        """Return the viewer for all frames if this cell has to hold it, else nothing."""
        holder = self._holder
        if holder is not None and (holder.place != cell.place or holder.run == cell.run):
            return ""
        self._holder = cell
        text = asset("sharing.js").replace("VIEWER_NAME", viewer_name())
        return f"<script>{text.replace('VIEWER_CODE', bundle())}</script>"


#: That of this process, which is the kernel of one notebook.
NOTEBOOK = Notebook()


def viewer_name() -> str:
    """Return the name by which frames ask for the viewer; it differs between versions."""
    return f"bspcsg-{sha256(bundle().encode()).hexdigest()[:12]}"


def running_cell() -> Cell | None:
    """Return the running cell, if this is a notebook with all cells on one page."""
    shell = _shell()
    if shell is None or any(name in sys.modules for name in _APART):
        return None
    parent: Any = getattr(shell, "get_parent", dict)()
    told = parent if isinstance(parent, Mapping) else {}
    place, run = told.get("metadata", {}).get("cellId"), told.get("header", {}).get("msg_id")
    # If a frontend gives cells no names, the code of the cell identifies it.
    written = getattr(shell, "user_ns", {}).get("In") or [""]
    return Cell(str(place or written[-1]), str(run or getattr(shell, "execution_count", "")))


def is_notebook() -> bool:
    """Say whether this process is the kernel of a notebook, which displays output."""
    return _shell() is not None


def _shell() -> Any:
    """Return IPython's shell if this is a kernel; a kernel has imported IPython."""
    ipython: Any = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return shell if getattr(shell, "kernel", None) is not None else None
