"""The connected pieces of a mesh, how thick each is, and points inside them."""

from dataclasses import dataclass
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from .._types import FloatArray, IndexArray
from .boxes import boxes_around, boxes_of
from .mesh import Mesh, surfaces_of

Point: TypeAlias = tuple[float, float, float]

#: Relative rounding error of a tetrahedron's volume, by the lengths of three edges.
_NOISE = 1e-15

#: The largest number of faces of a piece below which a point is looked for, and of points that are
#: kept.
_MAX_FACES_TRIED, _MAX_POINTS_KEPT = 60, 6


@dataclass(frozen=True, eq=False)
class MeshPieces:
    """The pieces of a closed mesh, each with the walls of its cavities.

    Parameters
    ----------
    mesh : Mesh
    owner : (m,) int64
        For each face the number of its piece; some numbers are not used.
    thickness : (p,) float64
        The thickness of each piece, in model units: twice the volume divided by the area. It is the
        thickness of a film, and a third of the side of a cube.
    """

    mesh: Mesh
    owner: IndexArray
    thickness: FloatArray

    @classmethod
    def of(cls, mesh: Mesh, film: float = 0.0) -> "MeshPieces":
        """Return the pieces of a mesh with faces; a thickness below `film` may be an estimate."""
        surfaces = surfaces_of(mesh.faces, len(mesh.vertices))
        volumes, areas = _measures(mesh, surfaces, film)
        outer = _outer_surfaces(mesh, surfaces, volumes)
        volumes, areas = _summed(outer, volumes), _summed(outer, areas)
        thickness = np.divide(2 * np.abs(volumes), areas, np.zeros_like(areas), where=areas > 0)
        return cls(mesh, outer[surfaces], thickness)

    @property
    def thickest(self) -> int:
        """The number of the thickest piece."""
        return int(self.thickness.argmax())

    def thicker_than(self, bound: float) -> list[int]:
        """Return the numbers of the pieces thicker than a bound, the thickest first."""
        order = np.argsort(-self.thickness, kind="stable")
        return [int(piece) for piece in order if self.thickness[piece] > bound]

    def corner_of(self, piece: int) -> Point:
        """Return a vertex of a piece."""
        face = self.mesh.faces[int((self.owner == piece).argmax())]
        return _as_point(self.mesh.vertices[face[0]])

    def points_in(self, piece: int) -> list[Point]:
        """Return points that should be inside a piece, the deepest first.

        They lie half-way between a large face and what is below it, computed in doubles: test them
        if you need certainty.
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
    """Return the point half-way from the middle of a face to the face behind it, and its depth."""
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
    """Return volume and area of each surface, with a point of the surface as origin.

    The volume of a needle is lost in rounding errors due to its length. If these could make it look
    thicker than a film, the sum is computed exactly.
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
    """Return the signed volume of a closed surface of (m, 3, 3) corners, rounded once."""
    six = Fraction(0)
    for a, b, c in triangles.tolist():
        (u, v, w), (x, y, z), (p, q, r) = (map(Fraction, corner) for corner in (a, b, c))
        six += u * (y * r - z * q) - v * (x * r - z * p) + w * (x * q - y * p)
    return float(six / 6)


def _summed(groups: IndexArray, values: FloatArray) -> FloatArray:
    return np.bincount(groups, values).astype(np.float64)


def _outer_surfaces(mesh: Mesh, surfaces: IndexArray, volumes: FloatArray) -> IndexArray:
    """Return for each wall of a cavity the surface around it, for other surfaces themselves.

    A closed film is a large surface around a cavity nearly as large; its thickness follows only
    from both. The surface with the smallest enclosing box is the one around a cavity.
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
