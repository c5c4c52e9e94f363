"""Blends along all edges of a face, where some of the edges vanish on the way inwards.

The material that remains below such a face is a roof over its outline, whose sides meet above the
straight skeleton. For a fillet, the roof is bent to the profile of the new surface.
"""

from collections.abc import Set
from itertools import pairwise

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...errors import LimitError
from ...operations.setops import union
from ...solid.solid import Solid
from ..planar.offsetting import offset_region
from .roofs import roof
from .rooms import face_loops, no_room
from .skeleton import Skeleton

#: Degrees by which walls may lean that count as square to a face.
_SQUARE = 1e-4

#: Lattice steps by which what is taken off reaches beyond the face and its walls.
_BEYOND = 20

#: The share of the size by which rounding may lower a roof.
_SAME = 1e-6


def is_cap(skeleton: Skeleton, face: int, chosen: Set[int]) -> bool:
    """Say whether just the edges of a face are selected, and its walls are perpendicular to it."""
    own = np.flatnonzero((skeleton.sides == face).any(axis=1))
    if not set(own.tolist()) <= chosen or len(set(skeleton.is_convex[own].tolist())) > 1:
        return False
    there = {edge for end in skeleton.ends[own].ravel().tolist() for edge in skeleton.edges_at(end)}
    bends = np.abs(180 - skeleton.angles[own])
    return len(there & chosen) == len(own) and bool((np.abs(bends - 90) < _SQUARE).all())


def cap_tool(skeleton: Skeleton, face: int, sign: int, profile: FloatArray, pitch: int) -> Solid:
    """Return the body to remove below a face, or to add above it if the sign is -1.

    Parameters
    ----------
    skeleton : Skeleton
    face, sign : int
    profile : (k, 2) float64
        The new surface from a wall to the face: the distance inside the wall, and the height above
        its start; both ascend from 0 to the size.
    pitch : int
        Of the solid's lattice.

    Raises
    ------
    InvalidParameterError
        If a part of the face would vanish, or it has more than a thousand corners.
    """
    frame = _frame(skeleton.normals[face] * sign)
    loops = [points @ frame.T for points in face_loops(skeleton, face)]
    level = float(np.concatenate(loops)[:, 2].mean())
    figure = Region([points[:: int(sign), :2] for points in loops], pitch=pitch)
    beyond, size = _BEYOND * 10.0**pitch, float(profile[-1, 1])
    roofs = []
    for part in figure.components:
        above = _roof_or_none(part)
        if above is None or above.vertices[:, 2].max() < (1 - _SAME) * profile[-1, 0]:
            place = np.append(part.to_polygons()[0][0], level) @ frame
            raise no_room(skeleton, place, [face])
        roofs.append(above)
    # Evaluate it, so that it is moved as one mesh. Raise it on feet, so that its floor differs from
    # that of the blocks.
    whole = union([*roofs, figure.extrude(size).translate(0, 0, -size)]).normalized()
    grown = offset_region(figure, beyond, "miter")
    tools = []
    for (inner, low), (outer, high) in pairwise(profile.tolist()):
        # The profile bounds a convex body, the intersection of the half-spaces below its lines.
        steep = (high - low) / (outer - inner)
        base = low - steep * inner
        block = grown.extrude(size + beyond - base)
        placed = [_placed(frame, level - size + base, slope) for slope in (1.0, steep)]
        tools.append(block.transform(placed[0]) - whole.transform(placed[1]))
    return union(tools)


def _placed(frame: FloatArray, height: float, steep: float) -> FloatArray:
    """Return the map of z = 0 onto a plane at a height of the frame, with heights scaled."""
    matrix = np.eye(4)
    matrix[:3, :3] = frame.T * (1, 1, steep)
    matrix[:3, 3] = frame[2] * height
    return matrix


def _roof_or_none(figure: Region) -> Solid | None:
    """Return the roof over a figure, or None if it has too many or ambiguous corners."""
    try:
        return roof(figure)
    except LimitError:
        return None


def _frame(normal: FloatArray) -> FloatArray:
    """Return two axes perpendicular to a normal, and it, (3, 3); exact along coordinate axes."""
    level = np.eye(3)[(int(np.abs(normal).argmax()) + 1) % 3]
    first = level - (level @ normal) * normal
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(normal, first), normal])
