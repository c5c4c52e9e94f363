"""`Child`: a worker process that can be killed, so that its failures do not harm the runner."""

import json
import os
import queue
import signal
import subprocess
import sys
import tempfile
import threading
from contextlib import suppress
from pathlib import Path
from typing import Any, Self

from ...errors import not_none

#: The time limit for a worker to start, in seconds. Importing the package takes a quarter of a
#: second on an idle machine and a hundred times as long on an overloaded one.
_START_TIMEOUT = 300.0

#: The time limit for a process to end after it has closed its output, in seconds.
_EXIT_TIMEOUT = 5.0


_BOOT = Path(__file__).with_name("start_worker.py")


class TimedOutError(Exception):
    """The worker did not answer within the time limit and was killed."""


class CrashedError(Exception):
    """The worker process ended without an answer; the message has its last line of output."""


class Child:
    """A worker process (see `worker`), started on first use and again after each crash.

    Parameters
    ----------
    greeting : dict
        The first line that is sent to the worker: ``settings``, ``memory`` in bytes or None,
        ``threads``.
    """

    def __init__(self, greeting: dict[str, Any]) -> None:
        self._greeting = greeting
        self._process: subprocess.Popen[str] | None = None
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._said = tempfile.TemporaryFile()  # noqa: SIM115
        self._lock = threading.Lock()
        self._stopped = False

    def __enter__(self) -> Self:
        """Return the child itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """Stop the process."""
        self.stop()

    def answer(self, request: dict[str, Any], seconds: float) -> Any:
        """Send a request to the worker and return its answer.

        Raises
        ------
        TimedOutError
            If no answer arrives within `seconds`.
        CrashedError
            If the process ends before it answers.
        """
        try:
            process = self._running()
            requests = not_none(process.stdin, "the process's input")
            requests.write(json.dumps(request) + "\n")
            requests.flush()
            line = self._lines.get(timeout=seconds)
        except queue.Empty:
            self._kill()
            raise TimedOutError from None
        except OSError:  # it ended while the request was sent
            line = ""
        if not line:
            raise CrashedError(self._buried())
        return json.loads(line)

    def stop(self) -> None:
        """End the process and start no other; a pending request is not answered."""
        with self._lock:
            self._stopped = True
        self._kill()
        with self._lock:
            self._said.close()

    def _running(self) -> "subprocess.Popen[str]":
        with self._lock:
            if self._stopped:
                raise CrashedError("stopped")
            fresh = self._process is None
            if self._process is None:
                self._process = self._started()
            process = self._process
        if fresh:
            self._await_start()
        return process

    def _started(self) -> "subprocess.Popen[str]":
        self._lines = queue.SimpleQueue()
        self._said.seek(0)
        self._said.truncate()
        process = subprocess.Popen(
            [sys.executable, "-P", os.fspath(_BOOT)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._said,
            env=_environment(),
            text=True,
            encoding="utf-8",
            # A new process group: killing it ends the worker's own children, and Ctrl-C does not
            # reach it.
            start_new_session=os.name == "posix",
        )
        listener = threading.Thread(target=_listen, args=(process, self._lines), daemon=True)
        listener.start()
        requests = not_none(process.stdin, "the process's input")
        requests.write(json.dumps(self._greeting) + "\n")
        requests.flush()
        return process

    def _await_start(self) -> None:
        """Wait until the worker has imported its modules, which no case's time includes."""
        try:
            if not self._lines.get(timeout=_START_TIMEOUT):
                raise CrashedError(self._buried())
        except queue.Empty:
            self._kill()
            raise CrashedError(f"the process did not start within {_START_TIMEOUT:g} s") from None

    def _buried(self) -> str:
        """Return how the process ended, with its last line of output, and forget the process."""
        process, code = self._process, None
        if process is not None:
            try:
                code = process.wait(_EXIT_TIMEOUT)
            except subprocess.TimeoutExpired:
                code = None
        self._kill()
        with self._lock:
            if self._stopped:
                return "stopped"
            self._said.seek(0)
            said = self._said.read().decode("utf-8", "replace")
        last = [line.strip() for line in said.splitlines() if line.strip()][-1:]
        return ": ".join([_exit_description(code), *last])

    def _kill(self) -> None:
        with self._lock:
            process, self._process = self._process, None
        if process is None:
            return
        if os.name == "posix":
            # The process group may have ended already.
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
        process.wait()
        # Closing fails if buffered requests cannot be sent.
        with suppress(OSError):
            not_none(process.stdin, "the process's input").close()


def _exit_description(code: int | None) -> str:
    if code is not None and code < 0:
        return f"the process was ended by the signal {signal.Signals(-code).name}"
    return f"the process ended with exit code {code}"


def _listen(process: "subprocess.Popen[str]", lines: "queue.SimpleQueue[str]") -> None:
    """Put the lines of a process's output into a queue, and an empty one at its end."""
    with not_none(process.stdout, "the process's output") as answers:
        for line in answers:
            lines.put(line)
    lines.put("")


def _environment() -> dict[str, str]:
    """Return the environment variables with which the child imports this same package."""
    home = str(Path(__file__).parents[3])
    paths = [home, *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in paths if path)}
