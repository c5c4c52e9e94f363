"""The content of files of STL, OBJ, OFF and PLY."""

import re
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from ..._core import are_points, are_triangles, numbers_in
from .layout import (
    OF_NUMBERS,
    Held,
    HeldRows,
    Rows,
    after,
    check_layout,
    header_of,
    rows_of,
    whole_numbers,
)


def binary_stl(file: BinaryIO) -> list[Held]:
    """Return the triangles after the header and the count, which must be those that follow."""
    data = file.read()
    count = int.from_bytes(data[80:84], "little")
    if len(data) != 84 + 50 * count:
        raise ValueError(f"it has {len(data)} bytes, which are not {count} triangles")
    records = np.frombuffer(data, np.dtype("12<f4,<u2"), count, 84)["f0"]
    return [Held(records[:, 3:].reshape(-1, 3))]


def text_stl(file: BinaryIO) -> list[Held]:
    """Return the solids, one after another."""
    data, found, at = file.read(), [], 0
    while at < len(data):
        head = data.index(b"\n", at) + 1
        name = after(b"solid ", data[at : head - 1])
        end = data.index(b"endsolid ", head)
        at = data.index(b"\n", end) + 1
        if after(b"endsolid ", data[end : at - 1]) != name:
            raise ValueError("a solid ends by another name")
        rows = rows_of(data[head:end], _FACET, 12)
        found.append(Held(rows[:, 3:].reshape(-1, 3), None, name))
    return found


_FACET = (
    b"facet normal 0 0 0\n outer loop\n  vertex 0 0 0\n  vertex 0 0 0\n  vertex 0 0 0\n"
    b" endloop\nendfacet\n"
)


def obj(file: BinaryIO) -> list[Held]:
    """Return the objects; all have the same vertices."""
    data = file.read()
    if data.startswith(b"#"):
        data = data[data.index(b"\n") + 1 :]
    end = _first(data, 0)
    vertices = rows_of(data[:end], b"v 0 0 0\n", 3)
    found = []
    while end < len(data):
        start, name = end, ""
        if data.startswith(b"o ", start):
            start = data.index(b"\n", start) + 1
            name = after(b"o ", data[end : start - 1])
        stop = data.find(b"\no ", start - 1) + 1
        end = stop or len(data)
        faces = rows_of(data[start:end], b"f 0 0 0\n", 3) - 1
        found.append(Held(vertices, whole_numbers(faces), name))
    return found


def _first(data: bytes, start: int) -> int:
    """Return where the first line begins that is no vertex."""
    found = [data.find(key, start) + 1 for key in (b"\nf ", b"\no ")]
    if data.startswith((b"f ", b"o ")):
        return start
    return min(filter(None, found), default=len(data))


def off(file: BinaryIO) -> list[Held]:
    """Return the faces between the vertices."""
    data = file.read()
    head = re.match(rb"OFF\n(?:#[^\n]*\n)?(\d+) (\d+) 0\n", data)
    return [_table(data, head)]


def text_ply(file: BinaryIO) -> list[Held]:
    """Return the faces after the vertices."""
    data = file.read()
    return [_table(data, _PLY.match(data))]


_PLY = re.compile(
    rb"ply\nformat [a-z_]+ 1\.0\n(?:comment [^\n]*\n)?element vertex (\d+)\n"
    rb"property double x\nproperty double y\nproperty double z\n"
    rb"element face (\d+)\nproperty list uchar int vertex_indices\nend_header\n"
)


def binary_ply(file: BinaryIO) -> list[HeldRows]:
    """Return the records after the header."""
    head = _PLY.match(header_of(file))
    if head is None:
        raise ValueError("its header is another one")
    vertices = _Points(file, head.end(), "3<f8", int(head[1]))
    faces = _Faces(file, vertices.end, "u1,3<i4", int(head[2]))
    held = HeldRows(vertices, faces, end=faces.end)
    if not held.count:
        held.check_end()
    return [held]


class _Points(Rows):
    """Rows of three doubles."""

    def hold(self, block: slice, expected: npt.NDArray[Any]) -> bool:
        return are_points(self.data(block), expected)


class _Faces(Rows):
    """Rows of three corners, each after a byte that says three."""

    def hold(self, block: slice, expected: npt.NDArray[Any]) -> bool:
        return are_triangles(self.data(block), expected.astype(np.int64, copy=False))

    def numbers(self, block: slice) -> npt.NDArray[Any]:
        records = super().numbers(block)
        if not (records["f0"] == 3).all():
            raise ValueError("a face has not three corners")
        corners: npt.NDArray[Any] = records["f1"]
        return corners


def _table(data: bytes, head: re.Match[bytes] | None) -> Held:
    """Return the vertices and faces that follow a header that counts them."""
    if head is None:
        raise ValueError("its header is another one")
    points, count = int(head[1]), int(head[2])
    body = data[head.end() :]
    expected = b"  \n" * points + b"   \n" * count
    check_layout(body.translate(None, OF_NUMBERS), expected)
    numbers = numbers_in(body)
    rows = numbers[3 * points :].reshape(count, 4)
    if not (rows[:, 0] == 3).all():
        raise ValueError("a face has not three corners")
    return Held(numbers[: 3 * points].reshape(points, 3), whole_numbers(rows[:, 1:]))
