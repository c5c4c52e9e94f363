"""What is made of a solid by the verbs of the floors above: the methods, apart from the value."""

from typing import TYPE_CHECKING

from .._types import Scalar, Vector
from ..above import above

if TYPE_CHECKING:
    from .solid import Solid


class Modelled:
    """A solid as modelling sees it."""

    __slots__ = ()

    def split(self, normal: "Vector | Solid", offset: Scalar = 0.0) -> "tuple[Solid, Solid]":
        """Return the solid in two: what lies on either side of a plane, or of another's surface.

        Both have the cut as a face; together they are the solid again, exactly.

        Parameters
        ----------
        normal : (3,) float or Solid
            Of the plane; need not have unit length. Or the solid to cut with.
        offset : float
            The plane holds the points x with ``normal . x == offset``.

        Returns
        -------
        Solid, Solid
            What has ``normal . x <= offset``, and the rest. Of a cut by a solid: what is inside
            that, and the rest. Either may be empty.

        Raises
        ------
        InvalidMeshError
            If the normal is zero or a number is not finite ("bad_normal").

        Notes
        -----
        The plane is that of `bspcsg.half_space`: the one asked for if it holds lattice points, else
        the nearest of its direction that does. In a block (see `bspcsg.block`) neither counts.

        Examples
        --------
        >>> import bspcsg as b
        >>> below, above = b.cube(2).split((0, 0, 1), 0.5)
        >>> below.volume, above.volume
        (2.0, 6.0)
        >>> inside, outside = b.cube(2).split(b.cube(1))
        >>> inside.volume, outside.volume
        (1.0, 7.0)
        """
        halves: tuple[Solid, Solid] = above("split")(self, normal, offset)
        return halves

    def trim(self, normal: Vector, offset: Scalar = 0.0) -> "Solid":
        """Return what lies on the side of a plane where its normal points: the second of `split`.

        Parameters
        ----------
        normal : (3,) float
            Need not have unit length.
        offset : float
            What has ``normal . x >= offset`` stays.

        Raises
        ------
        InvalidMeshError
            If the normal is zero or a number is not finite ("bad_normal").

        Examples
        --------
        >>> import bspcsg as b
        >>> b.cube(2).trim((0, 0, 1), 0.5).bounds[0].tolist()
        [0.0, 0.0, 0.5]
        """
        rest: Solid = above("trim")(self, normal, offset)
        return rest

    def decompose(self) -> "list[Solid]":
        """Return the connected parts, the largest volume first; none for the empty set.

        The wall of a cavity stays with the part around it. Parts that touch in a point or an edge
        only are apart.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity.

        Notes
        -----
        Of several parts each is the solid of its mesh: corners that are no lattice points are
        rounded to them. In a block (see `bspcsg.block`) none of them counts.

        Examples
        --------
        >>> import bspcsg as b
        >>> pair = b.cube(1) | b.cube(2).translate(5, 0, 0)
        >>> [part.volume for part in pair.decompose()]
        [8.0, 1.0]
        """
        parts: list[Solid] = above("decompose")(self)
        return parts
