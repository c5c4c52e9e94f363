"""Splits solids: into connected components, or into the two sides of a plane."""

import numpy as np

from .._types import FloatArray, IndexArray, Scalar, Vector
from ..attributes.attributes import made
from ..errors import InvalidMeshError
from ..mesh.boxes import boxes_around, boxes_of
from ..mesh.mesh import Mesh, surfaces_of
from ..shapes.primitives import half_space
from ..solid.counting import uncounted
from ..solid.solid import Solid

#: The number of corners of a cavity that are tested first: rarely do all of these lie on the shell
#: around it.
_CORNERS_TRIED_FIRST = 16


@uncounted
def connected_parts(solid: Solid) -> list[Mesh]:
    """Return the boundaries of the connected components, the largest volume first.

    A cavity's wall belongs to the component around it, which is found exactly. Parts that touch
    only in a point or an edge are separate, even where a face runs on from one to the other.

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

    Both sides have the cut as a face; their union is exactly the solid. The plane is that of
    `half_space`, with the same finding if it was moved onto the lattice.

    Parameters
    ----------
    solid : Solid
    normal : "x", "y", "z" or (3,) float
        Points to the upper side.
    offset : float

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
    """Return the faces of each number from 0 on as a separate mesh."""
    order = np.argsort(owner, kind="stable")
    ends = np.cumsum(np.bincount(owner))
    return [_selected(mesh, rows) for rows in np.split(order, ends[:-1])]


def _selected(mesh: Mesh, rows: IndexArray) -> Mesh:
    used, faces = np.unique(mesh.faces[rows], return_inverse=True)
    triangles = faces.reshape(-1, 3)
    carried = None if mesh.carried is None else made(mesh.attributes.onto(triangles, rows))
    return Mesh(mesh.vertices[used], triangles, mesh.source[rows], carried)


class _Shells:
    """The connected surfaces of a boundary, and how they are nested.

    Parameters
    ----------
    mesh : Mesh
    owner : (m,) int64
        For each face the number of its surface, from 0.
    pitch : int
    """

    def __init__(self, mesh: Mesh, owner: IndexArray, pitch: int) -> None:
        self._meshes = _split(Mesh(mesh.vertices, mesh.faces, mesh.source), owner)
        self._volumes = np.array([shell.volume for shell in self._meshes])
        self._boxes = boxes_of(mesh.vertices[mesh.faces], owner)
        self._pitch = pitch
        self._solids: dict[int, Solid] = {}

    def homes(self) -> IndexArray:
        """Return the outer shell that each shell belongs to: itself, or the one around a cavity."""
        homes = np.arange(len(self._meshes))
        cavities, solid = np.flatnonzero(self._volumes <= 0), np.flatnonzero(self._volumes > 0)
        around = boxes_around(self._boxes[cavities], self._boxes[solid])
        for cavity, near in zip(cavities.tolist(), around, strict=True):
            homes[cavity] = self._around(cavity, solid[near])
        return homes

    def _around(self, cavity: int, candidates: IndexArray) -> int:
        """Return the number of the smallest shell that contains a cavity's wall."""
        for number in candidates[np.argsort(self._volumes[candidates], kind="stable")].tolist():
            if self._holds(number, self._meshes[cavity].vertices):
                return int(number)
        # Only rounding can have moved the wall outside; the largest shell is the likeliest.
        return int(self._volumes.argmax())

    def _holds(self, number: int, points: FloatArray) -> bool:
        """Say whether points that cross no shell are inside it; one off the boundary decides."""
        if number not in self._solids:
            shell = self._meshes[number]
            self._solids[number] = Solid(shell.vertices, shell.faces, pitch=self._pitch)
        for some in (points[:_CORNERS_TRIED_FIRST], points[_CORNERS_TRIED_FIRST:]):
            try:
                sides = self._solids[number].classify(some)
            except InvalidMeshError:
                # Nothing is left of the shell on this lattice.
                return False
            if sides.any():
                return bool((sides > 0).any() and not (sides < 0).any())
        return False
