"""The evaluation of cases: a wrong result is detected, described and stored."""

from pathlib import Path
from typing import Any

import pytest

import bspcsg as b
from bspcsg.campaign.cases.case import Case, Operand
from bspcsg.campaign.cases.meshes import unpacked
from bspcsg.campaign.judging.evaluation import EvaluationSettings, evaluate
from bspcsg.campaign.record import CaseRecord
from bspcsg.operations.setops import OPERATIONS

Settle = pytest.MonkeyPatch


def cube_operand(name: str, side: float, shift: float = 0.0) -> Operand:
    mesh = b.cube(side).translate(shift, shift, shift).to_mesh()
    given = {"vertices": mesh.vertices.tolist(), "faces": mesh.faces.tolist()}
    return Operand(name, None, f"{side}/{shift}", None, given)


def case_of(operation: str, *operands: Operand) -> Case:
    return Case("0000", "pair", operation, operands)


def asked(
    operation: str, settings: EvaluationSettings | None = None, keep: bool = False
) -> CaseRecord:
    """Return the record of an operation on cubes of side 3 and 2 with a unit cube in common."""
    case = case_of(operation, cube_operand("a", 3), cube_operand("b", 2, 2))
    return evaluate(case, settings or EvaluationSettings(), keep)


def a_bump_too_many(*solids: "b.Solid") -> "b.Solid":
    """Return the intersection of two solids with a wrong small cube on top."""
    common = solids[0] & solids[1]
    return common | b.cube(0.5).translate(2, 2, 3)


def test_wrong_result_is_a_disagreement(tmp_path: Path, monkeypatch: Settle) -> None:
    monkeypatch.setitem(OPERATIONS, "intersection", a_bump_too_many)
    settings = EvaluationSettings(meshes=str(tmp_path / "kept"), relative="kept")
    found = asked("intersection", settings)
    assert found["verdict"] == "DISAGREE"
    assert (
        "crossing counts" in found["reason"]
        or "all other engines differ from bspcsg" in found["reason"]
    )
    names = [oracle["name"] for oracle in found["oracles"]]
    assert names == ["manifold3d", "pymeshlab", "crossing counts"]
    assert [oracle["agrees"] for oracle in found["oracles"][:2]] == [False, False]
    difference = found["set_difference"]
    assert difference is not None and not difference["equal"] and difference["exact"] is None
    assert difference["volume"] == pytest.approx(0.125)
    assert difference["place"] is not None and difference["place"][2] >= 3
    distance = found["hausdorff"]
    assert distance is not None
    assert distance["forward"] == pytest.approx(0.5)
    # Below the middle of the bump's foot, our surface is half its side away.
    assert 0.2 < distance["backward"] <= 0.25
    kept = unpacked(tmp_path / str(found["meshes"]))
    assert kept.difference.volume == pytest.approx(0.125) and list(kept.operands) == ["a", "b"]


def test_volumes_that_do_not_add_up_fail_us(monkeypatch: Settle) -> None:
    monkeypatch.setitem(OPERATIONS, "union", lambda *solids: solids[0])
    found = asked("union")
    assert found["verdict"] == "subject failed"
    assert found["identity"] == {"equation": "|A ∪ B| = |A| + |B| − |A ∩ B|", "holds": False}


def test_internal_error_fails_us(monkeypatch: Settle) -> None:
    def broken(*solids: "b.Solid") -> "b.Solid":
        raise b.InternalError("An invariant failed.")

    monkeypatch.setitem(OPERATIONS, "xor", broken)
    found = asked("xor")
    assert (found["verdict"], found["reason"]) == ("subject failed", "An invariant failed.")


@pytest.mark.parametrize(
    ("operation", "volume"),
    [("union", 34.0), ("difference", 26.0), ("intersection", 1.0), ("xor", 33.0)],
)
def test_right_results_agree(operation: str, volume: float) -> None:
    found = asked(operation)
    assert found["verdict"] == "agree" and found["ours"] is not None
    assert found["ours"]["volume"] == volume and found["ours"]["self_intersections"] == 0
    assert (found["identity"] is None) == (operation == "intersection")
    assert [operand["volume"] for operand in found["operands"]] == [27.0, 8.0]


def test_open_mesh_and_useless_file_are_refused(tmp_path: Path) -> None:
    mesh = b.cube(1).to_mesh()
    given = {"vertices": mesh.vertices.tolist(), "faces": mesh.faces[1:].tolist()}
    half = Operand("b", None, "half", None, given)
    found = evaluate(case_of("union", cube_operand("a", 1), half), EvaluationSettings())
    assert found["verdict"] == "refused" and "operand b" in found["reason"]
    missing = Operand("b", str(tmp_path / "none.stl"), "none")
    found = evaluate(case_of("union", cube_operand("a", 1), missing), EvaluationSettings())
    assert found["verdict"] == "refused" and "none.stl" in found["reason"]


def test_empty_result_agrees() -> None:
    far = case_of("intersection", cube_operand("a", 1), cube_operand("b", 1, 5))
    found = evaluate(far, EvaluationSettings(against=("pymeshlab",)))
    assert found["verdict"] == "agree" and found["ours"] is not None
    assert found["ours"]["triangles"] == 0 and found["ours"]["centroid"] is None
    assert found["oracles"][1]["agrees"] is True


def test_manifold_that_fails_is_overruled_by_pymeshlab(monkeypatch: Settle) -> None:
    from bspcsg.verify import oracle

    def fails(*_: Any) -> Any:
        raise oracle.OracleFailedError("manifold3d raised RuntimeError: no")

    monkeypatch.setattr(oracle, "manifold_result", fails)
    found = asked("union")
    assert found["verdict"] == "oracle failed"
    assert "pymeshlab agrees with bspcsg" in found["reason"]
    assert found["hausdorff"] is None and found["bounds"] is None
