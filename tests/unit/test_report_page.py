"""The HTML page of a report, as text."""

import re
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg.campaign.record import VERDICTS, Results
from bspcsg.report import campaign_cards
from bspcsg.report.campaign_cards import Card, PageBudget, cards_of
from bspcsg.report.campaign_page import report_page
from bspcsg.report.charts import share_below
from bspcsg.report.formatting import meaning, milliseconds, number, tone, vector, whole
from bspcsg.report.merging import merged
from support.results import case, header, keep_meshes, records, write_results
from support.shapes import icosphere


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    folder = tmp_path_factory.mktemp("results")
    return merged([write_results(folder / "r.jsonl", records(folder))])


@pytest.fixture(scope="module")
def page(results: Results) -> str:
    return report_page(results)


def attributes(page: str, name: str) -> list[str]:
    return re.findall(rf'\b{name}="([^"]*)"', page)


def test_all_cases_are_in_the_table_and_failures_come_first(page: str) -> None:
    rows = re.findall(r"<tr class=.*", page)
    assert len(rows) == 9 and "DISAGREE" in rows[0]
    assert "9 cases, 1 failure" in page
    assert attributes(page, "data-verdict") == ["DISAGREE", "agree"]
    read = re.sub("<[^>]+>", "", page)
    assert (
        "commandbspcsg crosscheck a.stl b.stl --seed 7 " in read and "a processor, 2 cores" in read
    )


def test_every_verdict_has_a_meaning_and_those_that_occur_are_explained(page: str) -> None:
    assert all(map(meaning, VERDICTS)) and meaning("unheard of") == ""
    explained = re.findall(r'<dt class="tone-\w+">([^<]+)</dt><dd>([^<]+)</dd>', page)
    assert explained == [(name, meaning(name)) for name in ("DISAGREE", "agree")]
    assert "makes of the same operands" in page and "up to 1 it is the same set" in page


def test_cards_show_pictures_numbers_and_the_command(page: str) -> None:
    first = page[page.index('id="case-1"') : page.index('id="case-2"')]
    assert "DISAGREE" in first and "the sets differ by more than rounding" in first
    # Both operands, the result, and three images on each other for the difference.
    assert len(re.findall(r'<img src="data:image/', first)) == 6
    assert "8.125" in first and "same set up to" in first and "volume 0.125" in first
    assert "bspcsg union a.stl b.stl -o out.stl" in first and "cad/a.stl" in first
    assert (
        "exactly the same set" in page
        and page.count("The meshes of this case were not stored") == 2
    )


def test_nothing_of_a_record_is_taken_for_markup(page: str) -> None:
    assert "&lt;b&gt;bump&lt;/b&gt;" in page and "<b>bump</b>" not in page


def test_the_page_asks_for_nothing_else(page: str) -> None:
    assert "default-src 'none'" in page
    addresses = attributes(page, "src") + attributes(page, "href")
    assert addresses and all(address.startswith(("data:", "#")) for address in addresses)
    assert "@import" not in page and "url(" not in page


def test_cards_are_as_many_as_asked_for(results: Results) -> None:
    page = report_page(results, cards=2, title="A & B")
    assert page.count("<article") == 2 and "2 of 9 cases" in page
    assert "A &amp; B" in page and "<article" not in report_page(results, cards=0)


def test_views_are_simplified_or_left_out_to_stay_within_the_size(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(campaign_cards, "still_picture", lambda *_, **__: "a picture")
    # Shuffled, because regular meshes are packed into next to nothing.
    rng = np.random.default_rng(5)
    vertices, faces = icosphere(4)
    places = rng.permutation(len(vertices))
    ball = b.Solid(vertices[places], rng.permutation(np.argsort(places)[faces]))
    record = case("cubes", "union", b.cube(1), b.cube(1))
    kept = keep_meshes(record, tmp_path, [], ball, ball)
    results = merged([write_results(tmp_path / "r.jsonl", [header(), kept])])

    def card(left: float) -> Card:
        budget = PageBudget(1, 0)
        budget.left = left
        (found,) = cards_of(list(results.cases.values()), results, budget)
        spent = sum(len(image) for figure in found.figures for image in figure.images)
        assert budget.left == left - spent - (len(found.model["data"]) if found.model else 0)
        return found

    roomy = card(1e6)
    assert roomy.model is not None and roomy.note == ""
    pictures = sum(len(image) for figure in roomy.figures for image in figure.images)
    limit = 0.9 * len(roomy.model["data"])
    tight = card(pictures + limit)
    assert tight.model is not None and len(tight.model["data"]) < limit
    assert "of 5\u202f120 triangles to fit on this page" in tight.note
    assert (
        card(1000).model is None
        and "a smaller number of cards leaves more space" in card(1000).note
    )


def test_each_view_gets_its_share() -> None:
    budget = PageBudget(40, 300_000)
    first = budget.allowance()
    assert 20_000 < first < 60_000
    for _ in range(38):
        budget.spend(10_000 + int(budget.allowance()))
    assert 0 <= budget.allowance() <= budget.left
    # A long table leaves cards their part of the page.
    assert (
        PageBudget(40, 10**9).left > 300_000
        and PageBudget(80, 0).left > 1.9 * PageBudget(40, 0).left
    )


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("../outside.npz", "out of the folder of the results"),
        ("none.npz", "none.npz: cannot read these meshes"),
        ("text.npz", "text.npz: cannot read these meshes"),
    ],
)
def test_meshes_that_cannot_be_read_are_said(tmp_path: Path, name: str, words: str) -> None:
    (tmp_path / "text.npz").write_text("no meshes")
    record = case("cubes", "union", b.cube(1), b.cube(1)) | {"meshes": name}
    page = report_page(merged([write_results(tmp_path / "r.jsonl", [header(), record])]))
    assert words in page and "data-model" not in page.split("<script")[0]


def test_without_pillow_pictures_stay_svg(
    results: Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "PIL", None)
    page = report_page(results)
    assert "image/webp" not in page and "image/svg+xml" in page


def test_without_jinja_the_line_to_type_is_said(
    results: Results, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    from bspcsg.report import assets

    monkeypatch.setitem(sys.modules, "jinja2", None)
    assets._environment.cache_clear()
    with pytest.raises(b.MissingPartError, match="pip install 'jinja2"):
        report_page(results)
    assert b.cube(1)._repr_html_() is None


def test_curves_rise_from_the_share_of_zeros_to_all() -> None:
    chart = share_below([("some", [0.0, 0.0, 1e-3, 1e-1])])
    assert chart is not None
    (curve,) = chart.curves
    heights = [float(y) for y in re.findall(r"[V,]([\d.]+)", curve.path)]
    assert heights == sorted(heights, reverse=True)
    share = (chart.bottom - heights[0]) / (chart.bottom - chart.top)
    assert share == pytest.approx(0.5) and heights[-1] == chart.top
    assert [mark.text for mark in chart.across] == ["0.001", "0.01", "0.1"]
    assert share_below([("none", [0.0])]) is None and share_below([]) is None


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (None, 6, "–"),
        (0.0, 6, "0"),
        (8.0, 6, "8"),
        (1234567.89, 6, "1\u202f234\u202f568"),
        (-0.125, 6, "-0.125"),
        (1.5e-9, 3, "1.5e-09"),
        (6812612667.92, 6, "6.81261e+09"),
        (6812612667.92, 12, "6\u202f812\u202f612\u202f667.92"),
    ],
)
def test_numbers(value: float | None, digits: int, text: str) -> None:
    assert number(value, digits) == text


def test_other_words() -> None:
    assert (whole(12345), whole(None)) == ("12\u202f345", "–")
    assert (milliseconds(0.0123), milliseconds(12.3)) == ("12.3", "12\u202f300")
    assert vector([1, 2.5, -3]) == "1, 2.5, -3"
    assert [tone(verdict) for verdict in ("agree", "refused", "DISAGREE")] == [
        "good",
        "mute",
        "bad",
    ]
