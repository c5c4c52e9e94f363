"""Whether two solids are the same set, and if not, how they differ.

Whether they are the same is decided exactly. How far their boundaries are apart is estimated from
points on the boundary of the symmetric difference: everywhere else they coincide, so even a small
bump on a large body is sampled.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .._types import FloatArray
from ..errors import missing_part
from ..mesh import interop
from ..mesh.distance import distances_to_triangles
from ..mesh.mesh import Mesh
from ..solid.counting import uncounted
from ..solid.solid import Solid
from .discrepancy import SetDifference, measured
from .verdict import Facts

#: How many points are measured at once; more need more memory.
_BATCH = 1000


@dataclass(frozen=True)
class SetComparison:
    """The difference of two solids.

    Parameters
    ----------
    a, b : Facts
        Of the reduced boundaries.
    difference : SetDifference
        The symmetric difference; its volume is zero only if the sets are equal.
    hausdorff : float or None
        A lower bound of the distance of the boundaries in model units, the larger of both ways,
        from samples; None if it was not measured or one set is empty.
    samples : int
        How many points were measured.
    """

    a: Facts
    b: Facts
    equal: bool
    difference: SetDifference
    hausdorff: float | None = None
    samples: int = 0

    def to_dict(self) -> dict[str, Any]:
        """Return everything as JSON values."""
        return asdict(self)


@uncounted
def compare(a: Solid, b: Solid, samples: int = 10_000, seed: int = 0) -> SetComparison:
    """Compare two solids as sets.

    Parameters
    ----------
    a, b : Solid
        Bounded.
    samples : int
        How many points of the difference to measure; 0 for none.
    seed : int
        Of the random points.

    Raises
    ------
    UnboundedError
        If a solid reaches to infinity.
    MissingPartError
        If distances are wanted and rtree or scipy are not installed.

    Examples
    --------
    >>> import bspcsg as b
    >>> found = compare(b.cube(2), b.box((2, 2, 2.5)), samples=100)
    >>> found.equal, found.difference.volume, round(found.hausdorff, 9)
    (False, 2.0, 0.5)
    """
    meshes = a.normalized().to_mesh(), b.normalized().to_mesh()
    facts = Facts.of(meshes[0]), Facts.of(meshes[1])
    difference = (a ^ b).normalized()
    if difference.is_empty:
        return SetComparison(*facts, True, SetDifference(0.0), 0.0)
    mesh = difference.to_mesh()
    found, _ = measured(difference.volume, mesh)
    if samples == 0 or any(len(one.faces) == 0 for one in (*meshes, mesh)):
        return SetComparison(*facts, False, found)
    *ways, count = hausdorff(*meshes, mesh, samples, seed)
    return SetComparison(*facts, False, found, max(ways), count)


def hausdorff(
    a: Mesh, b: Mesh, difference: Mesh | None, samples: int, seed: int = 0
) -> tuple[float, float, int]:
    """Return how far each mesh reaches from the other, at least, and from how many points.

    Parameters
    ----------
    a, b : Mesh
    difference : Mesh or None
        The boundary of their symmetric difference, which holds all that one has and the other has
        not; None if there is none.
    samples : int
        How many points of its faces, and of its vertices at most.
    seed : int

    Raises
    ------
    MissingPartError
        If rtree or scipy are not installed.
    """
    if difference is None or not all(len(one.faces) for one in (a, b, difference)):
        return 0.0, 0.0, 0
    points = _sampled(difference, samples, np.random.default_rng(seed))
    return _farthest(b, points), _farthest(a, points), len(points)


def _sampled(mesh: Mesh, count: int, rng: np.random.Generator) -> FloatArray:
    """Return vertices, at most `count` of them, and as many random points on the faces."""
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


def require_distances() -> None:
    """Refuse to measure distances without what that needs.

    Raises
    ------
    MissingPartError
        If rtree or scipy are not installed.
    """
    try:
        import rtree  # noqa: F401
        import scipy  # noqa: F401
    except ImportError as error:
        remedy = 'pip install "bspcsg[compare]", or say --samples 0'
        raise missing_part(str(error.name), "to measure distances", remedy) from error


def _farthest(mesh: Mesh, points: FloatArray) -> float:
    """Return the largest distance of the points from a mesh."""
    return float(distances(mesh, points).max(initial=0.0))


def distances(mesh: Mesh, points: FloatArray) -> FloatArray:
    """Return the distance of each point from a mesh, (k,), in model units.

    Raises
    ------
    MissingPartError
        If rtree or scipy are not installed.
    """
    require_distances()
    from trimesh import proximity

    nearby_faces: Any = proximity.nearby_faces
    target, corners = interop.to_trimesh(mesh), mesh.vertices[mesh.faces]
    found = np.zeros(len(points))
    for at in range(0, len(points), _BATCH):
        batch = points[at : at + _BATCH]
        # Which faces can be the nearest is taken from trimesh, but not how far they are: there it
        # is wrong for needles by a good part of their length.
        near = nearby_faces(target, batch)
        counts = np.array([len(faces) for faces in near])
        faces = np.concatenate(near).astype(np.int64)
        each = distances_to_triangles(np.repeat(batch, counts, axis=0), corners[faces])
        starts = np.concatenate([[0], counts.cumsum()[:-1]])
        found[at : at + _BATCH] = np.minimum.reduceat(each, starts)
    return found
