"""Reading and writing mesh files: STL, OBJ, PLY, OFF, 3MF, GLB, and VTK through meshio.

Coordinates are read and written in double precision where the format has it. A file that is cut off
or contradicts itself is an error that names the file and the line or byte. A file is written
completely or not at all, and only after it was read back and compared with the mesh.
"""

import os
from pathlib import Path
from typing import Any

from .errors import Finding, FormatError, warn_of_losses
from .formats.files import (
    decoded,
    encoded,
    form_of,
    format_of,
    read,
    read_as,
    write,
)
from .formats.raw import RawMesh
from .formats.registry import FORMATS
from .formats.solids import solid_of
from .parameters import file_path, instance_of, shown, text_value, truth_value
from .solid.ledger import counted
from .solid.solid import Solid

#: Suffixes of scripts, which `load` evaluates.
SCRIPTS = frozenset({".csg", ".json", ".scad"})

__all__ = [
    "FORMATS",
    "SCRIPTS",
    "RawMesh",
    "decoded",
    "encoded",
    "form_of",
    "format_of",
    "load",
    "loads",
    "read",
    "read_as",
    "save",
    "write",
]


def __dir__() -> list[str]:
    return sorted(__all__)


@counted
def load(path: str | os.PathLike[str], **options: Any) -> Solid:
    """Read a mesh file or a script as a solid; the suffix names the format.

    Parameters
    ----------
    path : str or path
        Ending in one of `FORMATS`, or a script: ``.csg``, ``.json`` or ``.scad`` (see
        `bspcsg.csg.load`).
        3MF and GLB are read in millimetres, all other formats in the unit in which they were
        written. A file that `save` wrote for the empty set is read as the empty set; any other file
        without faces is refused.
    **options
        For meshes as for `Solid`: ``pitch``, ``trusted``, ``winding``, and ``attributes=False`` to
        ignore colours and other attributes; for scripts as for `bspcsg.csg.load`.

    Raises
    ------
    FormatError
        If the file cannot be read in the format of its suffix.
    InvalidMeshError, LimitError
        If the content is not a solid: the message names the file, and the attribute `where` has the
        numbers of the faces.
    """
    if Path(file_path(path)).suffix.lower() in SCRIPTS:
        # Import the modules for scripts only if they are needed.
        from . import csg

        return csg.load(path, **options)
    return solid_of(read(path), path, **options)


@counted
def loads(data: Any, suffix: str | None, **options: Any) -> Solid:
    """Return the solid in the bytes of a mesh file, or in a file that is open for reading bytes.

    Parameters
    ----------
    data : bytes or file
        Companion files with materials and pictures are read only if `data` is a file on disk.
    suffix : str
        The suffix of a format, one of `FORMATS`, with or without its dot.
    **options
        As for `Solid`.

    Raises
    ------
    FormatError
        If no format is given (code "unknown_format"), or the data cannot be read in that format.
    """
    named = f".{text_value('' if suffix is None else suffix, 'suffix').lower().removeprefix('.')}"
    if named not in FORMATS:
        known = ", ".join(name[1:] for name in sorted(FORMATS))
        message = (
            f"To read bytes, suffix must name their format, one of {known}, not {shown(suffix)}."
        )
        raise FormatError(message, "unknown_format")
    content = data.read() if hasattr(data, "read") else data
    if isinstance(content, (bytearray, memoryview)):
        content = bytes(content)
    if not isinstance(content, bytes):
        raise FormatError(
            "The file gives text instead of bytes; open it in binary mode, with open(path, 'rb').",
            "unreadable",
        )
    name = getattr(data, "name", None)
    called = name if isinstance(name, str) else "<bytes>"
    files: dict[str, bytes] | None = None if _is_on_disk(data) else {}
    return solid_of(decoded(called, content, named, files), called, **options)


def _is_on_disk(data: Any) -> bool:
    """Say whether an object is an open file on disk, not bytes or a member of an archive."""
    try:
        data.fileno()
    except (AttributeError, OSError):
        return False
    return True


def save(solid: Solid, path: str | os.PathLike[str], *, text: bool = False) -> tuple[Finding, ...]:
    """Write the reduced boundary of a solid; the suffix names the format.

    Parameters
    ----------
    solid : Solid
    path : str or path
        Ending in one of `FORMATS`, or in ``.csg`` for the expression (see `bspcsg.csg.dump`).
        Binary STL and GLB have single precision; for 3MF and GLB, coordinates are millimetres.
    text : bool
        Write STL and PLY as text; OBJ and OFF always are.

    Returns
    -------
    tuple of Finding
        Findings about everything that the format could not store.

    Raises
    ------
    FormatError
        If the format is unknown or cannot store the coordinates, or the file cannot be written;
        code ``"write_mismatch"`` if the file reads back as another mesh.
    UnboundedError
        If the solid reaches to infinity.

    Warns
    -----
    LossWarning
        If the format cannot store an attribute, or stores a colour only in part.
    """
    is_text = truth_value(text, "text")
    own = instance_of(Solid, solid, "solid")
    if Path(file_path(path)).suffix.lower() == ".csg":
        from . import csg
        from .csg.from_solid import lost_attributes

        csg.dump(own, path)
        findings = lost_attributes([own])
    else:
        form_of(path, is_text)
        findings = write(own.normalized().to_mesh(), path, text=is_text)
    warn_of_losses(findings)
    return findings
