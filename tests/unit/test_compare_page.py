"""The page that compares names with other libraries: ours exist, and none of theirs is missing."""

import re
from pathlib import Path

import manifold3d

import bspcsg as b

PAGE = Path(__file__).parents[2] / "docs" / "compare.md"


def rows(heading: str | None = None) -> list[tuple[str, str]]:
    """Return the first two cells of each table row, below one heading or in the whole page."""
    text = PAGE.read_text("utf-8")
    if heading is not None:
        text = re.split(rf"^## {heading}$", text, flags=re.MULTILINE)[1].split("\n## ")[0]
    lines = [line for line in text.splitlines() if line.startswith("|")]
    cells = [re.split(r"(?<!\\)\|", line)[1:3] for line in lines]
    return [(one, two) for one, two in cells if not set(one) <= set(" -")]


def names(cell: str) -> list[str]:
    """Return the names in code type in a cell, without arguments."""
    return [found[1] for found in re.finditer(r"`([\w.]+)[^`]*`", cell)]


def is_ours(name: str) -> bool:
    """Return true if a dotted name exists in the package."""
    owner = b
    for part in name.removeprefix("bspcsg.").split("."):
        if not hasattr(owner, part):
            return False
        owner = getattr(owner, part)
    return True


def test_every_name_of_ours_exists() -> None:
    cells = [ours for _, ours in rows()]
    assert len(cells) > 20
    missing = [name for cell in cells for name in names(cell) if not is_ours(name)]
    assert missing == []


def test_no_method_of_manifolds_is_missing() -> None:
    told = {name for theirs, _ in rows("Solids") for name in names(theirs)}
    methods = {name for name in dir(manifold3d.Manifold) if not name.startswith("_")}
    assert methods <= told


def test_no_method_of_cross_sections_is_missing() -> None:
    told = {name for theirs, _ in rows("Regions") for name in names(theirs)}
    methods = {name for name in dir(manifold3d.CrossSection) if not name.startswith("_")}
    assert methods <= told


def test_no_node_of_openscad_is_missing() -> None:
    told = {name for theirs, _ in rows("OpenSCAD") for name in names(theirs)}
    assert set(b.csg.node_names()) <= told
    # What is no node of evaluated trees.
    language = "translate rotate scale mirror for intersection_for children echo roof fill"
    assert set(language.split()) <= told
