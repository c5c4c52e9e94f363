"""The check that a written file equals the mesh, in each corner of each triangle of each object.

Corners must be equal after one rounding of each coordinate to the file's precision. Then counts,
bounds and volumes are equal too, so no tolerance is needed.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, BinaryIO, TypeAlias

import numpy as np
import numpy.typing as npt

from .._types import IndexArray
from ..errors import FormatError, message_of
from ..mesh.mesh import Mesh
from .blocks import blocks
from .raw import RawMesh, parts_of
from .readback.stored_mesh import StoredMesh, StoredRows

#: A function that returns the objects of a file; raises any exception if the file is not valid.
ObjectReader: TypeAlias = Callable[[BinaryIO], Sequence[StoredMesh | StoredRows]]

#: A function that returns the name that a file has for an object of a given name.
NameInFile: TypeAlias = Callable[[str], str]


def verify(
    path: str,
    mesh: Mesh | RawMesh,
    scan: ObjectReader,
    name_in_file: NameInFile | None,
    repeats: bool,
    file: BinaryIO,
) -> None:
    """Raise an error unless the content of a written file equals the mesh.

    Parameters
    ----------
    path : str
        For the message.
    mesh : Mesh or RawMesh
        The mesh that was written.
    scan : callable
        Returns the objects of the file.
    name_in_file : callable, optional
        Returns the name that the file has for an object; None if the format has no objects.
    repeats : bool
        True if the format can store triangles that name a vertex twice.
    file : binary file
        The file, at its beginning.

    Raises
    ------
    FormatError
        If the content differs; code ``"write_mismatch"``. If the number of triangles is right, the
        attribute `where` has the number of the first triangle that differs.
    """
    with _readback_errors(path):
        stored = [one for one in scan(file) if one.count]
    expected = _expected_objects(mesh, name_in_file, repeats)
    _compare_counts(path, expected, stored)
    with _readback_errors(path):
        rounded = _rounded(mesh, stored)
        # The fastest comparison: a file with one object may have exactly the arrays of the mesh.
        if len(stored) == 1 and stored[0].has(rounded, expected[0][1]):
            return
        loaded = [one.loaded() for one in stored]
    _compare_corners(path, rounded, expected, loaded)


@contextmanager
def _readback_errors(path: str) -> Iterator[None]:
    """Replace any exception of the block by a `FormatError`: the file cannot be read back."""
    try:
        yield
    except MemoryError:
        raise
    except Exception as error:
        raise _mismatch(path, f"the file cannot be read back ({message_of(error)})") from error


def verify_with_attributes(
    path: str,
    mesh: RawMesh,
    read: Callable[[str, bytes], RawMesh],
    name_in_file: NameInFile | None,
    repeats: bool,
    file: BinaryIO,
) -> None:
    """Raise an error unless a written file has the triangles and the attributes of the mesh.

    Files with attributes have various layouts, so the normal readers are used, which share no code
    with the writers.

    Parameters
    ----------
    path : str
    mesh : RawMesh
        The mesh that was written.
    read : callable
        Returns the mesh that the bytes of a file contain.
    called, repeats, file
        As for `verify`.

    Raises
    ------
    FormatError
        If the content differs; code ``"write_mismatch"``.
    """
    with _readback_errors(path):
        found = read(path, file.read())
    vertices = found.vertices
    if np.array_equal(vertices, vertices.astype(np.float32)):
        vertices = vertices.astype(np.float32)
    named = [("", found.faces)] if name_in_file is None else parts_of(found)
    stored = [StoredMesh(vertices, faces, name) for name, faces in named if len(faces)]
    expected = _expected_objects(mesh, name_in_file, repeats)
    _compare_counts(path, expected, stored)
    _compare_corners(path, _rounded(mesh, stored), expected, stored)
    rows = np.arange(len(mesh.faces)) if repeats else np.flatnonzero(_three_corners(mesh.faces))
    _compare_attributes(path, mesh, found, rows)


def _compare_attributes(path: str, mesh: RawMesh, found: RawMesh, rows: IndexArray) -> None:
    for name in () if mesh.attributes is None else mesh.attributes.names:
        if found.attributes is None or found.attributes.kind_of(name) is None:
            raise _mismatch(path, f"the file lacks the attribute “{name}”")
        expected = mesh.attributes.at_corners(name, rows) if mesh.attributes else None
        told = found.attributes.at_corners(name)
        if expected is None or not _are_same(expected, told):
            raise _mismatch(path, f"the file has other values of the attribute “{name}”")
    meant_materials = {} if mesh.attributes is None else mesh.attributes.materials
    told_materials = {} if found.attributes is None else found.attributes.materials
    if any(told_materials.get(name) != one for name, one in meant_materials.items()):
        raise _mismatch(path, "the file has other materials")


def _are_same(one: npt.NDArray[Any], other: npt.NDArray[Any]) -> bool:
    if one.dtype.kind == "U" and other.dtype.kind == "U":
        return np.array_equal(one, other)
    return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=one.dtype.kind == "f")


def _mismatch(path: str, reason: str, where: tuple[int, ...] = ()) -> FormatError:
    message = (
        f"{path}: the written file differs from the mesh and was discarded: {reason}."
        " The disk may be at fault; if it happens again, please report it."
    )
    return FormatError(message, "write_mismatch", where)


def _expected_objects(
    mesh: Mesh | RawMesh, name_in_file: NameInFile | None, repeats: bool
) -> list[tuple[str, IndexArray]]:
    """Return name and triangles of each object that the written file must contain."""
    parts = [("", mesh.faces)] if name_in_file is None else parts_of(mesh)
    if name_in_file is not None:
        parts = [(name_in_file(name), faces) for name, faces in parts]
    if not repeats:
        parts = [(name, faces[_three_corners(faces)]) for name, faces in parts]
    return [(name, faces) for name, faces in parts if len(faces)]


def _three_corners(faces: IndexArray) -> npt.NDArray[np.bool_]:
    a, b, c = faces.T
    different: npt.NDArray[np.bool_] = (a != b) & (b != c) & (c != a)
    return different


def _compare_counts(
    path: str, expected: list[tuple[str, IndexArray]], stored: Sequence[StoredMesh | StoredRows]
) -> None:
    if len(expected) != len(stored):
        raise _mismatch(path, f"the file contains {len(stored)} objects instead of {len(expected)}")
    for (name, faces), one in zip(expected, stored, strict=True):
        if name != one.name:
            raise _mismatch(
                path, f"an object of the file is called “{one.name}” instead of “{name}”"
            )
        if len(faces) != one.count:
            told = f" in “{name}”" if name else ""
            message = f"the file contains {one.count} triangles{told} instead of {len(faces)}"
            raise _mismatch(path, message)


def _compare_corners(
    path: str,
    rounded: npt.NDArray[Any],
    expected: list[tuple[str, IndexArray]],
    stored: list[StoredMesh],
) -> None:
    before = 0
    for (_, faces), one in zip(expected, stored, strict=True):
        at = _first_difference(rounded, faces, one)
        if at is not None:
            message = f"triangle {before + at} of the file has other corners"
            raise _mismatch(path, message, (before + at,))
        before += len(faces)


def _rounded(mesh: Mesh | RawMesh, stored: Sequence[StoredMesh | StoredRows]) -> npt.NDArray[Any]:
    """Return the vertices of a mesh in the precision of the file's objects."""
    if not stored:
        return mesh.vertices
    return mesh.vertices.astype(stored[0].vertices.dtype.newbyteorder("="), copy=False)


def _first_difference(
    vertices: npt.NDArray[Any], faces: IndexArray, stored: StoredMesh
) -> int | None:
    """Return the number of the first triangle whose corners differ from those in the file.

    Return None if no triangle differs.
    """
    for block in blocks(len(faces)):
        expected = vertices[faces[block]]
        differ = (expected != _corners(stored, block.start, len(expected))).any(axis=(1, 2))
        if differ.any():
            return int(block.start + np.flatnonzero(differ)[0])
    return None


def _corners(stored: StoredMesh, start: int, count: int) -> npt.NDArray[Any]:
    if stored.faces is None:
        return stored.vertices[3 * start : 3 * (start + count)].reshape(-1, 3, 3)
    faces = stored.faces[start : start + count]
    if not 0 <= faces.min() <= faces.max() < len(stored.vertices):
        return np.full((count, 3, 3), np.nan)
    return stored.vertices[faces]
