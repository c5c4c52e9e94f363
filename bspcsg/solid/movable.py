"""`Movable`: the methods for affine transforms of solids and of objects that contain solids."""

from abc import ABC, abstractmethod
from typing import Any, Self

from .._types import Scalar, Vector
from ..errors import invalid_parameter
from ..geometry import transform
from ..geometry.arrays import axes_of
from ..geometry.per_axis import per_axis
from ..geometry.transform import Factors
from ..parameters import number


class Movable(ABC):
    """An object in space, such as a solid or an assembly, that affine maps can transform."""

    __slots__ = ()

    @abstractmethod
    def _moved(self, factors: Factors) -> Self:
        """Return the object's image under a sequence of affine maps; the last map acts first."""

    def translate(
        self,
        *offset: Scalar | Vector,
        x: Scalar | None = None,
        y: Scalar | None = None,
        z: Scalar | None = None,
    ) -> Self:
        """Return the object translated by three numbers, one vector, or along named axes.

        The result is exact if the numbers are multiples of the lattice step, as short decimals are.

        Parameters
        ----------
        *offset : float or (3,) float
            In model units.
        x, y, z : float, optional
            Instead of `offset`; 0 along an axis that is not named.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(1).translate(z=5) == csg.cube(1).translate(0, 0, 5)
        True
        """
        return self._moved((transform.translation(per_axis(offset, "offset", x=x, y=y, z=z)),))

    def rotate(
        self,
        angle: Scalar | Vector | None = None,
        axis: str | Vector = "z",
        *,
        x: Scalar = 0,
        y: Scalar = 0,
        z: Scalar = 0,
        about: Vector = (0, 0, 0),
    ) -> Self:
        """Return the object rotated about an axis.

        Quarter turns about a coordinate axis are exact.

        Parameters
        ----------
        angle : float or (3,) float, optional
            In degrees, counter-clockwise when the axis points at the viewer. Three angles turn
            about x, then y, then z, and `axis` is ignored.
        axis : {"x", "y", "z"} or (3,) float
            The direction of the axis of rotation.
        x, y, z : float
            In degrees, instead of `angle`: about x, then y, then z.
        about : (3,) float
            A point through which the axis passes, or each of the three axes.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.box((1, 2, 3)).rotate(z=90).bounds[0].tolist()
        [-2.0, 0.0, 0.0]
        """
        turns = number(x, "x"), number(y, "y"), number(z, "z")
        if angle is not None and any(turns):
            raise invalid_parameter(
                "Both an angle and rotations about x, y or z are given; give either angle and"
                " axis, or x, y and z."
            )
        turn: Any = turns if angle is None else angle
        is_one = axes_of(turn) == 0
        factors = (transform.rotation(turn, axis),) if is_one else transform.euler_rotation(turn)
        return self._moved(transform.about(about, factors))

    def scale(
        self,
        factor: Scalar | Vector | None = None,
        *others: Scalar,
        x: Scalar | None = None,
        y: Scalar | None = None,
        z: Scalar | None = None,
        about: Vector = (0, 0, 0),
    ) -> Self:
        """Return the object scaled by one factor, by three factors, or along named axes.

        Parameters
        ----------
        factor : float or (3,) float
        *others : float
            The factors along y and z, if `factor` is the factor along x.
        x, y, z : float, optional
            Instead of `factor`; 1 along an axis that is not named.
        about : (3,) float
            The point that does not move.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(1).scale(z=2).volume, csg.cube(1).scale(2).volume
        (2.0, 8.0)
        """
        given = () if factor is None else (factor, *others)
        factors = per_axis(given, "scale factor", missing=1.0, x=x, y=y, z=z)
        return self._moved(transform.about(about, (transform.scaling(factors),)))

    def mirror(
        self,
        normal: str | Vector | Scalar | None = None,
        *others: Scalar,
        x: Scalar | None = None,
        y: Scalar | None = None,
        z: Scalar | None = None,
        about: Vector = (0, 0, 0),
    ) -> Self:
        """Return the object's mirror image across a plane.

        Parameters
        ----------
        normal : {"x", "y", "z"} or (3,) float
            The normal of the plane; need not have unit length.
        *others : float
            The y and z coordinates of the normal, if `normal` is its x coordinate.
        x, y, z : float, optional
            Instead of `normal`; 0 along an axis that is not named.
        about : (3,) float
            A point of the plane.

        Examples
        --------
        >>> import bspcsg as csg
        >>> csg.cube(1).mirror("x") == csg.cube(1).mirror(x=1) == csg.cube(1).translate(x=-1)
        True
        """
        given = () if normal is None else (normal, *others)
        across = per_axis(given, "normal", x=x, y=y, z=z)
        return self._moved(transform.about(about, (transform.mirroring(across),)))

    def transform(self, matrix: Any) -> Self:
        """Return the image under an affine map, a (4, 4) or (3, 4) matrix for column vectors.

        Solids transformed by bitwise equal matrices are combined first and transformed afterwards.

        Raises
        ------
        InvalidMeshError
            If the matrix is not an invertible affine map.
        """
        return self._moved((transform.matrix_factor(matrix),))
