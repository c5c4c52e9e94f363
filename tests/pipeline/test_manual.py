"""The manual is correct: its code runs, and its output is as shown."""

import doctest
import json
import re
import tomllib
from importlib import import_module
from inspect import isfunction, ismodule
from pathlib import Path

import pytest

from bspcsg.cli.main import _VERBS
from manual import api_pages
from support.cli import script
from support.documents import (
    DOCS,
    ROOT,
    RUN,
    SHOWN,
    Session,
    blocks,
    exchanges,
    expected_of,
    looks_like,
    page_files,
    pictures,
    prepare,
    same,
)

PAGES = page_files()


def name(path: Path) -> str:
    return str(path.relative_to(DOCS))


# Found: a page called a method that does not exist.
# Found: the first example of the manual's page on `compare` showed three errors.
@pytest.mark.sampled(3)
@pytest.mark.parametrize("path", PAGES, ids=name)
def test_pages_show_what_happens(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    prepare(tmp_path)
    monkeypatch.chdir(tmp_path)
    session = Session()
    for language, block in blocks(path.read_text("utf-8")):
        assert language in RUN + SHOWN
        if language == "py":
            compile(block, path.name, "exec")
        if language == "json":
            json.loads(block)
        if language == "python":
            assert session.python(block).splitlines() == expected_of(block)
        if language == "console":
            for command, shown in exchanges(block):
                printed = session.command(command)
                assert "Traceback" not in printed
                assert same(printed, shown), f"$ {command}\n{printed}"
    for picture in pictures(path.read_text("utf-8")):
        assert looks_like(tmp_path / picture, path.parent / "pictures" / picture), picture


def test_same_ignores_times_and_versions_only() -> None:
    assert same("x  1.25 s\nmanifold3d 3.5.4\n", "x  0.1 s\nmanifold3d 3.6.0")
    assert not same("x  1.25\n", "x  0.1")
    assert same("a\nb\nc\nd\n", "a\n…\nd") and not same("a\nb\n", "a\n…\nd")
    assert not same("a\n", "") and not same("", "a")


def test_generated_parts_are_up_to_date() -> None:
    done = script("manual", "--check")
    assert done.returncode == 0, done.stdout + done.stderr


def test_every_verb_has_a_page_with_an_example() -> None:
    pages = {path.stem: path.read_text("utf-8") for path in (DOCS / "verbs").glob("*.md")}
    assert set(pages) == set(_VERBS)
    for verb, text in pages.items():
        consoles = [block for language, block in blocks(text) if language == "console"]
        assert any(f"$ bspcsg {verb}" in block for block in consoles), verb


def described(text: str) -> set[str]:
    """Return the names of the objects, without members, that API pages describe."""
    form = r"^::::\{py:(\w+)\} ([\w.]+)"
    names, module = set(), ""
    for role, name in re.findall(form, text, re.MULTILINE):
        if role == "currentmodule":
            module = name
        else:
            names.add(f"{module}.{name}")
    return names


def test_methods_and_types_are_described() -> None:
    page = api_pages()["solid"]
    assert re.search(r"^:::\{py:method\} fillet\(.*\) -> Solid$", page, re.MULTILINE)
    assert ":::{py:property} volume\n:type: float\n" in page
    assert ":::{py:method} from_mesh(" in page and "\n:classmethod:\n" in page
    # What only neighbours may say is no part of the API.
    assert "carried" not in page and "Later" not in page


# Found: the search found "watertight" on one page only, an internal one.
@pytest.mark.parametrize(
    "word", ["watertight", "non-manifold", "screw thread", "color", "STEP", "fillet", "boolean"]
)
def test_words_of_others_lead_somewhere(word: str) -> None:
    text = (DOCS / "glossary.md").read_text("utf-8")
    section = text.partition("## Words used elsewhere\n")[2].partition("\n## ")[0]
    rows = [line.split(" | ") for line in section.splitlines() if line.startswith("| ")]
    leading = [row for row in rows if word in row[0].strip("| ").split(", ")]
    assert len(leading) == 1 and re.search(r"\[.+\]\(.+\.md\)", leading[0][2])


# Found: `bsp.analysis` was on no page of the manual.
def test_every_public_name_is_in_the_api() -> None:
    text = "".join(api_pages().values())
    documented = described(text)
    values = {"__version__", "EDGE", "INTERIOR", "MISS", "VERTEX"}
    top = import_module("bspcsg")
    for package in ("bspcsg", "bspcsg.bsp", "bspcsg.csg"):
        module = import_module(package)
        public = {name for name in module.__all__ if not ismodule(getattr(module, name))} - values
        # What the top has too stands there.
        at_top = {n for n in public & set(top.__all__) if getattr(module, n) is getattr(top, n)}
        assert {f"bspcsg.{name}" for name in at_top} <= documented
        assert {f"{package}.{name}" for name in public - at_top} <= documented
    analysis = import_module("bspcsg.bsp").analysis
    own = {name for name, f in vars(analysis).items() if isfunction(f) and name[0] != "_"}
    own = {name for name in own if getattr(analysis, name).__module__ == analysis.__name__}
    assert {"visit_bound", "growth_table"} < own
    assert {f"bspcsg.bsp.analysis.{name}" for name in own} <= documented


# Found: the examples called the package `b`, which in the examples for trimesh is an operand.
def test_examples_have_one_name_for_the_package() -> None:
    written = [ROOT / "README.md", *PAGES, *(ROOT / "examples").rglob("*.py")]
    written += [*(ROOT / "examples").glob("*.md"), *(ROOT / "bspcsg").rglob("*.py")]
    names = {
        name
        for path in written
        for name in re.findall(r"\bimport bspcsg as (\w+)", path.read_text("utf-8"))
    }
    assert names == {"csg"}


def modules() -> list[str]:
    """Return the names of the package's modules with examples in docstrings."""
    files = [path for path in (ROOT / "bspcsg").rglob("*.py") if ">>> " in path.read_text("utf-8")]
    names = [".".join(path.relative_to(ROOT).with_suffix("").parts) for path in files]
    return sorted(name.removesuffix(".__init__") for name in names)


@pytest.mark.parametrize("module", modules())
def test_examples_of_docstrings(
    module: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    failed, tried = doctest.testmod(import_module(module))
    assert tried and not failed


def test_every_kept_picture_is_shown_and_small() -> None:
    shown = {
        path.parent / "pictures" / name
        for path in PAGES
        for name in pictures(path.read_text("utf-8"))
    }
    assert shown == set(DOCS.glob("**/pictures/*")) and len(shown) >= 4
    assert all(path.stat().st_size < 100_000 for path in shown)


def test_the_install_page_has_every_extra() -> None:
    page = (DOCS / "install.md").read_text("utf-8")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert set(re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE)) == (
        set(project["optional-dependencies"]) - {"test"}
    )
