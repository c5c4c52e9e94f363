"""What a written file holds, read by its layout alone: arrays, object by object.

These are no readers: they take the very layout that the writers of this package make, byte for
byte, and nothing else. They share no code with the writers, and every byte that tells of a triangle
is read.
"""

import io
import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt

from .._core import numbers_in
from .._types import IndexArray
from . import vtk
from .glb.container import container_of
from .glb.file import TO_METRES
from .glb.nodes import shown
from .source import Source


@dataclass(frozen=True, eq=False)
class Held:
    """One object as it stands in a file.

    Parameters
    ----------
    vertices : (n, 3) float32 or float64
        In the precision of the file.
    faces : (m, 3) int, optional
        Indices of `vertices`; where there are none, three vertices after another are a triangle.
    name : str
    """

    vertices: npt.NDArray[Any]
    faces: IndexArray | None = None
    name: str = ""

    @property
    def count(self) -> int:
        """Number of triangles."""
        return len(self.vertices) // 3 if self.faces is None else len(self.faces)


def binary_stl(data: bytes) -> list[Held]:
    """Return the triangles after the header and the count, which must be those that follow."""
    count = int.from_bytes(data[80:84], "little")
    if len(data) != 84 + 50 * count:
        raise ValueError(f"it has {len(data)} bytes, which are not {count} triangles")
    records = np.frombuffer(data, np.dtype("12<f4,<u2"), count, 84)["f0"]
    return [Held(records[:, 3:].reshape(-1, 3))]


def text_stl(data: bytes) -> list[Held]:
    """Return the solids, one after another."""
    found, at = [], 0
    while at < len(data):
        head = data.index(b"\n", at) + 1
        name = _after(b"solid ", data[at : head - 1])
        end = data.index(b"endsolid ", head)
        at = data.index(b"\n", end) + 1
        if _after(b"endsolid ", data[end : at - 1]) != name:
            raise ValueError("a solid ends by another name")
        rows = _rows(data[head:end], _FACET, 12)
        found.append(Held(rows[:, 3:].reshape(-1, 3), None, name))
    return found


_FACET = (
    b"facet normal 0 0 0\n outer loop\n  vertex 0 0 0\n  vertex 0 0 0\n  vertex 0 0 0\n"
    b" endloop\nendfacet\n"
)


def obj(data: bytes) -> list[Held]:
    """Return the objects; all have the same vertices."""
    if data.startswith(b"#"):
        data = data[data.index(b"\n") + 1 :]
    end = _first(data, 0)
    vertices = _rows(data[:end], b"v 0 0 0\n", 3)
    found = []
    while end < len(data):
        start, name = end, ""
        if data.startswith(b"o ", start):
            start = data.index(b"\n", start) + 1
            name = _after(b"o ", data[end : start - 1])
        stop = data.find(b"\no ", start - 1) + 1
        end = stop or len(data)
        faces = _rows(data[start:end], b"f 0 0 0\n", 3) - 1
        found.append(Held(vertices, _indices(faces), name))
    return found


def _first(data: bytes, start: int) -> int:
    """Return where the first line begins that is no vertex."""
    found = [data.find(key, start) + 1 for key in (b"\nf ", b"\no ")]
    if data.startswith((b"f ", b"o ")):
        return start
    return min(filter(None, found), default=len(data))


def off(data: bytes) -> list[Held]:
    """Return the faces between the vertices."""
    head = re.match(rb"OFF\n(?:#[^\n]*\n)?(\d+) (\d+) 0\n", data)
    return [_table(data, head)]


def text_ply(data: bytes) -> list[Held]:
    """Return the faces after the vertices."""
    return [_table(data, _PLY.match(data))]


_PLY = re.compile(
    rb"ply\nformat [a-z_]+ 1\.0\n(?:comment [^\n]*\n)?element vertex (\d+)\n"
    rb"property double x\nproperty double y\nproperty double z\n"
    rb"element face (\d+)\nproperty list uchar int vertex_indices\nend_header\n"
)


def binary_ply(data: bytes) -> list[Held]:
    """Return the records after the header."""
    head = _PLY.match(data)
    if head is None:
        raise ValueError("its header is another one")
    points, count = int(head[1]), int(head[2])
    if len(data) != head.end() + 24 * points + 13 * count:
        raise ValueError(f"it has {len(data)} bytes, which are not as many as its header says")
    vertices = np.frombuffer(data, "<f8", 3 * points, head.end()).reshape(-1, 3)
    records = np.frombuffer(data, np.dtype("u1,3<i4"), count, head.end() + 24 * points)
    if not (records["f0"] == 3).all():
        raise ValueError("a face has not three corners")
    return [Held(vertices, records["f1"])]


def _table(data: bytes, head: re.Match[bytes] | None) -> Held:
    """Return the vertices and faces that follow a header that counts them."""
    if head is None:
        raise ValueError("its header is another one")
    points, count = int(head[1]), int(head[2])
    body = data[head.end() :]
    expected = b"  \n" * points + b"   \n" * count
    _check_layout(body.translate(None, _OF_NUMBERS), expected)
    numbers = numbers_in(body)
    rows = numbers[3 * points :].reshape(count, 4)
    if not (rows[:, 0] == 3).all():
        raise ValueError("a face has not three corners")
    return Held(numbers[: 3 * points].reshape(points, 3), _indices(rows[:, 1:]))


def archive_3mf(data: bytes) -> list[Held]:
    """Return the objects of the model in the archive, each of which is built once."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if (damaged := archive.testzip()) is not None:
            raise ValueError(f"its part {damaged} is damaged")
        model = archive.read("3D/3dmodel.model")
    found, at = list(_objects(model)), model.index(b"</resources>")
    items = b"".join(b'<item objectid="%d"/>\n' % (number + 1) for number in range(len(found)))
    end = b"</resources>\n<build>\n" + items + b"</build>\n</model>\n"
    if model[at:] != end:
        raise ValueError("its build does not name each object once")
    return found


def _objects(model: bytes) -> Iterator[Held]:
    opening, between, closing = (
        b"<mesh><vertices>\n",
        b"</vertices><triangles>\n",
        b"</triangles></mesh></object>\n",
    )
    at, number = model.index(b"<resources>\n") + len(b"<resources>\n"), 0
    while model.startswith(b"<object ", at):
        number += 1
        start = model.index(opening, at)
        middle = model.index(between, start)
        end = model.index(closing, middle)
        told = ElementTree.fromstring(model[at:start] + b"</object>").attrib
        if told.get("id") != str(number) or told.get("type") != "model":
            raise ValueError(f"its object {number} is another one")
        vertices = _rows(model[start + len(opening) : middle], _VERTEX, 3)
        faces = _rows(model[middle + len(between) : end], _TRIANGLE, 3)
        yield Held(vertices, _indices(faces), told.get("name", ""))
        at = end + len(closing)
    if not model.startswith(b"</resources>", at):
        raise ValueError(f"something else follows its object {number}")


_VERTEX, _TRIANGLE = b'<vertex x="0" y="0" z="0"/>\n', b'<triangle v1="0" v2="0" v3="0"/>\n'


def glb(data: bytes) -> list[Held]:
    """Return what the nodes show, in metres each."""
    objects, hidden = shown(container_of(Source("file", data)))
    if hidden or any((one.matrix != TO_METRES).any() for one in objects):
        raise ValueError("a node is not where it should be")
    return [Held(one.vertices, one.faces, one.name) for one in objects]


def vtk_grid(suffix: str, data: bytes) -> list[Held]:
    """Return the triangles of a grid, as meshio reads it."""
    if data == vtk.EMPTY[suffix]:
        return []
    grid = vtk.grid_of(Source("file", data), suffix)
    kinds = [block.type for block in grid.cells]
    if kinds != ["triangle"]:
        raise ValueError(f"its cells are {kinds}")
    return [Held(np.asarray(grid.points), np.asarray(grid.cells[0].data))]


def _after(key: bytes, line: bytes) -> str:
    if not line.startswith(key):
        raise ValueError(f"a line does not begin with “{key.decode()}”")
    return line[len(key) :].decode("utf-8")


def _indices(rows: npt.NDArray[np.float64]) -> IndexArray:
    """Return whole numbers of doubles; others become what no file may hold."""
    indices: IndexArray = rows.astype(np.int64)
    return np.where(indices == rows, indices, -1)


def _rows(block: bytes, row: bytes, width: int) -> npt.NDArray[np.float64]:
    """Return the numbers of a block that is one layout of lines again and again."""
    layout, unit = block.translate(None, _OF_NUMBERS), row.translate(None, _OF_NUMBERS)
    count = len(layout) // len(unit)
    _check_layout(layout, unit * count)
    return numbers_in(block).reshape(count, width)


#: Bytes that may belong to a number.
_OF_NUMBERS = b"0123456789+-.eE"


def _check_layout(found: bytes, expected: bytes) -> None:
    """Refuse a block whose bytes between the numbers are others."""
    if found != expected:
        raise ValueError("its lines are not what they should be")
