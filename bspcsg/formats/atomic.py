"""Atomic writing: a file is either complete or does not exist.

A file is written under a temporary name, locked, and renamed when it is complete. If the process is
killed, the temporary file stays, but its lock ends: the next process that writes into the folder
removes it.
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

#: The name of a temporary file begins with at most this number of characters of the final name:
#: file systems allow 255 bytes for a name, and UTF-8 takes up to four for a character.
_MAX_NAME_CHARACTERS = 57

#: The end of a temporary file's name: a hash of the machine's name, a random number and ".part".
#: A machine removes only its own files, as it may not see the locks of other machines.
_PART = re.compile(r"\.[0-9a-f]{8}-[0-9a-f]{8}\.part\Z")

#: The folders from which this process has removed the temporary files of killed processes.
_cleaned_folders: set[Path] = set()

#: A function that reads the written file, and raises an error if its content is wrong.
FileCheck: TypeAlias = Callable[[BinaryIO], None]


def write_file(
    path: str | os.PathLike[str], chunks: Iterable[bytes], prove: FileCheck | None = None
) -> None:
    """Write the chunks to a temporary file in the folder of `path`, then rename it to `path`.

    If anything fails, an existing file stays unchanged. If `path` is the null device, the chunks
    are passed to `prove`, but not written.

    Parameters
    ----------
    path : str or path
    chunks : iterable of bytes
    prove : callable, optional
        Called before the renaming with the new file, at its beginning; raises an error if the
        content is wrong. The file is written while `prove` reads it, always ahead of the reader.

    Raises
    ------
    FormatError
        If the file cannot be written; code ``"unwritable"``. Errors of `prove` are passed on.
    """
    name = file_path(path)
    if name == os.devnull:
        _prove_without_writing(chunks, prove)
        return
    # A link stays a link: its target is replaced.
    target = Path(os.path.realpath(name))
    with _write_errors(name):
        _check_target(name)
        _clean_folder(target.parent)
        while True:
            with contextlib.suppress(_FileRemovedError):
                _write_new(target, chunks, prove)
                return


def refuse_target(path: str | os.PathLike[str]) -> None:
    """Raise a `FormatError` if `path` is a folder or a device, or its folder does not exist."""
    name = file_path(path)
    with _write_errors(name):
        _check_target(name)


@contextlib.contextmanager
def _write_errors(name: str) -> Iterator[None]:
    """Turn an `OSError` of the block into a `FormatError`: the file `name` cannot be written."""
    try:
        yield
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise FormatError(f"{name}: cannot write this file: {reason}.", "unwritable") from error


def _prove_without_writing(chunks: Iterable[bytes], prove: FileCheck | None) -> None:
    """Make all chunks and pass them to `prove`, without writing a file."""
    data = b"".join(chunks)
    if prove is not None:
        prove(io.BytesIO(data))


def _check_target(name: str) -> None:
    # Do not resolve the path: if /dev/stdout is a pipe, it resolves to a file that does not exist.
    path = Path(name)
    if path.is_dir():
        raise IsADirectoryError(21, "the path names a folder")
    if path.exists() and not path.is_file():
        raise OSError(22, "the path does not name an ordinary file")
    folder = Path(os.path.realpath(name)).parent
    if not folder.is_dir():
        raise FileNotFoundError(2, f"the folder {folder} does not exist")


#: The number of bytes that are buffered before they are written. A smaller buffer takes more time;
#: chunks longer than the buffer bypass it.
_BUFFER_BYTES = 1 << 18


def _clean_folder(folder: Path) -> None:
    """Remove the temporary files that killed processes of this machine left in a folder."""
    if sys.platform == "win32" or folder in _cleaned_folders:
        return
    _cleaned_folders.add(folder)
    with contextlib.suppress(OSError), os.scandir(folder) as found:
        for entry in found:
            named = _PART.search(entry.name)
            if named and named[0].startswith(f".{_machine()}-") and entry.name[0] == ".":
                _remove_stale(entry.path)


def _remove_stale(part: str) -> None:
    """Remove the temporary file `part` unless the process that writes it still runs."""
    if sys.platform == "win32":
        return
    with contextlib.suppress(OSError):
        # Skip links, and do not block on pipes, that have the name of a temporary file.
        handle = os.open(part, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        try:
            if stat.S_ISREG(os.fstat(handle).st_mode):
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                os.unlink(part)
        finally:
            os.close(handle)


def _machine() -> str:
    return f"{zlib.crc32(platform.node().encode('utf-8', 'replace')):08x}"


class _FileRemovedError(Exception):
    """Another process removed the temporary file just before it was locked."""


@contextlib.contextmanager
def _locked(handle: int, part: Path) -> Iterator[None]:
    """Lock a temporary file, so that no other process removes it while it is written."""
    if sys.platform == "win32":
        yield
        return
    # Lock a duplicate of the handle: the file is closed before it is renamed.
    lock = os.dup(handle)
    try:
        # On a file system without locks, no process removes temporary files.
        with contextlib.suppress(OSError):
            fcntl.flock(lock, fcntl.LOCK_EX)
        if not part.exists():
            raise _FileRemovedError
        yield
    finally:
        os.close(lock)


def _write_new(target: Path, chunks: Iterable[bytes], prove: FileCheck | None) -> None:
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
    """Flush a file to the disk; return True if its size and time of change stayed the same."""
    before = os.fstat(handle)
    os.fsync(handle)
    after = os.fstat(handle)
    return (before.st_size, before.st_mtime_ns) == (after.st_size, after.st_mtime_ns)


def _write_and_prove(
    part: Path, stream: BinaryIO, chunks: Iterable[bytes], prove: FileCheck
) -> None:
    with part.open("rb", buffering=0) as back:
        growing = _LazyFile(stream, iter(chunks), back)
        try:
            prove(cast(BinaryIO, growing))
        except Exception:
            if growing.failure is not None:
                raise growing.failure from None
            raise
        growing.finish()


class _LazyFile(io.RawIOBase):
    """A binary file whose chunks are written only when a reader needs them.

    When a block is read back, both the block and the arrays it came from are still in the
    processor's cache. This is faster than writing the whole file and then reading it.

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
        #: The exception that making or writing the chunks raised, if any.
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
        """Return the next `size` bytes, or all remaining bytes if `size` is negative."""
        if size < 0:
            self.finish()
        elif self._size < (end := self._back.tell() + size):
            self._write(end)
        return self._back.read(size)

    def finish(self) -> None:
        """Write all remaining chunks to the file."""
        # Chunks may be single lines: a Python loop over them would double the time.
        self._watched(lambda: self._stream.writelines(self._chunks))
        self._size = sys.maxsize

    def _write(self, end: int) -> None:
        """Write chunks until the file has at least `end` bytes, or no chunks remain."""

        def write() -> None:
            while self._size < end and (chunk := next(self._chunks, None)) is not None:
                self._stream.write(chunk)
                self._size += len(chunk)

        self._watched(write)

    def _watched(self, write: Callable[[], None]) -> None:
        """Call `write` and flush the file; store an exception in `failure`, then raise it."""
        try:
            write()
            self._stream.flush()
        except Exception as error:
            self.failure = error
            raise
