"""`Source`: the bytes and the name of a file for readers, and errors that name a position in it."""

import codecs
import errno
import os
import re
import stat
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from .._types import FloatArray
from ..errors import FormatError, unreadable
from ..parameters import file_path

#: The byte order mark of UTF-8, with which a text file may begin.
BYTE_ORDER_MARK = b"\xef\xbb\xbf"

#: The byte order marks of UTF-32 and UTF-16; UTF-32 comes first, as its marks begin with UTF-16's.
_WIDE_MARKS = {
    codecs.BOM_UTF32_LE: "utf-32",
    codecs.BOM_UTF32_BE: "utf-32",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}

#: The largest number of characters of an offending word that an error quotes.
_MAX_QUOTED_CHARACTERS = 24

#: The largest number of bytes of a script or drawing. A parsed file takes ten or more times as
#: many bytes of memory: some 3 GB.
_MAX_TEXT_BYTES = 1 << 28

#: Up to this number, doubles represent every whole number exactly.
_MAX_EXACT_INTEGER = 2.0**53

#: The largest number of characters of a whole number. It is twice what 64 bits need, so that errors
#: can quote a number that is a little too large.
_MAX_INTEGER_CHARACTERS = 40

#: The beginning of the pointer that Git LFS stores instead of a large file, and the largest number
#: of bytes of a pointer.
_POINTER_START = re.compile(rb"version https://(git-lfs|hawser)\.github\.com/spec/v\d")
_MAX_POINTER_BYTES = 1024


@dataclass(frozen=True)
class Source:
    """A file as the input of a reader.

    Parameters
    ----------
    name : str
        The path as the caller gave it.
    data : bytes
        The whole file.
    files : dict of str to bytes, optional
        The content of companion files by name; if absent, they are read from the disk.
    """

    name: str
    data: bytes
    files: Mapping[str, bytes] | None = None

    def without_mark(self) -> "Source":
        """Return the source without a byte order mark; UTF-16 and UTF-32 become UTF-8."""
        for mark, name in _WIDE_MARKS.items():
            if self.data.startswith(mark):
                with suppress(UnicodeError):
                    return replace(self, data=self.data.decode(name).encode())
        return replace(self, data=self.data.removeprefix(BYTE_ORDER_MARK))

    def beside(self, name: str) -> bytes | None:
        """Return the bytes of a companion file in the same folder; None if missing or too large."""
        if self.files is not None:
            return self.files.get(name)
        # Only plain file names: a mesh file could name a folder, a device or another user's file.
        if Path(name).name != name:
            return None
        # If the path is a link, companion files may be in its folder or in that of its target.
        for path in (self.name, os.path.realpath(self.name)):
            data = _limited(Path(path).parent / name)
            if data is not None:
                return data
        return None

    def error(
        self,
        message: str,
        code: str = "syntax",
        *,
        line: int | None = None,
        offset: int | None = None,
    ) -> FormatError:
        """Return a `FormatError` that names the file and a line (from 1) or a byte (from 0)."""
        if line is not None:
            return FormatError(f"{self.name}:{line}: {message}", code, [line])
        if offset is not None:
            return FormatError(f"{self.name}: at byte {offset}: {message}", code, [offset])
        return FormatError(f"{self.name}: {message}", code)

    def text_lines(
        self, comment: bytes = b"", naming: frozenset[bytes] = frozenset()
    ) -> Iterator[tuple[int, list[bytes]]]:
        """Yield number and words of each line that is not blank, without comments.

        In a line that begins with a keyword of `naming`, names may contain the comment mark: only a
        mark that is a word of its own begins a comment.
        """
        for number, line in enumerate(self.without_mark().data.splitlines(), 1):
            words = line.split()
            if comment and comment in line:
                words = _uncommented(line, words, comment, naming)
            if words:
                yield number, words

    def coordinates(self, rows: Sequence[Sequence[bytes]], lines: Sequence[int]) -> FloatArray:
        """Return the first three words of each row as (n, 3) float64, each rounded once.

        Raises
        ------
        FormatError
            If a row has fewer than three words, or a word is no finite number; the message has the
            number of the row's line.
        """
        try:
            numbers = [(float(row[0]), float(row[1]), float(row[2])) for row in rows]
            if b"_" in self.data and not all(map(_is_point, rows)):
                raise ValueError
        except (ValueError, IndexError):
            raise self._bad_row(rows, lines) from None
        points = np.array(numbers, dtype=np.float64).reshape(-1, 3)
        if not np.isfinite(points).all():
            row = int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])
            words = b" ".join(rows[row][:3])
            message = f"the coordinates {quoted(words)} are not three finite numbers."
            raise self.error(message, "non_finite", line=lines[row])
        return points

    def _bad_row(self, rows: Sequence[Sequence[bytes]], lines: Sequence[int]) -> FormatError:
        row = next(row for row, words in enumerate(rows) if not _is_point(words))
        words = b" ".join(rows[row][:3])
        message = f"expected three coordinates, found {quoted(words)}."
        return self.error(message, line=lines[row])


def _uncommented(
    line: bytes, words: list[bytes], comment: bytes, naming: frozenset[bytes]
) -> list[bytes]:
    if words[0] not in naming:
        return line.partition(comment)[0].split()
    return words[: words.index(comment)] if comment in words else words


def _limited(path: Path) -> bytes | None:
    """Return the bytes of a file; None if it is missing, too large or a pointer of Git LFS."""
    try:
        data = content_of(path) if path.stat().st_size <= _MAX_TEXT_BYTES else None
    except (OSError, ValueError):
        return None
    return None if data is None or _is_pointer(data) else data


def content_of(path: Path) -> bytes:
    """Return the bytes of a file or pipe; raise an `OSError` for devices, which may never end."""
    mode = path.stat().st_mode
    if stat.S_ISCHR(mode) or stat.S_ISBLK(mode):
        raise OSError(errno.EINVAL, "the path names a device, not a file")
    return path.read_bytes()


def limited_content(path: str | os.PathLike[str]) -> bytes:
    """Return the bytes of a script or drawing.

    Raises
    ------
    FormatError
        If the file cannot be read, is larger than 256 MiB, or is a pointer of Git LFS.
    """
    name = file_path(path)
    with _read_errors(name):
        data = content_of(Path(name)) if Path(name).stat().st_size <= _MAX_TEXT_BYTES else None
    if data is None or len(data) > _MAX_TEXT_BYTES:
        raise FormatError(
            f"{name}: the file is larger than the limit of {_MAX_TEXT_BYTES:,} bytes.", "too_large"
        )
    return refuse_pointer_file(name, data)


def whole_content(path: str | os.PathLike[str]) -> bytes:
    """Return the bytes of a file of any size.

    Raises
    ------
    FormatError
        If the file cannot be read or is a pointer of Git LFS.
    """
    name = file_path(path)
    with _read_errors(name):
        data = content_of(Path(name))
    return refuse_pointer_file(name, data)


def refuse_pointer_file(name: str, data: bytes) -> bytes:
    """Return the bytes of a file unchanged, unless they are a pointer of Git LFS.

    Raises
    ------
    FormatError
        If the bytes are a pointer of Git LFS; code ``"unreadable"``.
    """
    if _is_pointer(data):
        message = (
            f"{name}: the file is a Git LFS pointer, not the mesh; fetch the mesh with “git lfs"
            " pull”."
        )
        raise FormatError(message, "unreadable")
    return data


def _is_pointer(data: bytes) -> bool:
    return len(data) <= _MAX_POINTER_BYTES and _POINTER_START.match(data) is not None


@contextmanager
def _read_errors(name: str) -> Iterator[None]:
    """Turn an exception of the block into a `FormatError`: the file `name` cannot be read."""
    try:
        yield
    except (OSError, ValueError) as error:
        raise unreadable(name, error) from error


def quoted(words: bytes) -> str:
    """Return the first characters of a text in quotes, for a message; “nothing” if it is empty."""
    decoded = words.decode("utf-8", "replace")
    text = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in decoded)
    short = text if len(text) <= _MAX_QUOTED_CHARACTERS else text[:_MAX_QUOTED_CHARACTERS] + "…"
    return f"“{short}”" if text else "nothing"


def as_text(name: bytes) -> str:
    """Decode a name in a file as UTF-8, or as Latin-1 if it is no UTF-8."""
    try:
        return name.decode("utf-8")
    except UnicodeDecodeError:
        return name.decode("latin-1")


def to_integer(word: bytes) -> int:
    """Convert a word to an integer; raise a `ValueError` for other words, such as ``1_0``."""
    if b"_" in word or len(word) > _MAX_INTEGER_CHARACTERS:
        raise ValueError(word)
    return int(word)


def to_integral(word: bytes) -> int:
    """Convert a word to an integer, also one like ``1.0``; raise a `ValueError` for others."""
    try:
        return to_integer(word)
    except ValueError:
        number = float(word)
        if b"_" in word or not number.is_integer() or abs(number) > _MAX_EXACT_INTEGER:
            raise
        return int(number)


def _is_point(words: Sequence[bytes]) -> bool:
    try:
        numbers = [float(word) for word in words[:3]]
    except ValueError:
        return False
    return len(numbers) == 3 and not any(b"_" in word for word in words[:3])
