"""The triangles of a solid, as an array that can be called to select faces."""

from typing import TYPE_CHECKING, Any

import numpy as np

from .._types import IndexArray, Scalar
from ..errors import invalid_parameter

if TYPE_CHECKING:
    from ..modelling.making.faces import FaceSelection

    _Array = np.ndarray[tuple[int, int], np.dtype[np.int64]]
else:
    _Array = np.ndarray


class Triangles(_Array):
    """The triangles of a solid's mesh, (m, 3) int64; a call returns a selection of faces.

    Arrays derived from it, such as slices, cannot be called.
    """

    _solid: Any

    def __array_finalize__(self, whole: object) -> None:
        """Forget the solid in an array derived from this one, which so cannot select faces."""
        self._solid = None

    def __call__(self, *, all: bool = False, angle: Scalar = 30.0) -> "FaceSelection":  # noqa: A002
        """Return the solid's faces as a selection (see `FaceSelection`).

        The facets of a round surface are one face: neighbours that bend by at most `angle`, with
        neither more than twice as wide as the other. So a plane face is separate from a round edge
        beside it, unless their facets are nearly as wide.

        Parameters
        ----------
        all : bool
            True to select all plane faces, each facet of a round surface included.
        angle : float
            The largest bend, in degrees, between neighbouring facets of one round face.

        Raises
        ------
        InvalidParameterError
            If the angle is not from 0 to below 180.
        UnboundedError
            If the solid reaches to infinity.
        """
        if self._solid is None:
            raise invalid_parameter(
                "This copy of the array does not know its solid any more; call faces() of the"
                " solid instead."
            )
        from ..modelling.making.faces import faces_of

        return faces_of(self._solid, all=all, angle=angle)


def triangles_of(solid: Any, triangles: IndexArray) -> Triangles:
    """Return the triangles of a solid's mesh as an array that selects faces when called."""
    array = triangles.view(Triangles)
    array._solid = solid
    return array
