"""Display of the progress of long calls, and their interruption."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ._core import watch
from .parameters import at_least, function_of, not_negative

#: The number of characters of a full progress bar.
_WIDTH = 30

#: The number of seconds after which a progress bar appears.
_BAR_DELAY = 0.5


class Steps:
    """A counter of the steps done in a `progress` block.

    Parameters
    ----------
    of : int or None
        The total number of steps; None if it is unknown.
    """

    def __init__(self, of: int | None = None) -> None:
        self.of = of
        self.done = 0
        self._tell: Callable[[], object] = lambda: None

    def __call__(self, count: int = 1) -> None:
        """Record that one step, or `count` steps, are done."""
        self.done += at_least(0, count, "count")
        self._tell()

    @property
    def share(self) -> float | None:
        """The fraction of all steps that are done, from 0 to 1; None if their number is unknown."""
        return None if not self.of else min(self.done / self.of, 1.0)

    def told_to(self, tell: Callable[[], object]) -> None:
        """Set a function to call after each step."""
        self._tell = tell


class _Bar:
    """A progress bar: a line of standard error that is rewritten repeatedly."""

    def __init__(self, steps: Steps) -> None:
        self._steps = steps
        self._shown = ""
        self._can_go_back = sys.stderr.isatty() or "ipykernel" in sys.modules

    def tell(self, seconds: float) -> None:
        """Write the progress bar in a terminal or notebook, after `_BAR_DELAY` seconds."""
        if self._can_go_back and (self._shown or seconds >= _BAR_DELAY):
            self._put(self._line(seconds))

    def end(self, seconds: float) -> None:
        """Write the final progress bar and a line break, if the bar was written before."""
        if self._shown:
            self._put(self._line(seconds) + "\n")

    def _line(self, seconds: float) -> str:
        steps, share = self._steps, self._steps.share
        counted = f"  {steps.done}" if steps.done else ""
        if share is None:
            return f"working …{counted}  {seconds:.1f} s"
        filled = int(share * _WIDTH)
        bar = "█" * filled + "░" * (_WIDTH - filled)
        return f"{bar} {share:4.0%}{counted or '  0'} of {steps.of}  {seconds:.1f} s"

    def _put(self, line: str) -> None:
        rest = " " * max(len(self._shown) - len(line), 0)
        sys.stderr.write(f"\r{line.rstrip()}{rest}{line[len(line.rstrip()) :]}")
        sys.stderr.flush()
        self._shown = line


@contextmanager
def progress(
    tell: Callable[[float], object] | None = None, *, every: float = 0.1, of: int | None = None
) -> Iterator[Steps]:
    """Show a progress bar while operations run in a ``with`` block, or call a function repeatedly.

    Parameters
    ----------
    tell : callable, optional
        The function to call instead of writing the bar, with the seconds since the block began. An
        exception that it raises stops the running operation soon, and is raised from it; the solids
        are unchanged.
    every : float
        The least number of seconds between two calls, which are made in the thread that opened the
        block.
    of : int, optional
        The number of steps in the block, to display the share that is done.

    Yields
    ------
    callable
        A function to call after each step, with the attributes `done`, the number of steps done,
        and `share`.

    Notes
    -----
    The bar is written to standard error, in terminals and notebooks. It contains the seconds, and
    the share if `of` is given. No bar appears for work of less than half a second.

    Another thread can stop an operation through an object that `tell` checks, such as a
    `threading.Event`. Operations that `tell` itself starts are not watched. Work outside the core,
    such as manifold3d's when a result is validated, is not interrupted.

    Examples
    --------
    >>> import bspcsg as csg
    >>> parts = [csg.cube(2) - csg.sphere(size) for size in (1, 1.2)]
    >>> with csg.progress(of=len(parts)) as step:
    ...     for part in parts:
    ...         print(part.volume < 8)
    ...         step()
    True
    True
    >>> def patient(seconds):
    ...     if seconds > 60:
    ...         raise TimeoutError("this takes too long")
    >>> with csg.progress(patient):
    ...     (csg.cube(2) - csg.sphere(1)).volume < 8
    True
    """
    steps = Steps(None if of is None else at_least(1, of, "of"))
    bar = _Bar(steps)
    told = bar.tell if tell is None else function_of(tell, "tell")
    pause, began = not_negative(every, "every"), time.monotonic()
    paced = _PacedCall(told, pause, began)
    steps.told_to(paced)
    before = watch(paced)
    try:
        yield steps
    finally:
        watch(before)
        if tell is None:
            bar.end(time.monotonic() - began)


class _PacedCall:
    """A wrapper that drops calls within `pause` seconds of the last call, or during a call."""

    def __init__(self, told: Callable[[float], object], pause: float, began: float) -> None:
        self._told, self._pause, self._began = told, pause, began
        self._last = began
        self._is_told = False

    def __call__(self) -> None:
        now = time.monotonic()
        if self._is_told or now - self._last < self._pause:
            return
        self._last, self._is_told = now, True
        try:
            self._told(now - self._began)
        finally:
            self._is_told = False
