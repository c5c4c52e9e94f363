"""The code has what the page on stability promises."""

import json
import re
import shlex
import warnings
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg.bench import record as bench_record
from bspcsg.bsp.trees import dump
from bspcsg.campaign import record as campaign_record
from bspcsg.cli import main, output
from bspcsg.csg.syntax import json_form
from support.cli import Capture, ran

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/stability.md").read_text(encoding="utf-8")

#: A command for each kind of document, on the files of `folder`.
COMMANDS = {
    "any failure": "info none.stl none.obj",
    "union": "union a.stl b.stl -o c.stl",
    "info": "info a.stl",
    "convert": "convert a.stl -o a.ply",
    "compare": "compare a.stl b.stl --samples 10",
    "slice": "slice a.stl --z 1 -o a.svg",
    "clash": "clash a.stl b.stl",
    "doctor": "doctor",
    "validate": "validate a.stl b.stl",
}


def rows(heading: str) -> list[list[str]]:
    """Return the cells of the tables below a heading."""
    part = PAGE.partition(f"\n## {heading}\n")[2].partition("\n## ")[0]
    lines = [line for line in part.splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return [row for row in cells if not set(row[0]) <= set("- ")]


def test_the_exit_codes_are_those_of_the_code_and_of_the_help() -> None:
    documented = {int(code): words for code, words in rows("Exit codes")[1:]}
    codes = (
        output.DONE,
        output.FOUND,
        output.USAGE,
        output.UNREADABLE,
        output.REFUSED,
        output.UNWRITABLE,
        output.MISSING,
        output.INTERNAL,
        output.TIMED_OUT,
        output.INTERRUPTED,
        output.CLOSED_PIPE,
    )
    assert tuple(documented) == codes
    told = " ".join(main._EPILOG.split())
    assert all(f"{code} {words}" in told for code, words in documented.items())


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("stability")
    b.cube(2).save(place / "a.stl")
    b.cube(2).translate(1, 1, 1).save(place / "b.stl")
    return place


def test_every_document_has_a_command() -> None:
    named = {re.sub("`", "", row[0].split(",")[0]) for row in rows("Documents of `--json`")}
    assert set(COMMANDS) <= named


@pytest.mark.parametrize("what", COMMANDS)
def test_documents_have_their_fields(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    monkeypatch.chdir(folder)
    row = next(
        row
        for row in rows("Documents of `--json`")
        if row[0].replace("`", "").split(",")[0] == what and len(row) == 3
    )
    said = ran(capsys, *shlex.split(COMMANDS[what]), "--json")[1]
    document = json.loads(said)
    assert document["schema"] == int(row[1]) == output.SCHEMA
    top, _, inner = row[2].partition(";")
    if what == "any failure":
        error = json.loads(ran(capsys, "union", "none.stl", "b.stl", "-o", "c.stl", "--json")[1])
        assert set(re.findall("`(.*?)`", top)) <= set(error)
        assert set(re.findall("`(.*?)`", inner)) <= set(error["error"])
        return
    assert set(re.findall("`(.*?)`", top)) <= set(document)
    for name in re.findall("`(.*?)`", inner):
        assert all(name in one for one in document["files"])


def test_versions_of_files_are_those_of_the_code() -> None:
    versions = [row[1] for row in rows("Documents of `--json`") if len(row) == 2]
    documented = [int(version) for version in versions if version.isdigit()]
    assert documented == [
        campaign_record.SCHEMA,
        bench_record.SCHEMA,
        json_form.VERSION,
        dump._VERSION,
    ]


@pytest.mark.parametrize("name", ["volume_near", "volume_residues", "check"])
def test_what_is_to_go_warns_and_names_what_stays(name: str) -> None:
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        found = getattr(b.cube(1) | b.cube(2), name)
        if callable(found):
            found()
    assert [one.category for one in said] == [DeprecationWarning]
    assert re.search(rf"{name} goes with the next version; use \S+", str(said[0].message))
    assert Path(said[0].filename) == Path(__file__)
