"""OpenSCAD's own language, through the program openscad."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from ..errors import FormatError
from .syntax.intermediate import Intermediate
from .syntax.parser import parse
from .syntax.tree import CsgTree, Value
from .syntax.writer import value_text

#: Longest time for a conversion, in seconds.
TIMEOUT = 300.0


def read_scad(
    path: Path, *, defines: Mapping[str, Value] | None = None, timeout: float = TIMEOUT
) -> CsgTree:
    """Return the tree of a `.scad` file, which openscad evaluates to a `.csg` file.

    Parameters
    ----------
    path : Path
    defines : mapping of str to value, optional
        Variables of the script, as ``openscad -D name=value`` sets them.
    timeout : float
        In seconds.

    Raises
    ------
    FormatError
        If openscad is not on the PATH (code "missing_program"), takes too long ("timeout") or
        refuses the file; the message ends in what it said. Errors in what it made of the file
        quote the line of that, and name the script's own where only one can be meant.
    """
    name = os.fspath(path)
    if not path.is_file():
        raise FormatError(f"{name}: cannot read this file: no such file.", "unreadable")
    with tempfile.TemporaryDirectory(prefix="bspcsg-") as folder:
        output = Path(folder, "model.csg")
        _convert(path, output, defines or {}, timeout)
        text = output.read_text(encoding="utf-8")
    made = Intermediate(name, path.read_text(encoding="utf-8", errors="replace"), text)
    try:
        tree = parse(text, made.name, path.parent)
    except FormatError as error:
        raise made.explained(error) from error
    return replace(tree, name=name, intermediate=made)


def _convert(path: Path, output: Path, defines: Mapping[str, Value], timeout: float) -> None:
    program = shutil.which("openscad")
    if program is None:
        message = (
            f"{path}: OpenSCAD's language needs the program openscad, which is not on the PATH."
            " Install it (apt install openscad), or give a .csg file."
        )
        raise FormatError(message, "missing_program")
    options = [f"-D{name}={value_text(value)}" for name, value in defines.items()]
    # A shape to be kept is no preview, which scripts can ask for.
    command = [program, "--render", "-o", str(output), *options, "--", str(path.absolute())]
    try:
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            env={**os.environ, "QT_QPA_PLATFORM": "offscreen"},
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        message = f"{path}: openscad took longer than {timeout:g} seconds."
        raise FormatError(message, "timeout") from error
    if done.returncode != 0 or not output.is_file():
        raise FormatError(f"{path}: openscad refused it: {_complaint(done.stderr)}", "refused")


def _complaint(text: str) -> str:
    """Return the line of openscad's output that says what is wrong."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    errors = [line for line in lines if "ERROR" in line.upper()]
    return (errors or lines or ["it said nothing"])[-1]
