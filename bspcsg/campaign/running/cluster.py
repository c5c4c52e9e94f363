"""`Cluster`: answers from the workers of Dask distributed, each with child processes.

Dask neither limits the time of a task nor survives a crash of its worker. So a task only passes a
request to a child process and waits, as `bspcsg.campaign.running.pool` does on one machine.
"""

import json
import threading
import time
from collections.abc import Generator, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ...errors import MissingPartError, missing_part
from .child import Child
from .pool import answer_of

#: The time limit for reaching a scheduler, and for a scheduler to have a worker, in seconds.
_TIMEOUT = 30

#: The time between two checks for answers, in seconds.
_POLL_INTERVAL = 0.05

_children: dict[tuple[int, str], Child] = {}
_lock = threading.Lock()


def answer_on_worker(request: Any, greeting: str, seconds: float) -> Any:
    """Return the answer to a request from the current thread's child process, on a worker."""
    key = threading.get_ident(), greeting
    with _lock:
        if key not in _children:
            _children[key] = Child(json.loads(greeting))
        child = _children[key]
    return answer_of(child, request, seconds)


def stop_children() -> None:
    """Stop all child processes of this worker."""
    with _lock:
        children = list(_children.values())
        _children.clear()
    for child in children:
        child.stop()


class Cluster:
    """The workers of a Dask scheduler, which answer requests.

    Parameters
    ----------
    scheduler : str
        The address of the scheduler, such as ``tcp://host:8786``, or the path of its JSON file.
    greeting : dict
        The first line for each worker, see `bspcsg.campaign.running.child.Child`.

    Raises
    ------
    MissingPartError
        If distributed is not installed.
    """

    def __init__(self, scheduler: str, greeting: dict[str, Any]) -> None:
        if find_spec("distributed") is None:
            remedy = 'pip install "bspcsg[cluster]"'
            raise missing_part("distributed", "for --scheduler", remedy)
        self._scheduler, self._greeting = scheduler, json.dumps(greeting)

    def answers(
        self, requests: Sequence[Any], seconds: float
    ) -> Generator[tuple[int, Any], None, None]:
        """Yield the index of each request and its answer, as answers arrive.

        Raises
        ------
        MissingPartError
            If the scheduler cannot be reached (code "no_scheduler"), or has no worker for 30
            seconds (code "no_workers").
        """
        import distributed

        # Dask has no types.
        as_completed: Any = distributed.as_completed
        client = self._client()
        numbers = {}
        try:
            for number, request in enumerate(requests):
                place = (answer_on_worker, request, self._greeting, seconds)
                numbers[client.submit(*place, pure=False)] = number
            completed = as_completed(list(numbers), loop=client.loop)
            while not completed.is_empty():
                self._await_one(completed, client)
                future = next(completed)
                yield numbers[future], _result_of(future)
        finally:
            client.cancel(list(numbers), force=True)
            client.run(stop_children)
            client.close()

    def _await_one(self, completed: Any, client: Any) -> None:
        """Wait until an answer arrives; raise an error if there are no workers for a while."""
        seen = looked = time.monotonic()
        while not completed.has_ready():
            time.sleep(_POLL_INTERVAL)
            now = time.monotonic()
            if now - looked >= _TIMEOUT / 10:
                looked = now
                seen = now if client.nthreads() else seen
            if now - seen >= _TIMEOUT:
                message = f"{self._scheduler}: this scheduler has no workers."
                advice = "Start Dask workers, and continue with --results FILE --resume."
                raise MissingPartError(f"{message} {advice}", "no_workers")

    def _client(self) -> Any:
        import distributed

        client: Any = distributed.Client
        is_file = Path(self._scheduler).is_file()
        place = {"scheduler_file": self._scheduler} if is_file else {"address": self._scheduler}
        try:
            return client(**place, timeout=_TIMEOUT, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            message = (
                f"{self._scheduler}: no Dask scheduler answers at this address ({error}); start"
                " one, or correct --scheduler."
            )
            raise MissingPartError(message, "no_scheduler") from error


def _result_of(future: Any) -> Any:
    """Return the answer of a task, or a crash as an answer if its worker was lost."""
    try:
        return future.result()
    except Exception as error:
        reason = f"the worker was lost: {type(error).__name__}: {error}"
        return {"failure": "crash", "reason": reason, "seconds": 0.0}
