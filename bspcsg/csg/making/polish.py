"""Correction of rounding to six digits: rotations become exact, and faces coincide again."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..._types import FloatArray, IndexArray
from ...bsp import Region
from ...geometry.polygon import signed_area
from ...mesh.mesh import Mesh, surfaces_of
from ...solid.solid import Solid

#: A matrix becomes a rotation if each of its entries differs by at most this.
ROTATION_TOLERANCE = 1e-5

#: The number of significant digits that OpenSCAD writes.
DIGITS = 6


def polished_matrix(matrix: FloatArray) -> FloatArray:
    """Return a matrix with its linear part replaced by the nearest rotation, if within 1e-5.

    Parameters
    ----------
    matrix : (4, 4) float64

    Notes
    -----
    The nearest orthogonal matrix is U V' of the singular value decomposition U S V' (Schönemann
    1966); it may be a reflection. Entries that are 0 or ±1 up to rounding become exact.
    """
    u, _, v = np.linalg.svd(matrix[:3, :3])
    rotation = u @ v
    if np.abs(rotation - matrix[:3, :3]).max() > ROTATION_TOLERANCE:
        return matrix
    whole = np.round(rotation)
    rotation = np.where(np.abs(rotation - whole) < 1e-12, whole, rotation)
    result = matrix.copy()
    result[:3, :3] = rotation
    return result


class Polish(NamedTuple):
    """The changes that polishing made to the corners of a model.

    Parameters
    ----------
    pitch : int or None
        The pitch of the lattice to which corners were snapped; None if no corner was.
    moved : float
        The largest distance that a corner moved, in model units: each corner moves once, by at most
        half a step along each axis, so by at most √3/2 · 10**pitch.
    """

    pitch: int | None = None
    moved: float = 0.0


def polished_pitch(kinds: Sequence[Sequence[FloatArray]], finest: int) -> int | None:
    """Return the pitch of the finest lattice on which most features of different parts coincide.

    None means that no lattice increases their number. Features are corners or coordinates of faces.
    Features of one part that would coincide are distinct on purpose, and count against a lattice.
    The coarsest lattice step is one unit of the sixth digit of the largest coordinate: features
    that differ only by rounding differ by less.

    Parameters
    ----------
    kinds : sequence of sequence of (n, d) float64
        For each kind of feature, such as corners, the features of each part.
    finest : int
        The pitch of the parts' present lattice.
    """
    parts = [rows for kind in kinds for rows in kind]
    largest = max((float(np.abs(rows).max(initial=0)) for rows in parts), default=0.0)
    if largest == 0:
        return None
    coarsest = math.floor(math.log10(largest)) + 1 - DIGITS
    gains = [
        sum(_lattice_score(kind, pitch) for kind in kinds) for pitch in range(finest, coarsest + 1)
    ]
    if not gains or max(gains) == gains[0]:
        return None
    return finest + gains.index(max(gains))


def _lattice_score(parts: Sequence[FloatArray], pitch: int) -> int:
    """Return a score of a lattice: features common to parts, minus features lost within parts.

    Features are the rows of the arrays; only differences of scores are meaningful.
    """
    rounded = [np.unique(np.round(rows, -pitch), axis=0) for rows in parts]
    # The sum counts twice: once for features that parts share, once for features not lost.
    return 2 * sum(map(len, rounded)) - len(np.unique(np.concatenate(rounded), axis=0))


def corners_and_levels(bodies: Sequence[Solid | Region]) -> list[list[FloatArray]]:
    """Return the features of parts that may coincide, as a list of arrays for each kind.

    The kinds are corners, the coordinates of faces perpendicular to x, y and z, and corners of
    regions.
    """
    meshes = [body.to_mesh() for body in bodies if isinstance(body, Solid)]
    figures = [body.to_polygons() for body in bodies if isinstance(body, Region)]
    corners = [mesh.vertices for mesh in meshes]
    levels = [[_levels(mesh, axis) for mesh in meshes] for axis in range(3)]
    outlines = [np.concatenate(loops) for loops in figures]
    return [kind for kind in (corners, *levels, outlines) if kind]


def _levels(mesh: Mesh, axis: int) -> FloatArray:
    """Return the coordinates of the faces perpendicular to an axis, (n, 1)."""
    along = mesh.vertices[mesh.faces][:, :, axis]
    levels: FloatArray = along[np.ptp(along, axis=1) == 0][:, :1]
    return levels


def pitch_of(body: Solid | Region) -> int:
    """Return the pitch of the lattice of a solid or region."""
    return body.pitch if isinstance(body, Region) else body.tree.pitch


def snapped(body: Solid | Region, pitch: int) -> tuple[Solid | Region, float]:
    """Return a solid or region with its corners snapped to a lattice, and their largest motion.

    It is unchanged if one of its pieces or holes would lose more than half its volume or area.
    """
    if isinstance(body, Region):
        loops = body.to_polygons()
        on_lattice = [np.round(loop, -pitch) for loop in loops]
        if not _survive(*([signed_area(loop) for loop in some] for some in (loops, on_lattice))):
            return body, 0.0
        moved = max(_farthest(*pair) for pair in zip(loops, on_lattice, strict=True))
        return Region(on_lattice, pitch=pitch), moved
    mesh = body.normalized().to_mesh()
    corners = np.round(mesh.vertices, -pitch)
    surfaces = surfaces_of(mesh.faces, len(corners))
    if not _survive(*(_volumes(c[mesh.faces], surfaces) for c in (mesh.vertices, corners))):
        return body, 0.0
    return Solid(corners, mesh.faces, pitch=pitch), _farthest(mesh.vertices, corners)


def _survive(before: ArrayLike, after: ArrayLike) -> bool:
    """Return True if each signed area or volume has at least half of its previous value."""
    whole = np.asarray(before)
    return bool((np.asarray(after) * np.sign(whole) >= np.abs(whole) / 2).all())


def _volumes(triangles: FloatArray, surfaces: IndexArray) -> FloatArray:
    """Return the signed volume inside each connected surface, (n,).

    Coordinates are taken relative to the surface's first corner, against cancellation.
    """
    names, first, owner = np.unique(surfaces, return_index=True, return_inverse=True)
    a, b, c = np.moveaxis(triangles - triangles[first, :1][owner], 1, 0)
    volumes = np.zeros(len(names))
    np.add.at(volumes, owner, (np.cross(a, b) * c).sum(axis=1) / 6)
    return volumes


def _farthest(before: FloatArray, after: FloatArray) -> float:
    return float(np.linalg.norm(after - before, axis=1).max(initial=0))
