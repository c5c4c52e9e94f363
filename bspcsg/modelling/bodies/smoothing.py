"""Smoothing of solids by curved faces through their corners."""

import numpy as np

from ..._types import FloatArray, Scalar
from ...attributes.attributes import NORMALS
from ...mesh.mesh import Mesh
from ...parameters import at_least
from ...solid.ledger import counted
from ...solid.mesh_transform import AttributedMesh
from ...solid.solid import Solid, given_pitch, solid_with
from .refining import attributes_on, refuse_many_triangles, small_triangles, with_triangles_divided
from .shading import half_edges, next_side, normals, unit_vectors
from .warping import refuse_crossings

#: The sine of the least angle between two normals at which the edge between them counts as sharp.
_SHARP = 1e-6


@counted
def smooth(solid: Solid, n: int, sharp_angle: Scalar = 60.0) -> Solid:
    """Return the solid with each face curved and divided into n² triangles (see `Solid.smooth`)."""
    parts = at_least(1, n, "n")
    at_corners = normals(solid, sharp_angle)
    mesh = solid.normalized().to_mesh()
    if len(mesh.faces) == 0:
        return solid
    refuse_many_triangles(len(mesh.faces) * parts**2)
    flat, faces, origins = with_triangles_divided(mesh.vertices, mesh.faces, parts)
    vertices = flat.copy()
    weights = _weights(parts)
    # Neighbouring triangles compute shared points identically, so no gaps arise.
    patches = _points(mesh, _handles(mesh, at_corners), weights)
    vertices[faces.reshape(len(mesh.faces), -1)] = patches
    refuse_crossings(vertices, faces, "Bent smoothly")
    attributes = None
    if mesh.carried is not None:
        attributes = attributes_on(mesh, flat, faces, origins).without(NORMALS)
    bent = AttributedMesh(vertices, faces, attributes)
    return solid_with(vertices, faces, attributes, pitch=bent.pitch_in_range(given_pitch(solid)))


def _handles(mesh: Mesh, at_corners: FloatArray) -> FloatArray:
    """Return the inner control points of the cubic curves over triangle sides, (m, 3, 2, 3).

    At each end a curve is perpendicular to the normal there; along a sharp edge, to the normals of
    both faces.
    """
    forth, back = half_edges(mesh.faces)
    start, end = mesh.faces.ravel()[forth], mesh.faces.ravel()[back]
    p, q, own = mesh.vertices[start], mesh.vertices[end], at_corners.reshape(-1, 3)
    near = p + _along(q - p, own[forth], own[next_side(back)]) / 3
    far = q + _along(p - q, own[next_side(forth)], own[back]) / 3
    found = np.empty((mesh.faces.size, 2, 3))
    found[forth] = np.stack([near, far], axis=1)
    found[back] = np.stack([far, near], axis=1)
    return found.reshape(-1, 3, 2, 3)


def _along(ways: FloatArray, one: FloatArray, other: FloatArray) -> FloatArray:
    """Project vectors to be perpendicular to the normals one[k] and other[k].

    If the normals are nearly equal, the vectors become perpendicular to the mean normal only.
    """
    mean, edge = unit_vectors(one + other), np.cross(one, other)
    is_sharp = np.linalg.norm(edge, axis=1, keepdims=True) > _SHARP
    along = unit_vectors(edge)
    flat = ways - mean * np.einsum("ij,ij->i", ways, mean)[:, None]
    line = along * np.einsum("ij,ij->i", ways, along)[:, None]
    found: FloatArray = np.where(is_sharp, line, flat)
    return found


def _points(mesh: Mesh, handles: FloatArray, weights: FloatArray) -> FloatArray:
    """Return k points of the cubic Bézier patch over each triangle, (m, k, 3).

    The (m, 3, 2, 3) `handles` are the inner control points of the sides, the (k, 3) `weights` the
    barycentric coordinates of the points.
    """
    corners = mesh.vertices[mesh.faces]
    middle = handles.mean(axis=(1, 2))
    middle = middle + (middle - corners.mean(axis=1)) / 2
    points: FloatArray = 6 * weights.prod(axis=1)[:, None] * middle[:, None]
    for k in range(3):
        here, there = weights[:, k, None], weights[:, (k + 1) % 3, None]
        points += here**3 * corners[:, None, k]
        points += 3 * here**2 * there * handles[:, None, k, 0]
        points += 3 * here * there**2 * handles[:, None, k, 1]
    return points


def _weights(parts: int) -> FloatArray:
    """Return the barycentric coordinates, (3 parts², 3), of corners of a triangle's equal parts.

    The corners are in the order of `small_triangles`.
    """
    places = np.array(small_triangles(parts), dtype=np.float64).reshape(-1, 2) / parts
    return np.column_stack([1 - places.sum(axis=1), places])
