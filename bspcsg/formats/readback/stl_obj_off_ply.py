"""Readers of STL, OBJ, OFF and PLY files that this package has just written, to check them."""

import io
import re
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from ..._core import are_triangles
from .stored_mesh import (
    Rows,
    StoredMesh,
    StoredRows,
    header_of,
    rest_after,
    rows_of,
    whole_rows_of,
)
from .text_rows import Lines, Reader


def binary_stl(file: BinaryIO) -> list[StoredMesh]:
    """Return the triangles of a binary STL; a length that does not fit their count is an error."""
    data = file.read()
    count = int.from_bytes(data[80:84], "little")
    if len(data) != 84 + 50 * count:
        raise ValueError(
            f"its length of {len(data)} bytes does not fit the {count} triangles of its header"
        )
    records = np.frombuffer(data, np.dtype("12<f4,<u2"), count, 84)["f0"]
    return [StoredMesh(records[:, 3:].reshape(-1, 3))]


def text_stl(file: BinaryIO) -> list[StoredMesh]:
    """Return the solids of a text STL, in file order."""
    data, found, at = file.read(), [], 0
    while at < len(data):
        head = data.index(b"\n", at) + 1
        name = rest_after(b"solid ", data[at : head - 1])
        end = data.index(b"endsolid ", head)
        at = data.index(b"\n", end) + 1
        if rest_after(b"endsolid ", data[end : at - 1]) != name:
            raise ValueError("the name after “endsolid” differs from the name after “solid”")
        rows = rows_of(data[head:end], _FACET)
        found.append(StoredMesh(rows[:, 3:].reshape(-1, 3), None, name))
    return found


_FACET = (
    b"facet normal # # #\n outer loop\n  vertex # # #\n  vertex # # #\n  vertex # # #\n"
    b" endloop\nendfacet\n"
)


def obj(file: BinaryIO) -> list[StoredMesh] | list[StoredRows]:
    """Return the objects of an OBJ; each has all vertices of the file."""
    data = file.read()
    start = data.index(b"\n") + 1 if data.startswith(b"#") else 0
    end = _first(data, start, b"fo")
    vertices = _lines(data, start, end, _points)
    found = []
    while end < len(data):
        start, name = end, ""
        if data.startswith(b"o ", start):
            start = data.index(b"\n", start) + 1
            name = rest_after(b"o ", data[end : start - 1])
        end = _first(data, start, b"o")
        found.append(StoredRows(vertices, _lines(data, start, end, _named_faces), name))
    if len(found) == 1:
        return found
    points = vertices.all_rows()
    return [StoredMesh(points, one.faces.all_rows(), one.name) for one in found]


def _lines(data: bytes, start: int, end: int, read: Reader) -> Lines:
    """Return the lines between two byte offsets; raise an error if the last has no line break."""
    if start < end and data[end - 1 : end] != b"\n":
        raise ValueError(f"its last line is incomplete, at byte {end}")
    return Lines(io.BytesIO(data), lambda: start, data.count(b"\n", start, end), read)


def _points(text: bytes) -> npt.NDArray[Any]:
    return rows_of(text, b"v # # #\n")


def _named_faces(text: bytes) -> npt.NDArray[Any]:
    return whole_rows_of(text, b"f # # #\n") - 1


def _first(data: bytes, start: int, letters: bytes) -> int:
    """Return the first offset from `start` of one of the letters; the end if there is none."""
    found = [data.find(letter, start) for letter in letters]
    return min((at for at in found if at >= 0), default=len(data))


def off(file: BinaryIO) -> list[StoredRows]:
    """Return the only object of an OFF file, a list of one."""
    head = re.match(rb"OFF\n(?:#[^\n]*\n)?(\d+) (\d+) 0\n", header_of(file))
    return [_table(file, head)]


def text_ply(file: BinaryIO) -> list[StoredRows]:
    """Return the only object of a text PLY, a list of one."""
    return [_table(file, _PLY.match(header_of(file)))]


_PLY = re.compile(
    rb"ply\nformat [a-z_]+ 1\.0\n(?:comment [^\n]*\n)?element vertex (\d+)\n"
    rb"property double x\nproperty double y\nproperty double z\n"
    rb"element face (\d+)\nproperty list uchar int vertex_indices\nend_header\n"
)


def binary_ply(file: BinaryIO) -> list[StoredRows]:
    """Return the only object of a binary PLY, a list of one."""
    head = _PLY.match(header_of(file))
    if head is None:
        raise ValueError("its header differs from the one written")
    vertices = Rows(file, head.end(), "3<f8", int(head[1]))
    faces = _Faces(file, vertices.end, "u1,3<i4", int(head[2]))
    return [_complete(StoredRows(vertices, faces, ends=True))]


class _Faces(Rows):
    """Triangles of a binary PLY: rows of three vertex indices, each after a byte of value three."""

    def block_equals(self, block: slice, expected: npt.NDArray[Any]) -> bool:
        return are_triangles(self.data(block), expected.astype(np.int64, copy=False))

    def numbers(self, block: slice) -> npt.NDArray[Any]:
        records = super().numbers(block)
        if not (records["f0"] == 3).all():
            raise ValueError("a face does not have three corners")
        corners: npt.NDArray[Any] = records["f1"]
        return corners


def _table(file: BinaryIO, head: re.Match[bytes] | None) -> StoredRows:
    """Return the vertices and faces in the lines after the header `head`, which counts them."""
    if head is None:
        raise ValueError("its header differs from the one written")
    vertices = Lines(file, head.end, int(head[1]), _bare_points)
    faces = Lines(file, vertices.end, int(head[2]), _counted_faces)
    return _complete(StoredRows(vertices, faces, ends=True))


def _bare_points(text: bytes) -> npt.NDArray[Any]:
    return rows_of(text, b"# # #\n")


def _counted_faces(text: bytes) -> npt.NDArray[Any]:
    return whole_rows_of(text, b"3 # # #\n")


def _complete(stored: StoredRows) -> StoredRows:
    """Return an object; if it has no faces, which are not compared later, read it in full now."""
    if not stored.count:
        stored.loaded()
    return stored
