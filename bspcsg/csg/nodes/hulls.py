"""Convex hulls and sums of shapes: hull, minkowski."""

from functools import reduce

import manifold3d
import numpy as np

from ..._types import FloatArray
from ...bsp import ObjectTree, Region
from ...errors import InternalError
from ...modelling.planar.hulls import hull_region
from ...operations import setops
from ...solid.solid import Solid
from ..syntax.arguments import Arguments
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node

#: A shape with more faces is not divided into convex parts, which grows with their square.
_MOST_FACES = 2000

#: More pairs of convex parts than this would take hours.
_MOST_PAIRS = 20_000


@node("hull")
def hull(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the convex hull of all children together."""
    solids, regions = run.same_kind(owner, [child for child in children if child])
    if solids:
        return hull_solid(np.concatenate([solid.to_mesh().vertices for solid in solids]))
    loops = [loop for region in regions for loop in region.to_polygons()]
    return hull_region(np.concatenate(loops)) if loops else None


def hull_solid(points: FloatArray) -> Solid:
    """Return the convex hull of points in space, empty if they lie in a plane.

    Raises
    ------
    InternalError
        If the library's hull is no closed mesh.
    """
    body = manifold3d.Manifold.hull_points(np.array(points, dtype=np.float64, order="C"))
    if body.status() != manifold3d.Error.NoError:
        raise InternalError(f"The convex hull failed: {body.status()}.", "hull_failed")
    return Solid.empty() if body.is_empty() else Solid.from_mesh(body)


@node("minkowski")
def minkowski(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Return the sums of a point of each child: the first swept along the others.

    Empty solids do not count, as in OpenSCAD. Shapes that are not convex are divided into convex
    parts; the sums of parts are the hulls of the sums of their corners, and these are united.
    """
    arguments = run.arguments(owner)
    solids, regions = run.same_kind(owner, children)
    if solids:
        bodies = [solid for solid in solids if not solid.is_empty]
        return reduce(lambda a, b: _solid_sum(a, b, arguments), bodies) if bodies else Solid.empty()
    if regions:
        return reduce(lambda a, b: _region_sum(a, b, arguments), _summands(children, regions))
    return None


def _summands(children: list[Geometry], regions: list[Region]) -> list[Region]:
    """Return the plane figures that are summed; a lone empty one if the sum is empty.

    OpenSCAD leaves empty operands out, but in the plane not the first one, nor the only other one.
    """
    figures = [region for region in regions if not region.is_empty]
    first = children[0]
    if len(children) > 1 and (first is None or first.is_empty or len(figures) < 2):
        return [Region.empty()]
    return regions if len(children) == 1 else figures


def _solid_sum(a: Solid, b: Solid, arguments: Arguments) -> Solid:
    first, second = _solid_parts(a, arguments), _solid_parts(b, arguments)
    _check_pairs(len(first) * len(second), arguments)
    return setops.union(hull_solid(_sums(p, q)) for p in first for q in second)


def _region_sum(a: Region, b: Region, arguments: Arguments) -> Region:
    first, second = a.convex_parts(), b.convex_parts()
    _check_pairs(len(first) * len(second), arguments)
    hulls = [hull_region(_sums(p, q)) for p in first for q in second]
    return Region([loop for part in hulls for loop in part.to_polygons()])


def _sums(first: FloatArray, second: FloatArray) -> FloatArray:
    sums = first[:, None, :] + second[None, :, :]
    return np.ascontiguousarray(sums.reshape(-1, first.shape[1]))


def _check_pairs(count: int, arguments: Arguments) -> None:
    if count > _MOST_PAIRS:
        message = (
            f"its children are not convex and fall into parts of which {count:,} pairs would have"
            f" to be summed; the most are {_MOST_PAIRS:,}."
        )
        raise arguments.error(message, "too_large")


def _solid_parts(solid: Solid, arguments: Arguments) -> list[FloatArray]:
    """Return the corners of convex parts that make up the solid."""
    mesh = solid.normalized().to_mesh()
    if _is_convex(mesh.vertices, mesh.volume):
        return [mesh.vertices]
    if len(mesh.faces) > _MOST_FACES:
        message = (
            f"a child is not convex and has {len(mesh.faces):,} faces; more than {_MOST_FACES:,}"
            " are not divided into convex parts."
        )
        raise arguments.error(message, "too_large")
    cells = ObjectTree.from_mesh(mesh, pitch=solid.tree.pitch).cells()
    corners: dict[int, list[FloatArray]] = {}
    for face, cell in enumerate(cells.owner.tolist()):
        corners.setdefault(cell, []).append(cells[face])
    return [np.unique(np.concatenate(faces), axis=0) for faces in corners.values()]


def _is_convex(vertices: FloatArray, volume: float) -> bool:
    """Whether the hull is no larger, but for the rounding of its corners."""
    return hull_solid(vertices).volume <= volume * (1 + 1e-9)
