"""The page on trust names commands that exist, and answers that were given."""

import dataclasses
import re
import shlex
from collections.abc import Callable
from pathlib import Path

import pytest

import peers
from bspcsg.bench.engines import ENGINES, Engine

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
