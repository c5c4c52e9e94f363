"""Reading of one model part of a 3MF package: objects, build items and properties."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TypeAlias
from xml.parsers import expat

import numpy as np

from ..._types import FloatArray, IndexArray
from ...attributes.colours import one_color, opaque
from ...errors import FormatError, message_of
from ..source import Source, quoted

#: Millimetres in each unit that a model may name.
MILLIMETRES = {
    "micron": 0.001,
    "millimeter": 1.0,
    "centimeter": 10.0,
    "inch": 25.4,
    "foot": 304.8,
    "meter": 1000.0,
}

#: The part number of an object that has one component and gives it another name.
INSTANCE = "bspcsg:instance"

#: XML elements that are not read, and the names of their data in `RawMesh.dropped`.
_DROPPED = {
    "composite": "materials",
    "multi": "layers of properties",
    "metadata": "metadata",
}

#: Words in the namespaces of extensions that are read here, or whose unread data are reported. A
#: model that requires another extension is refused.
_READ = (
    "/material/",
    "/production/2015",
    "/booleanoperations/2023",
    "/beamlattice/",
    "/trianglesets/",
)

#: Kinds of objects that are no material, by the metadata in which Cura names them.
_CURA = {
    "cura:anti_overhang_mesh": "support blocker",
    "cura:support_mesh": "support",
    "cura:infill_mesh": "modifier",
    "cura:cutting_mesh": "modifier",
}

#: The number of XML attributes of a triangle that has no properties.
_BARE = 3

#: The name of a base material, and its colour in bytes.
Base: TypeAlias = tuple[str, tuple[int, ...]]

Start: TypeAlias = Callable[[str, dict[str, str]], None]

#: A function that takes the name and the text of a metadata element.
Metadata: TypeAlias = Callable[[str, str], None]


@dataclass(frozen=True, eq=False)
class PlacedObject:
    """A reference to an object, in the same part of a 3MF package or another, with a transform.

    Parameters
    ----------
    path : str
        Name of the part that has the object; empty for the part that has the reference.
    item : str
        Id of the object.
    transform : (4, 3) float64
        Acts on row vectors.
    """

    path: str
    item: str
    transform: FloatArray


@dataclass(frozen=True, eq=False)
class BooleanShape:
    """A solid made of other shapes by an operation.

    Parameters
    ----------
    operation : {"union", "difference", "intersection"}
        Applied to the base and the first operand, then to the result and the next operand.
    base : PlacedObject
    operands : list of PlacedObject
    is_optional : bool
        True if the base is used instead when the shape cannot be made.
    """

    operation: str
    base: PlacedObject
    operands: list[PlacedObject]
    is_optional: bool = False


@dataclass(eq=False)
class Object:
    """An object of a 3MF model: a mesh, a boolean shape, components, or empty.

    `usual` is the property group and index of triangles without properties of their own;
    `properties` are those of single triangles, by number: the group, and an index for each corner.
    """

    kind: str
    vertices: list[tuple[float, float, float]] = field(default_factory=list)
    triangles: list[tuple[int, int, int]] = field(default_factory=list)
    components: list[PlacedObject] = field(default_factory=list)
    shape: BooleanShape | None = None
    beams: int = 0
    name: str = ""
    part_number: str = ""
    usual: tuple[str, int] | None = None
    properties: dict[int, tuple[str, tuple[int, ...]]] = field(default_factory=dict)

    @property
    def is_body(self) -> bool:
        """True if the object is a mesh or a boolean shape."""
        return bool(self.triangles) or self.shape is not None

    def arrays(self) -> tuple[FloatArray, IndexArray]:
        """Return vertices (n, 3) float64 and triangles (m, 3) int64 of the mesh."""
        vertices = np.array(self.vertices, dtype=np.float64).reshape(-1, 3)
        return vertices, np.array(self.triangles, dtype=np.int64).reshape(-1, 3)


@dataclass(eq=False)
class ModelPart:
    """The content of one model part of a 3MF package.

    Objects and groups of properties are dictionaries by id. `textures` has the package part of each
    texture, and `coordinates` has groups of texture coordinates, each with the id of its texture.
    """

    unit: str = "millimeter"
    objects: dict[str, Object] = field(default_factory=dict)
    items: list[PlacedObject] = field(default_factory=list)
    dropped: set[str] = field(default_factory=set)
    colors: dict[str, list[tuple[int, ...]]] = field(default_factory=dict)
    bases: dict[str, list[Base]] = field(default_factory=dict)
    textures: dict[str, str] = field(default_factory=dict)
    coordinates: dict[str, tuple[str, list[tuple[float, float]]]] = field(default_factory=dict)


def parse_xml(
    source: Source,
    chunks: Iterable[bytes],
    start: Start,
    spaces: dict[str, str] | None = None,
    metadata: Metadata | None = None,
) -> None:
    """Parse XML: call `start` with name (without namespace) and attributes of each element.

    Elements are skipped unless their namespace is that of the root or of a supported extension,
    since their names have other meanings in other namespaces.

    Parameters
    ----------
    source : Source
        The source that errors name.
    chunks : iterable of bytes
        The XML.
    start : callable
    spaces : dict of str to str, optional
        Receives the namespaces by prefix, each before the element that declares it.
    metadata : callable, optional
        Called with name and text of each metadata element.

    Raises
    ------
    FormatError
        If the XML is not well-formed, or declares a document type or an unknown encoding.
    """
    parser = expat.ParserCreate(namespace_separator=" ")

    known: dict[str, bool] = {}

    def begin(tag: str, attributes: dict[str, str]) -> None:
        space, _, element = tag.rpartition(" ")
        if space not in known:
            known[space] = not known or any(word in space for word in _READ)
        if not known[space]:
            return
        named = {name.rpartition(" ")[2]: value for name, value in attributes.items()}
        try:
            start(element, named)
        except (KeyError, ValueError, OverflowError) as error:
            reason = (
                f"the attribute “{error.args[0]}” is missing"
                if isinstance(error, KeyError)
                else error
            )
            message = f"the element {quoted(element.encode())} is not valid: {reason}."
            raise source.error(message, line=parser.CurrentLineNumber) from None
        if element == "metadata" and metadata is not None:
            _listen(parser, named.get("name", ""), metadata)

    def refuse(*_: object) -> None:
        raise source.error(
            "the XML has a document type declaration, which is not supported; save it without.",
            line=parser.CurrentLineNumber,
        )

    def declare(prefix: str | None, space: str | None) -> None:
        if spaces is not None:
            spaces[prefix or ""] = space or ""

    parser.StartElementHandler = begin
    parser.StartNamespaceDeclHandler = declare
    parser.StartDoctypeDeclHandler = refuse
    try:
        for chunk in chunks:
            parser.Parse(chunk, False)
        parser.Parse(b"", True)
    except expat.ExpatError as error:
        message = f"the XML is not well-formed: {expat.ErrorString(error.code)}."
        raise source.error(message, line=error.lineno) from None
    except FormatError:
        raise
    except (LookupError, ValueError) as error:  # from decoding: `begin` turns its own into others
        raise source.error(f"the XML cannot be decoded: {message_of(error)}.", line=1) from error


def _listen(parser: expat.XMLParserType, name: str, metadata: Metadata) -> None:
    """Collect the text of the element that has just begun, and pass name and text to `metadata`."""
    words: list[str] = []

    def end(_: str) -> None:
        parser.CharacterDataHandler = parser.EndElementHandler = None
        metadata(name, "".join(words))

    parser.CharacterDataHandler = words.append
    parser.EndElementHandler = end


class PartReader:
    """A reader that makes a `ModelPart` of the XML of a 3MF package's model part.

    Parameters
    ----------
    source : Source
        The source that errors name.
    chunks : iterable of bytes
        The XML.
    part_name : callable
        Turns a path in the XML into the name of a part.
    """

    def __init__(
        self, source: Source, chunks: Iterable[bytes], part_name: Callable[[str], str]
    ) -> None:
        self._source = source
        self._chunks = chunks
        self._part_name = part_name
        self._part = ModelPart()
        self._current = Object("none")
        self._group = ""
        self._spaces: dict[str, str] = {}
        self._needs: list[str] = []

    def read(self) -> ModelPart:
        """Parse the XML and return the part.

        Raises
        ------
        FormatError
            If the part is no valid XML or no valid model, or requires an unsupported extension.
        """
        parse_xml(self._source, self._chunks, self._start, self._spaces, self._hear)
        for space in self._needs:
            if not any(word in space for word in _READ):
                message = f"the model requires the 3MF extension {space}, which is not supported."
                raise self._source.error(message, "unsupported")
        for number, held in self._part.objects.items():
            top = max(map(max, held.triangles), default=-1)
            if top >= len(held.vertices):
                raise self._bad_index(number, top, len(held.vertices))
        return self._part

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        # The two most frequent elements come first.
        if tag == "vertex":
            self._current.vertices.append(_point(attributes))
        elif tag == "triangle":
            if len(attributes) > _BARE:
                self._current.properties[len(self._current.triangles)] = self._named(attributes)
            self._current.triangles.append(_triangle(attributes))
        elif tag == "component":
            self._current.components.append(self._placed(attributes))
        elif tag == "item":
            self._part.items.append(self._placed(attributes))
        elif tag == "object":
            kind, name = attributes.get("type", "model"), attributes.get("name", "")
            self._current = Object(kind, name=name, part_number=attributes.get("partnumber", ""))
            if "pid" in attributes:
                self._current.usual = attributes["pid"], int(attributes.get("pindex", "0"))
            if attributes["id"] in self._part.objects:
                raise ValueError(f"two objects have the number {attributes['id']}")
            self._part.objects[attributes["id"]] = self._current
        elif tag == "model":
            self._part.unit = attributes.get("unit", "millimeter")
            if self._part.unit not in MILLIMETRES:
                raise ValueError(f"its unit {self._part.unit} is unknown")
            prefixes = attributes.get("requiredextensions", "").split()
            # No element can belong to an extension without a declared prefix.
            self._needs = [self._spaces[one] for one in prefixes if one in self._spaces]
        elif tag in ("booleanshape", "boolean"):
            self._combine(tag, attributes)
        elif tag == "build":
            # The elements that follow belong to no object.
            self._current = Object("none")
        else:
            self._note(tag, attributes)

    def _hear(self, name: str, text: str) -> None:
        """Read a metadata element: Cura marks objects that are no material by such elements."""
        if name in _CURA and text.strip().lower() == "true":
            self._current.kind = _CURA[name]

    def _combine(self, tag: str, attributes: dict[str, str]) -> None:
        """Read an element “booleanshape”, or “boolean”, which is an operand of such a shape."""
        placed = self._placed(attributes)
        if tag == "boolean":
            if self._current.shape is None:
                raise ValueError("it is not inside a boolean shape")
            self._current.shape.operands.append(placed)
            return
        operation = attributes.get("operation", "union")
        if operation not in ("union", "difference", "intersection"):
            raise ValueError(f"its operation {operation} is not union, difference or intersection")
        self._current.shape = BooleanShape(operation, placed, [])

    def _note(self, tag: str, attributes: dict[str, str]) -> None:
        """Read an element about properties: colours, base materials, textures; and count beams."""
        if tag in ("colorgroup", "basematerials"):
            self._group = attributes["id"]
        elif tag == "color":
            self._part.colors.setdefault(self._group, []).append(_color(attributes["color"]))
        elif tag == "base":
            base = attributes.get("name", ""), _color(attributes["displaycolor"])
            self._part.bases.setdefault(self._group, []).append(base)
        elif tag == "texture2d":
            self._part.textures[attributes["id"]] = self._part_name(attributes["path"])
        elif tag == "texture2dgroup":
            self._group = attributes["id"]
            self._part.coordinates[self._group] = attributes["texid"], []
        elif tag == "tex2coord":
            self._part.coordinates[self._group][1].append(_place(attributes))
        elif tag in _DROPPED:
            self._part.dropped.add(_DROPPED[tag])
        self._current.beams += tag == "beam"

    def _named(self, attributes: dict[str, str]) -> tuple[str, tuple[int, ...]]:
        """Return the property group of a triangle, and the property index at each corner."""
        usual = self._current.usual or ("", 0)
        group = attributes.get("pid", usual[0])
        first = attributes.get("p1")
        if first is None:
            return group, (usual[1],) * 3
        named = (first, attributes.get("p2", first), attributes.get("p3", first))
        return group, tuple(map(int, named))

    def _placed(self, attributes: dict[str, str]) -> PlacedObject:
        path = attributes.get("path", "")
        words = attributes.get("transform", "1 0 0 0 1 0 0 0 1 0 0 0").split()
        _refuse_underscores(words)
        matrix = np.array([float(word) for word in words])
        if len(matrix) != 12 or not np.isfinite(matrix).all():
            raise ValueError("a transform needs 12 finite numbers")
        name = self._part_name(path) if path else ""
        return PlacedObject(name, attributes["objectid"], matrix.reshape(4, 3))

    def _bad_index(self, number: str, index: int, count: int) -> FormatError:
        message = (
            f"a triangle of object {number} has the vertex index {index}, but the object has"
            f" {count} vertices."
        )
        return self._source.error(message, "index_out_of_range")


def _color(text: str) -> tuple[int, ...]:
    """Convert a hexadecimal colour to red, green, blue and opacity, from 0 to 255."""
    found: list[int] = opaque(one_color(text)).tolist()
    return tuple(found)


def _point(attributes: dict[str, str]) -> tuple[float, float, float]:
    words = attributes["x"], attributes["y"], attributes["z"]
    _refuse_underscores(words)
    point = float(words[0]), float(words[1]), float(words[2])
    if not all(abs(value) < float("inf") for value in point):
        raise ValueError("coordinates must be finite")
    return point


def _place(attributes: dict[str, str]) -> tuple[float, float]:
    """Return the texture coordinates (u, v) of a “tex2coord” element."""
    words = attributes["u"], attributes["v"]
    _refuse_underscores(words)
    u, v = float(words[0]), float(words[1])
    if not (abs(u) < float("inf") and abs(v) < float("inf")):
        raise ValueError("texture coordinates must be finite")
    return u, v


def _refuse_underscores(words: Iterable[str]) -> None:
    """Raise a `ValueError` if a word has an underscore: Python would read ``1_0`` as 10."""
    if "_" in "".join(words):
        raise ValueError("a number contains “_”, which is not allowed")


def _triangle(attributes: dict[str, str]) -> tuple[int, int, int]:
    words = attributes["v1"], attributes["v2"], attributes["v3"]
    _refuse_underscores(words)
    corners = int(words[0]), int(words[1]), int(words[2])
    if min(corners) < 0:
        raise ValueError("a vertex index is negative")
    return corners
