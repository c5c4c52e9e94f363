"""The command view: HTML pages of meshes."""

import json
import os
import webbrowser
from pathlib import Path

import pytest

import bspcsg as b
from support.cli import Capture, put, ran
from support.shapes import cube

_SCREENS = ("DISPLAY", "WAYLAND_DISPLAY", "SSH_CONNECTION", "SSH_TTY")


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the list of addresses that a browser is asked to open, as on a desktop."""
    asked: list[str] = []

    def opening(address: str) -> bool:
        asked.append(address)
        return True

    monkeypatch.setattr(webbrowser, "open", opening)
    for name in _SCREENS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("DISPLAY", ":0")
    return asked


def test_the_page_is_written_and_opened(folder: Path, capsys: Capture, opened: list[str]) -> None:
    code, out, err = ran(capsys, "view", "a.off", "c.stl", "-o", "both.html")
    assert (code, err) == (0, "") and out.startswith("both.html  24 triangles  ")
    page = Path("both.html").read_text(encoding="utf-8")
    assert "<title>a.off, c.stl</title>" in page and "3 × 3 × 3" in page
    assert opened == [(folder / "both.html").resolve().as_uri()]


def test_without_a_name_the_page_is_a_temporary_file(
    folder: Path, capsys: Capture, opened: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    code, out, _ = ran(capsys, "view", "a.off", "--json")
    told = json.loads(out)
    assert code == 0 and told["opened"] and told["triangles"] == 12
    assert Path(told["output"]).is_relative_to(folder) and Path(told["output"]).name == "a.html"
    assert Path(told["output"]).stat().st_size == told["bytes"]


def test_the_page_is_called_as_the_file_and_not_as_a_part_of_it(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    b.Assembly("box", [b.Assembly("body", b.cube(1)), b.Assembly("lid", b.cube(2))]).save("two.3mf")
    told = json.loads(ran(capsys, "view", "two.3mf", "--no-open", "--json")[1])
    assert Path(told["output"]).name == "two.html"


# Found: `lecture` required the option -o, though `view` did not.
def test_the_lecture_is_a_temporary_page_that_is_opened(
    folder: Path, capsys: Capture, opened: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(folder))
    code, out, err = ran(capsys, "lecture", "--json")
    page = Path(json.loads(out)["output"])
    assert (code, err, opened) == (0, "", [page.as_uri()]) and page.is_relative_to(folder)
    assert ran(capsys, "lecture", "-o", "x.html")[0] == 0 and len(opened) == 1
    monkeypatch.setenv("DISPLAY", "")
    assert "note: no browser was opened" in ran(capsys, "lecture")[2]


@pytest.mark.parametrize(
    ("changes", "arguments", "words"),
    [
        ({}, ["--no-open"], ""),
        ({"SSH_CONNECTION": "1.2.3.4"}, [], "note: no browser was opened"),
        ({"DISPLAY": ""}, [], "note: no browser was opened"),
    ],
)
def test_no_browser_is_started(
    folder: Path,
    capsys: Capture,
    opened: list[str],
    monkeypatch: pytest.MonkeyPatch,
    changes: dict[str, str],
    arguments: list[str],
    words: str,
) -> None:
    for name, value in changes.items():
        monkeypatch.setenv(name, value)
    code, _, err = ran(capsys, "view", "a.off", "-o", "a.html", *arguments)
    assert code == 0 and err.startswith(words) and bool(err) == bool(words)
    assert Path("a.html").exists() and not opened


def test_a_browser_that_does_not_start_is_said(
    folder: Path, capsys: Capture, opened: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(webbrowser, "open", lambda _: False)
    code, _, err = ran(capsys, "view", "a.off", "-o", "a.html")
    assert code == 0 and "no browser could be started" in err


def test_open_and_empty_meshes(folder: Path, capsys: Capture) -> None:
    put("open.off", (cube()[0], cube()[1][1:]))
    Path("none.off").write_text("OFF\n0 0 0\n")
    code, _, err = ran(capsys, "view", "open.off", "none.off", "-o", "x.html", "--no-open")
    assert code == 0 and "none.off: the file has no triangles to show" in err
    assert "11 triangles, open" in Path("x.html").read_text(encoding="utf-8")


def test_units_are_said(folder: Path, capsys: Capture) -> None:
    assert ran(capsys, "view", "a.off", "--unit", "in", "-o", "x.html", "--no-open")[0] == 0
    assert "50.8 × 50.8 × 50.8 mm" in Path("x.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["none.stl"], 3, "none.stl: cannot read"),
        (["part.step"], 3, "STEP"),
        (["a.off", "-o", "x.png"], 3, "must end in .html"),
        (["a.off", "-o", "no/x.html"], 5, "does not exist or is not writable"),
        (["-"], 2, "--from stl"),
        ([], 2, "FILE"),
    ],
)
def test_refusals(
    folder: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
    before = sorted(os.listdir())
    found, out, err = ran(capsys, "view", *arguments)
    assert (found, out) == (code, "") and words in err
    assert sorted(os.listdir()) == before
