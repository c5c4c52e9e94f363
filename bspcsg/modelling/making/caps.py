"""Blends along all edges of a face, if some of the edges shrink to nothing inwards.

The material that remains below such a face is a roof over its outline, whose sides meet above the
straight graph. For a fillet, each chord of the profile has a roof of its own slope.
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
from .blend_fit import face_loops, no_room
from .plane_faces import FaceGraph
from .roofs import roof

#: Walls count as perpendicular to a face if their angle differs from 90 by less, in degrees.
_SQUARE = 1e-4

#: Lattice steps by which the removed solid extends past the face and its walls.
_EXTENSION_STEPS = 20

#: The share of a blend's size by which rounding may lower a roof.
_SAME = 1e-6


def is_cap(graph: FaceGraph, face: int, chosen: Set[int]) -> bool:
    """Return True if a face can be blended as a whole.

    All its edges are selected, all are convex or all concave, no other edge at its corners is
    selected, and the adjacent faces are perpendicular to it.
    """
    own = np.flatnonzero((graph.sides == face).any(axis=1))
    if not set(own.tolist()) <= chosen or len(set(graph.is_convex[own].tolist())) > 1:
        return False
    there = {edge for end in graph.ends[own].ravel().tolist() for edge in graph.edges_at(end)}
    bends = np.abs(180 - graph.angles[own])
    return len(there & chosen) == len(own) and bool((np.abs(bends - 90) < _SQUARE).all())


def face_blend_tool(
    graph: FaceGraph, face: int, sign: int, profile: FloatArray, pitch: int
) -> Solid:
    """Return the solid to remove below a face, or to add above it if the sign is -1.

    Parameters
    ----------
    graph : FaceGraph
    face, sign : int
    profile : (k, 2) float64
        The section of the blend from a wall to the face: distance from the wall, and height above
        the first point; both ascend from 0 to the blend's size.
    pitch : int
        The pitch of the solid's lattice.

    Raises
    ------
    InvalidParameterError
        If the blend would consume a part of the face, or no roof over the face can be computed.
    """
    frame = _frame(graph.normals[face] * sign)
    loops = [points @ frame.T for points in face_loops(graph, face)]
    level = float(np.concatenate(loops)[:, 2].mean())
    figure = Region([points[:: int(sign), :2] for points in loops], pitch=pitch)
    beyond, size = _EXTENSION_STEPS * 10.0**pitch, float(profile[-1, 1])
    roofs = []
    for part in figure.components:
        above = _roof_or_none(part)
        if above is None or above.vertices[:, 2].max() < (1 - _SAME) * profile[-1, 0]:
            place = np.append(part.to_polygons()[0][0], level) @ frame
            raise no_room(graph, place, [face])
        roofs.append(above)
    # Evaluate the union, so that it is transformed as one mesh. Extend it downwards, so that its
    # floor is not in the plane of the blocks' floors.
    whole = union([*roofs, figure.extrude(size).translate(0, 0, -size)]).normalized()
    grown = offset_region(figure, beyond, "miter")
    tools = []
    for (inner, low), (outer, high) in pairwise(profile.tolist()):
        # The profile bounds a convex set, the intersection of the half-planes below its chords.
        steep = (high - low) / (outer - inner)
        base = low - steep * inner
        block = grown.extrude(size + beyond - base)
        placed = [_placed(frame, level - size + base, slope) for slope in (1.0, steep)]
        tools.append(block.transform(placed[0]) - whole.transform(placed[1]))
    return union(tools)


def _placed(frame: FloatArray, height: float, steep: float) -> FloatArray:
    """Return the (4, 4) matrix that scales z by `steep` and maps z = 0 to a plane of the frame.

    The plane is perpendicular to the frame's third axis, at `height` along it.
    """
    matrix = np.eye(4)
    matrix[:3, :3] = frame.T * (1, 1, steep)
    matrix[:3, 3] = frame[2] * height
    return matrix


def _roof_or_none(figure: Region) -> Solid | None:
    """Return the roof over a figure, or None if its corners are too many or ambiguous."""
    try:
        return roof(figure)
    except LimitError:
        return None


def _frame(normal: FloatArray) -> FloatArray:
    """Return an orthonormal frame, (3, 3), with a normal as last row; exact for axis normals."""
    level = np.eye(3)[(int(np.abs(normal).argmax()) + 1) % 3]
    first = level - (level @ normal) * normal
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(normal, first), normal])
