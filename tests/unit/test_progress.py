"""Long calls are watched, and stopped by what watches them."""

import itertools
import threading
import time
from collections.abc import Callable
from typing import Any

import pytest

import bspcsg as b


class StopError(Exception):
    """The error that the caller raises."""


def slow() -> b.Solid:
    """Return an expression that takes far longer than a test waits."""
    ball = b.sphere(1, segments=400)
    return b.union(*[ball.rotate((k, 2 * k, 3 * k)).translate(k / 99, 0, 0) for k in range(1, 60)])


def work_until(done: Callable[[], Any]) -> None:
    """Unite balls, more of them each time, until something is true."""
    ball = b.sphere(1, segments=300)
    for count in itertools.count(2):
        b.union(*[ball.translate(k / 7, k / 9, 0) for k in range(count)]).to_mesh()
        if done():
            return


# Found: booleans said nothing for minutes.
# Found: calls told no progress and could not be stopped.
def test_long_calls_tell_how_long_they_take() -> None:
    told: list[float] = []
    with b.progress(told.append, every=0.05):
        work_until(lambda: told)
    assert told == sorted(told)
    assert all(later - earlier >= 0.05 for earlier, later in itertools.pairwise(told))


def test_what_is_raised_ends_the_call_and_spares_the_solids() -> None:
    whole = slow()

    def impatient(seconds: float) -> None:
        if seconds > 0.2:
            raise StopError

    began = time.monotonic()
    with b.progress(impatient), pytest.raises(StopError):
        whole.to_mesh()
    assert time.monotonic() - began < 20
    assert "pending" in repr(whole)
    part = b.cube(2) - b.cube(1)
    assert part.volume == 7


def test_other_threads_stop_a_call() -> None:
    stop = threading.Event()

    def look(_: float) -> None:
        if stop.is_set():
            raise StopError

    threading.Timer(0.3, stop.set).start()
    with b.progress(look), pytest.raises(StopError):
        slow().to_mesh()


def test_watching_ends_with_the_block() -> None:
    told: list[float] = []
    with b.progress(told.append), b.progress(lambda _: None):
        pass
    with pytest.raises(StopError), b.progress(told.append):
        raise StopError
    count = len(told)
    (b.sphere(1, segments=400) & b.sphere(1, segments=400).translate(0.1, 0, 0)).to_mesh()
    assert len(told) == count


def test_what_watches_may_use_the_library() -> None:
    volumes: list[float] = []
    with b.progress(lambda _: volumes.append((b.cube(2) - b.cube(1)).volume), every=0):
        work_until(lambda: volumes)
    assert set(volumes) == {7.0}
