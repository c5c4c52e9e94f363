"""Run two threads on one object so that one interrupts the other at any line.

Usually chance decides where threads switch. Here the first function is traced, and the whole second
function runs at one of its lines; so all lines can be tried.
"""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType
from typing import Any, TypeVar

import bspcsg

_PACKAGE = str(Path(bspcsg.__file__).parent)

_First = TypeVar("_First")
_Second = TypeVar("_Second")


class _Between:
    """A trace function that calls `call` before the line with this number is executed."""

    def __init__(self, line: int, call: Callable[[], None]) -> None:
        self._left = line
        self._call = call

    def __call__(self, frame: FrameType, event: str, argument: Any) -> Any:
        return self._of_lines if frame.f_code.co_filename.startswith(_PACKAGE) else None

    def _of_lines(self, frame: FrameType, event: str, argument: Any) -> Any:
        if event == "line":
            self._left -= 1
            if self._left == -1:
                sys.settrace(None)
                self._call()
        return self._of_lines

    @property
    def has_called(self) -> bool:
        return self._left < 0


def interleaved(
    make: Callable[[], Any],
    first: Callable[[Any], _First],
    second: Callable[[Any], _Second],
) -> Iterator[tuple[_First, _Second]]:
    """Yield the results of both functions on an object, for each line at which `second` can run."""
    before, line = sys.gettrace(), 0
    while True:
        shared = make()
        found: list[_Second] = []

        def come(shared: Any = shared, found: list[_Second] = found) -> None:
            found.append(second(shared))

        between = _Between(line, come)
        sys.settrace(between)
        try:
            ours = first(shared)
        finally:
            sys.settrace(before)
        if not between.has_called:
            return
        yield ours, found[0]
        line += 1
