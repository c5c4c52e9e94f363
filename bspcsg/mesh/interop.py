"""Conversion of mesh objects of other libraries to arrays, and of meshes to manifold3d.

An object is recognized by its Python attributes, not by its type, so no library is imported.
"""

import importlib
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import numpy as np

from .._types import FloatArray, IndexArray
from ..errors import InvalidMeshError, MissingPartError, invalid_parameter
from ..geometry.arrays import doubles_or_none, is_masked
from ..geometry.polygon import triangulate_face
from .mesh import Mesh

if TYPE_CHECKING:
    import manifold3d

#: The result of a reader: vertices and faces, in any form that `mesh_arrays` takes.
AnyArrays: TypeAlias = tuple[Any, Any]

_Array = TypeVar("_Array", FloatArray, IndexArray)

#: The largest distance between a curved shape and its triangles, in model units.
TESSELLATION_TOLERANCE = 0.01


def arrays_from(mesh: Any, tolerance: float = TESSELLATION_TOLERANCE) -> AnyArrays:
    """Return vertices and faces of a mesh object of any known library, or of a pair of arrays.

    Parameters
    ----------
    mesh : object
    tolerance : float
        For curved shapes: the largest distance between surface and triangles, in model units.

    Raises
    ------
    InvalidMeshError
        If the object has none of the known sets of Python attributes.
    """
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return mesh[0], mesh[1]
    if all(hasattr(mesh, name) for name in _SHAPE):
        return _from_shape(mesh, tolerance)
    for names, holder in _HOLDERS:
        if all(hasattr(mesh, name) for name in names):
            return arrays_from(holder(mesh), tolerance)
    if all(hasattr(mesh, name) for name in _WORKPLANE):
        return _joined([arrays_from(shape, tolerance) for shape in _shapes_on(mesh)])
    for names, reader in _READERS:
        if all(hasattr(mesh, name) for name in names):
            return reader(mesh)
    raise invalid_parameter(
        f"The {type(mesh).__name__} is not a mesh: expected an object with vertices and faces,"
        f" or a pair (vertices, faces).{_advice(mesh)}"
    )


def _advice(mesh: Any) -> str:
    """Return advice for an object that is a grid of cells, no surface; else an empty string."""
    if hasattr(mesh, "extract_surface"):
        return " For a grid of cells, pass mesh.extract_surface()."
    return ""


def are_empty(arrays: AnyArrays) -> bool:
    """Say whether a pair (vertices, faces) has neither vertices nor faces."""
    try:
        return not any(map(len, arrays))
    except TypeError:  # no arrays at all: another check reports this
        return False


def mesh_arrays(vertices: Any, faces: Any) -> tuple[FloatArray, IndexArray]:
    """Return vertices (n, 3) float64 and triangles (m, 3) int64, without a copy if possible.

    Raises
    ------
    InvalidMeshError
        If an array has another shape, or an index is no whole number.
    """
    points = points_array(vertices, "Vertices")
    return points, face_array(faces, points)


def own_arrays(vertices: Any, faces: Any) -> tuple[FloatArray, IndexArray]:
    """Return vertices (n, 3) float64 and triangles (m, 3) int64 that share no memory with input."""
    points, triangles = mesh_arrays(vertices, faces)
    return _own(points, vertices), _own(triangles, faces)


def points_array(points: Any, name: str = "Points") -> FloatArray:
    """Return points as (n, 3) float64 in C order, without a copy if possible."""
    array = doubles_or_none(points)
    if array is None:
        raise InvalidMeshError(f"{name} must be an array of numbers of shape (n, 3).", "shape")
    if array.size == 0:
        return np.zeros((0, 3))
    if array.ndim != 2 or array.shape[1] != 3:
        raise InvalidMeshError(f"{name} must have shape (n, 3), not {array.shape}.", "shape")
    return np.ascontiguousarray(array)


def face_array(faces: Any, vertices: FloatArray) -> IndexArray:
    """Return faces as triangles, (m, 3) int64 in C order; larger polygons are triangulated."""
    if is_masked(faces):
        raise InvalidMeshError(
            "Faces must not be a masked array; pass the unmasked faces only.", "shape"
        )
    try:
        array = np.asarray(faces)
    except ValueError:  # faces of different lengths
        return _triangles(faces, vertices)
    if array.size == 0:
        return np.zeros((0, 3), dtype=np.int64)
    if array.ndim == 0:
        raise InvalidMeshError(
            "Faces must be a list of lists of at least 3 vertex indices each.", "shape"
        )
    if array.dtype == object:
        return _triangles(faces, vertices)
    if array.ndim != 2 or array.shape[1] < 3:
        raise InvalidMeshError(f"Faces must have shape (m, 3), not {array.shape}.", "shape")
    indices = np.ascontiguousarray(_whole(array))
    return indices if indices.shape[1] == 3 else _triangles(indices, vertices)


def _own(array: _Array, given: Any) -> _Array:
    """Return `array`, copied if it may share memory with `given`."""
    return array if array is not given and array.base is None else array.copy()


def _whole(array: Any) -> IndexArray:
    """Return indices as int64; raise an `InvalidMeshError` if a number is not a 64-bit integer."""
    if array.dtype.kind not in "iuf":
        raise InvalidMeshError(
            f"Vertex indices of faces must be integers, not {array.dtype}.", "shape"
        )
    if array.dtype.kind == "i":
        integers: IndexArray = array.astype(np.int64, copy=False)
        return integers
    with np.errstate(invalid="ignore"):  # NaN, which the comparison finds
        indices: IndexArray = array.astype(np.int64)
    if not (indices == array).all():
        raise InvalidMeshError("Vertex indices of faces must be integers below 2**63.", "shape")
    return indices


def _triangles(faces: Iterable[Any], vertices: FloatArray) -> IndexArray:
    triangles = []
    for number, face in enumerate(faces):
        corners = _whole(np.asarray(face))
        if corners.ndim != 1 or len(corners) < 3:
            raise InvalidMeshError(
                f"Face {number} must be a list of at least 3 vertex indices.", "shape", [number]
            )
        if corners.min() < 0 or corners.max() >= len(vertices):
            message = f"Face {number} has a vertex index outside 0 to {len(vertices) - 1}."
            raise InvalidMeshError(message, "index_out_of_range", [number])
        triangles.append(corners[triangulate_face(vertices[corners])])
    return np.concatenate(triangles) if triangles else np.zeros((0, 3), dtype=np.int64)


# Readers. Each takes an object with the Python attributes that `_READERS` names for it.


def _from_manifold(mesh: Any) -> AnyArrays:
    return _from_manifold_mesh(mesh.to_mesh64())


def _from_manifold_mesh(mesh: Any) -> AnyArrays:
    vertices = np.asarray(mesh.vert_properties)[:, :3]
    same = np.arange(len(vertices))
    same[np.asarray(mesh.merge_from_vert, dtype=np.int64)] = mesh.merge_to_vert
    return vertices, same[np.asarray(mesh.tri_verts, dtype=np.int64)]


def _from_polydata(mesh: Any) -> AnyArrays:
    return mesh.points, _unpadded(np.asarray(mesh.faces))


def _unpadded(stream: IndexArray) -> Any:
    """Divide an array of count, index, index, …, count, … into faces."""
    if len(stream) % 4 == 0 and (stream[::4] == 3).all():
        return stream.reshape(-1, 4)[:, 1:]
    faces = []
    position = 0
    while position < len(stream):
        end = position + 1 + int(stream[position])
        faces.append(stream[position + 1 : end])
        position = end
    return faces


def _from_vtk(mesh: Any) -> AnyArrays:
    points = [mesh.GetPoint(index) for index in range(mesh.GetNumberOfPoints())]
    faces = []
    for index in range(mesh.GetNumberOfCells()):
        cell = mesh.GetCell(index)  # the next call overwrites it
        corners = [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]
        # Points and lines are no part of a surface.
        if len(corners) >= 3:
            faces.append(corners)
    return points, faces


def _from_meshio(mesh: Any) -> AnyArrays:
    kinds = {block.type for block in mesh.cells}
    surface = [block for block in mesh.cells if block.type in ("triangle", "quad", "polygon")]
    unknown = kinds - {"triangle", "quad", "polygon", "vertex", "line"}
    if unknown:
        raise invalid_parameter(
            f"The mesh has cells of type {', '.join(sorted(unknown))}, which are not faces; pass"
            " its surface instead."
        )
    if len(surface) == 1:
        return mesh.points, surface[0].data
    return mesh.points, [face for block in surface for face in block.data]


def _from_shape(shape: Any, tolerance: float) -> AnyArrays:
    vertices, faces = shape.tessellate(tolerance)
    return [_coordinates(vertex) for vertex in vertices], faces


def _coordinates(vector: Any) -> tuple[float, ...]:
    return tuple(vector.toTuple() if hasattr(vector, "toTuple") else vector)


def _shapes_on(workplane: Any) -> list[Any]:
    return list(workplane.vals()) if hasattr(workplane, "vals") else [workplane.val()]


def _joined(parts: list[AnyArrays]) -> AnyArrays:
    """Return one mesh of several meshes, concatenated; where they overlap, they form a union."""
    points = [points_array(vertices, "Vertices") for vertices, _ in parts]
    starts = np.cumsum([0, *map(len, points)])
    faces = [
        face_array(given, corners) + start
        for (_, given), corners, start in zip(parts, points, starts, strict=False)
    ]
    return np.concatenate(points), np.concatenate(faces)


#: The Python attributes of a CAD kernel's shape. It is tried before meshes, since such a shape has
#: methods named vertices and faces.
_SHAPE = ("tessellate", "wrapped")

_WORKPLANE = ("val", "plane")

#: Objects that contain a mesh or a shape: their Python attributes, and how to get the content.
_HOLDERS: tuple[tuple[tuple[str, ...], Callable[[Any], Any]], ...] = (
    (("current_mesh",), lambda meshes: meshes.current_mesh()),
    (("part", "pending_faces"), lambda builder: builder.part),
    (("toCompound", "children"), lambda assembly: assembly.toCompound()),
    (("geometry", "to_mesh"), lambda scene: scene.to_mesh()),
    (("to_legacy",), lambda mesh: mesh.to_legacy()),
)

_READERS: tuple[tuple[tuple[str, ...], Callable[[Any], AnyArrays]], ...] = (
    (("to_mesh64",), _from_manifold),
    (("vert_properties", "tri_verts"), _from_manifold_mesh),
    (("vertex_matrix", "face_matrix"), lambda mesh: (mesh.vertex_matrix(), mesh.face_matrix())),
    (("points", "faces"), _from_polydata),
    # Grids have points and cells too, but are no surface: the last name excludes them.
    (("points", "cells", "cell_sets"), _from_meshio),
    (("GetPoint", "GetCell", "GetPolys"), _from_vtk),
    (("vertices", "faces"), lambda mesh: (mesh.vertices, mesh.faces)),
    (("vertices", "triangles"), lambda mesh: (mesh.vertices, mesh.triangles)),
)


def import_optional(name: str, package: str) -> Any:
    """Import an optional module; the error names the package to install.

    Raises
    ------
    MissingPartError
        If the module is not installed; code ``"missing_package"``.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        message = (
            f"The package {name.partition('.')[0]} is needed but not installed. Try: pip install"
            f" {package}"
        )
        raise MissingPartError(message, "missing_package") from error


def to_manifold(mesh: Mesh) -> "manifold3d.Manifold":
    """Return a `manifold3d.Manifold` of a mesh's vertices and faces, without attributes."""
    import manifold3d

    # The binding accepts only writable arrays of exactly these types.
    vertices = np.array(mesh.vertices, dtype=np.float64, order="C")
    faces = np.array(mesh.faces, dtype=np.uint64, order="C")
    return manifold3d.Manifold(manifold3d.Mesh64(vertices, faces))
