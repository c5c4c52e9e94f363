"""The content of the nodes of a GLB: triangles in single precision under a matrix, node by node."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from ..._types import FloatArray, IndexArray
from ...attributes.attributes import Attributes
from ...attributes.joining import MeshPart, concatenated
from ..placing import SingleArray
from ..raw import compacted
from .container import FAN, STRIP, TRIANGLES, Container
from .said import Named, materials_of, read_columns

_Triangles: TypeAlias = "tuple[SingleArray, IndexArray, Attributes | None]"

#: The type of a component by glTF's number, for positions and for indices.
_POSITION = {5126: "<f4"}
_INDEX = {5121: "<u1", 5123: "<u2", 5125: "<u4"}

_IDENTITY = np.eye(4)


@dataclass(frozen=True, eq=False)
class Shown:
    """A mesh at a node.

    Parameters
    ----------
    name : str
        Of the mesh, or of the node if the mesh has none.
    vertices : (n, 3) float32
        Before the matrix.
    faces : (m, 3) int64
    matrix : (4, 4) float64
        For column vectors: from the mesh to the scene.
    attributes : Attributes or None
    """

    name: str
    vertices: SingleArray
    faces: IndexArray
    matrix: FloatArray
    attributes: Attributes | None = None


def shown(container: Container) -> tuple[list[Shown], int]:
    """Return what the scene shows, and how many nodes with a mesh it does not show.

    A mesh at several nodes is shown at each of them. The nodes come in the order of the file,
    those inside a node after it.

    Raises
    ------
    ValueError, LookupError, TypeError
        If the data are of kinds that glTF does not have.
    """
    tree = container.tree
    nodes = tree.get("nodes", [])
    materials = materials_of(tree, container.data)
    meshes: dict[int, _Triangles] = {}
    found = []
    for number, matrix in _visited(tree, nodes):
        node = nodes[number]
        if "mesh" not in node:
            continue
        mesh = tree["meshes"][node["mesh"]]
        if node["mesh"] not in meshes:
            meshes[node["mesh"]] = triangles_of(container, mesh, materials)
        name = mesh.get("name") or node.get("name") or ""
        vertices, faces, said = meshes[node["mesh"]]
        found.append(Shown(str(name), vertices, faces, matrix, said))
    placed = sum("mesh" in node for node in nodes)
    return found, placed - len(found)


def _visited(tree: dict[str, Any], nodes: list[dict[str, Any]]) -> Iterator[tuple[int, FloatArray]]:
    """Yield the nodes of the scene, each with its matrix; a file without scenes shows them all."""
    scenes = tree.get("scenes", [])
    if scenes:
        roots = scenes[tree.get("scene", 0)].get("nodes", [])
    else:
        inner = {child for node in nodes for child in node.get("children", [])}
        roots = [number for number in range(len(nodes)) if number not in inner]
    waiting = [(number, _IDENTITY) for number in reversed(roots)]
    seen: set[int] = set()
    while waiting:
        number, outer = waiting.pop()
        if number in seen or not 0 <= number < len(nodes):
            raise IndexError(f"node {number} is shown twice or does not exist")
        seen.add(number)
        matrix = outer @ local_matrix(nodes[number])
        yield number, matrix
        children = nodes[number].get("children", [])
        waiting.extend((child, matrix) for child in reversed(children))


def local_matrix(node: dict[str, Any]) -> FloatArray:
    """Return the place of a node in the one around it, for column vectors."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    matrix[:3, :3] = _rotation(node.get("rotation", [0, 0, 0, 1])) * np.array(
        node.get("scale", [1, 1, 1]), dtype=np.float64
    )
    matrix[:3, 3] = node.get("translation", [0, 0, 0])
    return matrix


def _rotation(quaternion: list[float]) -> FloatArray:
    x, y, z, w = np.array(quaternion, dtype=np.float64) / np.linalg.norm(quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def triangles_of(container: Container, mesh: dict[str, Any], materials: Named) -> _Triangles:
    """Return the triangles of all primitives of a mesh, and what is said of them."""
    vertices: list[SingleArray] = [np.zeros((0, 3), np.float32)]
    faces = [np.zeros((0, 3), np.int64)]
    parts = []
    start = 0
    shared = _shared(mesh["primitives"])
    for primitive in mesh["primitives"]:
        mode = primitive.get("mode", TRIANGLES)
        if mode not in (TRIANGLES, STRIP, FAN) or "POSITION" not in primitive["attributes"]:
            continue
        points = _positions(container, primitive["attributes"]["POSITION"])
        corners = _faces(container, primitive, len(points), mode)
        used = None
        if primitive["attributes"]["POSITION"] in shared:
            # Of vertices that several primitives have, each takes what it uses.
            used, corners = compacted(corners)
        columns = read_columns(container, primitive, len(points), used)
        points = points if used is None else points[used]
        face = {}
        if "material" in primitive:
            face = {"material": np.full(len(corners), materials[primitive["material"]][0])}
        named = dict([materials[primitive["material"]]]) if face else {}
        said = Attributes(corners, columns, {}, face, named) if columns or face else None
        parts.append(MeshPart(len(points), corners, said))
        vertices.append(points)
        faces.append(corners + start)
        start += len(points)
    whole = np.concatenate(faces)
    return np.concatenate(vertices), whole, concatenated(parts, whole)


def _shared(primitives: list[dict[str, Any]]) -> set[Any]:
    """Return the accessors of positions that more than one primitive names."""
    named = [primitive["attributes"].get("POSITION") for primitive in primitives]
    return {accessor for accessor in named if named.count(accessor) > 1}


def _positions(container: Container, accessor: int) -> SingleArray:
    points = _elements(container, accessor, _POSITION, "VEC3")
    return np.ascontiguousarray(points, dtype=np.float32)


def _faces(container: Container, primitive: dict[str, Any], count: int, mode: int) -> IndexArray:
    corners = np.arange(count)
    if "indices" in primitive:
        corners = _elements(container, primitive["indices"], _INDEX, "SCALAR").ravel()
        corners = corners.astype(np.int64)
    if len(corners) and not 0 <= corners.min() <= corners.max() < count:
        raise IndexError("a triangle names a vertex that does not exist")
    if mode == TRIANGLES:
        return corners.reshape(-1, 3)
    second, third = corners[1:-1], corners[2:]
    if mode == FAN:
        return np.stack([np.repeat(corners[:1], len(third)), second, third], axis=1)
    faces = np.stack([corners[:-2], second, third], axis=1)
    faces[1::2] = faces[1::2, ::-1]
    return faces


def _elements(container: Container, number: int, kinds: dict[int, str], shape: str) -> Any:
    """Return the (count, k) elements of an accessor, in place."""
    accessor = container.tree["accessors"][number]
    view = container.tree["bufferViews"][accessor["bufferView"]]
    kind = kinds.get(accessor["componentType"])
    if kind is None or accessor["type"] != shape:
        raise ValueError(f"accessor {number} is of no type that is meant for its use")
    item, width = np.dtype(kind), {"SCALAR": 1, "VEC3": 3}[shape]
    stride = view.get("byteStride") or item.itemsize * width
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return np.ndarray(
        (accessor["count"], width), item, container.data, start, (stride, item.itemsize)
    )
