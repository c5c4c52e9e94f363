"""Every example runs, prints something, and leaves the files that it names."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from support.examples import WRITES

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("[0-9][0-9]_*.py"))


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 4


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example(example: Path, tmp_path: Path) -> None:
    lines = example.read_text().splitlines()
    assert lines[0].startswith('"""')
    assert len(lines) < 100
    done = subprocess.run(
        [sys.executable, "-W", "error", str(example), str(tmp_path)],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
        timeout=110,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()
    assert not done.stderr
    assert {path.name for path in tmp_path.iterdir()} == WRITES.get(example.stem, set())
