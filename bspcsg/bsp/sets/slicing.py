"""Sections of solids by planes, as regions in coordinates of the plane."""

from fractions import Fraction
from typing import Any, overload

import numpy as np

from ..._types import FloatArray, Scalar, Vector
from ...errors import core_errors
from ...geometry.arrays import axes_of
from ...geometry.hyperplane import Hyperplane, exact_number
from ...geometry.transform import named_axis, vector3
from ...parameters import instance_of, number
from ...solid.solid import Solid
from .region import Region

#: For a normal along an axis: the indices of the two axes that the section's coordinates follow.
_AXES = {
    (1, 0, 0): (1, 2),
    (-1, 0, 0): (2, 1),
    (0, 1, 0): (2, 0),
    (0, -1, 0): (0, 2),
    (0, 0, 1): (0, 1),
    (0, 0, -1): (1, 0),
}


@overload
def slice_solid(
    solid: Solid,
    offset: Scalar = 0.0,
    normal: str | Vector = (0, 0, 1),
    *,
    origin: Vector | None = None,
) -> Region: ...
@overload
def slice_solid(solid: Solid, offset: Vector, normal: str | Vector = (0, 0, 1)) -> list[Region]: ...
def slice_solid(
    solid: Solid,
    offset: Any = 0.0,
    normal: str | Vector = (0, 0, 1),
    *,
    origin: Vector | None = None,
) -> Region | list[Region]:
    """Return the section of a solid by a plane, or a list of sections for several offsets.

    Sections are in coordinates of the plane; parameters are those of `Solid.slice`.
    """
    instance_of(Solid, solid, "solid")
    if axes_of(offset) == 1:
        return _sections(solid, list(offset), normal, None)
    return _sections(solid, [offset], normal, origin)[0]


def _sections(
    solid: Solid, offsets: list[Scalar], normal: str | Vector, origin: Vector | None
) -> list[Region]:
    direction = vector3(named_axis(normal), "normal")
    products = [_product(direction, offset, origin) for offset in offsets]
    planes = [Hyperplane.from_numbers(direction.tolist(), product) for product in products]
    tree = solid.normalized().tree
    # A plane outside the range of the lattice does not cut a bounded solid.
    is_met = [plane.is_above_lattice(tree.pitch) is None for plane in planes]
    if not all(is_met) and not solid.is_bounded:
        is_met = [True] * len(planes)
    met = [plane for plane, meets in zip(planes, is_met, strict=True) if meets]
    with core_errors():
        sections = iter(tree.sections([plane.on_lattice(tree.pitch).row for plane in met]))
    nothing = np.zeros((0, 6))
    found = [next(sections) if meets else nothing for meets in is_met]
    return [_region(edges, direction, tree.pitch) for edges in found]


def _region(edges: FloatArray, normal: FloatArray, pitch: int) -> Region:
    """Return the region that (n, 6) edges in a plane enclose, in the plane's coordinates."""
    segments = _in_plane(edges.reshape(-1, 3), normal).reshape(-1, 2, 2)
    proper = (segments[:, 0] != segments[:, 1]).any(axis=1)
    return Region.from_segments(segments[proper], pitch=pitch)


def _product(normal: FloatArray, offset: Scalar, origin: Vector | None) -> Fraction:
    """Return the exact offset n·x of the plane: `offset`, or n·x at the point `origin`."""
    if origin is None:
        return exact_number(number(offset, "offset"))
    pairs = zip(normal.tolist(), vector3(origin, "origin").tolist(), strict=True)
    return sum((exact_number(n) * exact_number(x) for n, x in pairs), Fraction(0))


def _in_plane(points: FloatArray, normal: FloatArray) -> FloatArray:
    """Return the (n, 2) coordinates of points in the frame of a plane with this normal."""
    u, v = plane_frame(normal)
    columns = [sum(points[:, k] * axis[k] for k in range(3)) for axis in (u, v)]
    return np.column_stack(columns)


def plane_frame(normal: Vector) -> tuple[FloatArray, FloatArray]:
    """Return the two unit vectors of a plane's coordinates, right-handed about its normal.

    For a normal along a coordinate axis they are the two other axes in cyclic order: z gives (x,
    y), x gives (y, z), y gives (z, x); a negative axis exchanges them. For any other normal n, the
    first is the horizontal direction z × n, the second n × (z × n), which points up the slope.
    """
    n = vector3(normal, "normal")
    n = n / np.abs(n).max()
    x, y, z = np.sign(n).astype(int).tolist()
    axes = _AXES.get((x, y, z))
    if axes is not None:
        unit = np.eye(3)
        return unit[axes[0]], unit[axes[1]]
    n = n / np.linalg.norm(n)
    # n is not along an axis here, so z × n is not zero.
    u = np.array([-n[1], n[0], 0.0])
    u /= np.linalg.norm(u)
    return u, np.cross(n, u)
