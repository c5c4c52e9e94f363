"""Run the cases of a campaign and append each record to the results file at once."""

import os
import platform
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, cast

from ..._core import __version__
from ...machine import machine
from ..cases.case import Case
from ..judging.evaluation import EvaluationSettings, blank_record
from ..record import SCHEMA, CaseRecord, Journal, RunRecord, is_failure
from .pool import RequestHandler

_VERSIONED = ("manifold3d", "pymeshlab", "trimesh", "numpy")


@dataclass(frozen=True)
class CampaignPlan:
    """The cases of a run, the records already known, and how to run the other cases.

    Parameters
    ----------
    cases : sequence of Case
    known : dict of str to CaseRecord
        The records of an earlier run, by key; their cases are not run again.
    timeout : float
        The time limit of a case, in seconds.
    keep : str
        The cases whose meshes are written: "interesting", "all", "none", or a number of cases
        besides the interesting ones.
    fail_fast : bool
        True to stop at the first failure.
    """

    cases: Sequence[Case]
    known: dict[str, CaseRecord]
    timeout: float
    keep: str = "interesting"
    fail_fast: bool = False

    @property
    def open_cases(self) -> list[Case]:
        """The cases without a known record."""
        return [case for case in self.cases if case.key not in self.known]


def greeting(settings: EvaluationSettings, memory: int | None, threads: int) -> dict[str, Any]:
    """Return the first message to a worker, as JSON values."""
    told = {"settings": asdict(settings), "memory": memory, "threads": threads}
    return {**told, "folder": os.getcwd()}


def run_cases(
    plan: CampaignPlan,
    answering: RequestHandler,
    journal: Journal | None,
    notice: Callable[[CaseRecord], None],
) -> list[CaseRecord]:
    """Run all open cases, and return the records of these and of the known cases.

    Parameters
    ----------
    plan : CampaignPlan
    answering : RequestHandler
    journal : Journal or None
        The results file to which each record is appended as it arrives.
    notice : callable
        A function that is called with each new record.
    """
    found = {case.key: plan.known[case.key] for case in plan.cases if case.key in plan.known}
    with closing(_records(plan, answering)) as records:
        for record in records:
            if journal is not None:
                journal.append(record)
            found[record["key"]] = record
            notice(record)
            if plan.fail_fast and is_failure(record):
                break
    return [found[case.key] for case in plan.cases if case.key in found]


def _records(plan: CampaignPlan, answering: RequestHandler) -> Generator[CaseRecord, None, None]:
    cases = plan.open_cases
    chosen = _chosen(len(cases), plan.keep)
    requests = [{"case": case.to_dict(), "keep": n in chosen} for n, case in enumerate(cases)]
    with closing(answering.answers(requests, plan.timeout)) as answers:
        for number, answer in answers:
            yield _record_of(cases[number], answer)


def _record_of(case: Case, answer: Any) -> CaseRecord:
    if "failure" not in answer:
        return cast(CaseRecord, answer)
    record = blank_record(case, answer["failure"], answer["reason"])
    record["seconds"]["total"] = answer["seconds"]
    return record


def _chosen(count: int, keep: str) -> set[int]:
    """Return the indices of cases whose meshes are written even if they are not interesting."""
    wanted = count if keep == "all" else int(keep) if keep.isdecimal() else 0
    # Evenly spread over all cases, so that each kind is included.
    return {number * count // wanted for number in range(min(wanted, count))} if wanted else set()


def survey(
    files: Sequence[Path], answering: RequestHandler, seconds: float
) -> dict[Path, dict[str, Any]]:
    """Return for each file its number of ``triangles``, and why it is ``refused``, or None.

    ``refused`` is the reason why the file is no solid.

    A file on which the worker crashes or hangs counts as a solid without triangles, so that its
    cases report the failure, and the random draw does not depend on the machine's load.
    """
    requests = [{"survey": str(file)} for file in files]
    found: dict[Path, dict[str, Any]] = {}
    for number, answer in answering.answers(requests, seconds):
        names = ("triangles", "refused")
        found[files[number]] = {"triangles": 0, "refused": None} | {
            name: answer[name] for name in names if name in answer
        }
    return found


def run_record(command: str, seed: int) -> RunRecord:
    """Return the record of a run that starts now."""
    found = {"bspcsg": __version__, "python": platform.python_version()}
    for name in _VERSIONED:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return {
        "schema": SCHEMA,
        "type": "run",
        "command": command,
        "seed": seed,
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "versions": found,
        "machine": machine(),
    }
