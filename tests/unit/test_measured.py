"""docs/measured.md has the tables of the last release; a new release is made from records."""

import json
from pathlib import Path

import pytest

import measured
from recording import RELEASES, release


def test_the_page_has_the_tables_of_the_last_release() -> None:
    text = measured.PAGE.read_text(encoding="utf-8")
    assert measured.page(text, release()) == text


def test_tables_of_releases_are_small() -> None:
    assert all(path.stat().st_size < 15_000 for path in RELEASES.iterdir())


def test_a_release_keeps_what_was_not_measured_again(tmp_path: Path) -> None:
    before = release()
    machine = dict.fromkeys(("processor", "cores", "memory_gb", "system"), "none")
    record = {"machine": {"date": "today", **machine}, "operations": {"a | b": {"agree": 7}}}
    (tmp_path / "campaign.json").write_text(json.dumps(record))
    table = measured.condensed(tmp_path, before)
    assert {**table, "campaign": None} == {**before, "campaign": None}
    assert json.loads(measured.written(table)) == table
    page = measured.page(measured.PAGE.read_text(encoding="utf-8"), table)
    assert "| a \\| b | 7 | 0 | 0 | 0 | 0 |\n" in page and page.count("\n\n\n") == 0


def test_a_page_without_a_mark_is_refused() -> None:
    with pytest.raises(SystemExit, match="needs the line"):
        measured.page("# What was measured\n", release())
