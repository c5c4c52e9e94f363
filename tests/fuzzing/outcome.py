"""The work and the findings of fuzzing."""

import resource
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Found:
    """Something wrong: its kind (crash, wrong, hang, memory), words, and where its input lies."""

    kind: str
    what: str
    place: str


@dataclass
class Outcome:
    """The outcome of one run of a target.

    `coverage` is what libFuzzer counts at the end and counted at the beginning: edges of the
    instrumented code that inputs have reached.
    """

    executions: int = 0
    cpu_seconds: float = 0.0
    coverage: tuple[int, int] | None = None
    found: list[Found] = field(default_factory=list)

    def line(self) -> str:
        """Return one line for people."""
        first, last = self.coverage or (0, 0)
        reached = f", coverage {first} → {last}" if self.coverage else ""
        minutes = self.cpu_seconds / 60
        return (
            f"{self.executions} executions, {minutes:.1f} CPU min{reached}, {len(self.found)} found"
        )


class CpuClock:
    """The processor time of children that have ended, since it was made."""

    def __init__(self) -> None:
        self._start = _children()

    def seconds(self) -> float:
        """Return the seconds."""
        return _children() - self._start


def _children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
