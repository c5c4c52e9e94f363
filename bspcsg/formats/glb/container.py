"""Validation of a GLB file before anything is decoded: sizes, ranges, the tree of nodes."""

import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import Finding, FormatError
from ..source import Source

_MAGIC, _HEADER = b"glTF", 12
_JSON, _BINARY = b"JSON", b"BIN\0"

#: The numpy type of a component by glTF's number, and the components of an element by glTF's name.
COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
ELEMENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}

#: The largest number of triangles in a file, where a mesh counts once for each node that has it.
_MAX_TRIANGLES = 1 << 27

#: The largest number of ancestors that a node may have.
_MAX_NODE_DEPTH = 64

#: The extension that shows a node's mesh several times, with transformations from accessors.
_INSTANCES = "EXT_mesh_gpu_instancing"

#: Extensions that a file may require: those that are read here, and the first letters of the names
#: of those that change only the appearance.
_READ = (_INSTANCES, "KHR_mesh_quantization")
_APPEARANCE_PREFIXES = (
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "KHR_lights_",
    "EXT_lights_",
)

#: Extensions that compress data, and the advice on decompressing it.
_COMPRESSIONS = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
_DECOMPRESSION_ADVICE = " “gltf-transform copy in.glb out.glb” removes the compression."

#: Names, in messages, of vertex attributes that are not read, by the first letters of their keys.
_ATTRIBUTES = {
    "TANGENT": "tangents",
    "JOINTS_": "joints",
    "WEIGHTS_": "weights",
    "TEXCOORD_": "further texture coordinates",
    "COLOR_": "further colours",
}

#: glTF's numbers of the primitive modes that consist of triangles.
TRIANGLES, STRIP, FAN = 4, 5, 6


@dataclass(frozen=True, eq=False)
class Container:
    """The content of a GLB file whose JSON description has been validated.

    Parameters
    ----------
    tree : dict
        The JSON description.
    data : bytes
        The binary chunk, which contains the elements of accessors.
    findings : tuple of Finding
        Findings about primitives that are skipped: points, lines, and those without positions.
    dropped : tuple of str
        Kinds of data that are not read, as in `RawMesh.dropped`.
    """

    tree: dict[str, Any]
    data: bytes
    findings: tuple[Finding, ...]
    dropped: tuple[str, ...]


def container_of(source: Source) -> Container:
    """Return the JSON description and the binary data of a GLB file, validated.

    Raises
    ------
    FormatError
        If the file is cut off, is no GLB of version 2, or its description is inconsistent.
    """
    tree, data = _chunks(source)
    try:
        _DescriptionCheck(source, tree, len(data)).check()
        return Container(tree, data, _passed_by(tree), _dropped(tree))
    except FormatError:
        raise
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError) as error:
        reason = f"{type(error).__name__}: {error}"
        raise source.error(f"the JSON chunk of this GLB is not valid ({reason}).") from None


def _chunks(source: Source) -> tuple[dict[str, Any], bytes]:
    """Return the parsed JSON chunk and the bytes of the binary chunk of a GLB file."""
    data = source.data
    if len(data) < _HEADER + 8 or data[:4] != _MAGIC:
        raise source.error("the file is not a GLB: it does not begin with “glTF”.")
    version, length = (int.from_bytes(data[at : at + 4], "little") for at in (4, 8))
    if version != 2:
        raise source.error(f"the file is GLB of version {version}, but only version 2 can be read.")
    if length > len(data):
        message = f"the file is incomplete: it has {len(data)} bytes, but its header says {length}."
        raise source.error(message, "truncated", offset=len(data))
    found: dict[bytes, bytes] = {}
    at = _HEADER
    while at + 8 <= length:
        size, kind = int.from_bytes(data[at : at + 4], "little"), data[at + 4 : at + 8]
        if at + 8 + size > length:
            raise source.error(
                "a chunk extends beyond the end of the file, so the file is incomplete.",
                "truncated",
                offset=at,
            )
        found.setdefault(kind, data[at + 8 : at + 8 + size])
        at += 8 + size
    return _parsed(source, found.get(_JSON, b"")), found.get(_BINARY, b"")


def _parsed(source: Source, chunk: bytes) -> dict[str, Any]:
    try:
        tree = json.loads(chunk)
    except (ValueError, RecursionError) as error:
        raise source.error(f"the JSON chunk of this GLB is not valid JSON: {error}.") from None
    if not isinstance(tree, dict):
        raise source.error("the JSON chunk of this GLB is not a JSON object.")
    return tree


class _DescriptionCheck:
    """A check of a GLB file's JSON description against the length of its binary data.

    Parameters
    ----------
    source : Source
    tree : dict
        The JSON description.
    held : int
        Length of the binary chunk in bytes.
    """

    def __init__(self, source: Source, tree: dict[str, Any], data_bytes: int) -> None:
        self._source = source
        self._tree = tree
        self._data_bytes = data_bytes

    def check(self) -> None:
        """Raise a `FormatError` if the description has an error that would break decoding."""
        for extension in self._tree.get("extensionsRequired", []):
            if extension not in _READ and not extension.startswith(_APPEARANCE_PREFIXES):
                message = (
                    f"the file requires the glTF extension {extension}, which is not supported."
                )
                raise self._source.error(message + _conversion_advice(extension), "unsupported")
        for number, buffer in enumerate(self._tree.get("buffers", [])):
            if "uri" in buffer:
                is_text = str(buffer["uri"]).startswith("data:")
                where = "as text in the JSON chunk" if is_text else "in another file"
                message = (
                    f"the mesh data are stored {where}, which is not supported; pack all data into"
                    " the binary chunk of the GLB."
                )
                raise self._source.error(message, "unsupported")
            if number > 0 or not 0 <= buffer["byteLength"] <= self._data_bytes:
                message = (
                    f"buffer {number} needs more bytes than the {self._data_bytes} bytes of the"
                    " binary chunk."
                )
                raise self._source.error(message, "truncated")
        for number, accessor in enumerate(self._tree.get("accessors", [])):
            self._check_accessor(number, accessor)
        self._check_nodes(self._tree.get("nodes", []))

    def _entry(self, kind: str, index: Any) -> dict[str, Any]:
        """Return entry `index` of the list `kind`; a negative or too large index is an error."""
        entries: list[dict[str, Any]] = self._tree.get(kind, [])
        if type(index) is not int or not 0 <= index < len(entries):
            message = (
                f"the JSON chunk refers to entry {index} of “{kind}”, which has only"
                f" {len(entries)} entries."
            )
            raise self._source.error(message, "index_out_of_range")
        return entries[index]

    def _check_accessor(self, number: int, accessor: dict[str, Any]) -> None:
        """Raise a `FormatError` if elements of an accessor lie outside the binary data."""
        count, element = accessor["count"], _bytes_of(accessor)
        if "bufferView" in accessor:
            self._check_elements(number, accessor, count, element)
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            if sparse["count"] > count:
                message = (
                    f"accessor {number} has more sparse values ({sparse['count']}) than elements"
                    f" ({count})."
                )
                raise self._source.error(message)
            places = sparse["indices"]
            self._check_elements(number, places, sparse["count"], _bytes_of(places, "SCALAR"))
            self._check_elements(number, sparse["values"], sparse["count"], element)

    def _check_elements(
        self, number: int, accessor: dict[str, Any], count: int, element: int
    ) -> None:
        view = self._entry("bufferViews", accessor["bufferView"])
        self._entry("buffers", view["buffer"])
        start, length = view.get("byteOffset", 0), view["byteLength"]
        offset, stride = accessor.get("byteOffset", 0), view.get("byteStride") or element
        needed = offset + max(count - 1, 0) * stride + (count and element)
        if min(start, length, offset, stride, count) < 0 or start + length > self._data_bytes:
            message = (
                f"accessor {number} refers to bytes outside the {self._data_bytes} bytes of the"
                " binary chunk."
            )
            raise self._source.error(message, "truncated")
        if stride < element:
            message = (
                f"the elements of accessor {number} overlap: the stride is {stride} bytes, but"
                f" each element has {element}."
            )
            raise self._source.error(message)
        if needed > length:
            message = (
                f"accessor {number} has {count} elements according to its count, but its buffer"
                " view has bytes for fewer."
            )
            raise self._source.error(message, "truncated")

    def _used(self, number: Any) -> dict[str, Any]:
        """Return the accessor `number`; one that has no data to decode is an error."""
        accessor = self._entry("accessors", number)
        if "bufferView" in accessor:
            return accessor
        if "sparse" not in accessor:
            # An accessor has no buffer view if an extension has compressed its data, too.
            used = self._tree.get("extensionsUsed", [])
            packing = next((one for one in used if one in _COMPRESSIONS), "")
            message = f"accessor {number} has no data that can be read; they may be compressed."
            raise self._source.error(message + _conversion_advice(packing), "unsupported")
        zeros = accessor["count"] * _bytes_of(accessor)
        if not 0 <= zeros <= self._data_bytes:
            # Zeros take no bytes in the file, so its length does not limit their number.
            message = (
                f"accessor {number} has no data and stands for {zeros} bytes of zeros, more than"
                " the whole binary chunk."
            )
            raise self._source.error(message, "too_large")
        return accessor

    def _check_nodes(self, nodes: list[dict[str, Any]]) -> None:
        """Raise a `FormatError` if a node has several parents, or depth or triangles are too many.

        Nodes with several parents would allow cycles and huge scenes.
        """
        parents = [-1] * len(nodes)
        for number, node in enumerate(nodes):
            for child in node.get("children", []):
                if child < 0 or parents[child] != -1:
                    raise self._source.error(
                        f"node {child} has several parents, or a negative index; each node may"
                        " have one parent.",
                        "too_large",
                    )
                parents[child] = number
        for number in range(len(nodes)):
            steps, above = 0, number
            while (above := parents[above]) != -1:
                steps += 1
                if steps > _MAX_NODE_DEPTH:
                    message = (
                        f"the nodes are nested deeper than {_MAX_NODE_DEPTH} levels, or form a"
                        " cycle."
                    )
                    raise self._source.error(message, "too_large")
        shown = sum(self._triangles_of(node) for node in nodes)
        if shown > _MAX_TRIANGLES:
            raise self._source.error(
                f"the nodes contain {shown} triangles in all, more than the limit of"
                f" {_MAX_TRIANGLES}.",
                "too_large",
            )

    def _triangles_of(self, node: dict[str, Any]) -> int:
        if "mesh" not in node:
            return 0
        total = 0
        times = self._times(node)
        for primitive in self._entry("meshes", node["mesh"])["primitives"]:
            mode = primitive.get("mode", TRIANGLES)
            if _lacks_positions(primitive):
                continue
            if "material" in primitive:
                self._entry("materials", primitive["material"])
            for accessor in primitive["attributes"].values():
                self._used(accessor)
            if mode in (TRIANGLES, STRIP, FAN):
                corners = primitive.get("indices", primitive["attributes"]["POSITION"])
                count = self._used(corners)["count"]
                total += count // 3 if mode == TRIANGLES else count
        return total * times

    def _times(self, node: dict[str, Any]) -> int:
        """Return how often a node shows its mesh: once, or once for each of its instances."""
        told = instances_of(node)
        if told is None:
            return 1
        counts = {self._used(accessor)["count"] for accessor in told.values()}
        if len(counts) != 1:
            raise ValueError(
                "the instancing attributes of a node (TRANSLATION, ROTATION, SCALE) have"
                " different lengths"
            )
        return int(counts.pop())


def _conversion_advice(extension: str) -> str:
    """Return advice on how to convert a file that needs an extension, or an empty string."""
    return _DECOMPRESSION_ADVICE if extension in _COMPRESSIONS else ""


def _bytes_of(accessor: dict[str, Any], shape: str = "") -> int:
    """Return the number of bytes of an accessor's element; `shape` replaces the accessor's type."""
    return (
        np.dtype(COMPONENTS[accessor["componentType"]]).itemsize
        * ELEMENTS[shape or accessor["type"]]
    )


def instances_of(node: dict[str, Any]) -> dict[str, Any] | None:
    """Return the accessor numbers of a node's instances by key; None if it has no instances."""
    told = node.get("extensions", {}).get(_INSTANCES)
    return None if told is None else dict(told["attributes"])


def _lacks_positions(primitive: dict[str, Any]) -> bool:
    """Say whether a primitive has no vertex positions: readers skip it (glTF 2.0, 3.7.2.1)."""
    return "POSITION" not in primitive["attributes"]


def _dropped(tree: dict[str, Any]) -> tuple[str, ...]:
    """Return the names of the kinds of data in a GLB file that are not read, sorted."""
    found = {key for key in ("animations", "skins") if tree.get(key)}
    for primitive in _primitives(tree):
        if primitive.get("targets"):
            found.add("morph targets")
        unread = set(primitive["attributes"]) - {uv_of(tree, primitive), "COLOR_0"}
        for start, what in _ATTRIBUTES.items():
            if any(name.startswith(start) for name in unread):
                found.add(what)
    for material in tree.get("materials", []):
        if "KHR_texture_transform" in picture_of(material).get("extensions", {}):
            found.add("texture transforms")
    return tuple(sorted(found))


def _primitives(tree: dict[str, Any]) -> list[dict[str, Any]]:
    return [primitive for mesh in tree.get("meshes", []) for primitive in mesh["primitives"]]


def picture_of(material: dict[str, Any]) -> dict[str, Any]:
    """Return the texture reference of a material's base colour; an empty dict if there is none."""
    told: dict[str, Any] = material.get("pbrMetallicRoughness", {}).get("baseColorTexture", {})
    return told


def uv_of(tree: dict[str, Any], primitive: dict[str, Any]) -> str:
    """Return the attribute, such as “TEXCOORD_0”, that a primitive's base colour texture uses."""
    materials, number = tree.get("materials", []), primitive.get("material", -1)
    told = picture_of(materials[number]) if 0 <= number < len(materials) else {}
    return f"TEXCOORD_{told.get('texCoord', 0)}"


def _passed_by(tree: dict[str, Any]) -> tuple[Finding, ...]:
    primitives = _primitives(tree)
    nowhere = [primitive for primitive in primitives if _lacks_positions(primitive)]
    modes = [one.get("mode", TRIANGLES) for one in primitives if not _lacks_positions(one)]
    lines = sum(mode not in (TRIANGLES, STRIP, FAN) for mode in modes)
    told = (
        (lines, "groups of points or lines"),
        (len(nowhere), "primitives without vertex positions"),
    )
    return tuple(
        Finding("ignored", "warning", f"{count} {what} were ignored.", (), count)
        for count, what in told
        if count
    )
