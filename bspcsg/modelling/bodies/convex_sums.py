"""Minkowski sums of a solid and a convex tool that moves along its surface."""

import numpy as np

from ..._types import FloatArray, IndexArray
from ...solid.leaf import MeshLeaf
from ...solid.solid import Solid, from_leaf, keeping_pitch
from .hulls import hull_of, lattice_for
from .polyhedra import Polyhedron, in_steps, in_units, polyhedron_of
from .surface_sweep import swept_mesh


def swept(solid: Solid, tool: Solid, is_inside: bool = False) -> Solid:
    """Return the Minkowski sum of a bounded solid and a convex tool.

    If `is_inside`, return the solid eroded by the tool: the complement of the Minkowski sum of the
    solid's complement and the tool.

    Raises
    ------
    LimitError
        If the swept volume has too many faces.
    """
    pitch = _common_pitch(solid, tool)
    points, faces = _swept_mesh(solid, tool, pitch, is_inside)
    leaf = MeshLeaf(points, _turned(faces, is_inside), pitch=pitch)
    return keeping_pitch(from_leaf(leaf).normalized(), None)


def sum_of_convex(first: Solid, second: Solid) -> Solid:
    """Return the Minkowski sum of two convex solids; errors as for `swept`."""
    pitch = _common_pitch(first, second)
    return hull_of(_swept_mesh(first, second, pitch, False)[0], pitch)


def _swept_mesh(
    solid: Solid, tool: Solid, pitch: int, is_inside: bool
) -> tuple[FloatArray, IndexArray]:
    body, hull = _polyhedron(solid, pitch, is_inside), _polyhedron(tool, pitch, False)
    origin = _point_within(hull)
    moved = Polyhedron(hull.points - origin, hull.faces, hull.normals)
    points, faces = swept_mesh(body, moved)
    return in_units(points + origin, pitch), faces


def _common_pitch(solid: Solid, tool: Solid) -> int:
    """Return the smaller pitch of two solids; a larger one if its lattice cannot hold their sum."""
    boxes = [_box(one) for one in (solid, tool)]
    return lattice_for(np.concatenate([*boxes, boxes[0] + boxes[1]]), min(solid.pitch, tool.pitch))


def _box(solid: Solid) -> FloatArray:
    vertices = solid.normalized().to_mesh().vertices
    return np.stack([vertices.min(axis=0), vertices.max(axis=0)])


def _polyhedron(solid: Solid, pitch: int, is_turned: bool) -> Polyhedron:
    mesh = solid.normalized().to_mesh()
    points = np.rint(in_steps(mesh.vertices, pitch)).astype(np.int64)
    return polyhedron_of(points, _turned(mesh.faces, is_turned))


def _turned(faces: IndexArray, is_turned: bool) -> IndexArray:
    return np.ascontiguousarray(faces[:, ::-1] if is_turned else faces)


def _point_within(tool: Polyhedron) -> IndexArray:
    """Return the mean corner of a convex tool, rounded to a lattice point; else a corner.

    A corner is returned if the rounded point is not in the tool. The point becomes the tool's
    origin: in the middle it is about equally far from all faces, so swept pieces overlap least.
    """
    middle: IndexArray = np.rint(tool.points.mean(axis=0)).astype(np.int64)
    if tool.holds(middle):
        return middle
    corner: IndexArray = tool.points[0]
    return corner
