"""Solids by name: boxes, round bodies and half-spaces.

Names and defaults follow OpenSCAD: solids stand on the plane z = 0 and have their corner (boxes) or
axis (round bodies) at the origin, unless ``center=True`` puts their middle there. Round bodies are
polyhedra with `segments` sides, by default 32 as everywhere in this package, and their vertices lie
on the true surface. Lengths are in model units; parameters from which no solid can be made raise
`InvalidParameterError`.
"""

from typing import Any

import numpy as np

from .._types import FloatArray, Scalar, Vector
from ..errors import InvalidMeshError, invalid_parameter
from ..geometry.hyperplane import Hyperplane
from ..geometry.polygon import triangulate
from ..geometry.transform import named_axis, vector3
from ..parameters import (
    SEGMENTS,
    not_negative,
    number,
    positive,
    radius_or_half_diameter,
    refuse_many_corners,
    sides_around,
    truth_value,
)
from ..solid.leaf import PlaneLeaf
from ..solid.ledger import counted
from ..solid.solid import Solid, from_leaf
from .arrays import from_arrays
from .profile import extrude, revolve
from .sweep import surface_of_revolution, unit_circle

__all__ = [
    "box",
    "cone",
    "cube",
    "cylinder",
    "extrude",
    "half_space",
    "prism",
    "revolve",
    "sphere",
    "torus",
]

# The triangles of the unit cube; corner (x, y, z) has number 4x + 2y + z.
_BOX_FACES = np.array(
    [
        [0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5],
        [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6],
        [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3],
    ],
    dtype=np.int64,
)  # fmt: skip


def edge_lengths(size: Any, y: Any = None, z: Any = None) -> FloatArray:
    """Return the lengths along x, y and z, (3,), given as one number, three numbers or a vector.

    Raise `InvalidParameterError` for a length that is not above 0.
    """
    alone = y is None and z is None
    if not alone and (y is None or z is None):
        raise invalid_parameter("A box needs one edge length or three edge lengths, not two.")
    lengths = vector3(size if alone else (size, y, z), "size", spread=alone)
    for length in lengths:
        positive(length, "size")
    return lengths


@counted
def box(
    size: Scalar | Vector,
    y: Scalar | bool | None = None,
    z: Scalar | None = None,
    *,
    center: bool = False,
) -> Solid:
    """Return a box with edges parallel to the axes.

    Parameters
    ----------
    size : float or (3,) float
        Edge lengths in model units; one number alone makes a cube.
    y, z : float, optional
        The edge lengths along y and z, if `size` is the length along x. A truth value as second
        argument means `center`.
    center : bool
        True if the middle is at the origin, instead of the corner with the least coordinates.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.box(1, 2, 3).volume, csg.box((1, 2, 3)) == csg.box(1, 2, 3)
    (6.0, True)
    """
    if isinstance(y, (bool, np.bool_)):
        y, center = None, bool(y)
    lengths = edge_lengths(size, y, z)
    corners = np.indices((2, 2, 2)).reshape(3, 8).T
    is_central = truth_value(center, "center")
    vertices = (corners - 0.5) * lengths if is_central else corners * lengths
    return from_arrays(vertices, _BOX_FACES)


@counted
def cube(
    size: Scalar | Vector,
    y: Scalar | bool | None = None,
    z: Scalar | None = None,
    *,
    center: bool = False,
) -> Solid:
    """Return a cube with edge length `size`, or a box; a synonym of `box`."""
    return box(size, y, z, center=center)


@counted
def sphere(r: Scalar | None = None, segments: int = SEGMENTS, *, d: Scalar | None = None) -> Solid:
    """Return a polyhedral sphere about the origin, whose vertices lie on meridians and parallels.

    Parameters
    ----------
    r, d : float
        Radius or diameter, in model units; give one of them.
    segments : int
        Number of sides of the equator, at least 3; there are half as many bands from pole to pole.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.sphere(1, segments=4).to_mesh()
    Mesh(6 vertices, 8 faces)
    """
    size, around = (
        positive(radius_or_half_diameter(r, d, "A sphere"), "r"),
        sides_around(3, segments, "segments"),
    )
    bands = max(around // 2, 2)
    refuse_many_corners(around * bands, "This sphere")
    angles = unit_circle(2 * bands)[: bands + 1]
    # The profile runs from pole to pole; each pole is on the axis and so becomes one vertex.
    profile = np.column_stack([angles[:, 1], -angles[:, 0]]) * size
    return from_arrays(*surface_of_revolution(profile, around, closed=False))


@counted
def cylinder(
    h: Scalar,
    r: Scalar | None = None,
    *,
    r1: Scalar | None = None,
    r2: Scalar | None = None,
    d: Scalar | None = None,
    d1: Scalar | None = None,
    d2: Scalar | None = None,
    segments: int = SEGMENTS,
    center: bool = False,
) -> Solid:
    """Return a cylinder, cone or frustum along z.

    Parameters
    ----------
    h : float
        Height.
    r : float
        Radius of both ends, unless `r1` or `r2` is given.
    r1, r2 : float
        Radius of the lower and the upper end; one of them may be 0.
    d, d1, d2 : float
        Diameters, to be given instead of the radii.
    segments : int
        Number of sides around the axis, at least 3.
    center : bool
        True if the middle is at z = 0, instead of the lower end.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.cylinder(h=3, r=1, segments=4).volume
    6.0
    """
    both = None if r is None and d is None else radius_or_half_diameter(r, d, "A cylinder")
    low, high = (_end_radius(*end, both) for end in ((r1, d1), (r2, d2)))
    if low == high == 0:
        raise invalid_parameter("A cylinder needs a radius above 0 at one end at least.")
    height, around = positive(h, "h"), sides_around(3, segments, "segments")
    base = -height / 2 if truth_value(center, "center") else 0.0
    ends = np.array([[low, base], [high, base + height]])
    vertices, sides = surface_of_revolution(ends, around, closed=False)
    cap = triangulate([unit_circle(around)])
    # An apex is a single vertex and needs no cap.
    bottom = cap[:, ::-1] if low else cap[:0]
    top = cap + (len(vertices) - around) if high else cap[:0]
    return from_arrays(vertices, np.concatenate([sides, bottom, top]))


@counted
def cone(
    h: Scalar,
    r: Scalar | None = None,
    *,
    d: Scalar | None = None,
    segments: int = SEGMENTS,
    center: bool = False,
) -> Solid:
    """Return a cone of height `h` along z, with its apex up and base radius `r` or diameter `d`."""
    return cylinder(
        h, r1=radius_or_half_diameter(r, d, "A cone"), r2=0, segments=segments, center=center
    )


@counted
def torus(
    r: Scalar | None = None,
    tube: Scalar | None = None,
    *,
    d: Scalar | None = None,
    tube_d: Scalar | None = None,
    segments: int = SEGMENTS,
    tube_segments: int = SEGMENTS // 2,
) -> Solid:
    """Return a torus around the z axis.

    Parameters
    ----------
    r, d : float
        Distance from the axis to the middle of the tube, or twice that distance; give one.
    tube, tube_d : float
        Radius of the tube, below `r`, or its diameter; give one of them.
    segments, tube_segments : int
        Number of sides around the axis and around the tube, at least 3 each.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.torus(3, 1).genus
    1
    """
    major = positive(radius_or_half_diameter(r, d, "The ring of a torus"), "r")
    minor = positive(radius_or_half_diameter(tube, tube_d, "The tube of a torus"), "tube")
    if minor >= major:
        raise invalid_parameter(
            f"The tube radius of a torus must be smaller than its ring radius {major:g}, but is"
            f" {minor:g}."
        )
    along = sides_around(3, segments, "segments")
    across = sides_around(3, tube_segments, "tube_segments")
    refuse_many_corners(along * across, "This torus")
    profile = unit_circle(across) * minor + (major, 0)
    return from_arrays(*surface_of_revolution(profile, along, closed=True))


@counted
def prism(
    sides: int,
    h: Scalar,
    r: Scalar | None = None,
    *,
    d: Scalar | None = None,
    center: bool = False,
) -> Solid:
    """Return a prism along z with a regular polygon as base.

    Parameters
    ----------
    sides : int
        Number of sides of the polygon, at least 3.
    h : float
        Height.
    r, d : float
        Distance from the axis to the vertical edges, or twice that distance; give one of them. One
        edge is at y = 0 and positive x.
    center : bool
        True if the middle is at z = 0, instead of the lower end.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.prism(4, h=1, r=1).volume
    2.0
    """
    around = sides_around(3, sides, "sides")
    return cylinder(h, radius_or_half_diameter(r, d, "A prism"), segments=around, center=center)


@counted
def half_space(normal: str | Vector, offset: Scalar = 0.0) -> Solid:
    """Return the solid of all points x with ``normal . x <= offset``, bounded by one plane.

    Parameters
    ----------
    normal : "x", "y", "z" or (3,) float
        The plane's normal, which points outwards and need not have unit length.
    offset : float
        The value of ``normal . x`` on the plane.

    Raises
    ------
    InvalidMeshError
        If the normal is zero or a number is not finite ("bad_normal").
    LimitError
        If the plane is outside the lattice of the solids with which it is combined ("too_large").

    Notes
    -----
    The numbers count as the decimals they are written as, and transforms move the plane by exact
    arithmetic. When the half-space is combined with other solids, a plane that contains points of
    their common lattice stays exact, and is coplanar with faces that have their corners on it. Any
    other plane is moved to the nearest parallel plane that contains lattice points, by at most half
    a step, and the finding ``half_space_rounded`` gives the distance. Normals of more than 106
    bits, after rotations by odd angles, are rounded to 61 bits, which the finding includes. A
    half-space by itself chooses a lattice step down to 10**-12 if its plane needs it.

    Examples
    --------
    >>> import bspcsg as csg
    >>> (csg.cube(2) & csg.half_space((0, 0, 1), 0.5)).volume
    2.0
    >>> csg.half_space((1, 1, 1), 1).classify([(1, 0, 0), (0.5, 0.25, 0.25)]).tolist()
    [0, 0]
    """
    try:
        x, y, z = named_axis(normal)
    except (TypeError, ValueError) as error:
        message = "normal must be 'x', 'y', 'z' or a vector of three numbers."
        raise InvalidMeshError(message, "bad_normal") from error
    number(offset, "offset")
    return from_leaf(PlaneLeaf(Hyperplane.from_numbers((x, y, z), offset)))


def _end_radius(r: Scalar | None, d: Scalar | None, both: Any) -> float:
    return not_negative(radius_or_half_diameter(r, d, "Each end of a cylinder", default=both), "r")
