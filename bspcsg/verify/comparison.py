"""Compare two solids: whether they are the same set, and how far apart their boundaries are.

Equality is decided exactly. The distance of the boundaries is estimated from sample points on the
boundary of the symmetric difference: elsewhere the boundaries coincide, so even a small bump on a
large body is sampled.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .._types import FloatArray
from ..mesh.box_tree import BoxPairs, BoxTree, NearPairSearch, squared_gaps
from ..mesh.distance import distances_to_triangles
from ..mesh.mesh import Mesh
from ..solid.ledger import uncounted
from ..solid.solid import Solid
from .discrepancy import SetDifference, measured_difference
from .verdict import Facts

#: A bound of the rounding of distances, as a fraction of the largest coordinate.
_SLACK = 1e-12

#: The numbers of points, and of pairs of a point and a triangle, in one array operation, which
#: bound the memory.
_POINTS_PER_BATCH, _PAIRS_PER_BATCH = 1000, 1 << 16


@dataclass(frozen=True)
class SetComparison:
    """The result of comparing two solids as sets.

    Parameters
    ----------
    a, b : Facts
        The facts about the reduced boundary of each solid.
    difference : SetDifference
        The symmetric difference; its volume is zero only if the sets are equal.
    hausdorff : float or None
        A lower bound of the Hausdorff distance of the boundaries in model units, from sample
        points; None if it was not measured or one set is empty.
    samples : int
        The number of sample points.
    """

    a: Facts
    b: Facts
    equal: bool
    difference: SetDifference
    hausdorff: float | None = None
    samples: int = 0

    def to_dict(self) -> dict[str, Any]:
        """Return all fields as JSON values."""
        return asdict(self)


@uncounted
def compare(a: Solid, b: Solid, samples: int = 10_000, seed: int = 0) -> SetComparison:
    """Compare two solids as sets, and estimate the distance of their boundaries.

    Parameters
    ----------
    a, b : Solid
        The solids, which must be bounded.
    samples : int
        The number of sample points on the boundary of the difference; 0 to measure no distance.
    seed : int
        The seed of the random points.

    Raises
    ------
    UnboundedError
        If a solid reaches to infinity.

    Examples
    --------
    >>> import bspcsg as csg
    >>> found = compare(csg.cube(2), csg.box((2, 2, 2.5)), samples=100)
    >>> found.equal, found.difference.volume, round(found.hausdorff, 9)
    (False, 2.0, 0.5)
    """
    meshes = a.normalized().to_mesh(), b.normalized().to_mesh()
    facts = Facts.of(meshes[0]), Facts.of(meshes[1])
    difference = (a ^ b).normalized()
    if difference.is_empty:
        return SetComparison(*facts, True, SetDifference(0.0), 0.0)
    mesh = difference.to_mesh()
    found, _ = measured_difference(difference.volume, mesh)
    if samples == 0 or any(len(one.faces) == 0 for one in (*meshes, mesh)):
        return SetComparison(*facts, False, found)
    *ways, count = hausdorff(*meshes, mesh, samples, seed)
    return SetComparison(*facts, False, found, max(ways), count)


def hausdorff(
    a: Mesh, b: Mesh, difference: Mesh | None, samples: int, seed: int = 0
) -> tuple[float, float, int]:
    """Return lower bounds of the distances from a to b and from b to a, and the number of points.

    Parameters
    ----------
    a, b : Mesh
    difference : Mesh or None
        The boundary of their symmetric difference, on which the points lie; None if it is empty.
    samples : int
        The number of random points on the faces of `difference`, and the largest number of its
        vertices.
    seed : int
    """
    if difference is None or not all(len(one.faces) for one in (a, b, difference)):
        return 0.0, 0.0, 0
    points = _sampled(difference, samples, np.random.default_rng(seed))
    return _farthest(b, points), _farthest(a, points), len(points)


def _sampled(mesh: Mesh, count: int, rng: np.random.Generator) -> FloatArray:
    """Return at most `count` vertices of a mesh, and `count` random points on its faces."""
    vertices = mesh.vertices[np.unique(mesh.faces)]
    if len(vertices) > count:
        vertices = rng.choice(vertices, count, replace=False)
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] for corner in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    if areas.sum() == 0:
        return vertices
    face = rng.choice(len(areas), count, p=areas / areas.sum())
    u, v = rng.random((2, count, 1))
    root = np.sqrt(u)
    inner = (1 - root) * a[face] + root * (1 - v) * b[face] + root * v * c[face]
    return np.concatenate([vertices, inner])


def _farthest(mesh: Mesh, points: FloatArray) -> float:
    """Return the largest distance of any of the points from a mesh."""
    return float(distances(mesh, points).max(initial=0.0))


def distances(mesh: Mesh, points: FloatArray) -> FloatArray:
    """Return the distance of each point from a mesh, (k,), in model units."""
    corners = mesh.vertices[mesh.faces]
    slack = _SLACK * max(np.abs(corners).max(), np.abs(points).max(initial=0.0))
    surface = _Surface(corners, slack)
    batches = (
        points[at : at + _POINTS_PER_BATCH] for at in range(0, len(points), _POINTS_PER_BATCH)
    )
    return np.concatenate([np.zeros(0), *map(surface.distances, batches)])


class _Surface:
    """Triangles, (m, 3, 3), in a tree of boxes, to compute the distances of points from them.

    A box is skipped only if it is more than `slack` farther than the nearest triangle found.
    """

    def __init__(self, corners: FloatArray, slack: float) -> None:
        self._corners, self._slack = corners, slack
        self._tree = BoxTree.over(corners)
        self._boxes = corners.min(axis=1), corners.max(axis=1)

    def distances(self, points: FloatArray) -> FloatArray:
        """Return the distance of each point from the nearest triangle, (k,)."""
        found = np.full(len(points), np.inf)
        near = self._tree.near_leaves(points)
        each = np.repeat(np.arange(len(points)), near.shape[1])
        # The distances to triangles in nearby leaves bound the search for the nearest triangle.
        self._lower(found, points, np.column_stack([each, near.ravel()]))
        search = NearPairSearch(BoxTree.of_points(points), self._tree, self._limit(found))
        for pairs in search.leaves():
            self._lower(found, points, pairs)
            search.limit = self._limit(found)
        return found

    def _limit(self, found: FloatArray) -> FloatArray:
        return (found + self._slack) ** 2

    def _lower(self, found: FloatArray, points: FloatArray, pairs: BoxPairs) -> None:
        """Replace distances in `found` by smaller ones to triangles; `pairs` are (point, leaf)."""
        numbers, rows = self._tree.members(pairs[:, 1])
        owners = pairs[rows, 0]
        for at in range(0, len(owners), _PAIRS_PER_BATCH):
            own, near = owners[at : at + _PAIRS_PER_BATCH], numbers[at : at + _PAIRS_PER_BATCH]
            low, high = (side[near] for side in self._boxes)
            gaps = squared_gaps(low, high, points[own], points[own])
            kept = gaps <= self._limit(found)[own]
            own, near = own[kept], near[kept]
            each = distances_to_triangles(points[own], self._corners[near])
            np.minimum.at(found, own, each)
