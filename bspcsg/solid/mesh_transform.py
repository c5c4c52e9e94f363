"""Meshes under transforms: each coordinate is rounded once, and crossings are mended."""

from dataclasses import dataclass

import numpy as np

from .._core import mesh_moved, suited_pitch
from .._types import FloatArray, IndexArray
from ..attributes.attributes import Attributes
from ..errors import core_errors
from ..geometry import transform
from ..geometry.chain import FactorChain


@dataclass(frozen=True, eq=False)
class AttributedMesh:
    """A mesh with the attributes of its faces.

    Parameters
    ----------
    vertices : (n, 3) float64, in model units
    faces : (m, 3) int64, indices of `vertices`
    attributes : Attributes or None
    """

    vertices: FloatArray
    faces: IndexArray
    attributes: Attributes | None = None

    def moved(self, factors: FactorChain) -> "AttributedMesh":
        """Return the mesh after a transform; faces are reversed if it mirrors, to face outwards."""
        attributes = self.attributes and self.attributes.turned(factors.product[:3, :3])
        faces = self.faces
        if factors.mirrors:
            faces = np.ascontiguousarray(faces[:, ::-1])
            attributes = attributes and attributes.reordered([2, 1, 0])
        return AttributedMesh(transform.apply(factors.product, self.vertices), faces, attributes)

    def mended(self, before: FloatArray, pitch: int) -> "Mended | None":
        """Return the mesh without the crossings that moving its vertices caused; None if unchanged.

        Rounding moves each vertex separately, so surfaces that touched may cross. Such crossings
        are mended by changes as small as the rounding. The mesh must be closed (each edge shared by
        index, or once its vertices are welded as in import), and must not have crossed itself
        before it was moved.

        Parameters
        ----------
        before : (n, 3) float64
            The vertices before they were moved.
        pitch : int
            Exponent of the lattice step. Where crossings would remain, corners move to the lattice.
        """
        with core_errors():
            found = mesh_moved(before, self.vertices, self.faces, pitch)
        if found is None:
            return None
        kept, faces = found["kept"], found["triangles"]
        attributes = self.attributes and self.attributes.onto(faces, kept)
        left = np.isin(kept, found["crossings"])
        return Mended(
            AttributedMesh(found["vertices"], faces, attributes), kept, np.flatnonzero(left)
        )

    def pitch_in_range(self, given: int | None) -> int | None:
        """Return the given pitch if all vertices lie in the range of its lattice, else None."""
        if given is None or not np.isfinite(self.vertices).all():
            return given
        largest = float(np.abs(self.vertices).max(initial=0))
        return given if largest < (transform.LATTICE_REACH - 1) * 10.0**given else None

    def suited_pitch(self) -> int | None:
        """Return the pitch that suits the mesh's coordinates and extent, or None without one."""
        if len(self.vertices) == 0 or not np.isfinite(self.vertices).all():
            return None
        largest = float(np.abs(self.vertices).max())
        with core_errors():
            return suited_pitch(largest, float(np.ptp(self.vertices, axis=0).max()))


@dataclass(frozen=True, eq=False)
class Mended:
    """A moved mesh after its crossings were mended.

    Parameters
    ----------
    mesh : AttributedMesh
    origins : (m,) int64
        For each triangle, the triangle of the moved mesh that it comes from.
    crossing : (k,) int64
        The indices of triangles that still cross other triangles.
    """

    mesh: AttributedMesh
    origins: IndexArray
    crossing: IndexArray
