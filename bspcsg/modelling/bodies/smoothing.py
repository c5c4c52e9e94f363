"""Smoothing of solids by curved faces through their corners."""

import numpy as np

from ..._types import FloatArray, Scalar
from ...attributes.attributes import NORMALS
from ...mesh.mesh import Mesh
from ...parameters import at_least
from ...solid.counting import counted
from ...solid.moving import AttributedMesh
from ...solid.solid import Solid, given_pitch, solid_with
from .refining import attributes_on, divided, refuse_many, small_triangles
from .shading import half_edges, next_side, normals, unit
from .warping import refuse_crossings

#: The sine of the angle from which on two normals name an edge between them.
_SHARP = 1e-6


@counted
def smooth(solid: Solid, n: int, sharp_angle: Scalar = 60.0) -> Solid:
    """Return the solid with curved faces, each in n² triangles (see `Solid.smooth`)."""
    parts = at_least(1, n, "n")
    at_corners = normals(solid, sharp_angle)
    mesh = solid.normalized().to_mesh()
    if len(mesh.faces) == 0:
        return solid
    refuse_many(len(mesh.faces) * parts**2)
    flat, faces, origins = divided(mesh.vertices, mesh.faces, parts)
    vertices = flat.copy()
    weights = _weights(parts)
    # Triangles compute shared corners identically, so no gaps arise.
    patches = _points(mesh, _handles(mesh, at_corners), weights)
    vertices[faces.reshape(len(mesh.faces), -1)] = patches
    refuse_crossings(vertices, faces, "Bent smoothly")
    said = None
    if mesh.carried is not None:
        said = attributes_on(mesh, flat, faces, origins).without(NORMALS)
    bent = AttributedMesh(vertices, faces, said)
    return solid_with(vertices, faces, said, pitch=bent.held_pitch(given_pitch(solid)))


def _handles(mesh: Mesh, at_corners: FloatArray) -> FloatArray:
    """Return the inner control points of the cubic curves over triangle sides, (m, 3, 2, 3).

    A curve starts in the plane perpendicular to the normal; at a sharp edge, in the planes
    perpendicular to both normals.
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
    """Return the components of vectors that are perpendicular to two normals each."""
    mean, edge = unit(one + other), np.cross(one, other)
    is_sharp = np.linalg.norm(edge, axis=1, keepdims=True) > _SHARP
    along = unit(edge)
    flat = ways - mean * np.einsum("ij,ij->i", ways, mean)[:, None]
    line = along * np.einsum("ij,ij->i", ways, along)[:, None]
    found: FloatArray = np.where(is_sharp, line, flat)
    return found


def _points(mesh: Mesh, handles: FloatArray, weights: FloatArray) -> FloatArray:
    """Return points of the cubic patches over triangles, (m, k, 3), at (k, 3) weights."""
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
    """Return barycentric weights of the corners of a triangle's parts, as in `divided`."""
    places = np.array(small_triangles(parts), dtype=np.float64).reshape(-1, 2) / parts
    return np.column_stack([1 - places.sum(axis=1), places])
