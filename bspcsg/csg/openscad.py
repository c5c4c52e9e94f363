"""OpenSCAD's own language, through the program openscad."""

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

#: Longest time for a conversion, in seconds.
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
        Variables of the script, as ``openscad -D name=value`` sets them.
    timeout : float, optional
        In seconds, up to a million; None and infinity wait forever.

    Raises
    ------
    FormatError
        If openscad is not on the PATH (code "missing_program"), takes too long ("timeout") or
        refuses the file; the message ends in its output. Errors in the `.csg` text that it made
        quote a line of that text, and name the script's line if only one can be meant.
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
    # Scripts can ask whether they are previewed; here they are not.
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
    """Raise `InvalidParameterError` for values that no variable of a script can have."""
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
    """Return the line of openscad's output that describes the error."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    errors = [line for line in lines if "ERROR" in line.upper()]
    return (errors or lines or ["it printed no message"])[-1]
