"""Long calls that can be watched and stopped."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ._core import watch
from .parameters import at_least, function_of, not_negative

#: The number of characters of a full bar.
_WIDTH = 30

#: A bar appears after this many seconds: short work needs none.
_BAR_DELAY = 0.5


class Steps:
    """The steps done in a block, of a total that may be known.

    Parameters
    ----------
    of : int or None
        The number of all steps; None if nobody knows.
    """

    def __init__(self, of: int | None = None) -> None:
        self.of = of
        self.done = 0
        self._tell: Callable[[], object] = lambda: None

    def __call__(self, count: int = 1) -> None:
        """Record that a step is done, or so many of them."""
        self.done += at_least(0, count, "count")
        self._tell()

    @property
    def share(self) -> float | None:
        """The share of the steps that are done, from 0 to 1; None if nobody knows."""
        return None if not self.of else min(self.done / self.of, 1.0)

    def told_to(self, tell: Callable[[], object]) -> None:
        """Set a function to call after each step."""
        self._tell = tell


class _Bar:
    """One line of standard error, rewritten again and again."""

    def __init__(self, steps: Steps) -> None:
        self._steps = steps
        self._shown = ""
        self._can_go_back = sys.stderr.isatty() or "ipykernel" in sys.modules

    def tell(self, seconds: float) -> None:
        """Write the line if a terminal or notebook shows it and the delay has passed."""
        if self._can_go_back and (self._shown or seconds >= _BAR_DELAY):
            self._put(self._line(seconds))

    def end(self, seconds: float) -> None:
        """Write the line a last time, and leave it there."""
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
    """Show a bar while operations run in a ``with`` block, or call a function, which may stop them.

    Parameters
    ----------
    tell : callable, optional
        Called with the seconds since the block began, instead of the bar. An exception that it
        raises stops the operation soon, and is raised from the call that was running; the solids
        are unchanged.
    every : float
        The least number of seconds between two calls, which are made in the thread that opened the
        block.
    of : int, optional
        The number of steps in the block, for a share of work done.

    Yields
    ------
    callable
        Call it after each step; it has the steps that are `done`, and their `share`.

    Notes
    -----
    The bar is written to standard error, in terminals and notebooks. It shows the seconds, and the
    share if `of` is given. Work of less than half a second shows no bar.

    Another thread can stop an operation through something that `tell` checks, such as a
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
    """Calls a function at intervals, and never while it runs already."""

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
