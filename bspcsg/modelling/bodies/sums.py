"""Minkowski sums, those of solids."""

from fractions import Fraction
from typing import Any, TypeAlias, overload

import numpy as np

from ..._types import FloatArray
from ...bsp import ObjectTree, Region
from ...errors import LimitError, UnboundedError, core_errors, invalid_parameter
from ...geometry.hyperplane import Hyperplane
from ...mesh.mesh import Mesh
from ...operations import setops
from ...solid.counting import counted
from ...solid.leaf import PlaneLeaf
from ...solid.solid import Solid, from_leaf
from ..planar.sums import sum_of_regions
from .hulls import hull_of
from .shading import half_edges, next_side

#: Corners of convex sets, each an array of shape (n, 3).
ConvexParts: TypeAlias = list[FloatArray]

#: Whole numbers of any size.
LongArray: TypeAlias = np.ndarray[Any, np.dtype[np.object_]]

#: By how much of its volume, and by how many steps a corner, rounding makes a convex solid another.
_LARGER, _MOVED = 1e-9, 4

#: A solid with more faces is not divided into convex parts, which grows with their square.
_MOST_FACES = 2000

#: More pairs of convex parts than this would take hours.
_MOST_PAIRS = 20_000

#: Sums of corners of which one hull is made at once: 24 bytes each and as many in steps, 1 GB.
_MOST_SUMS = 20_000_000


@overload
def minkowski(a: Solid, b: Solid) -> Solid: ...
@overload
def minkowski(a: Region, b: Region) -> Region: ...
@counted
def minkowski(a: Any, b: Any) -> Solid | Region:
    """Return the Minkowski sum: all points that are a point of one solid plus one of the other.

    It is the first solid thickened by the second. The sum of convex solids is the hull of the sums
    of their corners, exactly; others are divided into convex parts first, and the sums of parts are
    united.

    Parameters
    ----------
    a, b : Solid, or Region both
        The complement of a bounded solid may stand for `a`. So ``~minkowski(~a, b)`` is `a` made
        thinner: all points at which the mirror image of `b` in the origin fits into `a`.

    Returns
    -------
    Solid or Region
        Empty if one of them is.

    Raises
    ------
    InvalidParameterError
        If they are not both solids or both regions.
    UnboundedError
        If `b` reaches to infinity, or `a` and its complement do.
    LimitError
        If a solid that is not convex has more than 2000 faces, or there are more than 20 000 pairs
        of parts ("too_large").

    Notes
    -----
    Corners of parts that are no lattice points are rounded to it before they are added.

    Examples
    --------
    >>> import bspcsg as b
    >>> b.minkowski(b.cube(2), b.cube(1)).volume
    27.0
    >>> thin = ~b.minkowski(~b.cube(4), b.cube(2, center=True))
    >>> thin == b.cube(2).translate(1, 1, 1)
    True
    """
    if isinstance(a, Region) and isinstance(b, Region):
        return sum_of_regions(a, b)
    if not isinstance(a, Solid) or not isinstance(b, Solid):
        raise invalid_parameter("A Minkowski sum is that of two solids, or of two regions.")
    if a.is_empty or b.is_empty:
        return Solid.empty()
    if not a.is_bounded:
        return ~_eroded(~a, b)
    return _sum_of_parts(convex_parts(a), convex_parts(b), min(a.pitch, b.pitch))


def convex_parts(solid: Solid) -> ConvexParts:
    """Return the corners of convex parts that make up a solid.

    Raises
    ------
    LimitError
        If it is not convex and has too many faces.
    UnboundedError
        If it reaches to infinity.
    """
    mesh = solid.normalized().to_mesh()
    if is_convex(solid):
        return [mesh.vertices]
    if len(mesh.faces) > _MOST_FACES:
        message = (
            f"a solid is not convex and has {len(mesh.faces):,} faces; more than {_MOST_FACES:,}"
            " are not divided into convex parts."
        )
        raise LimitError(message, "too_large")
    cells = ObjectTree.from_mesh(mesh, pitch=solid.tree.pitch).cells()
    corners: dict[int, list[FloatArray]] = {}
    for face, cell in enumerate(cells.owner.tolist()):
        corners.setdefault(cell, []).append(cells[face])
    return [np.unique(np.concatenate(faces), axis=0) for faces in corners.values()]


def is_convex(solid: Solid) -> bool:
    """Say whether the hull is no larger, but for the rounding of its corners."""
    mesh = solid.normalized().to_mesh()
    largest = mesh.volume * (1 + _LARGER)
    # Small holes in a large body hardly change its volume.
    return hull_of(mesh.vertices, solid.pitch).volume <= largest and not _bends_inwards(
        mesh, 10.0**solid.pitch
    )


def _bends_inwards(mesh: Mesh, step: float) -> bool:
    """Say whether an edge is concave by more than rounding can make it.

    Corners move by some steps. At the far corner of the smaller triangle the plane of the larger
    one moves as many times more as that corner is farther away than the edge is long, or the
    larger triangle high.
    """
    first, second = half_edges(mesh)
    points = mesh.vertices[mesh.faces].reshape(-1, 3)
    a, b, c = (points[k::3] for k in range(3))
    normals = np.cross(b - a, c - a)
    sizes = np.linalg.norm(normals, axis=1)
    is_first = sizes[first // 3] >= sizes[second // 3]
    large, small = np.where(is_first, first, second), np.where(is_first, second, first)
    start, end = points[large], points[next_side(large)]
    tip = points[next_side(next_side(small))] - start
    size, length = sizes[large // 3], np.linalg.norm(end - start, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):  # triangles without area have no plane
        over = np.einsum("ij,ij->i", tip, normals[large // 3]) / size
        reach = np.linalg.norm(tip, axis=1) / np.minimum(length, size / length)
    return bool((over > _MOVED * step * (1 + reach)).any())


def _sum_of_parts(first: ConvexParts, second: ConvexParts, pitch: int) -> Solid:
    _refuse_many(len(first) * len(second))
    return setops.union(_sum(p, q, pitch) for p in first for q in second)


def _refuse_many(pairs: int) -> None:
    if pairs > _MOST_PAIRS:
        message = (
            f"the solids fall into convex parts of which {pairs:,} pairs would have to be added;"
            f" the most are {_MOST_PAIRS:,}."
        )
        raise LimitError(message, "too_large")


def _sum(first: FloatArray, second: FloatArray, pitch: int) -> Solid:
    """Return the hull of the sums of corners."""
    if len(first) * len(second) > _MOST_SUMS:
        message = (
            f"the solids have {len(first):,} and {len(second):,} corners; the most sums of two are"
            f" {_MOST_SUMS:,}."
        )
        raise LimitError(message, "too_large")
    sums = first[:, None, :] + second[None, :, :]
    return hull_of(sums.reshape(-1, 3), pitch)


def _eroded(solid: Solid, tool: Solid) -> Solid:
    """Return the points at which the mirror image of a tool in the origin fits into a solid."""
    if not solid.is_bounded:
        raise UnboundedError(
            "This solid and its complement both reach to infinity, so it has no sum.", "unbounded"
        )
    if solid.is_empty:
        return solid
    if is_convex(solid) and is_convex(tool):
        return _between_planes(solid, tool)
    parts = convex_parts(tool)
    triangles = solid.normalized().to_mesh()
    _refuse_many(len(parts) * len(triangles.faces))
    pitch = min(solid.pitch, tool.pitch)
    corners = triangles.vertices[triangles.faces]
    return setops.intersection(_eroded_by(solid, corners, part, pitch) for part in parts)


def _eroded_by(solid: Solid, corners: FloatArray, part: FloatArray, pitch: int) -> Solid:
    """Return a solid less what a convex tool touches while it moves along the boundary.

    Where the tool touches no boundary, it is inside if one of its points is. One in its middle
    leaves a body that ends deep in what the tool touches, whose corners are rounded.
    """
    rim = setops.union(_sum(triangle, part, pitch) for triangle in corners)
    middle = [round(x, -pitch) for x in part.mean(axis=0).tolist()]
    return solid.translate(middle) - rim


def _between_planes(solid: Solid, tool: Solid) -> Solid:
    """Return a convex solid with each face moved in as far as the tool reaches.

    The planes are those of the inputs' faces, exactly: corners of what cuts left of them are
    rounded.
    """
    reach = _steps(tool)
    tree = solid.normalized().tree
    steps = Fraction(10) ** tree.pitch, Fraction(10) ** tool.pitch
    with core_errors():
        rows = _supporting(tree.planes(), _in_steps(solid))
    planes = {_plane_inside(normal, offset, reach, *steps) for *normal, offset in rows}
    halves = [from_leaf(PlaneLeaf(plane)) for plane in sorted(planes, key=_plane_key)]
    return setops.intersection(halves)


def _supporting(rows: list[list[int]], points: FloatArray) -> list[list[int]]:
    """Return planes, normal and offset, moved outwards to where they hold all points.

    Rounded bodies are convex but for some steps. Faces narrower than that may face anywhere.
    """
    planes = np.array(rows, dtype=np.float64)
    planes /= np.linalg.norm(planes[:, :3], axis=1)[:, None]
    doubt = max(0.1, 16 * float(np.finfo(np.float64).eps * np.abs(points).max()))

    def supporting(row: list[int], plane: FloatArray) -> list[int]:
        heights = points @ plane[:3]
        highest = int(heights.argmax())
        if heights[highest] <= plane[3] + doubt:
            return row
        normal, corner = row[:3], [round(x) for x in points[highest].tolist()]
        return [*normal, sum(n * x for n, x in zip(normal, corner, strict=True))]

    return [supporting(row, plane) for row, plane in zip(rows, planes, strict=True)]


def _in_steps(solid: Solid) -> FloatArray:
    """Return the corners in lattice steps."""
    vertices = solid.normalized().to_mesh().vertices
    steps: FloatArray = (
        vertices * 10.0**-solid.pitch if solid.pitch < 0 else vertices / 10.0**solid.pitch
    )
    return steps


def _steps(tool: Solid) -> LongArray:
    """Return the corners in whole lattice steps, as numbers without limits."""
    whole: LongArray = np.rint(_in_steps(tool)).astype(np.int64).astype(object)
    return whole


def _plane_inside(
    normal: list[int], offset: int, reach: LongArray, step: Fraction, tool_step: Fraction
) -> Hyperplane:
    """Return a plane moved by the least reach of the tool along its normal, each in its steps."""
    least = np.dot(reach, np.array(normal, dtype=object)).min()
    return Hyperplane.of(list(map(Fraction, normal)), offset * step + least * tool_step)


def _plane_key(plane: Hyperplane) -> Any:
    return plane.normal, plane.offset
