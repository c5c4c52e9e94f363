"""Standard output and error: what goes there is written whole, or fails under its own name.

Python's own streams do neither. An unbuffered one (``PYTHONUNBUFFERED``) passes by in silence that
a system took a part only, as it does on a full disk, of a limited file and above 2 GiB; and an
error of either stream does not say which file it is about.
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
    """Standard output cannot be written: no error of a file that is read or written meanwhile."""


class _CompleteWriter(io.RawIOBase):
    """The end of a stream: takes all that it is given.

    Parameters
    ----------
    raw : file
        The place that bytes go to.
    owner : file
        The stream that closes it when nobody holds that any more.
    fail : callable
        Told the error of a write, a closed pipe's apart; what it lets pass is lost.
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
        """Write all bytes."""
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
                # Whoever shares the pipe has it not wait for its reader.
                select.select([], [self._raw], [])
            else:
                done += count


def take_over(errors: str) -> None:
    """Have both streams of this process write whole, and their letters by this name of a codec."""
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
    """Return the file at the end of a stream; none of a terminal of Windows, which is no file."""
    if not isinstance(stream, io.TextIOWrapper):
        return None
    raw = getattr(stream.buffer, "raw", stream.buffer)
    return raw if isinstance(raw, io.FileIO) else None


def _refuse(error: OSError) -> None:
    discard("stdout")
    raise FullOutputError(error.errno, error.strerror, "standard output") from error


def _pass_by(_: OSError) -> None:
    # Nobody could be told; the work and its exit code are worth more than its words.
    discard("stderr")


def put(chunks: Iterable[bytes]) -> None:
    """Write bytes to standard output.

    Raises
    ------
    FullOutputError
        If it cannot take all of them.
    """
    sys.stdout.flush()
    sys.stdout.buffer.writelines(chunks)
    sys.stdout.buffer.flush()


def discard(name: str = "stdout") -> None:
    """Point a stream at nothing, so that what is left is not flushed where it failed."""
    nothing = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, getattr(sys, name).fileno())
    os.close(nothing)
