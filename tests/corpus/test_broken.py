"""Each broken file leads to its exit code and to one clear line, and nothing is written."""

import os
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import bspcsg as b
from bspcsg import bsp, csg
from bspcsg.io import FORMATS, write
from corpus.broken import (
    BOM,
    CSG,
    MESH,
    REFUSED,
    UNREADABLE,
    VOLUME,
    Broken,
    all_broken,
    all_broken_drawings,
    all_broken_scripts,
    good,
    good_drawing,
    good_tree,
)
from support.cli import Capture, ran

MESHES = all_broken()
SCRIPTS = all_broken_scripts()
DRAWINGS = all_broken_drawings()
TEXT = [(".stl", True), (".ply", True), (".obj", False), (".off", False)]


@pytest.fixture(autouse=True)
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Change to a temporary folder with one valid file."""
    monkeypatch.chdir(tmp_path)
    write(MESH, "good.off")


def test_there_are_many_cases_with_different_names() -> None:
    cases = [*MESHES, *SCRIPTS, *DRAWINGS]
    names = {str(case) for case in cases}
    assert len(names) == len(cases) > 350
    assert {case.code for case in cases} == {UNREADABLE, REFUSED}


def hints(line: str, arguments: tuple[str, ...]) -> list[str]:
    """Return the lines that must follow an error: for an open mesh, the options that close it."""
    if "the mesh is not closed" not in line:
        return []
    assert re.search(r"\d edges have no .* belongs to face \d+ and runs from \(.*\) to \(", line)
    advice = "  --on-invalid repair closes the mesh; --on-invalid warn leaves it out."
    if arguments[0] == "run":
        return [advice]
    name = Path(next(word for word in arguments if f" {word}: " in line))
    return [f"  Try: bspcsg repair {name} -o {name.stem}-fixed{name.suffix}", advice]


def refused(capsys: Capture, code: int, *arguments: str) -> str:
    """Assert that a command writes no file and prints one line; return the line."""
    before = sorted(os.listdir())
    found, out, err = ran(capsys, *arguments)
    told = [line for line in err.splitlines() if not line.startswith(("note: ", "warning: "))]
    lines = [line for line in told if not line.startswith("  ")]
    assert (found, out) == (code, ""), err
    assert len(lines) == 1 and lines[0].startswith("bspcsg: error: "), err
    assert told == lines + hints(lines[0], arguments), err
    assert lines[0].endswith((".", "…")) and 30 < len(lines[0]) < 500
    assert sorted(os.listdir()) == before
    return lines[0]


@pytest.mark.parametrize("case", MESHES, ids=str)
def test_meshes(capsys: Capture, case: Broken) -> None:
    name = Path(f"in{case.suffix}")
    name.write_bytes(case.data)
    line = refused(capsys, case.code, "union", "good.off", str(name), "-o", "x.ply")
    assert line.startswith(f"bspcsg: error: {name}")
    checked, out, err = ran(capsys, "check", str(name))
    assert checked == (UNREADABLE if case.code == UNREADABLE else 1)
    assert (str(name) in err) == (case.code == UNREADABLE) and (str(name) in out + err)
    if case.code == UNREADABLE:
        assert refused(capsys, UNREADABLE, "convert", str(name), "-o", "x.ply") == line


@pytest.mark.parametrize("case", SCRIPTS, ids=str)
def test_scripts(capsys: Capture, case: Broken) -> None:
    if case.suffix == ".json":
        Path("in.json").write_bytes(case.data)
        with pytest.raises(b.BspcsgError) as caught:
            csg.load("in.json")
        assert caught.value.message.startswith("in.json") and "\n" not in caught.value.message
        return
    Path("in.csg").write_bytes(case.data)
    refused(capsys, case.code, "run", "in.csg", "-o", "x.ply")


@pytest.mark.parametrize("case", DRAWINGS, ids=str)
def test_drawings(capsys: Capture, case: Broken) -> None:
    Path(f"in{case.suffix}").write_bytes(case.data)
    Path("in.csg").write_text(f'linear_extrude(height = 2) import(file = "in{case.suffix}");')
    line = refused(capsys, case.code, "run", "in.csg", "-o", "x.ply")
    assert "in.csg:1:" in line or "x.ply: the result is empty" in line


# What looks odd and is right


def with_ends(end: bytes) -> Callable[[bytes], bytes]:
    return lambda data: data.replace(b"\n", end)


def mixed(data: bytes) -> bytes:
    """Return the data with its lines ended in turn by LF, CR LF and CR."""
    ends: Iterator[bytes] = (end for _ in iter(int, 1) for end in (b"\n", b"\r\n", b"\r"))
    return b"".join(line + next(ends) for line in data.splitlines())


ODD: dict[str, Callable[[bytes], bytes]] = {
    "byte order mark": lambda data: BOM + data,
    "line ends of Windows": with_ends(b"\r\n"),
    "line ends of old Macs": with_ends(b"\r"),
    "line ends by turns": mixed,
    "no line end at the end": lambda data: data.rstrip(),
    "blank lines after it": lambda data: data + b"\n\n \n",
    "blanks and tabs": lambda data: data.replace(b" ", b" \t "),
}


@pytest.mark.parametrize("name", ODD)
@pytest.mark.parametrize(("suffix", "text"), TEXT)
def test_odd_meshes_are_read(name: str, suffix: str, text: bool) -> None:
    data = good(suffix, text)
    if suffix == ".ply" and name == "blanks and tabs":
        head, mark, body = data.partition(b"end_header\n")
        data = head + mark + ODD[name](body)
    else:
        data = ODD[name](data)
    Path(f"in{suffix}").write_bytes(data)
    assert b.load(f"in{suffix}").equals(b.cube(2))


@pytest.mark.parametrize("name", ODD)
def test_odd_scripts_are_read(name: str) -> None:
    Path("in.csg").write_bytes(ODD[name](CSG))
    assert b.load("in.csg").volume == VOLUME


@pytest.mark.parametrize("suffix", [".svg", ".dxf"])
def test_good_drawings_are_read(suffix: str) -> None:
    Path(f"in{suffix}").write_bytes(good_drawing(suffix))
    read = bsp.load_svg if suffix == ".svg" else bsp.load_dxf
    assert read(f"in{suffix}").extrude(2).volume_exact == VOLUME


def test_good_trees_are_read() -> None:
    Path("in.json").write_bytes(good_tree())
    assert csg.load("in.json").volume == VOLUME


# Bytes changed at random

#: The bytes that a change may put somewhere.
PIECES = st.sampled_from(
    [b"", b"\0", b"\xff", b"-1", b"9" * 20, b"nan", b"1e999", b" ", b"\n", b"<", b'"', b"{", b"["]
) | st.binary(max_size=8)
CHANGES = st.lists(
    st.tuples(st.floats(0, 1, exclude_max=True), st.integers(0, 30), PIECES), min_size=1, max_size=4
)
FORMS = [*((suffix, False) for suffix in FORMATS), (".stl", True), (".ply", True)]


def changed(data: bytes, changes: list[tuple[float, int, bytes]]) -> bytes:
    """Return the data with bytes replaced at positions given as fractions of the length."""
    for part, removed, new in changes:
        at = int(part * len(data))
        data = data[:at] + new + data[at + removed :]
    return data


@pytest.mark.parametrize(("suffix", "text"), FORMS)
@given(changes=CHANGES)
def test_changed_meshes(suffix: str, text: bool, changes: list[tuple[float, int, bytes]]) -> None:
    Path(f"in{suffix}").write_bytes(changed(good(suffix, text), changes))
    read_or_refused(lambda: b.load(f"in{suffix}"), f"in{suffix}")


@pytest.mark.filterwarnings("ignore::bspcsg.bsp.DrawingWarning")
@pytest.mark.parametrize("suffix", [".csg", ".json", ".svg", ".dxf"])
@settings(max_examples=20)
@given(changes=CHANGES)
def test_changed_scripts(suffix: str, changes: list[tuple[float, int, bytes]]) -> None:
    originals = {".csg": lambda: CSG, ".json": good_tree}
    make = originals.get(suffix, lambda: good_drawing(suffix))
    Path(f"in{suffix}").write_bytes(changed(make(), changes))
    if suffix in originals:
        read_or_refused(lambda: csg.load(f"in{suffix}"), f"in{suffix}")
    else:
        read = bsp.load_svg if suffix == ".svg" else bsp.load_dxf
        read_or_refused(lambda: read(f"in{suffix}").extrude(2), f"in{suffix}")


def read_or_refused(make: Callable[[], "b.Solid"], name: str) -> None:
    """Assert that a function returns a sound solid, or raises an error that is no defect."""
    try:
        solid = make()
        assert solid.volume_exact >= 0
    except b.BspcsgError as error:
        assert not isinstance(error, b.InternalError), error
        assert "\n" not in error.message and error.message
