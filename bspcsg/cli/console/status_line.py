"""The status line of a terminal: after a second it shows the current step and the time it takes.

The line is the last one on standard error; it is erased before other text is printed there.
"""

import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext

#: The time until the line appears, and the time between two updates, in seconds.
_LINE_DELAY, _POLL_INTERVAL = 1.0, 0.1

#: The control sequence that moves the cursor to the start of the line and erases the line.
_ERASE = "\r\033[K"


class _Line:
    """The status line and the thread that updates it."""

    def __init__(self, what: str) -> None:
        self.what = what
        self._began = time.monotonic()
        self._lock = threading.Lock()
        self._is_over = threading.Event()
        self._shown = ""
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def end(self) -> None:
        """Erase the line and end the thread."""
        self._is_over.set()
        self._thread.join()
        self._put("")

    @contextmanager
    def hidden(self) -> Iterator[None]:
        """Erase the line while other text is printed in the `with` block."""
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
def displayed(what: str, quiet: bool) -> Iterator[None]:
    """Show the status line while the `with` block runs, if standard error is a terminal.

    It is not shown if `quiet` is true.
    """
    global _line  # noqa: PLW0603  there is one terminal
    if quiet or os.environ.get("TERM") == "dumb" or not sys.stderr.isatty():
        yield
        return
    _line = _Line(what)
    try:
        yield
    finally:
        end()


def set_text(what: str) -> None:
    """Set the text of the status line, if there is one."""
    if _line is not None:
        _line.what = what


def hidden() -> AbstractContextManager[None]:
    """Return a context in which the status line is erased, for printing."""
    return nullcontext() if _line is None else _line.hidden()


def end() -> None:
    """End the status line, so that a progress bar or a script's output can use the terminal."""
    global _line
    if _line is not None:
        line, _line = _line, None
        line.end()
