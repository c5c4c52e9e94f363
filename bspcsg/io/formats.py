"""Which suffix stands for which format, and reading and writing by it."""

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np

from ..errors import Finding, FormatError
from ..mesh import Mesh
from . import obj, off, ply, stl, threemf
from .atomic import write_file
from .raw import RawMesh
from .source import Source

Encoder: TypeAlias = Callable[[Mesh | RawMesh], Iterator[bytes]]


@dataclass(frozen=True)
class Format:
    """How one format is read and written; one of the forms may be missing."""

    read: Callable[[Source], RawMesh]
    text: Encoder | None = None
    binary: Encoder | None = None


FORMATS = {
    ".stl": Format(stl.read, stl.text, stl.binary),
    ".obj": Format(obj.read, obj.text),
    ".ply": Format(ply.read, ply.text, ply.binary),
    ".off": Format(off.read, off.text),
    ".3mf": Format(threemf.read),
}


def format_of(path: str | os.PathLike[str]) -> Format:
    """Return the format that the suffix names.

    Raises
    ------
    FormatError
        If it names none; code ``"unknown_format"``.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in FORMATS:
        known = ", ".join(sorted(FORMATS))
        message = f"{os.fspath(path)}: “{suffix}” is no known mesh format; known are {known}."
        if not suffix:
            message = f"{os.fspath(path)}: the name needs a suffix: {known}."
        raise FormatError(message, "unknown_format")
    return FORMATS[suffix]


def encoder_of(path: str | os.PathLike[str], text: bool = False) -> Encoder:
    """Return what writes the format that the suffix names.

    Raises
    ------
    FormatError
        If the format is unknown or can only be read; code ``"unknown_format"``.
    """
    chosen = format_of(path)
    encoder = chosen.text if text else chosen.binary or chosen.text
    if encoder is None:
        writable = ", ".join(sorted(suffix for suffix, one in FORMATS.items() if one.text))
        message = f"{os.fspath(path)}: this format can only be read; written are {writable}."
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
        Ending in ``.stl``, ``.obj``, ``.ply``, ``.off`` or ``.3mf``.

    Raises
    ------
    FormatError
        If the file cannot be opened, is empty or cut off, is not of its format, or holds numbers
        that are not finite or vertex numbers out of range. The message names file and line (or
        byte), `where` holds that number.
    """
    chosen = format_of(path)
    name = os.fspath(path)
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise FormatError(f"{name}: cannot read this file: {reason}.", "unreadable") from error
    if not data:
        raise FormatError(f"{name}: the file is empty.", "empty_file")
    raw = chosen.read(Source(name, data))
    stem = Path(path).stem
    return RawMesh(raw.vertices, raw.faces, raw.name or stem, raw.findings)


def write(
    mesh: Mesh | RawMesh, path: str | os.PathLike[str], *, text: bool = False
) -> tuple[Finding, ...]:
    """Write a mesh; the suffix names the format.

    The file appears complete or not at all. Every format but binary STL keeps each coordinate's
    double; what single precision changes is returned as findings.

    Parameters
    ----------
    mesh : object
        With ``vertices`` (n, 3) float64 and ``faces`` (m, 3) int64.
    path : str or path
        Ending in ``.stl``, ``.obj``, ``.ply`` or ``.off``.
    text : bool
        Write STL and PLY as text; OBJ and OFF always are.

    Raises
    ------
    FormatError
        If the format is unknown, cannot hold the coordinates, or the file cannot be written.
    """
    encoder = encoder_of(path, text)
    findings: tuple[Finding, ...] = ()
    if encoder is stl.binary:
        findings = _single_precision(mesh, os.fspath(path))
    if len(mesh.vertices) > np.iinfo(np.int32).max and encoder is ply.binary:
        raise FormatError(f"{os.fspath(path)}: too many vertices for PLY; write OBJ.", "too_large")
    write_file(path, encoder(mesh))
    return findings


def _single_precision(mesh: Mesh | RawMesh, name: str) -> tuple[Finding, ...]:
    try:
        return stl.losses(mesh)
    except OverflowError:
        message = f"{name}: coordinates are beyond STL's single precision; write PLY, OBJ or OFF."
        raise FormatError(message, "too_large") from None
