"""The pages on design name files, functions and constants that are there."""

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ARCHITECTURE = ROOT / "core" / "ARCHITECTURE.md"
PAGES = [ARCHITECTURE, *sorted((ROOT / "docs" / "design").glob("*.md"))]

#: The folders where the paths of a page may start, and so a path may be shortened to its end.
_STARTS = (ROOT, ROOT / "core", ROOT / "core" / "src")

_PLACE = re.compile(r"`([\w.]+(?:/[\w.{},]+)+/?|[\w.]+\.(?:rs|py|md))(?:::(\w+))?`")
_CONSTANT = re.compile(r"\| `([A-Z_]+)` \| ([^|]+) \| `([^`]+)` \|")
_WORD = re.compile(r"`([A-Za-z_]\w*(?:::\w+)*)`")
_LINK = re.compile(r"\]\(([^)#:]+)\)")


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def places() -> Iterator[tuple[str, str, str]]:
    for page in PAGES:
        for path, name in dict.fromkeys(_PLACE.findall(text_of(page))):
            yield page.name, path, name


def resolved(path: str) -> list[Path]:
    """Return the files and folders that a path may mean; a lone file name is looked for."""
    found = [start / path for start in _STARTS if (start / path).exists()]
    return found or [file for file in sources() if file.as_posix().endswith(f"/{path}")]


@cache
def sources() -> tuple[Path, ...]:
    roots = (ROOT / "core" / "src", ROOT / "core" / "tests", ROOT / "bspcsg", ROOT / "tests")
    return tuple(
        file for root in roots for kind in ("*.rs", "*.py") for file in sorted(root.rglob(kind))
    )


def words_in(path: Path) -> set[str]:
    files = [path] if path.is_file() else sorted(path.rglob("*.rs"))
    return {word for file in files for word in re.findall(r"\w+", file.read_text(encoding="utf-8"))}


@cache
def all_words() -> frozenset[str]:
    stubs = ROOT / "bspcsg" / "_core.pyi"
    return frozenset(word for file in (*sources(), stubs) for word in words_in(file))


def test_there_are_pages_and_places() -> None:
    assert len(PAGES) >= 9
    assert len(list(places())) > 150


@pytest.mark.parametrize(("page", "path", "name"), list(places()))
def test_a_place_is_there(page: str, path: str, name: str) -> None:
    found = resolved(path)
    assert found, f"{page} names {path}, which is not there"
    if name:
        assert any(name in words_in(file) for file in found), f"{page}: no {name} in {path}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_names_in_code_type_are_names_of_the_code(page: Path) -> None:
    text = re.sub(r"```.*?```", "", text_of(page), flags=re.DOTALL)
    named = {part for word in _WORD.findall(text) for part in word.split("::")}
    assert named - all_words() - {"bspcsg", "mypy", "stubtest"} == set()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_constants_have_the_values_that_are_told(page: Path) -> None:
    for name, value, path in _CONSTANT.findall(text_of(page)):
        code = (ROOT / path).read_text(encoding="utf-8")
        given = re.search(rf"\bconst {name}: \w+ = ([^;]+);", code)
        assert given, f"{page.name}: {path} has no constant {name}"
        assert number(value) == number(given[1]), f"{page.name}: {name} is {given[1]}"


def number(text: str) -> float:
    """Return the value of a constant, as code or as prose writes it."""
    plain = text.translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")).replace("_", "")
    if power := re.match(r"(?:(\d+)·)?(2|10)(?=[⁰¹²³⁴⁵⁶⁷⁸⁹])", text):
        base, exponent = int(power[2]), int(plain[power.end() :].split()[0])
        return float(int(power[1] or 1) * base**exponent)
    if shift := re.fullmatch(r"(\d+) << (\d+)", plain):
        return float(int(shift[1]) << int(shift[2]))
    if quotient := re.match(r"([\d.]+) ?/ ?([\d.]+)", plain):
        return float(quotient[1]) / float(quotient[2])
    return float(plain.split()[0])


def test_numbers_are_read_as_they_are_meant() -> None:
    assert number("8192 elements") == number("1 << 13") == number("2¹³ words")
    assert number("3·10⁸ pairs") == number("3e8")
    assert number("1/4 of the tolerance") == number("0.25")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in _LINK.findall(text_of(page)):
        assert (page.parent / target).exists(), f"{page.name} links to {target}"


@pytest.mark.parametrize("page", PAGES[1:], ids=lambda page: page.name)
def test_a_page_goes_from_notation_to_invariants(page: Path) -> None:
    headings = re.findall(r"^## (.*)$", text_of(page), re.MULTILINE)
    assert headings[:1] == ["Notation"]
    wanted = ["Notation", "The idea", "Invariants", "Limits"]
    assert [heading for heading in headings if heading in wanted] == wanted


def test_the_architecture_is_read_in_fifteen_minutes() -> None:
    assert len(text_of(ARCHITECTURE).splitlines()) <= 250
