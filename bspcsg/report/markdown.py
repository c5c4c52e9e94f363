"""Results of campaigns as Markdown, for build summaries and messages."""

from collections.abc import Sequence

from ..campaign.record import CaseRecord, RunRecord, is_failure
from ..campaign.summary import conclusion, counts_by_verdict

#: The largest number of cases that a table lists.
_MAX_CASES_LISTED = 50

#: Verdicts that are listed although they are no failures.
_NOTEWORTHY = ("oracle failed", "oracle refused", "within rounding", "refused")


def markdown_text(cases: Sequence[CaseRecord], runs: Sequence[RunRecord] = ()) -> str:
    """Return Markdown tables of a campaign: counts by verdict, failures and noteworthy cases.

    Parameters
    ----------
    cases : sequence of CaseRecord
    runs : sequence of RunRecord
        The runs of the campaign; their commands, versions and machines are listed.
    """
    failures = [case for case in cases if is_failure(case)]
    blocks = ["# Validation", f"**{conclusion(cases)}**", _counts(cases)]
    if failures:
        blocks += ["## Failures", _listed(failures)]
    for verdict in _NOTEWORTHY:
        found = [case for case in cases if case["verdict"] == verdict]
        if found:
            blocks += [f"## {verdict.capitalize()}", _listed(found)]
    blocks += [_run(run) for run in runs]
    return "\n\n".join(blocks) + "\n"


def _counts(cases: Sequence[CaseRecord]) -> str:
    operations = sorted({case["operation"] for case in cases})
    head = _row(["verdict", *operations, "all"])
    rows = [head, _row(["---", *("---:" for _ in [*operations, "all"])])]
    parts = [
        counts_by_verdict([case for case in cases if case["operation"] == operation])
        for operation in operations
    ]
    for verdict, total in counts_by_verdict(cases).items():
        rows.append(_row([verdict, *(str(part.get(verdict, 0)) for part in parts), str(total)]))
    return "\n".join(rows)


def _listed(cases: Sequence[CaseRecord]) -> str:
    rows = [_row(["case", "verdict", "why", "again"]), _row(["---"] * 4)]
    for case in cases[:_MAX_CASES_LISTED]:
        rows.append(_row([case["case"], case["verdict"], case["reason"], _code(case["command"])]))
    more = len(cases) - _MAX_CASES_LISTED
    return "\n".join(rows) + (f"\n\nand {more} more" if more > 0 else "")


def _run(run: RunRecord) -> str:
    machine = run["machine"]
    versions = ", ".join(f"{name} {version}" for name, version in run["versions"].items())
    return "\n".join(
        [
            f"- {_code(run['command'])}, started {run['started']}, seed {run['seed']}",
            f"- {versions}",
            f"- {machine['processor']}, {machine['cores']} cores, {machine['memory_gb']} GB,"
            f" {machine['system']}",
        ]
    )


def _row(cells: Sequence[str]) -> str:
    # Escape vertical bars, which would end the cell, and line breaks, which would end the row.
    safe = (cell.replace("|", "\\|").replace("\n", " ") for cell in cells)
    return f"| {' | '.join(safe)} |"


def _code(text: str) -> str:
    return f"`{text.replace('`', chr(39))}`" if text else ""
