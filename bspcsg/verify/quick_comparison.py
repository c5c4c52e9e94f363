"""Test whether two meshes agree in everything that is cheap to measure.

These are volume, area, bounds, parts and Euler number, and whether points near the seam, where
faces from several operands meet, are inside. The test finds missing, surplus or moved parts, but
not two errors that cancel in all measures and are far from the points; only the symmetric
difference finds these.
"""

import numpy as np
import numpy.typing as npt

from ..mesh.mesh import Mesh
from ..mesh.pieces import Point
from .referee import RayClassifier
from .verdict import Facts

#: The relative error of volumes and areas that are summed in doubles.
SUM_ERROR = 1e-11

#: The largest number of faces at the seam with sample points, one on each side.
_MAX_FACES_PROBED = 16

#: The distance of a sample point from its face, in multiples of the film between both surfaces.
_CLEAR = 64.0

#: The least distance of a sample point from its face, in multiples of the square root of twice the
#: face's area.
_NEAR = 0.01


def measures_differ(mesh: Mesh, other: Mesh, film: float) -> bool:
    """Return true if a measure of two meshes differs by more than a film between them explains.

    Parameters
    ----------
    mesh, other : Mesh
    film : float
        The largest distance between the surfaces, in model units.
    """
    ours, theirs = Facts.of(mesh), Facts.of(other)
    return (
        ours.euler_number != theirs.euler_number
        or ours.components != theirs.components
        or abs(ours.volume - theirs.volume) > volume_of_film(ours, theirs, film)
        or areas_differ(ours, theirs, mesh, film)
        or _bounds_differ(mesh, other, film)
    )


def _bounds_differ(mesh: Mesh, other: Mesh, film: float) -> bool:
    ours, theirs = mesh.bounds, other.bounds
    if ours is None or theirs is None:
        return ours is not theirs
    return bool((np.abs(ours - theirs) > film).any())


def volume_of_film(ours: Facts, theirs: Facts, film: float) -> float:
    """Return the largest difference of volumes if both surfaces are at most `film` apart."""
    return film * (ours.area + theirs.area) + SUM_ERROR * abs(ours.volume)


def areas_differ(ours: Facts, theirs: Facts, mesh: Mesh, film: float) -> bool:
    """Return true if the areas differ by more than `film` times the length of `mesh`'s edges."""
    gap = abs(ours.area - theirs.area) - SUM_ERROR * ours.area
    return gap > 0 and gap > film * _edge_length(mesh)


def _edge_length(mesh: Mesh) -> float:
    corners = mesh.vertices[mesh.faces]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).sum())


def sides_differ(ours: Mesh, theirs: Mesh, film: float) -> tuple[int, bool]:
    """Return the number of sample points near the seam, and whether a point is in one mesh only."""
    points = _points_at_seam(ours, film)
    first, second = RayClassifier(ours), RayClassifier(theirs)
    sides = [(first.is_inside(point), second.is_inside(point)) for point in points]
    known = [(one, other) for one, other in sides if one is not None and other is not None]
    return len(known), any(one != other for one, other in known)


def _points_at_seam(mesh: Mesh, film: float) -> list[Point]:
    """Return points on both sides of faces at the seam, or of other faces if there is no seam."""
    faces = np.flatnonzero(_is_at_seam(mesh))
    if len(faces) == 0:
        faces = np.arange(len(mesh.faces))
    chosen = faces[
        np.linspace(0, len(faces) - 1, min(_MAX_FACES_PROBED, len(faces))).astype(np.int64)
    ]
    corners = mesh.vertices[mesh.faces[chosen]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(normals, axis=1, keepdims=True)
    units = np.divide(normals, doubled, np.zeros_like(normals), where=doubled > 0)
    steps = units * np.maximum(_CLEAR * film, _NEAR * np.sqrt(doubled))
    middles = corners.mean(axis=1)
    return [(x, y, z) for x, y, z in np.concatenate([middles - steps, middles + steps]).tolist()]


def _is_at_seam(mesh: Mesh) -> npt.NDArray[np.bool_]:
    operand = mesh.source[:, 0]
    last = np.zeros(len(mesh.vertices), dtype=operand.dtype)
    last[mesh.faces.ravel()] = np.repeat(operand, 3)
    at_seam: npt.NDArray[np.bool_] = (last[mesh.faces] != operand[:, None]).any(axis=1)
    return at_seam
