"""`EdgeSelection`: a selection of a solid's edges."""

from typing import ClassVar

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray, Scalar
from ...method_ownership import with_own_methods
from ...parameters import truth_value
from ...solid.solid import Solid
from .plane_faces import FaceGraph, face_graph_of
from .selection import Selection, as_bend, bends


@with_own_methods
class EdgeSelection(Selection):
    """A selection of a solid's edges; an edge is the segment between two corners of plane faces.

    Each property is an array with one entry per edge, for use in conditions.

    Examples
    --------
    >>> import bspcsg as csg
    >>> edges = csg.box(1, 2, 3).edges()
    >>> len(edges), edges.parallel("z")
    (12, EdgeSelection(4 of 12, length 3 to 3))
    >>> edges.filter(lambda e: e.length > 1.5)
    EdgeSelection(8 of 12, length 2 to 3)
    """

    _things: ClassVar[str] = "edges"
    _sizes: ClassVar[tuple[str, ...]] = ("length", "angle")

    @property
    def ends(self) -> FloatArray:
        """The start and end point of each edge, (n, 2, 3) float64, in model units."""
        ends: FloatArray = self._graph.vertices[self._graph.ends[self._numbers]]
        return ends

    @property
    def middle(self) -> FloatArray:
        """The midpoint of each edge, (n, 3) float64, in model units."""
        return np.asarray(self.ends.mean(axis=1))

    @property
    def direction(self) -> FloatArray:
        """The unit vector of each edge from its start to its end, (n, 3) float64."""
        directions: FloatArray = self._graph.directions[self._numbers]
        return directions

    @property
    def length(self) -> FloatArray:
        """The length of each edge, (n,) float64, in model units."""
        return np.asarray(np.linalg.norm(self._graph.vectors[self._numbers], axis=1))

    @property
    def normals(self) -> FloatArray:
        """The outward unit normals of the faces left and right of each edge, (n, 2, 3) float64."""
        normals: FloatArray = self._graph.normals[self._graph.sides[self._numbers]]
        return normals

    @property
    def angle(self) -> FloatArray:
        """The angle between the two faces of each edge, inside the solid, (n,) float64, in degrees.

        It is below 180 for a convex edge and above 180 for a concave edge.
        """
        angles: FloatArray = self._graph.angles[self._numbers]
        return angles

    @property
    def is_convex(self) -> BoolArray:
        """True for each edge whose angle inside the solid is below 180 degrees, (n,) bool."""
        convex: BoolArray = self._graph.is_convex[self._numbers]
        return convex

    def _flat_faces(self) -> tuple[IndexArray, IndexArray]:
        sides = self._graph.sides[self._numbers]
        return sides.ravel(), np.repeat(np.arange(len(self)), 2)

    def _between(self, heights: FloatArray) -> tuple[FloatArray, FloatArray]:
        ends = heights[self._graph.ends[self._numbers]]
        return ends.min(axis=1), ends.max(axis=1)

    def _total(self) -> int:
        return len(self._graph.ends)


def edges_of(solid: Solid, *, all: bool, angle: Scalar) -> EdgeSelection:  # noqa: A002
    """Return the selection of the edges of a solid; see `Solid.edges`."""
    least = as_bend(angle, truth_value(all, "all"))
    graph = face_graph_of(solid.normalized().to_mesh())
    return EdgeSelection(graph, np.flatnonzero(bends(graph, least)))


def selection(edges: EdgeSelection) -> tuple[FaceGraph, IndexArray]:
    """Return the face graph of the solid, and the numbers of the selected edges in it, (n,)."""
    return edges._graph, edges._numbers
