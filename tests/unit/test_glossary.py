"""One name for one thing: the glossary's places exist, and public types are defined once."""

import ast
import re
from collections import defaultdict
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

#: Public names that two rooms share, and why.
SHARED = {
    "Node": "the API has had `bspcsg.csg.Node` and `bspcsg.bsp.Node` from the beginning",
}

PLACE = re.compile(r"`([\w./]+)` `(\w+)`")

ENTRIES = [
    (word.strip(), python.strip(), rust.strip())
    for line in (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8").splitlines()
    if line.startswith("| ") and not line.startswith(("| word", "| ---"))
    for _, word, _, python, rust, _ in [line.split("|")]
]


def defines(path: Path, name: str) -> bool:
    """Say whether a file, or one in a folder, gives this name to something."""
    files = [path] if path.is_file() else sorted(path.rglob("*.rs"))
    rust = rf"\b(?:struct|enum|trait|type|fn|const) {name}\b"
    python = rf"^ *(?:class|def) {name}\b|^ *{name}\b[^=\n]*="
    texts = ((file.suffix, file.read_text(encoding="utf-8")) for file in files)
    return any(re.search(rust if kind == ".rs" else python, text, re.M) for kind, text in texts)


@pytest.mark.parametrize(("word", "python", "rust"), ENTRIES, ids=[word for word, *_ in ENTRIES])
def test_what_the_glossary_names_is_there(word: str, python: str, rust: str) -> None:
    places = [place for place in (python, rust) if place]
    assert places, f"{word} lives nowhere"
    for place in places:
        found = PLACE.fullmatch(place)
        assert found, place
        assert defines(ROOT / found[1], found[2]), f"{word}: there is no {found[2]} in {found[1]}"


def test_a_missing_name_is_noticed() -> None:
    assert defines(ROOT / "bspcsg" / "errors.py", "Finding")
    assert not defines(ROOT / "bspcsg" / "errors.py", "Findings")
    assert not defines(ROOT / "core" / "src" / "store", "Fragment")


def test_the_glossary_has_each_word_once_and_enough_of_them() -> None:
    words = [word for word, *_ in ENTRIES]
    assert len(words) == len(set(words)) >= 50


def test_public_types_of_the_package_are_defined_once() -> None:
    homes: defaultdict[str, list[str]] = defaultdict(list)
    for path in sorted((ROOT / "bspcsg").rglob("*.py")):
        for name in types_of(path):
            homes[name].append(path.relative_to(ROOT).as_posix())
    assert len(homes) > 150
    twice = {name: places for name, places in homes.items() if len(places) > 1}
    assert set(twice) == set(SHARED), twice


def types_of(path: Path) -> list[str]:
    """Return the public classes and type aliases of a module."""
    found = []
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef):
            found.append(node.name)
        elif isinstance(node, ast.AnnAssign) and "TypeAlias" in ast.unparse(node.annotation):
            found.append(ast.unparse(node.target))
    return [name for name in found if not name.startswith("_")]
