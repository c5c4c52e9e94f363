"""Reading and writing mesh files; the suffix of the file's name chooses the format."""

import itertools
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..errors import Finding, FormatError, format_errors, invalid_parameter
from ..mesh.mesh import Mesh
from ..parameters import file_path, instance_of, shown, text_value, truth_value
from . import single_precision
from .atomic import refuse_target, write_file
from .raw import RawMesh, empty_set, represents_empty_set
from .registry import FORMATS, Form, Format
from .source import Source, refuse_pointer_file, whole_content
from .storable_attributes import attribute_losses, attributes_or_none, with_attributes
from .verification import verify, verify_with_attributes

_BREP = (
    "{} files contain curved surfaces, and bspcsg reads triangle meshes only. Convert the"
    " file to a mesh first, for example with FreeCAD, Gmsh or the Python package cascadio."
)
_NO_LIBRARY = "{} files cannot be read; export {} instead."

#: Advice, by suffix, on formats that users try to read, but that are not supported.
_REFUSALS = {
    **dict.fromkeys((".step", ".stp"), _BREP.format("STEP")),
    **dict.fromkeys((".iges", ".igs"), _BREP.format("IGES")),
    ".brep": _BREP.format("BREP"),
    ".amf": _NO_LIBRARY.format("AMF", "3MF"),
    ".vtp": "VTP files cannot be read. Export VTU instead, or read the file with pyvista and pass"
    " the mesh to Solid.from_mesh.",
    ".gltf": (
        ".gltf files, whose data are in separate files, cannot be read; pack the model into one"
        " GLB file."
    ),
}

_CURVED = (
    "{} files describe curved surfaces, so meshes cannot be written to them; write 3MF or STL."
)

#: Advice, by suffix, on formats that users try to write, but that are not supported.
_UNWRITTEN = {
    **dict.fromkeys((".step", ".stp"), _CURVED.format("STEP")),
    **dict.fromkeys((".iges", ".igs"), _CURVED.format("IGES")),
    ".brep": _CURVED.format("BREP"),
    ".amf": "AMF files cannot be written; write 3MF, which stores the same data.",
    ".vtp": "VTP files cannot be written; write VTU, which stores the same data.",
    ".gltf": ".gltf files cannot be written; write GLB, which stores the same data in one file.",
}


def format_of(path: str | os.PathLike[str]) -> Format:
    """Return the mesh format that the suffix of a path names.

    Raises
    ------
    FormatError
        If the suffix names no format; code ``"unknown_format"``.
    """
    return _format_of(path, _REFUSALS)


def _format_of(path: str | os.PathLike[str], refusals: Mapping[str, str]) -> Format:
    name = file_path(path)
    suffix = Path(name).suffix.lower()
    if suffix in FORMATS:
        return FORMATS[suffix]
    known = ", ".join(sorted(FORMATS))
    message = f"“{suffix}” is not a known mesh format; known are {known}."
    if not suffix:
        message = f"the file name has no suffix to tell the format; it must end in one of {known}."
    raise FormatError(f"{name}: {refusals.get(suffix, message)}", "unknown_format")


def form_of(path: str | os.PathLike[str], text: bool = False) -> Form:
    """Return the form, text or binary, in which a file with the suffix of `path` is written.

    This is text if `text` is true or the format has no binary form.

    Raises
    ------
    FormatError
        If the format is unknown or has no form as text; code ``"unknown_format"``.
    """
    chosen = _format_of(path, _UNWRITTEN)
    form = chosen.text if truth_value(text, "text") else chosen.binary or chosen.text
    if form is None:
        textual = ", ".join(sorted(suffix for suffix, one in FORMATS.items() if one.text))
        message = (
            f"{os.fspath(path)}: this format has no text form; formats with one are {textual}."
        )
        raise FormatError(message, "unknown_format")
    return form


def read(path: str | os.PathLike[str]) -> RawMesh:
    """Read a mesh file as it is; the suffix names the format.

    Several objects in one file become one mesh, in the order of the file. Polygons become
    triangles. STL corners are joined where their coordinates are exactly equal. Nothing else is
    joined, dropped or repaired, with one exception: where a file transforms meshes and rounding
    would open them, they are mended, and findings count the dropped triangles. A file that equals,
    byte for byte, the file that `write` makes of the empty set is read as the empty set, with the
    finding "empty".

    Parameters
    ----------
    path : str or path
        Ending in one of `FORMATS`.

    Raises
    ------
    FormatError
        If the file cannot be opened, has no bytes or is cut off, is not of its format, or holds
        numbers that are not finite or vertex numbers out of range. The message names the file and
        the line (or byte); the attribute `where` has the number of that line or byte.
    MissingPartError
        If the format needs a library that is not installed.
    """
    return read_as(path, Path(file_path(path)).suffix)


def read_as(path: str | os.PathLike[str], suffix: str) -> RawMesh:
    """Read a mesh file in the format that `suffix` names, not its own suffix; see `read`."""
    name = file_path(path)
    if text_value(suffix, "suffix").lower() not in FORMATS:
        format_of(name)
    return decoded(name, whole_content(path), suffix)


def decoded(
    name: str, data: bytes, suffix: str, files: Mapping[str, bytes] | None = None
) -> RawMesh:
    """Return the mesh that the bytes of a file contain, in the format that `suffix` names.

    Parameters
    ----------
    name : str
        The path of the file, for errors and to find companion files.
    data : bytes
    suffix : str
    files : dict of str to bytes, optional
        The content of companion files by name; if absent, they are read from the disk.

    Raises
    ------
    FormatError
        As for `read`.
    """
    text_value(name, "name")
    instance_of(bytes, data, "data")
    if not (files is None or isinstance(files, Mapping)):
        raise invalid_parameter(
            f"files must be a dictionary from file names to bytes, not {shown(files)}."
        )
    if not data:
        raise FormatError(f"{name}: the file is empty.", "empty_file")
    refuse_pointer_file(name, data)
    chosen = format_of(f"data{text_value(suffix, 'suffix')}")
    if any(form is not None and data == _empty_file(form) for form in (chosen.text, chosen.binary)):
        return replace(empty_set(), name=Path(name).stem, unit=chosen.unit)
    with format_errors(name, suffix.removeprefix(".").upper()):
        raw = chosen.read(Source(name, data, files))
    return replace(raw, name=raw.name or Path(name).stem)


def _empty_file(form: Form) -> bytes:
    """Return the bytes of the file that represents the empty set in a form."""
    return b"".join(form.encode(empty_set()))


def write(
    mesh: Mesh | RawMesh, path: str | os.PathLike[str], *, text: bool = False
) -> tuple[Finding, ...]:
    """Write a mesh; the suffix names the format.

    The file appears complete or not at all: it is written under a temporary name and read back, and
    every corner of every triangle of every object is compared with the mesh before the file is
    renamed. Companion files, such as the materials of an OBJ, are written just before the renaming.
    Binary STL and GLB round coordinates to single precision, and the returned findings list what
    this changes; all other formats store each coordinate as the same double.

    Parameters
    ----------
    mesh : Mesh or RawMesh
    path : str or path
        Ending in one of `FORMATS`.
    text : bool
        Write STL and PLY as text; OBJ and OFF always are.

    Raises
    ------
    FormatError
        If the format is unknown, cannot hold the coordinates, or the file cannot be written; code
        ``"write_mismatch"`` if what was written reads back as another mesh, ``"empty"`` if there
        are no vertices for an OBJ.
    MissingPartError
        If the format needs a library that is not installed.
    """
    made = encoded(mesh, path, Path(file_path(path)).suffix, text)

    def prove(file: BinaryIO) -> None:
        made.prove(file)
        write_companions(path, made.files)

    write_file(path, made.chunks, prove)
    return made.findings


@dataclass(frozen=True, eq=False)
class Encoded:
    """The content of a file that is to be written, and the function that checks the written file.

    Parameters
    ----------
    chunks : iterator of bytes
    findings : tuple of Finding
        Findings about data that the format cannot store.
    prove : callable
        Takes the written file, and raises FormatError if its content differs from the mesh.
    files : dict of str to bytes
        The companion files by name: materials and pictures.
    """

    chunks: Iterator[bytes]
    findings: tuple[Finding, ...]
    prove: Callable[[BinaryIO], None]
    files: Mapping[str, bytes] = field(default_factory=dict)


def companion_paths(path: str | os.PathLike[str], files: Mapping[str, bytes]) -> dict[Path, bytes]:
    """Return the content of companion files by path, in the folder of `path`.

    If `path` is a link, this is the folder of the link's target.
    """
    folder = Path(path).parent
    if os.path.islink(path):
        folder = Path(os.path.realpath(path)).parent
    return {folder / name: data for name, data in files.items()}


def write_companions(path: str | os.PathLike[str], files: Mapping[str, bytes]) -> None:
    """Write companion files, given as content by name, into the folder of the file `path`."""
    places = companion_paths(path, files)
    for place in places:
        refuse_target(place)
    for place, data in places.items():
        write_file(place, [data])


def encoded(
    mesh: Mesh | RawMesh, path: str | os.PathLike[str], suffix: str, text: bool = False
) -> Encoded:
    """Return the bytes that `write` writes for a mesh, the findings, and the check of the file."""
    name = file_path(path)
    form = form_of(f"mesh{text_value(suffix, 'suffix')}", text)
    if not isinstance(mesh, (Mesh, RawMesh)):
        raise invalid_parameter(f"mesh must be a Mesh or a RawMesh, not {shown(mesh)}.")
    _refuse_unwritable(name, mesh, form)
    try:
        findings = form.losses(mesh) if form.losses is not None else ()
        if form.is_single and isinstance(mesh, Mesh):
            mesh, mended = single_precision.in_single_precision(mesh)
            findings = (*findings, *mended)
    except OverflowError:
        message = (
            f"{name}: a coordinate is too large for the single-precision numbers of this format;"
            " write PLY, OBJ, OFF or 3MF instead."
        )
        raise FormatError(message, "too_large") from None
    attributes = attributes_or_none(mesh)
    kept = (
        form.storable(attributes, mesh.vertices)
        if attributes is not None and form.storable is not None
        else None
    )
    if attributes is not None:
        findings = (*findings, *attribute_losses(attributes, kept, suffix))
    if kept is None or kept.is_empty:
        bare = mesh if attributes is None else with_attributes(mesh, None)
        proof = partial(verify, name, bare, form.scan, form.name_in_file, form.repeats)
        return Encoded(form.encode(bare), findings, proof)
    full = with_attributes(mesh, kept)
    # If the path is a link, companion files are named after its target.
    stem = Path(os.path.realpath(name)).stem
    head, files = (
        form.companion_files(full, stem) if form.companion_files is not None else (b"", {})
    )
    reader = partial(_read_back, suffix, files)
    proof = partial(verify_with_attributes, name, full, reader, form.name_in_file, form.repeats)
    return Encoded(itertools.chain([head], form.encode(full)), findings, proof, files)


def _read_back(suffix: str, files: Mapping[str, bytes], name: str, data: bytes) -> RawMesh:
    return FORMATS[suffix.lower()].read(Source(name, data, files))


def _refuse_unwritable(name: str, mesh: Mesh | RawMesh, form: Form) -> None:
    """Raise a `FormatError` if a mesh cannot be written in a form.

    It cannot if a coordinate is not finite, a triangle names a missing vertex, the form needs
    vertices and there are none, or the mesh is too large for the form.
    """
    count = len(mesh.vertices)
    if not np.isfinite(mesh.vertices).all():
        raise FormatError(f"{name}: a coordinate is not a finite number.", "non_finite")
    if len(mesh.faces) and not 0 <= mesh.faces.min() <= mesh.faces.max() < count:
        message = f"{name}: a triangle has a vertex index outside 0 to {count - 1}."
        raise FormatError(message, "index_out_of_range")
    if form.needs_vertices and not count and not represents_empty_set(mesh):
        message = (
            f"{name}: the mesh has no vertices, and a file of this format without vertices cannot"
            " be read back."
        )
        raise FormatError(f"{message} Write an empty Solid or Mesh instead.", "empty")
    if form.size_problem is not None and (reason := form.size_problem(mesh)):
        raise FormatError(f"{name}: {reason}", "too_large")
