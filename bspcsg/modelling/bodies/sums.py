"""Minkowski sums of solids."""

from fractions import Fraction
from itertools import islice
from typing import Any, TypeAlias, overload

import numpy as np

from ..._types import FloatArray
from ...bsp import ObjectTree, Region
from ...errors import LimitError, UnboundedError, core_errors, invalid_parameter
from ...geometry.hyperplane import Hyperplane
from ...mesh.mesh import Mesh
from ...operations import setops
from ...solid.leaf import PlaneLeaf
from ...solid.ledger import counted
from ...solid.solid import Solid, from_leaf
from ..planar.sums import sum_of_regions
from .convex_sums import sum_of_convex, swept
from .hulls import hull_of
from .polyhedra import LongArray, in_steps
from .shading import half_edges, next_side

#: The corners of each of several convex solids, as arrays of shape (n, 3).
ConvexParts: TypeAlias = list[FloatArray]

#: Tolerances for convex solids: how much larger the hull may be, relative to the solid's volume,
#: and how far rounding may move corners, in lattice steps.
_LARGER, _MOVED = 1e-9, 4

#: The largest product of the face counts of two solids that are not convex. Larger products would
#: take hours.
_MAX_FACE_PAIRS = 4_000_000

#: The number of Minkowski sums that are united in one batch. A union has fewer faces than its parts
#: together, so batches bound the memory.
_SUMS_PER_UNION = 64


@overload
def minkowski(a: Solid, b: Solid) -> Solid: ...
@overload
def minkowski(a: Region, b: Region) -> Region: ...
@counted
def minkowski(a: Any, b: Any) -> Solid | Region:
    """Return the Minkowski sum: all sums of a point of one solid and a point of the other.

    It is the first solid thickened by the second. The sum of convex solids is the hull of the sums
    of their corners. If only one solid is convex, the sum is the other solid plus the volume that
    the convex solid sweeps while it moves along the other's surface. If neither is convex, the
    solid with fewer faces is divided into convex parts, and the sums of the parts are united.

    Parameters
    ----------
    a, b : Solid, or Region both
        Two solids or two regions.
        `a` may be the complement of a bounded solid. So ``~minkowski(~a, b)`` erodes `a`: it
        consists of all points at which `b`, mirrored at the origin, fits into `a`.

    Returns
    -------
    Solid or Region
        Empty if `a` or `b` is empty.

    Raises
    ------
    InvalidParameterError
        If `a` and `b` are not both solids or both regions.
    UnboundedError
        If `b` reaches to infinity, or both `a` and its complement reach to infinity.
    LimitError
        If the convex solid sweeps a volume with more than 10 million faces, or if neither solid is
        convex and the product of their numbers of faces exceeds 4 million ("too_large"). For
        regions, if there are more than 20 000 pairs of convex parts.

    Notes
    -----
    Corners off the lattice are rounded to it before they are added.

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.minkowski(csg.cube(2), csg.cube(1)).volume
    27.0
    >>> thin = ~csg.minkowski(~csg.cube(4), csg.cube(2, center=True))
    >>> thin == csg.cube(2).translate(1, 1, 1)
    True
    """
    if isinstance(a, Region) and isinstance(b, Region):
        return sum_of_regions(a, b)
    if not isinstance(a, Solid) or not isinstance(b, Solid):
        raise invalid_parameter(
            f"The arguments of minkowski must be two solids or two regions, not {type(a).__name__}"
            f" and {type(b).__name__}."
        )
    if a.is_empty or b.is_empty:
        return Solid.empty()
    if not a.is_bounded:
        return ~_eroded(~a, b)
    if is_convex(a) and is_convex(b):
        return sum_of_convex(_hull(a), _hull(b))
    return _swept(*_solid_and_tool(a, b))


def convex_parts(solid: Solid) -> ConvexParts:
    """Return the corners of each of the convex parts whose union is a solid.

    Raises
    ------
    UnboundedError
        If the solid reaches to infinity.
    """
    mesh = solid.normalized().to_mesh()
    if is_convex(solid):
        return [mesh.vertices]
    cells = ObjectTree.from_mesh(mesh, pitch=solid.tree.pitch).cells()
    corners: dict[int, list[FloatArray]] = {}
    for face, cell in enumerate(cells.owner.tolist()):
        corners.setdefault(cell, []).append(cells[face])
    return [np.unique(np.concatenate(faces), axis=0) for faces in corners.values()]


def is_convex(solid: Solid) -> bool:
    """Return True if a solid equals its convex hull, up to rounding of its corners."""
    mesh = solid.normalized().to_mesh()
    largest = mesh.volume * (1 + _LARGER)
    # The volume alone does not reveal a small cavity, so edges are tested, too.
    return hull_of(mesh.vertices, solid.pitch).volume <= largest and not _bends_inwards(
        mesh, 10.0**solid.pitch
    )


def _bends_inwards(mesh: Mesh, step: float) -> bool:
    """Return True if an edge of a mesh is concave by more than rounding of corners explains.

    Rounding moves corners by up to `_MOVED` lattice steps of length `step`. The far corner of the
    smaller triangle at an edge is compared with the plane of the larger triangle, which may move
    farther there: by the ratio of that corner's distance to the edge's length or to the larger
    triangle's height.
    """
    first, second = half_edges(mesh.faces)
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


def _solid_and_tool(a: Solid, b: Solid) -> tuple[Solid, Solid]:
    """Return two solids in such an order that the second is convex or has at most as many faces."""
    first, second = (0 if is_convex(solid) else _face_count(solid) for solid in (a, b))
    return (b, a) if first < second else (a, b)


def _swept(solid: Solid, tool: Solid, is_inside: bool = False) -> Solid:
    """Return the Minkowski sum of a solid and a tool; if `is_inside`, the solid eroded by it."""
    _refuse_many(solid, tool)
    combined = setops.intersection if is_inside else setops.union
    hulls = (hull_of(part, tool.pitch) for part in convex_parts(tool))
    sums = (swept(solid, hull, is_inside) for hull in hulls if not hull.is_empty)
    found = combined(islice(sums, _SUMS_PER_UNION))
    while more := list(islice(sums, _SUMS_PER_UNION)):
        found = combined(found.normalized(), *more)
    return found


def _refuse_many(solid: Solid, tool: Solid) -> None:
    pairs = _face_count(solid) * _face_count(tool)
    if pairs > _MAX_FACE_PAIRS and not is_convex(tool):
        message = (
            f"neither solid is convex, and their {_face_count(solid):,} and"
            f" {_face_count(tool):,} faces form more than the {_MAX_FACE_PAIRS:,} pairs that"
            " are allowed; simplify the solids, or use a convex one."
        )
        raise LimitError(message, "too_large")


def _face_count(solid: Solid) -> int:
    return len(solid.normalized().to_mesh().faces)


def _hull(solid: Solid) -> Solid:
    return hull_of(_corners(solid), solid.pitch)


def _corners(solid: Solid) -> FloatArray:
    return solid.normalized().to_mesh().vertices


def _eroded(solid: Solid, tool: Solid) -> Solid:
    """Return the points at which a tool, mirrored at the origin, fits into a solid."""
    if not solid.is_bounded:
        raise UnboundedError(
            "This solid and its complement both reach to infinity, so its Minkowski sum"
            " cannot be computed; intersect it with a box first.",
            "unbounded",
        )
    if solid.is_empty:
        return solid
    if is_convex(solid) and is_convex(tool):
        return _between_planes(solid, tool)
    return _swept(solid, tool, is_inside=True)


def _between_planes(solid: Solid, tool: Solid) -> Solid:
    """Return a convex solid eroded by a tool: each face is moved inwards by the tool's extent.

    The exact planes of the input faces are used, since corners made by cuts are rounded.
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
    """Return planes moved outwards until no point lies outside any of them by more than rounding.

    A plane is a row [nx, ny, nz, offset] of integers; all lengths are in lattice steps. A point may
    lie far outside the plane of a face narrower than a step, whose normal rounding may turn.
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
    return in_steps(_corners(solid), solid.pitch)


def _steps(tool: Solid) -> LongArray:
    """Return a tool's corners, (n, 3), as Python integers in lattice steps."""
    whole: LongArray = np.rint(_in_steps(tool)).astype(np.int64).astype(object)
    return whole


def _plane_inside(
    normal: list[int], offset: int, reach: LongArray, step: Fraction, tool_step: Fraction
) -> Hyperplane:
    """Return a plane moved inwards by the extent of a tool along the plane's normal.

    The plane's `normal` and `offset` are in units of `step`, the tool's corners `reach` in units of
    `tool_step`.
    """
    least = np.dot(reach, np.array(normal, dtype=object)).min()
    return Hyperplane.of(list(map(Fraction, normal)), offset * step + least * tool_step)


def _plane_key(plane: Hyperplane) -> Any:
    return plane.normal, plane.offset
