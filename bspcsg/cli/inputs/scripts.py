"""Scripts as inputs in place of meshes: they are evaluated first."""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from ..console import status
from ..console.output import Output

if TYPE_CHECKING:
    from ...solid.solid import Solid

#: OpenSCAD's tree and its JSON form, its language, and Python.
SUFFIXES = (".csg", ".json", ".scad", ".py")

#: Those that may come from standard input; the others are run by programs that read files.
STREAMED = (".csg", ".json")


def made_by(
    path: Path, out: Output, text: str | None = None, suffix: str | None = None, **options: Any
) -> "Solid":
    """Return the solid that a script makes, and print what was left out.

    Parameters
    ----------
    path : Path
    out : Output
    text : str, optional
        The text of the script, if it has been read.
    suffix : str, optional
        The suffix of its language, if its name has another.
    **options
        As for `run_script` or `csg.load`.
    """
    if (suffix or path.suffix.lower()) == ".py":
        from ...script.run import run_script

        # The script's own output gets the terminal.
        status.end()
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
            # The things left out may be the reason why the script fails.
            for said in caught:
                out.warning(str(said.message))
