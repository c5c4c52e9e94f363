"""The transforms of a solid, as methods."""

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any

from .._types import Scalar, Vector
from ..errors import invalid_parameter
from ..geometry import transform
from ..geometry.arrays import axes_of
from ..geometry.transform import Factors
from ..parameters import number

if TYPE_CHECKING:
    from .solid import Solid


class Movable(ABC):
    """A solid that transforms move."""

    __slots__ = ()

    @abstractmethod
    def _moved(self, factors: Factors) -> "Solid":
        """Return the solid moved by the factors, outermost first."""

    def translate(self, *offset: Scalar | Vector) -> "Solid":
        """Return the solid moved by three numbers or one vector, in model units.

        Exact if the numbers are whole lattice steps, as short decimals are.
        """
        vector: Any = offset[0] if len(offset) == 1 else offset
        return self._moved((transform.translation(vector),))

    def rotate(
        self,
        angle: Scalar | Vector | None = None,
        axis: str | Vector = "z",
        *,
        x: Scalar = 0,
        y: Scalar = 0,
        z: Scalar = 0,
        about: Vector = (0, 0, 0),
    ) -> "Solid":
        """Return the solid rotated about an axis.

        Quarter turns about a coordinate axis are exact.

        Parameters
        ----------
        angle : float or (3,) float, optional
            In degrees, counter-clockwise when the axis points at the viewer. Three angles turn
            about x, then y, then z, and `axis` is ignored.
        axis : {"x", "y", "z"} or (3,) float
        x, y, z : float
            In degrees, instead of `angle`: about x, then y, then z.
        about : (3,) float
            A point of the axes.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.box((1, 2, 3)).rotate(z=90).bounds[0].tolist()
        [-2.0, 0.0, 0.0]
        """
        turns = number(x, "x"), number(y, "y"), number(z, "z")
        if angle is not None and any(turns):
            raise invalid_parameter("A rotation is by an angle and an axis, or by x, y and z.")
        turn: Any = turns if angle is None else angle
        is_one = axes_of(turn) == 0
        factors = (transform.rotation(turn, axis),) if is_one else transform.euler_rotation(turn)
        return self._moved(transform.about(about, factors))

    def scale(self, factor: Scalar | Vector, *, about: Vector = (0, 0, 0)) -> "Solid":
        """Return the solid scaled by one factor, or by one per axis; the point `about` stays."""
        return self._moved(transform.about(about, (transform.scaling(factor),)))

    def mirror(self, normal: str | Vector, *, about: Vector = (0, 0, 0)) -> "Solid":
        """Return the mirror image in the plane with this normal through the point `about`.

        The normal is "x", "y", "z" or three numbers.
        """
        return self._moved(transform.about(about, (transform.mirroring(normal),)))

    def transform(self, matrix: Any) -> "Solid":
        """Return the image under an affine map, a (4, 4) or (3, 4) matrix for column vectors.

        Solids that were moved by bitwise equal matrices are combined first and moved afterwards.

        Raises
        ------
        InvalidMeshError
            If the matrix is no invertible affine map.
        """
        return self._moved((transform.matrix_factor(matrix),))
