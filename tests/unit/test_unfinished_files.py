"""An unfinished file of a killed process is removed by the next writer in its folder."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg.formats import atomic
from bspcsg.formats.atomic import write_file

pytestmark = pytest.mark.skipif(os.name != "posix", reason="locks of POSIX")

#: Begins a file in this folder, says so, and waits to be killed.
WRITER = """
import sys
from bspcsg.formats.atomic import write_file
def chunks():
    yield b"half of it"
    sys.stdout.write("begun\\n")
    sys.stdout.flush()
    sys.stdin.read()
write_file("x.stl", chunks())
"""

#: Writes many files, each time as if it were the first in this folder.
CROWD = """
from bspcsg.formats import atomic
for k in range(30):
    atomic._cleaned_folders.clear()
    atomic.write_file(f"x{k % 3}.stl", [b"all of it"])
"""


def started(program: str, folder: Path) -> "subprocess.Popen[str]":
    path = str(Path(b.__file__).parents[1])
    return subprocess.Popen(
        [sys.executable, "-c", program],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": path},
        text=True,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )


def begun(folder: Path) -> "subprocess.Popen[str]":
    """Return a process that has started to write a file in a folder."""
    writer = started(WRITER, folder)
    assert writer.stdout is not None and writer.stdout.readline() == "begun\n"
    return writer


def kill(writer: "subprocess.Popen[str]") -> None:
    writer.send_signal(signal.SIGKILL)
    writer.communicate()


def names(folder: Path) -> list[str]:
    return sorted(os.listdir(folder))


@pytest.fixture(autouse=True)
def at_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(atomic, "_cleaned_folders", set())


# Found: after kill -9, hidden files of full size stayed for ever.
def test_files_of_the_dead_go_and_those_of_the_living_stay(tmp_path: Path) -> None:
    dead, living = begun(tmp_path), begun(tmp_path)
    kill(dead)
    assert len(names(tmp_path)) == 2
    write_file(tmp_path / "y.stl", [b"y"])
    first, second = names(tmp_path)
    assert first.startswith(".x.stl.") and second == "y.stl"
    living.communicate()
    assert living.returncode == 0 and names(tmp_path) == ["x.stl", "y.stl"]
    assert (tmp_path / "x.stl").read_bytes() == b"half of it"


def test_a_file_of_this_very_process_stays(tmp_path: Path) -> None:
    def chunks() -> Iterator[bytes]:
        yield b"x"
        atomic._cleaned_folders.clear()
        write_file(tmp_path / "y.stl", [b"y"])

    write_file(tmp_path / "x.stl", chunks())
    assert names(tmp_path) == ["x.stl", "y.stl"]


def test_a_file_stays_until_it_has_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    replace = os.replace

    def late(one: Path, other: Path) -> None:
        monkeypatch.setattr(os, "replace", replace)
        atomic._cleaned_folders.clear()
        write_file(tmp_path / "y.stl", [b"y"])
        replace(one, other)

    monkeypatch.setattr(os, "replace", late)
    write_file(tmp_path / "x.stl", [b"x"])
    assert names(tmp_path) == ["x.stl", "y.stl"]


def test_what_is_called_alike_stays(tmp_path: Path) -> None:
    machine = atomic._machine()
    other = f"{int(machine, 16) ^ 1:08x}"
    kept = [
        f".x.{other}-01234567.part",  # another machine's, which locks may not reach
        ".x.01234567.part",  # of version 1.0.0, which holds no lock
        f"x.{machine}-01234567.part",
        f".x.{machine}-01234567.part.stl",
        f".x.{machine}-0123456.part",
    ]
    for name in kept:
        (tmp_path / name).write_bytes(b"kept")
    (tmp_path / f".d.{machine}-01234567.part").mkdir()
    (tmp_path / f".l.{machine}-01234567.part").symlink_to(kept[0])
    os.mkfifo(tmp_path / f".p.{machine}-01234567.part")
    before = names(tmp_path)
    (tmp_path / f".x.{machine}-01234567.part").write_bytes(b"left")
    write_file(tmp_path / "y.stl", [b"y"])
    assert names(tmp_path) == sorted([*before, "y.stl"])


def test_long_names(tmp_path: Path) -> None:
    name = "\N{GRINNING FACE}" * 62 + ".stl"
    write_file(tmp_path / name, [b"x"])
    assert names(tmp_path) == [name]


def test_many_who_write_and_sweep_at_once(tmp_path: Path) -> None:
    crowd = [started(CROWD, tmp_path) for _ in range(4)]
    for one in crowd:
        one.communicate(timeout=60)
    assert [one.returncode for one in crowd] == [0] * 4
    assert names(tmp_path) == ["x0.stl", "x1.stl", "x2.stl"]


def test_folders_that_show_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def forbidden(_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(os, "scandir", forbidden)
    write_file(tmp_path / "x.stl", [b"x"])
    assert (tmp_path / "x.stl").read_bytes() == b"x"
