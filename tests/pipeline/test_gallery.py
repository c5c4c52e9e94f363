"""The gallery's pictures exist, and it names the examples that write them."""

import re
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image

from gallery import MAX_BLOCK_LINES, blocks, pictures, run
from support.examples import WRITES

EXAMPLES = Path(__file__).parents[2] / "examples"
PAGE = (EXAMPLES / "GALLERY.md").read_text("utf-8")
SHOWN = re.sub(r"<!--.*?-->", "", PAGE, flags=re.DOTALL)
BLOCKS = blocks()
PICTURES = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", SHOWN)


def test_every_picture_is_there_and_small() -> None:
    assert len(PICTURES) >= 7
    for name in PICTURES:
        assert 200 < (EXAMPLES / name).stat().st_size < 100_000


def test_every_committed_picture_is_shown() -> None:
    files = {f"gallery/{path.name}" for path in (EXAMPLES / "gallery").iterdir()}
    assert files == set(PICTURES)


def test_every_picture_is_written_by_code_that_is_shown_or_named() -> None:
    named = re.findall(r"\]\((\d\d_\w+)\.py\)", SHOWN)
    written = set().union(*(WRITES.get(name, set()) for name in named), *map(pictures, BLOCKS))
    assert {Path(picture).name for picture in PICTURES} == written


# Found: the gallery showed no code.
@pytest.mark.sampled(3)
@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: pictures(block)[0])
def test_the_code_on_the_page_makes_the_picture_below_it(block: str, tmp_path: Path) -> None:
    lines = [line for line in block.splitlines() if line]
    assert sum(not line.startswith(("import ", "from ")) for line in lines) <= MAX_BLOCK_LINES
    run(block, tmp_path)
    (name,) = pictures(block)
    assert f"](gallery/{name})" in SHOWN.split(block)[1].split("```")[1]
    made, kept = (_small(folder / "gallery" / name) for folder in (tmp_path, EXAMPLES))
    assert made.shape == kept.shape
    # Fonts and lines may differ by a shade between versions of matplotlib and FreeType.
    assert np.abs(made - kept).mean() < (1 if mpl.__version__.startswith("3.11.") else 6)


def _small(path: Path) -> "np.ndarray":
    """Return a picture in grey values up to 255, reduced to a fourth of its width."""
    with Image.open(path) as picture:
        return np.asarray(picture.convert("L").reduce(4), dtype=float)


def test_the_report_that_is_linked_is_there_and_of_so_many_cases() -> None:
    pages = {EXAMPLES / "GALLERY.md", EXAMPLES.parent / "README.md"}
    pages.add(EXAMPLES.parent / "docs" / "tasks" / "validate.md")
    for page in pages:
        (link,) = re.findall(r"\]\(([^)]*campaign_report\.html)\)", page.read_text("utf-8"))
        report = (page.parent / link).resolve()
        assert report == EXAMPLES / "campaign_report.html" and " 2120 " in page.read_text("utf-8")
    text = report.read_text(encoding="utf-8")
    assert "2\N{NARROW NO-BREAK SPACE}120 cases, no failure" in text and len(text) < 1_500_000
