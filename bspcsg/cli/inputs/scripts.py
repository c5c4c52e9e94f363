"""Evaluation of scripts that are given as inputs in place of meshes."""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ..console import status_line
from ..console.output import Output

if TYPE_CHECKING:
    from ...solid.solid import Solid

#: Suffixes of scripts: OpenSCAD's tree, its JSON form, OpenSCAD's language, and Python.
SUFFIXES = (".csg", ".json", ".scad", ".py")

#: Suffixes of scripts that standard input can be; scripts in OpenSCAD and Python are run by name.
STREAMED = (".csg", ".json")


def solid_of_script(
    path: Path, out: Output, text: str | None = None, suffix: str | None = None, **options: Any
) -> "Solid":
    """Return the solid that a script makes; print warnings about parts of it that are ignored.

    Parameters
    ----------
    path : Path
    out : Output
    text : str, optional
        The text of the script; if absent, it is read from the file.
    suffix : str, optional
        The suffix of the script's language; if absent, that of `path`.
    **options
        As for `run_script` or `csg.load`.
    """
    if (suffix or path.suffix.lower()) == ".py":
        from ...script.run import run_script

        # End the status line, since the script may print to the terminal.
        status_line.end()
        return run_script(path, **options)
    from ... import csg

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", csg.CsgWarning)
        try:
            if text is None:
                return csg.load(path, **options)
            form: Literal["csg", "json"] = "json" if suffix == ".json" else "csg"
            return csg.loads(text, name=str(path), form=form, **options)
        finally:
            # Print warnings even after an error: ignored parts may be its cause.
            for said in caught:
                out.warning(str(said.message))
