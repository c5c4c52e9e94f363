"""`EdgeSelection`: a selection of a solid's edges."""

from typing import ClassVar

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray, Scalar
from ...owned import owning
from ...parameters import truth_value
from ...solid.solid import Solid
from .selection import Selection, as_bend, bends
from .skeleton import Skeleton, skeleton_of


@owning
class EdgeSelection(Selection):
    """Edges of a solid, each between two plane faces and from corner to corner.

    All properties are arrays over the edges, for use in conditions.

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
        """The start and end of each edge, (n, 2, 3), in model units."""
        ends: FloatArray = self._skeleton.vertices[self._skeleton.ends[self._numbers]]
        return ends

    @property
    def middle(self) -> FloatArray:
        """The middles, (n, 3), in model units."""
        return np.asarray(self.ends.mean(axis=1))

    @property
    def direction(self) -> FloatArray:
        """Unit vectors from start to end, (n, 3)."""
        directions: FloatArray = self._skeleton.directions[self._numbers]
        return directions

    @property
    def length(self) -> FloatArray:
        """Lengths, (n,), in model units."""
        return np.asarray(np.linalg.norm(self._skeleton.vectors[self._numbers], axis=1))

    @property
    def normals(self) -> FloatArray:
        """Unit normals of the faces on the left and on the right, (n, 2, 3)."""
        normals: FloatArray = self._skeleton.normals[self._skeleton.sides[self._numbers]]
        return normals

    @property
    def angle(self) -> FloatArray:
        """Degrees between the faces through the material, (n,): below 180 convex, above concave."""
        angles: FloatArray = self._skeleton.angles[self._numbers]
        return angles

    @property
    def is_convex(self) -> BoolArray:
        """True where the angle is below 180 degrees, (n,)."""
        convex: BoolArray = self._skeleton.is_convex[self._numbers]
        return convex

    def _flat_faces(self) -> tuple[IndexArray, IndexArray]:
        sides = self._skeleton.sides[self._numbers]
        return sides.ravel(), np.repeat(np.arange(len(self)), 2)

    def _between(self, heights: FloatArray) -> tuple[FloatArray, FloatArray]:
        ends = heights[self._skeleton.ends[self._numbers]]
        return ends.min(axis=1), ends.max(axis=1)

    def _total(self) -> int:
        return len(self._skeleton.ends)


def edges_of(solid: Solid, *, all: bool, angle: Scalar) -> EdgeSelection:  # noqa: A002
    """Return the edges of a solid; see `Solid.edges`."""
    least = as_bend(angle, truth_value(all, "all"))
    skeleton = skeleton_of(solid.normalized().to_mesh())
    return EdgeSelection(skeleton, np.flatnonzero(bends(skeleton, least)))


def selection(edges: EdgeSelection) -> tuple[Skeleton, IndexArray]:
    """Return the skeleton and the numbers of a selection, for the modules of this package."""
    return edges._skeleton, edges._numbers
