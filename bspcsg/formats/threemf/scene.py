"""Reading and writing the tree of a 3MF's objects and components.

A leaf whose name differs from its mesh's is written as an object with one component, and marked by
the part number `INSTANCE`.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from xml.sax.saxutils import quoteattr

import numpy as np

from ..._types import FloatArray
from ..raw import RawMesh
from ..scene import SceneNode
from ..source import Source
from .objects import Objects
from .package import Package, opened
from .part import INSTANCE, MILLIMETRES, ModelPart, Object, PlacedObject
from .slicers import apply_slicer_settings
from .textures import Resources
from .write import beginning, hex_of, mesh_object, packed, properties, stored_name

_IDENTITY = np.eye(4)


def read(source: Source) -> SceneNode:
    """Read the build items of a 3MF file as a tree of nodes, in millimetres.

    Raises
    ------
    FormatError
        If the archive is damaged or has no model, or the model is not valid or needs an extension
        that is not supported.
    """
    with opened(source) as package:
        root = package.root()
        apply_slicer_settings(package, root)
        return _SceneReader(package, root).tree()


class _SceneReader:
    """A reader of one package's nodes; an object that several nodes show becomes one mesh."""

    def __init__(self, package: Package, root: str) -> None:
        self._package = package
        self._root = root
        self._objects = Objects(package)
        self._meshes: dict[tuple[str, str], RawMesh] = {}

    def tree(self) -> SceneNode:
        part = self._package.part(self._root)
        # Called only for its errors: objects that are nested too deeply or placed too often.
        self._objects.placed(self._root, part.items)
        found = self._nodes(self._root, part.items)
        scale = MILLIMETRES[part.unit]
        if len(found) == 1 and scale == 1:
            return found[0]
        matrix = np.diag([scale, scale, scale, 1.0])
        return SceneNode("", matrix, children=found)

    def _nodes(self, here: str, placed: Iterable[PlacedObject]) -> tuple[SceneNode, ...]:
        found = (self._node(here, one) for one in placed)
        return tuple(node for node in found if node is not None)

    def _node(self, here: str, placed: PlacedObject) -> SceneNode | None:
        """Return the node of a placed object; None if it is no model, but support or a surface."""
        path = placed.path or here
        part = self._package.part(path)
        told = part.objects[placed.item]
        matrix = _IDENTITY.copy()
        matrix[:3] = placed.transform.T
        if told.is_body:
            if told.kind != "model":
                return None
            mesh = self._mesh(path, part, placed.item)
            return SceneNode(told.name, matrix, mesh, _color(part, told))
        children = self._nodes(path, told.components)
        if told.part_number == INSTANCE and len(children) == 1:
            return SceneNode(told.name, matrix, children[0].mesh, children[0].color)
        return SceneNode(told.name, matrix, None, None, children)

    def _mesh(self, path: str, part: ModelPart, item: str) -> RawMesh:
        if (path, item) not in self._meshes:
            plain = _color(part, part.objects[item]) is not None
            made = self._objects.bare_mesh if plain else self._objects.mesh
            self._meshes[path, item] = replace(made(path, item), unit="mm")
        return self._meshes[path, item]


def _color(part: ModelPart, source: Object) -> tuple[float, ...] | None:
    """Return the only colour of an object; None if it has none or its triangles have properties."""
    if source.usual is None or source.properties or source.usual[0] not in part.bases:
        return None
    group = part.bases[source.usual[0]]
    if not 0 <= source.usual[1] < len(group):
        return None
    return tuple(value / 255 for value in group[source.usual[1]][1])


def encode(root: SceneNode) -> Iterator[bytes]:
    """Yield the bytes of a 3MF file of a tree; a mesh of several nodes is stored once."""
    resources = Resources(1)
    lines = [*_model(root, resources)]
    yield packed(iter(lines), resources.pictures)


def _model(root: SceneNode, resources: Resources) -> Iterator[str]:
    writing = _ObjectWriter(root, resources)
    top = writing.object_of(root)
    meshes = (node.mesh for node in root.walk() if node.mesh is not None)
    yield beginning(mesh.attributes for mesh in meshes if mesh.attributes is not None)
    yield "<resources>\n"
    yield from writing.lines
    yield f'</resources>\n<build>\n<item objectid="{top}"{_transform(root.matrix)}/>\n</build>\n'
    yield "</model>\n"


class _ObjectWriter:
    """A writer of a package's objects as XML; each comes after the objects that it refers to."""

    def __init__(self, root: SceneNode, resources: Resources) -> None:
        self.lines: list[str] = []
        self._resources = resources
        self._numbers: dict[tuple[int, tuple[float, ...] | None], tuple[int, str]] = {}
        self._colors: dict[tuple[float, ...], int] = {}
        for node in root.walk():
            if node.color is not None:
                self._colors.setdefault(node.color, len(self._colors))
        if self._colors:
            self._group = resources.free()
            self.lines.append(f'<basematerials id="{self._group}">\n')
            self.lines += [
                f'<base name="{hex_of(color)}" displaycolor="{hex_of(color)}"/>\n'
                for color in self._colors
            ]
            self.lines.append("</basematerials>\n")

    def object_of(self, node: SceneNode) -> int:
        """Write a node and its descendants as XML; return the id of the node's object."""
        if node.mesh is not None:
            return self._leaf(node, node.mesh)
        inner = [(self.object_of(child), child.matrix) for child in node.children]
        return self._components(node.name, inner, "")

    def _leaf(self, node: SceneNode, mesh: RawMesh) -> int:
        key = (id(mesh), node.color)
        if key not in self._numbers:
            painted, words = "", None
            if node.color is not None:
                painted = f' pid="{self._group}" pindex="{self._colors[node.color]}"'
            elif mesh.attributes is not None:
                groups, words = properties(mesh.attributes, self._resources)
                self.lines += groups
            number = self._resources.free()
            self._numbers[key] = (number, node.name)
            self.lines += mesh_object(number, node.name, mesh, painted, words)
        number, name = self._numbers[key]
        if name == node.name:
            return number
        return self._components(node.name, [(number, _IDENTITY)], INSTANCE)

    def _components(self, name: str, inner: list[tuple[int, FloatArray]], mark: str) -> int:
        number = self._resources.free()
        named = f" name={quoteattr(stored_name(name))}" if name else ""
        marked = f' partnumber="{mark}"' if mark else ""
        self.lines.append(f'<object id="{number}" type="model"{named}{marked}><components>\n')
        self.lines += [
            f'<component objectid="{one}"{_transform(matrix)}/>\n' for one, matrix in inner
        ]
        self.lines.append("</components></object>\n")
        return number


def _transform(matrix: FloatArray) -> str:
    if (matrix == _IDENTITY).all():
        return ""
    words = " ".join(repr(value) for value in matrix[:3].T.ravel().tolist())
    return f' transform="{words}"'
