"""Reading of OpenSCAD's own language by means of the program openscad."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ..errors import FormatError, invalid_parameter, unreadable
from ..parameters import file_path, seconds, shown, values_by_name
from ..processes import run_program
from .syntax.arguments import is_number
from .syntax.intermediate import Intermediate
from .syntax.parser import parse
from .syntax.tree import CsgTree, Value
from .syntax.writer import value_text

#: The default time limit of a conversion, in seconds.
TIMEOUT = 300.0


def read_scad(
    path: str | os.PathLike[str],
    *,
    defines: Mapping[str, Value] | None = None,
    timeout: float | None = TIMEOUT,
) -> CsgTree:
    """Return the tree of a `.scad` file, which openscad evaluates to a `.csg` file.

    Parameters
    ----------
    path : path
    defines : mapping of str to value, optional
        Values of the script's variables, as ``openscad -D name=value`` sets them.
    timeout : float, optional
        The time limit in seconds, up to a million; None or infinity for no limit.

    Raises
    ------
    FormatError
        If openscad is not on the PATH (code "missing_program"), takes too long ("timeout") or
        refuses the file ("refused"); the message ends with its output. Errors in the `.csg` text
        that openscad writes quote a line of that text, and name the script's line if it is
        unique.
    """
    name, limit = file_path(path), seconds(timeout, "timeout")
    values = values_by_name(defines, "defines")
    _refuse_no_values(tuple(values.values()))
    if not os.path.isfile(name):
        raise unreadable(name)
    with tempfile.TemporaryDirectory(prefix="bspcsg-") as folder:
        output = Path(folder, "model.csg")
        _convert(Path(name), output, values, limit)
        text = output.read_text(encoding="utf-8")
    made = Intermediate(name, Path(name).read_text(encoding="utf-8", errors="replace"), text)
    try:
        tree = parse(text, made.name, Path(name).parent)
    except FormatError as error:
        explained = made.explained(error)
        if explained is error:
            raise
        raise explained from error
    return replace(tree, name=name, intermediate=made)


def _convert(path: Path, output: Path, values: dict[str, Any], timeout: float | None) -> None:
    program = shutil.which("openscad")
    if program is None:
        message = (
            f"{path}: reading .scad files needs the program openscad, which is not on the"
            " PATH. Install it (apt install openscad), or give a .csg file."
        )
        raise FormatError(message, "missing_program")
    options = [f"-D{name}={value_text(value)}" for name, value in values.items()]
    # With --render, the variable $preview of a script is false.
    command = [program, "--render", "-o", str(output), *options, "--", str(path.absolute())]
    try:
        done = run_program(command, timeout, {**os.environ, "QT_QPA_PLATFORM": "offscreen"})
    except subprocess.TimeoutExpired as error:
        message = (
            f"{path}: openscad took longer than the time limit of {timeout:g} seconds and was"
            " stopped; raise the limit, or simplify the script."
        )
        raise FormatError(message, "timeout") from error
    if done.returncode != 0 or not output.is_file():
        raise FormatError(
            f"{path}: openscad cannot evaluate the script: {_complaint(done.stderr)}", "refused"
        )


def _refuse_no_values(found: tuple[Any, ...]) -> None:
    """Raise `InvalidParameterError` for values that variables of a script cannot have."""
    for one in found:
        if isinstance(one, tuple):
            _refuse_no_values(one)
        elif not (one is None or isinstance(one, (str, bool)) or is_number(one)):
            message = (
                "The values of defines must be numbers, strings, bools, None or tuples of"
                f" these, not {shown(one)}."
            )
            raise invalid_parameter(message)


def _complaint(text: str) -> str:
    """Return the last line of openscad's output that contains "ERROR", or else the last line."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    errors = [line for line in lines if "ERROR" in line.upper()]
    return (errors or lines or ["it printed no message"])[-1]
