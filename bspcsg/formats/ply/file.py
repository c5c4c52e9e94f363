"""PLY: text, binary little-endian and binary big-endian, with polygons and any further data."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..._types import FloatArray
from ...errors import Finding, FormatError
from ...mesh.mesh import Mesh
from ..raw import IndexPolygons, RawMesh, says_empty_set
from ..source import Source, quoted, whole
from .header import Element, Header, Order, read_header
from .lists import read_mixed, read_uniform

#: Both names of the list are in use.
_FACE_LISTS = ("vertex_indices", "vertex_index")


@dataclass
class _Found:
    """What the elements read so far hold."""

    vertices: FloatArray | None = None
    polygons: IndexPolygons | None = None
    polygon_error: Callable[[int, str, str], FormatError] | None = None


def read(source: Source) -> RawMesh:
    """Read the file.

    Raises
    ------
    FormatError
        If it is no PLY, is cut off, has no vertices or faces, or names a vertex that does not
        exist; names the line or the byte.
    """
    source = source.without_mark()
    header = read_header(source)
    found = _Found()
    if header.order is None:
        rest = _read_text(source, header, found)
    else:
        rest = _read_binary(source, header, header.order, found)
    if found.vertices is None:
        raise source.error("this PLY has no vertices with x, y and z.", line=header.lines)
    if found.polygons is None or found.polygon_error is None:
        strips = any(element.name == "tristrips" for element in header.elements)
        hint = " Its triangle strips cannot be read; save it with faces." if strips else ""
        raise source.error(f"this PLY has no face lists.{hint}", line=header.lines)
    faces = found.polygons.triangles(found.vertices, found.polygon_error)
    dropped = (*_more_than_a_shape(header), *found.polygons.dropped)
    return RawMesh(found.vertices, faces, "", rest, dropped=dropped)


def _more_than_a_shape(header: Header) -> tuple[str, ...]:
    """Return which elements and properties say something besides the shape."""
    found = []
    for element in header.elements:
        shape = {"vertex": ("x", "y", "z"), "face": _FACE_LISTS}.get(element.name)
        names = [prop.name for prop in element.properties if shape and prop.name not in shape]
        if shape is None and element.number:
            found.append(f"“{element.name}” elements")
        elif names and element.number:
            found.append(f"{element.name} properties {', '.join(names)}")
    return tuple(found)


def _axes(element: Element) -> tuple[int, int, int] | None:
    x, y, z = (element.index(axis) for axis in "xyz")
    return None if x is None or y is None or z is None else (x, y, z)


def _face_column(source: Source, header: Header, element: Element) -> int | None:
    """Return which property lists the corners of a face, if this element has one."""
    column = element.index(*_FACE_LISTS) if element.name == "face" else None
    if column is None or element.properties[column].count is None:
        return None
    if element.properties[column].item.kind == "f":
        raise source.error("vertex numbers must be of a whole-number type.", line=header.lines)
    return column


def _read_text(source: Source, header: Header, found: _Found) -> tuple[Finding, ...]:
    lines = [line for line in source.text_lines() if line[0] > header.lines]
    start = 0
    for element in header.elements:
        block = lines[start : start + element.number]
        start += element.number
        if len(block) < element.number:
            message = (
                f"the file ends after {len(block)} of {element.number} “{element.name}” lines."
            )
            last = lines[-1][0] if lines else header.lines
            raise source.error(message, "truncated", line=last)
        if element.name == "vertex" and (axes := _axes(element)):
            found.vertices = _text_vertices(source, block, element, axes)
        elif (column := _face_column(source, header, element)) is not None:
            _text_faces(source, block, element, column, found)
    rest = lines[start:]
    return _extra(len(rest), "lines", (rest[0][0],)) if rest else ()


def _text_vertices(
    source: Source,
    block: list[tuple[int, list[bytes]]],
    element: Element,
    axes: tuple[int, int, int],
) -> FloatArray:
    if element.has_lists:
        raise source.error("vertices with list properties cannot be read.", line=block[0][0])
    x, y, z = axes
    width = len(element.properties)
    for number, words in block:
        if len(words) != width:
            message = f"a vertex has {width} properties, but this line has {len(words)} numbers."
            raise source.error(message, line=number)
    rows = [[words[x], words[y], words[z]] for _, words in block]
    return source.coordinates(rows, [number for number, _ in block])


def _text_faces(
    source: Source,
    block: list[tuple[int, list[bytes]]],
    element: Element,
    column: int,
    found: _Found,
) -> None:
    lists = [_text_list(source, number, words, element, column) for number, words in block]
    found.polygons = IndexPolygons.from_lists(lists)
    found.polygon_error = lambda k, message, code: source.error(message, code, line=block[k][0])


def _text_list(
    source: Source, number: int, words: list[bytes], element: Element, column: int
) -> list[int]:
    """Return the list in one column of a line, every column checked to be there."""
    at, wanted = 0, []
    try:
        for position, prop in enumerate(element.properties):
            length = whole(words[at]) if prop.count is not None else 1
            at += prop.count is not None
            if length < 0 or at + length > len(words):
                raise ValueError
            if position == column:
                wanted = [_index(word) for word in words[at : at + length]]
            at += length
        if at != len(words):
            raise ValueError
    except (ValueError, IndexError):
        message = f"expected a face as the header describes it, found {quoted(b' '.join(words))}."
        raise source.error(message, line=number) from None
    return wanted


def _index(word: bytes) -> int:
    index = whole(word)
    if not -(2**63) <= index < 2**63:
        raise ValueError
    return index


def _read_binary(
    source: Source, header: Header, order: Order, found: _Found
) -> tuple[Finding, ...]:
    offset = header.end
    for element in header.elements:
        start = offset
        if not element.has_lists:
            offset = _read_records(source, order, element, start, found)
            continue
        column = _face_column(source, header, element)
        block = read_uniform(source, order, element, start, column)
        if block is None:
            block = read_mixed(source, order, element, start, column)
        offset = block.end
        if block.polygons is not None:
            found.polygons, found.polygon_error = block.polygons, block.error_at
    extra = len(source.data) - offset
    # A final line break is the habit of a text editor, not data.
    return () if source.data[offset:].isspace() or not extra else _extra(extra, "bytes", (offset,))


def _read_records(source: Source, order: Order, element: Element, start: int, found: _Found) -> int:
    """Read an element without lists; return where its data end."""
    fields = [(f"p{k}", p.item.newbyteorder(order)) for k, p in enumerate(element.properties)]
    record = np.dtype(fields)
    end = start + record.itemsize * element.number
    if end > len(source.data):
        held = (len(source.data) - start) // record.itemsize
        message = f"the file ends in “{element.name}” {held} of {element.number}."
        raise source.error(message, "truncated", offset=len(source.data))
    axes = _axes(element)
    if element.name == "vertex" and axes:
        records = np.frombuffer(source.data, record, element.number, start)
        columns = [records[f"p{axis}"].astype(np.float64) for axis in axes]
        found.vertices = np.stack(columns, axis=1)
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
    comment = "comment bspcsg: the empty set\n" if says_empty_set(mesh) else ""
    return (
        f"ply\nformat {form} 1.0\n{comment}element vertex {len(mesh.vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()


def binary(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the little-endian form, in double precision."""
    yield _header(mesh, "binary_little_endian")
    yield mesh.vertices.astype("<f8").tobytes()
    records = np.zeros(len(mesh.faces), [("count", "u1"), ("corners", "<i4", 3)])
    records["count"] = 3
    records["corners"] = mesh.faces
    yield records.tobytes()


def text(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the ASCII form; every coordinate reads back as the same double."""
    yield _header(mesh, "ascii")
    for point in mesh.vertices.tolist():
        yield "{!r} {!r} {!r}\n".format(*point).encode()
    for face in mesh.faces.tolist():
        yield "3 {} {} {}\n".format(*face).encode()
