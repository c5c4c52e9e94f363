"""The page on trust names commands that exist, and answers that were given."""

import dataclasses
import re
import shlex
import tomllib
from collections.abc import Callable
from importlib import metadata
from itertools import takewhile
from pathlib import Path

import click
import pytest

import peers
from bspcsg.bench.cases import CASES
from bspcsg.bench.engines import ENGINES, Engine
from bspcsg.cli.main import commands

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/trust.md").read_text(encoding="utf-8")
COMMANDS = sorted(
    set(re.findall(r"`((?:scripts/|cargo |\.venv/bin/python -m pytest )[^`]*)`", PAGE))
)


def test_every_row_has_a_command() -> None:
    assert len(COMMANDS) > 20
    tables = re.findall(r"(?m)^\| .*\|$", PAGE.partition("## Beside")[0])
    bodies = [line for line in tables if not line.startswith(("| what", "| ---"))]
    assert bodies and all("`" in line.split("|")[-2] for line in bodies)


@pytest.mark.parametrize("line", COMMANDS)
def test_commands_name_what_exists(line: str) -> None:
    words = shlex.split(line)
    if words[0] == "cargo":
        names = [words[k + 1] for k, word in enumerate(words) if word == "--test"]
        assert all((ROOT / f"core/tests/{name}.rs").exists() for name in names)
        assert (ROOT / words[words.index("--manifest-path") + 1]).exists()
    else:
        paths = [word for word in words if word.startswith(("scripts/", "tests/"))]
        assert paths and all((ROOT / path).exists() for path in paths)


@pytest.mark.parametrize("line", re.findall(r"`\.venv/bin/bspcsg ([^`]*)`", PAGE))
def test_lines_for_the_program_are_understood(line: str) -> None:
    """Options, cases and engines are such that the program has; files are there."""
    verb, *words = shlex.split(line)
    command = commands.get_command(click.Context(commands), verb)
    assert command is not None
    known = {option for parameter in command.params for option in parameter.opts}
    assert {word for word in words if word.startswith("--")} <= known
    asked = words[words.index("--against") + 1].split(",") if "--against" in words else []
    assert set(asked) <= ({*ENGINES} if verb == "bench" else {"pymeshlab", "openscad"})
    names = list(takewhile(lambda word: not word.startswith("--"), words))
    assert all(name in CASES or (ROOT / name).is_file() for name in names)


def rows_of_engines() -> list[list[str]]:
    lines = PAGE.partition("| exactness |")[2].splitlines()
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines if "`" in line]


def test_every_engine_has_a_line_that_shows_it() -> None:
    rows = rows_of_engines()
    assert [len(row) for row in rows] == [6] * 8 and all(all(row) for row in rows)
    named = " ".join(row[0] for row in rows)
    engines = ("bspcsg", "manifold3d", "CGAL", "libigl", "trueform", "MeshLib", "OpenSCAD")
    assert all(name in named for name in engines)
    assert all(row[-1].startswith(("`scripts/", "`.venv/bin/bspcsg ")) for row in rows)


#: Of each package the beginning of its row, the licence that the page tells, and words of its own.
LICENCES = {
    "manifold3d": ("manifold3d", "Apache-2.0", "Apache"),
    "libigl": ("libigl", "MPL-2.0", "Mozilla Public License 2.0"),
    "pymeshlab": ("CGAL, as", "pymeshlab GPL-3.0", "GPL3"),
    "trueform": ("trueform", "noncommercial or paid", "Noncommercial"),
    "meshlib": ("MeshLib", "noncommercial or paid", "NON-COMMERCIAL"),
}


def words_of(package: str) -> list[str] | None:
    """Return the metadata and the licences of a package, None if it is not installed."""
    try:
        about = metadata.distribution(package)
    except metadata.PackageNotFoundError:
        return None
    files = [file.read_text() for file in about.files or () if file.name == "LICENSE"]
    return [about.read_text("METADATA") or "", *files]


def test_licences_are_those_that_packages_state() -> None:
    installed = set()
    for package, (row, told, own) in LICENCES.items():
        assert any(cells[0].startswith(row) and told in cells[3] for cells in rows_of_engines())
        words = words_of(package)
        if words is not None:
            installed.add(package)
            assert any(own in text for text in words), package
    assert "manifold3d" in installed


def test_our_licence_is_the_one_that_the_page_tells() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert rows_of_engines()[0][:4:3] == ["bspcsg", project["license"]]
    assert (ROOT / "LICENSE").read_text(encoding="utf-8").split()[:2] == ["Apache", "License"]


def test_our_answers_are_right() -> None:
    assert {name: peers.answer("bspcsg", name) for name in peers.QUESTIONS} == dict.fromkeys(
        peers.QUESTIONS, "right"
    ) | {"open": "refused"}


def answering(found: tuple[float, int]) -> Callable[[Engine], tuple[float, int]]:
    return lambda engine: found


def test_a_wrong_answer_is_told_from_a_right_one(monkeypatch: pytest.MonkeyPatch) -> None:
    given = {"face": (2.0, 20), "edge": (2.5, 24), "itself": (0.0, 42), "open": (1.0, 23)}
    said = {
        "face": "20 triangles",
        "edge": "volume 2.5, not 2",
        "itself": "42 triangles left",
        "open": "taken, and nothing said",
    }
    for name, (volume, count) in given.items():
        asked = peers.QUESTIONS[name]
        changed = dataclasses.replace(asked, ask=answering((volume, count)))
        monkeypatch.setitem(peers.QUESTIONS, name, changed)
        assert peers.answer("bspcsg", name) == said[name]


def test_the_engines_of_the_page_are_those_that_can_be_asked() -> None:
    recorded = peers.recorded()["answers"]
    assert set(recorded) <= {*ENGINES, "libigl"} and {"bspcsg", "manifold3d"} <= set(recorded)
    assert all(set(said) == set(peers.QUESTIONS) for said in recorded.values())
