"""The worker process: times one item with all its engines in turn, and reports at once.

It writes one JSON document per line to standard output, so that a crash loses no earlier result.
"""

import gc
import json
import os
import resource
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from math import ceil
from pathlib import Path
from statistics import mean, median
from typing import Any

from ..machine import memory_mb, peak_mb, reset_peak
from .cases import CASES, dome
from .engines import ENGINES, Engine
from .result_facts import facts_of
from .targets import OURS
from .workloads import Carving, Chain, Outcome, StepCallback, Work

#: The least time between two reports of steps, in seconds.
_REPORT_INTERVAL = 0.5

#: The least time of a run, in seconds. A shorter call is repeated, and its cost is the mean.
_MIN_RUN_SECONDS = 0.02

#: The number of first and of last steps over which the median is taken; around step 1000 it is
#: twice that.
_WINDOW_STEPS = 100


@dataclass(frozen=True)
class Task:
    """The item that a worker times, with its engines and limits.

    Parameters
    ----------
    case, item : str
    small : bool
        True for a small item of the case.
    engines : list of str
        The names of the engines, in the order of their turns.
    runs : int
        The number of timed runs of each engine, after a warm-up run.
    budget : float
        The time for all runs of an engine, in seconds; fewer runs are timed if it is too short.
    shared : str
        The folder of shared data.
    cores : int
        The number of cores that the process may use; 0 for no limit.
    memory_gb : float
        The limit of the address space, in 2^30 bytes; 0 for none.
    steps : int
        The number of steps of the case "dome"; 0 for all.
    at_once : bool
        True to compute a chain's set as one expression instead.
    """

    case: str
    item: str
    small: bool
    engines: list[str]
    runs: int
    budget: float
    shared: str
    cores: int = 0
    memory_gb: float = 0.0
    steps: int = 0
    at_once: bool = False


def main(task: str) -> None:
    """Perform the task that a JSON document describes, and report to standard output."""
    perform(Task(**json.loads(task)), _print_json)


def perform(task: Task, say: Callable[[dict[str, Any]], None]) -> None:
    """Perform a task, and report each result to `say` as soon as it is known."""
    _limit_resources(task)
    work = _work_of(task)
    say({"say": "extent", "names": work.names, **asdict(work.extent())})
    turns = [_EngineRuns(ENGINES[name](), work, task, say) for name in task.engines]
    while any(turn.left for turn in turns):
        for turn in turns:
            if turn.left:
                turn.take()
    say({"say": "end", "peak_mb": peak_mb()})


def _limit_resources(task: Task) -> None:
    if task.cores:
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: task.cores])
    if task.memory_gb:
        bytes_allowed = int(task.memory_gb * 2**30)
        resource.setrlimit(resource.RLIMIT_AS, (bytes_allowed, bytes_allowed))


def _work_of(task: Task) -> Work:
    case = CASES[task.case]
    maker = (case.small if task.small else case.items)[task.item]
    if task.steps and task.case == "dome":
        maker = dome(task.steps)
    work = maker(Path(task.shared))
    if task.at_once and isinstance(work, Chain | Carving):
        return work.at_once()
    return work


class _EngineRuns:
    """The runs of one engine on one item."""

    def __init__(
        self, engine: Engine, work: Work, task: Task, say: Callable[[dict[str, Any]], None]
    ) -> None:
        self.engine, self.work, self.task, self.report = engine, work, task, say
        self.left = 1
        self._warm = False
        self._calls = 1

    def take(self) -> None:
        """Do one run and report its result; after a failure there are no further runs."""
        name = self.engine.name
        self.report({"say": "begin", "engine": name})
        try:
            measured, outcome = self._timed()
        except MemoryError:
            self._fail("out of memory")
        except Exception as error:  # the other engines continue
            self._fail(f"{type(error).__name__}: {error}")
        else:
            first = not self._warm
            self._plan(measured["seconds"])
            said = {"say": "run", "engine": name, **measured}
            self.report(said | self._details(outcome, first))

    def _timed(self) -> tuple[dict[str, Any], Outcome]:
        """Do one run of several calls, and return the mean cost of a call with the last outcome."""
        gc.collect()
        held = memory_mb()
        counted = reset_peak()
        calls = [self._call() for _ in range(self._calls - 1)]
        last, outcome = self._called()
        costs = {name: mean(call[name] for call in [*calls, last]) for name in last}
        memory = peak_mb() - held if counted else None
        return {**costs, "memory_mb": memory, "peak_mb": peak_mb(), **_of_process(outcome)}, outcome

    def _call(self) -> dict[str, float]:
        """Make one call and return its cost; the result is freed."""
        return self._called()[0]

    def _called(self) -> tuple[dict[str, float], Outcome]:
        prepared = self.work.prepare(self.engine)
        faults, began, used = _page_faults(), time.perf_counter(), time.process_time()
        outcome = self.work.run(self.engine, prepared, self._teller())
        seconds, cpu = time.perf_counter() - began, time.process_time() - used
        cost = {
            "seconds": sum(outcome.parts.values()) or seconds,
            "cpu": cpu,
            "faults": _page_faults() - faults,
        }
        return cost, outcome

    def _plan(self, seconds: float) -> None:
        """After the first run, set the number of runs that fit the budget, and of calls in each."""
        if self._warm:
            self.left -= 1
            return
        self._warm = True
        self._calls = max(ceil(_MIN_RUN_SECONDS / seconds), 1)
        self.left = max(min(self.task.runs, int(self.task.budget / seconds) - 1), 0)
        self.report({"say": "plan", "engine": self.engine.name, "runs": self.left})

    def _details(self, outcome: Outcome, first: bool) -> dict[str, Any]:
        details: dict[str, Any] = {"parts": outcome.parts, "facts": asdict(facts_of(outcome.mesh))}
        details["answer_mb"] = sum(array.nbytes for array in outcome.mesh) / 1e6
        if outcome.step_seconds:
            details["steps"] = len(outcome.step_seconds)
            details["windows"] = _median_step_times(outcome.step_seconds)
        if first:
            details["counters"] = self.work.counted(self.engine, outcome)
            details |= self._proof(outcome)
        return details

    def _proof(self, outcome: Outcome) -> dict[str, Any]:
        """Return, as "proof", our result's check without another engine; empty if there is none."""
        found = self.work.proof(outcome.mesh) if self.engine.name == OURS else None
        return {} if found is None else {"proof": asdict(found)}

    def _fail(self, reason: str) -> None:
        self.left = 0
        self.report({"say": "failed", "engine": self.engine.name, "reason": reason})

    def _teller(self) -> StepCallback:
        last = time.perf_counter()

        def tell(done: int) -> None:
            nonlocal last
            now = time.perf_counter()
            if now - last >= _REPORT_INTERVAL:
                last = now
                self.report({"say": "step", "engine": self.engine.name, "done": done})

        return tell


def _page_faults() -> int:
    """Return the number of minor page faults of this process."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt


def _of_process(outcome: Outcome) -> dict[str, float]:
    """Return the time and memory of a process that did the work, or an empty dict."""
    used = outcome.process
    if used is None:
        return {}
    sizes = {"memory_mb": used.peak_mb, "peak_mb": used.peak_mb}
    return {"seconds": used.seconds, "cpu": used.cpu, **sizes}


def _median_step_times(steps: list[float]) -> dict[str, float]:
    """Return the median times of the first, of the thousandth and of the last steps."""
    found = {"first": median(steps[:_WINDOW_STEPS]), "last": median(steps[-_WINDOW_STEPS:])}
    if len(steps) >= 1000 + _WINDOW_STEPS:
        found["thousandth"] = median(steps[1000 - _WINDOW_STEPS : 1000 + _WINDOW_STEPS])
    return found


def _print_json(document: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(document) + "\n")
    sys.stdout.flush()
