"""The page on trust names commands that exist, and our answers on it are correct."""

import dataclasses
import re
import shlex
from collections.abc import Callable
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


@pytest.mark.parametrize("line", COMMANDS)
def test_commands_name_what_exists(line: str) -> None:
    words = shlex.split(line)
    if words[0] == "cargo":
        names = [word.removeprefix("tests::") for word in words if word.startswith("tests::")]
        assert all([*(ROOT / "core/tests").glob(f"{name}*.rs")] for name in names)
        assert words[words.index("-p") + 1] == "bspcsg"
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
