"""Wavefront OBJ: its vertices and polygons. Materials, normals, groups and curves are passed by."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ..errors import Finding, FormatError
from ..mesh.mesh import Mesh
from .raw import EMPTY_SET, IndexPolygons, RawMesh, on_one_line, parts_of, says_empty_set
from .source import Source, quoted, whole

#: Statements about what a mesh of triangles has no room for.
_DROPPED = {
    b"vt": "texture coordinates",
    b"vn": "normals",
    b"usemtl": "materials",
    b"l": "lines",
    b"p": "points",
}

#: Statements that would add surface which is not in the polygons.
_SURFACES = frozenset({b"surf", b"curv", b"cstype", b"bmat"})


@dataclass
class _Found:
    """What the statements say, in their order; lines are those of the rows beside them."""

    rows: list[list[bytes]] = field(default_factory=list)
    row_lines: list[int] = field(default_factory=list)
    polygons: list[list[int]] = field(default_factory=list)
    face_lines: list[int] = field(default_factory=list)
    objects: list[tuple[bytes, int]] = field(default_factory=list)
    dropped: set[str] = field(default_factory=set)
    surfaces: int = 0


def read(source: Source) -> RawMesh:
    """Read all objects and groups as one mesh.

    Raises
    ------
    FormatError
        If a line is no valid statement, or names a vertex that does not exist; names the line.
    """
    found = _collected(source)
    if not found.rows:
        raise source.error("this is no OBJ mesh: it has no vertex.")
    vertices = source.coordinates(found.rows, found.row_lines)
    polygons = _faces(source, found.polygons, found.face_lines)
    faces = polygons.triangles(
        vertices,
        lambda k, message, code: source.error(message, code, line=found.face_lines[k]),
    )
    named = _objects(found.objects, [len(corners) - 2 for corners in found.polygons], len(faces))
    return RawMesh(
        vertices,
        faces,
        next((name for name, _ in named if name), ""),
        _curved(found.surfaces),
        objects=named if len(named) > 1 else (),
        dropped=(*sorted(found.dropped), *polygons.dropped),
    )


def _collected(source: Source) -> _Found:
    found = _Found()
    for number, words in _statements(source):
        key = words[0]
        if key == b"v":
            found.rows.append(words[1:])
            found.row_lines.append(number)
        elif key == b"f":
            found.polygons.append(_references(source, number, words, len(found.rows)))
            found.face_lines.append(number)
        elif key == b"o":
            found.objects.append((b" ".join(words[1:]), len(found.polygons)))
        elif key in _DROPPED:
            found.dropped.add(_DROPPED[key])
        found.surfaces += key in _SURFACES
    if any(len(row) > 4 for row in found.rows):  # a fourth number is a weight
        found.dropped.add("colours")
    return found


def _objects(
    begun: list[tuple[bytes, int]], triangles: list[int], total: int
) -> tuple[tuple[str, int], ...]:
    """Return names and triangle counts of objects that begin at some polygons."""
    if sum(triangles) != total:  # a polygon without area has fewer
        return ()
    if not begun or begun[0][1] > 0:
        begun = [(b"", 0), *begun]
    starts = [start for _, start in begun]
    counts = [
        sum(triangles[start:end])
        for start, end in zip(starts, [*starts[1:], len(triangles)], strict=True)
    ]
    names = [name.decode("utf-8", "replace") for name, _ in begun]
    return tuple((name, count) for name, count in zip(names, counts, strict=True) if count)


def _statements(source: Source) -> Iterator[tuple[int, list[bytes]]]:
    """Yield number and words of each line; a line that ends in a backslash goes on."""
    held: list[bytes] = []
    start = 0
    for number, words in source.text_lines(b"#"):
        start = start if held else number
        if words[-1].endswith(b"\\"):
            held += [*words[:-1], *filter(None, [words[-1][:-1]])]
            continue
        yield start, held + words
        held = []
    if held:
        raise source.error("the file ends in a line that must go on.", "truncated", line=start)


def _references(source: Source, number: int, words: list[bytes], known: int) -> list[int]:
    """Return the vertices of a face, from 0; negative numbers count back from the last vertex."""
    try:
        references = [whole(word.partition(b"/")[0]) for word in words[1:]]
    except ValueError:
        message = f"expected vertex numbers, found {quoted(b' '.join(words[1:]))}."
        raise source.error(message, line=number) from None
    if all(reference > 0 for reference in references):
        return [reference - 1 for reference in references]
    if 0 in references or min(references) < -known:
        wrong = 0 if 0 in references else min(references)
        message = f"vertex number {wrong} names no vertex; {known} precede this face."
        raise source.error(message, "index_out_of_range", line=number)
    return [known + reference if reference < 0 else reference - 1 for reference in references]


def _faces(source: Source, polygons: list[list[int]], lines: list[int]) -> IndexPolygons:
    try:
        return IndexPolygons.from_lists(polygons)
    except OverflowError:
        bad = next(k for k, polygon in enumerate(polygons) if max(polygon) >= 2**63)
        raise _too_large(source, lines[bad]) from None


def _too_large(source: Source, line: int) -> FormatError:
    return source.error("a vertex number is far too large.", "index_out_of_range", line=line)


def _curved(count: int) -> tuple[Finding, ...]:
    if not count:
        return ()
    message = f"{count} statements about free-form curves and surfaces were ignored."
    return (Finding("curves_ignored", "warning", message, (), count),)


def called(name: str) -> str:
    """Return an object's name as a line can hold it: without marks that end or go on a line."""
    return on_one_line(name).replace("#", "_").replace("\\", "_")


def text(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the file; every coordinate reads back as the same double."""
    if says_empty_set(mesh):
        yield EMPTY_SET
    for point in mesh.vertices.tolist():
        yield "v {!r} {!r} {!r}\n".format(*point).encode()
    parts = parts_of(mesh)
    for name, faces in parts:
        if name or len(parts) > 1:
            yield f"o {called(name)}\n".encode()
        for face in (faces + np.int64(1)).tolist():
            yield "f {} {} {}\n".format(*face).encode()
