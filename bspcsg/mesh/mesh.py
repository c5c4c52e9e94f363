"""`Mesh`: the triangles of a solid as arrays, with volume, area and other measures."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from .._core import mesh_counts, mesh_measures, mesh_moments
from .._core import surfaces_of as triangle_surfaces
from .._types import FloatArray, IndexArray
from ..attributes.attributes import Attributes, Later, Values
from ..attributes.material import Material
from ..errors import core_errors, deprecated
from .certificate import Certificate, certify


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """A closed triangle mesh; seen from outside, the corners of a triangle are counter-clockwise.

    The arrays of a solid's mesh are read-only and its attributes cannot be replaced, because the
    solid returns the same mesh again; copy arrays before you change them. Measures are cached, so
    make a new mesh if you change the arrays.

    Parameters
    ----------
    vertices : (n, 3) float64
        In model units.
    faces : (m, 3) int64
        Indices of `vertices`.
    source : (m, 2) int64
        The origin of each face: the number of the input mesh, counted from 0 in the order of
        the expression, and the index of the face in that mesh.
    carried : Later, optional
        The attributes, computed when they are first read; for the modules of this package.

    Examples
    --------
    >>> import bspcsg as csg
    >>> mesh = csg.cube(2).to_mesh()
    >>> mesh
    Mesh(8 vertices, 12 faces)
    >>> mesh.volume, mesh.area, mesh.euler_number
    (8.0, 24.0, 2)
    """

    vertices: FloatArray
    faces: IndexArray
    source: IndexArray
    carried: Later | None = field(default=None, repr=False)

    def __repr__(self) -> str:
        """Return the numbers of vertices and faces as text."""
        return f"Mesh({len(self.vertices)} vertices, {len(self.faces)} faces)"

    def __iter__(self) -> Iterator[Any]:
        """Yield vertices and faces, so that ``vertices, faces = mesh`` works."""
        yield self.vertices
        yield self.faces

    def frozen(self) -> "Mesh":
        """Make the arrays read-only, and return this mesh."""
        for array in (self.vertices, self.faces, self.source):
            array.flags.writeable = False
        return self

    @property
    def attributes(self) -> Attributes:
        """The attributes of vertices, corners and faces; empty if the mesh has none."""
        return Attributes(self.faces) if self.carried is None else self.carried.now()

    @property
    def vertex_attributes(self) -> Mapping[str, Values]:
        """Values of vertices, (n, …) arrays by name.

        An attribute is here if all faces at each vertex agree on its value; else it is in
        `corner_attributes`, since the faces on both sides of a cut have their own values.
        """
        return MappingProxyType(self.attributes.vertex)

    @property
    def corner_attributes(self) -> Mapping[str, Values]:
        """Values of the corners of each face, (m, 3, …) arrays by name."""
        return MappingProxyType(self.attributes.corner)

    @property
    def face_attributes(self) -> Mapping[str, Values]:
        """Values of faces, (m, …) arrays by name."""
        return MappingProxyType(self.attributes.face)

    @property
    def materials(self) -> Mapping[str, Material]:
        """The materials by name; the face attribute ``"material"`` has the name for each face."""
        return MappingProxyType(self.attributes.materials)

    def carrying(self, carried: Later) -> "Mesh":
        """Return a mesh of the same arrays with attributes; for the modules of this package."""
        return replace(self, carried=carried)

    @cached_property
    def certificate(self) -> Certificate:
        """The result of an exact check for open edges, crossings and triangles without area."""
        return certify(self.vertices, self.faces)

    @property
    def volume(self) -> float:
        """Volume in cubic model units: signed tetrahedra, whose sum is rounded only once."""
        return self._measures[0]

    @property
    def area(self) -> float:
        """Surface area in square model units."""
        return self._measures[1]

    @property
    def centroid(self) -> FloatArray:
        """Centre of volume, (3,) float64, in model units; NaN if the mesh has no volume."""
        return self._moments[0].copy()

    @property
    def inertia(self) -> FloatArray:
        """The inertia tensor about the centroid, (3, 3) float64, at density 1; NaN without volume.

        It is in model units to the fifth power.
        """
        second = self._moments[1]
        moments: FloatArray = np.trace(second) * np.eye(3) - second
        return moments

    @property
    def bounds(self) -> FloatArray | None:
        """Smallest and largest x, y and z, (2, 3) float64, or None for an empty mesh."""
        if len(self.faces) == 0:
            return None
        used = self.vertices
        if self._counts[0] < len(used):
            is_used = np.zeros(len(used), dtype=bool)
            is_used[self.faces] = True
            used = used[is_used]
        return np.array([used.min(axis=0), used.max(axis=0)])

    @property
    def euler_number(self) -> int:
        """The Euler number: vertices minus edges plus faces; unused vertices do not count."""
        vertices, edges, _, _ = self._counts
        return vertices - edges + len(self.faces)

    @property
    def open_edges(self) -> int:
        """The number of directed edges without exactly one opposite edge, by vertex index."""
        return self._counts[2]

    @property
    def surface_count(self) -> int:
        """Number of connected surfaces; the wall of a closed cavity is a separate surface."""
        return self._counts[3]

    @property
    def components(self) -> int:
        """The old name of `surface_count`; deprecated."""
        deprecated("Mesh.components", "surface_count")
        return self.surface_count

    @property
    def genus(self) -> int:
        """Number of handles, summed over all connected surfaces."""
        return self.surface_count - self.euler_number // 2

    def _middle(self) -> FloatArray:
        # An origin inside the mesh avoids cancellation.
        bounds = self.bounds
        return np.zeros(3) if bounds is None else bounds[0] + (bounds[1] - bounds[0]) / 2

    @cached_property
    def _measures(self) -> tuple[float, float]:
        x, y, z = self._middle().tolist()
        with core_errors():
            return mesh_measures(self.vertices, self.faces, (x, y, z))

    @cached_property
    def _moments(self) -> tuple[FloatArray, FloatArray]:
        """The centroid (3,) and the second moments about it (3, 3); NaN if there is no volume."""
        middle = self._middle()
        x, y, z = middle.tolist()
        with core_errors():
            volume, centroid, second = mesh_moments(self.vertices, self.faces, (x, y, z))
        if volume == 0:
            return np.full(3, np.nan), np.full((3, 3), np.nan)
        return middle + centroid, np.array(second)

    @cached_property
    def _counts(self) -> tuple[int, int, int, int]:
        """The counts of used vertices, edges, open edges and connected surfaces, in this order."""
        with core_errors():
            return mesh_counts(self.faces, len(self.vertices))


def surfaces_of(faces: IndexArray, vertex_count: int) -> IndexArray:
    """Return for each face the number of its connected surface, from 0.

    Surfaces are numbered in the order of their smallest vertex indices.

    Parameters
    ----------
    faces : (m, 3) int64
        Vertex indices of each face; faces that share a vertex are connected.
    vertex_count : int

    Returns
    -------
    (m,) int64
    """
    with core_errors():
        return triangle_surfaces(faces, vertex_count)
