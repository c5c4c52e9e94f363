"""What the README shows is what happens: its code runs, its output is right, its files exist."""

import contextlib
import io
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

README = Path(__file__).parents[2] / "README.md"
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", README.read_text(), re.DOTALL | re.MULTILINE)
PYTHON = [text for language, text in BLOCKS if language == "python"]
CONSOLE = [text for language, text in BLOCKS if language == "console"]


def test_the_first_lines_of_python_are_about_ten() -> None:
    assert 5 <= len(PYTHON[0].splitlines()) <= 16


@pytest.mark.parametrize("number", range(len(PYTHON)))
def test_python_blocks_run_and_print_what_they_say(
    number: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "examples").symlink_to(README.parent / "examples")
    monkeypatch.chdir(tmp_path)
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(PYTHON[number], f"README block {number}", "exec"), {})
    expected = re.findall(r"# -> (.*)$", PYTHON[number], re.MULTILINE)
    assert printed.getvalue().splitlines() == expected


def commands() -> list[tuple[str, list[str]]]:
    """Return each `$ bspcsg` line of the console blocks with the lines shown after it."""
    found = []
    for block in CONSOLE:
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, *shown = part.splitlines()
            if command.startswith("bspcsg "):
                found.append((command, shown))
    return found


def test_console_blocks_show_what_the_commands_print(tmp_path: Path) -> None:
    (tmp_path / "examples").symlink_to(README.parent / "examples")
    assert commands()
    for command, shown in commands():
        done = subprocess.run(
            [sys.executable, "-m", *shlex.split(command)],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            env={**os.environ, "COLUMNS": "100", "NO_COLOR": "1"},
            check=False,
        )
        printed = _without_times(done.stdout + done.stderr)
        assert [line.rstrip() for line in printed.splitlines()] == [
            line.rstrip() for line in _without_times("\n".join(shown)).splitlines()
        ]


def _without_times(text: str) -> str:
    return re.sub(r"\d+(\.\d+)? (m?s)\b", "# s", text)


def test_named_files_exist() -> None:
    for name in re.findall(r"\]\(([^)#:]+)\)", README.read_text()):
        assert (README.parent / name).exists(), name


def test_the_two_commands_are_there_and_can_be_run() -> None:
    for script in ("scripts/demo", "scripts/test"):
        assert f"\n{script}\n" in README.read_text()
        assert os.access(README.parent / script, os.X_OK)
