"""Atomic writing: a file is either complete or does not exist.

A file is written under a temporary name. If the process is killed, the temporary file stays; the
next process that writes into the folder removes it, since the writer's lock on it has ended.
"""

import contextlib
import io
import os
import platform
import re
import stat
import sys
import zlib
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import BinaryIO, TypeAlias, cast

from ..errors import FormatError
from ..parameters import file_path

if sys.platform != "win32":
    import fcntl

#: The largest number of characters of a file's name that begin the name of its unfinished file.
#: File systems allow 255 bytes for a name, and a character takes up to four.
_MAX_NAME_CHARACTERS = 57

#: The names of unfinished files, but for their first letters: they tell the machine, as locks may
#: not reach others that write into the same folder.
_PART = re.compile(r"\.[0-9a-f]{8}-[0-9a-f]{8}\.part\Z")

#: The folders from which this process has taken what others had left.
_swept: set[Path] = set()

#: Takes the file that was written, and raises an error if it is not what it should be.
Proof: TypeAlias = Callable[[BinaryIO], None]


def write_file(
    path: str | os.PathLike[str], chunks: Iterable[bytes], prove: Proof | None = None
) -> None:
    """Write the chunks to a new file beside `path`, then give it that name in one step.

    If anything fails, an existing file stays unchanged. Output to the null device is made and
    proved, but not kept.

    Parameters
    ----------
    path : str or path
    chunks : iterable of bytes
    prove : callable, optional
        Called with the new file, at its beginning, before the file gets its name. The file is
        written while `prove` reads it, always ahead of the reader.

    Raises
    ------
    FormatError
        If the file cannot be written; code ``"unwritable"``. Errors of `prove` are passed on.
    """
    name = file_path(path)
    if name == os.devnull:
        _drop(chunks, prove)
        return
    # A link stays a link: its target is replaced.
    target = Path(os.path.realpath(name))
    with _writing(name):
        _check_target(name)
        _sweep(target.parent)
        while True:
            with contextlib.suppress(_TakenAwayError):
                _write_new(target, chunks, prove)
                return


def refuse_target(path: str | os.PathLike[str]) -> None:
    """Raise a `FormatError` if a path cannot be that of a file, or is not that of a file."""
    name = file_path(path)
    with _writing(name):
        _check_target(name)


@contextlib.contextmanager
def _writing(name: str) -> Iterator[None]:
    """Turn errors of the block into a `FormatError` that the file cannot be written."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise FormatError(f"{name}: cannot write this file: {reason}.", "unwritable") from error


def _drop(chunks: Iterable[bytes], prove: Proof | None) -> None:
    """Make the output and prove it, without keeping it."""
    data = b"".join(chunks)
    if prove is not None:
        prove(io.BytesIO(data))


def _check_target(name: str) -> None:
    # Do not resolve the path: that of an open pipe, such as /dev/stdout, resolves to no file.
    path = Path(name)
    if path.is_dir():
        raise IsADirectoryError(21, "it is a folder")
    if path.exists() and not path.is_file():
        raise OSError(22, "it is not an ordinary file")
    folder = Path(os.path.realpath(name)).parent
    if not folder.is_dir():
        raise FileNotFoundError(2, f"the folder {folder} does not exist")


#: The number of bytes that are buffered before they are written. A smaller buffer takes more time,
#: and longer chunks go out as they are.
_BUFFER_BYTES = 1 << 18


def _sweep(folder: Path) -> None:
    """Remove the unfinished files that killed processes of this machine left in a folder."""
    if sys.platform == "win32" or folder in _swept:
        return
    _swept.add(folder)
    with contextlib.suppress(OSError), os.scandir(folder) as found:
        for entry in found:
            named = _PART.search(entry.name)
            if named and named[0].startswith(f".{_machine()}-") and entry.name[0] == ".":
                _take_away(entry.path)


def _take_away(part: str) -> None:
    """Remove an unfinished file unless its writer lives."""
    if sys.platform == "win32":
        return
    with contextlib.suppress(OSError):
        # Skip links, and do not block on pipes, that have the name of an unfinished file.
        handle = os.open(part, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        try:
            if stat.S_ISREG(os.fstat(handle).st_mode):
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                os.unlink(part)
        finally:
            os.close(handle)


def _machine() -> str:
    return f"{zlib.crc32(platform.node().encode('utf-8', 'replace')):08x}"


class _TakenAwayError(Exception):
    """Another process removed the unfinished file just before it was locked."""


@contextlib.contextmanager
def _locked(handle: int, part: Path) -> Iterator[None]:
    """Hold the lock on an unfinished file, which tells other processes that its writer lives."""
    if sys.platform == "win32":
        yield
        return
    # The file may be closed before it gets its name.
    lock = os.dup(handle)
    try:
        # On a file system without locks, nobody removes unfinished files.
        with contextlib.suppress(OSError):
            fcntl.flock(lock, fcntl.LOCK_EX)
        if not part.exists():
            raise _TakenAwayError
        yield
    finally:
        os.close(lock)


def _write_new(target: Path, chunks: Iterable[bytes], prove: Proof | None) -> None:
    name = f".{target.name[:_MAX_NAME_CHARACTERS]}.{_machine()}-{os.urandom(4).hex()}.part"
    part = target.with_name(name)
    # Opened like any new file, so that the umask sets its mode.
    handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    try:
        with contextlib.ExitStack() as until_named:
            with open(handle, "wb", buffering=_BUFFER_BYTES) as stream:
                until_named.enter_context(_locked(handle, part))
                if prove is None:
                    stream.writelines(chunks)
                else:
                    _write_and_prove(part, stream, chunks, prove)
                stream.flush()
                is_as_proved = _flushed(stream.fileno())
            if prove is not None and not is_as_proved:
                with part.open("rb") as written:
                    prove(written)
            if target.exists():
                part.chmod(target.stat().st_mode & 0o7777)
            os.replace(part, target)
    except BaseException:
        with contextlib.suppress(OSError):
            part.unlink()
        raise


def _flushed(handle: int) -> bool:
    """Flush a file to the disk; say whether its content stayed the same."""
    before = os.fstat(handle)
    os.fsync(handle)
    after = os.fstat(handle)
    return (before.st_size, before.st_mtime_ns) == (after.st_size, after.st_mtime_ns)


def _write_and_prove(part: Path, stream: BinaryIO, chunks: Iterable[bytes], prove: Proof) -> None:
    with part.open("rb", buffering=0) as back:
        growing = _Growing(stream, iter(chunks), back)
        try:
            prove(cast(BinaryIO, growing))
        except Exception:
            if growing.failure is not None:
                raise growing.failure from None
            raise
        growing.finish()


class _Growing(io.RawIOBase):
    """A file that is written while it is read.

    When a block is read back, both the block and the arrays it came from are still in the
    processor's cache. This is faster than a second pass over both.

    Parameters
    ----------
    stream : binary file
        The file to which the chunks are written.
    chunks : iterator of bytes
    back : file
        The same file, opened for reading.
    """

    def __init__(self, stream: BinaryIO, chunks: Iterator[bytes], back: io.FileIO) -> None:
        self._stream, self._chunks, self._back = stream, chunks, back
        self._size = 0
        # : The error of making or writing the chunks, if any.
        self.failure: Exception | None = None

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET, /) -> int:
        if whence == os.SEEK_END:
            self.finish()
        return self._back.seek(offset, whence)

    def tell(self) -> int:
        return self._back.tell()

    def read(self, size: int = -1, /) -> bytes:
        """Return `size` bytes, or all that are left."""
        if size < 0:
            self.finish()
        elif self._size < (end := self._back.tell() + size):
            self._write(end)
        return self._back.read(size)

    def finish(self) -> None:
        """Write all remaining chunks."""
        # Chunks may be single lines: a loop over them takes as long as making them.
        self._watched(lambda: self._stream.writelines(self._chunks))
        self._size = sys.maxsize

    def _write(self, end: int) -> None:
        """Write the file at least up to byte `end`, or to its end."""

        def write() -> None:
            while self._size < end and (chunk := next(self._chunks, None)) is not None:
                self._stream.write(chunk)
                self._size += len(chunk)

        self._watched(write)

    def _watched(self, write: Callable[[], None]) -> None:
        """Call `write`, and remember its error."""
        try:
            write()
            self._stream.flush()
        except Exception as error:
            self.failure = error
            raise
