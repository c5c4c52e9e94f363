"""Reading and writing VTK's legacy and XML files through meshio (the extra ``bspcsg[vtk]``).

meshio reads and writes files by name, so the bytes go through a temporary folder.
"""

import contextlib
import sys
import tempfile
import threading
import warnings
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TextIO, cast

import numpy as np

from ..errors import Finding, FormatError, message_of, missing_part
from ..mesh.mesh import Mesh
from .raw import IndexPolygons, RawMesh, represents_empty_set
from .source import Source

#: Types of cells that are faces, and types of cells that are skipped.
_FACES = ("triangle", "quad", "polygon")
_OTHER = ("vertex", "line")

#: The largest number of bytes that the compressed data of a file may unpack to.
_MAX_UNPACKED_BYTES = 1 << 31

#: The number of bytes in a chunk of a written file: they stay in the processor's cache.
_CHUNK_BYTES = 1 << 17

#: The content of files for the empty set, which meshio neither writes nor reads.
EMPTY = {
    ".vtk": (
        b"# vtk DataFile Version 3.0\nbspcsg\nASCII\nDATASET UNSTRUCTURED_GRID\n"
        b"POINTS 0 double\nCELLS 0 0\nCELL_TYPES 0\n"
    ),
    ".vtu": (
        b'<?xml version="1.0"?>\n'
        b'<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">\n'
        b"<UnstructuredGrid>\n"
        b'<Piece NumberOfPoints="0" NumberOfCells="0">\n'
        b'<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii"/></Points>\n'
        b'<Cells><DataArray type="Int64" Name="connectivity" format="ascii"/>'
        b'<DataArray type="Int64" Name="offsets" format="ascii"/>'
        b'<DataArray type="UInt8" Name="types" format="ascii"/></Cells>\n'
        b"</Piece>\n</UnstructuredGrid>\n</VTKFile>\n"
    ),
}


def reader(suffix: str) -> Callable[[Source], RawMesh]:
    """Return the reader for ``.vtk`` or ``.vtu``."""

    def read(source: Source) -> RawMesh:
        return _surface(source, _grid_of(source, suffix))

    return read


def writer(suffix: str) -> Callable[[Mesh | RawMesh], Iterator[bytes]]:
    """Return the binary writer for ``.vtk`` or ``.vtu``; coordinates read back unchanged."""

    def write(mesh: Mesh | RawMesh) -> Iterator[bytes]:
        return _write(mesh, suffix)

    return write


def _meshio() -> Any:
    try:
        import meshio
    except ImportError as error:
        raise missing_part("meshio", "for VTK files", 'pip install "bspcsg[vtk]"') from error
    return meshio


def _grid_of(source: Source, suffix: str) -> Any:
    """Return the `meshio.Mesh` of a file; limit the number of bytes that it unpacks to.

    Raises
    ------
    FormatError
        If meshio cannot read the file.
    """
    meshio = _meshio()
    if b"<!DOCTYPE" in source.data or b"<!ENTITY" in source.data:
        raise source.error(
            "the XML has a document type or entity declaration, which is not supported; save it"
            " without."
        )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"mesh{suffix}"
        path.write_bytes(source.data)
        try:
            with (
                _PATCH_LOCK,
                contextlib.redirect_stdout(cast(TextIO, _OtherThreadsStream(sys.stdout))),
                contextlib.redirect_stderr(cast(TextIO, _OtherThreadsStream(sys.stderr))),
                _bounded(_MAX_UNPACKED_BYTES),
                np.errstate(all="ignore"),
                warnings.catch_warnings(action="ignore"),
            ):
                return meshio.read(path)
        except (Exception, SystemExit) as error:  # of any type: meshio itself checks little
            reason = f"{type(error).__name__}: {message_of(error)}"
            reason = reason.replace(str(path), source.name)
            raise source.error(f"meshio cannot read this file ({reason}).") from error


#: Locked while `sys.stdout`, `sys.stderr` and modules in meshio are replaced, for all threads.
_PATCH_LOCK = threading.Lock()


class _OtherThreadsStream:
    """A stream that drops the output of the thread that created it, and passes on all other."""

    def __init__(self, stream: TextIO | None) -> None:
        self._stream, self._thread = stream, threading.get_ident()

    def write(self, text: str) -> int:
        """Write a text to the stream, unless the thread that created this object calls."""
        if self._stream is None or threading.get_ident() == self._thread:
            return len(text)
        return self._stream.write(text)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


class _Unpacker:
    """A replacement of zlib in meshio that limits the total number of unpacked bytes."""

    def __init__(self, largest: int) -> None:
        self._largest = self._left = largest

    def decompress(self, data: bytes) -> bytes:
        """Return the unpacked bytes; raise a `MemoryError` if all calls together exceed a limit."""
        found = zlib.decompressobj().decompress(data, self._left)
        self._left -= len(found)
        if self._left <= 0:
            raise MemoryError(
                f"its compressed data unpack to more than the limit of {self._largest >> 20} MB"
            )
        return found


class _Refuser:
    """A replacement of lzma in meshio that refuses all data, as their length is not limited."""

    @staticmethod
    def decompress(data: bytes) -> bytes:
        """Raise a `ValueError`: data packed by LZMA are not read."""
        raise ValueError("LZMA compression is not supported; save the file with zlib compression")


@contextlib.contextmanager
def _bounded(largest: int) -> Iterator[None]:
    """Limit the number of bytes that meshio unpacks inside a `with` block."""
    from meshio.vtu import _vtu

    kept = _vtu.zlib, _vtu.lzma
    _vtu.zlib, _vtu.lzma = _Unpacker(largest), _Refuser()
    try:
        yield
    finally:
        _vtu.zlib, _vtu.lzma = kept


def _surface(source: Source, grid: Any) -> RawMesh:
    vertices = np.asarray(grid.points, dtype=np.float64)
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise source.error("the points do not have 3 coordinates each.")
    if not np.isfinite(vertices).all():
        raise source.error("a coordinate is not a finite number.", "non_finite")
    unknown = sorted({block.type for block in grid.cells} - {*_FACES, *_OTHER})
    if unknown:
        message = (
            f"cells of type {', '.join(unknown)} are not faces; extract the surface of the grid"
            " first."
        )
        raise source.error(message, "unsupported")
    polygons = [
        [int(corner) for corner in face]
        for block in grid.cells
        if block.type in _FACES
        for face in block.data
    ]
    flat = IndexPolygons.from_lists(polygons)
    faces = flat.triangles(
        vertices, lambda k, message, code: source.error(f"cell {k}: {message}", code)
    )
    ignored = sum(len(block.data) for block in grid.cells if block.type in _OTHER)
    data = [f"data “{name}”" for name in (*grid.point_data, *grid.cell_data)]
    return RawMesh(vertices, faces, "", _ignored(ignored), dropped=(*data, *flat.dropped))


def _ignored(count: int) -> tuple[Finding, ...]:
    if not count:
        return ()
    message = f"{count} point and line cells were ignored."
    return (Finding("ignored", "warning", message, (), count),)


def _write(mesh: Mesh | RawMesh, suffix: str) -> Iterator[bytes]:
    if represents_empty_set(mesh):
        yield EMPTY[suffix]
        return
    if len(mesh.faces) == 0:
        raise FormatError(
            f"The mesh has no faces, so it cannot be written as {suffix}.", "unwritable"
        )
    meshio = _meshio()
    grid = meshio.Mesh(np.array(mesh.vertices), [("triangle", np.array(mesh.faces))])
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"mesh{suffix}"
        with _PATCH_LOCK:
            grid.write(path, binary=True)
        with path.open("rb", buffering=0) as written:
            while piece := written.read(_CHUNK_BYTES):
                yield piece
