"""Child processes that end when this process ends, also if it is killed.

Run as a script, ``processes.py PIPE PROGRAM ARGUMENT…`` becomes such a child and runs the program.
Then it imports nothing of this package.
"""

import contextlib
import os
import select
import signal
import sys
import threading
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import subprocess

#: The Linux option by which a process is killed when the thread that started it ends (prctl(2)).
_PARENT_DEATH_SIGNAL = 1


@contextlib.contextmanager
def parent_pipe() -> Iterator[tuple[int, ...]]:
    """Yield the file descriptors to pass to a child, so that it notices the end of this process.

    The tuple is empty on systems other than POSIX.
    """
    if os.name != "posix":
        yield ()
        return
    reader, writer = os.pipe()
    try:
        yield (reader,)
    finally:
        os.close(reader)
        os.close(writer)


def end_with_parent(pipe: int | None = None) -> None:
    """Have this process killed when its parent ends, or at once if the parent has already ended.

    Parameters
    ----------
    pipe : int, optional
        The read end of a pipe to which only the parent can write; without it nothing is done. On
        Linux, the thread that started this process must wait until it ends.
    """
    if pipe is None:
        return
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(_PARENT_DEATH_SIGNAL, signal.SIGKILL)
    else:
        threading.Thread(target=_end_without_writer, args=(pipe, None), daemon=True).start()
    _end_without_writer(pipe, 0)


def _end_without_writer(pipe: int, patience: int | None) -> None:
    waiting = select.poll()
    waiting.register(pipe, 0)
    if waiting.poll(patience):
        os.kill(os.getpid(), signal.SIGKILL)


def run_program(
    command: Sequence[str], timeout: float | None, environment: Mapping[str, str] | None = None
) -> "subprocess.CompletedProcess[str]":
    """Run a program to its end, and return its output and exit code.

    On Linux the program is killed if this process ends first.

    Raises
    ------
    subprocess.TimeoutExpired
        If the program takes longer than `timeout` seconds.
    """
    import subprocess

    with parent_pipe() as read_by_child:
        start: list[str] = []
        if sys.platform == "linux":
            # The setting to be killed with the parent persists when the program is exchanged.
            start = [sys.executable, "-I", "-S", __file__, *map(str, read_by_child)]
        return subprocess.run(
            [*start, *command],
            capture_output=True,
            text=True,
            encoding="utf-8",
            errors="replace",
            timeout=timeout,
            env=environment,
            check=False,
            pass_fds=read_by_child,
        )


def _become(pipe: int, command: list[str]) -> None:
    end_with_parent(pipe)
    os.close(pipe)
    os.execvp(command[0], command)


if __name__ == "__main__":
    _become(int(sys.argv[1]), sys.argv[2:])
