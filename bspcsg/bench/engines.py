"""The engines that are timed, behind one interface: solids, operations, volumes and arrays."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import reduce
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from typing import Any, Literal, TypeAlias

import numpy as np

from .._types import MeshArrays
from .result_facts import mesh_volume
from .shapes import joined

#: The operations of engines; a difference subtracts the other operands from the first one.
Operation: TypeAlias = Literal["union", "difference", "intersection"]

#: The largest relative error of rounding a number to double, and to single precision.
_DOUBLE = 2.0**-53
_FLOAT = 2.0**-24


class EngineError(Exception):
    """An engine reports that it cannot do the work."""


class Engine(ABC):
    """One engine; its solids are objects of the engine's own type."""

    name: str

    #: True if the engine has counters of its work.
    counts = False

    @abstractmethod
    def solid(self, mesh: MeshArrays) -> Any:
        """Return the solid that a mesh bounds, ready for operations."""

    @abstractmethod
    def combine(self, operation: Operation, solids: Sequence[Any]) -> Any:
        """Return the result of an operation on solids; the engine may defer the work."""

    @abstractmethod
    def volume(self, solid: Any) -> float:
        """Return the volume of a solid, which forces deferred work."""

    @abstractmethod
    def arrays(self, solid: Any) -> MeshArrays:
        """Return the boundary of a solid as arrays (vertices, faces)."""

    def resolution(self, size: float) -> float:
        """Return the largest distance a vertex may be moved, with coordinates up to `size`."""
        return 4 * _DOUBLE * size

    def boolean(self, first: MeshArrays, second: MeshArrays, operation: Operation) -> MeshArrays:
        """Return the result for two meshes as arrays, computed as the engine recommends."""
        return self.arrays(self.combine(operation, [self.solid(first), self.solid(second)]))

    def united(self, parts: Sequence[MeshArrays]) -> Any:
        """Return the union of meshes, passed as one mesh if the engine accepts overlaps."""
        return self.combine("union", [self.solid(part) for part in parts])

    def counters(self, solid: Any) -> dict[str, int]:
        """Return the numbers that the engine counted while it made a solid."""
        return {}


class _Bspcsg(Engine):
    """The engine of this package, by its public functions."""

    name = "bspcsg"
    counts = True

    def __init__(self) -> None:
        from ..operations import setops
        from ..solid.solid import Solid

        self._setops, self._solid = setops, Solid

    def solid(self, mesh: MeshArrays) -> Any:
        return self._solid(*mesh)

    def combine(self, operation: Operation, solids: Sequence[Any]) -> Any:
        return getattr(self._setops, operation)(*solids)

    def volume(self, solid: Any) -> float:
        return float(solid.volume)

    def arrays(self, solid: Any) -> MeshArrays:
        vertices, faces = solid.to_mesh()
        return vertices, faces

    def resolution(self, size: float) -> float:
        # Snapping to the default lattice moves a vertex by at most half the diagonal of a step's
        # cube.
        return 3**0.5 / 2 * 1e-9 + super().resolution(size)

    def boolean(self, first: MeshArrays, second: MeshArrays, operation: Operation) -> MeshArrays:
        return self._setops.boolean(*first, *second, operation)

    def united(self, parts: Sequence[MeshArrays]) -> Any:
        return self._solid(*joined(parts)).normalized()

    def counters(self, solid: Any) -> dict[str, int]:
        return dict(solid.tree.stats())


class _Manifold(Engine):
    """The engine manifold3d in double precision; deferred work is forced in the timed part."""

    name = "manifold3d"

    def __init__(self) -> None:
        import manifold3d

        self._package = manifold3d

    def solid(self, mesh: MeshArrays) -> Any:
        made = self._package.Manifold(self._package.Mesh64(mesh[0], mesh[1].astype(np.uint64)))
        self._refuse_errors(made)
        return made

    def combine(self, operation: Operation, solids: Sequence[Any]) -> Any:
        kinds = self._package.OpType
        kind = {
            "union": kinds.Add,
            "difference": kinds.Subtract,
            "intersection": kinds.Intersect,
        }[operation]
        return self._package.Manifold.batch_boolean(list(solids), kind)

    def volume(self, solid: Any) -> float:
        return float(solid.volume())

    def arrays(self, solid: Any) -> MeshArrays:
        solid.num_tri()
        self._refuse_errors(solid)
        mesh = solid.to_mesh64()
        return np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts)

    def resolution(self, size: float) -> float:
        # manifold3d's documented precision, relative to the largest coordinate.
        return 1e-12 * size

    def _refuse_errors(self, solid: Any) -> None:
        status = solid.status()
        if status != self._package.Error.NoError:
            raise EngineError(f"manifold3d reports the status {status.name}")


class _Trueform(Engine):
    """The engine trueform; its solids are meshes."""

    name = "trueform"

    def __init__(self) -> None:
        import trueform

        self._package = trueform

    def solid(self, mesh: MeshArrays) -> Any:
        return self._package.Mesh(np.ascontiguousarray(mesh[1]), mesh[0])

    def combine(self, operation: Operation, solids: Sequence[Any]) -> Any:
        if len(solids) == 2:
            made = getattr(self._package, f"boolean_{operation}")(*solids)
            return self._package.Mesh(*made[0])
        graph = self._package.CsgGraph(list(solids))
        return self._package.Mesh(*graph.mesh(self._expression(operation, len(solids))))

    def _expression(self, operation: Operation, count: int) -> Any:
        terms = [self._package.op(k) for k in range(count)]
        if operation == "intersection":
            return reduce(lambda a, b: a & b, terms)
        rest = reduce(lambda a, b: a | b, terms[1:])
        return terms[0] | rest if operation == "union" else terms[0] - rest

    def volume(self, solid: Any) -> float:
        return float(self._package.signed_volume(solid))

    def arrays(self, solid: Any) -> MeshArrays:
        return np.asarray(solid.points), np.asarray(solid.faces)

    def resolution(self, size: float) -> float:
        # Its lattice is finer than 30 bits for the largest coordinate.
        return 2.0**-30 * size


class _OfArrays(Engine):
    """The base class of engines that only combine two meshes; solids are arrays."""

    def solid(self, mesh: MeshArrays) -> Any:
        return mesh

    def combine(self, operation: Operation, solids: Sequence[Any]) -> Any:
        return reduce(lambda a, b: self.boolean(a, b, operation), solids)

    def volume(self, solid: Any) -> float:
        return mesh_volume(solid).value

    def arrays(self, solid: Any) -> MeshArrays:
        return solid[0], solid[1]

    def resolution(self, size: float) -> float:
        # These engines use single precision for input, computation or output.
        return 8 * _FLOAT * size

    @abstractmethod
    def boolean(self, first: MeshArrays, second: MeshArrays, operation: Operation) -> MeshArrays:
        """Return the result of an operation on two meshes, as arrays."""


class _Meshlib(_OfArrays):
    """The engine MeshLib."""

    name = "meshlib"

    def __init__(self) -> None:
        from meshlib import mrmeshnumpy, mrmeshpy

        self._package, self._arrays = mrmeshpy, mrmeshnumpy

    def solid(self, mesh: MeshArrays) -> Any:
        return self._arrays.meshFromFacesVerts(mesh[1], mesh[0])

    def combine(self, operation: Operation, solids: Sequence[Any]) -> Any:
        kinds = self._package.BooleanOperation
        kind = {
            "union": kinds.Union,
            "difference": kinds.DifferenceAB,
            "intersection": kinds.Intersection,
        }[operation]
        return reduce(lambda a, b: self._combined(a, b, kind), solids)

    def _combined(self, first: Any, second: Any, kind: Any) -> Any:
        result = self._package.boolean(first, second, kind)
        if not result.valid():
            raise EngineError(f"meshlib reports: {result.errorString}")
        return result.mesh

    def volume(self, solid: Any) -> float:
        return float(solid.volume())

    def arrays(self, solid: Any) -> MeshArrays:
        vertices = self._arrays.getNumpyVerts(solid)
        return vertices, self._arrays.getNumpyFaces(solid.topology)

    def boolean(self, first: MeshArrays, second: MeshArrays, operation: Operation) -> MeshArrays:
        return Engine.boolean(self, first, second, operation)


class _Pymeshlab(_OfArrays):
    """The engine pymeshlab, whose set operations are libigl's."""

    name = "pymeshlab"

    def __init__(self) -> None:
        import pymeshlab

        self._package = pymeshlab

    def boolean(self, first: MeshArrays, second: MeshArrays, operation: Operation) -> MeshArrays:
        meshes = self._package.MeshSet()
        for vertices, faces in (first, second):
            meshes.add_mesh(self._package.Mesh(vertices, faces))
        combine = getattr(meshes, f"generate_boolean_{operation}")
        combine(first_mesh=0, second_mesh=1)
        made = meshes.current_mesh()
        return made.vertex_matrix(), made.face_matrix()


class _Vtk(_OfArrays):
    """The engine VTK, by its boolean filter for polygonal data."""

    name = "vtk"

    def __init__(self) -> None:
        import vtk
        from vtk.util import numpy_support

        self._package, self._numpy = vtk, numpy_support

    def boolean(self, first: MeshArrays, second: MeshArrays, operation: Operation) -> MeshArrays:
        combine = self._package.vtkBooleanOperationPolyDataFilter()
        getattr(combine, f"SetOperationTo{operation.capitalize()}")()
        for port, mesh in enumerate((first, second)):
            combine.SetInputData(port, self._polygons(mesh))
        combine.Update()
        made = combine.GetOutput()
        points = self._numpy.vtk_to_numpy(made.GetPoints().GetData())
        corners = self._numpy.vtk_to_numpy(made.GetPolys().GetConnectivityArray())
        return points, corners.reshape(-1, 3)

    def _polygons(self, mesh: MeshArrays) -> Any:
        points, cells = self._package.vtkPoints(), self._package.vtkCellArray()
        points.SetData(self._numpy.numpy_to_vtk(mesh[0], deep=True))
        corners = self._numpy.numpy_to_vtkIdTypeArray(mesh[1].ravel().astype(np.int64), deep=True)
        starts = np.arange(0, 3 * len(mesh[1]) + 1, 3, dtype=np.int64)
        cells.SetData(self._numpy.numpy_to_vtkIdTypeArray(starts, deep=True), corners)
        made = self._package.vtkPolyData()
        made.SetPoints(points)
        made.SetPolys(cells)
        return made


#: All engines by name: ours, then the main rival, then the others by speed.
ENGINES: dict[str, type[Engine]] = {
    made.name: made for made in (_Bspcsg, _Manifold, _Trueform, _Meshlib, _Pymeshlab, _Vtk)
}


def installed() -> dict[str, str]:
    """Return the engines that can be imported, with their versions."""
    return {name: found for name in ENGINES if (found := version_of(name))}


def version_of(name: str) -> str:
    """Return the version of an installed engine, or "" if it is not installed."""
    if name == _Bspcsg.name:
        # A checkout on the path has no metadata of an installed package.
        return str(import_module(name).__version__)
    try:
        return version(name) if find_spec(name) is not None else ""
    except (PackageNotFoundError, ImportError, ValueError):
        return ""
