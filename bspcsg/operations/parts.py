"""A solid in parts: its connected components, and the two sides of a plane."""

import numpy as np

from .._types import FloatArray, IndexArray, Scalar, Vector
from ..attributes.attributes import made
from ..mesh.mesh import Mesh, surfaces_of
from ..shapes.primitives import half_space
from ..solid.counting import uncounted
from ..solid.solid import Solid


@uncounted
def connected_parts(solid: Solid) -> list[Mesh]:
    """Return the boundaries of the connected components, the largest volume first.

    A cavity's wall goes with the component around it; which one that is, is decided exactly. Parts
    that touch in a point or an edge only are apart.

    Parameters
    ----------
    solid : Solid

    Raises
    ------
    UnboundedError
        If the solid reaches to infinity.
    """
    mesh = solid.normalized().to_mesh()
    if len(mesh.faces) == 0:
        return []
    owner = surfaces_of(mesh.faces, len(mesh.vertices))
    shells = [_selected(mesh, owner == number) for number in range(int(owner.max()) + 1)]
    volumes = [shell.volume for shell in shells]
    outer = [number for number, volume in enumerate(volumes) if volume > 0]
    home = {number: number for number in outer}
    for cavity in set(range(len(shells))) - set(outer):
        home[cavity] = _around(shells, volumes, outer, cavity, solid.pitch)
    groups = [np.isin(owner, [k for k in home if home[k] == number]) for number in outer]
    parts = [_selected(mesh, group) for group in groups]
    return sorted(parts, key=lambda part: -part.volume)


@uncounted
def sides_of_plane(solid: Solid, normal: Vector, offset: Scalar) -> tuple[Solid, Solid]:
    """Return what of a solid lies below and above the plane ``normal . x = offset``.

    Both sides have the cut as a face; together they are the solid again, exactly. The plane is that
    of `half_space`, and so is the finding if it had to be moved onto the lattice.

    Parameters
    ----------
    solid : Solid
    normal : (3,) float
        Points to the side that is above.
    offset : float

    Examples
    --------
    >>> import bspcsg as b
    >>> below, above = sides_of_plane(b.cube(2), (0, 0, 1), 0.5)
    >>> below.volume, above.volume
    (2.0, 6.0)
    """
    below = half_space(normal, offset)
    return solid & below, solid - below


def _selected(mesh: Mesh, which: "np.ndarray[tuple[int], np.dtype[np.bool_]]") -> Mesh:
    used, faces = np.unique(mesh.faces[which], return_inverse=True)
    triangles, kept = faces.reshape(-1, 3), np.flatnonzero(which)
    carried = None if mesh.carried is None else made(mesh.attributes.onto(triangles, kept))
    return Mesh(mesh.vertices[used], triangles, mesh.source[which], carried)


def _around(
    shells: list[Mesh], volumes: list[float], outer: list[int], cavity: int, pitch: int
) -> int:
    """Return the number of the smallest shell that a cavity's wall lies in."""
    points = shells[cavity].vertices
    for number in sorted(outer, key=lambda number: volumes[number]):
        if _in_box(points, shells[number].vertices) and _is_inside(points, shells[number], pitch):
            return number
    # Only rounding can have pushed the wall out; the largest shell is the likeliest.
    return max(outer, key=lambda number: volumes[number])


def _in_box(points: FloatArray, around: FloatArray) -> bool:
    low, high = around.min(axis=0), around.max(axis=0)
    return bool((points.min(axis=0) >= low).all() and (points.max(axis=0) <= high).all())


def _is_inside(points: FloatArray, shell: Mesh, pitch: int) -> bool:
    """Whether points that do not cross a shell are inside it; one off the boundary decides."""
    faces: IndexArray = shell.faces
    sides = Solid(shell.vertices, faces, pitch=pitch).classify(points)
    return bool((sides > 0).any() and not (sides < 0).any())
