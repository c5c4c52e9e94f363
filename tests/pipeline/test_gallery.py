"""The gallery shows pictures that are there, and names the examples that write them."""

import re
from pathlib import Path

from support.examples import WRITES

EXAMPLES = Path(__file__).parents[2] / "examples"
PAGE = (EXAMPLES / "GALLERY.md").read_text()
SHOWN = re.sub(r"<!--.*?-->", "", PAGE, flags=re.DOTALL)
PICTURES = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", SHOWN)


def test_every_picture_is_there_and_small() -> None:
    assert len(PICTURES) >= 7
    for name in PICTURES:
        assert 200 < (EXAMPLES / name).stat().st_size < 100_000


def test_every_committed_picture_is_shown() -> None:
    files = {f"gallery/{path.name}" for path in (EXAMPLES / "gallery").iterdir()}
    assert files == set(PICTURES)


def test_every_picture_is_written_by_an_example_that_is_named() -> None:
    named = re.findall(r"\]\((\d\d_\w+)\.py\)", SHOWN)
    written = set().union(*(WRITES[name] for name in named))
    assert {Path(picture).name for picture in PICTURES} == written


def test_the_report_that_is_linked_is_there_and_of_so_many_cases() -> None:
    pages = {EXAMPLES / "GALLERY.md", EXAMPLES.parent / "README.md"}
    pages.add(EXAMPLES.parent / "docs" / "tasks" / "validate.md")
    for page in pages:
        (link,) = re.findall(r"\]\(([^)]*campaign_report\.html)\)", page.read_text())
        report = (page.parent / link).resolve()
        assert report == EXAMPLES / "campaign_report.html" and " 2120 " in page.read_text()
    text = report.read_text(encoding="utf-8")
    assert "2\N{NARROW NO-BREAK SPACE}120 cases, no failure" in text and len(text) < 1_500_000
