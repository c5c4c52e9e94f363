"""The page that `bspcsg report` writes: the results of a campaign."""

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ..campaign.record import CaseRecord, FactsRecord, Results, is_failure
from ..campaign.summary import counts_by_verdict
from .assets import asset, bundle, rendered
from .campaign_cards import PageBudget, cards_of, cases_for_cards
from .case_table import table
from .charts import Chart, share_below
from .formatting import meaning, milliseconds, number, tone, vector, whole
from .merging import ordered, versions_of

#: An estimate of the number of characters of one card without its pictures and its 3D view.
_CARD_TEXT_CHARACTERS = 4_000

_FILES = ("page.css", "report.css", "loader.js", "table.js")

_FACTS: tuple[tuple[str, str, Any], ...] = (
    ("volume", "volume", lambda value: number(value, 12)),
    ("area", "area", lambda value: number(value, 12)),
    ("triangles", "triangles", whole),
    ("vertices", "vertices", whole),
    ("euler_number", "Euler number", whole),
    ("components", "surfaces", whole),
    ("open_edges", "open edges", whole),
    ("self_intersections", "self-intersections", whole),
    ("centroid", "centroid", vector),
)


def report_page(
    results: Results,
    cards: int = 40,
    title: str = "Validation report",
    watch: Callable[[list[CaseRecord]], Iterable[CaseRecord]] = iter,
) -> str:
    """Return the page of a campaign's results as HTML.

    Parameters
    ----------
    results : Results
    cards : int
        The number of cases shown with pictures and all their numbers, failures first.
    title : str
    watch : callable
        Returns an iterable over the cases of cards, which may show progress while they are drawn.

    Raises
    ------
    MissingPartError
        If Jinja2 is not installed.
    """
    cases = ordered(results)
    chosen = cases_for_cards(results, cards)
    columns, rows = table(cases, {case["key"]: f"case-{k + 1}" for k, case in enumerate(chosen)})
    # Besides its text, each cell and each row has tags.
    spent = sum(60 + sum(4 + len(cell) for cell in row.cells) for row in rows)
    spent += (
        len(bundle())
        + sum(len(asset(name)) for name in _FILES)
        + _CARD_TEXT_CHARACTERS * len(chosen)
    )
    page = rendered(
        "report.html",
        title=title,
        lead=_lead(results),
        failed=any(map(is_failure, cases)),
        verdicts=[
            (name, count, tone(name), meaning(name))
            for name, count in counts_by_verdict(cases).items()
        ],
        charts=_charts(results),
        runs=results.runs,
        versions=versions_of(results.runs),
        columns=columns,
        rows=rows,
        operations=sorted({case["operation"] for case in cases}),
        cards=list(cards_of(watch(chosen), results, PageBudget(len(chosen), spent))),
        total=len(cases),
        facts=_facts,
        number=number,
        whole=whole,
        vector=vector,
        milliseconds=milliseconds,
    )
    return re.sub(r"\n\s+", "\n", page)


def _lead(results: Results) -> str:
    failures = sum(map(is_failure, results.cases.values()))
    count = f"{whole(len(results.cases))} case{'s' if len(results.cases) != 1 else ''}"
    return f"{count}, {whole(failures) if failures else 'no'} failure{'s' if failures > 1 else ''}"


def _facts(ours: FactsRecord | None, oracles: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the names of the engines that made a mesh, and rows of measures of the meshes.

    The keys are "engines" and "rows".
    """
    made = [("bspcsg", ours), *((oracle["name"], oracle["facts"]) for oracle in oracles)]
    made = [(name, facts) for name, facts in made if facts is not None]
    rows = [
        (title, [shown(facts[key]) for _, facts in made])
        for key, title, shown in _FACTS
        if any(facts[key] is not None for _, facts in made)
    ]
    return {"engines": [name for name, _ in made], "rows": rows}


def _charts(results: Results) -> list[tuple[str, str, Chart]]:
    """Return the charts of times and of differences that have data: title, axis name, chart."""
    times: dict[str, list[float]] = {"bspcsg": []}
    ratios = []
    for case in results.cases.values():
        if case["ours"]:
            times["bspcsg"].append(case["seconds"]["ours"])
        for oracle in case["oracles"]:
            if oracle["facts"]:
                times.setdefault(oracle["name"], []).append(oracle["seconds"])
        found, bounds = case["set_difference"], case["bounds"]
        if found and bounds and bounds["same_set"] > 0:
            ratios.append(found["thickness"] / bounds["same_set"])
    # Names tell the number of cases, since an engine may have run in hard cases only.
    timed = [(f"{name}, {whole(len(found))} cases", found) for name, found in times.items()]
    drawn = (
        ("Time of the operation", "seconds", share_below(timed)),
        (
            "Thickness of the difference",
            "thickness / bound; up to 1 it is the same set",
            share_below([("bspcsg and oracle", ratios)]),
        ),
    )
    return [(title, axis, chart) for title, axis, chart in drawn if chart is not None]
