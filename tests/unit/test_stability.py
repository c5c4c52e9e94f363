"""The code has everything that the page on stability promises."""

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
from bspcsg.cli import main
from bspcsg.cli.console import output
from bspcsg.csg.syntax import json_form
from support.cli import Capture, ran

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs/stability.md").read_text(encoding="utf-8")

#: A command for each verb that has documents, and one that fails, on the files of `folder`.
COMMANDS = {
    "any failure": "info none.stl none.obj",
    "union": "union a.stl b.stl -o c.stl",
    "difference": "difference a.stl b.stl -o c.stl",
    "intersection": "intersection a.stl b.stl -o c.stl",
    "xor": "xor a.stl b.stl -o c.stl",
    "eval": "eval 'a.stl - b.stl' -o c.stl",
    "run": "run m.csg -o c.stl",
    "hull": "hull a.stl b.stl -o c.stl",
    "simplify": "simplify a.stl --tolerance 0.1 -o c.stl",
    "info": "info a.stl",
    "check": "check a.stl",
    "convert": "convert a.stl -o a.ply",
    "split": "split two.stl -o part.stl",
    "repair": "repair a.stl -o c.stl",
    "compare": "compare a.stl b.stl --samples 10",
    "slice": "slice a.stl --z 1 -o a.svg",
    "project": "project a.stl -o a.svg",
    "clash": "clash a.stl b.stl",
    "tree": "tree m.csg",
    "render": "render a.stl -o a.png",
    "view": "view a.stl -o a.html --no-open",
    "lecture": "lecture -o lecture.html",
    "doctor": "doctor",
    "crosscheck": "crosscheck a.stl b.stl --op difference --results cases.jsonl",
    "report": "report kept.jsonl -o report.html",
    "bench": "bench --from kept.json",
}

KEPT = ROOT / "tests/corpus/kept/1.0.0"


def rows(heading: str) -> list[list[str]]:
    """Return the cells of the tables below a heading of the page."""
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
    (b.cube(2) | b.cube(1).translate(5, 0, 0)).save(place / "two.stl")
    (place / "m.csg").write_text("cube(2);")
    (place / "kept.jsonl").write_bytes((KEPT / "cases.jsonl").read_bytes())
    (place / "kept.json").write_bytes((KEPT / "bench.json").read_bytes())
    return place


def documents() -> dict[str, list[str]]:
    """Return the schema and the fields of each kind of JSON document."""
    found = [row for row in rows("Documents of `--json`")[1:] if len(row) == 3]
    return {name: row[1:] for row in found for name in row[0].replace("`", "").split(", ")}


def test_every_verb_has_a_document_and_a_command() -> None:
    assert set(COMMANDS) == set(documents()) == {*main._VERBS, "any failure"}


@pytest.mark.parametrize("what", COMMANDS)
def test_documents_have_their_fields(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    monkeypatch.chdir(folder)
    schema, fields = documents()[what]
    said = ran(capsys, *shlex.split(COMMANDS[what]), "--json")[1]
    document = json.loads(said)
    assert document["schema"] == int(schema) == output.SCHEMA
    top, _, inner = fields.partition(";")
    if what == "any failure":
        error = json.loads(ran(capsys, "union", "none.stl", "b.stl", "-o", "c.stl", "--json")[1])
        assert set(re.findall("`(.*?)`", top)) <= set(error)
        assert set(re.findall("`(.*?)`", inner)) <= set(error["error"])
        return
    named = re.findall("`(.*?)`", top)
    assert set(named) <= set(document)
    for name in re.findall("`(.*?)`", inner):
        assert all(name in one for one in document[named[-1]])


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
    assert re.search(rf"{name} will be removed in the next version; use \S+", str(said[0].message))
    assert Path(said[0].filename) == Path(__file__)
