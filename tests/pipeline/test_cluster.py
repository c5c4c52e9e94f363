"""Campaigns on the workers of Dask distributed."""

import json
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from bspcsg.campaign.running import cluster
from support.cli import Capture, ran

# Dask starts its event loop and threads in ways that it warns about itself.
pytestmark = pytest.mark.filterwarnings("ignore")


@pytest.fixture
def scheduler() -> Iterator[Any]:
    """Yield a scheduler with one worker of two threads in this process."""
    from distributed import LocalCluster

    place = LocalCluster(  # type: ignore[no-untyped-call]
        n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
    )
    with place:
        yield place


def test_cases_run_on_the_workers(folder: Path, capsys: Capture, scheduler: Any) -> None:
    given = ["crosscheck", "a.off", "c.stl", "--results", "r.jsonl", "--json"]
    where = ["--scheduler", scheduler.scheduler_address]
    code, out, _ = ran(capsys, *given, *where)
    assert code == 0 and json.loads(out)["verdicts"] == {"agree": 4}
    records = [json.loads(line) for line in Path("r.jsonl").read_text("utf-8").splitlines()][1:]
    volumes = {record["operation"]: record["ours"]["volume"] for record in records}
    assert volumes == {"union": 15.0, "difference": 7.0, "intersection": 1.0, "xor": 14.0}
    assert not cluster._children

    Path("scheduler.json").write_text(json.dumps({"address": scheduler.scheduler_address}))
    limits = ["--timeout", "0.0001", "--op", "union", "--scheduler", "scheduler.json"]
    code, out, _ = ran(capsys, "crosscheck", "a.off", "c.stl", "--json", *limits)
    assert code == 1 and json.loads(out)["verdicts"] == {"timeout": 1}


def test_no_scheduler_is_told(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "_TIMEOUT", 0.2)
    given = ["crosscheck", "a.off", "c.stl", "--scheduler", "tcp://127.0.0.1:9"]
    code, _, err = ran(capsys, *given)
    assert code == 6 and err.startswith(
        "bspcsg: error: tcp://127.0.0.1:9: no Dask scheduler answers"
    )


def test_dask_is_optional(folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "find_spec", lambda name: None)
    given = ["crosscheck", "a.off", "c.stl", "--scheduler", "tcp://127.0.0.1:9"]
    code, _, err = ran(capsys, *given)
    assert code == 6 and 'pip install "bspcsg[cluster]"' in err


# Found: `validate` waited for ever without a message.
def test_a_cluster_without_workers_is_told(
    folder: Path, capsys: Capture, scheduler: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "_TIMEOUT", 2)
    scheduler.scale(0)
    given = ["crosscheck", "a.off", "c.stl", "--results", "r.jsonl"]
    code, _, err = ran(capsys, *given, "--scheduler", scheduler.scheduler_address)
    assert code == 6 and "this scheduler has no workers" in err and "--resume" in err


def test_workers_may_come_late(folder: Path, capsys: Capture, scheduler: Any) -> None:
    scheduler.scale(0)
    late = threading.Timer(1, lambda: scheduler.scale(1))
    late.start()
    given = ["crosscheck", "a.off", "c.stl", "--op", "union", "--json"]
    code, out, err = ran(capsys, *given, "--scheduler", scheduler.scheduler_address)
    late.join()
    assert code == 0 and json.loads(out)["verdicts"] == {"agree": 1}, err
