"""Division of solids into connected components, or by a plane."""

import numpy as np

from .._types import FloatArray, IndexArray, Scalar, Vector
from ..attributes.attributes import made
from ..errors import InvalidMeshError
from ..mesh.boxes import boxes_around, boxes_of
from ..mesh.mesh import Mesh, surfaces_of
from ..shapes.primitives import half_space
from ..solid.ledger import uncounted
from ..solid.solid import Solid

#: The number of a cavity's corners that are tested first. Usually one of them is not on the
#: enclosing shell.
_CORNERS_TRIED_FIRST = 16


@uncounted
def connected_parts(solid: Solid) -> list[Mesh]:
    """Return the boundary of each connected component of a solid, the largest volume first.

    The wall of a cavity belongs to the component around it, which is found exactly. Components that
    touch only in a point or an edge are separate, even if a face continues from one to the other.

    Parameters
    ----------
    solid : Solid

    Raises
    ------
    UnboundedError
        If the solid reaches to infinity.
    """
    mesh = solid._divided_mesh()
    if len(mesh.faces) == 0:
        return []
    owner = surfaces_of(mesh.faces, len(mesh.vertices))
    home = _Shells(mesh, owner, solid.pitch).homes()
    _, part = np.unique(home[owner], return_inverse=True)
    return sorted(_split(mesh, part), key=lambda part: -part.volume)


@uncounted
def sides_of_plane(solid: Solid, normal: str | Vector, offset: Scalar) -> tuple[Solid, Solid]:
    """Return the parts of a solid below and above the plane ``normal . x = offset``.

    Both parts have the cut as a face; their union is exactly the solid. The plane is the boundary
    of `half_space`, with the same finding if it was moved onto the lattice.

    Parameters
    ----------
    solid : Solid
    normal : "x", "y", "z" or (3,) float
        The plane's normal, which points to the upper side.
    offset : float
        The value of ``normal . x`` on the plane.

    Examples
    --------
    >>> import bspcsg as csg
    >>> below, above = sides_of_plane(csg.cube(2), (0, 0, 1), 0.5)
    >>> below.volume, above.volume
    (2.0, 6.0)
    """
    below = half_space(normal, offset)
    return solid & below, solid - below


def _split(mesh: Mesh, owner: IndexArray) -> list[Mesh]:
    """Return a mesh of the faces with `owner` k, for each k from 0."""
    order = np.argsort(owner, kind="stable")
    ends = np.cumsum(np.bincount(owner))
    return [_selected(mesh, rows) for rows in np.split(order, ends[:-1])]


def _selected(mesh: Mesh, rows: IndexArray) -> Mesh:
    used, faces = np.unique(mesh.faces[rows], return_inverse=True)
    triangles = faces.reshape(-1, 3)
    carried = None if mesh.carried is None else made(mesh.attributes.onto(triangles, rows))
    return Mesh(mesh.vertices[used], triangles, mesh.source[rows], carried)


class _Shells:
    """The connected surfaces ("shells") of a solid's boundary, and which contains which.

    Parameters
    ----------
    mesh : Mesh
    owner : (m,) int64
        The number of each face's surface, from 0.
    pitch : int
        The pitch of the solid.
    """

    def __init__(self, mesh: Mesh, owner: IndexArray, pitch: int) -> None:
        self._meshes = _split(Mesh(mesh.vertices, mesh.faces, mesh.source), owner)
        self._volumes = np.array([shell.volume for shell in self._meshes])
        self._boxes = boxes_of(mesh.vertices[mesh.faces], owner)
        self._pitch = pitch
        self._solids: dict[int, Solid] = {}

    def homes(self) -> IndexArray:
        """Return the number of the outer shell of each shell, (n,).

        It is the shell itself, or for the wall of a cavity, the smallest shell around it.
        """
        homes = np.arange(len(self._meshes))
        cavities, solid = np.flatnonzero(self._volumes <= 0), np.flatnonzero(self._volumes > 0)
        around = boxes_around(self._boxes[cavities], self._boxes[solid])
        for cavity, near in zip(cavities.tolist(), around, strict=True):
            homes[cavity] = self._around(cavity, solid[near])
        return homes

    def _around(self, cavity: int, candidates: IndexArray) -> int:
        """Return the number of the smallest candidate shell that contains a cavity's wall."""
        for number in candidates[np.argsort(self._volumes[candidates], kind="stable")].tolist():
            if self._holds(number, self._meshes[cavity].vertices):
                return int(number)
        # Only rounding can have moved the wall out of its shell; take the largest shell.
        return int(self._volumes.argmax())

    def _holds(self, number: int, points: FloatArray) -> bool:
        """Return True if points are inside a shell; points on its boundary do not count.

        The points belong to a surface that does not cross the shell, so one point off the boundary
        decides.
        """
        if number not in self._solids:
            shell = self._meshes[number]
            self._solids[number] = Solid(shell.vertices, shell.faces, pitch=self._pitch)
        for some in (points[:_CORNERS_TRIED_FIRST], points[_CORNERS_TRIED_FIRST:]):
            try:
                sides = self._solids[number].classify(some)
            except InvalidMeshError:
                # The shell vanishes on this lattice.
                return False
            if sides.any():
                return bool((sides > 0).any() and not (sides < 0).any())
        return False
