"""`scripts/instructions` fails when a count changes, and says when it cannot compare."""

import json
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest

import instructions
from instructions import CASES, SKIPPED
from recording import REPOSITORY

_HERE = {"compiler": "rustc 1", "instruction set": "x86_64"}


@pytest.fixture
def counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, int]:
    """Return the counts that programs have from now on; records hold 1000 for each case."""
    counts = dict.fromkeys(CASES, 1000)
    monkeypatch.setattr(instructions, "RECORDS", tmp_path)
    monkeypatch.setattr(instructions, "place", lambda: _HERE)
    monkeypatch.setattr(instructions, "built", lambda _: Path("program"))
    monkeypatch.setattr(instructions, "counted", lambda _, case: counts[case])
    monkeypatch.setattr("shutil.which", lambda _: "valgrind")
    _keep(tmp_path, {"place": _HERE, "counts": dict(counts)})
    return counts


def _keep(folder: Path, build: dict[str, Any]) -> None:
    record = {"builds": {"dev": build, "release": build}}
    (folder / "instructions.json").write_text(json.dumps(record), "utf-8")


def test_cases_are_those_of_the_program() -> None:
    program = (REPOSITORY / "core/examples/fixed_cases.rs").read_text("utf-8")
    assert re.findall(r'(?m)^    \("(\w+)", \|\|', program) == list(CASES)


@pytest.mark.parametrize(("count", "code"), [(1029, 0), (971, 0), (1031, 1), (969, 1)])
def test_a_count_more_than_three_percent_off_fails(
    counted: dict[str, int], capsys: pytest.CaptureFixture[str], count: int, code: int
) -> None:
    counted["chain"] = count
    assert instructions.main(["--check"]) == code
    said = capsys.readouterr().out
    assert ("recorded counts: chain." in said) == bool(code)
    assert all(name in said for name in CASES)
    assert instructions.main(["--check", "pair"]) == 0


@pytest.mark.parametrize("place", [{**_HERE, "compiler": "rustc 2"}, {}])
def test_counts_from_elsewhere_are_not_compared(
    counted: dict[str, int],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    place: dict[str, str],
) -> None:
    _keep(tmp_path, {"place": place, "counts": {}})
    assert instructions.main(["--check"]) == SKIPPED
    assert "this is rustc 1" in capsys.readouterr().out


def test_without_valgrind_nothing_is_compared(
    counted: dict[str, int], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("shutil.which", lambda _: None)
    assert instructions.main(["--check"]) == SKIPPED
    assert "valgrind is needed" in capsys.readouterr().out
    with pytest.raises(SystemExit, match="valgrind is needed"):
        instructions.main([])


def test_a_case_without_a_count_fails(counted: dict[str, int], tmp_path: Path) -> None:
    _keep(tmp_path, {"place": _HERE, "counts": {"pair": 1000}})
    assert instructions.main(["--check", "pair"]) == 0
    assert instructions.main(["--check"]) == 1


def test_counts_of_some_cases_are_recorded_beside_those_of_the_same_place(
    counted: dict[str, int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept: list[dict[str, Any]] = []
    monkeypatch.setattr(instructions, "keep", lambda _, result: kept.append(result["builds"]))
    counted["pair"] = 2000
    instructions.main(["--record", "pair"])
    assert kept[0]["dev"]["counts"] == {**dict.fromkeys(CASES, 1000), "pair": 2000}
    _keep(tmp_path, {"place": {}, "counts": dict(counted)})
    instructions.main(["--record", "pair"])
    assert kept[1]["release"] == {"place": _HERE, "counts": {"pair": 2000}}


@pytest.mark.parametrize(("code", "said"), [(0, "0 of 2"), (77, "1 of 2"), (1, "")])
def test_steps_that_cannot_be_done_are_counted(code: int, said: str) -> None:
    check = (REPOSITORY / "scripts/check").read_text("utf-8")
    [step] = re.findall(r"(?ms)^skipped=0$.*?^}$", check)
    asked = f"{step}\nstep one true\nstep two bash -c 'exit {code}'\necho $skipped of 2"
    done = subprocess.run(
        ["bash", "-uc", asked], capture_output=True, encoding="utf-8", check=False
    )
    assert done.returncode == (1 if code == 1 else 0)
    assert said in done.stdout and (code != 77 or "SKIPPED" in done.stdout)
