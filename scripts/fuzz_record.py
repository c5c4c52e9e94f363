"""The work and the findings of fuzzing, and the record that adds them up."""

import json
import resource
from dataclasses import dataclass, field
from typing import Any

from recording import RECORDS, machine

#: The kinds of findings.
KINDS = ("crash", "wrong", "hang", "memory")


@dataclass(frozen=True)
class Found:
    """Something wrong: of which kind, in words, and where its input lies."""

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


def add_to_record(target: str, seed: int, outcome: Outcome) -> None:
    """Add a run to `scripts/records/fuzz.json`; runs of one commit and seed are one row."""
    path = RECORDS / "fuzz.json"
    record: dict[str, Any] = (
        json.loads(path.read_text("utf-8")) if path.is_file() else {"targets": {}}
    )
    rows = record["targets"].setdefault(target, [])
    here = machine()
    same = {"commit": here["commit"], "seed": seed}
    row = next((row for row in rows if all(row[key] == same[key] for key in same)), None)
    if row is None:
        row = {
            **same,
            "machine": here,
            "executions": 0,
            "cpu_minutes": 0.0,
            **dict.fromkeys(KINDS, 0),
        }
        rows.append(row)
    row["executions"] += outcome.executions
    row["cpu_minutes"] = round(row["cpu_minutes"] + outcome.cpu_seconds / 60, 2)
    if outcome.coverage is not None:
        row["coverage"] = outcome.coverage[1]
    for each in outcome.found:
        row[each.kind] += 1
    RECORDS.mkdir(exist_ok=True)
    path.write_text(json.dumps(record, indent=1) + "\n")


def cpu_hours() -> dict[str, float]:
    """Return the processor time of all runs of each target."""
    return {
        target: round(sum(row["cpu_minutes"] for row in rows) / 60, 2)
        for target, rows in _recorded()
    }


def _recorded() -> list[tuple[str, list[dict[str, Any]]]]:
    """Return the targets by name, with the rows of their runs."""
    record = json.loads((RECORDS / "fuzz.json").read_text("utf-8"))
    return sorted(record["targets"].items())


def totals() -> list[str]:
    """Return a line for each target: what all its runs add up to."""
    lines = []
    for target, rows in _recorded():
        executions, hours = (sum(row[key] for row in rows) for key in ("executions", "cpu_minutes"))
        found = sum(row[kind] for row in rows for kind in KINDS)
        lines.append(
            f"{target:9} {executions:9} executions, {hours / 60:5.2f} CPU h, {found} found"
        )
    return lines
