"""Reading and writing STL, binary and ASCII; corners with equal coordinates become one vertex.

The binary form has single precision. The length of a file decides whether it is binary, not its
first word: binary files may begin with "solid", too.
"""

import re
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace

import numpy as np

from .._types import FloatArray
from ..attributes.attributes import Values
from ..errors import Finding, FormatError
from ..mesh.mesh import Mesh
from ..mesh.weld import welded
from . import single_precision
from .blocks import blocks
from .raw import EMPTY_SET, RawMesh, on_one_line, parts_of, represents_empty_set
from .source import Source, as_text, quoted

_HEADER = 84
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

#: The mark in a binary STL's header before the colour of the whole mesh.
_COLOR = b"COLOR="

#: The first word of each line of one facet.
_FACET = (b"facet", b"outer", b"vertex", b"vertex", b"vertex", b"endloop", b"endfacet")


#: Patterns for texts with other line breaks: an end keyword, which may be written as two words, and
#: the blank before a keyword that should begin a line.
_ENDS = re.compile(rb"(?i)(?<!\S)end(?:_|\s+)(solid|loop|facet)(?!\S)")
_STATEMENTS = re.compile(rb"(?i) (?=(?:(?:end)?(?:solid|facet)|outer|vertex|endloop)(?: |$))")


def read(source: Source) -> RawMesh:
    """Read a binary or an ASCII STL file.

    Raises
    ------
    FormatError
        If the file is cut off, is no STL, or has coordinates that are not finite.
    """
    data = source.data
    if len(data) >= _HEADER and len(data) == _HEADER + _RECORD.itemsize * _promised(data):
        return _read_binary(source)
    text = source.without_mark()
    if text.data.lstrip()[:5].lower() != b"solid" or b"\0" in text.data[:1024]:
        return _read_binary(source)
    try:
        return _read_text(text)
    except FormatError as error:
        if error.code not in ("syntax", "truncated"):
            raise
        # If no other division into lines helps, raise the error with the file's own line numbers.
        joined = _ENDS.sub(rb"end\1", text.data)
        for data in (joined, _STATEMENTS.sub(b"\n", b" ".join(joined.split()))):
            with suppress(FormatError):
                return _read_text(replace(text, data=data))
        raise


def _promised(data: bytes) -> int:
    return int.from_bytes(data[_HEADER - 4 : _HEADER], "little")


def _read_binary(source: Source) -> RawMesh:
    data = source.data
    if len(data) < _HEADER:
        message = (
            f"the file is not an STL mesh: a binary STL has at least {_HEADER} bytes, not"
            f" {len(data)}."
        )
        raise source.error(message, "truncated", offset=len(data))
    count, held = _promised(data), (len(data) - _HEADER) // _RECORD.itemsize
    if count > held:
        message = (
            f"the file is incomplete: it ends in triangle {held}, but its header says {count}"
            " triangles."
        )
        raise source.error(message, "truncated", offset=len(data))
    if count == 0 and held:
        message = f"the header says 0 triangles, but data for {held} triangles follow."
        raise source.error(message, offset=_HEADER)
    records = np.frombuffer(data, _RECORD, count, _HEADER)
    extra = len(data) - _HEADER - count * _RECORD.itemsize
    starts = _starts_by_lengths(data, records["attribute"]) if extra else None
    if starts is not None:
        rows = b"".join(data[start : start + _RECORD.itemsize] for start in starts)
        records, extra = np.frombuffer(rows, _RECORD), 0
    with np.errstate(invalid="ignore"):  # NaN, which the next line rejects
        corners = records["corners"].reshape(-1, 3).astype(np.float64)
    _check_finite(source, corners, starts)
    title, mark, _ = data[: _HEADER - 4].partition(_COLOR)
    name = title.split(b"\0")[0].strip().decode("latin-1")
    is_coloured = bool(mark) or (starts is None and bool(records["attribute"].any()))
    dropped = ("colours",) * is_coloured + ("attribute bytes",) * (starts is not None)
    return replace(_joined(corners, name, _extra_bytes(extra)), dropped=dropped)


def _starts_by_lengths(data: bytes, attributes: Values) -> list[int] | None:
    """Return the byte offset of each triangle if the attribute field is a length, else None.

    By the format's rule, a triangle states the number of attribute bytes that follow it. Programs
    usually store a colour in that field, and no bytes follow. The field counts as a length only if
    the triangles then fill the file exactly.
    """
    named = np.flatnonzero(attributes)
    if not len(named):
        return None
    # Both interpretations agree up to the first triangle whose field is not 0.
    starts = [_HEADER + _RECORD.itemsize * k for k in range(int(named[0]))]
    at = _HEADER + _RECORD.itemsize * len(starts)
    while len(starts) < len(attributes) and at + _RECORD.itemsize <= len(data):
        starts.append(at)
        at += _RECORD.itemsize
        at += int.from_bytes(data[at - 2 : at], "little")
    return starts if len(starts) == len(attributes) and at == len(data) else None


def _check_finite(source: Source, corners: FloatArray, starts: list[int] | None) -> None:
    finite = np.isfinite(corners)
    if not finite.all():
        triangle = int(np.flatnonzero(~finite)[0]) // 9
        offset = _HEADER + triangle * _RECORD.itemsize if starts is None else starts[triangle]
        message = f"triangle {triangle} has a coordinate that is not a finite number."
        raise source.error(message, "non_finite", offset=offset)


def _extra_bytes(count: int) -> tuple[Finding, ...]:
    if not count:
        return ()
    message = f"{count} bytes after the last triangle were ignored."
    return (Finding("extra_data", "warning", message, (), count),)


def _read_text(source: Source) -> RawMesh:
    rows: list[list[bytes]] = []
    lines: list[int] = []
    solids: list[tuple[bytes, int]] = []
    inside, step, number = False, 0, 0
    for number, words in source.text_lines():
        key = words[0].lower()
        if step == 0 and key == (b"endsolid" if inside else b"solid"):
            inside = not inside
            if inside:
                solids.append((b" ".join(words[1:]), len(rows)))
            continue
        if not inside or key != _FACET[step]:
            expected = _FACET[step] if inside else b"solid"
            message = f"expected “{expected.decode()}”, found {quoted(words[0])}."
            raise source.error(message, line=number)
        if key == b"vertex":
            rows.append(words[1:4])
            lines.append(number)
        step = (step + 1) % len(_FACET)
    if inside:
        missing = _FACET[step].decode() if step else "endsolid"
        raise source.error(
            f"the file is incomplete: it ends where “{missing}” must follow.",
            "truncated",
            line=number,
        )
    raw = _joined(source.coordinates(rows, lines), "", ())
    ends = [*(first for _, first in solids[1:]), len(rows)]
    names = [as_text(name) for name, _ in solids]
    starts = [first for _, first in solids]
    objects = [(n, (end - start) // 3) for n, start, end in zip(names, starts, ends, strict=True)]
    title = next(filter(None, names), "")
    return replace(raw, name=title, objects=tuple(objects) if len(objects) > 1 else ())


def _joined(corners: FloatArray, name: str, findings: tuple[Finding, ...]) -> RawMesh:
    vertices, indices = welded(corners)
    return RawMesh(vertices, indices.reshape(-1, 3), name, findings)


def binary(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the bytes of a binary STL; coordinates are rounded to single precision."""
    title = EMPTY_SET.strip(b"# \n") if represents_empty_set(mesh) else b"bspcsg"
    header = title.ljust(_HEADER - 4, b" ")
    yield header + len(mesh.faces).to_bytes(4, "little")
    rounded = mesh.vertices.astype(np.float32)
    for block in blocks(len(mesh.faces)):
        faces = mesh.faces[block]
        records = np.zeros(len(faces), _RECORD)
        records["corners"] = rounded[faces]
        records["normal"] = _normals(mesh.vertices[faces])
        yield records.tobytes()


def stored_name(name: str) -> str:
    """Return the name of a solid on one line; a solid without a name is called "bspcsg"."""
    return on_one_line(name) or "bspcsg"


def text(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the bytes of an ASCII STL, a solid for each object; doubles read back unchanged."""
    for name, faces in parts_of(mesh) or [("", mesh.faces)]:
        title = stored_name(name)
        yield f"solid {title}\n".encode()
        for block in blocks(len(faces)):
            yield from _facets(mesh.vertices[faces[block]])
        yield f"endsolid {title}\n".encode()


def _facets(corners: FloatArray) -> Iterator[bytes]:
    for normal, triangle in zip(_normals(corners).tolist(), corners.tolist(), strict=True):
        yield (
            "facet normal {} {} {}\n outer loop\n".format(*normal)
            + "".join("  vertex {!r} {!r} {!r}\n".format(*corner) for corner in triangle)
            + " endloop\nendfacet\n"
        ).encode()


def losses(mesh: Mesh | RawMesh) -> tuple[Finding, ...]:
    """Return findings about what single precision, in which binary STL is, changes in a mesh.

    Raises
    ------
    OverflowError
        If a coordinate is beyond single precision.
    """
    return single_precision.losses(mesh, "binary STL")


def _normals(corners: FloatArray) -> FloatArray:
    """Return the unit normals of triangles (m, 3, 3), zero for a triangle without area."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    with np.errstate(over="ignore", invalid="ignore"):
        normals = np.cross(b - a, c - a)
        lengths = np.linalg.norm(normals, axis=1)[:, None]
        is_usual = (lengths > 0) & np.isfinite(lengths)
    units: FloatArray = np.divide(normals, lengths, np.zeros_like(normals), where=is_usual)
    return units
