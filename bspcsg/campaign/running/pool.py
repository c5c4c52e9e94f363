"""`LocalPool`: answers requests in several child processes at a time."""

import queue
import threading
import time
from collections.abc import Generator, Sequence
from typing import Any, Protocol

from .child import Child, CrashedError, TimedOutError


class RequestHandler(Protocol):
    """A protocol: an object that answers requests, in any order."""

    def answers(
        self, requests: Sequence[Any], seconds: float
    ) -> Generator[tuple[int, Any], None, None]:
        """Yield the index of each request and its answer, as answers arrive.

        If there is no answer, it is a dict with ``failure`` ("timeout" or "crash"), ``reason`` and
        ``seconds``. Closing the iterator stops requests that are still running.
        """
        ...


def answer_of(child: Child, request: Any, seconds: float) -> Any:
    """Return a child's answer to a request, or a dict that describes the timeout or crash."""
    began = time.perf_counter()
    try:
        return child.answer(request, seconds)
    except TimedOutError:
        kind, reason = "timeout", f"stopped after {seconds:g} s"
    except (CrashedError, OSError, ValueError) as error:
        # A process that does not start, or a malformed answer, counts as a crash.
        kind, reason = "crash", str(error)
    spent = round(time.perf_counter() - began, 4)
    return {"failure": kind, "reason": reason, "seconds": spent}


class LocalPool:
    """A pool of child processes on this machine that answer requests.

    Parameters
    ----------
    jobs : int
        The largest number of child processes at a time.
    greeting : dict
        The first line for each child, see `bspcsg.campaign.running.child.Child`.
    """

    def __init__(self, jobs: int, greeting: dict[str, Any]) -> None:
        self._jobs, self._greeting = jobs, greeting

    def answers(
        self, requests: Sequence[Any], seconds: float
    ) -> Generator[tuple[int, Any], None, None]:
        """Yield the index of each request and its answer, as answers arrive."""
        waiting: queue.SimpleQueue[int] = queue.SimpleQueue()
        for number in range(len(requests)):
            waiting.put(number)
        answered: queue.SimpleQueue[tuple[int, Any]] = queue.SimpleQueue()
        stopped = threading.Event()

        def work(child: Child) -> None:
            with child:
                while not stopped.is_set():
                    try:
                        number = waiting.get_nowait()
                    except queue.Empty:
                        return
                    answered.put((number, answer_of(child, requests[number], seconds)))

        children = [Child(self._greeting) for _ in range(min(self._jobs, len(requests)))]
        threads = [threading.Thread(target=work, args=(child,)) for child in children]
        try:
            for thread in threads:
                thread.start()
            for _ in requests:
                yield answered.get()
        finally:
            stopped.set()
            for child in children:
                child.stop()
            for thread in threads:
                if thread.ident is not None:
                    thread.join()
