"""Reading and writing OBJ: polygons, texture coordinates, normals, colours and materials.

Groups, lines and curves are skipped.
"""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from .._types import FloatArray, IndexArray
from ..attributes.attributes import Attributes, Kind, Values, corners_to_faces
from ..attributes.colours import COLOR, as_bytes, as_floats, is_color, is_opaque, opaque
from ..attributes.material import Material
from ..errors import Finding, FormatError
from ..mesh.mesh import Mesh
from . import mtl
from .blocks import encoded_lines, listed
from .raw import EMPTY_SET, IndexPolygons, RawMesh, on_one_line, parts_of, represents_empty_set
from .source import Source, as_text, quoted, to_integer
from .storable_attributes import attributes_or_none, selected_attributes

#: Keywords of statements that are not read, and what they define.
_DROPPED = {
    b"l": "lines",
    b"p": "points",
}

#: Keywords of free-form curves and surfaces, which are surface besides the polygons.
_SURFACES = frozenset({b"surf", b"curv", b"cstype", b"bmat"})

#: Keywords that names follow. Such names may end in a backslash, as paths do.
_NAMING = frozenset(
    {b"o", b"g", b"usemtl", b"mtllib", b"usemap", b"maplib", b"shadow_obj", b"trace_obj"}
)

#: Keywords that numbers follow, and all keywords that may begin the line after a line of names.
_NUMBERS = frozenset({b"v", b"vt", b"vn", b"f", b"l", b"p"})
_FOLLOWING = frozenset({*_NAMING, *_NUMBERS, b"s"})


@dataclass
class _ObjContent:
    """The content of an OBJ's statements, in file order.

    `row_lines` and `face_lines` have the line number of each vertex and polygon. For each polygon
    that names texture coordinates or normals, `corners` has the indices of these at each corner,
    from 0, or -1 for none.
    """

    rows: list[list[bytes]] = field(default_factory=list)
    row_lines: list[int] = field(default_factory=list)
    polygons: list[list[int]] = field(default_factory=list)
    face_lines: list[int] = field(default_factory=list)
    objects: list[tuple[bytes, int]] = field(default_factory=list)
    dropped: set[str] = field(default_factory=set)
    surfaces: int = 0
    textures: list[list[bytes]] = field(default_factory=list)
    normals: list[list[bytes]] = field(default_factory=list)
    corners: dict[int, list[tuple[int, int]]] = field(default_factory=dict)
    materials: list[tuple[str, int]] = field(default_factory=list)
    libraries: list[list[bytes]] = field(default_factory=list)


def read(source: Source) -> RawMesh:
    """Read all objects and groups of an OBJ file as one mesh.

    Raises
    ------
    FormatError
        If a line is no valid statement, or names a vertex that does not exist; the message has the
        number of the line.
    """
    source = source.without_mark()
    found = _collected(source)
    if not found.rows:
        raise source.error("the file is not an OBJ mesh: it has no vertex.")
    vertices = source.coordinates(found.rows, found.row_lines)
    polygons = _faces(source, found.polygons, found.face_lines)
    positions = polygons.positions(
        vertices,
        lambda k, message, code: source.error(message, code, line=found.face_lines[k]),
    )
    faces = polygons.corners[positions]
    attributes, missing = _attributes_of(source, found, polygons, positions)
    named = _objects(found.objects, [len(corners) - 2 for corners in found.polygons], len(faces))
    return RawMesh(
        vertices,
        faces,
        next((name for name, _ in named if name), ""),
        (*_curved(found.surfaces), *_missing(missing)),
        objects=named if len(named) > 1 else (),
        dropped=(*sorted(found.dropped), *polygons.dropped),
        attributes=None if attributes.is_empty else _with_colors(attributes),
    )


def _attributes_of(
    source: Source, found: _ObjContent, polygons: IndexPolygons, positions: IndexArray
) -> tuple[Attributes, list[str]]:
    """Return the attributes of an OBJ's triangles, and the names of missing companion files."""
    faces = polygons.corners[positions]
    vertex: dict[str, Values] = {}
    if found.rows and all(len(row) == 6 for row in found.rows):
        vertex["color"] = _numbers([row[3:] for row in found.rows], 3)
    elif any(len(row) > 4 for row in found.rows):  # a fourth number is a weight
        found.dropped.add("colours")
    corner: dict[str, Values] = {}
    for name, rows, place, width in (
        ("uv", found.textures, 0, 2),
        ("normal", found.normals, 1, 3),
    ):
        if rows and found.corners:
            numbers = _references_at(found, place, len(rows))[positions]
            # The last row of the table is for corners without texture coordinates or normal.
            table = np.concatenate([_numbers(rows, width), np.full((1, width), np.nan)])
            corner[name] = table[numbers]
    if not found.materials:
        return Attributes(faces, vertex, corner), []
    names = _material_names(found)[polygons.owners(positions)]
    libraries = mtl.materials_in(source, found.libraries)
    found.dropped |= libraries.dropped
    used = {name: one for name, one in libraries.materials.items() if name in names}
    return Attributes(faces, vertex, corner, {"material": names}, used), libraries.missing


def _numbers(rows: list[list[bytes]], width: int) -> FloatArray:
    """Return the first `width` words of each row as numbers, NaN if a word is none or missing."""
    return np.array([[_number(row, k) for k in range(width)] for row in rows])


def _number(row: list[bytes], place: int) -> float:
    try:
        return float(row[place])
    except (ValueError, IndexError):
        return math.nan


def _references_at(found: _ObjContent, place: int, count: int) -> IndexArray:
    """Return the index of the texture coordinates or normal of each polygon corner, -1 for none.

    `place` is 0 for texture coordinates, 1 for normals; indices from `count` on become -1.
    """
    numbers = []
    for polygon, corners in enumerate(found.polygons):
        named = found.corners.get(polygon)
        rows = [-1] * len(corners) if named is None else [pair[place] for pair in named]
        numbers += [row if row < count else -1 for row in rows]
    return np.array(numbers, dtype=np.int64)


def _row(parts: list[bytes], place: int, known: int) -> int:
    """Return the index, from 0, that the part `place` of a corner names, -1 for none.

    Negative numbers count back from the last of `known` entries.
    """
    try:
        number = to_integer(parts[place])
    except (ValueError, IndexError):
        return -1
    return number - 1 if number > 0 else max(known + number, -1) if number < 0 else -1


def _material_names(found: _ObjContent) -> Values:
    """Return the material name of each polygon, empty if it has none."""
    starts = [start for _, start in found.materials]
    ends = [*starts[1:], len(found.polygons)]
    counts = [starts[0], *(end - start for start, end in zip(starts, ends, strict=True))]
    return np.repeat(np.array(["", *(name for name, _ in found.materials)]), counts)


def _missing(names: list[str]) -> tuple[Finding, ...]:
    if not names:
        return ()
    told = ", ".join(f"“{name}”" for name in dict.fromkeys(names))
    message = (
        f"the files {told}, to which this OBJ refers, were not found in its folder, so their"
        " colours and pictures are missing."
    )
    return (Finding("ignored", "warning", message, (), len(names)),)


def _collected(source: Source) -> _ObjContent:
    found = _ObjContent()
    for number, words in _statements(source):
        key = words[0]
        if key == b"v":
            found.rows.append(words[1:])
            found.row_lines.append(number)
        elif key == b"f":
            found.polygons.append(_references(source, number, words, len(found.rows)))
            found.face_lines.append(number)
            if b"/" in b"".join(words):
                known = len(found.textures), len(found.normals)
                parts = [word.split(b"/") for word in words[1:]]
                rows = [(_row(each, 1, known[0]), _row(each, 2, known[1])) for each in parts]
                found.corners[len(found.polygons) - 1] = rows
        elif key == b"vt":
            found.textures.append(words[1:])
        elif key == b"vn":
            found.normals.append(words[1:])
        elif key == b"usemtl":
            found.materials.append((mtl.name_of(words[1:]), len(found.polygons)))
        elif key == b"mtllib":
            found.libraries.append(words[1:])
        elif key == b"o":
            found.objects.append((b" ".join(words[1:]), len(found.polygons)))
        elif key in _DROPPED:
            found.dropped.add(_DROPPED[key])
        found.surfaces += key in _SURFACES
    return found


def _objects(
    begun: list[tuple[bytes, int]], triangles: list[int], total: int
) -> tuple[tuple[str, int], ...]:
    """Return name and triangle count of each object, given its name and first polygon.

    Return an empty tuple if the triangle counts of the polygons do not add up to `total`.
    """
    if sum(triangles) != total:  # a polygon without area has fewer triangles
        return ()
    if not begun or begun[0][1] > 0:
        begun = [(b"", 0), *begun]
    starts = [start for _, start in begun]
    counts = [
        sum(triangles[start:end])
        for start, end in zip(starts, [*starts[1:], len(triangles)], strict=True)
    ]
    names = [as_text(name) for name, _ in begun]
    return tuple((name, count) for name, count in zip(names, counts, strict=True) if count)


def _statements(source: Source) -> Iterator[tuple[int, list[bytes]]]:
    """Yield line number and words of each statement; a backslash at a line's end continues it.

    A line of names is continued only if the next line begins no statement; else the backslash
    belongs to the last name.
    """
    held: list[bytes] = []
    start, is_in_word = 0, False
    for number, words in source.text_lines(b"#", _NAMING):
        if held and held[0] in _NAMING and _is_statement(words, is_in_word):
            yield start, _ended(held, is_in_word)
            held = []
        start = start if held else number
        if words[-1].endswith(b"\\"):
            is_in_word = words[-1] != b"\\"
            held += [*words[:-1], *filter(None, [words[-1][:-1]])]
            continue
        yield start, held + words
        held = []
    if held and held[0] not in _NAMING:
        raise source.error(
            "the last line ends in a backslash, so its continuation is missing; the file may"
            " be incomplete.",
            "truncated",
            line=start,
        )
    if held:
        yield start, _ended(held, is_in_word)


def _is_statement(words: list[bytes], is_after_word: bool) -> bool:
    """Say whether the words after a line of names and a backslash begin a statement of their own.

    If the backslash ended a word, any known keyword begins a statement; if it stood alone, only a
    keyword for numbers, such as “v”, with at least two words after it.
    """
    if is_after_word:
        return words[0] in _FOLLOWING
    return words[0] in _NUMBERS and len(words) > 2


def _ended(names: list[bytes], is_in_word: bool) -> list[bytes]:
    """Return a line of names with its final backslash, in the last word or as a separate word."""
    return [*names[:-1], names[-1] + b"\\"] if is_in_word else [*names, b"\\"]


def _references(source: Source, number: int, words: list[bytes], known: int) -> list[int]:
    """Return the vertex indices of a face, from 0.

    Negative numbers in the file count back from the last of `known` vertices.
    """
    try:
        references = [to_integer(word.partition(b"/")[0]) for word in words[1:]]
    except ValueError:
        message = (
            f"expected integer vertex numbers after “f”, found {quoted(b' '.join(words[1:]))}."
        )
        raise source.error(message, line=number) from None
    if all(reference > 0 for reference in references):
        return [reference - 1 for reference in references]
    if 0 in references or min(references) < -known:
        wrong = 0 if 0 in references else min(references)
        message = f"vertex number {wrong} does not exist; {known} vertices precede this face."
        raise source.error(message, "index_out_of_range", line=number)
    return [known + reference if reference < 0 else reference - 1 for reference in references]


def _faces(source: Source, polygons: list[list[int]], lines: list[int]) -> IndexPolygons:
    try:
        return IndexPolygons.from_lists(polygons)
    except OverflowError:
        bad = next(k for k, polygon in enumerate(polygons) if max(polygon) >= 2**63)
        raise _too_large(source, lines[bad]) from None


def _too_large(source: Source, line: int) -> FormatError:
    return source.error(
        "a vertex number is too large: it must be below 2^63.", "index_out_of_range", line=line
    )


def _curved(count: int) -> tuple[Finding, ...]:
    if not count:
        return ()
    message = (
        f"{count} statements about free-form curves and surfaces were ignored, because only"
        " polygons are read."
    )
    return (Finding("curves_ignored", "warning", message, (), count),)


def stored_name(name: str) -> str:
    """Return a name with “_” instead of characters that end or continue a line of OBJ."""
    return on_one_line(name).replace("#", "_").replace("\\", "_")


def storable(attributes: Attributes) -> Attributes:
    """Return the attributes that OBJ can store.

    These are colours of vertices, without opacity; materials of faces, or else colours of faces;
    texture coordinates and normals.
    """
    attributes = _with_colors_of_vertices(attributes.without_empty_material())
    given = _named_materials(attributes)
    names = _storable_names({*np.unique(given).tolist(), *attributes.materials})

    def keep(kind: Kind, name: str, values: Values) -> Values | None:
        depth = 2 if kind == "corner" else 1
        if values is given:
            kinds, numbers = np.unique(values, return_inverse=True)
            return np.array([names[one] for one in kinds.tolist()])[numbers]
        if kind == "vertex" and is_color(name, values, depth):
            return as_floats(values)[:, :3]
        if kind == "face" and is_color(name, values, depth):
            return None if "material" in attributes.face else opaque(as_bytes(values))
        width = _CORNERS.get(name)
        if kind != "face" and values.dtype.kind == "f" and values.shape[depth:] == (width,):
            return _whole_rows(values)
        return None

    held = selected_attributes(attributes, keep)
    used = set(held.face["material"].tolist()) if "material" in held.face else set()
    named = {names[name]: material for name, material in attributes.materials.items()}
    materials = {name: material for name, material in named.items() if name in used}
    return Attributes(held.faces, held.vertex, held.corner, held.face, materials)


def _with_colors_of_vertices(attributes: Attributes) -> Attributes:
    """Return the attributes, with opaque face colours made vertex colours.

    If faces at a vertex have different colours, the attributes stay unchanged.
    """
    attributes = corners_to_faces(attributes, COLOR)
    colors = attributes.face.get(COLOR)
    if colors is None or not is_color(COLOR, colors, 1) or not is_opaque(colors):
        return attributes
    found = np.zeros((int(attributes.faces.max(initial=-1)) + 1, 3))
    shown = as_floats(colors)[:, None, :3]
    found[attributes.faces] = shown
    if not np.array_equal(found[attributes.faces], np.repeat(shown, 3, axis=1)):
        return attributes
    rest = attributes.without({COLOR})
    return replace(rest, vertex={**rest.vertex, COLOR: found})


#: Names of materials that stand for colours of faces: red, green, blue and opacity, hexadecimal.
_COLORED = re.compile("color_([0-9a-f]{8})")


def _with_colors(attributes: Attributes) -> Attributes:
    """Return the attributes with face colours instead of materials, if all are named after colours.

    If another material is used, the attributes stay unchanged.
    """
    names = attributes.face.get("material")
    if names is None or COLOR in attributes.names:
        return attributes
    kinds, numbers = np.unique(names, return_inverse=True)
    colors = [_color_called(kind, attributes.materials.get(kind)) for kind in kinds.tolist()]
    if not all(colors):
        return attributes
    table = np.array([list(color) for color in colors], dtype=np.uint8)
    rest = attributes.without({"material"})
    return replace(rest, face={**rest.face, COLOR: table[numbers]}, materials={})


def _color_called(name: str, material: Material | None) -> bytes:
    """Return the four bytes of the colour that a material is named after.

    Return no bytes if the name is no colour, or if the material has another colour or a picture.
    """
    match = _COLORED.fullmatch(name)
    if match is None:
        return b""
    color = bytes.fromhex(match[1])
    is_its = material is None or material == Material(np.frombuffer(color, np.uint8) / _BYTE)
    return color if is_its else b""


_BYTE = 255


def with_materials(attributes: Attributes | None) -> Attributes | None:
    """Return the attributes with materials instead of face colours, which OBJ does not have."""
    if attributes is None or COLOR not in attributes.face:
        return attributes
    kinds, numbers = np.unique(attributes.face[COLOR], axis=0, return_inverse=True)
    names = [f"color_{bytes(kind).hex()}" for kind in kinds.tolist()]
    materials = {name: Material(kind / _BYTE) for name, kind in zip(names, kinds, strict=True)}
    rest = attributes.without({COLOR})
    face = {**rest.face, "material": np.array(names)[numbers.ravel()]}
    return replace(rest, face=face, materials=materials)


def _named_materials(attributes: Attributes) -> Values:
    """Return the material name of each face; an empty array if faces have no materials."""
    names = attributes.face.get("material")
    if names is not None and names.dtype.kind == "U" and names.ndim == 1:
        return names
    return np.array([], dtype=str)


def _whole_rows(values: Values) -> Values | None:
    """Return rows of numbers, where a row with a NaN becomes all NaN; None if every row has one."""
    is_known = ~np.isnan(values).any(axis=-1, keepdims=True)
    rows: Values = np.where(is_known, values, np.nan).astype(np.float64)
    return rows if is_known.any() else None


def _storable_names(names: set[str]) -> dict[str, str]:
    """Return a distinct name that OBJ can store for each of the given material names."""
    held = {"": ""}
    taken = {""}
    # Names that need no change come first, so that they stay as they are.
    for name in sorted(names - {""}, key=lambda name: (stored_name(name) != name, name)):
        fit = stored_name(name) or "_"
        # A material whose name looks like a colour must not be read back as a colour.
        fit = free = f"{fit}_" if _COLORED.fullmatch(fit) else fit
        number = 1
        while free in taken:
            number += 1
            free = f"{fit} ({number})"
        held[name] = free
        taken.add(free)
    return held


#: Attributes of corners that OBJ can store, and the number of their components.
_CORNERS = {"uv": 2, "normal": 3}


def companion_files(mesh: RawMesh, stem: str) -> tuple[bytes, dict[str, bytes]]:
    """Return an OBJ's statement that names the material library, and the companion files by name.

    Both are empty if there are no materials.
    """
    attributes = with_materials(attributes_or_none(mesh))
    if attributes is None or not attributes.materials:
        return b"", {}
    library, files = mtl.library_and_companions(attributes.materials, _escaped_stem(stem))
    return f"mtllib {library}\n".encode(), files


def _escaped_stem(stem: str) -> str:
    """Return the stem of a file with blanks and special characters escaped.

    Other programs take a name with a blank for two names. Distinct stems stay distinct.
    """
    return "".join(
        letter if letter.isprintable() and letter not in " #\\~" else f"~{ord(letter):02x}"
        for letter in stem
    )


def text(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the bytes of an OBJ file; every coordinate reads back as the same double."""
    attributes = with_materials(attributes_or_none(mesh))
    if represents_empty_set(mesh):
        yield EMPTY_SET
    if attributes is not None and "color" in attributes.vertex:
        for point in listed(np.concatenate([mesh.vertices, attributes.vertex["color"]], axis=1)):
            yield "v {!r} {!r} {!r} {!r} {!r} {!r}\n".format(*point).encode()
    else:
        yield from encoded_lines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in listed(mesh.vertices))
    if attributes is not None:
        yield from _text_with_attributes(mesh, attributes)
        return
    parts = parts_of(mesh)
    for name, faces in parts:
        if name or len(parts) > 1:
            yield f"o {stored_name(name)}\n".encode()
        corners = listed(faces + np.int64(1))
        yield from encoded_lines(f"f {a} {b} {c}\n" for a, b, c in corners)


def _text_with_attributes(mesh: Mesh | RawMesh, attributes: Attributes) -> Iterator[bytes]:
    numbers: dict[str, IndexArray] = {}
    for name, key in (("uv", "vt"), ("normal", "vn")):
        if attributes.kind_of(name) in ("vertex", "corner"):
            corners = attributes.at_corners(name).reshape(-1, _CORNERS[name])
            rows, inverse = np.unique(corners, axis=0, return_inverse=True)
            is_known = ~np.isnan(rows).any(axis=1)
            numbers[name] = np.where(is_known, np.cumsum(is_known), 0)[inverse].reshape(-1, 3)
            for row in rows[is_known].tolist():
                yield f"{key} {' '.join(map(repr, row))}\n".encode()
    names = attributes.face.get("material")
    current, start = "", 0
    parts = parts_of(mesh)
    for name, faces in parts:
        if name or len(parts) > 1:
            yield f"o {stored_name(name)}\n".encode()
        for row, face in enumerate(listed(faces), start):
            if names is not None and names[row] != current:
                current = str(names[row])
                yield f"usemtl {current}\n".encode()
            yield ("f " + " ".join(_corner(numbers, row, k, face[k]) for k in range(3))).encode()
            yield b"\n"
        start += len(faces)


def _corner(numbers: Mapping[str, IndexArray], row: int, corner: int, vertex: int) -> str:
    """Return a corner as OBJ writes it: the numbers of its vertex, texture coordinates, normal."""
    uv, normal = (_at(numbers.get(name), row, corner) for name in ("uv", "normal"))
    if normal:
        return f"{vertex + 1}/{uv}/{normal}"
    return f"{vertex + 1}/{uv}" if uv else f"{vertex + 1}"


def _at(numbers: IndexArray | None, row: int, corner: int) -> str:
    number = 0 if numbers is None else int(numbers[row, corner])
    return str(number) if number else ""
