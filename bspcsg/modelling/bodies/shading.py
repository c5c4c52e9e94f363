"""Normals and curvatures of solids' surfaces."""

import math

import numpy as np

from ..._types import FloatArray, IndexArray, Scalar
from ...errors import invalid_parameter
from ...mesh.mesh import Mesh, surfaces_of
from ...parameters import not_negative
from ...solid.ledger import uncounted
from ...solid.solid import Solid

#: A bound of the rounding error of the cosine of an angle between faces.
_ROUNDING = 1e-12


@uncounted
def normals(solid: Solid, sharp_angle: Scalar = 30.0) -> FloatArray:
    """Return a unit normal for each corner of each triangle, (m, 3, 3) (see `Solid.normals`)."""
    limit = not_negative(sharp_angle, "sharp_angle")
    if limit > 180:
        raise invalid_parameter(f"sharp_angle must be at most 180 degrees, not {limit:g}.")
    mesh = solid.normalized().to_mesh()
    if len(mesh.faces) == 0:
        return np.zeros((0, 3, 3))
    own = unit_vectors(_areas(mesh))
    fans = _fans(mesh, own, limit)
    weighted = (own[:, None] * _angles(mesh)[..., None]).reshape(-1, 3)
    sums = np.zeros((int(fans.max()) + 1, 3))
    np.add.at(sums, fans, weighted)
    found: FloatArray = unit_vectors(sums)[fans].reshape(-1, 3, 3)
    return found


@uncounted
def curvature(solid: Solid) -> tuple[FloatArray, FloatArray]:
    """Return the Gaussian and the mean curvature at each vertex, two (n,) arrays."""
    mesh = solid.normalized().to_mesh()
    count = len(mesh.vertices)
    sizes = np.linalg.norm(_areas(mesh), axis=1) / 2
    shares = np.bincount(mesh.faces.ravel(), np.repeat(sizes / 3, 3), count)
    angles = np.bincount(mesh.faces.ravel(), _angles(mesh).ravel(), count)
    forth, back = half_edges(mesh.faces)
    start, end = mesh.faces.ravel()[forth], mesh.faces.ravel()[back]
    own, along = unit_vectors(_areas(mesh)), mesh.vertices[end] - mesh.vertices[start]
    bends = _signed_bends(own[forth // 3], own[back // 3], along)
    quarters = np.linalg.norm(along, axis=1) * bends / 4
    bent = np.bincount(start, quarters, count) + np.bincount(end, quarters, count)
    with np.errstate(divide="ignore", invalid="ignore"):
        return (2 * math.pi - angles) / shares, bent / shares


def _areas(mesh: Mesh) -> FloatArray:
    """Return the normal of each triangle, (m, 3), whose length is twice the triangle's area."""
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def unit_vectors(vectors: FloatArray) -> FloatArray:
    """Return vectors divided by their lengths; a zero vector stays zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    units: FloatArray = np.divide(vectors, lengths, np.zeros_like(vectors), where=lengths > 0)
    return units


def _angles(mesh: Mesh) -> FloatArray:
    """Return the angles of each triangle at its corners, (m, 3), in radians."""
    corners = mesh.vertices[mesh.faces]
    found = np.empty(mesh.faces.shape)
    for k in range(3):
        u, v = corners[:, k - 2] - corners[:, k], corners[:, k - 1] - corners[:, k]
        across = np.linalg.norm(np.cross(u, v), axis=1)
        found[:, k] = np.arctan2(across, np.einsum("ij,ij->i", u, v))
    return found


def half_edges(faces: IndexArray) -> tuple[IndexArray, IndexArray]:
    """Return the two opposite half-edges of each edge of a closed mesh, as two (e,) arrays.

    Half-edge 3 f + k runs from corner k of face f to its next corner. The first array has the
    half-edges that run from the smaller to the larger vertex number.
    """
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    count = faces.max(initial=0) + 1
    forth, back = np.argsort(start * count + end), np.argsort(end * count + start)
    once = start[forth] < end[forth]
    return forth[once], back[once]


def _signed_bends(one: FloatArray, other: FloatArray, along: FloatArray) -> FloatArray:
    """Return the angle between the normals of two faces at each edge, negative if concave.

    `one` is the normal of the face whose boundary runs in the direction `along`.
    """
    across = np.cross(one, other)
    bends = np.arctan2(np.linalg.norm(across, axis=1), np.einsum("ij,ij->i", one, other))
    signed: FloatArray = np.copysign(bends, np.einsum("ij,ij->i", across, along))
    return signed


def _fans(mesh: Mesh, own: FloatArray, limit: float) -> IndexArray:
    """Return a group number for each triangle corner, (3 m,).

    Corners at one vertex are in the same group unless sharp edges separate them. An edge is sharp
    if the normals `own` of its faces differ by more than `limit` degrees.
    """
    forth, back = half_edges(mesh.faces)
    cosines = np.einsum("ij,ij->i", own[forth // 3], own[back // 3])
    flat = cosines >= math.cos(math.radians(limit)) - _ROUNDING
    forth, back = forth[flat], back[flat]
    count = mesh.faces.size
    alone = np.arange(count)
    # A half-edge starts at the vertex where the opposite half-edge ends.
    pairs = [(alone, alone), (forth, next_side(back)), (next_side(forth), back)]
    linked = [np.stack([here, there, there], axis=1) for here, there in pairs]
    return surfaces_of(np.concatenate(linked), count)[:count]


def next_side(side: IndexArray) -> IndexArray:
    """Return, for each half-edge number, the next half-edge of the same triangle."""
    following: IndexArray = side - side % 3 + (side + 1) % 3
    return following
