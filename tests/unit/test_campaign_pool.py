"""Children that crash or hang fail only their own request."""

import os
from pathlib import Path
from typing import Any

import pytest

from bspcsg.campaign.judging.evaluation import EvaluationSettings
from bspcsg.campaign.running.child import Child, CrashedError, TimedOutError
from bspcsg.campaign.running.pool import LocalPool
from bspcsg.campaign.running.runner import greeting, survey
from support.cli import put
from support.shapes import cube

GREETING = greeting(EvaluationSettings(), None, 1)


@pytest.fixture
def good(tmp_path: Path) -> str:
    put(str(tmp_path / "good.off"), cube(2))
    return str(tmp_path / "good.off")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_crash_and_hang_are_that_request_only(tmp_path: Path, good: str) -> None:
    hanging = tmp_path / "endless.off"
    os.mkfifo(hanging)
    survey, crash = {"survey": good}, {"case": 3.5}
    asked: list[dict[str, Any]] = [survey, {"survey": str(hanging)}, crash, survey, crash, survey]
    found = dict(LocalPool(2, GREETING).answers(asked, 3.0))
    for number in (0, 3, 5):
        assert found[number] == {"file": good, "triangles": 12, "refused": None}
    for number in (2, 4):
        assert found[number]["failure"] == "crash" and "TypeError" in found[number]["reason"]
    assert found[1]["failure"] == "timeout" and found[1]["seconds"] >= 3.0


def test_child_that_cannot_start_says_why(good: str) -> None:
    child = Child({**GREETING, "folder": "/nowhere/at/all"})
    with child, pytest.raises(CrashedError, match="/nowhere/at/all"):
        child.answer({"survey": good}, 10.0)


def test_child_is_started_again_after_a_time_out(good: str) -> None:
    with Child(GREETING) as child:
        with pytest.raises(TimedOutError):
            child.answer({"survey": good}, 0.0)
        assert child.answer({"survey": good}, 20.0)["triangles"] == 12
        child.stop()
        with pytest.raises(CrashedError, match="stopped"):
            child.answer({"survey": good}, 20.0)


def test_closing_the_answers_ends_the_children(good: str) -> None:
    answers = LocalPool(1, GREETING).answers([{"survey": good}] * 50, 20.0)
    assert next(answers)[1]["triangles"] == 12
    answers.close()


def test_file_that_crashes_the_survey_stays_in(good: str) -> None:
    class Shaky:
        """A pool that answers for the first file and crashes at the second."""

        def answers(self, requests: Any, seconds: float) -> Any:
            yield 0, {"file": good, "triangles": 0, "refused": "open"}
            yield 1, {"failure": "crash", "reason": "gone", "seconds": 0.1}

    found = survey([Path("a.stl"), Path("b.stl")], Shaky(), 1.0)
    assert found[Path("a.stl")] == {"triangles": 0, "refused": "open"}
    assert found[Path("b.stl")] == {"triangles": 0, "refused": None}
