"""`scripts/fuzz` reads libFuzzer's output, and detects inputs that hang."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import fuzz
from fuzzing.guided import Guided, outcome_of
from mutants import MUTANTS, Mutant
from recording import REPOSITORY, write_rows

SAID = """INFO: seed corpus: files: 40
#41\tINITED cov: 1200 ft: 3400 corp: 30/9Kb
#900\tNEW    cov: 1234 ft: 3500 corp: 31/9Kb
stat::number_of_executed_units: 901
"""


def test_a_run_without_findings() -> None:
    outcome = outcome_of(SAID, 0)
    assert (outcome.executions, outcome.coverage, outcome.found) == (901, (1200, 1234), [])


@pytest.mark.parametrize(
    ("words", "kind"),
    [
        ("panicked at src/targets/evaluate.rs:12:5:\nleft is not right", "wrong"),
        ("panicked at src/../../core/tests/support/meshes.rs:18:5:\nan edge", "wrong"),
        ("panicked at /home/me/core/src/merge/lists/list.rs:31:21:\noverflow", "crash"),
        ("==7== ERROR: libFuzzer: timeout after 10 seconds", "hang"),
        ("==7== ERROR: libFuzzer: out-of-memory (used: 2049Mb)", "memory"),
        ("=== Uncaught Python exception: ===\nAssertionError: ['raw: x']", "wrong"),
        ("=== Uncaught Python exception: ===\nKeyError: 3", "crash"),
        ("Segmentation fault", "crash"),
    ],
)
def test_findings_have_kinds(words: str, kind: str) -> None:
    said = f"{SAID}{words}\nartifact_prefix='x/'; Test unit written to x/crash-12\n"
    [found] = outcome_of(said.replace("\\\n", "\n"), 77).found
    assert (found.kind, found.place) == (kind, "x/crash-12")


@pytest.mark.parametrize(("work", "count"), [("time.sleep(0.3)", 0), ("spin(0.3)", 1)])
def test_an_input_hangs_by_processor_time(
    work: str, count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program that stops for an input at once, and has its work to do when asked alone."""
    program = tmp_path / "target.py"
    program.write_text(
        f"""import sys, time
def spin(seconds):
    while time.process_time() < seconds:
        pass
if sys.argv[-1].endswith("slow"):
    {work}
else:
    sys.exit("libFuzzer: timeout; Test unit written to {tmp_path}/slow")
"""
    )
    monkeypatch.setattr("fuzzing.guided.SECONDS", 0.2)
    monkeypatch.setattr("fuzzing.guided.MAX_FINDINGS", 1)
    target = Guided("any", [sys.executable, str(program)], tmp_path)
    assert len(target.run(1, time.monotonic() + 60).found) == count


@pytest.mark.parametrize(("seconds", "count"), [(0.0, 0), (0.3, 1)])
def test_inputs_that_ended_late_hang_by_processor_time(
    seconds: float, count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program that tells of a slow input and goes on, as libFuzzer does."""
    program = tmp_path / "target.py"
    program.write_text(
        f"""import pathlib, sys, time
if "slow-unit" in sys.argv[-1]:
    while time.process_time() < {seconds}:
        pass
else:
    pathlib.Path({str(tmp_path)!r}, "any", "found", "slow-unit-12").touch()
"""
    )
    monkeypatch.setattr("fuzzing.guided.SECONDS", 0.2)
    target = Guided("any", [sys.executable, str(program)], tmp_path)
    found = target.run(1, time.monotonic() + 2).found
    assert [each.place[-12:] for each in found] == ["slow-unit-12"] * count


def test_programs_that_never_end_are_stopped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fuzzing.guided.SECONDS", 0.01)
    monkeypatch.setattr("fuzzing.guided.MAX_FINDINGS", 1)
    program = tmp_path / "target.py"
    program.write_text("import time\ntime.sleep(1000)\n")
    target = Guided("any", [sys.executable, str(program)], tmp_path)
    [found] = target.run(1, time.monotonic() + 2).found
    assert (found.kind, found.place) == ("hang", "")


@pytest.mark.parametrize("targets", [["readers"], []])
def test_what_is_missing_is_said_before_anything_runs(
    targets: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["fuzz", *targets])
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    with pytest.raises(SystemExit) as ended:
        fuzz.main()
    assert ended.value.code == 2 and "readers needs atheris" in capsys.readouterr().err


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.what)
def test_mutants_change_one_place_of_the_source(mutant: Mutant) -> None:
    source = REPOSITORY / "core" / "src" / mutant.file
    assert source.read_text(encoding="utf-8").count(mutant.old) == 1
    file, *names = mutant.tests
    tests = (REPOSITORY / "core" / "tests" / f"{file}.rs").read_text(encoding="utf-8")
    assert all(f"fn {name}(" in tests for name in names)


def test_records_keep_what_earlier_runs_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    order = ["first", "second", "third"]
    earlier = [{"mutant": what, "verdict": "noticed"} for what in ("gone", "second", "third")]
    (tmp_path / "mutants.json").write_text(json.dumps({"mutants": earlier}))
    monkeypatch.setattr("recording.RECORDS", tmp_path)
    again = [{"mutant": what, "verdict": "SURVIVED"} for what in ("third", "first")]
    path = write_rows("mutants", again, "mutant", order)
    rows = json.loads(path.read_text("utf-8"))["mutants"]
    assert [row["verdict"] for row in rows] == ["SURVIVED", "noticed", "SURVIVED"]
    assert [row["mutant"] for row in rows] == order and ["commit" in row for row in rows] == [
        True,
        False,
        True,
    ]


ROUNDS = """
import sys, time
sys.path[:0] = sys.argv[1:]
from fuzzing import rounds

def judged(seed: int, at: int) -> tuple[list[str], str]:
    began = time.process_time()
    while time.process_time() - began < (0.6 if at < 4 else 20):
        pass
    return [], ""

rounds.SECONDS, rounds.one_scene = 1, judged
rounds.rounds("scenes", 1, 0, time.monotonic() + 60)
"""


def test_a_round_is_ended_by_its_own_time_and_not_by_that_of_all() -> None:
    command = [
        sys.executable,
        "-c",
        ROUNDS,
        *(str(REPOSITORY / name) for name in ("scripts", "tests")),
    ]
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    assert [json.loads(line)["round"] for line in ran.stdout.splitlines()] == [0, 1, 2, 3, 4]
    assert ran.returncode == -signal.SIGPROF
