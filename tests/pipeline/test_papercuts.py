"""The command line is pleasant to use: one test for each small flaw that has been fixed."""

import json
import os
import pty
import re
import sys
import time
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg.cli.console import status_line
from bspcsg.cli.console.tables import table_text
from support.cli import Capture, Piped, finished, process, put, ran
from support.shapes import cuboid, icosphere

POSIX = pytest.mark.skipif(os.name != "posix", reason="as POSIX has it")

CSG = "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]]) cube([2, 2, 1]);"


def at_terminal(monkeypatch: pytest.MonkeyPatch, columns: int) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", str(columns))


# Outputs


# Found: `-o /dev/null` was refused.
@POSIX
@pytest.mark.parametrize(
    "line",
    [
        "union a.off c.stl",
        "union a.off c.stl --to glb",
        "hull a.off c.stl",
        "convert a.off",
        "convert a.off c.stl --to obj",
        "split a.off",
        "split a.off c.stl",
        "repair a.off",
        "simplify a.off --tolerance 0.1",
        "render a.off",
        "slice a.off --z 1",
        "project a.off",
        "tree m.csg",
        "run m.csg --no-overwrite",
        "view a.off --no-open",
    ],
)
def test_the_null_device_takes_every_output(folder: Path, capsys: Capture, line: str) -> None:
    Path("m.csg").write_text(CSG)
    code, out, err = ran(capsys, *line.split(), "-o", os.devnull)
    # A script that is only run is called by its own name.
    named = "m.csg" if line.startswith("run") else os.devnull
    assert code == 0 and "error" not in err and named in out
    assert os.path.exists(os.devnull) and not Path(os.devnull).is_file()


# Found: `--outdir` did not make the folder.
def test_outdir_is_made(folder: Path, capsys: Capture) -> None:
    line = ["convert", "a.off", "c.stl", "--to", "ply", "--outdir", "new/inner"]
    assert ran(capsys, *line)[0] == 0
    assert b.load("new/inner/a.ply").volume == b.load("new/inner/c.ply").volume == 8


def test_outdir_is_not_made_for_nothing(folder: Path, capsys: Capture) -> None:
    code, _, _ = ran(capsys, "convert", "-", "--to", "ply", "--outdir", "new")
    assert code == 2 and not Path("new").exists()
    code, _, err = ran(capsys, "convert", "a.off", "--to", "ply", "--outdir", "a.off/x")
    assert code == 5 and "a.off/x: cannot create this folder" in err


# Found: units were misspelt.
@pytest.mark.parametrize(("unit", "size"), [("mm", 50.8), ("cm", 5.08), ("in", 2.0)])
def test_units_are_converted(folder: Path, capsys: Capture, unit: str, size: float) -> None:
    line = ["convert", "a.off", "-o", "x.ply", "--unit", "in", "--to-unit", unit]
    assert ran(capsys, *line)[0] == 0
    bounds = b.load("x.ply").bounds
    assert bounds is not None and bounds[1].tolist() == pytest.approx([size] * 3, rel=1e-15)


def test_formats_with_units_take_no_other(folder: Path, capsys: Capture) -> None:
    code, _, err = ran(capsys, "convert", "a.off", "-o", "x.3mf", "--to-unit", "cm")
    assert code == 2 and "--to-unit: 3MF files have a fixed or stored unit" in err


# Inputs


# Found: `eval` did not expand file name patterns.
@pytest.mark.parametrize(
    ("line", "volume"),
    [
        ("union *.off c.stl", 15),
        ("hull [ac].*", 8 + 3 * 4),
        ("eval *.off-c.stl", None),
        ("eval [ac].*", 15),
        ("eval c.stl - *.off", 7),
        ("convert *.stl", 8),
        ("simplify a.* --tolerance 0.1", 8),
    ],
)
def test_patterns_that_the_shell_left_are_matched(
    folder: Path, capsys: Capture, line: str, volume: float | None
) -> None:
    verb, *words = line.split()
    if verb == "eval":
        words = [" ".join(words)]
    code, _, err = ran(capsys, verb, *words, "-o", "x.ply")
    if volume is None:
        assert code == 3 and "*.off-c.stl: no file matches this pattern." in err
    else:
        assert code == 0 and b.load("x.ply").volume == pytest.approx(volume)


def test_patterns_without_a_match(folder: Path, capsys: Capture) -> None:
    code, _, err = ran(capsys, "info", "none*.stl")
    assert code == 3 and "none*.stl: no file matches this pattern." in err
    code, _, err = ran(capsys, "slice", "*.*", "--z", "1", "-o", "x.svg")
    assert (
        code == 2
        and "*.* matches 2 files, but only one is allowed here; name one of them, such as a.off."
        in err
    )


@pytest.mark.parametrize(
    "meant", ["in", "in/*", "in/**/*", "in/a.off in/deep/c.stl in/a.png in/a.mtl"]
)
def test_companions_of_meshes_are_skipped_and_counted(
    folder: Path, capsys: Capture, meant: str
) -> None:
    Path("in/deep/.hidden").mkdir(parents=True)
    Path("a.off").rename("in/a.off")
    Path("c.stl").rename("in/deep/c.stl")
    for name in ("a.mtl", "a.png"):
        Path("in", name).touch()
    Path("in/deep/.hidden/b.off").touch()
    code, out, err = ran(capsys, "info", *meant.split(), "--json")
    assert code == 0 and err == "note: skipped 2 files that are not meshes: 1 .mtl, 1 .png.\n"
    files = json.loads(out)["files"]
    assert [Path(one["file"]) for one in files] == [Path("in/a.off"), Path("in/deep/c.stl")]
    assert ran(capsys, "info", *meant.split(), "-q")[2] == ""
    code, _, _ = ran(capsys, "union", *meant.split(), "-o", "x.ply")
    assert code == 0 and b.load("x.ply").volume == 15


def test_views_skip_companions_and_open_no_folders(folder: Path, capsys: Capture) -> None:
    for name in ("in.png", "in.mtl"):
        Path(name).touch()
    for meant in ("*", "a.off c.stl in.png in.mtl"):
        line = ["view", *meant.split(), "-o", "x.html", "--no-open", "--json"]
        code, out, err = ran(capsys, *line)
        assert code == 0 and json.loads(out)["files"] == ["a.off", "c.stl"]
        assert "skipped 2 files that are not meshes" in err
        Path("x.html").unlink()


def test_what_is_named_alone_or_is_of_another_format_is_no_companion(
    folder: Path, capsys: Capture
) -> None:
    Path("a.mtl").touch()
    Path("b.step").touch()
    assert ran(capsys, "info", "a.mtl")[0] == 3
    code, _, err = ran(capsys, "info", "a.off", "b.step")
    assert code == 3 and "STEP" in err
    code, _, err = ran(capsys, "info", "*.step")
    assert code == 3 and "STEP" in err


def test_folders_without_meshes(folder: Path, capsys: Capture) -> None:
    Path("none/deep").mkdir(parents=True)
    assert ran(capsys, "check", "none")[::2] == (
        3,
        "bspcsg: error: none: no mesh file was found.\n",
    )
    Path("none/deep/a.txt").touch()
    code, _, err = ran(capsys, "check", "none")
    assert (
        code == 3 and "none: no mesh file was found, only 1 file that is not a mesh: 1 .txt." in err
    )
    # Where something else is a mesh, an empty folder is nothing to speak of.
    assert ran(capsys, "check", "none", "a.off")[0] == 0


def test_names_that_look_like_patterns_are_names(folder: Path, capsys: Capture) -> None:
    Path("a.off").rename("a[1].off")
    assert ran(capsys, "check", "a[1].off")[0] == 0


def test_scripts_come_from_standard_input(folder: Path, piped: Piped) -> None:
    code, out, err = piped(
        *["union", "a.off", "-", "--from", "csg", "-o", "x.ply"], given=CSG.encode()
    )
    assert code == 0, err
    assert b.load("x.ply").volume == 12
    made = piped("tree", "-", "--to", "json", "-o", "m.json", given=CSG.encode())
    assert made[0] == 0
    tree = Path("m.json").read_bytes()
    code, out, _ = piped("info", "-", "--from", "json", "--json", given=tree)
    assert code == 0 and json.loads(out)["files"][0]["volume"] == 4
    code, _, err = piped("info", "-", "--from", "csg", given=b"cube(;")
    assert code == 3 and err.startswith(b"bspcsg: error: -:1:6: expected")
    code, _, err = piped("info", "-", "--from", "py", given=b"")
    assert code == 2 and b"-: .py scripts cannot be read from standard input" in err


def test_scripts_may_have_any_suffix(folder: Path, capsys: Capture) -> None:
    Path("model.txt").write_text(CSG)
    assert "volume" in ran(capsys, "info", "model.txt", "--from", "csg")[1]


# What is said


# Found: numbers in pipes had no-break spaces as separators of digits.
def test_numbers_are_whole_in_pipes_and_grouped_at_terminals(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    put("ball.ply", icosphere(4))
    out = ran(capsys, "info", "ball.ply")[1]
    assert re.search(r"triangles +5120\n", out) and "\N{NO-BREAK SPACE}" not in out
    assert " ball.ply\n ------" in out
    at_terminal(monkeypatch, 80)
    out = ran(capsys, "info", "ball.ply")[1]
    assert "5\N{NO-BREAK SPACE}120" in out and "\n ─────" in out


TABLE = (
    ["part", "needed for", "count"],
    [["a", "several words of some length", "7"], ["b", "others", "12"]],
)


# Found: tables ignored the terminal's width.
@pytest.mark.parametrize("columns", [44, 60, 200])
def test_tables_fit_the_terminal(columns: int, monkeypatch: pytest.MonkeyPatch) -> None:
    at_terminal(monkeypatch, columns)
    lines = table_text(*TABLE, right=["count"]).splitlines()
    assert max(map(len, lines)) <= columns
    assert " ".join(lines).split().count("words") == 1


# Found: tables took names between colons for emoji, and cut wide letters.
def test_tables_show_names_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = [["a:x:b.obj", "1"], ["部品" * 9, "2"]]
    piped = table_text(["file", "count"], rows)
    at_terminal(monkeypatch, 80)
    for text in (piped, table_text(["file", "count"], rows)):
        assert "a:x:b.obj " in text and "部品" * 9 in text


def test_tables_without_room_become_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    at_terminal(monkeypatch, 40)
    names = ["one", "another", "a third", "the fourth", "number five"]
    text = table_text(names, [["x" * 9] * 5, ["y" * 9, "", "y", "y", "y"]])
    assert text.splitlines()[:2] == ["one          xxxxxxxxx", "another      xxxxxxxxx"]
    assert "\n\none          yyyyyyyyy\na third      y\n" in text


def test_tables_in_pipes_lose_nothing() -> None:
    long = "word " * 60
    assert long.strip() in table_text(["a", "b"], [["x", long]])


@pytest.mark.parametrize(
    ("environment", "terminal", "coloured"),
    [
        ({}, True, True),
        ({}, False, False),
        ({"NO_COLOR": "1"}, True, False),
        ({"NO_COLOR": ""}, True, True),
        ({"FORCE_COLOR": "1"}, False, True),
        ({"FORCE_COLOR": "0"}, True, False),
        ({"FORCE_COLOR": "1", "NO_COLOR": "1"}, True, False),
        ({"TERM": "dumb"}, True, False),
    ],
)
def test_colours_by_convention(
    folder: Path,
    capsys: Capture,
    monkeypatch: pytest.MonkeyPatch,
    environment: dict[str, str],
    terminal: bool,
    coloured: bool,
) -> None:
    for name in ("NO_COLOR", "FORCE_COLOR", "TERM"):
        monkeypatch.delenv(name, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
    for arguments in (["unoin"], ["info", "none.stl"]):
        err = ran(capsys, *arguments)[2]
        assert ("\033[31m" in err) == coloured
        assert re.sub(r"\033\[\d+m", "", err).startswith("bspcsg: error: ")


# Found: wrong usage with `--json` left standard output empty.
@pytest.mark.parametrize(
    "verb", ["union", "info", "convert", "slice", "bench", "crosscheck", "unoin"]
)
def test_wrong_use_is_json_too(folder: Path, capsys: Capture, verb: str) -> None:
    code, out, err = ran(capsys, verb, "--no-such-option", "--json")
    said = json.loads(out)
    assert code == said["exit"] == 2 and said["schema"] == 1
    assert said["error"]["code"] == "usage" and said["error"]["message"] in err


def test_one_error_of_many_has_a_code(folder: Path, capsys: Capture) -> None:
    put("bad.off", cuboid((0, 0, 0), (1, 1, 1)))
    Path("bad.off").write_text("OFF\n")
    _, out, _ = ran(capsys, "convert", "a.off", "bad.off", "--to", "ply", "--outdir", ".", "--json")
    error = json.loads(out)["files"][1]["error"]
    assert set(error) == {"code", "message", "where"} and error["message"].startswith("bad.off:")


def test_repair_tells_what_was_noticed(folder: Path, capsys: Capture) -> None:
    b.box(0.1, 0.2, 0.3).save("x.glb")
    b.box(0.1, 0.2, 0.3).save("x.ply")
    for name, said in (("x.glb", "unit"), ("x.ply", "single_precision")):
        code, out, err = ran(capsys, "repair", name, "-o", "y.stl", "--json")
        (finding,) = json.loads(out)["findings"]
        assert code == 0 and finding["code"] == said and finding["message"] in err


# Found: the printed seconds omitted half of the work.
def test_seconds_are_all_of_them(folder: Path, capsys: Capture) -> None:
    put("ball.ply", icosphere(5))
    began = time.perf_counter()
    line = ["union", "ball.ply", "a.off", "-o", "x.stl"]
    seconds = json.loads(ran(capsys, *line, "--json")[1])["seconds"]
    taken = time.perf_counter() - began
    assert {"start", "read", "combine", "check", "write", "total"} <= set(seconds)
    parts = sum(seconds.values()) - seconds["total"]
    assert parts <= seconds["total"] + 0.01
    assert 0.9 * taken - 0.05 < seconds["total"] <= taken


def test_seconds_count_from_the_start_of_the_process(folder: Path) -> None:
    code, out, _ = finished("union", "a.off", "c.stl", "-o", "x.ply", "--json")
    assert code == 0 and json.loads(out)["seconds"]["start"] > 0.005


@POSIX
@pytest.mark.deep
def test_long_work_says_for_how_long_at_a_terminal(folder: Path) -> None:
    leader, follower = pty.openpty()
    running = process(
        *["info", "-", "--from", "csg"],
        stdin=-1,
        stdout=-1,
        stderr=follower,
        more={"TERM": "xterm"},
    )
    os.close(follower)
    said = b""
    while b"info \xe2\x80\xa6 2 s" not in said:
        said += os.read(leader, 1000)
    assert running.stdin is not None and running.stdout is not None
    running.stdin.write(CSG.encode())
    running.stdin.close()
    with running.stdout as out:
        assert b"volume" in out.read() and running.wait(timeout=60) == 0
    # The line goes before the process ends.
    said += os.read(leader, 1000)
    os.close(leader)
    assert said.endswith(b"\r\033[K")


def test_nothing_is_under_way_in_pipes(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(status_line, "_LINE_DELAY", 0.0)
    with status_line.displayed("work", quiet=False):
        assert status_line._line is None
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    for name, quiet in (("dumb", False), ("xterm", True)):
        monkeypatch.setenv("TERM", name)
        with status_line.displayed("work", quiet):
            assert status_line._line is None


# Found: control sequences in names of files reached the terminal.
@POSIX
@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("info", 0),
        ("check", 0),
        ("convert --to stl --outdir new", 0),
        ("compare a.off", 1),
        ("union a.off --unit in -o x.3mf", 0),
        ("repair -o x.ply", 0),
        ("view --no-open -o x.html", 0),
    ],
)
def test_names_do_not_steer_the_terminal(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch, line: str, code: int
) -> None:
    """Names of files that are there, and of those that are not: neither title nor cursor moves."""
    name = "\x1b]0;title\x07\x9b2J b.stl"
    verb, *words = line.split()
    at_terminal(monkeypatch, 80)
    monkeypatch.setenv("FORCE_COLOR", "1")
    put(name, cuboid((0, 0, 0), (0.1, 0.2, 0.3)))
    found, out, err = ran(capsys, verb, name, *words, "-v")
    missing, _, refusal = ran(capsys, verb, f"no{name}", *words)
    assert (found, missing) == (code, 3), err + refusal
    for told in (out + err, refusal):
        assert not re.search(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]", re.sub(r"\x1b\[\d+m", "", told))
    shown = "\ufffd]0;title\ufffd\ufffd2J b."
    # Where the name is no part of the result, only the missing file is named.
    assert shown in refusal and (shown in out + err or verb in {"union", "repair", "view"})
