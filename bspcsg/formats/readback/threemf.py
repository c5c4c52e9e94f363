"""A reader of 3MF files that this package has just written, to check their content."""

import zipfile
from collections.abc import Iterator
from typing import BinaryIO
from xml.etree import ElementTree

from .stored_mesh import StoredMesh, rows_of, whole_rows_of


def archive(file: BinaryIO) -> list[StoredMesh]:
    """Return the objects of a 3MF; raise a `ValueError` unless its build names each once."""
    with zipfile.ZipFile(file) as archive:
        parts = {name: _read(archive, name) for name in archive.namelist()}
    model = parts["3D/3dmodel.model"]
    found, at = list(_objects(model)), model.index(b"</resources>")
    items = b"".join(b'<item objectid="%d"/>\n' % (number + 1) for number in range(len(found)))
    end = b"</resources>\n<build>\n" + items + b"</build>\n</model>\n"
    if model[at:] != end:
        raise ValueError("its build section does not list each object exactly once")
    return found


def _read(archive: zipfile.ZipFile, name: str) -> bytes:
    """Return a part of an archive, its checksum verified.

    The part is read in chunks, so that signals can interrupt the reading.
    """
    with archive.open(name) as part:
        return b"".join(iter(lambda: part.read(_CHUNK_BYTES), b""))


#: The number of bytes that are unpacked at a time.
_CHUNK_BYTES = 1 << 20


def _objects(model: bytes) -> Iterator[StoredMesh]:
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
            raise ValueError(f"its object {number} has another number or type than the one written")
        vertices = rows_of(model[start + len(opening) : middle], _VERTEX)
        faces = whole_rows_of(model[middle + len(between) : end], _TRIANGLE)
        yield StoredMesh(vertices, faces, told.get("name", ""))
        at = end + len(closing)
    if not model.startswith(b"</resources>", at):
        raise ValueError(f"unexpected data follows its object {number}")


_VERTEX, _TRIANGLE = b'<vertex x="#" y="#" z="#"/>\n', b'<triangle v1="#" v2="#" v3="#"/>\n'
