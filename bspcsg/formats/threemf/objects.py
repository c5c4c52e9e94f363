"""The objects of a 3MF package: their transforms and meshes.

An object is a mesh, or a boolean shape of meshes, which is evaluated here (3MF Boolean Operations
Extension 1.1.0, section 2.1).
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from ..._types import FloatArray
from ...errors import BspcsgError, FormatError, InternalError, InvalidParameterError, not_none
from ...solid.solid import Solid, combine, solid_with
from ..raw import RawMesh
from ..storable_attributes import attributes_or_none
from .package import Package
from .part import INSTANCE, Object, PlacedObject
from .properties import properties_of

#: The largest number of objects in a build, where an object counts each time it appears.
_MAX_OBJECTS_PLACED = 100_000

#: The largest depth to which objects may be nested.
_MAX_OBJECT_DEPTH = 64

#: The largest number of triangles of all operands of a boolean shape: its evaluation then takes
#: several gigabytes.
_MAX_BOOLEAN_TRIANGLES = 1 << 24

#: A part's name, a reference in that part to an object, and the transforms of the objects that
#: contain the reference, innermost first.
_Waiting: TypeAlias = tuple[str, PlacedObject, tuple[FloatArray, ...]]


class Objects:
    """The objects of a 3MF package; the mesh of each is made once and then reused.

    Parameters
    ----------
    package : Package

    Attributes
    ----------
    unmade : list of str
        The reasons why optional shapes could not be made.
    """

    def __init__(self, package: Package) -> None:
        self._package = package
        self._meshes: dict[tuple[str, str], RawMesh] = {}
        self._solids: dict[tuple[str, str], tuple[Solid, int]] = {}
        self._bases: set[tuple[str, str]] = set()
        self.unmade: list[str] = []

    def placed(
        self, root: str, items: list[PlacedObject]
    ) -> list[tuple[str, str, tuple[FloatArray, ...]]]:
        """Return part, object id and transforms of each mesh or shape of a build, in file order.

        The transforms are given innermost first.

        Raises
        ------
        FormatError
            If an object does not exist, or objects are nested too deeply.
        """
        found: list[tuple[str, str, tuple[FloatArray, ...]]] = []
        waiting: list[_Waiting] = [(root, item, ()) for item in reversed(items)]
        visited = 0
        while waiting:
            here, placed, outer = waiting.pop()
            visited += 1
            transforms: tuple[FloatArray, ...] = (placed.transform, *outer)
            path, known = self._named(here, placed)
            # An object that only renames its component does not count as a level.
            deepest = _MAX_OBJECT_DEPTH + (known.part_number == INSTANCE)
            is_deep = bool(known.components) and len(transforms) >= deepest
            if visited > _MAX_OBJECTS_PLACED or is_deep:
                raise self._too_deep()
            if not known.components:
                found.append((path, placed.item, transforms))
            waiting.extend((path, inner, transforms) for inner in reversed(known.components))
        return found

    def bare_mesh(self, path: str, item: str) -> RawMesh:
        """Return the mesh of an object before any transform, without attributes."""
        known = self._package.part(path).objects[item]
        if known.shape is None:
            return RawMesh(*known.arrays(), known.name)
        return replace(self.mesh(path, item), attributes=None)

    def mesh(self, path: str, item: str) -> RawMesh:
        """Return the mesh of an object before any transform; boolean shapes are evaluated.

        Raises
        ------
        FormatError
            If an operand of a shape is no closed mesh, or shapes are nested too deeply.
        """
        if (path, item) not in self._meshes:
            known = self._package.part(path).objects[item]
            make = self._written if known.shape is None else self._evaluated
            if known.shape is not None and known.shape.is_optional:
                make = self._attempted
            made = make(path, item)
            self._meshes[path, item] = replace(made, name=known.name)
        return self._meshes[path, item]

    def used(self) -> set[tuple[str, str]]:
        """Return part and id of each object that was an operand of a boolean shape."""
        return {*self._solids, *self._bases}

    def _named(self, here: str, placed: PlacedObject) -> tuple[str, Object]:
        """Return the part of an object to which the part `here` refers, and the object."""
        path = placed.path or here
        known = self._package.part(path).objects.get(placed.item)
        if known is None:
            message = f"the model refers to object {placed.item} in {path}, which does not exist."
            raise self._package.source.error(message, "index_out_of_range")
        return path, known

    def _too_deep(self) -> FormatError:
        message = (
            f"the objects are nested deeper than {_MAX_OBJECT_DEPTH} levels, form a cycle, or use"
            f" components more than {_MAX_OBJECTS_PLACED} times."
        )
        return self._package.source.error(message, "too_large")

    def _written(self, path: str, item: str) -> RawMesh:
        part = self._package.part(path)
        known = part.objects[item]
        vertices, faces = known.arrays()
        try:
            attributes = properties_of(part, known, faces, self._package.picture)
        except IndexError as error:
            message = f"object {item} in {path}: {error}."
            raise self._package.source.error(message, "index_out_of_range") from error
        return RawMesh(vertices, faces, attributes=attributes)

    def _attempted(self, path: str, item: str) -> RawMesh:
        """Return the mesh of a boolean shape; if it cannot be made, the mesh of its base."""
        shape = not_none(self._package.part(path).objects[item].shape, "the shape")
        try:
            return self._evaluated(path, item)
        except FormatError as error:
            self.unmade.append(error.message)
            base = shape.base.path or path
            self._bases.add((base, shape.base.item))
            return _moved(self.mesh(base, shape.base.item), shape.base.transform)

    def _evaluated(self, path: str, item: str) -> RawMesh:
        here = PlacedObject("", item, np.eye(4, 3))
        with self._errors_with_name(item):
            mesh = self._solid(path, here, 0)[0].normalized().to_mesh()
        is_nothing = len(mesh.faces) == 0
        return RawMesh(
            mesh.vertices, mesh.faces, attributes=attributes_or_none(mesh), is_empty_set=is_nothing
        )

    def _solid(self, here: str, placed: PlacedObject, depth: int) -> tuple[Solid, int]:
        """Return an object as a transformed solid, and the count of triangles it is made of."""
        if depth > _MAX_OBJECT_DEPTH:
            raise self._too_deep()
        path, known = self._named(here, placed)
        if known.kind != "model" or not known.is_body:
            message = (
                f"object {placed.item} is an operand of a boolean shape, but it is not a mesh of"
                " type “model”."
            )
            raise self._package.source.error(message, "unsupported")
        if (path, placed.item) not in self._solids:
            made = self._combined if known.shape is not None else self._meshed
            self._solids[path, placed.item] = made(path, placed.item, depth)
        solid, triangles = self._solids[path, placed.item]
        matrix = np.eye(4)
        matrix[:3] = placed.transform.T
        return solid.transform(matrix), triangles

    def _combined(self, path: str, item: str, depth: int) -> tuple[Solid, int]:
        shape = not_none(self._package.part(path).objects[item].shape, "the shape")
        with self._errors_with_name(item):
            parts = [self._solid(path, one, depth + 1) for one in (shape.base, *shape.operands)]
        triangles = sum(count for _, count in parts)
        if triangles > _MAX_BOOLEAN_TRIANGLES:
            message = (
                f"the boolean shape {item} has {triangles} triangles in its operands, more than"
                f" the limit of {_MAX_BOOLEAN_TRIANGLES}."
            )
            raise self._package.source.error(message, "too_large")
        base, *others = [solid for solid, _ in parts]
        if shape.operation == "union":
            return combine("or", [base, *others]), triangles
        if shape.operation == "difference":
            others = [~solid for solid in others]
        return combine("and", [base, *others]), triangles

    def _meshed(self, path: str, item: str, _: int) -> tuple[Solid, int]:
        mesh = self.mesh(path, item)
        with self._errors_with_name(item):
            return solid_with(mesh.vertices, mesh.faces, mesh.attributes), len(mesh.faces)

    @contextmanager
    def _errors_with_name(self, item: str) -> Iterator[None]:
        """Add the names of the file and of an object to errors about the object's shape."""
        try:
            yield
        except (FormatError, InternalError):
            raise
        except BspcsgError as error:
            message = f"object {item}, an operand of a boolean shape: {error.message}"
            is_flat = isinstance(error, InvalidParameterError)
            code = "unsupported" if is_flat else error.code
            raise self._package.source.error(message, code) from error


def _moved(mesh: RawMesh, matrix: FloatArray) -> RawMesh:
    """Return a mesh transformed by a (4, 3) matrix; if it mirrors, triangles are reversed."""
    faces, attributes = mesh.faces, mesh.attributes
    if np.linalg.det(matrix[:3]) < 0:
        faces, attributes = faces[:, ::-1], attributes and attributes.reordered([2, 1, 0])
    vertices = mesh.vertices @ matrix[:3] + matrix[3]
    return replace(mesh, vertices=vertices, faces=faces, attributes=attributes)
