"""File names that are legal but unusual."""

import os
import sys
from pathlib import Path

import pytest

import bspcsg as b
from support.cli import Capture, Piped, finished, put, ran
from support.shapes import cube

#: File names that Linux allows: up to 255 bytes, any but two.
STEMS = {
    "no text": os.fsdecode(b"w\xfcrfel \xff"),
    "two lines": "new\nline",
    "markup": "<b>&amp;[red]x",
    "wildcards": "a[1]*?",
    "percent": "per%cent%",
    "turned round": "\u202etext",
    "long": "x" * 251,
    "long in four bytes": "\U0001f980" * 62,
}

#: Commands on a file `x`, for which a test puts a name of `STEMS`; also outputs have that name.
LINES = {
    "info": ["info", "x.stl", "--json"],
    "check": ["check", "x.stl", "--html", "page.html"],
    "compare": ["compare", "x.stl", "x.stl", "--html", "page.html"],
    "view": ["view", "x.stl", "-o", "x.htm", "--no-open"],
    "union": ["union", "x.stl", "x.stl", "-o", "x.3mf"],
    "convert": ["convert", "x.stl", "-o", "x.glb"],
    "slice": ["slice", "x.stl", "--z", "0.5", "-o", "x.svg"],
    "render": ["render", "x.stl", "-o", "x.png"],
    "crosscheck": [
        *("crosscheck", "x.stl", "x.stl", "--op", "union"),
        *("--junit", "x.xml", "--markdown", "x.md", "--results", "x.jso"),
    ],
}

pytestmark = pytest.mark.skipif(
    sys.platform != "linux", reason="other systems allow fewer names, or normalise them"
)


# Found: pages of files whose names are no text, and inputs without a suffix, ended in an internal
# error; long names could not be written to.
@pytest.mark.sampled(3)
@pytest.mark.parametrize("stem", STEMS)
@pytest.mark.parametrize("verb", LINES)
def test_files_may_have_any_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, piped: Piped, stem: str, verb: str
) -> None:
    monkeypatch.chdir(tmp_path)
    name = STEMS[stem]
    put(f"{name}.stl", cube())
    arguments = [word.replace("x.", f"{name}.") for word in LINES[verb]]
    code, _, err = piped(*arguments)
    assert (code, b"error" in err) == (0, False), err


def test_pages_show_what_is_no_text_as_terminals_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    name = os.fsdecode(b"w\xfcrfel.stl")
    put(name, cube())
    code, _, err = finished("view", os.fsencode(name), "-o", "x.html", "--no-open")
    assert (code, err) == (0, b"")
    assert "<title>w?rfel.stl</title>" in Path("x.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("suffix", [".3mf", ".glb", ".stl"])
def test_files_without_a_suffix_are_refused_before_they_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture, suffix: str
) -> None:
    monkeypatch.chdir(tmp_path)
    code, _, err = ran(capsys, "union", "first", "second", "-o", f"out{suffix}")
    assert code == 3 and "first: there is no such file or folder." in err
    Path("first").write_bytes(b"")
    code, _, err = ran(capsys, "union", "first", "second", "-o", f"out{suffix}")
    assert code == 3 and "first: the file name has no suffix to tell the format" in err


# Found: an empty name was the current folder, which `validate` then took its cases from, and one of
# results ended in an internal error.
@pytest.mark.parametrize(
    "line",
    [
        ["info", ""],
        ["union", "a.stl", "a.stl", "-o", ""],
        ["crosscheck", ""],
        ["crosscheck", "a.stl", "--results", ""],
        ["check", "a.stl", "--html", ""],
        ["convert", "a.stl", "--outdir", "", "--to", "off"],
        ["run", "a.py", "-o", "x.stl", "--allow-path", ""],
        ["lecture", "-o", ""],
        ["bench", "-o", ""],
    ],
)
def test_names_are_not_empty(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture, line: list[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    code, _, err = ran(capsys, *line)
    assert code == 2 and "the file name is empty" in err


def test_names_too_long_for_any_file_are_an_error(tmp_path: Path) -> None:
    with pytest.raises(b.FormatError) as caught:
        b.save(b.cube(1), tmp_path / f"{'x' * 252}.stl")
    assert caught.value.code == "unwritable"
    assert list(tmp_path.iterdir()) == []
