"""Rows of numbers in a text file that is being checked, each row a line of text."""

from collections.abc import Callable, Iterator
from typing import Any, BinaryIO, TypeAlias

import numpy as np
import numpy.typing as npt

from .stored_mesh import size_of, text_at

#: A function that returns the rows of three numbers in complete lines of text, and raises an
#: exception for lines of another form.
Reader: TypeAlias = Callable[[bytes], npt.NDArray[Any]]

#: The number of bytes that are read at a time: with the numbers in them they fit into the
#: processor's cache.
_BYTES_PER_READ = 1 << 18


class Lines:
    """Rows of three numbers in a file, each row a line of text.

    Parameters
    ----------
    file : binary file
    start : callable
        Returns the byte offset of the first line.
    count : int
    read : callable
    """

    def __init__(self, file: BinaryIO, start: Callable[[], int], count: int, read: Reader) -> None:
        self._file = file
        self._start = start
        self._count = count
        self._read = read
        self._end: int | None = None

    def __len__(self) -> int:
        """Return the number of lines."""
        return self._count

    @property
    def dtype(self) -> "np.dtype[Any]":
        """The numpy type of one number in the lines."""
        return self._read(b"").dtype

    def end(self) -> int:
        """Return the byte offset after the last line; the first call may read all lines."""
        if self._end is None:
            self._end = self._start() + sum(map(len, self._texts()))
        return self._end

    def check_last(self) -> None:
        """Raise a `ValueError` unless the file ends after the last line."""
        if size_of(self._file) != self.end():
            raise ValueError("there is data after its last line")

    def equals(self, expected: npt.NDArray[Any]) -> bool:
        """Say whether the numbers in the lines equal the rows of `expected`."""
        row, end = 0, self._start()
        for text in self._texts():
            found = self._read(text)
            if not (found == expected[row : row + len(found)]).all():
                return False
            row, end = row + len(found), end + len(text)
        self._end = end
        return True

    def all_rows(self) -> npt.NDArray[Any]:
        """Return the numbers in all lines as one array, a row for each line."""
        return np.concatenate([self._read(b""), *map(self._read, self._texts())])

    def _texts(self) -> Iterator[bytes]:
        """Yield all lines in chunks of complete lines."""
        at, left = self._start(), self._count
        while left:
            text, count = _first_lines(text_at(self._file, at, _BYTES_PER_READ), left)
            if not count:
                raise ValueError(f"it ends too early, at byte {at}")
            yield text
            at, left = at + len(text), left - count


def _first_lines(text: bytes, most: int) -> tuple[bytes, int]:
    """Return the complete lines at the start of a text, at most `most`, and their number."""
    count = text.count(b"\n")
    if count > most:
        return text[: -len(text.split(b"\n", most)[most])], most
    return text[: text.rfind(b"\n") + 1], count
