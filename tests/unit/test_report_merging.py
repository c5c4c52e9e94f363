"""Merging the results of parts of a campaign."""

import json
from itertools import permutations
from pathlib import Path
from typing import Any

import pytest

import bspcsg as b
from bspcsg.report.merging import document, merged, versions_of
from support.results import Record, case, disagreeing, header, write_results


@pytest.fixture(scope="module")
def agreeing() -> Record:
    return case("corner", "union", b.cube(2), b.cube(2).translate(1, 1, 1))


def test_the_order_of_the_files_does_not_matter(tmp_path: Path, agreeing: Record) -> None:
    early, late = header(), header(started="2026-03-02T00:00:00+00:00", seed=8)
    again = agreeing | {"verdict": "crash"}
    paths = [
        write_results(tmp_path / "1.jsonl", [early, agreeing]),
        write_results(tmp_path / "2.jsonl", [late, again]),
        write_results(tmp_path / "3.jsonl", [early, disagreeing()]),
    ]
    found = [document(merged(order)) for order in permutations(paths)]
    assert len(set(found)) == 1
    results: dict[str, Any] = json.loads(found[0])
    # The case that was run twice counts as in the run that was started last.
    assert results["verdicts"] == {"DISAGREE": 1, "crash": 1} and results["cases"] == 2
    assert [run["seed"] for run in results["runs"]] == [7, 8]


def test_the_last_line_about_a_case_counts(tmp_path: Path, agreeing: Record) -> None:
    lines = [header(), agreeing | {"verdict": "timeout"}, agreeing]
    results = merged([write_results(tmp_path / "r.jsonl", lines)])
    assert [found["verdict"] for found in results.cases.values()] == ["agree"]


def test_a_torn_last_line_is_left_out(tmp_path: Path, agreeing: Record) -> None:
    path = write_results(tmp_path / "r.jsonl", [header(), agreeing])
    path.write_text(path.read_text("utf-8") + '{"schema": 1, "type": "ca')
    assert len(merged([path]).cases) == 1


def test_versions_of_all_runs() -> None:
    runs: Any = [header(versions={"numpy": "2.1"}), header(versions={"numpy": "2.2"})]
    assert versions_of(runs) == {"numpy": ["2.1", "2.2"]}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no case"),
        ('{"schema": 1, "type": "run"}\n', "run has no 'command'"),
        ("solid cube\n", ":1: this line is not a record of a results file"),
        ('{"schema": 99, "type": "run"}\n', "schema 99"),
        ('{"schema": 1, "type": "case", "key": "k"}\n', "case has no 'bounds'"),
    ],
)
def test_what_is_no_results_file(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "r.jsonl"
    path.write_text(text)
    with pytest.raises(b.FormatError, match=words):
        merged([path])


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"operands": {}}, "case.operands is not of type list"),
        ({"operands": [{"name": "a"}]}, r"case.operands\[0\] has no 'file'"),
        ({"seconds": 3}, "case.seconds is not a JSON object"),
        ({"memory_mb": "much"}, "case.memory_mb is not a finite number"),
        ({"memory_mb": float("nan")}, "case.memory_mb is not a finite number"),
        ({"verdict": None}, "case.verdict is not of type str"),
        (
            {"hausdorff": {"forward": 0, "backward": 0, "samples": 1.5}},
            "samples is not of type int",
        ),
    ],
)
def test_a_case_of_another_form_is_named(
    tmp_path: Path, agreeing: Record, changes: Record, words: str
) -> None:
    path = write_results(tmp_path / "r.jsonl", [header(), agreeing | changes])
    with pytest.raises(b.FormatError, match=words):
        merged([path])
