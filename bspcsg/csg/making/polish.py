"""Undoes rounding to six digits: makes rotations exact, and lets faces meet again."""

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

#: Entries of a matrix may be this far from a rotation's to be taken for one.
NEARLY = 1e-5

#: The number of digits that OpenSCAD writes.
DIGITS = 6


def polished_matrix(matrix: FloatArray) -> FloatArray:
    """Return the matrix with its linear part replaced by the nearest rotation, if it is near.

    Parameters
    ----------
    matrix : (4, 4) float64

    Notes
    -----
    The nearest orthogonal matrix is U V' of the singular value decomposition U S V' (Schönemann
    1966). Mirror images stay mirror images. Entries that are 0 or ±1 up to rounding become exact.
    """
    u, _, v = np.linalg.svd(matrix[:3, :3])
    rotation = u @ v
    if np.abs(rotation - matrix[:3, :3]).max() > NEARLY:
        return matrix
    whole = np.round(rotation)
    rotation = np.where(np.abs(rotation - whole) < 1e-12, whole, rotation)
    result = matrix.copy()
    result[:3, :3] = rotation
    return result


class Polish(NamedTuple):
    """The changes of polishing, besides matrices that became rotations.

    Parameters
    ----------
    pitch : int or None
        Exponent of the step of the lattice that corners were moved to; None if none had to move.
    moved : float
        The largest distance that a corner moved, in model units: each moves once, by half a step
        along each axis at most, √3/2 · 10**pitch in all.
    """

    pitch: int | None = None
    moved: float = 0.0


def polished_pitch(kinds: Sequence[Sequence[FloatArray]], finest: int) -> int | None:
    """Return the finest lattice on which most of different parts coincides; None if none helps.

    Things that would coincide within one part are distinct on purpose, and count against a lattice.
    The coarsest lattice has a step of one unit of the sixth digit of the largest coordinate: things
    that differ only by rounding differ by less.

    Parameters
    ----------
    kinds : sequence of sequence of (n, d) float64
        For each kind of thing that may coincide, such as corners, the things of each part.
    finest : int
        Exponent of the step of the lattice that they lie on.
    """
    parts = [rows for kind in kinds for rows in kind]
    largest = max((float(np.abs(rows).max(initial=0)) for rows in parts), default=0.0)
    if largest == 0:
        return None
    coarsest = math.floor(math.log10(largest)) + 1 - DIGITS
    gains = [sum(_gain(kind, pitch) for kind in kinds) for pitch in range(finest, coarsest + 1)]
    if not gains or max(gains) == gains[0]:
        return None
    return finest + gains.index(max(gains))


def _gain(parts: Sequence[FloatArray], pitch: int) -> int:
    """Return how much parts share on a lattice, less how much each loses, up to a constant."""
    rounded = [np.unique(np.round(rows, -pitch), axis=0) for rows in parts]
    # Counted twice: once for what parts share, and once for what they do not lose.
    return 2 * sum(map(len, rounded)) - len(np.unique(np.concatenate(rounded), axis=0))


def corners_and_levels(bodies: Sequence[Solid | Region]) -> list[list[FloatArray]]:
    """Return what may coincide: corners, and the coordinates of faces perpendicular to an axis."""
    meshes = [body.to_mesh() for body in bodies if isinstance(body, Solid)]
    figures = [body.to_polygons() for body in bodies if isinstance(body, Region)]
    corners = [mesh.vertices for mesh in meshes]
    levels = [[_levels(mesh, axis) for mesh in meshes] for axis in range(3)]
    outlines = [np.concatenate(loops) for loops in figures]
    return [kind for kind in (corners, *levels, outlines) if kind]


def _levels(mesh: Mesh, axis: int) -> FloatArray:
    """Return the (n, 1) coordinates along an axis of the faces perpendicular to it."""
    along = mesh.vertices[mesh.faces][:, :, axis]
    levels: FloatArray = along[np.ptp(along, axis=1) == 0][:, :1]
    return levels


def pitch_of(body: Solid | Region) -> int:
    """Return the exponent of the step of a body's lattice."""
    return body.pitch if isinstance(body, Region) else body.tree.pitch


def snapped(body: Solid | Region, pitch: int) -> tuple[Solid | Region, float]:
    """Return a body with its corners on a lattice, and the largest distance that one moved.

    A body stays as it is if a piece or a hole of it would lose more than half its size.
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
    """Say whether all signed sizes keep at least half of their value."""
    whole = np.asarray(before)
    return bool((np.asarray(after) * np.sign(whole) >= np.abs(whole) / 2).all())


def _volumes(triangles: FloatArray, surfaces: IndexArray) -> FloatArray:
    """Return the signed volume within each surface, from its first corner for few digits' sake."""
    names, first, owner = np.unique(surfaces, return_index=True, return_inverse=True)
    a, b, c = np.moveaxis(triangles - triangles[first, :1][owner], 1, 0)
    volumes = np.zeros(len(names))
    np.add.at(volumes, owner, (np.cross(a, b) * c).sum(axis=1) / 6)
    return volumes


def _farthest(before: FloatArray, after: FloatArray) -> float:
    return float(np.linalg.norm(after - before, axis=1).max(initial=0))
