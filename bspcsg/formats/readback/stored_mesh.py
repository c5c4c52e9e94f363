"""Objects of a mesh file that is being checked, and the rows of numbers in that file."""

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
    """One object of a file, with the numbers that the file contains.

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
        """The number of triangles."""
        return len(self.vertices) // 3 if self.faces is None else len(self.faces)

    def has(self, vertices: npt.NDArray[Any], faces: IndexArray) -> bool:
        """Say whether the object has exactly these vertices and faces, in this order."""
        if self.faces is None or self.vertices.shape != vertices.shape:
            return False
        return bool((self.faces == faces).all() and (self.vertices == vertices).all())

    def loaded(self) -> "StoredMesh":
        """Return the object itself, since its numbers are already in memory."""
        return self


class RowsInFile(Protocol):
    """Rows of three numbers in a file, which are read from the file when they are needed."""

    def __len__(self) -> int:
        """Return the number of rows."""

    @property
    def dtype(self) -> "np.dtype[Any]":
        """The numpy type of one number in the rows."""

    def equals(self, expected: npt.NDArray[Any]) -> bool:
        """Say whether the rows equal the rows of `expected`."""

    def all_rows(self) -> npt.NDArray[Any]:
        """Return all rows as one array."""

    def check_last(self) -> None:
        """Raise a `ValueError` unless the file ends after the last row."""


class Rows:
    """Rows of numbers in a binary file, each row a record of the same number of bytes.

    They are read and compared in blocks that stay in the processor's cache: this takes a fifth of
    the time of reading the whole file into new memory.

    Parameters
    ----------
    file : binary file
    start : int
        The offset of the first row's first byte.
    row : dtype
        The type of one row.
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
        """The numpy type of one number in the rows."""
        base: np.dtype[Any] = self._row.base
        return base

    @property
    def end(self) -> int:
        """The offset of the first byte after the last row."""
        return self._start + self._count * int(self._row.itemsize)

    def check_last(self) -> None:
        """Raise a `ValueError` unless the file ends after the last row."""
        if size_of(self._file) != self.end:
            raise ValueError(f"its length is not the {self.end} bytes that follow from its header")

    def equals(self, expected: npt.NDArray[Any]) -> bool:
        """Say whether the rows equal the rows of `expected` bit by bit."""
        return all(
            self.block_equals(block, expected[block])
            for block in blocks(self._count, ROWS_PER_FILE_BLOCK)
        )

    def block_equals(self, block: slice, expected: npt.NDArray[Any]) -> bool:
        """Say whether a block's rows of 8-byte numbers equal the rows of `expected` bit by bit."""
        base = self._row.base
        words = np.ascontiguousarray(expected, base.newbyteorder("=")).view(np.uint64)
        return are_words(self.data(block), words, base == base.newbyteorder(">"))

    def numbers(self, block: slice) -> npt.NDArray[Any]:
        """Return the rows of a block as an array."""
        return np.frombuffer(self.data(block), self._row)

    def all_rows(self) -> npt.NDArray[Any]:
        """Return all rows as one array."""
        return self.numbers(slice(None))

    def data(self, block: slice) -> bytes:
        """Return the bytes of a block of rows."""
        start, stop, _ = block.indices(self._count)
        size = self._row.itemsize
        return read_exactly(self._file, self._start + start * size, (stop - start) * size)


@dataclass(frozen=True, eq=False)
class StoredRows:
    """One object of a file, whose numbers are read from the file when they are needed.

    Parameters
    ----------
    vertices, faces : RowsInFile
    name : str
    ends : bool
        True if nothing may follow the faces in the file.
    """

    vertices: RowsInFile
    faces: RowsInFile
    name: str = ""
    ends: bool = False

    @property
    def count(self) -> int:
        """The number of triangles."""
        return len(self.faces)

    def has(self, vertices: npt.NDArray[Any], faces: IndexArray) -> bool:
        """Say whether the object has exactly these vertices and faces, in this order."""
        if len(self.vertices) != len(vertices):
            return False
        found = self.vertices.equals(vertices) and self.faces.equals(faces)
        self.check_end()
        return found

    def loaded(self) -> StoredMesh:
        """Return the object with all of its numbers in memory."""
        vertices, faces = self.vertices.all_rows(), self.faces.all_rows()
        self.check_end()
        return StoredMesh(vertices, faces, self.name)

    def check_end(self) -> None:
        """Raise a `ValueError` if `ends` is true and something follows the faces in the file."""
        if self.ends:
            self.faces.check_last()


def read_exactly(file: BinaryIO, start: int, count: int) -> bytes:
    """Return `count` bytes of a file from offset `start`; fewer are a `ValueError`."""
    file.seek(start)
    data = file.read(count)
    if len(data) != count:
        raise ValueError(f"it ends too early, at byte {start + len(data)}")
    return data


def size_of(file: BinaryIO) -> int:
    """Return the number of bytes of a file."""
    return file.seek(0, os.SEEK_END)


#: An upper bound of the number of bytes in the text lines between two blocks of numbers.
_MAX_LINE_BYTES = 1 << 12


def text_at(file: BinaryIO, start: int, count: int = _MAX_LINE_BYTES) -> bytes:
    """Return up to `count` bytes of a file from offset `start`.

    By default they include all text lines before the next block of numbers.
    """
    file.seek(start)
    return file.read(count)


def header_of(file: BinaryIO) -> bytes:
    """Return the first bytes of a file, which include its whole header."""
    return text_at(file, 0)


def rest_after(key: bytes, line: bytes) -> str:
    """Return the rest of a line that begins with `key`; raise a `ValueError` if it does not."""
    if not line.startswith(key):
        raise ValueError(f"a line does not begin with “{key.decode()}”")
    return line[len(key) :].decode("utf-8")


def rows_of(block: bytes, row: bytes) -> npt.NDArray[np.float64]:
    """Return the numbers in a text that repeats the pattern `row`, where `#` stands for a number.

    Each repetition gives one row of the array.
    """
    return numbers_in_rows(block, row).reshape(-1, row.count(b"#"))


def whole_rows_of(block: bytes, row: bytes) -> IndexArray:
    """Return the integers in a text that repeats the pattern `row`, where `#` stands for one.

    Each repetition gives one row of the array.
    """
    return whole_numbers_in_rows(block, row).reshape(-1, row.count(b"#"))
