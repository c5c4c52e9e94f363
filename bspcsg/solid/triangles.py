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
    """Triangles of a solid's mesh, (m, 3) int64; call it to get a selection of faces.

    Results of array operations are ordinary arrays.
    """

    _solid: Any

    def __array_finalize__(self, whole: object) -> None:
        """Drop the solid in arrays derived from this one."""
        self._solid = None

    def __call__(self, *, all: bool = False, angle: Scalar = 30.0) -> "FaceSelection":  # noqa: A002
        """Return the faces as a selection (see `FaceSelection`).

        The facets of a round surface are one face: neighbours that bend by at most `angle`, with
        neither more than twice as wide as the other. So a plane face is separate from a round edge
        beside it, unless their facets are nearly as wide.

        Parameters
        ----------
        all : bool
            True for all plane faces, also facets.
        angle : float
            Degrees.

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
    """Return the triangles of a solid's mesh."""
    array = triangles.view(Triangles)
    array._solid = solid
    return array
