"""Sharing of the viewer's code among the 3D views in a notebook: one cell contains it for all.

Each view is a frame with its own picture. The frame asks the enclosing page for the viewer, which
answers as soon as the cell with the viewer is present, also in a notebook that was saved and
reopened.
"""

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from hashlib import sha256
from typing import Any

from ..assets import asset, bundle

#: Modules of notebook programs that show each output in a page of its own, so that outputs cannot
#: share code.
_APART = ("google.colab",)


@dataclass(frozen=True)
class Cell:
    """One run of a cell in a notebook.

    Parameters
    ----------
    place : str
        The identity of the cell, which is the same when the cell runs again.
    run : str
        The identity of the run.
    """

    place: str
    run: str


class Notebook:
    """A notebook, and the cell that contains the viewer's code."""

    def __init__(self) -> None:
        self._holder: Cell | None = None

    def script(self, cell: Cell) -> str:
        """Return the viewer's code if this cell has to contain it, else an empty string.

        The first cell with a view contains it, and so does a new run of that cell.
        """
        holder = self._holder
        if holder is not None and (holder.place != cell.place or holder.run == cell.run):
            return ""
        self._holder = cell
        text = asset("sharing.js").replace("VIEWER_NAME", viewer_name())
        return f"<script>{text.replace('VIEWER_CODE', bundle())}</script>"


#: The notebook of this process, which is the kernel of one notebook.
NOTEBOOK = Notebook()


def viewer_name() -> str:
    """Return the name by which frames ask for the viewer; it depends on the viewer's code."""
    return f"bspcsg-{sha256(bundle().encode()).hexdigest()[:12]}"


def running_cell() -> Cell | None:
    """Return the running cell of a notebook that shows all cells in one page, else None."""
    shell = _shell()
    if shell is None or any(name in sys.modules for name in _APART):
        return None
    parent: Any = getattr(shell, "get_parent", dict)()
    told = parent if isinstance(parent, Mapping) else {}
    place, run = told.get("metadata", {}).get("cellId"), told.get("header", {}).get("msg_id")
    # If the notebook program gives cells no ids, the code of the cell identifies it.
    written = getattr(shell, "user_ns", {}).get("In") or [""]
    return Cell(str(place or written[-1]), str(run or getattr(shell, "execution_count", "")))


def is_notebook() -> bool:
    """Say whether this process is the kernel of a notebook."""
    return _shell() is not None


def _shell() -> Any:
    """Return IPython's shell if this process is the kernel of a notebook, else None."""
    ipython: Any = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    return shell if getattr(shell, "kernel", None) is not None else None
