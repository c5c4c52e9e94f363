"""The content of grids of VTK and VTU."""

import re
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import vtk
from ..source import Source
from .layout import Held

_HEAD = re.compile(
    rb"# vtk DataFile Version 5\.1\nwritten by [^\n]*\nBINARY\n"
    rb"DATASET UNSTRUCTURED_GRID\nPOINTS (\d+) double\n"
)
_CELLS = re.compile(rb"\nCELLS (\d+) (\d+)\nOFFSETS vtktypeint64\n")

#: VTK's number of triangles.
_TRIANGLE = 5


def legacy(data: bytes) -> list[Held]:
    """Return the triangles of a VTK file, whose blocks hold big-endian numbers."""
    if data == vtk.EMPTY[".vtk"]:
        return []
    head = _HEAD.match(data)
    if head is None:
        raise ValueError("its header is another one")
    vertices, at = _block(data, head.end(), ">f8", 3 * int(head[1]))
    cells = _CELLS.match(data, at)
    if cells is None:
        raise ValueError("something else follows its points")
    count = int(cells[1]) - 1
    offsets, at = _block(data, cells.end(), ">i8", count + 1)
    at = _behind(b"\nCONNECTIVITY vtktypeint64\n", data, at)
    corners, at = _block(data, at, ">i8", int(cells[2]))
    kinds, at = _block(data, _behind(b"\nCELL_TYPES %d\n" % count, data, at), ">i4", count)
    if data[at:] != b"\n" or len(corners) != 3 * count:
        raise ValueError(f"its {count} cells are not all it holds")
    if (offsets != np.arange(0, 3 * count + 1, 3)).any() or (kinds != _TRIANGLE).any():
        raise ValueError("a cell is no triangle")
    return [Held(vertices.reshape(-1, 3), corners.reshape(-1, 3))]


def _block(data: bytes, at: int, kind: str, count: int) -> tuple[npt.NDArray[Any], int]:
    """Return so many numbers, and where the bytes go on behind them."""
    numbers = np.frombuffer(data, kind, count, at)
    return numbers, at + numbers.nbytes


def _behind(key: bytes, data: bytes, at: int) -> int:
    if not data.startswith(key, at):
        raise ValueError(f"“{key.decode().strip()}” is not where it should be")
    return at + len(key)


def xml(data: bytes) -> list[Held]:
    """Return the triangles of a VTU file, as meshio reads it."""
    if data == vtk.EMPTY[".vtu"]:
        return []
    found = vtk.grid_of(Source("file", data), ".vtu")
    kinds = [block.type for block in found.cells]
    if kinds != ["triangle"]:
        raise ValueError(f"its cells are {kinds}")
    return [Held(np.asarray(found.points), np.asarray(found.cells[0].data))]
