"""The measuring scripts run, at small counts, on the meshes of the repository."""

import json
from pathlib import Path

import pytest

from support.cli import script

ROOT = Path(__file__).parents[2]


@pytest.mark.timeout(300)
def test_campaign_goes_on_where_it_stopped(tmp_path: Path) -> None:
    journal = tmp_path / "campaign.jsonl"
    common = ["--meshes", str(ROOT / "examples" / "meshes"), "--results", str(journal), "-j", "2"]
    first = script("campaign", *common, "--pairs", "4")
    assert first.returncode == 0, first.stdout + first.stderr
    answers = [json.loads(line) for line in journal.read_text().splitlines()]
    refused = [answer for answer in answers if answer["verdict"] == "refused"]
    assert [answer["file"] for answer in refused] == ["teapot_open.stl"]
    assert refused[0]["code"] == "not_closed" and refused[0]["where"]
    second = script("campaign", *common, "--pairs", "6")
    assert second.returncode == 0, second.stdout + second.stderr
    longer = [json.loads(line) for line in journal.read_text().splitlines()]
    assert longer[: len(answers)] == answers
    assert len(longer) == len(answers) + 2
    assert "results not sound: 0 of 24" in second.stdout


def test_bench_checks_its_answers() -> None:
    done = script("bench", "--quick", "--runs", "1")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "spheres" in done.stdout


def test_rays_are_compared() -> None:
    done = script("bench_rays", "--quick")
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count("bspcsg ") >= 3


def test_probes_print_their_counts() -> None:
    done = script("probes", "--rounds", "0.001")
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count(" 0 failed") >= 9
