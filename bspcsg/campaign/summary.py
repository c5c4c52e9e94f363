"""Summarise a campaign in numbers."""

from collections import Counter
from collections.abc import Sequence
from typing import Any

from .record import FAILURES, SCHEMA, VERDICTS, CaseRecord, is_failure


def summary_of(cases: Sequence[CaseRecord]) -> dict[str, Any]:
    """Return counts by verdict, operation, kind and pose, and the failures by name.

    Parameters
    ----------
    cases : sequence of CaseRecord
    """
    return {
        "schema": SCHEMA,
        "cases": len(cases),
        "verdicts": counts_by_verdict(cases),
        "operations": _counts_within(cases, "operation"),
        "kinds": dict(sorted(Counter(case["kind"] for case in cases).items())),
        "poses": dict(sorted(Counter(case["pose"] or "as it lies" for case in cases).items())),
        "identities": _identities(cases),
        "thickest_agreement": _thickest(cases),
        "seconds": round(sum(case["seconds"]["total"] for case in cases), 1),
        "failures": {case["case"]: _failure_reason(case) for case in cases if is_failure(case)},
    }


def counts_by_verdict(cases: Sequence[CaseRecord]) -> dict[str, int]:
    """Return the number of cases of each verdict, the most serious verdict first."""
    counts = Counter(case["verdict"] for case in cases)
    return {verdict: counts[verdict] for verdict in VERDICTS if counts[verdict]}


def conclusion(cases: Sequence[CaseRecord]) -> str:
    """Return a sentence with the number of cases that failed."""
    failed = sum(map(is_failure, cases))
    if len(cases) == 1:
        return "The one case failed." if failed else "The one case did not fail."
    if failed:
        return f"{failed} of {len(cases)} cases failed."
    return f"None of {len(cases)} cases failed."


def _counts_within(cases: Sequence[CaseRecord], field: str) -> dict[str, dict[str, int]]:
    names = sorted({str(case[field]) for case in cases})  # type: ignore[literal-required]
    return {
        name: counts_by_verdict(
            [case for case in cases if case[field] == name]  # type: ignore[literal-required]
        )
        for name in names
    }


def _identities(cases: Sequence[CaseRecord]) -> dict[str, int]:
    """Return the numbers of equations of exact volumes that were checked and that were wrong."""
    found = [case.get("identity") for case in cases]
    known = [identity for identity in found if identity is not None]
    broken = sum(not identity["holds"] for identity in known)
    return {"checked": len(known), "broken": broken}


def _thickest(cases: Sequence[CaseRecord]) -> float:
    """Return the thickness, in model units, of the thickest difference among cases that agree."""
    agreeing = [case for case in cases if case["verdict"] not in FAILURES]
    known = [
        case["set_difference"]["thickness"]
        for case in agreeing
        if case["set_difference"] is not None and case["verdict"].startswith(("agree", "same"))
    ]
    return max(known, default=0.0)


def _failure_reason(case: CaseRecord) -> str:
    return f"{case['verdict']}: {case['reason']}" if case["reason"] else case["verdict"]
