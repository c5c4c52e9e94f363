"""The folder that the tests of the command line work in."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from support.browser import Browser, started
from support.cli import put
from support.shapes import cuboid


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with two overlapping cubes; relative names mean files in it."""
    monkeypatch.chdir(tmp_path)
    put("a.off", cuboid((0, 0, 0), (2, 2, 2)))
    put("c.stl", cuboid((1, 1, 1), (3, 3, 3)))
    return tmp_path


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """Return the one browser of all tests of pages."""
    with started(webgl=True) as running:
        yield running
