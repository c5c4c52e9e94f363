"""Merging of results files of campaigns, such as the shards of one campaign."""

import json
import os
from collections.abc import Iterable, Sequence
from typing import Any

from ..campaign.record import (
    VERDICTS,
    CaseRecord,
    Results,
    RunRecord,
    read_results,
)
from ..campaign.summary import summary_of
from ..errors import FormatError
from .json_validation import type_mismatch


def merged(paths: Sequence[str | os.PathLike[str]]) -> Results:
    """Read and merge results files; their order does not matter.

    If a case occurs several times, its last line counts, in the file whose run started last.

    Raises
    ------
    FormatError
        If a file cannot be read or is no results file, or if no file has a case.
    """
    everything = Results()
    for results in sorted(map(_read, paths), key=_started):
        everything.runs += [run for run in results.runs if run not in everything.runs]
        everything.cases.update(results.cases)
        everything.folders.update(results.folders)
    if not everything.cases:
        names = ", ".join(str(path) for path in paths)
        raise FormatError(
            f"{names}: the results contain no case; run bspcsg crosscheck --results first.",
            "empty_results",
        )
    return everything


def _read(path: str | os.PathLike[str]) -> Results:
    results = read_results([path])
    lines: list[tuple[Any, type]] = [(run, RunRecord) for run in results.runs]
    lines += [(case, CaseRecord) for case in results.cases.values()]
    for line, kind in lines:
        fault = type_mismatch(line, kind, line["type"])
        if fault:
            message = (
                f"{os.fspath(path)}: the results file is not valid: {fault}. Give a file that"
                " bspcsg crosscheck --results wrote."
            )
            raise FormatError(message, "malformed")
    return results


def _started(results: Results) -> tuple[str, list[str]]:
    # For equal times, the keys decide, so that the order of the files does not matter.
    return max((run["started"] for run in results.runs), default=""), sorted(results.cases)


def rank(case: CaseRecord) -> int:
    """Return the rank of a case's verdict, 0 for the worst."""
    verdict = case["verdict"]
    return VERDICTS.index(verdict) if verdict in VERDICTS else len(VERDICTS)


def versions_of(runs: Iterable[RunRecord]) -> dict[str, list[str]]:
    """Return the versions of each engine in all runs, by the engine's name."""
    found: dict[str, set[str]] = {}
    for run in runs:
        for name, version in run["versions"].items():
            found.setdefault(name, set()).add(version)
    return {name: sorted(versions) for name, versions in found.items()}


def ordered(results: Results) -> list[CaseRecord]:
    """Return all cases, sorted by verdict, the worst first, then by name."""
    return sorted(results.cases.values(), key=lambda case: (rank(case), case["case"], case["key"]))


def document(results: Results) -> str:
    """Return summary, runs and cases of the results as one JSON document."""
    cases = ordered(results)
    found = {**summary_of(cases), "runs": results.runs, "results": cases}
    return json.dumps(found, indent=1, allow_nan=False) + "\n"
