"""`FaceSelection`: a selection of a solid's faces."""

from typing import ClassVar, Self

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray, Scalar
from ...errors import invalid_parameter
from ...method_ownership import with_own_methods
from ...parameters import truth_value
from ...solid.ledger import uncounted
from ...solid.solid import Solid
from .plane_faces import FaceGraph, face_graph_of, groups, members
from .selection import Selection, as_bend, bends

#: The largest ratio of the widths of two neighbouring facets that count as one round face. A plane
#: face beside a round edge is usually wider than that.
_AS_WIDE = 2.0

#: The number of corners per batch, which bounds an array of three doubles each to 24 MB.
_CORNERS_PER_BATCH = 1_000_000


@with_own_methods
class FaceSelection(Selection):
    """A selection of a solid's faces: flat faces, and round faces that consist of flat facets.

    Neighbouring facets with a small angle between them and similar widths form one face, such as
    the wall of a bore. Each property is an array with one entry per face, for use in conditions.

    Parameters
    ----------
    graph : FaceGraph
        The plane faces and edges of the solid.
    numbers : (n,) int64
        The numbers of the selected faces.
    surface : (f,) int64
        The number of the face that contains each plane face of the face graph.

    Examples
    --------
    >>> import bspcsg as csg
    >>> faces = (csg.box(9, 9, 3) - csg.cylinder(3, d=4).translate(4, 4, 0)).faces()
    >>> len(faces), faces.filter(lambda f: ~f.is_flat)
    (7, FaceSelection(1 of 7, area 37.6386 to 37.6386))
    """

    _things: ClassVar[str] = "faces"
    _sizes: ClassVar[tuple[str, ...]] = ("area",)

    def __init__(self, graph: FaceGraph, numbers: IndexArray, surface: IndexArray) -> None:
        super().__init__(graph, numbers)
        self._surface = surface

    def _with(self, numbers: IndexArray) -> Self:
        return type(self)(self._graph, numbers, self._surface)

    @property
    def area(self) -> FloatArray:
        """The area of each face, (n,) float64, in model units squared."""
        return np.asarray(self._sums(np.linalg.norm(self._graph.areas, axis=1)))

    @property
    def middle(self) -> FloatArray:
        """The centroid of each face, (n, 3), in model units; not on the face if that is round."""
        graph = self._graph
        weights = np.linalg.norm(graph.areas, axis=1)
        middles = graph.vertices[graph.triangles].mean(axis=1)
        moments = [self._sums(weights * middles[:, axis]) for axis in range(3)]
        return np.column_stack(moments) / self.area[:, None]

    @property
    def is_flat(self) -> BoolArray:
        """True for each face that lies in one plane, (n,) bool."""
        counts = np.bincount(self._surface, minlength=self._total())
        return np.asarray(counts[self._numbers] == 1, dtype=np.bool_)

    @property
    def normal(self) -> FloatArray:
        """The outward unit normal of each flat face, (n, 3) float64; zero for a round face."""
        first = np.zeros(self._total(), dtype=np.int64)
        first[self._surface] = np.arange(len(self._surface))
        normals = self._graph.normals[first[self._numbers]]
        return np.where(self.is_flat[:, None], normals, 0.0)

    @property
    def direction(self) -> FloatArray:
        """The outward unit normal of each flat face, (n, 3) float64; zero for a round face."""
        return self.normal

    def _sums(self, values: FloatArray) -> FloatArray:
        """Return the sum of the triangles' values over each selected face, (n,)."""
        of_triangle = self._surface[self._graph.face]
        sums = np.bincount(of_triangle, values, minlength=self._total())
        return np.asarray(sums[self._numbers], dtype=np.float64)

    def _flat_faces(self) -> tuple[IndexArray, IndexArray]:
        place = np.full(self._total(), -1)
        place[self._numbers] = np.arange(len(self))
        owners = place[self._surface]
        return np.flatnonzero(owners >= 0), owners[owners >= 0]

    def _between(self, heights: FloatArray) -> tuple[FloatArray, FloatArray]:
        corners = heights[self._graph.triangles]
        of_triangle = self._surface[self._graph.face]
        low, high = np.full(self._total(), np.inf), np.full(self._total(), -np.inf)
        np.minimum.at(low, of_triangle, corners.min(axis=1))
        np.maximum.at(high, of_triangle, corners.max(axis=1))
        return low[self._numbers], high[self._numbers]

    def _total(self) -> int:
        return int(self._surface.max(initial=-1)) + 1

    def _is_alike(self, other: object) -> bool:
        return isinstance(other, FaceSelection) and np.array_equal(self._surface, other._surface)


@uncounted
def faces_of(solid: Solid, *, all: bool, angle: Scalar) -> FaceSelection:  # noqa: A002
    """Return the selection of the faces of a solid; see `Solid.faces`."""
    least = as_bend(angle, truth_value(all, "all"))
    graph = face_graph_of(solid.normalized().to_mesh())
    surface = _surfaces(graph, least)
    return FaceSelection(graph, np.arange(int(surface.max(initial=-1)) + 1), surface)


def flat_face(faces: FaceSelection) -> tuple[FloatArray, float]:
    """Return the unit normal, and the offset along it, of the plane of a single flat face.

    Raises
    ------
    InvalidParameterError
        If the selection is not a single face, or the face is not flat.
    """
    if not isinstance(faces, FaceSelection):
        raise invalid_parameter(
            "face must be a selection of faces, such as solid.faces().sort_by('z')[-1]."
        )
    if len(faces) != 1:
        raise invalid_parameter(f"Exactly one face must be selected, but {len(faces)} are.")
    if not faces.is_flat[0]:
        raise invalid_parameter("The selected face is curved; select a flat face.")
    normal: FloatArray = faces.normal[0]
    return normal, float(faces.middle[0] @ normal)


def _surfaces(graph: FaceGraph, least: float) -> IndexArray:
    """Return the number of the flat or round face that contains each plane face of a face graph.

    Plane faces belong together if their widths are similar and their angle is below `least`.
    """
    smooth = np.flatnonzero(~bends(graph, least))
    wide = [_widths(graph, smooth, side) for side in (0, 1)]
    alike = np.maximum(*wide) <= _AS_WIDE * np.minimum(*wide)
    return groups(graph.sides[smooth[alike]], len(graph.normals))


def _widths(graph: FaceGraph, edges: IndexArray, side: int) -> FloatArray:
    """Return how far the plane face on side 0 or 1 of each edge extends from the edge, (n,)."""
    widths = np.zeros(len(edges))
    counts = np.bincount(graph.face, minlength=len(graph.normals))
    sizes = counts[graph.sides[edges, side]]
    parts = np.cumsum(sizes) // _CORNERS_PER_BATCH
    for part in np.split(np.arange(len(edges)), np.flatnonzero(np.diff(parts)) + 1):
        own = edges[part]
        triangles, pair = members(graph.face, graph.sides[own, side])
        starts, inward = graph.vertices[graph.ends[own, 0]], graph.inward[own, side]
        corners = graph.vertices[graph.triangles[triangles]]
        away = np.einsum("ijk,ik->ij", corners - starts[pair, None], inward[pair])
        np.maximum.at(widths, part[pair], away.max(axis=1))
    return widths
