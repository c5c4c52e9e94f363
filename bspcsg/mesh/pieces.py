"""The connected pieces of a mesh, the thickness of each, and points inside them."""

from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from .._types import FloatArray, IndexArray
from .boxes import boxes_around, boxes_of
from .mesh import Mesh, surfaces_of

Point: TypeAlias = tuple[float, float, float]

#: The rounding error of a tetrahedron's volume, relative to the product of three edge lengths.
_NOISE = 1e-15

#: The largest number of faces of a piece from which a point inside is sought, and of points that
#: are returned.
_MAX_FACES_TRIED, _MAX_POINTS_KEPT = 60, 6


@dataclass(frozen=True, eq=False)
class MeshPieces:
    """The connected pieces of a closed mesh; the walls of a cavity belong to the piece around it.

    Parameters
    ----------
    mesh : Mesh
    owner : (m,) int64
        For each face the number of its piece; not every number from 0 to p - 1 occurs.
    thickness : (p,) float64
        The thickness of each piece, in model units: twice the volume divided by the area. For a
        film this is the distance between its sides; for a cube it is a third of the edge.
    """

    mesh: Mesh
    owner: IndexArray
    thickness: FloatArray

    @classmethod
    def of(cls, mesh: Mesh, film: float = 0.0) -> "MeshPieces":
        """Return the pieces of a non-empty mesh; a thickness below `film` may be inexact."""
        surfaces = surfaces_of(mesh.faces, len(mesh.vertices))
        volumes, areas = _measures(mesh, surfaces, film)
        outer = _outer_surfaces(mesh, surfaces, volumes)
        volumes, areas = _summed(outer, volumes), _summed(outer, areas)
        thickness = np.divide(2 * np.abs(volumes), areas, np.zeros_like(areas), where=areas > 0)
        return cls(mesh, outer[surfaces], thickness)

    @property
    def thickest(self) -> int:
        """The number of the piece with the largest thickness."""
        return int(self.thickness.argmax())

    def thicker_than(self, bound: float) -> list[int]:
        """Return the numbers of the pieces whose thickness exceeds `bound`, the thickest first."""
        order = np.argsort(-self.thickness, kind="stable")
        return [int(piece) for piece in order if self.thickness[piece] > bound]

    def corner_of(self, piece: int) -> Point:
        """Return the coordinates of one vertex of a piece."""
        face = self.mesh.faces[int((self.owner == piece).argmax())]
        return _as_point(self.mesh.vertices[face[0]])

    def points_in(self, piece: int) -> list[Point]:
        """Return up to six points that should be inside a piece, the deepest first.

        Each is half-way between a large face and the next face below it. They are computed in
        doubles, so test them if you need certainty.
        """
        triangles = self.mesh.vertices[self.mesh.faces[self.owner == piece]]
        origin = triangles[0, 0]
        local = triangles - origin
        normals = np.cross(local[:, 1] - local[:, 0], local[:, 2] - local[:, 0])
        largest = np.argsort(-np.linalg.norm(normals, axis=1), kind="stable")[:_MAX_FACES_TRIED]
        below = [_below(local, normals, face) for face in largest.tolist()]
        found = sorted((pair for pair in below if pair is not None), key=lambda pair: -pair[0])
        return [_as_point(point + origin) for _, point in found[:_MAX_POINTS_KEPT]]


def _as_point(point: FloatArray) -> Point:
    x, y, z = point.tolist()
    return x, y, z


def _below(
    triangles: FloatArray, normals: FloatArray, face: int
) -> tuple[float, FloatArray] | None:
    """Return the depth and the point half-way from a face's centroid to the next face below it.

    Return None if no face is below, or the face has no area.
    """
    start = triangles[face].mean(axis=0)
    length = np.linalg.norm(normals[face])
    if length == 0:
        return None
    down = -normals[face] / length
    edge = triangles[:, 1:] - triangles[:, :1]
    across = np.cross(down, edge[:, 1])
    scale = np.einsum("ij,ij->i", edge[:, 0], across)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        offset = start - triangles[:, 0]
        u = np.einsum("ij,ij->i", offset, across) / scale
        turned = np.cross(offset, edge[:, 0])
        v = turned @ down / scale
        depth = np.einsum("ij,ij->i", edge[:, 1], turned) / scale
        hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (depth > 0)
    hit[face] = False
    if not hit.any():
        return None
    half = float(depth[hit].min()) / 2
    return half, start + down * half


def _measures(mesh: Mesh, surfaces: IndexArray, film: float) -> tuple[FloatArray, FloatArray]:
    """Return volume and area of each surface, computed relative to a point of the surface.

    For a long thin piece, the rounding errors of the volume may exceed it. If they could make the
    piece appear thicker than `film`, the volume is computed exactly.
    """
    _, first = np.unique(surfaces, return_index=True)
    origin = mesh.vertices[mesh.faces[first, 0]][surfaces]
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] - origin for corner in range(3))
    volumes = np.einsum("ij,ij->i", np.cross(a, b), c) / 6
    noise = np.prod([np.linalg.norm(corner, axis=1) for corner in (a, b, c)], axis=0) * _NOISE
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    total, doubt, area = (_summed(surfaces, values) for values in (volumes, noise, areas))
    unclear = (np.abs(total) < 100 * doubt) & (2 * (np.abs(total) + doubt) > film * area)
    for surface in np.flatnonzero(unclear).tolist():
        total[surface] = _exact_volume(mesh.vertices[mesh.faces[surfaces == surface]])
    return total, area


def _exact_volume(triangles: FloatArray) -> float:
    """Return the signed volume of a closed surface, given by corners (m, 3, 3), rounded once."""
    six = Fraction(0)
    for a, b, c in triangles.tolist():
        (u, v, w), (x, y, z), (p, q, r) = (map(Fraction, corner) for corner in (a, b, c))
        six += u * (y * r - z * q) - v * (x * r - z * p) + w * (x * q - y * p)
    return float(six / 6)


def _summed(groups: IndexArray, values: FloatArray) -> FloatArray:
    return np.bincount(groups, values).astype(np.float64)


def _outer_surfaces(mesh: Mesh, surfaces: IndexArray, volumes: FloatArray) -> IndexArray:
    """Return for the wall of each cavity the surface around it, for all other surfaces themselves.

    A cavity's wall has negative volume. The surface around it is the one of smallest volume whose
    box contains the wall's box and whose volume is at least as large. A closed film, for example,
    is a surface around a cavity nearly as large, and its thickness follows only from both.
    """
    count = len(volumes)
    outer = np.arange(count)
    cavities = np.flatnonzero(volumes < 0)
    if len(cavities) == 0:
        return outer
    boxes = boxes_of(mesh.vertices[mesh.faces], surfaces)
    solid = np.flatnonzero(volumes > 0)
    for cavity, near in zip(cavities, boxes_around(boxes[cavities], boxes[solid]), strict=True):
        around = solid[near]
        around = around[volumes[around] >= -volumes[cavity]]
        if len(around):
            outer[cavity] = around[volumes[around].argmin()]
    return outer
