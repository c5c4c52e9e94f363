"""Objects of a file, and blocks of numbers with a common layout."""

import os
from dataclasses import dataclass
from typing import Any, BinaryIO, Protocol

import numpy as np
import numpy.typing as npt

from ..._core import are_words, numbers_in_rows, whole_numbers_in_rows
from ..._types import IndexArray
from ..blocks import ROWS_PER_FILE_BLOCK, blocks


@dataclass(frozen=True, eq=False)
class StoredMesh:
    """One object as it stands in a file.

    Parameters
    ----------
    vertices : (n, 3) float32 or float64
        In the precision of the file.
    faces : (m, 3) int, optional
        Indices of `vertices`; without them, every three consecutive vertices are a triangle.
    name : str
    """

    vertices: npt.NDArray[Any]
    faces: IndexArray | None = None
    name: str = ""

    @property
    def count(self) -> int:
        """Number of triangles."""
        return len(self.vertices) // 3 if self.faces is None else len(self.faces)

    def has(self, vertices: npt.NDArray[Any], faces: IndexArray) -> bool:
        """Say whether the object has exactly these arrays."""
        if self.faces is None or self.vertices.shape != vertices.shape:
            return False
        return bool((self.faces == faces).all() and (self.vertices == vertices).all())

    def loaded(self) -> "StoredMesh":
        """Return it with all of its numbers in memory, where they are."""
        return self


class RowsInFile(Protocol):
    """Rows of three numbers in a file, which are read on demand."""

    def __len__(self) -> int:
        """Return the number of rows."""

    @property
    def dtype(self) -> "np.dtype[Any]":
        """The type of one number."""

    def are(self, expected: npt.NDArray[Any]) -> bool:
        """Say whether the rows are these."""

    def everything(self) -> npt.NDArray[Any]:
        """Return all rows."""

    def check_last(self) -> None:
        """Refuse a file that does not end with them."""


class Rows:
    """Numbers in records of one size.

    Blocks that stay in a processor's cache are read and compared in a fifth of the time that a
    file takes in fresh memory.

    Parameters
    ----------
    file : binary file
    start : int
        The first of their bytes.
    row : dtype
        Of one row.
    count : int
    """

    def __init__(self, file: BinaryIO, start: int, row: Any, count: int) -> None:
        self._file = file
        self._start = start
        self._row: np.dtype[Any] = np.dtype(row)
        self._count = count

    def __len__(self) -> int:
        """Return the number of rows."""
        return self._count

    @property
    def dtype(self) -> "np.dtype[Any]":
        """The type of one number."""
        base: np.dtype[Any] = self._row.base
        return base

    @property
    def end(self) -> int:
        """The offset of the first byte after them."""
        return self._start + self._count * int(self._row.itemsize)

    def check_last(self) -> None:
        """Refuse a file that does not end with them."""
        if size_of(self._file) != self.end:
            raise ValueError(f"its length is not the {self.end} bytes that follow from its header")

    def are(self, expected: npt.NDArray[Any]) -> bool:
        """Say whether the rows are these."""
        return all(
            self.hold(block, expected[block]) for block in blocks(self._count, ROWS_PER_FILE_BLOCK)
        )

    def hold(self, block: slice, expected: npt.NDArray[Any]) -> bool:
        """Say whether the rows of a block, of numbers of eight bytes, equal these bit by bit."""
        base = self._row.base
        words = np.ascontiguousarray(expected, base.newbyteorder("=")).view(np.uint64)
        return are_words(self.data(block), words, base == base.newbyteorder(">"))

    def numbers(self, block: slice) -> npt.NDArray[Any]:
        """Return the rows of a block."""
        return np.frombuffer(self.data(block), self._row)

    def everything(self) -> npt.NDArray[Any]:
        """Return all rows."""
        return self.numbers(slice(None))

    def data(self, block: slice) -> bytes:
        """Return the bytes of a block."""
        start, stop, _ = block.indices(self._count)
        size = self._row.itemsize
        return piece(self._file, self._start + start * size, (stop - start) * size)


@dataclass(frozen=True, eq=False)
class StoredRows:
    """One object whose numbers are still in the file.

    Parameters
    ----------
    vertices, faces : RowsInFile
    name : str
    ends : bool
        True if nothing may follow the faces.
    """

    vertices: RowsInFile
    faces: RowsInFile
    name: str = ""
    ends: bool = False

    @property
    def count(self) -> int:
        """Number of triangles."""
        return len(self.faces)

    def has(self, vertices: npt.NDArray[Any], faces: IndexArray) -> bool:
        """Say whether the file holds exactly these arrays, in this order."""
        if len(self.vertices) != len(vertices):
            return False
        found = self.vertices.are(vertices) and self.faces.are(faces)
        self.check_end()
        return found

    def loaded(self) -> StoredMesh:
        """Return it with all of its numbers in memory."""
        vertices, faces = self.vertices.everything(), self.faces.everything()
        self.check_end()
        return StoredMesh(vertices, faces, self.name)

    def check_end(self) -> None:
        """Refuse a file that goes on where it should end."""
        if self.ends:
            self.faces.check_last()


def piece(file: BinaryIO, start: int, count: int) -> bytes:
    """Return `count` bytes of a file; raise an error if it ends earlier."""
    file.seek(start)
    data = file.read(count)
    if len(data) != count:
        raise ValueError(f"it ends too early, at byte {start + len(data)}")
    return data


def size_of(file: BinaryIO) -> int:
    """Return the number of bytes of a file."""
    return file.seek(0, os.SEEK_END)


#: The lines between two blocks of numbers have fewer bytes than this.
_MAX_LINE_BYTES = 1 << 12


def text_at(file: BinaryIO, start: int, count: int = _MAX_LINE_BYTES) -> bytes:
    """Return bytes of a file: unless told, enough for all lines before the next numbers."""
    file.seek(start)
    return file.read(count)


def header_of(file: BinaryIO) -> bytes:
    """Return the first bytes of a file, which include its whole header."""
    return text_at(file, 0)


def after(key: bytes, line: bytes) -> str:
    """Return the name that follows a key in a line."""
    if not line.startswith(key):
        raise ValueError(f"a line does not begin with “{key.decode()}”")
    return line[len(key) :].decode("utf-8")


def rows_of(block: bytes, row: bytes) -> npt.NDArray[np.float64]:
    """Return the numbers of a block of equal rows; `#` stands for a number in the pattern `row`."""
    return numbers_in_rows(block, row).reshape(-1, row.count(b"#"))


def whole_rows_of(block: bytes, row: bytes) -> IndexArray:
    """Return whole numbers as `rows_of` does."""
    return whole_numbers_in_rows(block, row).reshape(-1, row.count(b"#"))
