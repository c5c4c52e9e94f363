"""A pool that answers requests in child processes, several at a time."""

import queue
import threading
import time
from collections.abc import Generator, Sequence
from typing import Any, Protocol

from .child import Child, CrashedError, TimedOutError


class Answering(Protocol):
    """Something that answers requests in any order."""

    def answers(
        self, requests: Sequence[Any], seconds: float
    ) -> Generator[tuple[int, Any], None, None]:
        """Yield the number of each request and its answer as it arrives.

        A missing answer is replaced by a dict with ``failure`` ("timeout" or "crash"), ``reason``
        and ``seconds``. Closing the iterator stops requests that are still running.
        """
        ...


def answer_of(child: Child, request: Any, seconds: float) -> Any:
    """Return a child's answer, or how the child failed."""
    began = time.perf_counter()
    try:
        return child.answer(request, seconds)
    except TimedOutError:
        kind, reason = "timeout", f"stopped after {seconds:g} s"
    except (CrashedError, OSError, ValueError) as error:
        # Neither a process that does not start nor a malformed answer ends the campaign.
        kind, reason = "crash", str(error)
    spent = round(time.perf_counter() - began, 4)
    return {"failure": kind, "reason": reason, "seconds": spent}


class LocalPool:
    """Children of this process.

    Parameters
    ----------
    jobs : int
        The number of workers at a time.
    greeting : dict
        See `bspcsg.campaign.child.Child`.
    """

    def __init__(self, jobs: int, greeting: dict[str, Any]) -> None:
        self._jobs, self._greeting = jobs, greeting

    def answers(
        self, requests: Sequence[Any], seconds: float
    ) -> Generator[tuple[int, Any], None, None]:
        """Yield the number of each request and its answer as it comes."""
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
