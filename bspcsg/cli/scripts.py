"""Scripts where meshes are asked for: what they make is the input."""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .output import Output

if TYPE_CHECKING:
    from ..solid.solid import Solid

#: OpenSCAD's tree and its JSON form, its language, and Python.
SUFFIXES = (".csg", ".json", ".scad", ".py")


def is_script(path: Path) -> bool:
    """Return whether a file's suffix is that of a script."""
    return path.suffix.lower() in SUFFIXES


def made_by(path: Path, out: Output, text: str | None = None, **options: Any) -> "Solid":
    """Return the solid that a script makes; what was left out is told.

    Parameters
    ----------
    path : Path
    out : Output
    text : str, optional
        The script, if it was read already.
    **options
        As for `run_script` or `csg.load`.
    """
    if path.suffix.lower() == ".py":
        from ..script.run import run_script

        return run_script(path, **options)
    from .. import csg

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", csg.CsgWarning)
        if text is None:
            solid = csg.load(path, **options)
        else:
            solid = csg.loads(text, name=str(path), **options)
    # A polished model is evaluated twice, and warns as often.
    for said in dict.fromkeys(str(warning.message) for warning in caught):
        out.warning(said)
    return solid
