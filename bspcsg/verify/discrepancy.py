"""The symmetric difference of two meshes as sets, and its thickness.

A volume alone does not distinguish rounding from error: a film of one lattice step over a large
body has more volume than a small missing part. So the symmetric difference is built exactly,
divided into connected pieces, and judged by the thickest piece.
"""

from dataclasses import dataclass

import numpy as np

from .._types import IndexArray
from ..errors import InvalidMeshError, LimitError
from ..mesh.mesh import Mesh
from ..mesh.pieces import MeshPieces
from ..mesh.weld import welded
from ..solid.solid import Solid


@dataclass(frozen=True)
class SetDifference:
    """The volume, area and thickness of the symmetric difference of two sets.

    Parameters
    ----------
    volume : float
        The volume of the difference on the lattice, rounded once; zero only if the sets are equal.
    area : float
    thickness : float
        The thickness of the thickest connected piece, in model units: twice its volume divided by
        its area, which for a film is its thickness and for a cube a third of its side.
    place : tuple of float or None
        A point of the thickest piece.
    """

    volume: float
    area: float = 0.0
    thickness: float = 0.0
    place: tuple[float, float, float] | None = None


def difference_of(
    a: Mesh, b: Mesh, pitch: int, film: float = 0.0
) -> tuple[SetDifference, MeshPieces | None]:
    """Return the symmetric difference of the sets that two closed meshes bound.

    Parameters
    ----------
    a, b : Mesh
    pitch : int
        The pitch of the lattice to which both meshes are snapped.
    film : float
        The thickness in model units below which differences need not be exact.

    Returns
    -------
    SetDifference
    Pieces or None
        The connected pieces of the difference; None if it is empty.

    Raises
    ------
    InvalidMeshError
        If a mesh is not closed.
    """
    difference = _where_windings_differ(a, b, pitch)
    if difference.is_empty:
        return SetDifference(0.0), None
    return measured_difference(difference.volume, difference.normalized().to_mesh(), film)


def measured_difference(
    volume: float, mesh: Mesh, film: float = 0.0
) -> tuple[SetDifference, MeshPieces | None]:
    """Return the `SetDifference` of a volume with this boundary mesh, and the pieces or None."""
    if len(mesh.faces) == 0 or mesh.area == 0:
        return SetDifference(volume), None
    pieces = MeshPieces.of(mesh, film)
    worst = pieces.thickest
    # The exact volume includes parts that have no volume after rounding to doubles.
    thickness = max(float(pieces.thickness[worst]), 2 * volume / mesh.area)
    return SetDifference(volume, mesh.area, thickness, pieces.corner_of(worst)), pieces


def _where_windings_differ(a: Mesh, b: Mesh, pitch: int) -> Solid:
    """Return the set of points at which the winding numbers of the two meshes differ.

    The winding number of both meshes together, the second inside out, is the difference; faces that
    the meshes share cancel by their corners alone.
    """
    count = len(a.vertices)
    vertices, same = welded(np.concatenate([a.vertices, b.vertices]))
    faces = _cancelled(np.concatenate([same[:count][a.faces], same[count:][b.faces][:, ::-1]]))
    if len(faces) == 0:
        return Solid.empty()
    try:
        return Solid(vertices, faces, pitch=pitch, winding="nonzero")
    except LimitError:
        return Solid(vertices, faces, winding="nonzero")
    except InvalidMeshError as error:
        if error.code != "empty_mesh":
            raise
        # The remaining faces have no area on the lattice.
        return Solid.empty()


def _cancelled(faces: IndexArray) -> IndexArray:
    """Return the faces after removing pairs with the same corners in opposite order."""
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    first = faces.argmin(axis=1)
    rows = np.arange(len(faces))
    low, mid, high = (faces[rows, (first + step) % 3] for step in range(3))
    forth = mid < high
    corners = np.stack([low, np.minimum(mid, high), np.maximum(mid, high)], axis=1)
    kinds, which = np.unique(corners, axis=0, return_inverse=True)
    surplus = np.bincount(which.ravel(), np.where(forth, 1, -1), len(kinds)).astype(np.int64)
    oriented = np.where((surplus > 0)[:, None], kinds, kinds[:, [0, 2, 1]])
    return np.repeat(oriented, np.abs(surplus), axis=0)
