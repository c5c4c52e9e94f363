"""Run the command line, in this process or in a process of its own."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

import pytest

import bspcsg
from bspcsg.cli.main import run
from bspcsg.io import RawMesh, write

from .shapes import Arrays

Capture = pytest.CaptureFixture[str]


class Piped(Protocol):
    """A function that runs a command with bytes as its standard input."""

    def __call__(self, *arguments: str | bytes, given: bytes = b"") -> tuple[int, bytes, bytes]:
        """Return the exit code, standard output and standard error."""


def put(name: str, mesh: Arrays) -> None:
    """Write a mesh to a file."""
    write(RawMesh(*mesh), name)


def ran(capsys: Capture, *arguments: str) -> tuple[int, str, str]:
    """Run a command in this process; return exit code, standard output and standard error."""
    code = run(arguments)
    said = capsys.readouterr()
    assert "Traceback" not in said.out + said.err
    return code, said.out, said.err


def process(*arguments: str | bytes, **settings: Any) -> "subprocess.Popen[bytes]":
    """Start a command in a process of its own; `before` is called there first."""
    path = str(Path(bspcsg.__file__).parent.parent)
    environment = {**os.environ, "PYTHONPATH": path, **settings.pop("more", {})}
    command = [sys.executable, "-m", "bspcsg", *arguments]
    also: Callable[[], None] | None = settings.pop("before", None)

    def heed() -> None:
        # Between fork and exec this sets signals and limits; no lock of another thread is needed.
        heed_interrupts()
        if also is not None:
            also()

    first = heed if os.name == "posix" else None
    return subprocess.Popen(command, env=environment, preexec_fn=first, **settings)  # noqa: PLW1509


def heed_interrupts() -> None:
    """Restore the default action of SIGINT, which shells set to "ignore" in the background."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def finished(
    *arguments: str | bytes, given: bytes = b"", **settings: Any
) -> tuple[int, bytes, bytes]:
    """Run a command in a process of its own; return exit code, standard output and error."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    running = process(*arguments, **{**pipes, **settings})
    out, err = running.communicate(given, timeout=60)
    assert b"Traceback" not in (out or b"") + (err or b"")
    return running.returncode, out, err


def script(name: str, *arguments: str) -> "subprocess.CompletedProcess[str]":
    """Run one of the project's scripts with the Python of the tests."""
    root = Path(__file__).resolve().parents[2]
    return subprocess.run(
        [str(root / "scripts" / name), *arguments],
        capture_output=True,
        encoding="utf-8",
        env={**os.environ, "PYTHON": sys.executable},
        timeout=280,
        check=False,
    )
