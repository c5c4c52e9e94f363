"""Links between Markdown files, and paths and names in code type, lead to existing things."""

import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from manual import API, TITLES

ROOT = Path(__file__).resolve().parents[2]

#: Pages whose code type names files, and names in them as `path::name`.
PAGES = [
    ROOT / "CONTRIBUTING.md",
    ROOT / "core" / "ARCHITECTURE.md",
    *sorted((ROOT / "docs" / "design").glob("*.md")),
]

#: The folders where such a path may start; a lone file name is looked for.
STARTS = (ROOT, ROOT / "core", ROOT / "core" / "src")

LINK = re.compile(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)")
PLACE = re.compile(r"`([\w.]+(?:/[\w.{},]+)+/?|[\w.]+\.(?:rs|py|md))(?:::(\w+))?`")
ENTRY = re.compile(r"`([\w./]+)` `(\w+)`")


def text_of(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def markdown() -> list[Path]:
    """Return the Markdown files of the repository that git does not ignore."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return [path for name in done.stdout.splitlines() if (path := ROOT / name).exists()]


def dead_links(page: Path) -> Iterator[str]:
    generated = {API / f"{name}.md" for name in ("index", *TITLES)}
    for link in LINK.findall(text_of(page)):
        target = (page.parent / link).resolve()
        if not (target.exists() or target in generated):
            yield f"{page.relative_to(ROOT)}: {link}"


def test_links_lead_somewhere() -> None:
    pages = markdown()
    assert len(pages) > 50
    assert [link for page in pages for link in dead_links(page)] == []


@cache
def sources() -> tuple[Path, ...]:
    roots = (ROOT / "core" / "src", ROOT / "core" / "tests", ROOT / "bspcsg", ROOT / "tests")
    return tuple(path for root in roots for kind in ("*.rs", "*.py") for path in root.rglob(kind))


def resolved(path: str) -> list[Path]:
    """Return the files and folders that a path in a text may refer to."""
    found = [start / path for start in STARTS if (start / path).exists()]
    return found or [file for file in sources() if file.as_posix().endswith(f"/{path}")]


def has(path: Path, name: str) -> bool:
    files = [path] if path.is_file() else path.rglob("*.rs")
    return any(re.search(rf"\b{name}\b", text_of(file)) for file in files)


def dead_places(text: str) -> list[str]:
    return [
        f"{path}::{name}"
        for path, name in dict.fromkeys(PLACE.findall(text))
        if not any(not name or has(found, name) for found in resolved(path))
    ]


def test_paths_and_names_of_design_pages_are_there() -> None:
    assert [(page.name, dead) for page in PAGES for dead in dead_places(text_of(page))] == []


def test_places_of_the_glossary_are_there() -> None:
    entries = ENTRY.findall(text_of(ROOT / "docs" / "glossary.md"))
    assert len(entries) > 50
    assert [place for place in entries if not has(ROOT / place[0], place[1])] == []


def test_what_is_dead_is_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = "`tests/unit/test_links.py::dead_places` `mesh/grid.rs` `none.rs` `mesh/grid.rs::No`"
    assert dead_places(text) == ["none.rs::", "mesh/grid.rs::No"]
    assert not has(ROOT / "bspcsg" / "errors.py", "Findings")
    page = tmp_path / "page.md"
    page.write_text("[a](page.md#b) [c](https://d) [e](none.md) ![f](none.png)")
    monkeypatch.setattr(sys.modules[__name__], "ROOT", tmp_path)
    assert list(dead_links(page)) == ["page.md: none.md", "page.md: none.png"]
