"""Reading and writing GLB, the binary form of glTF 2.0: metres, y upwards, single precision.

The matrix of each written node converts the model's millimetres with z upwards to metres, so
coordinates are stored unscaled: numbers of single precision read back unchanged. Objects may have
equal names, so every object is a node with a mesh of its own.
"""

import json
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from ..._types import FloatArray, IndexArray
from ...attributes.attributes import Attributes, Values
from ...errors import Finding
from ...mesh.mesh import Mesh
from .. import single_precision
from ..mesh_placement import PlacedMesh, is_exact, placed_meshes
from ..raw import RawMesh, compacted, parts_of, represents_empty_set
from ..source import Source
from ..storable_attributes import attributes_or_none
from .attribute_conversion import Pictures, columns_of, dropped_pictures, stored_name
from .container import container_of
from .nodes import NodeMesh, visible_meshes

#: Matrices for column vectors from millimetres with z upwards to metres with y upwards, and back.
TO_METRES = np.array(
    [[0.001, 0, 0, 0], [0, 0, 0.001, 0], [0, -0.001, 0, 0], [0, 0, 0, 1]], dtype=np.float64
)
TO_MILLIMETRES = np.array(
    [[1000, 0, 0, 0], [0, 0, -1000, 0], [0, 1000, 0, 0], [0, 0, 0, 1]], dtype=np.float64
)

#: Numbers in glTF that stand for component types and for the purpose of a buffer view.
_FLOAT, _UNSIGNED, _VERTICES, _INDICES = 5126, 5125, 34962, 34963
_WORD = 5123


def read(source: Source) -> RawMesh:
    """Read the triangles of all nodes of the scene as one mesh, in millimetres with z upwards.

    Raises
    ------
    FormatError
        If the file is cut off, is no GLB of version 2, or has content that cannot be read.
    """
    container = container_of(source)
    try:
        objects, hidden = visible_meshes(container)
    except IndexError as error:
        raise source.error(f"{error}.", "index_out_of_range") from error
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise source.error(f"this GLB cannot be decoded: {error}.") from error
    mesh = placed_meshes([_placed(one) for one in objects if len(one.faces)])
    if not np.isfinite(mesh.vertices).all():
        raise source.error("a coordinate is not a finite number.", "non_finite")
    findings = (*mesh.findings, *container.findings, *_hidden(hidden), _unit())
    dropped = (*container.dropped, *dropped_pictures(container.tree, container.data))
    return replace(mesh, findings=findings, unit="mm", dropped=dropped)


def _placed(one: NodeMesh) -> PlacedMesh:
    """Return a node's mesh and its map to millimetres; mirrored triangles are reversed."""
    placing = TO_MILLIMETRES @ one.matrix
    linear = placing[:3, :3]
    with np.errstate(invalid="ignore", over="ignore"):
        size = np.linalg.det(linear)
        attributes = None if one.attributes is None else one.attributes.turned(linear)
        keeps = size == 0 or is_exact(one.vertices, linear, placing[:3, 3])
    faces = one.faces
    if size < 0:
        faces, attributes = faces[:, ::-1], attributes and attributes.reordered([2, 1, 0])
    own = RawMesh(one.vertices.astype(np.float64), faces, one.name, attributes=attributes)
    return PlacedMesh(own, partial(_moved, matrix=placing), keeps, placing.tobytes())


def _moved(vertices: FloatArray, matrix: FloatArray) -> FloatArray:
    x, y, z = vertices.T
    # No matrix product: if a row has only one nonzero entry, the result must be exact.
    with np.errstate(invalid="ignore", over="ignore"):  # not finite: refused later
        rows = [row[0] * x + row[1] * y + row[2] * z + row[3] for row in matrix[:3]]
    return np.stack(rows, axis=1)


def _hidden(count: int) -> tuple[Finding, ...]:
    if not count:
        return ()
    message = f"{count} meshes that are not part of the scene were ignored."
    return (Finding("ignored", "warning", message, (), count),)


def _unit() -> Finding:
    message = (
        "GLB uses metres with the y axis up; coordinates were converted to millimetres with the z"
        " axis up."
    )
    return Finding("unit", "note", message, (), 1)


def most_bytes(mesh: Mesh | RawMesh) -> int:
    """Return an upper bound of the bytes of vertices and indices; objects share no vertices."""
    vertices = min(3 * len(mesh.faces), len(mesh.vertices) * len(parts_of(mesh)))
    return 12 * (len(mesh.faces) + vertices)


def size_problem(mesh: Mesh | RawMesh) -> str:
    """Return why a mesh is too large for GLB, or an empty string if it fits."""
    is_beyond = most_bytes(mesh) > np.iinfo(np.uint32).max
    return (
        (
            "the mesh has too many triangles for GLB, whose size is limited to 4 GiB; write 3MF"
            " instead."
        )
        if is_beyond
        else ""
    )


def binary(mesh: Mesh | RawMesh) -> Iterator[bytes]:
    """Yield the bytes of a GLB file; coordinates are rounded to single precision."""
    attributes = attributes_or_none(mesh)
    if attributes is not None:
        yield from _with_attributes(mesh, attributes)
        return
    described = Description(represents_empty_set(mesh))
    blocks = []
    for name, faces in parts_of(mesh):
        if len(faces) == 0:
            continue
        used, corners = compacted(faces)
        vertices = mesh.vertices[used].astype("<f4")
        described.add(name, vertices, len(faces))
        blocks += [vertices.tobytes(), corners.astype("<u4").tobytes()]
    yield from container(described.text(), blocks)


def _with_attributes(mesh: Mesh | RawMesh, attributes: Attributes) -> Iterator[bytes]:
    """Yield the bytes of a GLB file; a vertex whose corners differ in an attribute is split."""
    described = Description(False)
    pictures = Pictures(attributes.materials, described.append)
    start = 0
    for name, faces in parts_of(mesh):
        rows = np.arange(start, start + len(faces))
        start += len(faces)
        if len(faces):
            primitives = described.append_mesh(
                mesh.vertices, faces, attributes.for_faces(rows), pictures
            )
            described.add_object(name, primitives)
    further = pictures.described()
    yield from container(described.text(further), described.blocks)


def _divided(faces: IndexArray, columns: dict[str, Values]) -> tuple[IndexArray, IndexArray]:
    """Split the vertices of triangles (m, 3) whose corners differ in the values of a column.

    Return the number, from 0 to 3 m - 1, of one corner for each new vertex, and the triangles as
    indices of the new vertices.
    """
    blocks = [faces.reshape(-1, 1).astype("<i8").view(np.uint8)]
    for values in columns.values():
        flat = np.ascontiguousarray(values).reshape(len(blocks[0]), -1)
        blocks.append(flat.view(np.uint8).reshape(len(flat), -1))
    rows = np.ascontiguousarray(np.concatenate(blocks, axis=1))
    keys = rows.view(f"V{rows.shape[1]}").ravel()
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    return first, inverse.reshape(-1, 3)


def _runs(names: Values | None, count: int) -> list[tuple[int, int, str]]:
    """Return (begin, end, material name) for each run of consecutive triangles of one material."""
    if names is None:
        return [(0, count, "")]
    starts = [0, *(np.flatnonzero(names[1:] != names[:-1]) + 1).tolist()]
    ends = [*starts[1:], count]
    return [(begin, end, str(names[begin])) for begin, end in zip(starts, ends, strict=True)]


class Description:
    """The JSON description of a GLB file, built object by object."""

    def __init__(self, is_empty_set: bool) -> None:
        self._extras = {"extras": {"bspcsg": "the empty set"}} if is_empty_set else {}
        self._size = 0
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._names: list[dict[str, str]] = []
        self._primitives: list[list[dict[str, Any]]] = []
        self.blocks: list[bytes] = []

    def add(self, name: str, vertices: "np.ndarray[Any, Any]", triangles: int) -> None:
        """Describe an object; the caller writes its vertices, then its indices, to the data."""
        self._names.append({"name": stored_name(name)} if name else {})
        self._primitives.append([_primitive(len(self._names) - 1)])
        low, high = vertices.min(axis=0).tolist(), vertices.max(axis=0).tolist()
        self._append(12 * len(vertices), _VERTICES, len(vertices), _FLOAT, "VEC3")
        self._accessors[-1] |= {"min": low, "max": high}
        self._append(12 * triangles, _INDICES, 3 * triangles, _UNSIGNED, "SCALAR")

    def _append(self, size: int, target: int, count: int, component: int, kind: str) -> None:
        view = {"buffer": 0, "byteOffset": self._size, "byteLength": size, "target": target}
        self._views.append(view)
        self._size += size
        accessor = {"bufferView": len(self._views) - 1, "componentType": component}
        self._accessors.append({**accessor, "count": count, "type": kind})

    def add_object(self, name: str, primitives: list[dict[str, Any]]) -> None:
        """Describe an object that consists of primitives from `append_mesh`."""
        self._names.append({"name": stored_name(name)} if name else {})
        self._primitives.append(primitives)

    def append(self, data: bytes) -> int:
        """Append bytes to the binary data, and return the number of their buffer view."""
        view = {"buffer": 0, "byteOffset": self._size, "byteLength": len(data)}
        self._views.append(view)
        self.blocks.append(data + bytes(-len(data) % 4))
        self._size += len(self.blocks[-1])
        return len(self._views) - 1

    def append_mesh(
        self, points: FloatArray, faces: IndexArray, attributes: Attributes, pictures: Pictures
    ) -> list[dict[str, Any]]:
        """Append triangles with attributes to the data; return a primitive for each material."""
        columns = columns_of(attributes, np.arange(len(faces)))
        first, corners = _divided(faces, columns)
        vertices = points[faces.ravel()[first]].astype("<f4")
        accessors = {"POSITION": self.append_column(vertices, with_bounds=True)}
        for key, values in columns.items():
            flat = values.reshape(3 * len(faces), *values.shape[2:])
            accessors[key] = self.append_column(flat[first])
        primitives = []
        for begin, end, material in _runs(attributes.face.get("material"), len(faces)):
            indices = self.append_indices(corners[begin:end])
            painted = {"material": pictures.numbers[material]} if material else {}
            primitives.append({"attributes": accessors, "indices": indices, "mode": 4, **painted})
        return primitives

    def append_column(self, values: Values, with_bounds: bool = False) -> int:
        """Append an array of vertex values to the data, and return the number of its accessor."""
        little = np.ascontiguousarray(values, values.dtype.newbyteorder("<"))
        width = 1 if values.ndim == 1 else values.shape[1]
        whole = {"componentType": _WORD, "normalized": True}
        kind = whole if values.dtype == np.uint16 else {"componentType": _FLOAT}
        accessor: dict[str, Any] = {"bufferView": self.append(little.tobytes()), **kind}
        self._views[-1]["target"] = _VERTICES
        accessor["count"] = len(values)
        accessor["type"] = "SCALAR" if width == 1 else f"VEC{width}"
        if with_bounds:
            accessor |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def append_indices(self, corners: IndexArray) -> int:
        """Append triangles to the data as vertex indices; return the number of their accessor."""
        view = self.append(corners.astype("<u4").tobytes())
        self._views[view]["target"] = _INDICES
        accessor = {"bufferView": view, "componentType": _UNSIGNED, "count": corners.size}
        self._accessors.append({**accessor, "type": "SCALAR"})
        return len(self._accessors) - 1

    def _separate_nodes(self) -> list[dict[str, Any]]:
        """Return a node for each object, in metres with y upwards."""
        matrix = TO_METRES.T.ravel().tolist()
        return [
            {**named, "mesh": number, "matrix": matrix} for number, named in enumerate(self._names)
        ]

    def text(
        self, further: dict[str, Any] | None = None, nodes: list[dict[str, Any]] | None = None
    ) -> bytes:
        """Return the JSON description as UTF-8 bytes.

        Parameters
        ----------
        further : dict, optional
            More entries at the top level, such as materials.
        nodes : list of dict, optional
            A tree of nodes as glTF has them, the root first; by default a root for each object.
        """
        roots = [0]
        if nodes is None:
            roots, nodes = list(range(len(self._names))), self._separate_nodes()
        asset = {"version": "2.0", "generator": "bspcsg", **self._extras}
        tree: dict[str, Any] = {"asset": asset, "scene": 0}
        tree["scenes"] = [{"nodes": roots} if self._names else {}]
        if self._names:
            tree["nodes"] = nodes
            tree["meshes"] = [
                {**named, "primitives": self._primitives[number]}
                for number, named in enumerate(self._names)
            ]
            tree["accessors"] = self._accessors
            tree["bufferViews"] = self._views
            tree["buffers"] = [{"byteLength": self._size}]
            tree |= further or {}
        return json.dumps(tree, separators=(",", ":"), ensure_ascii=False).encode()


def _primitive(number: int) -> dict[str, Any]:
    return {"attributes": {"POSITION": 2 * number}, "indices": 2 * number + 1, "mode": 4}


def container(description: bytes, blocks: list[bytes]) -> Iterator[bytes]:
    """Yield a GLB file of a JSON description and data blocks, each a multiple of 4 bytes long."""
    text = description + b" " * (-len(description) % 4)
    held = sum(map(len, blocks))
    total = 20 + len(text) + (8 + held if blocks else 0)
    yield b"glTF" + _word(2) + _word(total) + _word(len(text)) + b"JSON" + text
    if blocks:
        yield _word(held) + b"BIN\0"
        yield from blocks


def _word(number: int) -> bytes:
    return number.to_bytes(4, "little")


def losses(mesh: Mesh | RawMesh) -> tuple[Finding, ...]:
    """Return a finding about the change of unit, and findings about rounding to single precision.

    Raises
    ------
    OverflowError
        If a coordinate is beyond single precision.
    """
    message = (
        "GLB uses metres with the y axis up; the model was assumed to be in millimetres with the"
        " z axis up, and converted."
    )
    return Finding("unit", "note", message, (), 1), *single_precision.losses(mesh, "GLB")
