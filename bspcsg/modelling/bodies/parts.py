"""Solids cut in two, and taken apart."""

from ..._types import Scalar, Vector
from ...operations.parts import connected_parts, sides_of_plane
from ...shapes.primitives import half_space
from ...solid.counting import counted, uncounted
from ...solid.solid import Solid, solid_of_mesh


@uncounted
def split(solid: Solid, normal: str | Vector | Solid, offset: Scalar = 0.0) -> tuple[Solid, Solid]:
    """Return both sides of a plane or of another solid's surface (see `Solid.split`)."""
    if isinstance(normal, Solid):
        return solid & normal, solid - normal
    return sides_of_plane(solid, normal, offset)


@counted
def trim(solid: Solid, normal: str | Vector, offset: Scalar = 0.0) -> Solid:
    """Return what lies on the side of a plane where its normal points (see `Solid.trim`)."""
    return solid - half_space(normal, offset)


@uncounted
def decompose(solid: Solid) -> list[Solid]:
    """Return the connected parts, the largest first (see `Solid.decompose`)."""
    meshes = connected_parts(solid)
    if len(meshes) == 1:
        return [solid]
    return [solid_of_mesh(mesh, pitch=solid.pitch) for mesh in meshes]
