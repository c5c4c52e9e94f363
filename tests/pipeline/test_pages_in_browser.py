"""HTML pages in a real browser, opened as files."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from selenium.webdriver.common.keys import Keys

import bspcsg as b
from bspcsg.cli.main import run
from bspcsg.report.campaign_page import report_page
from bspcsg.report.merging import merged
from bspcsg.report.viewer.layer import COLOURS, Layer
from bspcsg.report.viewer.view_page import view_page
from support.browser import Browser, started
from support.cli import put
from support.results import records, write_results
from support.shapes import cuboid

#: The reference picture of the view of `_parts`, as small as its shapes can be told apart.
_REFERENCE = Path(__file__).parent.parent / "corpus" / "pictures" / "view.png"

_DRAWN = "document.querySelector('.stage[data-drawn]')"


@pytest.fixture(scope="module")
def blind() -> Iterator[Browser]:
    """Yield a browser without WebGL."""
    with started(webgl=False) as running:
        yield running


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("results")
    results = merged([write_results(folder / "r.jsonl", records(folder))])
    page = folder / "report.html"
    page.write_text(report_page(results), encoding="utf-8")
    return page


@pytest.fixture(scope="module")
def view(tmp_path_factory: pytest.TempPathFactory) -> Path:
    page = tmp_path_factory.mktemp("view") / "view.html"
    page.write_text(view_page(_parts(), "a drilled cube & a ball", unit="mm"), encoding="utf-8")
    return page


@pytest.fixture(scope="module")
def checked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the page that `check` writes for a ball with a hole."""
    folder = tmp_path_factory.mktemp("checked")
    vertices, faces = b.sphere(r=1, segments=16).to_mesh()
    put(str(folder / "open.off"), (vertices, np.delete(faces, [100, 101], axis=0)))
    assert run(["check", str(folder / "open.off"), "--html", str(folder / "check.html"), "-q"]) == 1
    return folder / "check.html"


@pytest.fixture(scope="module")
def compared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the page that `compare` writes for two boxes."""
    folder = tmp_path_factory.mktemp("compared")
    files = [str(folder / f"{height}.off") for height in (2, 3)]
    for name, height in zip(files, (2, 3), strict=True):
        put(name, cuboid((0, 0, 0), (2, 2, height)))
    page = folder / "compare.html"
    assert run(["compare", *files, "--html", str(page), "-q"]) == 1
    return page


def _parts() -> list[Layer]:
    drilled = b.cube(2, center=True) - b.cylinder(h=4, r=0.6, segments=24, center=True)
    ball = b.sphere(r=0.5, segments=24).translate(0, 0, 1.5)
    meshes = [drilled.to_mesh(), ball.to_mesh()]
    names = ("drilled", "ball")
    return [
        Layer(name, mesh.vertices, mesh.faces, colour)
        for name, mesh, colour in zip(names, meshes, COLOURS, strict=False)
    ]


def _change(before: "np.ndarray", after: "np.ndarray") -> float:
    """Return the fraction of pixels that differ clearly."""
    return float((np.abs(before.astype(int) - after).max(axis=2) > 24).mean())


def _set(browser: Browser, selector: str, value: object) -> None:
    browser.run(
        "const e = document.querySelector(arguments[0]); e.value = arguments[1];"
        "for (const kind of ['input', 'change']) e.dispatchEvent(new Event(kind))",
        selector,
        value,
    )


def test_the_report_opens_without_a_network_or_errors(browser: Browser, report: Path) -> None:
    browser.open(report)
    assert browser.texts("h1") == ["Validation report"]
    browser.click("#case-1 .opener")
    browser.wait(_DRAWN)
    assert browser.errors() == []
    asked = browser.requests()
    assert asked[0] == report.as_uri()
    assert all(address.startswith("data:") for address in asked[1:])


_DESKTOP = {"width": 1280, "height": 900, "deviceScaleFactor": 1, "mobile": False}

_LONG = "a_mesh_with_a_rather_long_name_as_people_have_them_v12_final"


def _clipped(browser: Browser, selector: str) -> list[str]:
    """Return the texts of elements that are not entirely visible on a desktop."""
    found = browser.run(
        "return [...document.querySelectorAll(arguments[0])].filter(e =>"
        " e.scrollWidth > e.clientWidth + 1 || e.getBoundingClientRect().right > innerWidth)"
        ".map(e => e.textContent)",
        selector,
    )
    return list(found)


# Found: at the width of a desktop the last columns were outside the window, and names were
# truncated.
def test_all_columns_and_names_are_in_sight(browser: Browser, tmp_path: Path) -> None:
    found = records(tmp_path)
    for one in found:
        if one["type"] == "case":
            one["case"] = f"0001-{_LONG}-{one['case']}"
    results = merged([write_results(tmp_path / "r.jsonl", found)])
    (tmp_path / "report.html").write_text(report_page(results), encoding="utf-8")
    browser.device(_DESKTOP)
    try:
        browser.open(tmp_path / "report.html")
        assert len(browser.texts("#cases th")) > 10
        assert _clipped(browser, ".scroll, #cases th, #cases td") == []
    finally:
        browser.device(None)


def test_names_of_compared_files_are_in_sight(browser: Browser, tmp_path: Path) -> None:
    files = [str(tmp_path / f"{_LONG}_{height}.off") for height in (2, 3)]
    for name, height in zip(files, (2, 3), strict=True):
        put(name, cuboid((0, 0, 0), (2, 2, height)))
    assert run(["compare", *files, "--html", str(tmp_path / "c.html"), "-q"]) == 1
    browser.device(_DESKTOP)
    try:
        browser.open(tmp_path / "c.html")
        browser.wait(_DRAWN)
        assert browser.texts(".notes li")[0] == "The sets differ."
        assert len(browser.texts(".layers button")) == 3
        assert _clipped(browser, ".layers button, .notes li, h1") == []
    finally:
        browser.device(None)


def test_the_table_is_sorted(browser: Browser, report: Path) -> None:
    browser.open(report)
    heads = browser.texts("#cases th")
    column = heads.index("triangles in") + 1
    header, cells = f"#cases th:nth-child({column})", f"#cases td:nth-child({column})"
    orders = []
    for expected in ("ascending", "descending"):
        # From the keyboard, as a button.
        browser.type(f"{header} button", Keys.ENTER)
        assert browser.run(f"return document.querySelector('{header}').ariaSort") == expected
        orders.append([int(text) for text in browser.texts(cells)])
    assert orders[0] == sorted(orders[0]) and orders[1] == orders[0][::-1] != orders[0]
    browser.click("#cases th:nth-child(1) button")
    assert browser.texts("#cases td:nth-child(1)")[0] == "DISAGREE"
    assert browser.run("return document.querySelectorAll('[aria-sort=none]').length") == (
        len(heads) - 1
    )


def test_numbers_are_sorted_as_numbers_and_gaps_come_last(browser: Browser, report: Path) -> None:
    browser.open(report)
    column = browser.texts("#cases th").index("its thickness") + 1
    cells = f"#cases td:nth-child({column})"
    for text, row in (("–", 0), ("1e-12", 1), ("2\u202f000", 2)):
        browser.run(f"document.querySelectorAll('{cells}')[{row}].textContent = '{text}'")
    for _ in range(2):
        browser.click(f"#cases th:nth-child({column}) button")
        assert browser.texts(cells)[-1] == "–"
    assert browser.texts(cells)[0] == "2\u202f000"


def test_the_table_is_filtered_with_its_cards(browser: Browser, report: Path) -> None:
    browser.open(report)
    assert browser.texts("#count") == ["9 of 9 cases"]
    browser.click(".chip[data-verdict=DISAGREE]")
    assert browser.texts("#count") == ["1 of 9 cases"]
    assert browser.texts(".card h3") == ["<b>bump</b>-union"]
    browser.click("#filters button[type=reset]")
    browser.wait("document.getElementById('count').textContent.startsWith('9')")
    browser.type("#words", "BALL diff")
    assert browser.texts("#cases td:nth-child(2)") == ["ball-difference"]
    browser.run("document.getElementById('words').value = ''")
    _set(browser, "#operation", "union")
    assert browser.texts("#count") == ["5 of 9 cases"] and browser.errors() == []


def test_the_view_of_a_case(browser: Browser, report: Path) -> None:
    browser.open(report)
    browser.click("#case-1 .opener")
    browser.wait(_DRAWN)
    assert browser.texts("#case-1 .tools button") == [
        "A", "B", "result", "difference", "parallel", "reset", "close",
    ]  # fmt: skip
    canvas = "#case-1 canvas"
    shown = browser.pixels(canvas)
    red = (shown[:, :, 0] > 150) & (shown[:, :, 1:] < 90).all(axis=2)
    assert red.mean() > 0.003 and _change(np.broadcast_to(shown[5, 5], shown.shape), shown) > 0.1
    browser.click("#case-1 .tools button", 3)
    without = browser.pixels(canvas)
    assert not ((without[:, :, 0] > 150) & (without[:, :, 1:] < 90).all(axis=2)).any()
    browser.click("#case-1 .close")
    assert browser.texts("#case-1 canvas") == [] and browser.texts("#case-1 .opener") != []


def test_axe_finds_nothing_on_pages(
    browser: Browser, report: Path, view: Path, checked: Path, compared: Path
) -> None:
    shown = [(page, "light") for page in (report, view, checked, compared)] + [(report, "dark")]
    for page, theme in shown:
        browser.prefer(theme)
        browser.open(page)
        if page == report:
            browser.click("#case-1 .opener")
        browser.wait(_DRAWN)
        browser.run("for (const part of document.querySelectorAll('details')) part.open = true")
        assert browser.violations() == [], (page.name, theme)
    browser.prefer("light")


def test_axe_finds_what_is_wrong(browser: Browser, view: Path) -> None:
    browser.open(view)
    browser.wait(_DRAWN)
    browser.run("document.querySelector('.tools select').ariaLabel = ''")
    browser.run("document.querySelector('main').append(document.createElement('img'))")
    rules = {finding.partition(":")[0] for finding in browser.violations()}
    assert rules == {"select-name", "image-alt"}


def test_only_a_few_views_are_open_at_once(browser: Browser, report: Path) -> None:
    browser.open(report)
    for number in range(1, 7):
        browser.click(f"#case-{number} .opener")
        browser.wait(f"document.querySelector('#case-{number} .stage[data-drawn]')")
    assert browser.run("return document.querySelectorAll('canvas').length") == 4
    assert browser.texts("#case-1 .opener") != [] and browser.errors() == []


def test_the_view_looks_as_it_did(browser: Browser, view: Path, tmp_path: Path) -> None:
    browser.open(view)
    browser.wait(_DRAWN)
    shown = Image.fromarray(browser.pixels("canvas"))
    small = shown.resize((64, 48), Image.Resampling.BOX)
    small.save(tmp_path / "view.png")
    with Image.open(_REFERENCE) as reference:
        expected = np.asarray(reference.convert("RGB")).astype(int)
    # Renderers differ along edges, which are a small part of all pixels.
    difference = np.abs(np.asarray(small) - expected)
    assert difference.mean() < 4, f"looks different: {tmp_path / 'view.png'}"


def test_the_view_turns_cuts_and_hides(browser: Browser, view: Path) -> None:
    browser.open(view)
    browser.wait(_DRAWN)
    # With the ring of the focus, which stays.
    browser.type("canvas", Keys.ESCAPE)
    first = browser.pixels("canvas")
    browser.type("canvas", Keys.LEFT, Keys.LEFT)
    turned = browser.pixels("canvas")
    browser.type("canvas", Keys.HOME)
    assert _change(first, turned) > 0.02
    assert _change(first, browser.pixels("canvas")) < 0.001
    browser.click(".tools button", 0)
    assert _change(first, browser.pixels("canvas")) > 0.1
    browser.click(".tools button", 0)
    browser.choose("Edges", "none")
    assert 0.0005 < _change(first, browser.pixels("canvas")) < 0.1
    browser.choose("Edges", "features")
    browser.choose("Section", "2")
    assert browser.texts(".tools > output") == ["0.5 mm"]
    halved = browser.pixels("canvas")
    _set(browser, ".tools > input", 900)
    assert browser.texts(".tools > output") == ["1.7 mm"]
    assert _change(halved, browser.pixels("canvas")) > 0.05 and browser.errors() == []


def test_a_section_is_filled(browser: Browser, tmp_path: Path) -> None:
    mesh = b.sphere(r=1, segments=48).to_mesh()
    page = tmp_path / "ball.html"
    page.write_text(view_page([Layer("ball", mesh.vertices, mesh.faces)], "ball"), "utf-8")
    browser.open(page)
    browser.wait(_DRAWN)
    browser.choose("Edges", "none")
    browser.choose("Section", "2")
    cut = browser.pixels("canvas").astype(int)
    height, width, _ = cut.shape
    # Around the middle lies the disk of the cut, in one colour; below it the ball, shaded.
    disk = cut[height // 2 - 20 : height // 2 + 20, width // 2 - 60 : width // 2 + 60]
    assert (np.ptp(disk, axis=(0, 1)) <= 2).all()
    below = cut[int(height * 0.84) : int(height * 0.88), width // 2 - 60 : width // 2 + 60]
    assert (np.ptp(below, axis=(0, 1)) > 8).any()


def test_without_webgl_the_pictures_stay(blind: Browser, report: Path, view: Path) -> None:
    blind.open(report)
    blind.click("#case-1 .opener")
    blind.wait("document.querySelector('#case-1 .say')")
    assert "WebGL turned off" in blind.texts("#case-1 .say")[0]
    assert blind.run("return document.querySelectorAll('canvas').length") == 0
    assert len(blind.texts("#case-1 .pictures img")) == 6
    blind.open(view)
    blind.wait("document.querySelector('.say')")
    picture = blind.pixels(".still")
    assert _change(np.broadcast_to(picture[2, 2], picture.shape), picture) > 0.1
    assert blind.errors() == []


def test_a_solid_in_a_notebook(browser: Browser, tmp_path: Path) -> None:
    page = tmp_path / "cell.html"
    page.write_text(f"<!doctype html><body>{b.cube(1)._repr_html_()}</body>", encoding="utf-8")
    browser.open(page)
    browser.wait("document.querySelector('iframe')")
    colours: set[int] = set()
    for _ in range(100):
        shown = browser.pixels("iframe")
        colours = {int(colour) for colour in shown[100:350, 300:700].astype(int).sum(axis=2).flat}
        if len(colours) > 30:
            break
    assert len(colours) > 30 and browser.errors() == []
