"""Reading and writing OFF as text; variants have colours, normals or texture coordinates."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import repeat

import numpy as np

from ..attributes.attributes import Attributes, Kind, Values, corners_to_faces
from ..attributes.colours import COLOR, as_bytes, is_color
from ..errors import Finding, FormatError
from ..mesh.mesh import Mesh
from .blocks import encoded_lines, listed
from .raw import EMPTY_SET, IndexPolygons, RawMesh, represents_empty_set
from .source import Source, quoted, to_integer, to_integral
from .storable_attributes import attributes_or_none, selected_attributes

#: The keyword of an OFF file; the number of vertices may follow it without a blank.
_KEYWORD = re.compile(rb"((?:ST)?C?N?(4?)(n?)(?i:OFF))(\d*)")

_Line = tuple[int, list[bytes]]


def read(source: Source) -> RawMesh:
    """Read an OFF file.

    Raises
    ------
    FormatError
        If the file is cut off, names a vertex that does not exist, or is no OFF; the message has
        the number of the line.
    """
    source = source.without_mark()
    keyword, lines = _body(source)
    vertex_count, face_count, rest = _counts(source, lines)
    try:
        return _mesh(source, keyword, vertex_count, face_count, rest)
    except FormatError:
        number, words = lines[0]
        spread = _one_record_per_line(vertex_count, face_count, [(number, words[3:]), *rest])
        # Variants of OFF have more than three numbers for each vertex.
        if spread is None or (keyword.isalpha() and keyword != b"OFF"):
            raise
        return _mesh(source, keyword, vertex_count, face_count, spread)


def _one_record_per_line(
    vertex_count: int, face_count: int, lines: list[_Line]
) -> list[_Line] | None:
    """Return a line for each vertex and face of a file whose line breaks are elsewhere.

    Return None if numbers are missing, or additional: a colour is found only at the end of a line.
    """
    # If the number of lines is right, the error is in a line, not in the line breaks.
    is_spread = sum(bool(words) for _, words in lines) != vertex_count + face_count
    if not is_spread or sum(len(words) for _, words in lines) < 3 * vertex_count + face_count:
        return None
    words = [(number, word) for number, line in lines for word in line]
    found: list[_Line] = []
    at = 0
    while len(found) < vertex_count + face_count:
        try:
            length = 3 if len(found) < vertex_count else 1 + to_integral(words[at][1])
        except (ValueError, IndexError):
            return None
        row = words[at : at + length]
        if not 1 <= length == len(row):
            return None
        found.append((row[0][0], [word for _, word in row]))
        at += length
    return found if at == len(words) else None


def _mesh(
    source: Source, keyword: bytes, vertex_count: int, face_count: int, lines: list[_Line]
) -> RawMesh:
    if vertex_count + face_count > len(lines):
        message = (
            f"the file is incomplete: it has {len(lines)} lines of data, but its header says"
            f" {vertex_count} vertices and {face_count} faces, one on each line."
        )
        raise source.error(message, "truncated", line=lines[-1][0] if lines else 1)
    points, polygons = lines[:vertex_count], lines[vertex_count : vertex_count + face_count]
    vertices = source.coordinates([row for _, row in points], [number for number, _ in points])
    corners = [_corners(source, number, words) for number, words in polygons]
    flat = IndexPolygons.from_lists(corners)
    positions = flat.positions(
        vertices, lambda k, message, code: source.error(message, code, line=polygons[k][0])
    )
    faces = flat.corners[positions]
    extra = _extra_lines(lines[vertex_count + face_count :])
    of_points = _colors([words[3:] for _, words in points]) if keyword == b"COFF" else None
    of_faces = _colors([words[to_integral(words[0]) + 1 :] for _, words in polygons])
    vertex = {} if of_points is None else {"color": of_points}
    face = {} if of_faces is None or vertex else {"color": of_faces[flat.owners(positions)]}
    attributes = Attributes(faces, vertex, {}, face) if vertex or face else None
    dropped = (*_more_than_a_shape(points, polygons, vertex, face), *flat.dropped)
    return RawMesh(vertices, faces, "", extra, dropped=dropped, attributes=attributes)


def _more_than_a_shape(
    points: list[_Line],
    polygons: list[_Line],
    vertex: dict[str, Values],
    face: dict[str, Values],
) -> tuple[str, ...]:
    """Return the names of the data of vertices and faces that are not read."""
    found = []
    if not vertex and any(len(words) > 3 for _, words in points):
        found.append("data of vertices")
    if not face and any(len(words) > to_integral(words[0]) + 1 for _, words in polygons):
        found.append("colours of faces")
    return tuple(found)


def _colors(rows: Sequence[Sequence[bytes]]) -> Values | None:
    """Return rows of text as colours, (k, 3) or (k, 4), uint8 or float64; None for other text."""
    widths = {len(row) for row in rows}
    if len(widths) != 1 or not widths <= {3, 4}:
        return None
    try:
        if all(word.isdigit() for row in rows for word in row):
            numbers = np.array([[to_integer(word) for word in row] for row in rows])
            return numbers.astype(np.uint8) if numbers.max() <= 255 else None
        return np.array([[float(word) for word in row] for row in rows])
    except ValueError:
        return None


def storable(attributes: Attributes) -> Attributes:
    """Return the attributes that OFF can store: colours of vertices, else of faces, as bytes."""
    attributes = corners_to_faces(attributes, COLOR)

    def keep(kind: Kind, name: str, values: Values) -> Values | None:
        is_held = kind != "corner" and is_color(name, values, 1)
        return as_bytes(values) if is_held else None

    return selected_attributes(attributes, keep)


def _body(source: Source) -> tuple[bytes, list[_Line]]:
    """Return the first word in upper case, usually the keyword, and the lines after the keyword."""
    lines = list(_lines(source))
    first = next(source.text_lines(b"#"), (1, [b""]))[1][0]
    keyword = _KEYWORD.fullmatch(first)
    return (first if keyword is None else keyword[1]).upper(), lines


def _lines(source: Source) -> Iterator[_Line]:
    """Yield the lines after the keyword; the rest of the keyword's own line comes first."""
    lines = source.text_lines(b"#")
    number, words = next(lines, (1, [b""]))
    keyword = _KEYWORD.fullmatch(words[0])
    if keyword is None:
        if not words[0].isdigit():
            raise source.error(
                f"the file is not an OFF mesh: it begins with {quoted(words[0])}.", line=number
            )
        yield number, words
    elif keyword[2] or keyword[3]:
        raise source.error(
            "the OFF file is not three-dimensional (4OFF or nOFF), and only three-dimensional"
            " ones can be read.",
            line=number,
        )
    elif keyword[4]:
        yield number, [keyword[4], *words[1:]]
    elif len(words) > 1 and words[1].upper() == b"BINARY":
        raise source.error("binary OFF cannot be read; save it as text, or as PLY.", line=number)
    elif len(words) > 1:
        yield number, words[1:]
    yield from lines


def _counts(source: Source, lines: list[_Line]) -> tuple[int, int, list[_Line]]:
    """Return the counts of vertices and faces from the first line, and the lines after it."""
    number, words = lines[0] if lines else (1, [])
    try:
        counts = [to_integer(word) for word in words[:2]]
    except ValueError:
        counts = []
    if len(counts) < 2 or min(counts) < 0:
        found = quoted(b" ".join(words))
        raise source.error(
            f"expected the number of vertices and the number of faces, found {found}.", line=number
        )
    return counts[0], counts[1], lines[1:]


def _corners(source: Source, number: int, words: list[bytes]) -> list[int]:
    """Return the vertex indices in the line of a face; a colour after them is ignored."""
    try:
        count = to_integral(words[0])
        indices = [to_integral(word) for word in words[1 : count + 1]]
    except ValueError:
        message = (
            "expected a face as a number of corners and integer vertex indices, found"
            f" {quoted(b' '.join(words))}."
        )
        raise source.error(message, line=number) from None
    if len(indices) != count:
        message = f"a face of {count} corners has only {len(indices)} vertex indices."
        raise source.error(message, line=number)
    if any(not 0 <= index < 2**63 for index in indices):
        message = (
            f"a face has the vertex index {min(indices) if min(indices) < 0 else max(indices)},"
            " which is out of range."
        )
        raise source.error(message, "index_out_of_range", line=number)
    return indices


def _extra_lines(lines: list[_Line]) -> tuple[Finding, ...]:
    if not lines:
        return ()
    message = f"{len(lines)} lines after the last face were ignored."
    return (Finding("extra_data", "warning", message, (lines[0][0],), len(lines)),)


def text(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the bytes of an OFF file; every coordinate reads back as the same double."""
    attributes = attributes_or_none(mesh)
    keyword = b"COFF\n" if attributes and attributes.vertex else b"OFF\n"
    yield keyword + (EMPTY_SET if represents_empty_set(mesh) else b"")
    yield f"{len(mesh.vertices)} {len(mesh.faces)} 0\n".encode()
    points = _words(attributes.vertex if attributes else {}, len(mesh.vertices))
    faces = _words(attributes.face if attributes else {}, len(mesh.faces))
    yield from encoded_lines(_data(mesh, points, faces))


def _data(mesh: Mesh | RawMesh, points: Iterable[str], faces: Iterable[str]) -> Iterator[str]:
    for (x, y, z), words in zip(listed(mesh.vertices), points, strict=True):
        yield f"{x!r} {y!r} {z!r}{words}\n"
    for (a, b, c), words in zip(listed(mesh.faces), faces, strict=True):
        yield f"3 {a} {b} {c}{words}\n"


def _words(attributes: Mapping[str, Values], count: int) -> Iterable[str]:
    """Return the end of each line: its colour, a space before each number, or an empty string."""
    if "color" not in attributes:
        return repeat("", count)
    return ("".join(f" {value}" for value in row) for row in listed(attributes["color"]))
