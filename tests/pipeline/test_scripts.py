"""The measuring scripts run, with small counts, on the meshes of the repository."""

import json
from pathlib import Path

import pytest

from support.cli import script

ROOT = Path(__file__).parents[2]

#: They take long, and what they run has tests of its own.
pytestmark = pytest.mark.deep


def test_campaign_goes_on_where_it_stopped(tmp_path: Path) -> None:
    journal = tmp_path / "campaign.jsonl"
    common = ["--meshes", str(ROOT / "examples" / "meshes"), "--results", str(journal), "-j", "2"]
    first = script("campaign", *common, "--poses", "2")
    assert first.returncode == 0, first.stdout + first.stderr
    assert "1 file left out because it is not a solid" in first.stderr
    answers = journal.read_text("utf-8").splitlines()
    second = script("campaign", *common, "--poses", "3")
    assert second.returncode == 0, second.stdout + second.stderr
    longer = journal.read_text("utf-8").splitlines()
    assert longer[: len(answers)] == answers
    assert len(longer) == len(answers) + 1 + 4
    assert "8 cases of 12 known" in second.stderr
    assert "None of 12 cases failed." in second.stdout


def test_bench_checks_its_answers() -> None:
    done = script("bench", "cubes", "--quick", "--runs", "1", "--against", "manifold3d")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "agree" in done.stdout


def test_rays_are_compared() -> None:
    done = script("bench_rays", "--quick")
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("bspcsg ") >= 3


def test_regions_are_compared() -> None:
    done = script("bench_regions", "--quick")
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("True") == 6


def test_fuzzing_goes_on_where_it_stopped(tmp_path: Path) -> None:
    common = ["scenes", "files", "--minutes", "0.05", "--folder", str(tmp_path)]
    reached = []
    for _ in range(2):
        done = script("fuzz", *common, "--seed", "7")
        assert done.returncode == 0, done.stdout + done.stderr
        assert done.stdout.count(", 0 found") == 2
        states = [
            json.loads((tmp_path / name / "state.json").read_text("utf-8")) for name in common[:2]
        ]
        reached.append([state["7"] for state in states])
    assert all(0 < first < second for first, second in zip(*reached, strict=True))


def test_unknown_targets_are_refused() -> None:
    done = script("fuzz", "nothing", "--minutes", "0.01")
    assert done.returncode == 2 and "no such target: nothing" in done.stderr
