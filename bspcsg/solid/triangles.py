"""The triangles of a solid, as an array that can be asked for the solid's faces."""

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
    """Triangles of a solid's mesh, (m, 3) int64; called, the faces that they make up.

    What is computed of them is an array like any other.
    """

    _solid: Any

    def __array_finalize__(self, whole: object) -> None:
        """Forget the solid in arrays that are made of this one."""
        self._solid = None

    def __call__(self, *, all: bool = False, angle: Scalar = 30.0) -> "FaceSelection":  # noqa: A002
        """Return the faces, to choose some of them (see `FaceSelection`).

        Facets of one round surface are one face: those that bend by `angle` at most, and of which
        neither is more than twice as wide as the other. So a plane face stays apart from the round
        edge beside it, unless that is nearly as wide.

        Parameters
        ----------
        all : bool
            True for all plane faces, facets among them.
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
            raise invalid_parameter("This array is no solid's any more; ask solid.faces().")
        from ..modelling.making.faces import faces_of

        return faces_of(self._solid, all=all, angle=angle)


def triangles_of(solid: Any, triangles: IndexArray) -> Triangles:
    """Return the triangles of a solid's mesh."""
    array = triangles.view(Triangles)
    array._solid = solid
    return array
