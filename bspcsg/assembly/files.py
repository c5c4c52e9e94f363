"""Reading and writing of assemblies: components of 3MF, nodes of GLB, objects of OBJ."""

import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from .._types import FloatArray
from ..attributes.attributes import Attributes
from ..attributes.colours import hexadecimal
from ..attributes.material import Material
from ..errors import Finding, FormatError, format_errors
from ..formats import obj, single_precision
from ..formats.atomic import write_file
from ..formats.files import form_of, read_as, write
from ..formats.glb import scene as glb
from ..formats.raw import RawMesh, joined, parts_of
from ..formats.registry import Form
from ..formats.scene import SceneNode, are_equal_trees, have_equal_attributes
from ..formats.solids import solid_of
from ..formats.source import Source, whole_content
from ..formats.storable_attributes import unstorable_finding
from ..formats.threemf import scene as threemf
from ..formats.threemf.properties import storable
from ..formats.threemf.write import stored_name
from ..geometry import transform
from ..mesh.mesh import Mesh
from ..parameters import file_path
from ..solid.solid import Solid
from . import scripts
from .tree import Assembly, transformed_solid

#: The formats that store a tree of objects, each with its reader and writer.
_TREES: dict[str, tuple[Callable[[Source], SceneNode], Callable[[SceneNode], Iterator[bytes]]]] = {
    ".3mf": (threemf.read, threemf.encode),
    ".glb": (glb.read, glb.encode),
}

#: The suffixes of OpenSCAD scripts and their JSON form.
_SCRIPTS = frozenset({".csg", ".json", ".scad"})

#: The largest value of a colour component in a file.
_BYTE = 255


def load(path: str | os.PathLike[str], **options: Any) -> Assembly:
    """Read an assembly from a file; see `Assembly.load`."""
    return load_as(path, Path(file_path(path)).suffix.lower(), **options)


def load_as(path: str | os.PathLike[str], suffix: str, **options: Any) -> Assembly:
    """Read an assembly in the format that `suffix` names, not the file's own suffix."""
    if suffix in _SCRIPTS:
        return scripts.load(path, Path(path).stem, **options)
    if suffix in _TREES:
        return _AssemblyReader(path, suffix, options).assembly(_scene(path, suffix))
    raw = read_as(path, suffix)
    start, children = 0, []
    for name, faces in parts_of(raw):
        rows = np.arange(start, start + len(faces))
        start += len(faces)
        attributes = (
            None if raw.attributes is None else raw.attributes.for_faces(rows).with_used_materials()
        )
        solid = solid_of(RawMesh(raw.vertices, faces, name, attributes=attributes), path, **options)
        children.append(Assembly(name, solid))
    return Assembly(Path(path).stem, children)


def _scene(path: str | os.PathLike[str], suffix: str) -> SceneNode:
    return _decoded(os.fspath(path), whole_content(path), suffix)


def _decoded(name: str, data: bytes, suffix: str) -> SceneNode:
    with format_errors(name, suffix[1:].upper()):
        return _TREES[suffix][0](Source(name, data))


class _AssemblyReader:
    """A file that is read as an assembly: nodes with a common mesh get a common solid."""

    def __init__(self, path: str | os.PathLike[str], suffix: str, options: dict[str, Any]) -> None:
        self._path = path
        self._suffix = suffix
        self._options = options
        self._solids: dict[int, Solid] = {}

    def assembly(self, root: SceneNode) -> Assembly:
        """Return the assembly of a scene's root node.

        Without any part in it, raise the error of reading the file as a mesh.
        """
        made = self._node(root) or Assembly(root.name)
        if not made.parts:
            solid_of(read_as(self._path, self._suffix), self._path, **self._options)
        return made

    def _node(self, node: SceneNode) -> Assembly | None:
        """Return the assembly of a node, or None if its matrix is singular."""
        if _is_flat(node.matrix):
            return None
        inner = (self._node(child) for child in node.children)
        content: Any = [child for child in inner if child is not None]
        if node.mesh is not None:
            content = self._solid(node.mesh)
        factor = transform.matrix_factor(node.matrix)
        made = Assembly(node.name, content, color=node.color)
        return made._moved((factor,))

    def _solid(self, mesh: RawMesh) -> Solid:
        if id(mesh) not in self._solids:
            self._solids[id(mesh)] = solid_of(mesh, self._path, **self._options)
        return self._solids[id(mesh)]


def _is_flat(matrix: FloatArray) -> bool:
    return bool(np.isfinite(matrix).all()) and transform.determinant_sign(matrix) == 0


def save(assembly: Assembly, path: str | os.PathLike[str]) -> tuple[Finding, ...]:
    """Write an assembly to a file, and return the findings about losses; see `Assembly.save`."""
    suffix = Path(file_path(path)).suffix.lower()
    return (*_written(assembly, path, suffix), *_lost_densities(assembly))


def _written(assembly: Assembly, path: str | os.PathLike[str], suffix: str) -> tuple[Finding, ...]:
    """Write an assembly, and return the findings about losses other than densities."""
    if suffix == ".csg":
        return scripts.save(assembly, path)
    if suffix == ".obj":
        whole, lost = _single_mesh(assembly)
        return (*write(whole, path), *_unstorable_finding(lost, suffix))
    form = form_of(path)
    if suffix not in _TREES:
        message = (
            f"{os.fspath(path)}: an assembly cannot be written in this format; choose a file name"
            " that ends in .3mf, .glb, .obj or .csg."
        )
        raise FormatError(message, "unknown_format")
    describing = _SceneBuilder(form)
    try:
        scene = describing.node(assembly, None)
    except OverflowError:
        message = (
            f"{os.fspath(path)}: a coordinate is too large for the single-precision numbers of"
            " this format; write 3MF instead."
        )
        raise FormatError(message, "too_large") from None
    if scene is None:
        raise FormatError(
            f"{os.fspath(path)}: the assembly is not written, because none of its parts has a"
            " volume.",
            "empty",
        )
    given = scene
    scene = _ThreemfConverter().node(scene) if suffix == ".3mf" else glb.as_written(scene)

    def prove(file: BinaryIO) -> None:
        found = _decoded(os.fspath(path), file.read(), suffix)
        if not are_equal_trees(scene, found) or (
            suffix == ".3mf" and not have_equal_attributes(scene, found)
        ):
            message = (
                f"{os.fspath(path)}: the written file was discarded, because it differs from the"
                " assembly when it is read back. The disk may be at fault; if it happens again,"
                " please report it."
            )
            raise FormatError(message, "write_mismatch")

    write_file(path, _TREES[suffix][1](scene), prove)
    return (
        *_lost_attributes(given, scene, suffix),
        *_empty_parts_finding(describing.empty),
        *describing.changes,
    )


def _empty_parts_finding(count: int) -> tuple[Finding, ...]:
    if not count:
        return ()
    message = f"{count} parts without volume were left out."
    return (Finding("empty_parts", "warning", message, (), count),)


def _lost_densities(assembly: Assembly) -> tuple[Finding, ...]:
    count = sum(part.density is not None for part in assembly.parts)
    if not count:
        return ()
    message = f"mesh files cannot store densities; the densities of {count} parts were left out."
    return (Finding("densities_left_out", "warning", message, (), count),)


class _SceneBuilder:
    """Converter of an assembly to scene nodes; parts with a common solid get a common mesh."""

    def __init__(self, form: Form) -> None:
        #: The number of parts without volume, which files cannot store.
        self.empty = 0
        #: The findings about changes that the format makes to meshes.
        self.changes: list[Finding] = []
        self._form = form
        self._meshes: dict[int, tuple[Solid, RawMesh]] = {}

    def node(self, assembly: Assembly, color: tuple[float, ...] | None) -> SceneNode | None:
        """Return the scene node of an assembly, or None if it has no part with volume.

        `color` is the colour inherited from the assembly around it.
        """
        name = stored_name(assembly.name)
        color = color if assembly.color is None else assembly.color
        matrix = transform.product(assembly.factors) if assembly.factors else np.eye(4)
        if assembly.shape is None:
            inner = (self.node(child, color) for child in assembly.children)
            children = tuple(child for child in inner if child is not None)
            return SceneNode(name, matrix, None, None, children) if children else None
        mesh = self._mesh(assembly.shape, name)
        if len(mesh.faces) == 0:
            self.empty += 1
            return None
        return SceneNode(name, matrix, mesh, None if _is_painted(mesh.attributes) else color)

    def _mesh(self, solid: Solid, name: str) -> RawMesh:
        if id(solid) not in self._meshes:
            mesh = solid.normalized().to_mesh()
            self._tell(name, () if self._form.losses is None else self._form.losses(mesh))
            if self._form.is_single:
                mesh, mended = single_precision.in_single_precision(mesh)
                self._tell(name, mended)
            self._meshes[id(solid)] = (solid, _raw(mesh, name, self._form.is_single))
        return self._meshes[id(solid)][1]

    def _tell(self, name: str, findings: tuple[Finding, ...]) -> None:
        """Record the findings about a part, with its name; the finding about the unit only once."""
        for one in findings:
            is_common = one.code == "unit"
            told = one if is_common else replace(one, message=f"“{name or 'part'}”: {one.message}")
            if not is_common or one not in self.changes:
                self.changes.append(told)


def _raw(mesh: Mesh, name: str, in_single: bool) -> RawMesh:
    vertices = mesh.vertices.astype(np.float32) if in_single else mesh.vertices
    attributes = mesh.attributes.without_empty_material() if mesh.carried is not None else None
    return RawMesh(vertices.astype(np.float64), mesh.faces, name, attributes=attributes)


def _is_painted(attributes: Attributes | None) -> bool:
    """Return True if a mesh has colours or materials, which override the colour of its part."""
    return attributes is not None and not {"color", "material"}.isdisjoint(attributes.names)


class _ThreemfConverter:
    """Converter of scene nodes to the colours and attributes that 3MF can store.

    Nodes with a common mesh still have a common mesh afterwards.
    """

    def __init__(self) -> None:
        self._meshes: dict[int, RawMesh] = {}

    def node(self, node: SceneNode) -> SceneNode:
        """Return a scene node and its children as 3MF will store them."""
        color = node.color and tuple(round(value * _BYTE) / _BYTE for value in node.color)
        mesh = None if node.mesh is None else self._mesh(node.mesh)
        return SceneNode(node.name, node.matrix, mesh, color, tuple(map(self.node, node.children)))

    def _mesh(self, mesh: RawMesh) -> RawMesh:
        if id(mesh) not in self._meshes:
            held = None if mesh.attributes is None else storable(mesh.attributes)
            attributes = None if held is None or held.is_empty else held
            self._meshes[id(mesh)] = replace(mesh, attributes=attributes)
        return self._meshes[id(mesh)]


def _lost_attributes(given: SceneNode, written: SceneNode, suffix: str) -> tuple[Finding, ...]:
    """Return the finding about attributes of `given` that are missing in `written`, if any."""
    lost: set[str] = set()
    for node, held in zip(given.walk(), written.walk(), strict=True):
        if node.mesh is not None and held.mesh is not None and node.mesh.attributes is not None:
            names = () if held.mesh.attributes is None else held.mesh.attributes.names
            lost.update(set(node.mesh.attributes.names).difference(names))
    return _unstorable_finding(lost, suffix)


def _unstorable_finding(lost: set[str], suffix: str) -> tuple[Finding, ...]:
    """Return the finding that a format cannot store attributes of the given names, if any."""
    return unstorable_finding([f"“{name}”" for name in sorted(lost)], suffix)


def _single_mesh(assembly: Assembly) -> tuple[RawMesh, set[str]]:
    """Return all parts as one mesh with an object for each, and the names of omitted attributes.

    Attributes that OBJ cannot store are omitted before the meshes are joined, because their types
    may differ between parts.
    """
    pieces: list[RawMesh] = []
    lost: set[str] = set()
    for part in assembly.parts:
        mesh = transformed_solid(part.shape, part.factors).normalized().to_mesh()
        attributes = mesh.attributes.without_empty_material()
        if part.color is not None and not _is_painted(attributes):
            name = hexadecimal(part.color)
            face = {**attributes.face, "material": np.full(len(mesh.faces), name)}
            attributes = replace(attributes, face=face, materials={name: Material(part.color)})
        held = obj.storable(attributes)
        lost.update(set(attributes.names).difference(held.names))
        own = None if held.is_empty else held
        pieces.append(RawMesh(mesh.vertices, mesh.faces, part.path, attributes=own))
    if any(one.attributes and "material" in one.attributes.face for one in pieces):
        # Another part has materials, so write the colours of faces as materials, too.
        pieces = [replace(one, attributes=obj.with_materials(one.attributes)) for one in pieces]
    return joined(pieces), lost
