"""Campaigns as JUnit XML, which every build server shows."""

import re
from collections.abc import Sequence
from xml.etree import ElementTree as Xml

from ..campaign.record import CaseRecord, RunRecord

#: The element for each verdict, for a build server; the others passed.
_ELEMENTS = {
    "DISAGREE": "failure",
    "subject failed": "failure",
    "timeout": "error",
    "crash": "error",
    "refused": "skipped",
    "oracle refused": "skipped",
    "oracle failed": "skipped",
}

#: Characters that XML 1.0 has no way to write.
_UNWRITABLE = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def junit_text(cases: Sequence[CaseRecord], runs: Sequence[RunRecord] = ()) -> str:
    """Return a suite for each operation, with a test case for each case.

    Parameters
    ----------
    cases : sequence of CaseRecord
    runs : sequence of RunRecord
        The runs whose commands, versions and machine become properties.
    """
    root = Xml.Element("testsuites", _counts(cases), name="bspcsg validate")
    for operation in sorted({case["operation"] for case in cases}):
        part = [case for case in cases if case["operation"] == operation]
        suite = Xml.SubElement(root, "testsuite", _counts(part), name=operation)
        if runs:
            suite.set("timestamp", runs[0]["started"])
            _describe_runs(suite, runs)
        for case in part:
            _add_case(suite, case)
    Xml.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{Xml.tostring(root, encoding="unicode")}\n'


def _counts(cases: Sequence[CaseRecord]) -> dict[str, str]:
    kinds = [_ELEMENTS.get(case["verdict"], "passed") for case in cases]
    found = {
        "tests": len(cases),
        "failures": kinds.count("failure"),
        "errors": kinds.count("error"),
        "skipped": kinds.count("skipped"),
    }
    seconds = sum(case["seconds"]["total"] for case in cases)
    return {**{name: str(count) for name, count in found.items()}, "time": f"{seconds:.3f}"}


def _describe_runs(suite: Xml.Element, runs: Sequence[RunRecord]) -> None:
    properties = Xml.SubElement(suite, "properties")
    for run in runs:
        named = {"command": run["command"], "seed": run["seed"], **run["versions"]}
        for name, value in {**named, **run["machine"]}.items():
            Xml.SubElement(properties, "property", name=name, value=_clean(str(value)))


def _add_case(suite: Xml.Element, case: CaseRecord) -> None:
    element = Xml.SubElement(
        suite,
        "testcase",
        classname=f"{case['kind']}.{case['operation']}",
        name=_clean(case["case"]),
        time=f"{case['seconds']['total']:.3f}",
    )
    kind = _ELEMENTS.get(case["verdict"])
    if kind is not None:
        message = _clean(f"{case['verdict']}: {case['reason']}".rstrip(": "))
        found = Xml.SubElement(element, kind, message=message)
        if kind != "skipped":
            found.set("type", case["verdict"])
            found.text = _clean(_details(case))
    said = Xml.SubElement(element, "system-out")
    said.text = _clean(f"{case['verdict']}\n{case['command']}")


def _details(case: CaseRecord) -> str:
    lines = [case["reason"], f"key: {case['key']}"]
    lines += [
        f"{oracle['name']} {oracle['version']}: {oracle['says']}" for oracle in case["oracles"]
    ]
    files = [str(operand["file"]) for operand in case["operands"] if operand["file"]]
    return "\n".join([*lines, *files, f"again: {case['command']}"])


def _clean(text: str) -> str:
    return _UNWRITABLE.sub("\ufffd", text)
