"""Streams, file names that are no text, full disks, interrupts, completion, and startup time."""

import errno
import io
import os
import resource
import signal
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

import pytest

import bspcsg as b
from bspcsg.cli.console import standard_streams
from support.cli import Capture, Piped, finished, process, put, ran
from support.results import disagreeing, header, write_results
from support.shapes import icosphere, moved

POSIX = pytest.mark.skipif(os.name != "posix", reason="as POSIX has it")


def volume_of(data: bytes, suffix: str) -> float:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"read-back.{suffix}")
        path.write_bytes(data)
        return b.load(path).volume


@pytest.mark.parametrize("suffix", ["stl", "ply", "3mf", "glb"])
def test_streams_in_and_out(folder: Path, piped: Piped, suffix: str) -> None:
    given = Path("c.stl").read_bytes()
    arguments = ["union", "a.off", "-", "--from", "stl", "-o", "-", "--to", suffix]
    code, out, err = piped(*arguments, given=given)
    assert code == 0 and volume_of(out, suffix) == pytest.approx(15, rel=1e-6)
    # Standard output has nothing but the mesh; messages go to standard error.
    assert b"check: agree" in err


def test_a_chain_of_pipes(folder: Path) -> None:
    made = finished("union", "a.off", "c.stl", "-o", "-", "--to", "ply", "-q")
    assert made[0] == 0 and made[2] == b""
    code, out, _ = finished("info", "-", "--from", "ply", given=made[1])
    assert code == 0 and b"volume" in out and b"15" in out


def test_files_without_a_suffix(folder: Path, capsys: Capture) -> None:
    Path("c.stl").rename("c")
    assert ran(capsys, "union", "a.off", "c", "-o", "x", "--from", "stl", "--to", "ply")[0] == 0
    assert volume_of(Path("x").read_bytes(), "ply") == 15


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["union", "-", "a.off", "-o", "x.ply"], "--from"),
        (["union", "-", "-", "-o", "x.ply", "--from", "stl"], "only once"),
        (["union", "a.off", "c.stl", "-o", "-"], "--to"),
        (["union", "a.off", "c.stl", "-o", "-", "--to", "ply", "--json"], "--json"),
        (
            ["union", "a.off", "c.stl", "-o", "x.ply", "--to", "step"],
            "'step' is not a known format",
        ),
        (["info", "-"], "--from"),
    ],
)
def test_streams_that_cannot_be(
    folder: Path, capsys: Capture, arguments: list[str], words: str
) -> None:
    code, out, err = ran(capsys, *arguments)
    assert code == 2 and words in err and "Try: bspcsg" in err
    assert ("error" in out) == ("--json" in arguments)


def test_an_empty_stream(folder: Path, piped: Piped) -> None:
    code, out, err = piped("union", "a.off", "-", "--from", "stl", "-o", "x.ply")
    assert (code, out, err) == (3, b"", b"bspcsg: error: -: the file is empty.\n")


@POSIX
@pytest.mark.parametrize("suffix", [b"stl", b"3mf", b"glb", b"obj"])
def test_names_that_are_no_text(folder: Path, piped: Piped, suffix: bytes) -> None:
    os.rename(b"c.stl", b"c\xff\n.stl")
    name = b"x\xfe." + suffix
    code, out, err = piped("union", "a.off", b"c\xff\n.stl", "-o", name)
    assert code == 0 and out.startswith(name) and os.path.exists(name)
    code, out, err = piped("info", b"none\xff.stl")
    assert code == 3 and b"none\xff.stl: cannot read" in err


@POSIX
def test_terminals_without_quotes_and_signs(folder: Path) -> None:
    Path("a.off").rename("\u017ca.off")
    code, out, _ = finished("info", "\u017ca.off", more={"PYTHONIOENCODING": "latin-1"})
    # The sign of the size is in Latin-1, the first letter of the name is not.
    assert code == 0 and b"2 \xd7 2 \xd7 2" in out and b" ?a.off\n" in out


@pytest.mark.parametrize("verb", ["union", "eval", "convert", "split", "repair"])
def test_a_full_disk(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch, verb: str
) -> None:
    put("open.ply", (icosphere(1)[0], icosphere(1)[1][1:]))

    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    arguments = {
        "union": ["union", "a.off", "c.stl"],
        "eval": ["eval", "a.off - c.stl"],
        "convert": ["convert", "a.off"],
        "split": ["split", "a.off"],
        "repair": ["repair", "open.ply"],
    }
    before = sorted(os.listdir())
    code, out, err = ran(capsys, *arguments[verb], "-o", "x.ply")
    assert (code, out) == (5, "") and "No space left on device" in err
    assert sorted(os.listdir()) == before


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no /dev/full")
@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "arguments", [["info", "a.off"], ["check", "a.off"], ["convert", "a.off", "-o-", "--to", "stl"]]
)
def test_a_full_output(folder: Path, arguments: list[str]) -> None:
    with open("/dev/full", "wb") as full:
        code, _, err = finished(*arguments, stdout=full)
    assert code == 5
    assert err == b"bspcsg: error: standard output: cannot write: No space left on device.\n"


def closed(number: int) -> Any:
    """Return a function that closes the standard stream with this number in a new process."""
    return lambda: os.close(number)


@POSIX
@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["union", "-", "a.off", "--from", "off", "-o", "x.ply"], b"-: the file is empty.\n"),
        (["info", "-", "--from", "stl"], b"-: the file is empty.\n"),
        (["render", "-", "--from", "stl", "-o", "x.svg"], b"-: the file is empty.\n"),
        (
            ["report", "-", "-o", "x.md"],
            b"-: the results contain no case; run bspcsg crosscheck --results first.\n",
        ),
    ],
)
def test_a_closed_input_is_an_empty_one(folder: Path, arguments: list[str], said: bytes) -> None:
    before = sorted(os.listdir())
    code, out, err = finished(*arguments, before=closed(0))
    assert (code, out, err) == (3, b"", b"bspcsg: error: " + said)
    assert sorted(os.listdir()) == before


@POSIX
@pytest.mark.sampled(5)
@pytest.mark.parametrize(
    "arguments",
    [
        ["info", "a.off"],
        ["doctor"],
        ["tree", "m.csg"],
        ["union", "a.off", "c.stl", "-o-", "--to", "off", "-q"],
        ["render", "a.off", "-o-", "--to", "svg", "-q"],
    ],
)
def test_a_closed_output_is_one_that_cannot_be_written(folder: Path, arguments: list[str]) -> None:
    Path("m.csg").write_text("cube(1);")
    code, out, err = finished(*arguments, before=closed(1))
    assert (code, out) == (5, b"")
    assert err == b"bspcsg: error: standard output: cannot write: Bad file descriptor.\n"


@POSIX
def test_no_output_file_takes_the_place_of_a_closed_stream(folder: Path) -> None:
    code, out, err = finished("union", "a.off", "c.stl", "-o", "x.off", before=closed(2))
    assert code == 0 and out.startswith(b"x.off  ") and err == b""
    assert volume_of(Path("x.off").read_bytes(), "off") == 15


def test_scripts_from_a_stream(piped: Piped) -> None:
    arguments = ("run", "-", "-o", "-", "--to", "off", "-q")
    code, out, _ = piped(*arguments, given=b"cube(3);")
    assert code == 0 and volume_of(out, "off") == 27
    code, _, err = piped(*arguments, given=b"cube(3);\n\n  tent();")
    assert code == 3 and err.startswith(b"bspcsg: error: -:3:3: tent() is not supported. ")
    assert piped(*arguments, given=b"\xff")[0] == 3


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="nothing is forbidden to root")
def test_no_permission(folder: Path, capsys: Capture) -> None:
    Path("a.off").chmod(0)
    code, _, err = ran(capsys, "info", "a.off")
    assert code == 3 and "Permission denied" in err
    folder.chmod(0o500)
    code, _, err = ran(capsys, "convert", "c.stl", "-o", "x.ply")
    assert code == 5 and "is not writable" in err


def test_forbidden_files_as_the_system_tells_it(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def forbidden(*_: Any) -> None:
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", forbidden)
    code, _, err = ran(capsys, "info", "a.off")
    assert code == 3
    assert err == "bspcsg: error: a.off: cannot read this file: Permission denied.\n"


@pytest.mark.parametrize("verb", ["compare", "slice"])
def test_folders_are_no_files(folder: Path, capsys: Capture, verb: str) -> None:
    Path("d.stl").mkdir()
    more = {"compare": ["a.off"], "slice": ["--z", "1", "-o", "x.svg"]}[verb]
    code, _, err = ran(capsys, verb, "d.stl", *more)
    assert code == 3 and "d.stl: cannot read this file: Is a directory." in err


@POSIX
@pytest.mark.deep
@pytest.mark.parametrize("verb", ["eval", "compare"])
def test_interrupts_are_quiet(folder: Path, verb: str) -> None:
    put("s.ply", icosphere(6))
    put("t.ply", moved(icosphere(6), (0.001, 0.002, 0.003)))
    more = {"eval": ["s.ply ^ t.ply", "-o", "x.ply"], "compare": ["s.ply", "t.ply"]}[verb]
    running = process(verb, *more, "-v", stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert running.stderr is not None and b"s.ply" in running.stderr.readline()
    time.sleep(0.3)
    running.send_signal(signal.SIGINT)
    out, err = running.communicate(timeout=60)
    assert running.returncode == 130
    assert out == b"" and b"Traceback" not in err and not Path("x.ply").exists()


SHELLS = {"bash": b"complete", "zsh": b"compdef", "fish": b"complete"}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("shell", SHELLS)
def test_completion_scripts(shell: str) -> None:
    code, out, _ = finished(more={"_BSPCSG_COMPLETE": f"{shell}_source"})
    assert code == 0 and SHELLS[shell] in out and b"_BSPCSG_COMPLETE" in out


@pytest.mark.parametrize(
    ("words", "found"),
    [
        ("bspcsg co", {b"plain,convert", b"plain,compare"}),
        ("bspcsg union --win", {b"plain,--winding"}),
        ("bspcsg union --winding e", {b"plain,even-odd"}),
        ("bspcsg check a", {b"file,a"}),
        ("bspcsg convert a.off --to o", {b"plain,obj", b"plain,off"}),
        ("bspcsg info - --from c", {b"plain,csg"}),
        ("bspcsg bench cub", {b"plain,cubes"}),
    ],
)
def test_completions(
    monkeypatch: pytest.MonkeyPatch, piped: Piped, words: str, found: set[bytes]
) -> None:
    monkeypatch.setenv("_BSPCSG_COMPLETE", "bash_complete")
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", str(len(words.split()) - 1))
    code, out, _ = piped()
    assert code == 0 and set(out.split()) == found


@POSIX
def test_the_version_comes_at_once() -> None:
    spent = []
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        assert process("--version", stdout=subprocess.DEVNULL).wait(timeout=60) == 0
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    assert min(spent) < 0.2


def test_folders_that_are_forbidden(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)
    for arguments in (["convert", "a.off"], ["eval", "a.off"], ["split", "a.off"]):
        code, out, err = ran(capsys, *arguments, "-o", "x.ply")
        assert (code, out) == (5, "") and "the folder . does not exist or is not writable" in err


#: Environments in which Python's own streams are unbuffered or buffered.
UNBUFFERED = [{"PYTHONUNBUFFERED": "1"}, {"PYTHONUNBUFFERED": ""}]

#: Commands that write to standard output, one for each way in which the code writes.
ANSWERS = [
    ["convert", "s.ply", "-o-", "--to", "stl"],
    ["render", "s.ply", "-o-", "--to", "svg", "-q"],
    ["report", "results.jsonl", "-o-", "--format", "html"],
    ["tree", "long.csg"],
    ["info", *["a.off"] * 20, "--json"],
    ["--help"],
]


def at_most(size: int) -> Any:
    """Return a function that limits the size of files of a new process."""

    def limit() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    return limit


# Found: with unbuffered output, text was cut off when the disk was full, and the exit code was 0.
@POSIX
@pytest.mark.sampled(4)
@pytest.mark.parametrize("more", UNBUFFERED)
@pytest.mark.parametrize("arguments", ANSWERS)
def test_standard_output_takes_all_or_fails(
    folder: Path, arguments: list[str], more: dict[str, str]
) -> None:
    put("s.ply", icosphere(4))
    write_results(Path("results.jsonl"), [header(), disagreeing()])
    Path("long.csg").write_text("cube(1);" * 1000)
    with open("cut", "wb") as cut:
        code, _, err = finished(*arguments, stdout=cut, before=at_most(1000), more=more)
    assert (code, os.path.getsize("cut")) == (5, 1000)
    assert err.endswith(b"bspcsg: error: standard output: cannot write: File too large.\n")
    reader, writer = os.pipe()
    running = process(*arguments, stdout=writer, stderr=subprocess.PIPE, more=more)
    os.close(writer)
    assert len(os.read(reader, 1000)) == 1000
    os.close(reader)
    _, err = running.communicate(timeout=60)
    # What fits into a pipe at once was written before the reader stopped.
    assert running.returncode == 141 or (running.returncode == 0 and arguments[0] != "convert")


def test_systems_that_take_a_part_at_a_time() -> None:
    """As Linux takes 2 GiB at most."""
    taken = bytearray()

    class Sparing(io.RawIOBase):
        def write(self, data: Any) -> int:
            taken.extend(data[:7])
            return min(len(data), 7)

    data = bytes(range(256)) * 10
    whole = standard_streams._CompleteWriter(Sparing(), None, standard_streams._refuse)
    assert whole.write(data) == len(data) and bytes(taken) == data


@POSIX
def test_readers_that_are_not_waited_for(folder: Path) -> None:
    """Whoever shares a pipe may have set it so that it takes nothing while it is full."""
    put("s.ply", icosphere(4))
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    running = process("convert", "s.ply", "-o-", "--to", "stl", "-q", stdout=writer)
    os.close(writer)
    time.sleep(1)
    with open(reader, "rb") as stream:
        data = stream.read()
    assert running.wait(timeout=60) == 0 and len(data) == 84 + 50 * 5120


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="there is no /dev/full")
def test_words_that_nobody_can_hear_cost_no_work(folder: Path) -> None:
    with open("/dev/full", "wb") as full:
        assert finished("union", "a.off", "c.stl", "-o", "x.off", "-v", stderr=full)[0] == 0
        assert volume_of(Path("x.off").read_bytes(), "off") == 15
        assert finished("info", "none.off", stderr=full)[0] == 3


# Found: the error message named standard output instead of the file of results.
@POSIX
@pytest.mark.parametrize("size", [0, 100, 1500])
def test_a_full_disk_under_the_results(folder: Path, size: int) -> None:
    line = ["crosscheck", "a.off", "c.stl", "--op", "union", "-j1", "--results", "r.jsonl"]
    code, out, err = finished(*line, before=at_most(size))
    assert (code, out) == (5, b"")
    assert err == b"bspcsg: error: r.jsonl: cannot write: File too large.\n"


def test_other_files_on_a_full_disk(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any, **__: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", "/tmp/some")

    monkeypatch.setattr("tempfile.mkdtemp", full)
    Path("cube.py").write_text("import bspcsg\nresult = bspcsg.box(1, 1, 1)\n")
    code, out, err = ran(capsys, "run", "cube.py", "-o", "x.ply")
    assert (code, out) == (5, "")
    assert err == "bspcsg: error: /tmp/some: cannot write: No space left on device.\n"
