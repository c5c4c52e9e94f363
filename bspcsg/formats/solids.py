"""Solids of what mesh files hold."""

import os
from typing import Any

from ..errors import BspcsgError
from ..solid.solid import Solid, solid_with
from .raw import RawMesh


def solid_of(
    raw: RawMesh, path: str | os.PathLike[str], *, attributes: bool = True, **options: Any
) -> Solid:
    """Return the solid of what was read from a file; errors name the file.

    A file that `save` wrote of the empty set is the empty set again; any other without faces is
    refused, as what should be in it may have got lost.
    """
    if raw.is_empty_set:
        return Solid.empty()
    try:
        said = raw.attributes if attributes else None
        solid = solid_with(raw.vertices, raw.faces, said, **options)
        return solid.normalized() if raw.is_mended else solid
    except BspcsgError as error:
        # A file of nothing but what is passed by: that is why nothing is left.
        reasons = raw.passed_by if len(raw.faces) == 0 else ()
        message = " ".join([f"{os.fspath(path)}: {error.message}", *reasons])
        raise type(error)(message, error.code, error.where) from error
