"""`EdgeSelection`: a selection of a solid's edges."""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray, Vector
from ...errors import invalid_parameter
from ...geometry.arrays import axes_of
from ...geometry.transform import axis_vector
from ...solid.solid import Solid
from .skeleton import Skeleton, skeleton_of

#: The sine of the largest angle between parallel lines: the lattice turns an edge of a thousand
#: steps so much.
_PARALLEL = 1e-3


class EdgeSelection:
    """Edges of a solid, each between two plane faces, from corner to corner.

    All properties are arrays over the edges, so that conditions are made of them.

    Examples
    --------
    >>> import bspcsg as csg
    >>> edges = csg.box(1, 2, 3).edges()
    >>> len(edges), edges.parallel("z")
    (12, EdgeSelection(4 of 12, lengths 3 to 3))
    >>> edges.where(lambda e: e.length > 1.5)
    EdgeSelection(8 of 12, lengths 2 to 3)
    """

    def __init__(self, skeleton: Skeleton, numbers: IndexArray) -> None:
        self._skeleton = skeleton
        self._numbers = numbers

    @property
    def ends(self) -> FloatArray:
        """The beginning and end of each edge, (n, 2, 3), in model units."""
        ends: FloatArray = self._skeleton.vertices[self._skeleton.ends[self._numbers]]
        return ends

    @property
    def middle(self) -> FloatArray:
        """The middles, (n, 3), in model units."""
        return np.asarray(self.ends.mean(axis=1))

    @property
    def direction(self) -> FloatArray:
        """Unit vectors from beginning to end, (n, 3)."""
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
        """Degrees from face to face through the material, (n,): below 180 convex, above concave."""
        angles: FloatArray = self._skeleton.angles[self._numbers]
        return angles

    @property
    def is_convex(self) -> BoolArray:
        """True where the angle is below 180 degrees, (n,)."""
        convex: BoolArray = self._skeleton.is_convex[self._numbers]
        return convex

    def where(self, condition: "Callable[[EdgeSelection], Any] | Any") -> "EdgeSelection":
        """Return the edges for which a condition holds.

        Parameters
        ----------
        condition : function or (n,) bool
            The function is given these edges and returns a truth value for each.

        Raises
        ------
        InvalidParameterError
            If there are not as many truth values as edges.
        """
        found = condition(self) if callable(condition) else condition
        given = np.asarray(None if axes_of(found) is None else found)
        if given.dtype != np.bool_ or given.shape != (len(self),):
            raise invalid_parameter(
                f"A condition has one truth value for each of the {len(self)} edges, not"
                f" {given.dtype} of shape {given.shape}."
            )
        return EdgeSelection(self._skeleton, self._numbers[given])

    def parallel(self, axis: str | Vector) -> "EdgeSelection":
        """Return the edges along an axis, either way.

        Parameters
        ----------
        axis : {"x", "y", "z"} or (3,) float
        """
        across = np.linalg.norm(np.cross(self.direction, axis_vector(axis)), axis=1)
        return self.where(across <= _PARALLEL)

    def __or__(self, other: "EdgeSelection") -> "EdgeSelection":
        """Return the edges of both selections of one solid."""
        if not isinstance(other, EdgeSelection):
            return NotImplemented
        if other._skeleton.vertices is not self._skeleton.vertices:
            raise invalid_parameter("Selections of different solids cannot be united.")
        return EdgeSelection(self._skeleton, np.union1d(self._numbers, other._numbers))

    def __len__(self) -> int:
        """Return the number of edges."""
        return len(self._numbers)

    def __repr__(self) -> str:
        """Say how many edges of how many, and how long they are."""
        told = f", lengths {self.length.min():g} to {self.length.max():g}" if len(self) else ""
        return f"EdgeSelection({len(self)} of {len(self._skeleton.ends)}{told})"


def edges_of(solid: Solid) -> EdgeSelection:
    """Return all edges of a solid."""
    skeleton = skeleton_of(solid.normalized().to_mesh())
    return EdgeSelection(skeleton, np.arange(len(skeleton.ends)))


def selection(edges: EdgeSelection) -> tuple[Skeleton, IndexArray]:
    """Return what a selection is made of, for the modules of this package."""
    return edges._skeleton, edges._numbers
