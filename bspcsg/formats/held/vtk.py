"""What grids of VTK and VTU hold."""

import numpy as np

from .. import vtk
from ..source import Source
from .layout import Held


def grid(suffix: str, data: bytes) -> list[Held]:
    """Return the triangles of a grid, as meshio reads it."""
    if data == vtk.EMPTY[suffix]:
        return []
    found = vtk.grid_of(Source("file", data), suffix)
    kinds = [block.type for block in found.cells]
    if kinds != ["triangle"]:
        raise ValueError(f"its cells are {kinds}")
    return [Held(np.asarray(found.points), np.asarray(found.cells[0].data))]
