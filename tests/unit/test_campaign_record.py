"""Results files: lines are appended, and read back whatever a killed writer left."""

import json
from pathlib import Path
from typing import Any

import pytest

import bspcsg as b
from bspcsg.campaign.cases.case import Case, Operand
from bspcsg.campaign.judging.evaluation import blank_record
from bspcsg.campaign.record import Journal, is_failure, read_results
from bspcsg.campaign.running.runner import run_record


def record(name: str, verdict: str = "agree") -> Any:
    operands = (Operand("a", "a.stl", name), Operand("b", "b.stl", "1"))
    return blank_record(Case(name, "pair", "union", operands), verdict, "")


def test_appended_lines_are_read_back(tmp_path: Path) -> None:
    path = tmp_path / "r.jsonl"
    first, second = record("one"), record("two", "DISAGREE")
    with Journal(path) as journal:
        journal.append(run_record("bspcsg validate", 1))
        journal.append(first)
    with Journal(path) as journal:
        journal.append(second)
    found = read_results([path])
    assert found.runs[0]["command"] == "bspcsg validate" and found.runs[0]["machine"]["cores"] > 0
    assert list(found.cases.values()) == [first, second]
    assert [is_failure(case) for case in found.cases.values()] == [False, True]


@pytest.mark.parametrize("kept", range(1, 40, 13))
def test_torn_last_line_is_left_out_and_cut_off(tmp_path: Path, kept: int) -> None:
    path = tmp_path / "r.jsonl"
    with Journal(path) as journal:
        journal.append(record("one"))
    whole = path.read_bytes()
    path.write_bytes(whole + whole[:kept])
    assert len(read_results([path]).cases) == 1
    with Journal(path) as journal:
        journal.append(record("two"))
    assert [json.loads(line)["case"] for line in path.read_text("utf-8").splitlines()] == [
        "one",
        "two",
    ]


def test_latest_line_of_a_case_counts(tmp_path: Path) -> None:
    shards = [tmp_path / "r-1.jsonl", tmp_path / "r-2.jsonl"]
    for path, verdict in zip(shards, ("timeout", "agree"), strict=True):
        with Journal(path) as journal:
            journal.append(record("one", verdict))
    assert [case["verdict"] for case in read_results(shards).cases.values()] == ["agree"]


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("nonsense", "malformed"),
        ("[]", "malformed"),
        ('{"type": "case", "schema": 1}', "malformed"),
        ('{"type": "run", "schema": 2}', "unknown_schema"),
        ("[" * 100_000, "malformed"),
    ],
)
def test_other_files_are_refused(tmp_path: Path, line: str, code: str) -> None:
    path = tmp_path / "r.jsonl"
    path.write_text(line + "\n")
    with pytest.raises(b.FormatError, match=r"r\.jsonl:1: ") as caught:
        read_results([path])
    assert caught.value.code == code


def test_missing_and_unwritable_files_are_told(tmp_path: Path) -> None:
    with pytest.raises(b.FormatError, match="cannot read"):
        read_results([tmp_path / "none.jsonl"])
    with pytest.raises(b.FormatError, match="cannot write"):
        Journal(tmp_path)


def test_key_depends_on_everything_asked() -> None:
    operands = (Operand("a", "a.stl", "00"), Operand("b", "b.stl", "11"))
    same = Case("x", "pose", "union", operands, "random", 1, 2)
    renamed = (Operand("a", "elsewhere.stl", "00"), operands[1])
    assert Case("y", "pose", "union", renamed, "random", 1, 2).key == same.key
    others = [
        Case("x", "pose", "xor", operands, "random", 1, 2),
        Case("x", "pose", "union", operands[::-1], "random", 1, 2),
        Case("x", "pose", "union", operands, "corner", 1, 2),
        Case("x", "pose", "union", operands, "random", 1, 3),
        Case("x", "pose", "union", operands, "random", 2, 2),
    ]
    assert len({same.key, *(case.key for case in others)}) == 6
    assert Case.from_dict(json.loads(json.dumps(same.to_dict()))) == same
