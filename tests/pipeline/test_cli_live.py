"""Live pages, which follow changes of their files, from a server on this machine."""

import http.client
import json
import os
import signal
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg.cli.pages.live_server import LiveServer, Site, change_stamp
from support.cli import Capture, process, put, ran
from support.shapes import cuboid

_SCRIPT = "import bspcsg as b\nresult = b.cube({side})\n"


_SAID = Path("log/said.txt")


@contextmanager
def serving(*arguments: str) -> Iterator[tuple[int, "subprocess.Popen[bytes]"]]:
    """Start a server and yield its port and process; assert that Ctrl-C ends it quietly."""
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    running = process(*arguments, "--no-open", "--json", **pipes)
    try:
        assert running.stdout is not None
        told = json.loads(running.stdout.readline())
        yield int(told["address"].rsplit(":", 1)[1].strip("/")), running
    finally:
        running.send_signal(signal.SIGINT)
        _, err = running.communicate(timeout=20)
    assert running.returncode == 0 and b"Traceback" not in err


def asked(port: int, path: str, **headers: str) -> tuple[int, str]:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    try:
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        return answer.status, answer.read().decode()
    finally:
        connection.close()


def changed(port: int, before: str) -> str:
    """Wait until the server's state differs from `before`, and return it."""
    for _ in range(300):
        now = asked(port, "/changes")[1]
        if now != before:
            return now
        time.sleep(0.05)
    raise AssertionError("nothing changed")


def test_a_page_follows_its_script(folder: Path) -> None:
    Path("part.py").write_text(_SCRIPT.format(side=2))
    with serving("view", "part.py", "--live") as (port, _):
        before = asked(port, "/changes")[1]
        status, page = asked(port, "/")
        assert status == 200 and "2 × 2 × 2" in page and "connect-src 'self'" in page
        Path("part.py").write_text(_SCRIPT.format(side=13))
        now = changed(port, before)
        assert "13 × 13 × 13" in asked(port, "/")[1]
        Path("part.py").write_text("resul = 1 +\n")
        changed(port, now)
        status, page = asked(port, "/")
        assert status == 200 and "part.py:1: SyntaxError" in page and "live" not in page[:200]


@pytest.mark.deep
def test_a_script_that_writes_beside_itself_runs_once(folder: Path) -> None:
    Path("part.py").write_text(
        "import bspcsg as b, pathlib, time\nresult = b.cube(2)\n"
        "open('runs.txt', 'a').write('x')\nb.io.save(result, 'out.stl')\n"
    )
    with serving("view", "part.py", "--live") as (port, _):
        asked(port, "/")
        state = asked(port, "/changes")[1]
        assert asked(port, "/")[0] == 200 and asked(port, "/changes")[1] == state
        assert Path("runs.txt").read_text("utf-8") == "x"


def test_a_folder_has_a_page_for_each_file(folder: Path) -> None:
    Path("notes.txt").write_text("secret")
    put("b & c.off", cuboid((0, 0, 0), (5, 5, 5)))
    with serving("view", ".") as (port, _):
        _, page = asked(port, "/")
        assert "/part/a.off" in page and "/part/b%20%26%20c.off" in page and "notes" not in page
        assert "5 × 5 × 5" in asked(port, "/part/b%20%26%20c.off")[1]
        for path in ("/part/notes.txt", "/part/../a.off", "/part/%2e%2e%2fx.off", "/a.off", "/x"):
            assert asked(port, path)[0] == 404
        state = asked(port, "/changes")[1]
        put("new.off", cuboid((0, 0, 0), (1, 1, 1)))
        changed(port, state)
        assert "/part/new.off" in asked(port, "/")[1]


def test_only_this_machine_is_answered() -> None:
    server = LiveServer(Site(lambda path: "x" if path == "/" else None, lambda: "1"))
    import threading

    thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
    thread.start()
    try:
        assert server.server_address[0] == "127.0.0.1"
        assert asked(server.server_port, "/") == (200, "x")
        assert asked(server.server_port, "/", Host="evil.example")[0] == 403
        assert asked(server.server_port, "/", Host=f"localhost:{server.server_port}")[0] == 200
    finally:
        server.shutdown()
        server.server_close()


@contextmanager
def watching(*arguments: str) -> Iterator["subprocess.Popen[bytes]"]:
    """Run a script with ``--watch`` until Ctrl-C, and yield its process."""
    # Not beside the script, where what is said would be a change.
    _SAID.parent.mkdir()
    with _SAID.open("w") as said:
        running = process("run", *arguments, "--no-open", stdout=said, stderr=said)
    try:
        yield running
    finally:
        running.send_signal(signal.SIGINT)
        running.wait(timeout=20)
    assert "Traceback" not in _SAID.read_text("utf-8")


def until(found: Callable[[], object]) -> None:
    for _ in range(300):
        if found():
            return
        time.sleep(0.05)
    raise AssertionError(_SAID.read_text("utf-8"))


@pytest.mark.deep
def test_a_script_runs_again_when_it_changes(folder: Path) -> None:
    Path("part.py").write_text(_SCRIPT.format(side=2))
    with watching("part.py", "--watch", "-o", "part.stl") as running:
        said = _SAID
        until(
            lambda: "volume 8 " in said.read_text("utf-8") and "watching" in said.read_text("utf-8")
        )
        Path("part.py").write_text("result = 1 +\n")
        until(lambda: "SyntaxError" in said.read_text("utf-8"))
        Path("part.py").write_text(_SCRIPT.format(side=3))
        until(lambda: "volume 27 " in said.read_text("utf-8"))
        assert said.read_text("utf-8").count("volume") == 2
    assert running.returncode == 0 and b.io.load("part.stl").volume == 27


@pytest.mark.deep
def test_a_result_is_shown_without_a_file(folder: Path) -> None:
    Path("part.py").write_text(_SCRIPT.format(side=2))
    before = sorted(os.listdir())
    with watching("part.py", "--watch", "--view") as running:
        said = _SAID
        until(lambda: "shows the result" in said.read_text("utf-8"))
        port = int(said.read_text("utf-8").partition("http://127.0.0.1:")[2].partition("/")[0])
        state = asked(port, "/changes")[1]
        assert "2 × 2 × 2" in asked(port, "/")[1] and asked(port, "/x")[0] == 404
        Path("part.py").write_text("result = 1 +\n")
        state = changed(port, state)
        assert "SyntaxError" in asked(port, "/")[1]
        Path("part.py").write_text(_SCRIPT.format(side=5))
        changed(port, state)
        assert "5 × 5 × 5" in asked(port, "/")[1]
        assert said.read_text("utf-8").startswith("part.py  12 triangles")
    assert running.returncode == 0
    assert set(os.listdir()) == {*before, "log"}


def test_the_stamp_sees_every_change(tmp_path: Path) -> None:
    inside = tmp_path / "a.txt"
    seen = [change_stamp([tmp_path])]
    inside.write_text("1")
    seen.append(change_stamp([tmp_path]))
    os.utime(inside, ns=(1, 1))
    seen.append(change_stamp([tmp_path]))
    inside.unlink()
    assert len({*seen}) == 3 and change_stamp([tmp_path]) == seen[0]
    assert change_stamp([inside]) == change_stamp([inside])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["view", ".", "-o", "x.html"], "leave out -o"),
        (["view", "a.off", "--live", "-o", "x.html"], "leave out -o"),
        (["view", "-", "--live", "--from", "stl"], "not standard input"),
        (["run", "part.py"], "-o part.stl"),
        (["run", "part.py", "--watch"], "-o part.stl"),
        (["run", "-", "--view"], "not standard input"),
    ],
)
def test_refusals(folder: Path, capsys: Capture, arguments: list[str], words: str) -> None:
    code, out, err = ran(capsys, *arguments)
    assert (code, out) == (2, "") and words in err
