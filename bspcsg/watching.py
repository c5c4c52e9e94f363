"""Long calls that can be watched and stopped."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ._core import watch
from .parameters import function_of, not_negative


@contextmanager
def progress(tell: Callable[[float], object], *, every: float = 0.1) -> Iterator[None]:
    """Call a function while operations run in a ``with`` block, which may stop them.

    Parameters
    ----------
    tell : callable
        Is given the seconds since the block began. An exception that it raises ends the operation
        soon, and comes out of the call that was under way; the solids are as they were before it.
    every : float
        Seconds between two calls, at least; they come from the thread that opened the block.

    Notes
    -----
    Other threads stop an operation by what `tell` looks at, such as a `threading.Event`. Operations
    that `tell` starts itself are not watched. What happens outside the core, as in manifold3d while
    a result is validated, is not interrupted.

    Examples
    --------
    >>> import bspcsg as csg
    >>> def patient(seconds):
    ...     if seconds > 60:
    ...         raise TimeoutError("this takes too long")
    >>> with csg.progress(patient):
    ...     (csg.cube(2) - csg.sphere(1)).volume < 8
    True
    """
    told, pause = function_of(tell, "tell"), not_negative(every, "every")
    began = last = time.monotonic()
    is_told = False

    def look() -> None:
        nonlocal last, is_told
        now = time.monotonic()
        if is_told or now - last < pause:
            return
        last, is_told = now, True
        try:
            told(now - began)
        finally:
            is_told = False

    before = watch(look)
    try:
        yield
    finally:
        watch(before)
