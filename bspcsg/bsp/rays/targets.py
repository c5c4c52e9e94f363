"""Read the facets at which rays are cast: points, segments or triangles of any object."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..._types import FloatArray, IndexArray
from ...errors import InvalidMeshError
from ...geometry.arrays import doubles
from ...mesh import interop
from ...solid.ledger import uncounted
from ...solid.solid import Solid


@dataclass(frozen=True, eq=False)
class RayTargets:
    """The facets at which rays are cast, all of one dimension.

    Parameters
    ----------
    corners : (n, d, d) float64
        The corners of each facet: one in 1D, two in 2D, three in 3D.
    source : (n, 2) int64 or None
        The input mesh and face of each triangle, if the facets are those of a solid.
    pitch : int or None
        The pitch of the solid's lattice, if the facets are those of a solid.
    unbounded : bool
        True if the facets bound a set whose complement is bounded.
    """

    corners: FloatArray
    source: IndexArray | None = None
    pitch: int | None = None
    unbounded: bool = False

    @property
    def dimension(self) -> int:
        """The dimension of the facets: 1, 2 or 3."""
        return int(self.corners.shape[2])

    def normals(self, facets: Any = slice(None)) -> FloatArray:
        """Return unit normals, (n, d): +1 in 1D, to the right in 2D, by the right-hand rule in 3D.

        Parameters
        ----------
        facets : slice or (n,) int64
            The facets; by default all.
        """
        corners = self.corners[facets]
        edges = corners[:, 1:] - corners[:, :1]
        if self.dimension == 1:
            return np.ones((len(edges), 1))
        normals: FloatArray
        if self.dimension == 2:
            normals = np.stack([edges[:, 0, 1], -edges[:, 0, 0]], axis=1)
        else:
            normals = np.cross(edges[:, 0], edges[:, 1])
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        return np.asarray(normals / np.where(lengths > 0, lengths, 1))

    def sizes(self) -> FloatArray:
        """Return the area of each triangle, the length of each segment, or 1 for points, (n,)."""
        edges = self.corners[:, 1:] - self.corners[:, :1]
        if self.dimension == 1:
            return np.ones(len(edges))
        if self.dimension == 2:
            return np.asarray(np.linalg.norm(edges[:, 0], axis=1))
        return np.asarray(np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / 2)


def facets_from(given: Any) -> RayTargets:
    """Return the facets of an array, a solid, or any mesh object.

    Parameters
    ----------
    given : array_like, Solid, or mesh
        ``(n,)`` for points of the line, ``(n, 2, 2)`` for segments of the plane, ``(n, 3, 3)`` for
        triangles; a `Solid`; a *tuple* ``(vertices, faces)``; or what `Solid.from_mesh` takes. A
        mesh need not be closed.

    Raises
    ------
    InvalidMeshError
        If the object has no facets of these shapes, or an index of a vertex is out of range.
    UnboundedError
        If a solid and its complement are both unbounded, so that its boundary is unbounded.
    """
    if isinstance(given, Solid):
        return _boundary_of(given)
    if isinstance(given, (list, np.ndarray)):
        return RayTargets(_corner_array(given))
    vertices, faces = interop.own_arrays(*interop.arrays_from(given))
    if faces.size and not (faces.min() >= 0 and faces.max() < len(vertices)):
        bad = np.flatnonzero(((faces < 0) | (faces >= len(vertices))).any(axis=1))
        message = f"Face {bad[0]} has a vertex index outside 0 to {len(vertices) - 1}."
        raise InvalidMeshError(message, "index_out_of_range", bad[:10].tolist())
    return RayTargets(vertices[faces])


@uncounted
def _boundary_of(solid: Solid) -> RayTargets:
    """Return the boundary triangles of a solid that is bounded or has a bounded complement."""
    reduced = solid.normalized()
    outside = reduced if reduced.is_bounded else (~solid).normalized()
    unbounded = outside is not reduced and outside.is_bounded
    mesh = (outside if unbounded else reduced).to_mesh()
    faces = mesh.faces[:, ::-1] if unbounded else mesh.faces
    return RayTargets(mesh.vertices[faces], mesh.source, reduced.pitch, unbounded)


def _corner_array(given: Any) -> FloatArray:
    refusal = InvalidMeshError("Facets must be an array of numbers.", "shape")
    array = np.array(doubles(given, refusal), order="C")
    if array.ndim == 1:
        return array.reshape(-1, 1, 1)
    if array.ndim == 3 and array.shape[1:] in ((1, 1), (2, 2), (3, 3)):
        return array
    raise InvalidMeshError(
        f"Facets must have shape (n,), (n, 2, 2) or (n, 3, 3), not {array.shape}.", "shape"
    )


def vectors(given: Any, dimension: int, name: str) -> FloatArray:
    """Return points or directions as (n, d) float64; a single vector becomes one row.

    Raises
    ------
    InvalidMeshError
        If the shape is neither (n, d) nor (d,).
    """
    array = doubles(given, InvalidMeshError(f"{name} must be an array of numbers.", "shape"))
    if dimension == 1 and array.ndim == 1:
        array = array[:, None]
    array = np.atleast_2d(array)
    if array.ndim != 2 or array.shape[1] != dimension:
        shape = np.shape(given)
        message = f"{name} must have shape (n, {dimension}) or ({dimension},), not {shape}."
        raise InvalidMeshError(message, "shape")
    return array


def ray_arrays(
    origins: Any, heads: Any, dimension: int, names: tuple[str, str] = ("Origins", "Directions")
) -> tuple[FloatArray, FloatArray]:
    """Return origins and directions (or targets) as two (n, d) arrays in C order.

    A single origin or direction is repeated for all rays.

    Raises
    ------
    InvalidMeshError
        If the shapes are wrong, or the counts differ and neither is 1.
    """
    first, second = vectors(origins, dimension, names[0]), vectors(heads, dimension, names[1])
    if len(first) != len(second) and 1 not in (len(first), len(second)):
        message = (
            f"There are {len(first)} origins but {len(second)} {names[1].lower()}; give equally"
            " many, or one of either."
        )
        raise InvalidMeshError(message, "shape")
    first, second = np.broadcast_arrays(first, second)
    return np.ascontiguousarray(first), np.ascontiguousarray(second)
