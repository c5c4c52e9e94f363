"""Evaluate one case: compute our result, ask other engines, and compare the results."""

import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from ... import csg
from ..._types import FloatArray, SetOp
from ...errors import BspcsgError, InternalError, MissingPartError
from ...formats.atomic import write_file
from ...machine import peak_mb, reset_peak
from ...mesh.mesh import Mesh
from ...operations.setops import OPERATIONS
from ...solid.solid import Solid
from ...verify import oracle
from ...verify.check import ReportWithMeshes, report_with_meshes
from ...verify.comparison import hausdorff
from ...verify.verdict import CheckReport, Facts, Verdict
from ..cases.case import SCRIPT, Case
from ..cases.identities import identity_of
from ..cases.meshes import packed
from ..cases.operands import operands_of
from ..engines.engine_request import EngineRequest
from ..record import (
    SCHEMA,
    CaseRecord,
    DifferenceRecord,
    FactsRecord,
    HausdorffRecord,
    OracleRecord,
)
from .mesh_facts import facts_of
from .opinions import crossings_opinion, is_installed, opinion, script_opinion
from .verdict import verdict_of

#: The verdicts of the comparison with manifold3d after which further engines are asked.
_DOUBTFUL = frozenset({Verdict.DISAGREE, Verdict.ORACLE_REFUSED, Verdict.ORACLE_FAILED})

#: The verdicts of cases that are not interesting, so that their meshes are not written.
_UNINTERESTING = frozenset({str(Verdict.AGREE), str(Verdict.OTHER_TOPOLOGY)})

#: The largest fraction of a case's time limit that one additional engine may take.
_MAX_ENGINE_SHARE = 0.4


@dataclass(frozen=True)
class EvaluationSettings:
    """The settings that all cases of a campaign are evaluated with.

    Parameters
    ----------
    against : tuple of str
        The engines to ask in every case besides manifold3d; others are asked only in doubtful
        cases.
    samples : int
        The number of sample points for distances; 0 to measure none.
    timeout : float
        The time limit of a case, in seconds.
    meshes : str or None
        The folder for the meshes of interesting cases, or None to write none.
    relative : str
        The name of the folder `meshes` in records.
    """

    against: tuple[str, ...] = ()
    samples: int = 500
    timeout: float = 300.0
    meshes: str | None = None
    relative: str = ""


@dataclass
class _Stopwatch:
    """A stopwatch that records the seconds of each part of a case."""

    began: float = field(default_factory=time.perf_counter)
    last: float = field(default_factory=time.perf_counter)
    seconds: dict[str, float] = field(default_factory=dict)

    def lap(self, name: str) -> None:
        now = time.perf_counter()
        self.seconds[name] = round(now - self.last, 4)
        self.last = now


def blank_record(case: Case, verdict: str, reason: str) -> CaseRecord:
    """Return the record of a case of which only the verdict and its reason are known."""
    return {
        "schema": SCHEMA,
        "type": "case",
        "key": case.key,
        "case": case.name,
        "kind": case.kind,
        "operation": case.operation,
        "operands": [
            {
                "name": operand.name,
                "file": operand.file,
                "sha256": operand.sha256,
                "pose": operand.pose,
                "triangles": None,
                "volume": None,
            }
            for operand in case.operands
        ],
        "command": case.command,
        "seed": case.seed,
        "pose": case.pose,
        "verdict": verdict,
        "reason": reason,
        "ours": None,
        "oracles": [],
        "set_difference": None,
        "hausdorff": None,
        "bounds": None,
        "identity": None,
        "seconds": {"load": 0.0, "ours": 0.0, "check": 0.0, "total": 0.0},
        "memory_mb": None,
        "meshes": None,
    }


def evaluate(case: Case, settings: EvaluationSettings, keep: bool = False) -> CaseRecord:
    """Evaluate a case and return its record; an error of the package becomes a verdict.

    Parameters
    ----------
    case : Case
    settings : EvaluationSettings
    keep : bool
        True to write the meshes even if the case is not interesting.
    """
    reset_peak()
    clock = _Stopwatch()
    try:
        record = _Evaluation(case, settings, clock).run(keep)
    except InternalError as error:
        record = blank_record(case, str(Verdict.SUBJECT_FAILED), error.message)
    except MissingPartError:
        raise
    except BspcsgError as error:
        record = blank_record(case, "refused", error.message)
    seconds = {**record["seconds"], **clock.seconds}
    seconds["total"] = round(time.perf_counter() - clock.began, 4)
    record["seconds"] = cast(Any, seconds)
    record["memory_mb"] = round(peak_mb(), 1) or None
    return record


class _Evaluation:
    """The evaluation of one case: computes our result, compares it and makes the record."""

    def __init__(self, case: Case, settings: EvaluationSettings, clock: _Stopwatch) -> None:
        self._case, self._settings, self._clock = case, settings, clock
        self._is_script = case.operation == SCRIPT

    def run(self, keep: bool) -> CaseRecord:
        solids, rows = self._loaded()
        self._clock.lap("load")
        result = solids[0] if self._is_script else OPERATIONS[self._case.operation](*solids)
        result.normalized().to_mesh()
        self._clock.lap("ours")
        began = time.perf_counter()
        found = self._examined(result, solids)
        asked = time.perf_counter() - began
        identity = None if self._is_script else identity_of(self._case.operation, solids, result)
        others = self._further(found, solids, result)
        verdict, reason = verdict_of(found.report, others, identity, self._is_script)
        record = blank_record(self._case, verdict, reason)
        self._describe_operands(record, solids, rows)
        record["ours"] = facts_of(found.ours, found.report.ours, crossings=True)
        record["oracles"] = [_manifold_record(found, asked), *others]
        record["identity"] = identity
        record["set_difference"] = _difference_record(found.report)
        record["hausdorff"] = self._distances(found)
        if found.report.set_difference is not None:
            bounds = found.report.same_set_bound, found.report.rounding_bound
            record["bounds"] = {"same_set": bounds[0], "rounding": bounds[1]}
        self._clock.lap("check")
        if self._settings.meshes and (keep or verdict not in _UNINTERESTING):
            record["meshes"] = self._stored_path(found)
        return record

    def _loaded(self) -> tuple[list[Solid], Sequence[FloatArray | None]]:
        if not self._is_script:
            return operands_of(self._case)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", csg.CsgWarning)
            path = str(self._case.operands[0].file)
            return [csg.load(path, on_invalid="warn")], [None]

    def _examined(self, result: Solid, solids: list[Solid]) -> ReportWithMeshes:
        if not self._is_script:
            return report_with_meshes(result, cast(SetOp, self._case.operation), solids)
        if result.last_operation is None:
            # A script without operations: manifold3d gets its mesh as the union of one operand.
            return report_with_meshes(result, "union", [result])
        return report_with_meshes(result)

    def _further(
        self, found: ReportWithMeshes, solids: list[Solid], result: Solid
    ) -> list[OracleRecord]:
        """Return the records of all engines that are asked besides manifold3d."""
        wanted = [name for name in self._settings.against if name != "manifold3d"]
        limit = self._settings.timeout * _MAX_ENGINE_SHARE
        if self._is_script:
            path = Path(str(self._case.operands[0].file))
            ask = "openscad" in wanted or is_installed("openscad")
            return [script_opinion(path, result, limit)] if ask else []
        doubtful = found.report.verdict in _DOUBTFUL
        if doubtful and "pymeshlab" not in wanted and is_installed("pymeshlab"):
            wanted.append("pymeshlab")
        if not wanted and not doubtful:
            return []
        operands = [solid.normalized().to_mesh() for solid in solids]
        asked = (self._case.operation, found.program, operands, found.ours)
        question = EngineRequest(*asked, result.pitch, limit, result.tree.snapped_by)
        said = [opinion(name, question) for name in wanted]
        if doubtful or any(record["agrees"] is False for record in said):
            said.append(crossings_opinion(question))
        return said

    def _describe_operands(
        self, record: CaseRecord, solids: list[Solid], rows: Sequence[FloatArray | None]
    ) -> None:
        if self._is_script:
            return
        for operand, solid, pose in zip(record["operands"], solids, rows, strict=True):
            operand["triangles"] = len(solid.to_mesh().faces)
            operand["volume"] = solid.volume
            operand["pose"] = None if pose is None else pose.tolist()

    def _distances(self, found: ReportWithMeshes) -> HausdorffRecord | None:
        theirs, difference = found.theirs, found.difference
        if theirs is None or not self._settings.samples or found.report.set_difference is None:
            return None
        if difference is not None and not (len(found.ours.faces) and len(theirs.faces)):
            return None
        forth, back, count = hausdorff(found.ours, theirs, difference, self._settings.samples)
        return {"forward": forth, "backward": back, "samples": count}

    def _stored_path(self, found: ReportWithMeshes) -> str:
        """Write the meshes of a case to a file, and return its path as in the record."""
        folder = Path(str(self._settings.meshes))
        folder.mkdir(parents=True, exist_ok=True)
        name = f"{self._case.key}.npz"
        write_file(folder / name, [packed(found.operands, found.ours, found.difference)])
        return f"{self._settings.relative}/{name}"


def _manifold_record(found: ReportWithMeshes, seconds: float) -> OracleRecord:
    report = found.report
    name, _, version = oracle.versioned_name().partition(" ")
    return {
        "name": name,
        "version": version,
        "agrees": _MANIFOLD_AGREES.get(report.verdict),
        "says": report.summary(),
        "facts": _their_facts(found.theirs, report.theirs),
        "seconds": round(seconds, 4),
    }


_MANIFOLD_AGREES = {
    Verdict.AGREE: True,
    Verdict.OTHER_TOPOLOGY: True,
    Verdict.WITHIN_ROUNDING: True,
    Verdict.DISAGREE: False,
}


def _their_facts(mesh: Mesh | None, facts: Facts | None) -> FactsRecord | None:
    return None if mesh is None else facts_of(mesh, facts)


def _difference_record(report: CheckReport) -> DifferenceRecord | None:
    found = report.set_difference
    if found is None:
        return None
    equal = found.volume == 0
    return {
        "volume": found.volume,
        "exact": "0" if equal else None,
        "thickness": found.thickness,
        "equal": equal,
        "place": None if found.place is None else [float(x) for x in found.place],
    }
