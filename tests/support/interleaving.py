"""Two threads on one object, one of which comes between two lines of the other.

Where threads change over is up to chance. Here one is traced, and the other's whole work is done at
one of its lines; so all places can be tried.
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
    """A tracer that calls something before the line of this number is carried out."""

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
    """Yield what both find at an object, for each line of our code at which the second may come."""
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
