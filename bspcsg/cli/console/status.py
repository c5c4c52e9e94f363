"""The line on a terminal that says, after a second, what is under way and for how long.

The line stands at the end of standard error and goes before anything else is said there.
"""

import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext

#: The time until a line appears, and the time between two looks at the clock, in seconds.
_LINE_DELAY, _POLL_INTERVAL = 1.0, 0.1

#: To the start of the line, and nothing behind it.
_ERASE = "\r\033[K"


class _Line:
    """The line and the thread that keeps it up to date."""

    def __init__(self, what: str) -> None:
        self.what = what
        self._began = time.monotonic()
        self._lock = threading.Lock()
        self._is_over = threading.Event()
        self._shown = ""
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def end(self) -> None:
        """Take the line away for good."""
        self._is_over.set()
        self._thread.join()
        self._put("")

    @contextmanager
    def hidden(self) -> Iterator[None]:
        """Take the line away while something is said."""
        with self._lock:
            self._put("")
            yield

    def _run(self) -> None:
        while not self._is_over.wait(_POLL_INTERVAL):
            seconds = time.monotonic() - self._began
            if seconds >= _LINE_DELAY:
                with self._lock:
                    self._put(f"{self.what} … {seconds:.0f} s")

    def _put(self, text: str) -> None:
        if text != self._shown:
            self._shown = text
            sys.stderr.write(_ERASE + text)
            sys.stderr.flush()


_line: _Line | None = None


@contextmanager
def watched(what: str, quiet: bool) -> Iterator[None]:
    """Show for how long something is under way, unless nobody is there or wants to know."""
    global _line  # noqa: PLW0603  there is one terminal
    if quiet or os.environ.get("TERM") == "dumb" or not sys.stderr.isatty():
        yield
        return
    _line = _Line(what)
    try:
        yield
    finally:
        end()


def tell(what: str) -> None:
    """Say what is under way now."""
    if _line is not None:
        _line.what = what


def hidden() -> AbstractContextManager[None]:
    """Return the context in which something is said."""
    return nullcontext() if _line is None else _line.hidden()


def end() -> None:
    """Leave the terminal to something else."""
    global _line
    if _line is not None:
        line, _line = _line, None
        line.end()
