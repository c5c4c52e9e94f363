"""Reading and writing PLY with attributes: text, binary little-endian and big-endian."""

import itertools
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np

from ..._types import FloatArray, IndexArray
from ...attributes.attributes import Attributes, Values
from ...errors import Finding, FormatError
from ...mesh.mesh import Mesh
from ..blocks import ROWS_PER_FILE_BLOCK, blocks, encoded_lines, listed
from ..raw import IndexPolygons, RawMesh, represents_empty_set
from ..source import Source, quoted, to_integral
from ..storable_attributes import attributes_or_none
from .columns import TYPES, attributes_of, columns_of, corners_of, lists_of, names_in
from .header import Element, Header, Order, read_header
from .lists import read_mixed, read_uniform

#: The names that programs use for the list of a face's vertex indices.
_FACE_LISTS = ("vertex_indices", "vertex_index")

#: The names of the elements that have vertex indices: polygons, or strips of triangles.
_FACES, _STRIPS = "face", "tristrips"

_Line: TypeAlias = tuple[int, list[bytes]]

_LISTS_OF_VERTICES = "the vertices have list properties, which are not supported."


@dataclass
class _PlyContent:
    """The content of the elements that have been read from a PLY file."""

    vertices: FloatArray | None = None
    polygons: IndexPolygons | None = None
    polygon_error: Callable[[int, str, str], FormatError] | None = None
    element: str = ""
    vertex_columns: dict[str, Values] = field(default_factory=dict)
    face_columns: dict[str, Values] = field(default_factory=dict)

    def take(
        self,
        name: str,
        polygons: IndexPolygons,
        error_at: Callable[[int, str, str], FormatError],
        columns: dict[str, Values],
    ) -> None:
        """Store the polygons of an element, or its strips as triangles if there are no polygons."""
        has_faces = self.polygons is not None and len(self.polygons.counts) > 0
        if name == _STRIPS and not has_faces:
            triangles, owners = polygons.of_strips()
            self.element, self.polygons, self.face_columns = name, triangles, {}
            self.polygon_error = lambda k, text, code: error_at(int(owners[k]), text, code)
        elif name == _FACES and (len(polygons.counts) or self.polygons is None):
            self.element, self.polygons, self.face_columns = name, polygons, columns
            self.polygon_error = error_at


def read(source: Source) -> RawMesh:
    """Read a PLY file.

    Raises
    ------
    FormatError
        If the file is no PLY, is cut off, has no vertices or faces, or names a vertex that does not
        exist; the message has the number of the line or of the byte.
    """
    source = source.without_mark()
    header = read_header(source)
    found = _PlyContent()
    if header.order is None:
        rest = _read_text(source, header, found)
    else:
        rest = _read_binary(source, header, header.order, found)
    if found.vertices is None:
        raise source.error(
            "the PLY has no element “vertex” with the properties x, y and z.", line=header.lines
        )
    if found.polygons is None or found.polygon_error is None:
        raise source.error(
            "the PLY has no element “face” with a list of vertex indices.", line=header.lines
        )
    faces, attributes = _triangles_and_attributes(
        found, found.polygons, found.vertices, found.polygon_error
    )
    dropped = (*_more_than_a_shape(header, attributes, found.element), *found.polygons.dropped)
    told = (*_no_statements(header), *rest)
    return RawMesh(found.vertices, faces, "", told, dropped=dropped, attributes=attributes)


def _no_statements(header: Header) -> tuple[Finding, ...]:
    if not header.unknown:
        return ()
    message = f"{len(header.unknown)} lines of the header have no PLY keyword and were ignored."
    return (Finding("ignored", "warning", message, header.unknown[:1], len(header.unknown)),)


def _triangles_and_attributes(
    found: _PlyContent,
    polygons: IndexPolygons,
    vertices: FloatArray,
    error_at: Callable[[int, str, str], FormatError],
) -> tuple[IndexArray, Attributes | None]:
    """Return the triangles of polygons, and the attributes or None."""
    if not found.vertex_columns and not found.face_columns:
        return polygons.triangles(vertices, error_at), None
    positions = polygons.positions(vertices, error_at)
    faces, owners = polygons.corners[positions], polygons.owners(positions)
    lists = {name: values for name, values in found.face_columns.items() if values.ndim == 2}
    single = {name: values for name, values in found.face_columns.items() if values.ndim == 1}
    count = int(polygons.counts.max(initial=3))
    lists = lists if (polygons.counts == count).all() else {}
    corner = {name: values[positions] for name, values in corners_of(lists, count).items()}
    face = {name: values[owners] for name, values in attributes_of(single).items()}
    vertex = attributes_of(found.vertex_columns)
    vertex, corner, face = _without_repeated_names(vertex, corner, face)
    return faces, Attributes(faces, vertex, corner, face)


def _without_repeated_names(*kinds: dict[str, Values]) -> Iterator[dict[str, Values]]:
    """Yield each dictionary without the names that an earlier dictionary has."""
    taken: set[str] = set()
    for kind in kinds:
        yield {name: values for name, values in kind.items() if name not in taken}
        taken.update(kind)


def _more_than_a_shape(
    header: Header, attributes: Attributes | None, faces: str
) -> tuple[str, ...]:
    """Return descriptions of the elements, properties and pictures that are not read."""
    columns = names_in(attributes)
    told = [f"the picture “{name}”" for name in header.pictures]
    for element in header.elements:
        shape = {"vertex": ("x", "y", "z"), faces: _FACE_LISTS}.get(element.name)
        kept = (*(shape or ()), *columns.get(element.name, ()))
        names = [prop.name for prop in element.properties if shape and prop.name not in kept]
        if shape is None and element.number:
            told.append(f"“{element.name}” elements")
        elif names and element.number:
            told.append(f"{element.name} properties {', '.join(names)}")
    return tuple(told)


def _axes(element: Element) -> tuple[int, int, int] | None:
    x, y, z = (element.index(axis) for axis in "xyz")
    return None if x is None or y is None or z is None else (x, y, z)


def _face_column(source: Source, header: Header, element: Element) -> int | None:
    """Return the number of the property with a face's vertex indices; None if there is none."""
    is_listing = element.name in (_FACES, _STRIPS)
    column = element.index(*_FACE_LISTS) if is_listing else None
    if column is None or element.properties[column].count is None:
        return None
    if element.properties[column].item.kind == "f":
        raise source.error(
            "the list of vertex indices must have an integer type, not float or double.",
            line=header.lines,
        )
    return column


def _read_text(source: Source, header: Header, found: _PlyContent) -> tuple[Finding, ...]:
    lines = [line for line in source.text_lines() if line[0] > header.lines]
    try:
        return _read_lines(source, header, lines, found)
    except FormatError:
        spread = _one_record_per_line(header, lines)
        if spread is None:
            raise
        return _read_lines(source, header, spread, found)


def _one_record_per_line(header: Header, lines: list[_Line]) -> list[_Line] | None:
    """Return a line for each record of a file whose line breaks are elsewhere.

    Return None if the numbers are not exactly those that the header promises.
    """
    # If the number of lines is right, the error is in a line, not in the line breaks.
    if sum(element.number for element in header.elements) == len(lines):
        return None
    words = [(number, word) for number, line in lines for word in line]
    found: list[_Line] = []
    at = 0
    for element in header.elements:
        for _ in range(element.number):
            start = at
            try:
                for prop in element.properties:
                    at += 1 if prop.count is None else 1 + max(to_integral(words[at][1]), 0)
            except (ValueError, IndexError):
                return None
            row = words[start:at]
            if not row or at > len(words):
                return None
            found.append((row[0][0], [word for _, word in row]))
    return found if at == len(words) else None


def _read_lines(
    source: Source, header: Header, lines: list[_Line], found: _PlyContent
) -> tuple[Finding, ...]:
    start = 0
    for element in header.elements:
        block = lines[start : start + element.number]
        start += element.number
        if len(block) < element.number:
            message = (
                f"the file is incomplete: it has {len(block)} of the {element.number} lines of"
                f" the element “{element.name}”."
            )
            last = lines[-1][0] if lines else header.lines
            raise source.error(message, "truncated", line=last)
        if element.name == "vertex" and (axes := _axes(element)):
            found.vertices = _text_vertices(source, block, element, axes)
            found.vertex_columns = _text_columns(source, block, element, axes)
        elif (column := _face_column(source, header, element)) is not None:
            _text_faces(source, block, element, column, found)
    rest = lines[start:]
    return _extra(len(rest), "lines", (rest[0][0],)) if rest else ()


def _text_vertices(
    source: Source,
    block: list[_Line],
    element: Element,
    axes: tuple[int, int, int],
) -> FloatArray:
    if element.has_lists:
        raise source.error(_LISTS_OF_VERTICES, line=block[0][0] if block else None)
    x, y, z = axes
    width = len(element.properties)
    for number, words in block:
        if len(words) != width:
            message = (
                f"each vertex has {width} properties according to the header, but this line has"
                f" {len(words)} numbers."
            )
            raise source.error(message, line=number)
    rows = [[words[x], words[y], words[z]] for _, words in block]
    return source.coordinates(rows, [number for number, _ in block])


def _text_faces(
    source: Source,
    block: list[_Line],
    element: Element,
    column: int,
    found: _PlyContent,
) -> None:
    lists = [_text_list(source, number, words, element, column) for number, words in block]
    found.take(
        element.name,
        IndexPolygons.from_lists(lists),
        lambda k, message, code: source.error(message, code, line=block[k][0]),
        _text_face_columns(source, block, element, column),
    )


def _text_columns(
    source: Source,
    block: list[_Line],
    element: Element,
    known: tuple[int, ...],
) -> dict[str, Values]:
    """Return the columns of an element without lists, except the columns numbered in `known`."""
    return {
        prop.name: _text_numbers(source, block, [words[k] for _, words in block], prop.item)
        for k, prop in enumerate(element.properties)
        if k not in known
    }


def _text_face_columns(
    source: Source, block: list[_Line], element: Element, column: int
) -> dict[str, Values]:
    """Return the columns of faces except column `column`, and except lists of varying length."""
    rows = [_split(words, element) for _, words in block]
    found: dict[str, Values] = {}
    for k, prop in enumerate(element.properties):
        length = len(rows[0][k]) if rows else 0
        if k == column or any(len(row[k]) != length for row in rows):
            continue
        flat = [word for row in rows for word in row[k]]
        values = _text_numbers(source, block, flat, prop.item)
        found[prop.name] = values if prop.count is None else values.reshape(len(rows), length)
    return found


def _split(words: list[bytes], element: Element) -> list[list[bytes]]:
    """Divide the words of a valid line into a list of words for each property."""
    at, found = 0, []
    for prop in element.properties:
        length = 1 if prop.count is None else to_integral(words[at])
        at += prop.count is not None
        found.append(words[at : at + length])
        at += length
    return found


def _text_numbers(
    source: Source,
    block: list[_Line],
    words: list[bytes],
    kind: "np.dtype[np.generic]",
) -> Values:
    try:
        numbers = [float(word) if kind.kind == "f" else to_integral(word) for word in words]
        return np.array(numbers, dtype=kind)
    except (ValueError, OverflowError):
        message = f"a property here is not a number of the type {kind} that the header says."
        raise source.error(message, line=block[0][0]) from None


def _text_list(
    source: Source, number: int, words: list[bytes], element: Element, column: int
) -> list[int]:
    """Return the list in column `column` of a line; an invalid line is a `FormatError`."""
    at, wanted = 0, []
    try:
        for position, prop in enumerate(element.properties):
            length = to_integral(words[at]) if prop.count is not None else 1
            at += prop.count is not None
            if length < 0 or at + length > len(words):
                raise ValueError
            if position == column:
                wanted = [_index(word) for word in words[at : at + length]]
            at += length
        if at != len(words):
            raise ValueError
    except (ValueError, IndexError):
        message = (
            "expected a face with the properties that the header lists, found"
            f" {quoted(b' '.join(words))}."
        )
        raise source.error(message, line=number) from None
    return wanted


def _index(word: bytes) -> int:
    index = to_integral(word)
    if not -(2**63) <= index < 2**63:
        raise ValueError
    return index


def _read_binary(
    source: Source, header: Header, order: Order, found: _PlyContent
) -> tuple[Finding, ...]:
    offset = header.end
    for element in header.elements:
        start = offset
        if not element.has_lists:
            offset = _read_records(source, order, element, start, found)
            continue
        if element.name == "vertex" and _axes(element):
            raise source.error(_LISTS_OF_VERTICES, line=header.lines)
        column = _face_column(source, header, element)
        block = read_uniform(source, order, element, start, column)
        if block is None:
            block = read_mixed(source, order, element, start, column)
        offset = block.end
        if block.polygons is not None:
            found.take(element.name, block.polygons, block.error_at, block.columns)
    extra = len(source.data) - offset
    # A line break at the end comes from a text editor, and is no data.
    return () if source.data[offset:].isspace() or not extra else _extra(extra, "bytes", (offset,))


def _read_records(
    source: Source, order: Order, element: Element, start: int, found: _PlyContent
) -> int:
    """Read a binary element without lists; return the byte offset at which its data end."""
    fields = [(f"p{k}", p.item.newbyteorder(order)) for k, p in enumerate(element.properties)]
    record = np.dtype(fields)
    end = start + record.itemsize * element.number
    if end > len(source.data):
        held = (len(source.data) - start) // record.itemsize
        message = (
            f"the file is incomplete: it ends in item {held} of {element.number} of the element"
            f" “{element.name}”."
        )
        raise source.error(message, "truncated", offset=len(source.data))
    axes = _axes(element)
    if element.name == "vertex" and axes:
        records = np.frombuffer(source.data, record, element.number, start)
        columns = [records[f"p{axis}"].astype(np.float64) for axis in axes]
        found.vertices = np.stack(columns, axis=1)
        found.vertex_columns = {
            prop.name: records[f"p{k}"].astype(prop.item)
            for k, prop in enumerate(element.properties)
            if k not in axes
        }
        finite = np.isfinite(found.vertices).all(axis=1)
        if not finite.all():
            vertex = int(np.flatnonzero(~finite)[0])
            message = f"vertex {vertex} has a coordinate that is not a finite number."
            offset = start + vertex * record.itemsize
            raise source.error(message, "non_finite", offset=offset)
    return end


def _extra(count: int, unit: str, where: tuple[int, ...]) -> tuple[Finding, ...]:
    message = f"{count} {unit} after the last element were ignored."
    return (Finding("extra_data", "warning", message, where, count),)


def _header(mesh: Mesh | RawMesh, form: str) -> bytes:
    comment = "comment bspcsg: the empty set\n" if represents_empty_set(mesh) else ""
    vertex, face, lists = _columns(mesh)
    return (
        f"ply\nformat {form} 1.0\n{comment}element vertex {len(mesh.vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"{_properties(vertex)}"
        f"element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\n"
        f"{_properties(face)}{_properties(lists, 'list uchar ')}end_header\n"
    ).encode()


_Columns: TypeAlias = list[tuple[str, Values]]


def _columns(mesh: Mesh | RawMesh) -> tuple[_Columns, _Columns, _Columns]:
    """Return the attributes of a mesh as columns of vertices, columns of faces, lists of faces."""
    attributes = attributes_or_none(mesh)
    if attributes is None:
        return [], [], []
    return (
        list(columns_of(attributes.vertex)),
        list(columns_of(attributes.face)),
        list(lists_of(attributes.corner)),
    )


def _properties(columns: _Columns, kind: str = "") -> str:
    words = (f"property {kind}{_type_of(values)} {name}\n" for name, values in columns)
    return "".join(words)


def _type_of(values: Values) -> str:
    return TYPES[f"{values.dtype.kind}{values.dtype.itemsize}"]


def size_problem(mesh: Mesh | RawMesh) -> str:
    """Return why a mesh is too large for PLY, or an empty string if it fits."""
    is_beyond = len(mesh.vertices) > np.iinfo(np.int32).max
    return (
        "the mesh has more than 2^31 - 1 vertices, too many for PLY; write OBJ instead."
        if is_beyond
        else ""
    )


def binary(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the bytes of a binary little-endian PLY file, in double precision."""
    yield _header(mesh, "binary_little_endian")
    vertex, face, lists = _columns(mesh)
    row = np.dtype([("xyz", "<f8", 3), *_fields(vertex)])
    for block in blocks(len(mesh.vertices), ROWS_PER_FILE_BLOCK):
        points = np.empty(len(mesh.vertices[block]), row)
        points["xyz"] = mesh.vertices[block]
        _fill(points, vertex, block)
        yield points.tobytes()
    further: list[Any] = _fields(face)
    for k, (_, values) in enumerate(lists):
        further += [(f"n{k}", "u1"), (f"l{k}", _little(values), values.shape[1:])]
    row = np.dtype([("count", "u1"), ("corners", "<i4", 3), *further])
    for block in blocks(len(mesh.faces), ROWS_PER_FILE_BLOCK):
        records = np.empty(len(mesh.faces[block]), row)
        records["count"] = 3
        records["corners"] = mesh.faces[block]
        _fill(records, face, block)
        for k, (_, values) in enumerate(lists):
            records[f"n{k}"], records[f"l{k}"] = values.shape[1], values[block]
        yield records.tobytes()


def _fields(columns: _Columns) -> list[tuple[str, "np.dtype[Any]"]]:
    return [(f"p{k}", _little(values)) for k, (_, values) in enumerate(columns)]


def _fill(records: Values, columns: _Columns, block: slice) -> None:
    for k, (_, values) in enumerate(columns):
        records[f"p{k}"] = values[block]


def _little(values: Values) -> "np.dtype[Any]":
    return values.dtype.newbyteorder("<")


def text(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the bytes of a text PLY file; every coordinate reads back as the same double."""
    yield _header(mesh, "ascii")
    yield from encoded_lines(_lines(mesh))


def _lines(mesh: Mesh | RawMesh) -> Iterator[str]:
    vertex, face, lists = _columns(mesh)
    further = _words(vertex, len(mesh.vertices))
    for (x, y, z), words in zip(listed(mesh.vertices), further, strict=True):
        yield f"{x!r} {y!r} {z!r}{words}\n"
    further = _words([*face, *lists], len(mesh.faces))
    for (a, b, c), words in zip(listed(mesh.faces), further, strict=True):
        yield f"3 {a} {b} {c}{words}\n"


def _words(columns: _Columns, count: int) -> Iterable[str]:
    """Return the end of each text line: the values of columns, a space before each.

    A list begins with its length.
    """
    if not columns:
        return itertools.repeat("", count)
    lists = [listed(values) for _, values in columns]
    return ("".join(map(_word, row)) for row in zip(*lists, strict=True))


def _word(value: Any) -> str:
    if isinstance(value, list):
        return f" {len(value)}" + "".join(map(_word, value))
    return f" {value!r}"
