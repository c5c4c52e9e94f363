"""Every exit code of every command that has it; a command that fails writes no file."""

import errno
import io
import json
import os
import resource
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg.cli.console import standard_streams
from bspcsg.cli.main import _VERBS, run
from bspcsg.errors import missing_part
from bspcsg.operations.setops import OPERATIONS
from support.cli import Capture, finished, process, put, ran
from support.results import disagreeing, header, write_results
from support.shapes import cube, cuboid, icosphere, joined, moved

POSIX = pytest.mark.skipif(os.name != "posix", reason="as POSIX has it")

#: By exit code, commands in a folder of good and bad files (see `place`).
CODES = {
    0: [
        "union a.off c.stl -o x.ply",
        "difference a.off c.stl -o x.ply",
        "intersection a.off c.stl -o x.ply",
        "xor a.off c.stl -o x.ply",
        "eval '(a.off - c.stl) | c.stl' -o x.ply",
        "run good.csg -o x.ply",
        "split a.off --plane 0,0,1,1 -o x-%.ply",
        "slice a.off --z 1 -o x.svg",
        "hull a.off c.stl -o x.ply",
        "simplify a.off -o x.ply --tolerance 0.01mm",
        "split a.off c.stl -o x%.ply",
        "project a.off -o x.svg",
        "clash apart.off a.off --clearance 1mm",
        "render a.off -o x.svg",
        "convert a.off -o x.ply",
        "info a.off open.stl",
        "check a.off c.stl",
        "repair open.stl -o x.ply",
        "compare a.off same.obj",
        "crosscheck a.off c.stl --op union --results x.jsonl -j 1",
        "report results.jsonl -o x.html",
        "view a.off -o x.html --no-open",
        "lecture -o x.html",
        "lecture -o /dev/null",
        "tree good.csg",
        "bench --list",
        "doctor",
        "--help",
        "--version",
    ],
    1: [
        "check a.off open.stl",
        "check --strict double.ply",
        "compare a.off c.stl",
        "clash a.off c.stl",
        "clash apart.off a.off --clearance 9mm",
        "compare a.off near.off --tolerance 1e-6",
        "convert third.off -o x.stl --fail-on-loss",
        "repair open.stl -o x.ply --steps orient",
    ],
    2: [
        "",
        "unoin a.off c.stl -o x.ply",
        "union a.off c.stl",
        "union a.off -o x.ply",
        "xor a.off c.stl -o x.ply --pitch 23",
        "eval 'a.off -' -o x.ply",
        "eval '' -o x.ply",
        "run good.csg",
        "split a.off -o x.ply --plane 0,0,1",
        "slice a.off -o x.svg",
        "hull -o x.ply",
        "simplify a.off -o x.ply",
        "simplify a.off -o x.ply --tolerance -1",
        "split a.off a.off -o x%.ply",
        "split a.off -o -",
        "project a.off -o -",
        "clash a.off",
        "clash a.off c.stl --clearance no",
        "render a.off -o x.svg --size 0x9",
        "convert a.off c.stl -o x.ply",
        "convert a.off",
        "info",
        "check --from step a.off",
        "repair open.stl -o x.ply --steps none",
        "compare a.off",
        "crosscheck",
        "report results.jsonl",
        "view",
        "lecture part.stl",
        "tree",
        "bench no-such-case",
        "doctor a.off",
        "info a.off --threads -1",
        "info - --from",
    ],
    3: [
        "union a.off none.stl -o x.ply",
        "intersection a.off cut.stl -o x.ply",
        "union a.off c.stl -o x.step",
        "eval 'a.off - none.stl' -o x.ply",
        "run none.csg -o x.ply",
        "run a.off -o x.ply",
        "run bad.csg -o x.ply",
        "run bad.py -o x.ply",
        "split cut.stl -o x-%.ply",
        "slice cut.stl --z 1 -o x.svg",
        "hull a.off cut.stl -o x.ply",
        "simplify cut.stl -o x.ply --tolerance 1",
        "split a.off cut.stl -o x%.ply",
        "project a.off -o x.png",
        "clash a.off none.stl",
        "render cut.stl -o x.svg",
        "render a.off -o x.jpg",
        "convert cut.stl -o x.ply",
        "convert part.step -o x.ply",
        "info none.stl",
        "info .",
        "check a.off cut.stl",
        "repair cut.stl -o x.ply",
        "compare a.off none.stl",
        "crosscheck none.stl",
        "report none.jsonl -o x.html",
        "report a.off -o x.html",
        "view none.stl -o x.html --no-open",
        "lecture -o x.txt",
        "tree bad.csg",
        "bench --from none.json",
    ],
    4: [
        "union a.off open.stl -o x.ply",
        "difference a.off a.off -o x.ply",
        "xor a.off far.off -o x.ply",
        "eval '~a.off' -o x.ply",
        "eval 'open.stl & a.off' -o x.ply",
        "run empty.csg -o x.ply",
        "run open.csg -o x.ply",
        "run number.py -o x.ply",
        "split a.off --plane 0,0,1,9 -o x-%.ply",
        "split open.stl -o x-%.ply",
        "slice a.off --z 9 -o x.svg",
        "slice open.stl --z 1 -o x.svg",
        "hull open.stl -o x.ply",
        "simplify open.stl -o x.ply --tolerance 1",
        "split a.off open.stl -o x%.ply",
        "project open.stl -o x.svg",
        "clash a.off open.stl",
        "compare a.off open.stl",
    ],
    5: [
        "union a.off c.stl -o no/x.ply",
        "union a.off c.stl -o folder.ply",
        "eval 'a.off' -o no/x.ply",
        "run good.csg -o no/x.ply",
        "split a.off -o no/x-%.ply",
        "slice a.off --z 1 -o no/x.svg",
        "hull a.off -o no/x.ply",
        "simplify a.off -o folder.ply --tolerance 1",
        "split a.off -o no/%.ply",
        "project a.off -o no/x.svg",
        "render a.off -o no/x.svg",
        "render a.off -o folder.svg",
        "convert a.off -o folder.ply",
        "convert a.off --to stl --outdir a.off",
        "repair open.stl -o no/x.ply",
        "report results.jsonl -o no/x.html",
        "view a.off -o no/x.html --no-open",
        "lecture -o no/x.html",
        "tree good.csg -o no/x.json",
    ],
}


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Change to a temporary folder with valid and invalid files, and yield it."""
    folder = tmp_path_factory.mktemp("place")
    before = Path.cwd()
    os.chdir(folder)
    put("a.off", cuboid((0, 0, 0), (2, 2, 2)))
    put("same.obj", cuboid((0, 0, 0), (2, 2, 2)))
    put("near.off", cuboid((0, 0, 0), (2, 2, 2.001)))
    put("c.stl", cuboid((1, 1, 1), (3, 3, 3)))
    put("third.off", cube(1 / 3))
    put("apart.off", cuboid((5, 0, 0), (6, 1, 1)))
    put("far.off", moved(cube(), (1e300, 0, 0)))
    put("double.ply", joined(cuboid((0, 0, 0), (2, 2, 2)), cuboid((1, 1, 1), (3, 3, 3))))
    vertices, faces = icosphere(0)
    put("open.stl", (vertices, faces[1:]))
    Path("cut.stl").write_bytes(Path("c.stl").read_bytes()[:-1])
    Path("folder.ply").mkdir()
    Path("folder.svg").mkdir()
    Path("good.csg").write_text("cube(2);")
    Path("bad.csg").write_text("cube(2")
    Path("empty.csg").write_text("union();")
    Path("open.csg").write_text('import(file = "open.stl");')
    Path("bad.py").write_text("raise ValueError('no')")
    Path("number.py").write_text("result = 3")
    write_results(Path("results.jsonl"), [header(), disagreeing()])
    Path("endless.py").write_text("open('started', 'w')\nwhile True:\n    pass\n")
    yield folder
    os.chdir(before)


def written(before: set[str]) -> set[str]:
    """Return the names of new files in the current folder, after deleting them."""
    new = set(os.listdir()) - before
    for name in new:
        os.unlink(name)
    return new


# Found: `lecture -o /dev/null` was refused.
@pytest.mark.parametrize("code", CODES)
def test_codes(place: Path, capsys: Capture, code: int) -> None:
    before = set(os.listdir())
    for line in CODES[code]:
        found, _, err = ran(capsys, *shlex.split(line))
        assert found == code, (line, err)
        new = written(before)
        assert all(name.startswith("x") for name in new), line
        if code > 1:
            assert not new and err, line
            errors = [text for text in err.splitlines() if text.startswith("bspcsg: error: ")]
            assert len(errors) == (line != ""), line


def test_every_verb_is_tried() -> None:
    tried = {code: {line.partition(" ")[0] for line in lines} for code, lines in CODES.items()}
    assert set(_VERBS) <= tried[0] and len(set(_VERBS) - tried[2]) <= 4
    assert set(_VERBS) - tried[3] <= {"difference", "xor", "doctor"}


@pytest.mark.parametrize("line", ["union a.off c.stl -o x.ply"])
def test_the_process_ends_with_the_code(place: Path, line: str) -> None:
    before = set(os.listdir())
    assert finished(*shlex.split(line))[0] == 0
    assert finished(*shlex.split(line.replace("a.off", "none.off")))[0] == 3
    written(before)


@pytest.mark.parametrize(
    ("line", "package"),
    [
        ("convert a.off -o x.vtk", "meshio"),
        ("render a.off -o x.png", "PIL"),
        ("slice a.off --z 1 -o x.dxf", "ezdxf"),
    ],
)
def test_code_6_names_what_to_install(
    place: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch, line: str, package: str
) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == package]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, package, None)
    before = set(os.listdir())
    code, out, err = ran(capsys, *shlex.split(line))
    assert (code, out) == (6, "") and "pip install" in err
    assert not written(before)


def test_code_6_of_a_missing_program(
    place: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("good.scad").write_text("cube(2);")
    monkeypatch.setenv("PATH", str(place))
    code, _, err = ran(capsys, "run", "good.scad", "-o", "x.ply")
    assert code == 6 and "openscad" in err


def test_code_70_asks_for_a_report(
    place: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise AssertionError("never")

    monkeypatch.setitem(OPERATIONS, "union", fail)
    code, out, err = ran(capsys, "union", "a.off", "c.stl", "-o", "x.ply")
    assert (code, out) == (70, "") and len(err.splitlines()) == 1
    assert "AssertionError: never" in err and "--debug" in err
    code, out, _ = ran(capsys, "union", "a.off", "c.stl", "-o", "x.ply", "--json")
    assert code == json.loads(out)["exit"] == 70


def test_code_70_of_an_exhausted_memory(
    place: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise MemoryError

    monkeypatch.setitem(OPERATIONS, "xor", fail)
    code, _, err = ran(capsys, "xor", "a.off", "c.stl", "-o", "x.ply")
    assert code == 70 and "out of memory" in err


@pytest.mark.parametrize("line", ["run endless.py -o x.ply --timeout 0.5"])
def test_code_124_after_a_time_limit(place: Path, capsys: Capture, line: str) -> None:
    code, out, err = ran(capsys, *shlex.split(line))
    assert (code, out) == (124, "") and "0.5 s" in err and not Path("x.ply").exists()


@POSIX
def test_code_130_after_an_interrupt(place: Path) -> None:
    Path("started").unlink(missing_ok=True)
    running = process("run", "endless.py", "-o", "x.ply", stderr=subprocess.PIPE)
    began = time.monotonic()
    while not Path("started").exists() and time.monotonic() - began < 30:
        time.sleep(0.05)
    running.send_signal(signal.SIGINT)
    _, err = running.communicate(timeout=30)
    assert (running.returncode, err) == (130, b"") and not Path("x.ply").exists()


@POSIX
@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "line",
    ["compare a.off same.obj", "convert a.off -o - --to stl", "--help"],
)
def test_code_141_after_a_closed_pipe(place: Path, line: str) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    running = process(*shlex.split(line), stdout=writer, stderr=subprocess.PIPE)
    os.close(writer)
    _, err = running.communicate(timeout=60)
    assert (running.returncode, err) == (141, b"")


@POSIX
@pytest.mark.sampled(2)
@pytest.mark.parametrize("verb", ["union", "render"])
def test_code_5_when_the_disk_is_full(place: Path, verb: str) -> None:
    put("s.ply", icosphere(3))
    Path("x.ply").write_text("kept")
    lines = {
        "union": "union a.off s.ply -o x.ply --no-check",
        "render": "render s.ply -o x.svg",
    }
    before = set(os.listdir())
    running = process(*shlex.split(lines[verb]), stderr=subprocess.PIPE, before=_no_large_files)
    _, err = running.communicate(timeout=60)
    assert running.returncode == 5 and b"cannot write this file: File too large." in err
    assert set(os.listdir()) == before and Path("x.ply").read_text("utf-8") == "kept"
    os.unlink("x.ply")


def _no_large_files() -> None:
    """Limit the size of files to 2000 bytes, as on a disk that is nearly full."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="there is no /dev/zero")
def test_code_3_of_devices_that_never_end(place: Path, capsys: Capture) -> None:
    for name, line in {
        "zero.stl": "info zero.stl",
        "zero.csg": "run zero.csg -o x.ply",
        "zero": "convert zero --from stl -o x.ply",
    }.items():
        Path(name).symlink_to("/dev/zero")
        code, _, err = ran(capsys, *shlex.split(line))
        assert (
            code == 3
            and f"{name}: cannot read this file: the path names a device, not a file." in err
        )
        os.unlink(name)


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EIO])
def test_code_5_when_standard_output_is_full(
    place: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture, number: int
) -> None:
    class Full(io.RawIOBase):
        def writable(self) -> bool:
            return True

        def write(self, _: object) -> int:
            raise OSError(number, "no more")

    with monkeypatch.context() as place_of_output:
        place_of_output.setattr(
            "bspcsg.cli.console.standard_streams.redirect_to_null", lambda *_: None
        )
        raw = standard_streams._CompleteWriter(Full(), None, standard_streams._refuse)
        place_of_output.setattr(sys, "stdout", io.TextIOWrapper(io.BufferedWriter(raw)))
        assert run(["info", "a.off"]) == 5
        raw.write = len  # type: ignore[method-assign]
    assert "standard output: cannot write: no more." in capsys.readouterr().err


def test_the_codes_of_errors_are_those_of_the_help(capsys: Capture) -> None:
    _, out, _ = ran(capsys, "--help")
    for code in (*CODES, 6, 70, 124, 130, 141):
        assert f"  {code} " in out


def test_errors_of_the_library_have_codes() -> None:
    from bspcsg.cli.console.output import exit_code_of

    assert exit_code_of(missing_part("x", "for y", "z")) == 6
    assert exit_code_of(b.InternalError("x")) == 70
    assert exit_code_of(b.FormatError("x", "unwritable")) == 5
    assert exit_code_of(b.FormatError("x", "syntax")) == 3
    assert exit_code_of(b.LimitError("x", "too_large")) == 4
    assert exit_code_of(b.UnboundedError("x", "unbounded")) == 4
