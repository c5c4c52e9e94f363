"""The README is correct: its code runs, and its output is as shown."""

import os
from pathlib import Path

import pytest

from support.documents import Session, blocks, exchanges, expected_of, same

README = Path(__file__).parents[2] / "README.md"
PYTHON = [text for language, text in blocks(README.read_text("utf-8")) if language == "python"]
CONSOLE = [text for language, text in blocks(README.read_text("utf-8")) if language == "console"]


def test_blocks_show_what_happens(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "examples").symlink_to(README.parent / "examples")
    monkeypatch.chdir(tmp_path)
    for block in PYTHON:
        assert Session().python(block).splitlines() == expected_of(block)
    assert any(list(exchanges(block)) for block in CONSOLE)
    for block in CONSOLE:
        for command, shown in exchanges(block):
            printed = Session().command(command)
            assert same(printed, shown), f"$ {command}\n{printed}"


def test_the_two_commands_are_there_and_can_be_run() -> None:
    for script in ("scripts/demo", "scripts/test"):
        assert f"\n{script}\n" in README.read_text("utf-8")
        assert os.access(README.parent / script, os.X_OK)
