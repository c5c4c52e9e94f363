"""The difference of two meshes as sets, and its thickness.

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
    """The symmetric difference of two sets.

    Parameters
    ----------
    volume : float
        Of the difference on the lattice, rounded once; zero only if the sets are equal.
    area : float
    thickness : float
        The thickness of its thickest piece, in model units: twice the volume divided by the area.
        For a film that is its thickness, for a cube a third of its side.
    place : tuple of float or None
        A point of that piece.
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
        Of the lattice to which both meshes are snapped.
    film : float
        The thickness in model units below which differences need not be exact.

    Returns
    -------
    SetDifference
    Pieces or None
        The pieces of the difference, if it is not empty.

    Raises
    ------
    InvalidMeshError
        If a mesh is not closed.
    """
    difference = _where_windings_differ(a, b, pitch)
    if difference.is_empty:
        return SetDifference(0.0), None
    return measured(difference.volume, difference.normalized().to_mesh(), film)


def measured(
    volume: float, mesh: Mesh, film: float = 0.0
) -> tuple[SetDifference, MeshPieces | None]:
    """Return the size of a difference with this volume and boundary, and its pieces, if any."""
    if len(mesh.faces) == 0 or mesh.area == 0:
        return SetDifference(volume), None
    pieces = MeshPieces.of(mesh, film)
    worst = pieces.thickest
    # The exact volume also counts parts that rounding to doubles has flattened.
    thickness = max(float(pieces.thickness[worst]), 2 * volume / mesh.area)
    return SetDifference(volume, mesh.area, thickness, pieces.corner_of(worst)), pieces


def _where_windings_differ(a: Mesh, b: Mesh, pitch: int) -> Solid:
    """Return the set of points at which the winding numbers of the two meshes differ.

    Both meshes are taken as one, the second inside out: its winding number is the difference, and
    faces that the meshes share cancel before any geometry is done.
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
        # The faces that are left have no area on the lattice.
        return Solid.empty()


def _cancelled(faces: IndexArray) -> IndexArray:
    """Return the faces without pairs that have the same corners in opposite order."""
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
