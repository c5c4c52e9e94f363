"""Meshes moved by a transform: each coordinate is rounded once, and surfaces still do not cross."""

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
        """Return the mesh moved by the product of the factors, its outside still outside."""
        said = self.attributes and self.attributes.turned(factors.product[:3, :3])
        faces = self.faces
        if factors.mirrors:
            faces = np.ascontiguousarray(faces[:, ::-1])
            said = said and said.reordered([2, 1, 0])
        return AttributedMesh(transform.apply(factors.product, self.vertices), faces, said)

    def mended(self, before: FloatArray, pitch: int) -> "Mended | None":
        """Return the mesh without the crossings that moving its vertices has made, if it has any.

        Rounding moves each vertex by itself, so that surfaces that touched may cross. This is
        mended by changes of the width of the rounding, where the mesh is closed, by index or once
        its vertices are welded as import does, and did not cross itself there before.

        Parameters
        ----------
        before : (n, 3) float64
            The vertices before they were moved.
        pitch : int
            Exponent of the lattice step: corners go to the lattice where else crossings are left.
        """
        with core_errors():
            found = mesh_moved(before, self.vertices, self.faces, pitch)
        if found is None:
            return None
        kept, faces = found["kept"], found["triangles"]
        said = self.attributes and self.attributes.onto(faces, kept)
        left = np.isin(kept, found["crossings"])
        return Mended(AttributedMesh(found["vertices"], faces, said), kept, np.flatnonzero(left))

    def held_pitch(self, given: int | None) -> int | None:
        """Return the given pitch if its lattice holds all vertices, else None."""
        if given is None or not np.isfinite(self.vertices).all():
            return given
        largest = float(np.abs(self.vertices).max(initial=0))
        return given if largest < (transform.LATTICE_REACH - 1) * 10.0**given else None

    def suited_pitch(self) -> int | None:
        """Return the pitch that its size suits; None if it has none, which its import tells."""
        if len(self.vertices) == 0 or not np.isfinite(self.vertices).all():
            return None
        largest = float(np.abs(self.vertices).max())
        with core_errors():
            return suited_pitch(largest, float(np.ptp(self.vertices, axis=0).max()))


@dataclass(frozen=True, eq=False)
class Mended:
    """A moved mesh of which crossings were mended.

    Parameters
    ----------
    mesh : AttributedMesh
    kept : (m,) int64
        The triangle of the mesh as it was moved that each of these stands for.
    left : (k,) int64
        The triangles that cross others still.
    """

    mesh: AttributedMesh
    kept: IndexArray
    left: IndexArray
