"""One version number: of the crate and its lock, the compiled core, the changelog and the pages."""

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


def requirements(*extras: str) -> set[str]:
    """Return the requirements of some extras, or of the package itself without extras."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    listed = [project["optional-dependencies"][extra] for extra in extras]
    return {each for names in listed or [project["dependencies"]] for each in names}


def test_no_other_major_version_comes_unasked() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"][
        "optional-dependencies"
    ]
    for each in requirements() | requirements(*(set(extras) - {"all"})):
        assert re.match(r"[\w-]+>=[\d.]+,<[\d.]+(;|$)", each), each


def test_the_tests_need_all_that_users_may_install() -> None:
    (every,) = requirements("all")
    extras = re.fullmatch(r"bspcsg\[([\w,]+)\]", every)
    assert extras and requirements(*extras[1].split(",")) <= requirements("test")


# Found: the packages for one format took a quarter of the disk space of an installation.
def test_drawings_of_one_format_are_an_extra() -> None:
    needed = {re.split(r"[<>=;]", each)[0] for each in requirements()}
    assert {"numpy", "manifold3d"} < needed and needed.isdisjoint({"ezdxf", "fonttools", "rtree"})
    assert {re.split(r"[<>=;]", each)[0] for each in requirements("dxf")} == {"ezdxf"}


def test_the_changelog_begins_with_what_is_unreleased_then_the_version() -> None:
    headings = re.findall(r"^## (.*)$", CHANGELOG, re.MULTILINE)
    assert headings[0] == "[Unreleased]"
    latest = re.fullmatch(r"\[(.*)\] - (\S+)", headings[1])
    assert latest and latest[1] == VERSION and date.fromisoformat(latest[2])


def test_the_install_page_shows_the_version() -> None:
    page = (ROOT / "docs/install.md").read_text(encoding="utf-8")
    assert re.findall(r"^bspcsg (\d\S*)$", page, re.MULTILINE) == [VERSION]
