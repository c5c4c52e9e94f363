"""The verdict on a case from the opinions of all engines."""

from collections.abc import Sequence

from ...verify.verdict import CheckReport, Verdict
from ..record import IdentityRecord, OracleRecord


def verdict_of(
    report: CheckReport,
    records: Sequence[OracleRecord],
    identity: IdentityRecord | None,
    is_script: bool = False,
) -> tuple[str, str]:
    """Return the verdict on a case and its reason, from the opinions of all engines.

    Parameters
    ----------
    report : CheckReport
        The comparison of our result with manifold3d's.
    records : sequence of OracleRecord
    identity : IdentityRecord or None
    is_script : bool
        True for a script, about which `records` has OpenSCAD's opinion.

    Notes
    -----
    Counts of crossings are exact, so one wrongly classified point overrules all engines. An engine
    with rounding that alone contradicts our result and another engine's counts as wrong; our result
    never counts as right if it stands alone. For scripts only OpenSCAD counts, because manifold3d
    gets primitives that we have made.
    """
    verdict, reason = report.verdict, report.reason
    if identity is not None and not identity["holds"]:
        return str(
            Verdict.SUBJECT_FAILED
        ), f"the volumes violate the identity {identity['equation']}"
    if verdict is Verdict.SUBJECT_FAILED:
        return str(verdict), reason
    counts = [other for other in records if other["name"] == "crossing counts"]
    for other in counts:
        if other["agrees"] is False:
            return str(Verdict.DISAGREE), _joined(reason, f"crossing counts: {other['says']}")
    engines = [other for other in records if other not in counts]
    if is_script and any(engine["agrees"] is False for engine in engines):
        said = "; ".join(f"{engine['name']} {engine['says']}" for engine in engines)
        return str(Verdict.DISAGREE), _joined(reason, said)
    return _weighed_verdict(verdict, reason, engines, bool(counts and counts[0]["agrees"]))


def _weighed_verdict(
    verdict: Verdict, reason: str, engines: Sequence[OracleRecord], counted: bool
) -> tuple[str, str]:
    """Return the verdict and its reason after weighing which engines support our result."""
    for_us = [engine["name"] for engine in engines if engine["agrees"] is True]
    against = [engine for engine in engines if engine["agrees"] is False]
    if verdict is Verdict.DISAGREE:
        if for_us and not against:
            said = f"{_joined_names(for_us)} agrees with bspcsg, so only manifold3d differs"
            return str(Verdict.ORACLE_FAILED), _joined(reason, said)
        alone = (
            "all other engines differ from bspcsg"
            if against
            else "no other engine could decide which result is right"
        )
        return str(verdict), _joined(reason, alone)
    if not against:
        said = f"{_joined_names(for_us)} agrees with bspcsg" if for_us and reason else ""
        return str(verdict), _joined(reason, said)
    said = "; ".join(f"{engine['name']} {engine['says']}" for engine in against)
    if verdict in (Verdict.ORACLE_FAILED, Verdict.ORACLE_REFUSED) and not counted:
        return str(Verdict.DISAGREE), _joined(reason, said)
    if verdict in (Verdict.ORACLE_FAILED, Verdict.ORACLE_REFUSED):
        return str(Verdict.ORACLE_FAILED), _joined(
            reason, said, "crossing counts confirm the result of bspcsg"
        )
    names = _joined_names([engine["name"] for engine in against])
    return str(verdict), _joined(reason, said, f"only {names} differs")


def _joined(*parts: str) -> str:
    return "; ".join(part for part in parts if part)


def _joined_names(names: Sequence[str]) -> str:
    return " and ".join(names)
