"""What CONTRIBUTING names is there, and its walks follow imports of the folders they pass."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
PLACES = sorted(set(re.findall(r"`([\w.]+(?:/[\w.]*)+)`", TEXT)))
WALKS = [walk for walk in re.findall(r"\*\*A [^*]+\*\*([^*]+?)\n\n", TEXT) if "→" in walk]


def test_there_are_places_and_walks() -> None:
    assert len(PLACES) > 30
    assert len(WALKS) == 3


@pytest.mark.parametrize("place", PLACES)
def test_a_place_is_there(place: str) -> None:
    assert (ROOT / place).exists()


@pytest.mark.parametrize("walk", WALKS)
def test_a_walk_passes_each_file_of_the_core_once(walk: str) -> None:
    files = [file for file in re.findall(r"`([\w./]+)`", walk) if file.startswith("core/")]
    assert len(files) == len(set(files))
