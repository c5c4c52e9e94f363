"""The site is built without warnings, has no broken links, and loads nothing from a network."""

import re
import zlib
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

from support.browser import Browser, started
from support.cli import script
from support.documents import DOCS, ROOT

#: Building the site takes long.
pytestmark = pytest.mark.deep

#: Attributes by which a page loads something, or leads somewhere.
_LOADED = {
    ("script", "src"),
    ("img", "src"),
    ("source", "src"),
    ("iframe", "src"),
    ("link", "href"),
}
_LED = {("a", "href")}

#: A style sheet's or a script's way to load something.
_FETCHED = re.compile(r"(?:url\(|@import |fetch\(|src=)['\"]?(?:https?:)?//[^'\")]+")


class _Page(HTMLParser):
    """A page's loaded files, its links, and its anchors."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.loaded: list[str] = []
        self.led: list[str] = []
        self.places: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if value is None:
                continue
            if name == "id":
                self.places.add(value)
            elif (tag, name) in _LOADED:
                self.loaded.append(value)
            elif (tag, name) in _LED:
                self.led.append(value)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of the site, built in strict mode."""
    out = tmp_path_factory.mktemp("site") / "site"
    done = script("site", str(out))
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stderr == ""
    return out


@pytest.fixture(scope="module")
def pages(site: Path) -> dict[Path, _Page]:
    return {path: _Page(path) for path in site.rglob("*.html")}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with started(webgl=False) as running:
        yield running


def test_every_page_of_the_manual_is_a_page_of_the_site(site: Path) -> None:
    for path in DOCS.rglob("*.md"):
        assert (site / path.relative_to(ROOT).with_suffix(".html")).exists()


def test_links_lead_somewhere(pages: dict[Path, _Page]) -> None:
    checked = 0
    for path, page in pages.items():
        for link in page.led + page.loaded:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            assert target.is_file(), f"{path.name}: {link}"
            # Furo's link to the top of a page has no place of its own.
            if parts.fragment and target in pages:
                assert unquote(parts.fragment) in pages[target].places, f"{path.name}: {link}"
            checked += 1
    assert checked > 1000


def test_nothing_is_loaded_from_a_network(site: Path, pages: dict[Path, _Page]) -> None:
    for path, page in pages.items():
        for link in page.loaded:
            assert not urlsplit(link).netloc and urlsplit(link).scheme in ("", "data"), path
    for pattern in ("*.css", "*.js"):
        for path in site.rglob(pattern):
            assert not _FETCHED.findall(path.read_text(encoding="utf-8")), path


def test_pages_are_searched_without_a_server(site: Path, browser: Browser) -> None:
    browser.open(site / "search.html")
    browser.type("input[name=q]", "minkowski\n")
    browser.wait("document.querySelectorAll('.search li').length > 2")
    assert any("Modelling" in text for text in browser.texts(".search li a"))
    assert browser.errors() == []


# Found: the search led from terms that other programs use to an internal page, or to none.
@pytest.mark.parametrize(
    ("word", "page"),
    [
        ("watertight", "docs/tasks/scans.html"),
        ("non-manifold", "docs/tasks/scans.html"),
        ("screw thread", "docs/tasks/making.html"),
        ("color", "docs/tasks/assemblies.html"),
        ("Solid.min_gap", "docs/api/solid.html#bspcsg.Solid.min_gap"),
    ],
)
def test_the_search_leads_from_words_to_their_pages(
    site: Path, browser: Browser, word: str, page: str
) -> None:
    browser.open(site / "search.html")
    browser.type("input[name=q]", f"{word}\n")
    browser.wait("document.querySelectorAll('.search li').length > 0")
    browser.wait(f"document.querySelector('.search li a').getAttribute('href') === '{page}'")


def test_names_of_python_are_in_the_inventory_and_are_links(site: Path) -> None:
    data = (site / "objects.inv").read_bytes().split(b"\n", 4)[4]
    names = {
        line.split()[0] for line in zlib.decompress(data).decode().splitlines() if " py:" in line
    }
    assert {"bspcsg.Solid", "bspcsg.Solid.fillet", "bspcsg.bsp.RayCaster"} < names and len(
        names
    ) > 500
    shapes = (site / "docs/api/shapes.html").read_text(encoding="utf-8")
    assert shapes.count('href="solid.html#bspcsg.Solid"') > 5
    index = (site / "docs/api/index.html").read_text(encoding="utf-8")
    assert 'href="shapes.html#bspcsg.cylinder"' in index
    tutorial = (site / "docs/tutorials/manifold3d.html").read_text(encoding="utf-8")
    assert 'href="../api/operations.html#bspcsg.union"' in tutorial


def test_pages_speak_to_screen_readers_and_keyboards(site: Path, browser: Browser) -> None:
    browser.size(390, 844)
    browser.open(site / "docs/index.html")
    browser.wait("document.querySelector('.sidebar-drawer[aria-label]')")
    assert browser.run("return document.documentElement.lang") == "en"
    silent = "return document.querySelectorAll('[role=heading]:not([aria-level])').length"
    assert browser.run(silent) == 0
    wide = "[...document.querySelectorAll('pre')].filter(e => e.scrollWidth > e.clientWidth)"
    assert browser.run(f"return {wide}.length") > 0
    assert browser.run(f"return {wide}.every(e => e.tabIndex == 0)")


@pytest.mark.parametrize(("theme", "width"), [("light", 1280), ("dark", 390)])
def test_axe_finds_nothing_on_pages(site: Path, browser: Browser, theme: str, width: int) -> None:
    browser.prefer(theme)
    browser.size(width, 844)
    for name in ("docs/index", "docs/tutorials/first_part", "docs/api/solid", "lecture"):
        browser.open(site / f"{name}.html")
        assert browser.violations() == [], name


def test_the_lecture_is_led_to(site: Path, pages: dict[Path, _Page]) -> None:
    page = site / "lecture.html"
    leading = {
        path.relative_to(site).as_posix()
        for path, read in pages.items()
        if any((path.parent / link).resolve() == page for link in read.led)
    }
    assert leading == {"docs/lecture.html", "docs/verbs/lecture.html"}


def test_options_keep_their_hyphens(site: Path) -> None:
    assert "--check=off" in (site / "docs/verbs/union.html").read_text(encoding="utf-8")


def test_pages_fit_a_phone(site: Path, browser: Browser) -> None:
    browser.size(390, 844)
    for name in ("docs/index", "docs/verbs/union", "docs/api/solid", "docs/tasks/scans"):
        browser.open(site / f"{name}.html")
        assert browser.run("return document.documentElement.scrollWidth") <= 390, name
        assert browser.errors() == []


def test_a_phone_shows_buttons_apart_and_pictures_large(site: Path, browser: Browser) -> None:
    browser.size(390, 844)
    browser.open(site / "examples/GALLERY.html")
    widths = browser.run("return [...document.querySelectorAll('td img')].map(e => e.clientWidth)")
    assert len(widths) > 11 and min(widths) > 120
    apart = browser.run(
        "const buttons = [...document.querySelectorAll('.mobile-header .header-right > *')];"
        "const [theme, contents] = buttons.map(e => e.getBoundingClientRect());"
        "return contents.left - theme.right"
    )
    assert apart >= 8
