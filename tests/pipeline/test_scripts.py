"""The measuring scripts run, at small counts, on the meshes of the repository."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def run(name: str, *arguments: str) -> "subprocess.CompletedProcess[str]":
    """Run one of the scripts with the interpreter of the tests."""
    return subprocess.run(
        [str(ROOT / "scripts" / name), *arguments],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHON": sys.executable},
        timeout=280,
        check=False,
    )


@pytest.mark.timeout(300)
def test_campaign_goes_on_where_it_stopped(tmp_path: Path) -> None:
    journal = tmp_path / "campaign.jsonl"
    common = ["--meshes", str(ROOT / "examples" / "meshes"), "--results", str(journal), "-j", "2"]
    first = run("campaign", *common, "--pairs", "4")
    assert first.returncode == 0, first.stdout + first.stderr
    answers = [json.loads(line) for line in journal.read_text().splitlines()]
    refused = [answer for answer in answers if answer["verdict"] == "refused"]
    assert [answer["file"] for answer in refused] == ["teapot_open.stl"]
    assert refused[0]["code"] == "not_closed" and refused[0]["where"]
    second = run("campaign", *common, "--pairs", "6")
    assert second.returncode == 0, second.stdout + second.stderr
    longer = [json.loads(line) for line in journal.read_text().splitlines()]
    assert longer[: len(answers)] == answers
    assert len(longer) == len(answers) + 2
    assert "results not sound: 0 of 24" in second.stdout


def test_bench_checks_its_answers() -> None:
    done = run("bench", "cubes", "--quick", "--runs", "1", "--against", "manifold3d")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "agree" in done.stdout


def test_rays_are_compared() -> None:
    done = run("bench_rays", "--quick")
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("bspcsg ") >= 3


def test_probes_print_their_counts() -> None:
    done = run("probes", "--rounds", "0.001")
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count(" 0 failed") >= 9
