"""Run a command and print its use of time and memory: ``meter.py COMMAND...``.

It is a process of its own, because Linux counts the memory of a parent at the start of a child to
the child's peak; so the parent must be small.
"""

import json
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path


@dataclass(frozen=True)
class Usage:
    """The time and memory used by a process and the processes that it started.

    Parameters
    ----------
    seconds, cpu : float
        Wall-clock time, and processor time of all threads, in seconds.
    peak_mb : float
        The peak memory of the largest of the processes, in 10^6 bytes.
    code : int
        The exit code of the process.
    said : str
        The last line on standard error.
    """

    seconds: float
    cpu: float
    peak_mb: float
    code: int
    said: str


def run_metered(command: Sequence[str]) -> Usage:
    """Run a command, and return the time and memory that it used."""
    meter = [sys.executable, str(Path(__file__)), *command]
    done = subprocess.run(meter, capture_output=True, check=True)
    return Usage(**json.loads(done.stdout))


def _run(command: Sequence[str]) -> Usage:
    import resource

    began = time.perf_counter()
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, check=False)
    seconds = time.perf_counter() - began
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    lines = done.stderr.decode("utf-8", "replace").splitlines()
    return Usage(
        seconds=seconds,
        cpu=used.ru_utime + used.ru_stime,
        peak_mb=used.ru_maxrss * 1024 / 1e6,
        code=done.returncode,
        said=lines[-1] if lines else "",
    )


if __name__ == "__main__":
    sys.stdout.write(json.dumps(asdict(_run(sys.argv[1:]))))
