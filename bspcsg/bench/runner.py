"""Run benchmark cases in child processes with a time limit for each call, and collect results."""

import json
import os
import select
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from ..errors import not_none
from ..machine import machine
from .case import BenchCase
from .cases import CASES
from .engines import ENGINES
from .targets import MAIN_RIVAL, OURS
from .worker import Task

#: The time limit for making operands before the first call, and for ending after the last call, in
#: seconds.
_GRACE_SECONDS = 120.0

_PACKAGE = Path(__file__).resolve().parents[1]

_BOOT = Path(__file__).with_name("start_worker.py")


@dataclass(frozen=True)
class Settings:
    """The settings of a benchmark run.

    Parameters
    ----------
    engines : sequence of str
        The names of the engines to time, in the cases that include them.
    runs : int
        The number of timed runs of each engine.
    small : bool
        True to time the small items of the cases.
    limit : float or None
        The time limit of one call, in seconds; None for the limit of the case.
    budget : float
        The time for all runs of an engine on an item, in seconds.
    shared : Path
        The folder of shared data.
    core : Path or None
        The path of another build of the compiled core; None for the installed one.
    memory_gb : float
        The address space of a worker, in 2^30 bytes; 0 for no limit.
    steps : int
        The number of steps of the case "dome"; 0 for all.
    """

    engines: Sequence[str]
    runs: int = 5
    small: bool = False
    limit: float | None = None
    budget: float = 150.0
    shared: Path = Path("../shared")
    core: Path | None = None
    memory_gb: float = 12.0
    steps: int = 0


#: A function that is called with a line of text about the current work.
Progress = Callable[[str], None]


def run_case(key: str, settings: Settings, progress: Progress) -> dict[str, Any]:
    """Run one case, and return its row of the record."""
    case = CASES[key]
    if case.needs and not (settings.shared / case.needs).exists():
        missing = f"{settings.shared / case.needs} does not exist"
        return {"case": key, "title": case.title, "left_out": missing, "items": []}
    too_large = _too_large(case, settings)
    asked = case.labels(settings.shared, small=settings.small)
    labels = [label for label in asked if label not in too_large]
    items = [_item(key, label, settings, progress) for label in labels]
    # Targets do not apply to a partial run.
    small = settings.small or _is_cut(key, settings)
    row = {"case": key, "title": case.title, "small": small, "items": items}
    return row | {"too_large": too_large} if too_large else row


def _too_large(case: BenchCase, settings: Settings) -> dict[str, str]:
    """Return why items need more memory than this machine has, by the item's label."""
    has = machine()["memory_gb"]
    return {
        label: f"needs {needed:g} GB of memory, this machine has {has:g}"
        for label, needed in case.needs_gb.items()
        if has and needed > has and label in (case.small if settings.small else case.items)
    }


def _is_cut(key: str, settings: Settings) -> bool:
    return key == "dome" and settings.steps > 0


def _item(key: str, label: str, settings: Settings, progress: Progress) -> dict[str, Any]:
    case = CASES[key]
    taking_part = [name for name in settings.engines if not case.engines or name in case.engines]
    task = Task(
        case=key,
        item=label,
        small=settings.small,
        engines=taking_part,
        runs=settings.runs,
        budget=settings.budget,
        shared=str(settings.shared),
        cores=case.cores,
        memory_gb=_bound_of_memory(case, label, settings),
        steps=settings.steps,
    )
    gathered = Gathered(f"{settings.steps} steps" if _is_cut(key, settings) else label)
    for part in _parts(case, task):
        _until_done(part, settings, gathered, progress)
    row = gathered.row()
    if case.checked_at_once and not _checked(row):
        row["at_once"] = _rival_at_once(task, settings, progress)
    return row if case.other_sets else with_volumes_compared(row)


def _bound_of_memory(case: BenchCase, label: str, settings: Settings) -> float:
    """Return the limit of a worker's address space in 2^30 bytes, enough for this item."""
    if not settings.memory_gb:
        return 0.0
    return max(settings.memory_gb, case.needs_gb.get(label, 0.0) * 1e9 / 2**30)


def _parts(case: BenchCase, task: Task) -> list[Task]:
    """Return one task for all engines, or one task for each engine if the case runs them alone."""
    if not case.alone:
        return [task]
    return [replace(task, engines=[name]) for name in task.engines]


def _checked(row: dict[str, Any]) -> bool:
    return any("facts" in found for name, found in row["engines"].items() if name != OURS)


def _rival_at_once(task: Task, settings: Settings, progress: Progress) -> dict[str, Any]:
    """Return the main rival's result for a chain, computed as one expression."""
    gathered = Gathered(task.item)
    asked = replace(task, engines=[MAIN_RIVAL], runs=0, at_once=True, cores=0)
    _until_done(asked, settings, gathered, progress)
    found: dict[str, Any] = gathered.row()["engines"].get(MAIN_RIVAL, {})
    return found


def _until_done(task: Task, settings: Settings, gathered: "Gathered", progress: Progress) -> None:
    """Run workers until each engine is done or has failed, as by crashing its worker."""
    engines = list(task.engines)
    while engines:
        culprit = _run_worker(replace(task, engines=engines), settings, gathered, progress)
        if culprit is None:
            return
        gathered.forget_unfinished(engines, culprit)
        engines = [name for name in engines if not gathered.is_over(name)]


def _run_worker(
    task: Task, settings: Settings, gathered: "Gathered", progress: Progress
) -> str | None:
    """Run one worker; return the engine at whose call it ended too early, or None."""
    limit = CASES[task.case].limit if settings.limit is None else settings.limit
    core = str(settings.core.resolve()) if settings.core else ""
    command = [sys.executable, "-P", str(_BOOT), str(_PACKAGE.parent), core]
    with (
        TemporaryDirectory(ignore_cleanup_errors=True) as scratch,
        subprocess.Popen(
            [*command, json.dumps(asdict(task))],
            stdout=subprocess.PIPE,
            # Engines may write anything to stderr; the worker reports errors on stdout.
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONHASHSEED": "0", "TMPDIR": scratch},
        ) as child,
    ):
        try:
            under_way, reason = _read_reports(child, task, limit, gathered, progress)
        finally:
            child.kill()
    if reason is None:
        return None
    gathered.ended(under_way or task.engines[0], reason)
    return under_way or task.engines[0]


def _read_reports(
    child: "subprocess.Popen[bytes]",
    task: Task,
    limit: float,
    gathered: "Gathered",
    progress: Progress,
) -> tuple[str | None, dict[str, Any] | None]:
    """Read a worker's output; return the engine it was running and its failure, each or None."""
    lines = _LineReader(child)
    under_way, began = None, time.monotonic()
    while True:
        line = lines.next(began + (limit if under_way else _GRACE_SECONDS + limit))
        if line is None:
            return under_way, {"state": "stopped", "stopped_after": time.monotonic() - began}
        if not line:
            reason = f"the process ended with code {child.wait()}"
            return under_way, {"state": "crashed", "reason": reason}
        said = json.loads(line)
        gathered.take(said)
        if said["say"] == "end":
            return None, None
        if said["say"] == "begin":
            under_way, began = said["engine"], time.monotonic()
            progress(f"{task.case}, {task.item}: {under_way}")
        elif said["say"] in ("run", "failed"):
            under_way, began = None, time.monotonic()


class _LineReader:
    """Reads the output of a process line by line, with deadlines."""

    def __init__(self, child: "subprocess.Popen[bytes]") -> None:
        self._descriptor = not_none(child.stdout, "the process's output").fileno()
        self._waiting = b""

    def next(self, deadline: float) -> bytes | None:
        """Return the next line, b"" at the end of the output, or None after the deadline."""
        while b"\n" not in self._waiting:
            left = deadline - time.monotonic()
            if left <= 0 or not select.select([self._descriptor], [], [], left)[0]:
                return None
            chunk = os.read(self._descriptor, 1 << 16)
            if not chunk:
                return b""
            self._waiting += chunk
        line, _, self._waiting = self._waiting.partition(b"\n")
        return line


class Gathered:
    """Collects what workers report about one item."""

    def __init__(self, label: str) -> None:
        self._label = label
        self._extent: dict[str, Any] = {}
        self._engines: dict[str, dict[str, Any]] = {}

    def take(self, message: dict[str, Any]) -> None:
        """Store one report of a worker."""
        if message["say"] == "extent":
            self._extent = {name: message[name] for name in ("area", "size", "triangles", "names")}
        elif message["say"] == "plan":
            self._of(message)["planned"] = message["runs"]
        elif message["say"] == "run":
            self._add_run(self._of(message), message)
        elif message["say"] == "step":
            self._of(message)["steps_done"] = message["done"]
        elif message["say"] == "failed":
            self._of(message).update(state="failed", reason=message["reason"])

    def _of(self, message: dict[str, Any]) -> dict[str, Any]:
        return self._engines.setdefault(message["engine"], _empty_result())

    def _add_run(self, found: dict[str, Any], message: dict[str, Any]) -> None:
        found["seconds"].append(message["seconds"])
        found["cpu_seconds"].append(message["cpu"])
        found["memory_mb"] = max(found["memory_mb"], message["memory_mb"] or 0.0)
        found["peak_mb"] = max(found.get("peak_mb", 0.0), message["peak_mb"])
        found.setdefault("volumes", []).append(message["facts"]["volume"])
        found.setdefault("faults_each", []).append(message.get("faults", 0))
        for name in ("parts", "windows", "counters", "facts", "answer_mb", "steps", "proof"):
            if name in message:
                found[name] = message[name]

    def ended(self, engine: str, reason: dict[str, Any]) -> None:
        """Store that the worker ended during a call of this engine."""
        self._engines.setdefault(engine, _empty_result()).update(reason)

    def is_over(self, engine: str) -> bool:
        """Return true if an engine has failed or has finished all its runs."""
        found = self._engines.get(engine, {})
        wanted = found.get("planned", 0) + 1
        return "state" in found or len(found.get("seconds", ())) >= wanted

    def forget_unfinished(self, engines: Sequence[str], culprit: str) -> None:
        """Remove the results of engines that are not finished, except the culprit."""
        for name in engines:
            if name != culprit and not self.is_over(name):
                self._engines.pop(name, None)

    def row(self) -> dict[str, Any]:
        """Return the results of the item in the form of a record."""
        for found in self._engines.values():
            found["median"] = _warm_median(found["seconds"])
            found["cpu"] = _warm_median(found["cpu_seconds"])
            found["cold"] = next(iter(found["seconds"]), None)
            found["faults"] = _warm_median(found.pop("faults_each", []))
            found["runs"] = max(len(found["seconds"]) - 1, min(len(found["seconds"]), 1))
            if "state" not in found:
                found["state"] = "ok"
            elif found["seconds"]:
                found["median"] = None
        return {"item": self._label, **self._extent, "engines": self._engines}


def _empty_result() -> dict[str, Any]:
    return {"seconds": [], "cpu_seconds": [], "memory_mb": 0.0}


def _warm_median(times: list[float]) -> float | None:
    """Return the median of all times but the first, a warm-up; of one time, the time itself."""
    return median(times[1:] or times) if times else None


def with_volumes_compared(row: dict[str, Any]) -> dict[str, Any]:
    """Return the row with each volume compared with ours, within a bound of the rounding."""
    ours = row["engines"].get(OURS, {})
    if "facts" not in ours:
        return row
    others = {name: found for name, found in row["engines"].items() if name != OURS}
    others |= {MAIN_RIVAL: row["at_once"]} if "facts" in row.get("at_once", {}) else {}
    for name, found in others.items():
        if "facts" in found:
            found["difference"] = max(
                abs(mine - theirs) for mine in ours["volumes"] for theirs in found["volumes"]
            )
            found["bound"] = _volume_tolerance(row, ours, found, name)
            found["agrees"] = found["difference"] <= found["bound"]
            found["same_euler_number"] = (
                found["facts"]["euler_number"] == ours["facts"]["euler_number"]
            )
    return row


def _volume_tolerance(
    row: dict[str, Any], ours: dict[str, Any], theirs: dict[str, Any], name: str
) -> float:
    """Return the largest difference of our and another engine's volume that rounding explains.

    An engine may move each vertex by its resolution. The faces of the answer are parts of the
    operands' faces, so the volume changes by at most the operands' area times that distance.
    """
    ways = sum(_resolution(engine, row["size"]) for engine in (OURS, name))
    roundings = ours["facts"]["volume_error"] + theirs["facts"]["volume_error"]
    return float(row["area"] * ways + roundings)


def _resolution(engine: str, size: float) -> float:
    # Without calling `__init__`, which would import the engine.
    return ENGINES[engine].resolution(ENGINES[engine].__new__(ENGINES[engine]), size)
