"""One version: of the crate and its lock, the compiled core, the changelog and the pages."""

import re
import tomllib
from datetime import date
from pathlib import Path

import bspcsg as b

ROOT = Path(__file__).parents[2]
VERSION = tomllib.loads((ROOT / "core/Cargo.toml").read_text(encoding="utf-8"))["package"][
    "version"
]
CHANGELOG = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def test_the_compiled_core_is_of_the_version() -> None:
    assert b.__version__ == VERSION


def test_the_lock_names_the_version() -> None:
    lock = tomllib.loads((ROOT / "Cargo.lock").read_text(encoding="utf-8"))
    assert [p["version"] for p in lock["package"] if p["name"] == "bspcsg"] == [VERSION]


def test_packages_take_the_version_of_the_crate() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert "version" in project["dynamic"] and "version" not in project
    stable = "Development Status :: 5 - Production/Stable" in project["classifiers"]
    assert stable == (not VERSION.startswith("0."))


def test_the_changelog_begins_with_what_is_unreleased_then_the_version() -> None:
    headings = re.findall(r"^## (.*)$", CHANGELOG, re.MULTILINE)
    assert headings[0] == "[Unreleased]"
    latest = re.fullmatch(r"\[(.*)\] - (\S+)", headings[1])
    assert latest and latest[1] == VERSION and date.fromisoformat(latest[2])


def test_the_install_page_shows_the_version() -> None:
    page = (ROOT / "docs/install.md").read_text(encoding="utf-8")
    assert re.findall(r"^bspcsg (\d\S*)$", page, re.MULTILINE) == [VERSION]
