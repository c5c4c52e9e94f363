"""Summaries of campaigns: counts, JUnit XML and Markdown, for any names of cases."""

from typing import Any
from xml.etree import ElementTree as Xml

import pytest

from bspcsg.campaign.cases.case import Case, Operand
from bspcsg.campaign.judging.evaluation import blank_record
from bspcsg.campaign.record import VERDICTS
from bspcsg.campaign.running.runner import run_record
from bspcsg.campaign.summary import conclusion, summary_of
from bspcsg.report.junit import junit_text
from bspcsg.report.markdown import markdown_text


def record(verdict: str, name: str = "0001-union", reason: str = "", **more: Any) -> Any:
    operands = (Operand("a", "a|b.stl", "00"), Operand("b", "b.stl", "11"))
    case = Case(
        name, "pose", "union", operands, "corner", 1, 2, "bspcsg crosscheck 'a|b.stl' b.stl"
    )
    return {**blank_record(case, verdict, reason), **more}


ALL = [record(verdict, f"{number:04d}") for number, verdict in enumerate(VERDICTS)]


def test_summary_counts_everything() -> None:
    broken = {"identity": {"equation": "1 = 2", "holds": False}}
    found = summary_of([*ALL, record("subject failed", "9999", "no sum", **broken)])
    assert found["cases"] == len(VERDICTS) + 1 and found["verdicts"]["subject failed"] == 2
    assert found["identities"] == {"checked": 1, "broken": 1}
    assert found["poses"] == {"corner": len(VERDICTS) + 1}
    assert set(found["failures"]) == {"0000", "0001", "0002", "0003", "9999"}
    assert found["failures"]["9999"] == "subject failed: no sum"
    assert conclusion(ALL) == "4 of 10 cases failed."


def test_junit_sorts_verdicts_by_what_a_build_does_about_them() -> None:
    suite = Xml.fromstring(junit_text(ALL, [run_record("bspcsg crosscheck", 1)]).encode())
    counts = {name: suite.get(name) for name in ("tests", "failures", "errors", "skipped")}
    assert counts == {"tests": "10", "failures": "2", "errors": "2", "skipped": "3"}
    properties = {one.get("name"): one.get("value") for one in suite.iter("property")}
    assert properties["command"] == "bspcsg crosscheck" and properties["seed"] == "1"


@pytest.mark.parametrize("word", ["a\x00b", "<&\"'>", "\ud800", "]]>", "ä∪b"])
def test_any_text_makes_sound_xml(word: str) -> None:
    text = junit_text([record("crash", word, word)])
    case = next(Xml.fromstring(text.encode()).iter("testcase"))
    kept = word.replace("\x00", "\ufffd").replace("\ud800", "\ufffd")
    assert case.get("name") == kept
    error = case.find("error")
    assert error is not None and error.get("message") == f"crash: {kept}"


def test_markdown_lists_what_matters() -> None:
    text = markdown_text(ALL, [run_record("bspcsg crosscheck", 1)])
    assert "**4 of 10 cases failed.**" in text and "| **" not in text
    assert text.count("\n## ") == 5
    assert "| DISAGREE | 1 | 1 |" in text and "`bspcsg crosscheck`, started" in text


def test_markdown_tables_hold_any_text() -> None:
    text = markdown_text([record("crash", "a|b", "one\ntwo")])
    row = next(line for line in text.splitlines() if "one two" in line)
    assert row.replace("\\|", "").count("|") == 5


def test_long_lists_end() -> None:
    text = markdown_text([record("timeout", str(number)) for number in range(60)])
    assert "and 10 more" in text and text.count("| timeout |") == 51
