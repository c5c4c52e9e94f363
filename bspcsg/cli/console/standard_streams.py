"""Replacement of standard output and error by streams that write completely or raise an error.

Python's own streams do not. If they are unbuffered (``PYTHONUNBUFFERED``), they silently ignore
partial writes, which occur on a full disk, at a file size limit and above 2 GiB; and their errors
do not name the file.
"""

import io
import os
import select
import sys
from collections.abc import Callable, Iterable
from typing import Any

#: The number of bytes that are buffered before they are written.
_BUFFER_BYTES = 1 << 16


class FullOutputError(OSError):
    """An error: standard output cannot be written. Other files have errors of other classes."""


class _CompleteWriter(io.RawIOBase):
    """A raw stream whose `write` writes all bytes, in several steps if necessary.

    Parameters
    ----------
    raw : file
        The file to which bytes are written.
    owner : file
        The original stream; it is stored, since its garbage collection would close the file.
    fail : callable
        Called with the error of a write, unless the pipe is closed. If it returns, the data are
        lost.
    """

    def __init__(self, raw: io.RawIOBase, owner: object, fail: Callable[[OSError], None]) -> None:
        self._raw, self._owner, self._fail = raw, owner, fail

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._raw.fileno()

    def isatty(self) -> bool:
        return self._raw.isatty()

    def write(self, data: Any, /) -> int:
        """Write all bytes of `data`, and return their number; call `fail` if that is impossible."""
        with memoryview(data) as view:
            size = len(view)
            try:
                self._write(view)
            except BrokenPipeError:
                raise
            except OSError as error:
                self._fail(error)
            return size

    def _write(self, view: memoryview) -> None:
        done = 0
        while done < len(view):
            count = self._raw.write(view[done:])
            if count is None:
                # Another process that shares the pipe has made it non-blocking.
                select.select([], [self._raw], [])
            else:
                done += count


def replace_streams(errors: str) -> None:
    """Replace standard output and error by streams that write completely.

    `errors` is the name of the codec's error handler.
    """
    for name, fail in (("stdout", _refuse), ("stderr", _pass_by)):
        stream = getattr(sys, name)
        raw = _raw_of(stream)
        if raw is not None:
            stream.flush()
            whole = io.BufferedWriter(_CompleteWriter(raw, stream, fail), _BUFFER_BYTES)
            made = io.TextIOWrapper(whole, stream.encoding, errors, line_buffering=True)
            setattr(sys, name, made)
        elif isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=errors)


def _raw_of(stream: object) -> io.FileIO | None:
    """Return the unbuffered file under a text stream; None for a Windows console and others."""
    if not isinstance(stream, io.TextIOWrapper):
        return None
    raw = getattr(stream.buffer, "raw", stream.buffer)
    return raw if isinstance(raw, io.FileIO) else None


def _refuse(error: OSError) -> None:
    redirect_to_null("stdout")
    raise FullOutputError(error.errno, error.strerror, "standard output") from error


def _pass_by(_: OSError) -> None:
    # The error cannot be reported anywhere; the work and its exit code matter more than messages.
    redirect_to_null("stderr")


def write_bytes(chunks: Iterable[bytes]) -> None:
    """Write bytes to standard output.

    Raises
    ------
    FullOutputError
        If not all bytes can be written.
    """
    sys.stdout.flush()
    sys.stdout.buffer.writelines(chunks)
    sys.stdout.buffer.flush()


def redirect_to_null(name: str = "stdout") -> None:
    """Redirect a standard stream to the null device, so that flushing it does not fail again."""
    nothing = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, getattr(sys, name).fileno())
    os.close(nothing)
