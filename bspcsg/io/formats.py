"""Which suffix stands for which format, and reading and writing by it."""

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np

from ..errors import Finding, FormatError, format_errors
from ..mesh import Mesh
from . import glb, obj, off, ply, stl, threemf, threemf_write, vtk
from .atomic import write_file
from .raw import RawMesh
from .source import Source, content_of

Encoder: TypeAlias = Callable[[Mesh | RawMesh], Iterator[bytes]]
Losses: TypeAlias = Callable[[Mesh | RawMesh], tuple[Finding, ...]]


@dataclass(frozen=True)
class Format:
    """How one format is read and written; one of the written forms may be missing.

    Parameters
    ----------
    read : callable
    text, binary : callable, optional
    losses : callable, optional
        What the binary form cannot keep; raises OverflowError if it cannot hold the numbers.
    unit : str
        ``"mm"`` if files say how long a unit is, and are read and written in millimetres.
    up : {"z", "y"}
        Which axis is up in files; meshes in memory have z up.
    """

    read: Callable[[Source], RawMesh]
    text: Encoder | None = None
    binary: Encoder | None = None
    losses: Losses | None = None
    unit: str = ""
    up: str = "z"


FORMATS = {
    ".stl": Format(stl.read, stl.text, stl.binary, stl.losses),
    ".obj": Format(obj.read, obj.text),
    ".ply": Format(ply.read, ply.text, ply.binary),
    ".off": Format(off.read, off.text),
    ".3mf": Format(threemf.read, None, threemf_write.binary, threemf_write.losses, "mm"),
    ".glb": Format(glb.read, None, glb.binary, glb.losses, "mm", "y"),
    ".vtk": Format(vtk.reader(".vtk"), None, vtk.writer(".vtk")),
    ".vtu": Format(vtk.reader(".vtu"), None, vtk.writer(".vtu")),
}

_BREP = (
    "{} is a format of curved surfaces, and bspcsg reads meshes only. Make a mesh of it first, for"
    " example with FreeCAD, Gmsh or the Python package cascadio."
)
_NO_LIBRARY = "{} is not read, for want of a well-kept library; have {} written instead."

#: What to say of formats that people try, and that are not for us.
_REFUSALS = {
    **dict.fromkeys((".step", ".stp"), _BREP.format("STEP")),
    **dict.fromkeys((".iges", ".igs"), _BREP.format("IGES")),
    ".brep": _BREP.format("BREP"),
    ".amf": _NO_LIBRARY.format("AMF", "3MF"),
    ".vtp": "VTP is read by VTK's own package only, of some hundred megabytes, which is left out"
    " here; have VTU written instead, or pass what pyvista read to Solid.from_mesh.",
    ".gltf": "glTF with separate files is not read; pack it into one GLB file.",
}


def format_of(path: str | os.PathLike[str]) -> Format:
    """Return the format that the suffix names.

    Raises
    ------
    FormatError
        If it names none; code ``"unknown_format"``.
    """
    suffix = Path(path).suffix.lower()
    if suffix in FORMATS:
        return FORMATS[suffix]
    known = ", ".join(sorted(FORMATS))
    message = f"“{suffix}” is no known mesh format; known are {known}."
    if not suffix:
        message = f"the name needs a suffix that says the format: {known}."
    raise FormatError(f"{os.fspath(path)}: {_REFUSALS.get(suffix, message)}", "unknown_format")


def encoder_of(path: str | os.PathLike[str], text: bool = False) -> Encoder:
    """Return what writes the format that the suffix names.

    Raises
    ------
    FormatError
        If the format is unknown or has no form as text; code ``"unknown_format"``.
    """
    chosen = format_of(path)
    encoder = chosen.text if text else chosen.binary or chosen.text
    if encoder is None:
        textual = ", ".join(sorted(suffix for suffix, one in FORMATS.items() if one.text))
        message = f"{os.fspath(path)}: this format is never text; text can be {textual}."
        raise FormatError(message, "unknown_format")
    return encoder


def read(path: str | os.PathLike[str]) -> RawMesh:
    """Read a mesh file as it is; the suffix names the format.

    Several objects in one file become one mesh, in the order of the file. Polygons become
    triangles. STL corners are joined where their coordinates are equal, exactly; nothing else is
    joined, dropped or repaired.

    Parameters
    ----------
    path : str or path
        Ending in one of `FORMATS`.

    Raises
    ------
    FormatError
        If the file cannot be opened, is empty or cut off, is not of its format, or holds numbers
        that are not finite or vertex numbers out of range. The message names file and line (or
        byte), `where` holds that number.
    MissingPartError
        If the format needs a library that is not installed.
    """
    return read_as(path, Path(path).suffix)


def read_as(path: str | os.PathLike[str], suffix: str) -> RawMesh:
    """Read a mesh file as what a suffix names, whatever its own suffix; else as `read`."""
    name = os.fspath(path)
    if suffix.lower() not in FORMATS:
        format_of(name)
    try:
        data = content_of(Path(path))
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise FormatError(f"{name}: cannot read this file: {reason}.", "unreadable") from error
    return decoded(name, data, suffix)


def decoded(name: str, data: bytes, suffix: str) -> RawMesh:
    """Return the mesh in the bytes of a file; `name` is for errors, the rest as for `read`."""
    if not data:
        raise FormatError(f"{name}: the file is empty.", "empty_file")
    with format_errors(name, suffix.removeprefix(".").upper()):
        raw = FORMATS[suffix.lower()].read(Source(name, data))
    return replace(raw, name=raw.name or Path(name).stem)


def write(
    mesh: Mesh | RawMesh, path: str | os.PathLike[str], *, text: bool = False
) -> tuple[Finding, ...]:
    """Write a mesh; the suffix names the format.

    The file appears complete or not at all. Every format but binary STL and GLB keeps each
    coordinate's double; what single precision changes is returned as findings.

    Parameters
    ----------
    mesh : object
        With ``vertices`` (n, 3) float64 and ``faces`` (m, 3) int64.
    path : str or path
        Ending in one of `FORMATS`.
    text : bool
        Write STL and PLY as text; OBJ and OFF always are.

    Raises
    ------
    FormatError
        If the format is unknown, cannot hold the coordinates, or the file cannot be written.
    MissingPartError
        If the format needs a library that is not installed.
    """
    chunks, findings = encoded(mesh, path, Path(path).suffix, text)
    write_file(path, chunks)
    return findings


def encoded(
    mesh: Mesh | RawMesh, path: str | os.PathLike[str], suffix: str, text: bool = False
) -> tuple[Iterator[bytes], tuple[Finding, ...]]:
    """Return the bytes of a file and what the format could not keep, as for `write`."""
    name = os.fspath(path)
    encoder = encoder_of(f"mesh{suffix}", text)
    chosen = FORMATS[suffix.lower()]
    if len(mesh.vertices) > np.iinfo(np.int32).max and encoder is ply.binary:
        raise FormatError(f"{name}: too many vertices for PLY; write OBJ.", "too_large")
    if chosen.losses is None or encoder is not chosen.binary:
        return encoder(mesh), ()
    try:
        return encoder(mesh), chosen.losses(mesh)
    except OverflowError:
        message = f"{name}: coordinates are beyond single precision; write PLY, OBJ, OFF or 3MF."
        raise FormatError(message, "too_large") from None
