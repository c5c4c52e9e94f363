"""Reading of the meshes at the nodes of a GLB: triangles in single precision, with a matrix."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from ..._types import FloatArray, IndexArray
from ...attributes.attributes import Attributes
from ...attributes.concatenation import MeshPart, concatenated
from ..mesh_placement import SingleArray
from ..raw import compacted
from .accessors import fractions, stored
from .attribute_conversion import Named, materials_of, read_columns
from .container import COMPONENTS, FAN, STRIP, TRIANGLES, Container, instances_of

_Triangles: TypeAlias = "tuple[SingleArray, IndexArray, Attributes | None]"

_IDENTITY = np.eye(4)


@dataclass(frozen=True, eq=False)
class NodeMesh:
    """A mesh that a node of a GLB shows, with the matrix from the mesh to the scene.

    Parameters
    ----------
    name : str
        The name of the mesh, or of the node if the mesh has none.
    vertices : (n, 3) float32
        In the mesh's own coordinates.
    faces : (m, 3) int64
    matrix : (4, 4) float64
        From the mesh's coordinates to the scene's, for column vectors.
    attributes : Attributes or None
    """

    name: str
    vertices: SingleArray
    faces: IndexArray
    matrix: FloatArray
    attributes: Attributes | None = None


def visible_meshes(container: Container) -> tuple[list[NodeMesh], int]:
    """Return the meshes of a scene's nodes, and the number of nodes with a mesh outside the scene.

    A mesh of several nodes is returned once for each of them. The nodes come in the order of the
    file, children after their parent.

    Raises
    ------
    ValueError, LookupError, TypeError
        If the data have types that glTF does not allow.
    """
    tree = container.tree
    nodes = tree.get("nodes", [])
    materials = materials_of(tree, container.data)
    meshes: dict[int, _Triangles] = {}
    found = []
    seen = 0
    for number, matrix in _visited(tree, nodes):
        node = nodes[number]
        if "mesh" not in node:
            continue
        seen += 1
        mesh = tree["meshes"][node["mesh"]]
        if node["mesh"] not in meshes:
            meshes[node["mesh"]] = triangles_of(container, mesh, materials)
        name = mesh.get("name") or node.get("name") or ""
        vertices, faces, said = meshes[node["mesh"]]
        for place in instance_matrices(container, node):
            found.append(NodeMesh(str(name), vertices, faces, matrix @ place, said))
    return found, sum("mesh" in node for node in nodes) - seen


def _visited(tree: dict[str, Any], nodes: list[dict[str, Any]]) -> Iterator[tuple[int, FloatArray]]:
    """Yield number and matrix to the scene of each node; all nodes if the file has no scenes."""
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
            raise IndexError(f"node {number} does not exist, or occurs twice in the scene")
        seen.add(number)
        matrix = outer @ local_matrix(nodes[number])
        yield number, matrix
        children = nodes[number].get("children", [])
        waiting.extend((child, matrix) for child in reversed(children))


def local_matrix(node: dict[str, Any]) -> FloatArray:
    """Return the matrix (4, 4) from a glTF node's coordinates to its parent's, for columns."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    given = [
        np.array([node.get(key, usual)], dtype=np.float64)
        for key, usual in zip(("translation", "rotation", "scale"), _DEFAULT_TRANSFORM, strict=True)
    ]
    matrix: FloatArray = _matrices(*given)[0]
    return matrix


#: glTF's defaults of a node: no translation, no rotation (a quaternion), and the scale 1.
_DEFAULT_TRANSFORM = ([0, 0, 0], [0, 0, 0, 1], [1, 1, 1])


def instance_matrices(container: Container, node: dict[str, Any]) -> FloatArray:
    """Return the matrices (n, 4, 4) from a node's instances to the node, or one identity."""
    told = instances_of(node)
    if told is None:
        return _IDENTITY[None]
    count = container.tree["accessors"][next(iter(told.values()))]["count"]
    given = []
    for key, usual in zip(("TRANSLATION", "ROTATION", "SCALE"), _DEFAULT_TRANSFORM, strict=True):
        values = np.tile(np.array(usual, dtype=np.float64), (count, 1))
        if key in told:
            values = fractions(stored(container, told[key])).astype(np.float64)
        if values.shape[1] != len(usual):
            raise ValueError(
                f"the instancing attribute {key} has {values.shape[1]} numbers for each instance"
                f" instead of {len(usual)}"
            )
        given.append(values)
    return _matrices(*given)


def _matrices(translations: FloatArray, rotations: FloatArray, scales: FloatArray) -> FloatArray:
    """Return (n, 4, 4) matrices for column vectors: they scale, then rotate, then translate."""
    found = np.tile(_IDENTITY, (len(scales), 1, 1))
    found[:, :3, :3] = _rotation_matrices(rotations) * scales[:, None]
    found[:, :3, 3] = translations
    return found


def _rotation_matrices(quaternions: FloatArray) -> FloatArray:
    """Return the rotation matrices (n, 3, 3) of quaternions (n, 4), any length, real part last."""
    with np.errstate(invalid="ignore"):  # results that are not finite are refused later
        x, y, z, w = (quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def triangles_of(container: Container, mesh: dict[str, Any], materials: Named) -> _Triangles:
    """Return vertices, triangles and attributes of all primitives of a glTF mesh, joined."""
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
            # If several primitives share vertices, each gets a copy of the vertices that it uses.
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
    """Return the numbers of the position accessors that more than one primitive uses."""
    named = Counter(primitive["attributes"].get("POSITION") for primitive in primitives)
    return {accessor for accessor, times in named.items() if times > 1}


#: The component types that positions may have, and those that indices may have.
_POSITIONS = ("f4", "i1", "u1", "i2", "u2")
_INDICES = ("u1", "u2", "u4")


def _positions(container: Container, accessor: int) -> SingleArray:
    _check_kind(container, accessor, "VEC3", _POSITIONS)
    values = stored(container, accessor)
    if container.tree["accessors"][accessor].get("normalized"):
        values = fractions(values)
    return np.ascontiguousarray(values, dtype=np.float32)


def _check_kind(container: Container, number: int, shape: str, kinds: tuple[str, ...]) -> None:
    accessor = container.tree["accessors"][number]
    if accessor["type"] != shape or COMPONENTS[accessor["componentType"]][1:] not in kinds:
        raise ValueError(
            f"accessor {number} has a type or component type that glTF does not allow for its use"
        )


def _faces(container: Container, primitive: dict[str, Any], count: int, mode: int) -> IndexArray:
    corners = np.arange(count)
    if "indices" in primitive:
        _check_kind(container, primitive["indices"], "SCALAR", _INDICES)
        corners = stored(container, primitive["indices"]).ravel().astype(np.int64)
    if len(corners) and not 0 <= corners.min() <= corners.max() < count:
        raise IndexError(f"a triangle has a vertex index outside 0 to {count - 1}")
    if mode == TRIANGLES:
        return corners.reshape(-1, 3)
    second, third = corners[1:-1], corners[2:]
    if mode == FAN:
        return np.stack([np.repeat(corners[:1], len(third)), second, third], axis=1)
    faces = np.stack([corners[:-2], second, third], axis=1)
    faces[1::2] = faces[1::2, ::-1]
    return faces
