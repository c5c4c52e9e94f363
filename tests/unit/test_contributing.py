"""CONTRIBUTING names things that are there, and its walks go from file to file in one direction."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
PLACES = sorted(set(re.findall(r"`([\w.]+(?:/[\w.]*)+)`", TEXT)))
WALKS = {
    title: re.findall(r"^\d+\. `([\w./]+)`", steps, re.MULTILINE)
    for title, steps in re.findall(r"\*\*(A [^*]+)\*\*, in [^:]+:\n\n(.*?)\n\n", TEXT, re.DOTALL)
}


def test_there_are_places_and_walks() -> None:
    assert len(PLACES) > 60
    assert len(WALKS) == 3
    assert all(len(files) > 9 for files in WALKS.values())


@pytest.mark.parametrize("place", PLACES)
def test_a_place_is_there(place: str) -> None:
    assert (ROOT / place).exists()


@pytest.mark.parametrize("walk", WALKS)
def test_a_walk_passes_each_file_once(walk: str) -> None:
    assert len(WALKS[walk]) == len(set(WALKS[walk]))


@pytest.mark.parametrize("walk", WALKS)
def test_each_step_goes_to_a_file_that_an_earlier_one_names(walk: str) -> None:
    files = WALKS[walk]
    for place, file in enumerate(files[1:], 1):
        earlier = [(ROOT / before).read_text(encoding="utf-8") for before in files[:place]]
        assert any(leads_to(text, file) for text in earlier), f"nothing leads to {file}"


def leads_to(text: str, file: str) -> bool:
    """Say whether a file's text imports another file, or what the binding has of it."""
    path = Path(file)
    if path.parent.name == "verbs":
        # A user comes to it from outside.
        return True
    if path.parts[:3] == ("core", "src", "python"):
        # Python knows the binding as one module.
        return "_core import" in text
    if imports(text, path.stem):
        return True
    package = ROOT / path.parent / "__init__.py"
    return (
        imports(text, path.parent.name)
        and package.exists()
        and imports(package.read_text("utf-8"), path.stem)
    )


def imports(text: str, name: str) -> bool:
    """Say whether a module is imported by a text, or started by its name."""
    found = rf"\b(import|from|use)\b.*\b{name}\b|\"bspcsg[\w.]*\.{name}\""
    return re.search(found, text) is not None
