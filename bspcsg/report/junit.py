"""JUnit XML for build servers, with the results of campaigns or of checked meshes."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple
from xml.etree import ElementTree as Xml

from ..campaign.record import CaseRecord, RunRecord

#: The XML element of a test case by the verdict of a campaign's case; other verdicts are passes.
_ELEMENTS = {
    "DISAGREE": "failure",
    "subject failed": "failure",
    "timeout": "error",
    "crash": "error",
    "refused": "skipped",
    "oracle refused": "skipped",
    "oracle failed": "skipped",
}

#: Characters that XML 1.0 cannot represent.
_UNWRITABLE = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


class JUnitCase(NamedTuple):
    """One test case of JUnit; `element` is "failure", "error", "skipped", or empty for a pass."""

    group: str
    name: str
    verdict: str
    element: str = ""
    reason: str = ""
    details: str = ""
    output: str = ""
    seconds: float | None = None


def junit_text(cases: Sequence[CaseRecord], runs: Sequence[RunRecord] = ()) -> str:
    """Return the JUnit XML of a campaign: a suite for each operation, a test case for each case.

    Parameters
    ----------
    cases : sequence of CaseRecord
    runs : sequence of RunRecord
        The runs of the campaign; their commands, versions and machines become properties.
    """
    suites = {
        operation: [_case_of(case) for case in cases if case["operation"] == operation]
        for operation in sorted({case["operation"] for case in cases})
    }
    started = runs[0]["started"] if runs else ""
    return junit_of("bspcsg crosscheck", suites, started, _properties(runs))


def junit_of(
    title: str,
    suites: Mapping[str, Sequence[JUnitCase]],
    started: str = "",
    properties: Sequence[tuple[str, str]] = (),
) -> str:
    """Return a JUnit XML document.

    Parameters
    ----------
    title : str
    suites : mapping of str to sequence of JUnitCase
        The test cases of each suite, by its name.
    started : str
        The start time of the run; empty to omit it.
    properties : sequence of (str, str)
        Properties of the run, repeated in every suite.
    """
    whole = [case for cases in suites.values() for case in cases]
    root = Xml.Element("testsuites", _counts(whole), name=title)
    for name, cases in suites.items():
        suite = Xml.SubElement(root, "testsuite", _counts(cases), name=_clean(name))
        if started:
            suite.set("timestamp", started)
        if properties:
            told = Xml.SubElement(suite, "properties")
            for key, value in properties:
                Xml.SubElement(told, "property", name=key, value=_clean(value))
        for case in cases:
            _add_case(suite, case)
    Xml.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{Xml.tostring(root, encoding="unicode")}\n'


def _case_of(case: CaseRecord) -> JUnitCase:
    return JUnitCase(
        f"{case['kind']}.{case['operation']}",
        case["case"],
        case["verdict"],
        _ELEMENTS.get(case["verdict"], ""),
        case["reason"],
        _details(case),
        case["command"],
        case["seconds"]["total"],
    )


def _counts(cases: Iterable[JUnitCase]) -> dict[str, str]:
    kinds = [case.element for case in cases]
    found = {
        "tests": str(len(kinds)),
        "failures": str(kinds.count("failure")),
        "errors": str(kinds.count("error")),
        "skipped": str(kinds.count("skipped")),
    }
    times = [case.seconds for case in cases if case.seconds is not None]
    return {**found, "time": f"{sum(times):.3f}"} if times or not kinds else found


def _properties(runs: Sequence[RunRecord]) -> list[tuple[str, str]]:
    told = []
    for run in runs:
        named = {"command": run["command"], "seed": run["seed"], **run["versions"]}
        told += [(name, str(value)) for name, value in {**named, **run["machine"]}.items()]
    return told


def _add_case(suite: Xml.Element, case: JUnitCase) -> None:
    element = Xml.SubElement(
        suite, "testcase", classname=_clean(case.group), name=_clean(case.name)
    )
    if case.seconds is not None:
        element.set("time", f"{case.seconds:.3f}")
    if case.element:
        message = _clean(f"{case.verdict}: {case.reason}".rstrip(": "))
        found = Xml.SubElement(element, case.element, message=message)
        if case.element != "skipped":
            found.set("type", case.verdict)
            found.text = _clean(case.details)
    said = Xml.SubElement(element, "system-out")
    said.text = _clean(f"{case.verdict}\n{case.output}")


def _details(case: CaseRecord) -> str:
    lines = [case["reason"], f"key: {case['key']}"]
    lines += [
        f"{oracle['name']} {oracle['version']}: {oracle['says']}" for oracle in case["oracles"]
    ]
    files = [str(operand["file"]) for operand in case["operands"] if operand["file"]]
    return "\n".join([*lines, *files, f"again: {case['command']}"])


def _clean(text: str) -> str:
    return _UNWRITABLE.sub("\ufffd", text)
