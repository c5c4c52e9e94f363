"""Errors and findings that quote files contain no control characters, which steer terminals."""

import copy
import errno
import json
import pickle
import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import bspcsg as b
from bspcsg import csg
from bspcsg.io import read

#: Moves the cursor, sets the title, and rings the bell.
HOSTILE = "\x1b]0;x\x07\x1b[31m\x9b2J\x00\x7f"

CONTROLS = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")

#: Small files, with marks where words can be anything.
FILES = {
    "ply": "ply\nformat § 1.0\nelement § 0\nproperty § x\ncomment §\n§\nend_header\n§ 0 0\n",
    "off": "§OFF§\n3 1 § 0\n0 0 §\n1 0 0\n0 1 0\n3 § 0 1 2\n",
    "obj": "§ 1\nmtllib §.mtl\ng §\nusemtl §\nv 0 0 §\nv 1 0 0\nv 0 1 0\nf 1 2 § 3\n",
    "stl": "solid §\nfacet § normal 0 0 1\nouter loop §\nvertex 0 § 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid §\n",
    "dxf": "0\nSECTION\n2\nENTITIES\n0\n§LINE\n8\n§\n10\n§0\n20\n0\n11\n1\n21\n0\n"
    "0\nENDSEC\n0\nEOF§\n",
    "svg": '<svg xmlns="§"><path d="M 0 0 § 1 1 L 0 1 z"/><rect width="§1" height="1"/></svg§>',
    "csg": 'cube(§);\nimport(file = "§");\nunion§();\ntext("§");\n§cube([1, "§", 1]);\n',
}


def marked() -> list[tuple[str, int]]:
    """Return each file with the index of each mark in it."""
    return [(suffix, k) for suffix, text in FILES.items() for k in range(text.count("§"))]


def filled(text: str, number: int) -> str:
    """Return a text with one mark replaced by hostile characters, and all others removed."""
    parts = text.split("§")
    return "".join(parts[: number + 1]) + HOSTILE + "".join(parts[number + 1 :])


def load(path: Path) -> tuple[str, ...]:
    """Return the messages of reading a file."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            if path.suffix == ".csg":
                csg.load(path, lenient=True)
                found: tuple[b.Finding, ...] = ()
            elif path.suffix in (".dxf", ".svg"):
                found = ()
                csg.loads(f'linear_extrude(1) import("{path.name}");', folder=path.parent)
            else:
                found = read(path).findings
        except b.BspcsgError as error:
            return (str(error), error.message, str(pickle.loads(pickle.dumps(error))))
    return (*(one.message for one in found), *(str(one.message) for one in caught))


# Found: an unknown form of a PLY was quoted as it was.
@pytest.mark.parametrize(("suffix", "number"), marked())
def test_errors_hold_no_control_characters(tmp_path: Path, suffix: str, number: int) -> None:
    path = tmp_path / f"part.{suffix}"
    path.write_text(filled(FILES[suffix], number), "utf-8")
    for told in load(path):
        assert not CONTROLS.search(told), told


@pytest.mark.parametrize("suffix", FILES)
def test_names_of_files_are_shown_without_control_characters(tmp_path: Path, suffix: str) -> None:
    told = load(tmp_path / f"no\x1b]0;x\x07.{suffix}")
    assert told and not any(map(CONTROLS.search, told))
    assert "no\ufffd]0;x\ufffd." in told[0]


def test_errors_and_findings_of_any_kind() -> None:
    for kind in (b.BspcsgError, b.FormatError, b.InternalError):
        assert str(kind("a\x1bb\nc\td\x9b", "code", [1])) == "a\ufffdb\nc\td\ufffd"
    found = b.Finding("code", "note", "a\x07b", (), 1)
    assert json.dumps(found.message, ensure_ascii=False) == '"a\ufffdb"'


# Found: the error for a missing file was not a `FileNotFoundError`.
@pytest.mark.parametrize(
    "call",
    [
        b.load,
        b.Solid.from_mesh,
        b.Assembly.load,
        b.run_script,
        lambda path: b.csg.load(f"{path}.csg"),
        lambda path: b.csg.load(f"{path}.scad"),
        b.Region.from_svg,
        lambda path: b.text("a", font=f"{path}.ttf"),
    ],
)
def test_missing_files_are_errors_of_files_too(call: Callable[[str], Any]) -> None:
    with pytest.raises(FileNotFoundError, match=r"missing.*: cannot read this file: ") as caught:
        call("missing.stl")
    error = caught.value
    assert isinstance(error, b.FormatError) and isinstance(error, ValueError)
    assert (error.code, error.where, error.errno) == ("unreadable", (), errno.ENOENT)
    assert str(error.filename).startswith("missing.stl")
    again = pickle.loads(pickle.dumps(error))
    assert (str(again), again.code, again.filename) == (str(error), error.code, error.filename)
    assert type(again) is type(copy.copy(error)) is type(error)


def test_files_that_are_there_and_cannot_be_read_are_not_missing(tmp_path: Path) -> None:
    with pytest.raises(b.FormatError) as caught:
        b.load(tmp_path, format="stl")
    assert not isinstance(caught.value, FileNotFoundError)
