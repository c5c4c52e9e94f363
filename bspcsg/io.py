"""Reading and writing of mesh files: STL, OBJ, PLY, OFF, 3MF, GLB, and VTK through meshio.

Coordinates are read and written in double precision if the format has it. A truncated or
inconsistent file is refused with its name and the line or byte. A file is written completely or not
at all, and only after it was read back and compared with the mesh.
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
from .parameters import file_path, of_kind, shown, text_value, truth_value
from .solid.counting import counted
from .solid.solid import Solid

#: The suffixes of scripts, which `load` evaluates.
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
        The file, whose suffix is one of `FORMATS`, or a script: ``.csg``, ``.json`` or ``.scad``
        (see `bspcsg.csg.load`).
        3MF and GLB are read in millimetres, the other formats in the unit in which they were
        written. A file that `save` wrote for the empty set is read as the empty set; any other file
        without faces is refused.
    **options
        For meshes, the options of `Solid`: ``pitch``, ``trusted``, ``winding``, and
        ``attributes=False`` to ignore colours and other attributes; for scripts, the options of
        `bspcsg.csg.load`.

    Raises
    ------
    FormatError
        If the file cannot be read in the format of its suffix.
    InvalidMeshError, LimitError
        If the content is not a solid. The message names the file, `where` lists the faces.
    """
    if Path(file_path(path)).suffix.lower() in SCRIPTS:
        # Import the evaluator of scripts only if needed, since it imports many modules.
        from . import csg

        return csg.load(path, **options)
    return solid_of(read(path), path, **options)


@counted
def loads(data: Any, suffix: str | None, **options: Any) -> Solid:
    """Read a solid from the bytes of a mesh file, or from a file object open in binary mode.

    Parameters
    ----------
    data : bytes or file
        The contents, or a file. Materials and pictures in other files are read only for a file on
        disk.
    suffix : str
        The format, one of `FORMATS`, with or without its dot.
    **options
        The options of `Solid`.

    Raises
    ------
    FormatError
        If no format is given (code "unknown_format"), or as for `load`.
    """
    named = f".{text_value('' if suffix is None else suffix, 'suffix').lower().removeprefix('.')}"
    if named not in FORMATS:
        known = ", ".join(name[1:] for name in sorted(FORMATS))
        message = f"To read bytes, say their format: one of {known}, not {shown(suffix)}."
        raise FormatError(message, "unknown_format")
    content = data.read() if hasattr(data, "read") else data
    if isinstance(content, (bytearray, memoryview)):
        content = bytes(content)
    if not isinstance(content, bytes):
        raise FormatError("A mesh is read from bytes; open the file with mode 'rb'.", "unreadable")
    name = getattr(data, "name", None)
    called = name if isinstance(name, str) else "<bytes>"
    files: dict[str, bytes] | None = None if _is_on_disk(data) else {}
    return solid_of(decoded(called, content, named, files), called, **options)


def _is_on_disk(data: Any) -> bool:
    """Return True if an object has a file descriptor, unlike members of archives."""
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
        The file, whose suffix is one of `FORMATS`, or ``.csg`` for the expression (see
        `bspcsg.csg.dump`). Binary STL and GLB store single precision; in 3MF and GLB, model units
        are millimetres.
    text : bool
        True to write STL and PLY as text; OBJ and OFF are always text.

    Returns
    -------
    tuple of Finding
        Findings about all data that the format cannot store.

    Raises
    ------
    FormatError
        If the format is unknown or cannot store the coordinates, or the file cannot be written;
        code ``"write_mismatch"`` if reading the file gives a different mesh.
    UnboundedError
        If the solid reaches to infinity.

    Warns
    -----
    LossWarning
        If the format cannot store an attribute, or only a part of a colour.
    """
    is_text = truth_value(text, "text")
    own = of_kind(Solid, solid, "solid")
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
