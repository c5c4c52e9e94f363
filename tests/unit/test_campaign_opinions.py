"""Further engines detect a wrong result, and the ruling names the engine that stands alone."""

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg.campaign.engines import openscad as openscad_engine
from bspcsg.campaign.engines import pymeshlab as pymeshlab_engine
from bspcsg.campaign.engines.engine_request import EngineRequest, NoOpinionError
from bspcsg.campaign.judging.opinions import crossings_opinion, opinion, script_opinion
from bspcsg.campaign.judging.verdict import verdict_of
from bspcsg.mesh.mesh import Mesh
from bspcsg.verify.check import CheckReport, Facts, Verdict, report_with_meshes

needs_openscad = pytest.mark.skipif(
    not shutil.which("openscad"), reason="openscad is not installed"
)


def question(ours: "b.Solid | None" = None, operation: str = "difference") -> EngineRequest:
    """Return a question about a cube without a corner, with `ours` as our result."""
    operands = [b.cube(3), b.cube(2).translate(2, 2, 2)]
    found = report_with_meshes(operands[0] - operands[1], "difference", operands)
    meshes = [solid.normalized().to_mesh() for solid in operands]
    mesh = found.ours if ours is None else ours.normalized().to_mesh()
    return EngineRequest(operation, found.program, meshes, mesh, -9, 60.0)


WRONG = b.cube(3)


def test_pymeshlab_tells_right_from_wrong() -> None:
    right, wrong = opinion("pymeshlab", question()), opinion("pymeshlab", question(WRONG))
    assert (right["agrees"], right["says"]) == (True, "exactly the same set")
    assert right["facts"] is not None and right["facts"]["volume"] == 26.0
    assert wrong["agrees"] is False and "differs by volume 1," in wrong["says"]


def test_empty_answer_of_pymeshlab_is_an_answer() -> None:
    apart = [b.cube(1).to_mesh(), b.cube(1).translate(5, 0, 0).to_mesh()]
    found = pymeshlab_engine.ask_pymeshlab(
        EngineRequest("intersection", [], apart, apart[0], -9, 60.0)
    )
    assert len(found.mesh.faces) == 0


def test_crossings_tell_right_from_wrong() -> None:
    right, wrong = crossings_opinion(question()), crossings_opinion(question(b.cube(1)))
    assert right["agrees"] is True and wrong["agrees"] is False
    assert "are correctly classified" in right["says"]


def fake_openscad(monkeypatch: pytest.MonkeyPatch, said: str, corners: "Mesh | None") -> None:
    """Replace OpenSCAD by a function that writes a mesh and prints a message."""

    def run(command: list[str], timeout: float) -> "subprocess.CompletedProcess[str]":
        if corners is not None and "-o" in command:
            b.Solid(corners.vertices, corners.faces).save(command[2])
        return subprocess.CompletedProcess(command, 0, "", said)

    monkeypatch.setattr(openscad_engine, "_ran", run)
    monkeypatch.setattr(shutil, "which", lambda name: name)


def test_openscad_tells_right_from_wrong(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fake_openscad(monkeypatch, "OpenSCAD version 2021.01\n", question().ours)
    right, wrong = opinion("openscad", question()), opinion("openscad", question(WRONG))
    assert (right["agrees"], right["version"]) == (True, "2021.01") and wrong["agrees"] is False
    ours = b.cube(3) - b.cube(2).translate(2, 2, 2)
    assert script_opinion(tmp_path / "m.csg", ours, 60.0)["agrees"] is True
    assert script_opinion(tmp_path / "m.csg", WRONG, 60.0)["agrees"] is False


def test_lattices_of_two_pitches_are_no_disagreement() -> None:
    """The faces of a large part lie where the coarse lattice had them, its double did not."""
    large = b.cube(1, center=True).rotate(33, axis=(1, 2, 3)).to_mesh()
    operands = [b.Solid(*large), b.box(1, 0.8, 0.6), b.cube(1e-4).translate(3, 0, 0)]
    result = b.union(operands)
    found = report_with_meshes(result, "union", operands)
    meshes = [large, *(solid.to_mesh() for solid in operands[1:])]
    place = ("union", found.program, meshes, found.ours, result.pitch, 60.0)
    assert result.pitch < operands[0].pitch
    assert opinion("pymeshlab", EngineRequest(*place, result.tree.snapped_by))["agrees"] is True
    assert opinion("pymeshlab", EngineRequest(*place))["agrees"] is False


def test_question_in_openscads_language_is_the_same_question(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from bspcsg import csg

    scripts: list[str] = []

    def keep(path: Path, timeout: float) -> Any:
        scripts.append(path.read_text("utf-8"))
        raise NoOpinionError("kept")

    monkeypatch.setattr(openscad_engine, "run_script", keep)
    volumes = {"union": 34, "difference": 26, "intersection": 1, "xor": 33}
    for operation in volumes:
        opinion("openscad", question(operation=operation))
    assert [csg.loads(script).volume for script in scripts] == list(volumes.values())


def test_openscad_that_left_something_out_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    fake_openscad(monkeypatch, "ERROR: The given mesh is not closed!\n", WRONG.to_mesh())
    found = opinion("openscad", question())
    assert found["agrees"] is None and "but it said: ERROR: The given mesh" in found["says"]


def test_openscad_that_writes_nothing_has_no_opinion(monkeypatch: pytest.MonkeyPatch) -> None:
    fake_openscad(monkeypatch, "Aborted\n", None)
    found = opinion("openscad", question())
    assert (found["agrees"], found["says"]) == (None, "OpenSCAD failed: Aborted")


def test_openscad_is_not_asked_about_large_meshes() -> None:
    large = b.sphere(1, segments=64).to_mesh()
    with pytest.raises(NoOpinionError, match="takes at most"):
        openscad_engine.ask_openscad(EngineRequest("union", [], [large, large], large, -9, 1.0))


def test_engine_that_takes_too_long_has_no_opinion() -> None:
    found = question()
    late = EngineRequest(found.operation, found.program, found.operands, found.ours, -9, 0.001)
    assert opinion("pymeshlab", late)["says"] == "pymeshlab took longer than 0.001 s"


def report(verdict: Verdict, reason: str = "") -> CheckReport:
    facts = Facts.of(b.cube(1).to_mesh())
    return CheckReport("union", verdict, reason, facts, None, 1.0, None, 0.0, 0.0, "manifold3d")


def said(name: str, agrees: bool | None) -> Any:
    says = "says so"
    return {"name": name, "version": "", "agrees": agrees, "says": says, "facts": None,
            "seconds": 0.0}  # fmt: skip


COUNTS, LAB, SCAD = "crossing counts", "pymeshlab", "openscad"


@pytest.mark.parametrize(
    ("verdict", "others", "ruling", "words"),
    [
        (Verdict.AGREE, [], "agree", ""),
        (Verdict.AGREE, [(LAB, True)], "agree", ""),
        (Verdict.AGREE, [(LAB, False), (COUNTS, True)], "agree", "only pymeshlab differs"),
        (Verdict.AGREE, [(LAB, False), (COUNTS, False)], "DISAGREE", "crossing counts"),
        (Verdict.DISAGREE, [(COUNTS, None)], "DISAGREE", "no other engine could decide"),
        (Verdict.DISAGREE, [(LAB, True)], "oracle failed", "only manifold3d differs"),
        (Verdict.DISAGREE, [(LAB, False)], "DISAGREE", "all other engines differ from bspcsg"),
        (
            Verdict.DISAGREE,
            [(LAB, True), (SCAD, False)],
            "DISAGREE",
            "all other engines differ from bspcsg",
        ),
        (Verdict.DISAGREE, [(LAB, True), (COUNTS, False)], "DISAGREE", "crossing counts"),
        (Verdict.ORACLE_FAILED, [(LAB, True)], "oracle failed", "pymeshlab agrees with bspcsg"),
        (Verdict.ORACLE_FAILED, [(LAB, False), (COUNTS, None)], "DISAGREE", "pymeshlab says so"),
        (
            Verdict.ORACLE_REFUSED,
            [(LAB, False), (COUNTS, True)],
            "oracle failed",
            "confirm the result",
        ),
        (Verdict.ORACLE_REFUSED, [(COUNTS, True)], "oracle refused", ""),
        (Verdict.SUBJECT_FAILED, [(LAB, True)], "subject failed", "why"),
    ],
)
def test_ruling(
    verdict: Verdict, others: list[tuple[str, bool | None]], ruling: str, words: str
) -> None:
    reason = "" if verdict is Verdict.AGREE else "why"
    found = verdict_of(report(verdict, reason), [said(*other) for other in others], None)
    assert found[0] == ruling and words in found[1] and reason in found[1]


def test_broken_identity_fails_us_whoever_agrees() -> None:
    broken: Any = {"equation": "1 = 2", "holds": False}
    found = verdict_of(report(Verdict.AGREE), [said(LAB, True)], broken)
    assert found == ("subject failed", "the volumes violate the identity 1 = 2")


def test_openscad_counts_alone_about_its_own_language() -> None:
    assert verdict_of(report(Verdict.AGREE), [said(SCAD, False)], None, True)[0] == "DISAGREE"
    assert verdict_of(report(Verdict.AGREE), [said(SCAD, None)], None, True)[0] == "agree"


def test_child_without_pymeshlab_is_no_opinion(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    child = tmp_path / "child.py"
    told = json.dumps({"missing": "no module"})
    child.write_text(
        f"import pathlib, sys\npathlib.Path(sys.argv[1], 'said.json').write_text({told!r})\n"
        "sys.exit(6)\n"
    )
    monkeypatch.setattr(pymeshlab_engine, "_CHILD", child)
    assert opinion("pymeshlab", question())["says"] == "pymeshlab could not be loaded: no module"
    child.write_text("import os, signal\nos.kill(os.getpid(), signal.SIGSEGV)\n")
    assert (
        opinion("pymeshlab", question())["says"]
        == "the process of pymeshlab ended with exit code -11"
    )


def test_inertia_of_a_mesh_is_that_of_its_solid() -> None:
    mesh = b.box((1, 2, 3)).translate(100, 0, 0).to_mesh()
    expected = np.diag([2**2 + 3**2, 1 + 3**2, 1 + 2**2]) * 6 / 12
    assert np.allclose(mesh.inertia, expected, rtol=1e-12)
    assert np.isnan(b.Solid.empty().to_mesh().inertia).all()
