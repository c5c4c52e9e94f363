"""Solids of mesh files."""

import os
from typing import Any

from ..errors import BspcsgError
from ..solid.solid import Solid, solid_with
from .raw import RawMesh


def solid_of(
    raw: RawMesh, path: str | os.PathLike[str], *, attributes: bool = True, **options: Any
) -> Solid:
    """Return the solid of the mesh of a file; errors name the file.

    A file that `save` wrote of the empty set gives the empty set. Any other file without faces is
    refused, since its content may have been lost.
    """
    if raw.is_empty_set:
        return Solid.empty()
    try:
        said = raw.attributes if attributes else None
        solid = solid_with(raw.vertices, raw.faces, said, **options)
        return solid.normalized() if raw.is_mended else solid
    except BspcsgError as error:
        # The file has only data that the reader skips, so no faces are left.
        reasons = raw.passed_by if len(raw.faces) == 0 else ()
        message = " ".join([f"{os.fspath(path)}: {error.message}", *reasons])
        raise type(error)(message, error.code, error.where) from error
