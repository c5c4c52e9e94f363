"""Readers of VTK and VTU files that this package has just written, to check their content."""

import re
import zlib
from binascii import a2b_base64
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from .. import vtk
from ..blocks import ROWS_PER_FILE_BLOCK, blocks
from .stored_mesh import Rows, StoredMesh, StoredRows, header_of, read_exactly, size_of, text_at

_HEAD = re.compile(
    rb"# vtk DataFile Version 5\.1\nwritten by [^\n]*\nBINARY\n"
    rb"DATASET UNSTRUCTURED_GRID\nPOINTS (\d+) double\n"
)
_CELLS = re.compile(rb"\nCELLS (\d+) (\d+)\nOFFSETS vtktypeint64\n")

#: VTK's number for cells that are triangles.
_TRIANGLE = 5
_KIND = _TRIANGLE.to_bytes(4, "big")


def legacy(file: BinaryIO) -> list[StoredRows]:
    """Return the triangles of a VTK file, as one object; an empty list for the empty set."""
    start = header_of(file)
    if start == vtk.EMPTY[".vtk"]:
        return []
    head = _HEAD.match(start)
    if head is None:
        raise ValueError("its header differs from the one written")
    vertices = Rows(file, head.end(), "3>f8", int(head[1]))
    cells = _CELLS.match(text_at(file, vertices.end))
    if cells is None:
        raise ValueError("unexpected data follows its points")
    count = int(cells[1]) - 1
    offsets = Rows(file, vertices.end + cells.end(), ">i8", count + 1)
    at = _behind(b"\nCONNECTIVITY vtktypeint64\n", file, offsets.end)
    faces = Rows(file, at, "3>i8", count)
    kinds = Rows(file, _behind(b"\nCELL_TYPES %d\n" % count, file, faces.end), ">i4", count)
    if _behind(b"\n", file, kinds.end) != size_of(file) or int(cells[2]) != 3 * count:
        raise ValueError(f"there is data after its {count} cells, or their size is wrong")
    _check_triangles(offsets, kinds)
    return [StoredRows(vertices, faces)]


def _behind(key: bytes, file: BinaryIO, at: int) -> int:
    if read_exactly(file, at, len(key)) != key:
        raise ValueError(f"the keyword “{key.decode().strip()}” is missing at byte {at}")
    return at + len(key)


def _check_triangles(offsets: Rows, kinds: Rows) -> None:
    """Raise a `ValueError` unless all cells are triangles, cell k at offset 3 k."""
    for block in blocks(len(offsets), ROWS_PER_FILE_BLOCK):
        rows = np.arange(*block.indices(len(offsets)), dtype=np.int64)
        if not offsets.block_equals(block, 3 * rows[:, None]):
            raise ValueError("a cell does not have three corners")
    for block in blocks(len(kinds), ROWS_PER_FILE_BLOCK):
        data = kinds.data(block)
        if data != _KIND * (len(data) // len(_KIND)):
            raise ValueError("a cell is not a triangle")


_GRID = re.compile(
    rb'<\?xml version="1\.0"\?>\n<VTKFile type="UnstructuredGrid" version="0\.1"'
    rb' byte_order="(Little|Big)Endian" compressor="vtkZLibDataCompressor">\n<!--[^>]*-->\n'
    rb'<UnstructuredGrid>\n<Piece NumberOfPoints="(\d+)" NumberOfCells="(\d+)">\n<Points>\n'
)

#: The lines before each array of a VTU file, and the numpy type of the array's numbers.
_ARRAYS = (
    (b'<DataArray type="Float64" Name="Points" NumberOfComponents="3" format="binary">\n', "f8"),
    (b'</Points>\n<Cells>\n<DataArray type="Int64" Name="connectivity" format="binary">\n', "i8"),
    (b'<DataArray type="Int64" Name="offsets" format="binary">\n', "i8"),
    (b'<DataArray type="Int64" Name="types" format="binary">\n', "i8"),
)
_END_OF_ARRAY = b"\n</DataArray>\n"
_END = b"</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"


def xml(file: BinaryIO) -> list[StoredMesh]:
    """Return the triangles of a VTU file, as one object; an empty list for the empty set."""
    data = file.read()
    if data == vtk.EMPTY[".vtu"]:
        return []
    grid = _GRID.match(data)
    if grid is None:
        raise ValueError("its header differs from the one written")
    points, count = int(grid[2]), int(grid[3])
    arrays = _arrays(file, data, grid.end(), "<" if grid[1] == b"Little" else ">")
    vertices, faces, offsets, kinds = arrays
    if [len(vertices), len(faces), len(kinds)] != [3 * points, 3 * count, count]:
        raise ValueError("its arrays do not have the lengths that its header says")
    if not np.array_equal(offsets, np.arange(3, 3 * count + 1, 3)):
        raise ValueError("a cell does not have three corners")
    if (kinds != _TRIANGLE).any():
        raise ValueError("a cell is not a triangle")
    return [StoredMesh(vertices.reshape(-1, 3), faces.reshape(-1, 3))]


def _arrays(file: BinaryIO, data: bytes, at: int, order: str) -> list[npt.NDArray[Any]]:
    """Return the arrays of a VTU file from byte `at`; `order` is “<” or “>”, the byte order.

    Raise a `ValueError` if other data follow the arrays.
    """
    found = []
    for line, kind in _ARRAYS:
        start = _behind(line, file, at)
        end = data.index(_END_OF_ARRAY, start)
        found.append(np.frombuffer(_unpacked(data[start:end], order), order + kind))
        at = end + len(_END_OF_ARRAY)
    if _behind(_END, file, at) != len(data):
        raise ValueError("there is data after the end of its arrays")
    return found


def _unpacked(text: bytes, order: str) -> bytes:
    """Return the bytes of an array from base64: a table of lengths, then blocks packed by zlib."""
    end = _letters(_WORD)
    count = int(np.frombuffer(_bytes(text[:end])[:_WORD], order + "u4")[0])
    end = _letters(_WORD * (3 + count))
    size, last, *lengths = np.frombuffer(_bytes(text[:end]), order + "u4")[1:].tolist()
    packed, at, pieces = _bytes(text[end:]), 0, []
    for length in lengths:
        pieces.append(zlib.decompress(packed[at : at + length]))
        at += length
    if at != len(packed) or [len(one) for one in pieces] != [*[size] * (count - 1), last]:
        raise ValueError(
            "the compressed blocks of an array do not have the lengths that its header says"
        )
    return b"".join(pieces)


def _bytes(text: bytes) -> bytes:
    return a2b_base64(text, strict_mode=True)


#: The number of bytes of one entry in an array's table of lengths.
_WORD = 4


def _letters(count: int) -> int:
    """Return the number of base64 letters that encode `count` bytes."""
    return -(-count // 3) * 4
