"""Progress callbacks see long calls, and can stop them."""

import io
import itertools
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import pytest

import bspcsg as b
from bspcsg import progress_display
from support.cli import Capture


class StopError(Exception):
    """The error that the callback raises."""


def slow() -> b.Solid:
    """Return an expression that takes far longer than a test."""
    ball = b.sphere(1, segments=400)
    return b.union(*[ball.rotate((k, 2 * k, 3 * k)).translate(k / 99, 0, 0) for k in range(1, 60)])


def work_until(done: Callable[[], Any]) -> None:
    """Unite balls, more of them each time, until `done` is true."""
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


class Terminal(io.StringIO):
    """A stand-in for standard error on a terminal."""

    def isatty(self) -> bool:
        return True


def on_terminal(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    """Replace standard error by a terminal, without the delay of the progress bar; return it."""
    found = Terminal()
    monkeypatch.setattr(sys, "stderr", found)
    monkeypatch.setattr(progress_display, "_BAR_DELAY", 0.0)
    return found


# Found: `with progress():` was a TypeError.
def test_a_bar_shows_the_share_of_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)
    with b.progress(of=4, every=0) as step:
        for _ in range(3):
            step()
        assert (step.done, step.share) == (3, 0.75)
    *_, first, second, last = terminal.getvalue().split("\r")
    assert first.startswith("█" * 15 + "░" * 15 + "  50%  2 of 4  ")
    assert second.startswith("█" * 22 + "░" * 8 + "  75%  3 of 4  ")
    assert last.endswith(" s\n") and "75%" in last and terminal.getvalue().count("\n") == 1


def test_without_a_number_the_bar_shows_time(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = on_terminal(monkeypatch)
    with b.progress(every=0.05) as step:
        work_until(terminal.getvalue)
    assert step.share is None and "working …" in terminal.getvalue()


def test_short_work_and_files_have_no_bar(capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    with b.progress(of=1) as step:
        step()
    found = Terminal()
    monkeypatch.setattr(sys, "stderr", found)
    with b.progress(of=1, every=0) as step:
        step()
    assert found.getvalue() == "" and capsys.readouterr() == ("", "")


@pytest.mark.parametrize("given", [{"of": 0}, {"of": -1}, {"of": 1.5}, {"of": "all"}, {"tell": 3}])
def test_bars_of_no_steps_are_refused(given: dict[str, Any]) -> None:
    with pytest.raises(b.InvalidParameterError) as caught, b.progress(**given):
        pass
    assert caught.value.code == "invalid_parameter"
    with b.progress(lambda _: None) as step, pytest.raises(b.InvalidParameterError):
        step(-1)
