"""Every example runs, prints something, and writes the files listed for it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from support.examples import MODELS, WRITES

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("[0-9][0-9]_*.py"))


def test_there_are_examples() -> None:
    assert len(EXAMPLES) >= 4


@pytest.mark.sampled(3)
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example(example: Path, tmp_path: Path) -> None:
    lines = example.read_text("utf-8").splitlines()
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
    if example.stem in MODELS:
        assert len(lines) < 60
        assert_model(example.stem, done.stdout)


#: The words that models say of themselves, beside being closed and certified.
TOLD = {
    "14_enclosure": "the closed lid and the body share 0.0 mm³",
    "16_bolt_and_nut": "bolt and nut share 0.0 mm³\nclearance between them: 0.1 mm",
    "17_flange": "holes: 9 ",
    "18_brick": "one on the other, share 0.0 mm³",
    "23_duct": "ways through: 5 ",
    "24_hinge": "volumes shared on the way: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]",
    "25_assembly": "clashes: 0",
}


def assert_model(stem: str, text: str) -> None:
    """Assert that a model's output says that it is sound, and has its expected figures."""
    assert "closed: True\ncertified in single precision: True\n" in text
    assert TOLD.get(stem, "") in text
