"""Making a solid of the mesh that was read from a file."""

import os
from typing import Any

from ..errors import BspcsgError
from ..solid.solid import Solid, solid_with
from .raw import RawMesh


def solid_of(
    raw: RawMesh, path: str | os.PathLike[str], *, attributes: bool = True, **options: Any
) -> Solid:
    """Return the solid that the mesh of a file encloses; errors name the file.

    If `save` wrote the file for the empty set, it is the empty set. Any other file without faces
    is an error, since its content may have been lost.
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
