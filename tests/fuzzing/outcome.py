"""The outcome of a fuzz run: how much was tested, and the findings."""

import resource
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Found:
    """A finding: its kind (crash, wrong, hang, memory), a message, and the path of its input."""

    kind: str
    what: str
    place: str


@dataclass
class Outcome:
    """The outcome of one run of a fuzz target.

    `coverage` has the number of covered edges of the code that libFuzzer counts at the start and at
    the end.
    """

    executions: int = 0
    cpu_seconds: float = 0.0
    coverage: tuple[int, int] | None = None
    found: list[Found] = field(default_factory=list)

    def line(self) -> str:
        """Return the outcome as one line of text."""
        first, last = self.coverage or (0, 0)
        reached = f", coverage {first} → {last}" if self.coverage else ""
        minutes = self.cpu_seconds / 60
        return (
            f"{self.executions} executions, {minutes:.1f} CPU min{reached}, {len(self.found)} found"
        )


class CpuClock:
    """A stopwatch of the processor time of child processes that have ended."""

    def __init__(self) -> None:
        self._start = _children()

    def seconds(self) -> float:
        """Return the processor time since the stopwatch was made, in seconds."""
        return _children() - self._start


def _children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
