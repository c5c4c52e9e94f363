"""Boxes with round edges and corners."""

import itertools
import math

import numpy as np

from ..._types import FloatArray, IndexArray, Scalar, Vector
from ...errors import invalid_parameter
from ...mesh.weld import welded
from ...parameters import SEGMENTS, not_negative, refuse_many_corners, sides_around, truth_value
from ...shapes.arrays import from_arrays
from ...shapes.primitives import box, edge_lengths
from ...solid.ledger import counted
from ...solid.solid import Solid
from .patches import patch_directions, patch_faces


@counted
def rounded_box(
    size: Scalar | Vector,
    *numbers: Scalar,
    r: Scalar | None = None,
    segments: int = SEGMENTS,
    center: bool = False,
) -> Solid:
    """Return a box with round edges and corners.

    Parameters
    ----------
    size : float or (3,) float
        Edge lengths in model units; one number makes a cube.
    *numbers : float
        The lengths along y and z, if `size` is the length along x; then the radius, unless it is
        given as `r`.
    r : float
        Radius of the edges, at most half of the shortest edge length; 0 makes a plain box.
    segments : int
        Number of sides of a full circle, at least 4; each edge has a quarter of them, rounded up.
    center : bool
        True if the middle of the box is at the origin. Otherwise its bounding box has its corner of
        least coordinates there.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, or the radius leaves the edges no room.
    LimitError
        If the solid would have too many corners.

    Examples
    --------
    >>> import bspcsg as csg
    >>> round(csg.rounded_box((4, 3, 2), 0.5, segments=4).volume, 4)
    20.1667
    >>> csg.rounded_box(4, 3, 2, r=0.5) == csg.rounded_box((4, 3, 2), 0.5)
    True
    """
    given = numbers if r is None else (*numbers, r)
    if len(given) not in (1, 3):
        raise invalid_parameter(
            "A rounded box needs one size or three sizes, and the radius r, as in (4, 3, 2), 0.5."
        )
    *others, round_by = given
    lengths = edge_lengths(size, *others)
    radius, around = not_negative(round_by, "r"), sides_around(4, segments, "segments")
    if radius == 0:
        return box(lengths, center=center)
    if radius > lengths.min() / 2:
        raise invalid_parameter(
            f"r must be at most half of the shortest edge, {lengths.min() / 2:g}, not {radius:g}."
        )
    steps = math.ceil(around / 4)
    refuse_many_corners(4 * (steps + 1) * (steps + 2), "This box")
    vertices, faces = _rounded(lengths, radius, steps)
    return from_arrays(
        *_proper(vertices if truth_value(center, "center") else vertices + lengths / 2, faces)
    )


def _rounded(lengths: FloatArray, radius: float, steps: int) -> tuple[FloatArray, IndexArray]:
    """Return vertices and faces of a centred rounded box; some faces are turned inwards."""
    unit = patch_directions(np.eye(3), steps)
    signs = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    vertices = np.concatenate([sign * (lengths / 2 - radius + radius * unit) for sign in signs])
    octant = np.arange(8).reshape(2, 2, 2) * len(unit)
    faces = [patch_faces(steps) + start for start in octant.ravel()]
    sides = _sides(steps)
    for axis in range(3):
        below, above = np.moveaxis(octant, axis, 0).reshape(2, 4)
        for low, high in zip(below, above, strict=True):
            faces.append(_quads(low + sides[axis], high + sides[axis]))
        corner = sides[(axis + 1) % 3][-1]
        faces += [
            _quads(face[0] + corner, face[1] + corner) for face in np.moveaxis(octant, axis, 0)
        ]
    return vertices, np.concatenate(faces)


def _sides(steps: int) -> list[IndexArray]:
    """Return, for each axis, the points of a corner patch at which the edge along that axis begins.

    The points of axis k form the patch's side from axis k + 1 to axis k + 2 (modulo 3).
    """
    rows = np.arange(steps + 1)
    first = rows * (rows + 1) // 2
    return [first[-1] + rows, (first + rows)[::-1], first]


def _quads(start: IndexArray, end: IndexArray) -> IndexArray:
    a, b, c, d = start[:-1], start[1:], end[:-1], end[1:]
    return np.concatenate([np.column_stack([a, b, d]), np.column_stack([a, d, c])])


def _proper(vertices: FloatArray, faces: IndexArray) -> tuple[FloatArray, IndexArray]:
    """Return a mesh without degenerate triangles, and with all triangles facing outwards.

    The mesh is convex, so the mean of its points decides which side of a triangle is outside.
    """
    points, same = welded(vertices)
    faces = same[faces]
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    a, b, c = (points[faces[:, k]] - points.mean(axis=0) for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(a, b), c) < 0
    faces[inward] = faces[inward][:, ::-1]
    return points, faces
