"""Defects of the core lead to one error and a report with the input, and the program continues."""

import json
import os
import re
import stat
import tempfile
import zipfile
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg import _core, defect
from bspcsg.errors import core_errors, from_core


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr(defect, "_numbers", iter(range(1, 1000)))
    return tmp_path


def report_of(error: BaseException) -> zipfile.ZipFile:
    named = re.search(r"the file (\S+\.zip),", str(error))
    assert named is not None, str(error)
    assert stat.S_IMODE(Path(named[1]).stat().st_mode) == 0o600
    return zipfile.ZipFile(named[1])


def facts_of(error: BaseException) -> dict[str, object]:
    with report_of(error) as archive:
        facts: dict[str, object] = json.loads(archive.read("report.json"))
    return facts


@pytest.mark.parametrize("size", [0, 100_000], ids=["own thread", "pool"])
def test_a_panic_is_an_error_with_a_report(size: int, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(b.InternalError, match="a panic on purpose") as caught, core_errors():
        _core.fail_on_purpose(True, size)
    assert caught.value.code == "internal"
    assert re.search(r"a panic at core/src/python/mod\.rs:\d+:\d+: ", str(caught.value))
    facts = facts_of(caught.value)
    assert "a panic on purpose" in str(facts["message"])
    assert facts["bspcsg"] == b.__version__
    assert capfd.readouterr() == ("", ""), "the error says it, and nobody else"
    assert (b.cube(2) - b.cube(1)).volume == 7, "the library goes on"


def test_a_defect_that_is_no_panic_has_a_report_too() -> None:
    with pytest.raises(b.InternalError, match="a failure on purpose") as caught, core_errors():
        _core.fail_on_purpose(False, 0)
    assert facts_of(caught.value)["message"] == "a failure on purpose"


def test_a_report_holds_the_operands_and_the_program() -> None:
    ball, box = b.sphere(2), b.box((1, 2, 3)).translate((0.5, 0, 0))
    error = _core.CoreError("broken")
    error.code, error.where, error.message = "internal", [], "broken"
    error.call = "Tree.evaluate"
    program = [("leaf", [0]), ("leaf", [1]), ("or", [0, 1])]
    error.inputs = {
        "program": program,
        "operand-0": ball.tree,
        "operand-1": box.tree,
        "vertices": np.eye(3),
        "strange": object(),
    }
    raised = from_core(error)
    facts = facts_of(raised)
    assert facts["call"] == "Tree.evaluate"
    inputs = facts["inputs"]
    assert isinstance(inputs, dict)
    assert inputs["program"] == [[name, lines] for name, lines in program]
    assert inputs["operand-0"] == "operand-0.snapshot"
    with report_of(raised) as archive:
        operands = [_core.Tree.load(archive.read(f"operand-{k}.snapshot")) for k in (0, 1)]
        with archive.open("vertices.npy") as file:
            assert (np.load(file, allow_pickle=False) == np.eye(3)).all()
    again = _core.Tree.evaluate(program, operands)
    assert again.volume6_exact(2**60) == (ball | box).tree.volume6_exact(2**60)


def test_a_defect_of_a_real_call_names_its_operand() -> None:
    tree = (b.cube(2) - b.cube(1)).tree
    with pytest.raises(_core.CoreError) as caught:
        tree.given_arrays()
    assert caught.value.code == "internal"
    assert facts_of(from_core(caught.value))["inputs"] == {"operand-0": "operand-0.snapshot"}


def test_a_report_that_cannot_be_written_hides_nothing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "missing"))
    with pytest.raises(b.InternalError, match=r"report it with the input\.$"), core_errors():
        _core.fail_on_purpose(True, 0)


def test_an_operand_that_cannot_be_written_is_named() -> None:
    error = _core.CoreError("broken")
    error.code, error.where, error.message = "internal", [], "broken"
    error.call, error.inputs = "call", {"objects": np.array([object()]), "size": 3}
    facts = facts_of(from_core(error))
    inputs = facts["inputs"]
    assert isinstance(inputs, dict)
    assert "not written" in str(inputs["objects"])
    assert inputs["size"] == 3


def test_a_process_writes_few_reports(folder: Path) -> None:
    for _ in range(40):
        with pytest.raises(b.InternalError), core_errors():
            _core.fail_on_purpose(False, 0)
    assert len(os.listdir(folder)) == 16


# Found: extraction started again when it met a defect of its own.
def test_no_result_depends_on_a_defect() -> None:
    """Only what makes an error, or words for one, knows that it is about a defect."""
    core = Path(__file__).resolve().parents[2] / "core" / "src"
    asking = {
        path.relative_to(core).as_posix()
        for path in core.rglob("*.rs")
        if "ErrorKind::Internal" in path.read_text("utf-8")
    }
    assert asking == {
        "error.rs",
        "interrupt.rs",
        "merge/evaluate.rs",
        "python/calls/errors.rs",
    }
