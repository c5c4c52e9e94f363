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
