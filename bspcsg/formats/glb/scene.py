"""Reading and writing a GLB as a tree of nodes."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ..._types import FloatArray
from ...attributes.attributes import Attributes
from ...attributes.colours import hexadecimal
from ...attributes.material import Material
from ..raw import RawMesh
from ..scene import SceneNode
from ..source import Source
from .attribute_conversion import Pictures, materials_of, storable, stored_name
from .container import Container, container_of, instances_of
from .file import TO_METRES, TO_MILLIMETRES, Description, container
from .linear_colours import as_read
from .nodes import instance_matrices, local_matrix, triangles_of

_IDENTITY = np.eye(4)


def read(source: Source) -> SceneNode:
    """Read the scene of a GLB as a tree of nodes, in millimetres with z upwards.

    Raises
    ------
    FormatError
        If the file is cut off, is no GLB of version 2, or has content that cannot be read.
    """
    held = container_of(source)
    try:
        return _SceneReader(held).root()
    except IndexError as error:
        raise source.error(f"{error}.", "index_out_of_range") from error
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise source.error(f"this GLB cannot be decoded: {error}.") from error


class _SceneReader:
    """A reader of one file's nodes; a mesh that several nodes share becomes one object."""

    def __init__(self, container: Container) -> None:
        self._container = container
        self._nodes = container.tree.get("nodes", [])
        self._meshes: dict[int, tuple[RawMesh, tuple[float, ...] | None]] = {}
        self._materials = materials_of(container.tree, container.data)

    def root(self) -> SceneNode:
        scenes = self._container.tree.get("scenes", [])
        if scenes:
            roots = scenes[self._container.tree.get("scene", 0)].get("nodes", [])
        else:
            inner = {child for node in self._nodes for child in node.get("children", [])}
            roots = [number for number in range(len(self._nodes)) if number not in inner]
        if len(roots) == 1 and self._only_turns(self._nodes[roots[0]]):
            return self._node(self._nodes[roots[0]]["children"][0], _IDENTITY)
        found = tuple(self._node(number, TO_MILLIMETRES) for number in roots)
        return found[0] if len(found) == 1 else SceneNode("", _IDENTITY, children=found)

    def _only_turns(self, node: dict[str, Any]) -> bool:
        """Say whether a node has only one child and the matrix `TO_METRES`, as written here."""
        is_bare = set(node) == {"matrix", "children"} and len(node["children"]) == 1
        return is_bare and bool((local_matrix(node) == TO_METRES).all())

    def _node(self, number: int, outer: FloatArray) -> SceneNode:
        """Return node `number` with all below it; `outer` is applied after the node's matrix."""
        if not 0 <= number < len(self._nodes):
            raise IndexError(f"node {number} does not exist")
        told = self._nodes[number]
        mesh, color = self._mesh(told["mesh"]) if "mesh" in told else (None, None)
        children = tuple(self._node(child, _IDENTITY) for child in told.get("children", []))
        matrix = outer @ local_matrix(told)
        name = str(told.get("name") or (mesh.name if mesh is not None else ""))
        if mesh is not None and len(mesh.faces) == 0:
            mesh = None
        if mesh is None or not (children or instances_of(told)):
            return SceneNode(name, matrix, mesh, color, children)
        places = instance_matrices(self._container, told)
        own = (SceneNode(mesh.name, place, mesh, color) for place in places)
        return SceneNode(name, matrix, None, None, (*own, *children))

    def _mesh(self, number: int) -> tuple[RawMesh, tuple[float, ...] | None]:
        """Return mesh `number`, always the same object, and its colour or None."""
        if number not in self._meshes:
            told = self._container.tree["meshes"][number]
            vertices, faces, attributes = triangles_of(self._container, told, self._materials)
            points = vertices.astype(np.float64)
            if not np.isfinite(points).all():
                raise ValueError("a coordinate is not a finite number")
            name = str(told.get("name") or "")
            made = RawMesh(points, faces, name, unit="mm", attributes=attributes)
            self._meshes[number] = _painted(made)
        return self._meshes[number]


def as_written(root: SceneNode) -> SceneNode:
    """Return a tree with the colours and attributes that reading its GLB file would return."""
    return _GlbConverter().node(root)


class _GlbConverter:
    """A converter of trees to what GLB can store; nodes that share a mesh share the new one."""

    def __init__(self) -> None:
        self._meshes: dict[int, tuple[RawMesh, tuple[float, ...] | None]] = {}

    def node(self, node: SceneNode) -> SceneNode:
        """Return a node, and all below it, with the colours and attributes that GLB can store."""
        mesh, painted = (None, None) if node.mesh is None else self._mesh(node.mesh)
        color = painted if node.color is None else as_read(node.color)
        return SceneNode(node.name, node.matrix, mesh, color, tuple(map(self.node, node.children)))

    def _mesh(self, mesh: RawMesh) -> tuple[RawMesh, tuple[float, ...] | None]:
        if id(mesh) not in self._meshes:
            held = None if mesh.attributes is None else storable(mesh.attributes, mesh.vertices)
            attributes = None if held is None or held.is_empty else held
            one = replace(mesh, attributes=attributes)
            self._meshes[id(mesh)] = one, _painted(one)[1]
        return self._meshes[id(mesh)]


def _painted(mesh: RawMesh) -> tuple[RawMesh, tuple[float, ...] | None]:
    """Return a mesh and its colour, or None for the colour.

    If the mesh has one material, named after its own colour, that material is removed and its
    colour returned.
    """
    attributes = mesh.attributes
    if (
        attributes is None
        or "material" not in attributes.face
        or "color" in attributes.names
        or not len(mesh.faces)
    ):
        return mesh, None
    names = np.unique(attributes.face["material"]).tolist()
    material = attributes.materials.get(names[0], Material())
    # Materials whose colours are equal in bytes have names that differ by a number at the end.
    is_named = len(names) == 1 and names[0].partition(" ")[0] == hexadecimal(material.color)
    if not is_named or material.texture is not None:
        return mesh, None
    rest = replace(attributes.without({"material"}), materials={})
    return replace(mesh, attributes=None if rest.is_empty else rest), material.color


def encode(root: SceneNode) -> Iterator[bytes]:
    """Yield the bytes of a GLB file of a tree from `as_written`, each shared mesh stored once.

    Meshes have no names, since a tree has only names of nodes.
    """
    nodes: list[dict[str, Any]] = [{"matrix": TO_METRES.T.ravel().tolist()}]
    described = Description(is_empty_set=False)
    taken: dict[str, Material] = {}
    meshes: dict[tuple[int, tuple[float, ...] | None], tuple[int, Attributes, RawMesh]] = {}
    waiting = [(root, 0)]
    while waiting:
        node, parent = waiting.pop()
        number = len(nodes)
        told: dict[str, Any] = {"matrix": node.matrix.T.ravel().tolist()}
        nodes.append(told | ({"name": stored_name(node.name)} if node.name else {}))
        nodes[parent].setdefault("children", []).append(number)
        if node.mesh is not None and len(node.mesh.faces):
            key = (id(node.mesh), node.color)
            if key not in meshes:
                attributes = _attributes_of(node.mesh, node.color)
                meshes[key] = (len(meshes), attributes.among(taken), node.mesh)
            nodes[number]["mesh"] = meshes[key][0]
        waiting.extend((child, number) for child in reversed(node.children))
    pictures = Pictures(taken, described.append)
    for _, attributes, mesh in meshes.values():
        described.add_object(
            "", described.append_mesh(mesh.vertices, mesh.faces, attributes, pictures)
        )
    further = pictures.described()
    yield from container(described.text(further, nodes), described.blocks)


def _attributes_of(mesh: RawMesh, color: tuple[float, ...] | None) -> Attributes:
    attributes = Attributes(mesh.faces) if mesh.attributes is None else mesh.attributes
    if color is None or {"color", "material"}.intersection(attributes.names):
        return attributes
    names = np.full(len(mesh.faces), hexadecimal(color))
    return replace(
        attributes, face={"material": names}, materials={hexadecimal(color): Material(color)}
    )
