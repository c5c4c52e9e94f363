"""Splitting of solids by planes and solids, and into connected parts."""

import numpy as np

from ..._core import suited_pitch
from ..._types import Scalar, Vector
from ...errors import InvalidMeshError, core_errors
from ...mesh.mesh import Mesh
from ...operations.parts import connected_parts, sides_of_plane
from ...shapes.primitives import half_space
from ...solid.ledger import counted, uncounted
from ...solid.solid import Solid, given_pitch, keeping_pitch, solid_of_mesh

#: The smallest positive double.
_MIN_POSITIVE = float(np.nextafter(0, 1))


@uncounted
def split(solid: Solid, normal: str | Vector | Solid, offset: Scalar = 0.0) -> tuple[Solid, Solid]:
    """Split a solid by a plane or another solid into two parts (see `Solid.split`)."""
    if isinstance(normal, Solid):
        return solid & normal, solid - normal
    return sides_of_plane(solid, normal, offset)


@counted
def trim(solid: Solid, normal: str | Vector, offset: Scalar = 0.0) -> Solid:
    """Return the part of a solid on the side to which a plane's normal points."""
    return solid - half_space(normal, offset)


@uncounted
def decompose(solid: Solid) -> list[Solid]:
    """Return the connected parts of a solid, the largest first (see `Solid.decompose`)."""
    meshes = connected_parts(solid)
    if len(meshes) == 1:
        return [solid]
    parts = (_part(mesh, solid.pitch) for mesh in meshes)
    given = given_pitch(solid)
    return [keeping_pitch(part, given) for part in parts if part is not None]


def _part(mesh: Mesh, pitch: int) -> Solid | None:
    """Return the solid that a mesh bounds; None if it is too thin for coordinates in doubles.

    A finer lattice is chosen if the solid would vanish on the lattice of the given pitch.
    """
    if mesh.volume > mesh.area * 10.0**pitch:
        # Snapping moves no corner by a whole lattice step, so the solid cannot vanish.
        return solid_of_mesh(mesh, pitch=pitch)
    largest = float(np.abs(mesh.vertices).max())
    with core_errors():
        finest = suited_pitch(largest, _MIN_POSITIVE)
    found = (
        _solid_on(mesh, exponent) for exponent in sorted({pitch, min(pitch, finest)}, reverse=True)
    )
    return next((solid for solid in found if solid is not None), None)


def _solid_on(mesh: Mesh, pitch: int) -> Solid | None:
    try:
        solid = solid_of_mesh(mesh, pitch=pitch)
    except InvalidMeshError as error:
        if error.code != "empty_mesh":
            raise
        return None
    return None if solid.is_empty else solid
