"""What is made of a solid by the verbs of the floors above: the methods, apart from the value."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .._types import FloatArray, Scalar, Vector, WindingRule
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

    def min_gap(self, other: "Solid") -> float:
        """Return the least distance of a point of one solid from one of the other.

        It is 0 where they touch or overlap, and infinite if one is empty.

        Raises
        ------
        UnboundedError
            If one of them reaches to infinity.

        Notes
        -----
        Whether they overlap is decided exactly. Else boxes around triangles rule out what is far,
        and the nearest triangles are compared in fractions; the answer is rounded.

        Examples
        --------
        >>> import bspcsg as b
        >>> b.cube(1).min_gap(b.cube(1).translate(4, 5, 0))
        5.0
        """
        gap: float = above("min_gap")(self, other)
        return gap

    def closest_points(self, other: "Solid") -> tuple[FloatArray, FloatArray]:
        """Return a point of this solid and one of the other that are nearest, (3,) float64 each.

        Of several such pairs it is always the same one. Where the solids overlap, both are one
        point of both.

        Raises
        ------
        InvalidParameterError
            If one of them is empty.
        UnboundedError
            If one of them reaches to infinity.

        Examples
        --------
        >>> import bspcsg as b
        >>> p, q = b.cube(1).closest_points(b.cube(1).translate(2, 3, 4))
        >>> p.tolist(), q.tolist()
        ([1.0, 1.0, 1.0], [2.0, 3.0, 4.0])
        """
        pair: tuple[FloatArray, FloatArray] = above("closest_points")(self, other)
        return pair

    def intersects(self, other: "Solid") -> bool:
        """Whether the solids have a point in common; a common point of their surfaces will do.

        Whether they have volume in common is the opposite of `isdisjoint`.

        Raises
        ------
        UnboundedError
            If one of them reaches to infinity.

        Examples
        --------
        >>> import bspcsg as b
        >>> side = b.cube(1).translate(1, 0, 0)
        >>> b.cube(1).intersects(side), b.cube(1).isdisjoint(side)
        (True, True)
        """
        found: bool = above("intersects")(self, other)
        return found

    def refine(self, n: int | None = None, *, edge_length: Scalar | None = None) -> "Solid":
        """Return the solid with smaller triangles, for `warp` and for what works corner by corner.

        Corners stay, and new ones lie on the edges and in the faces, rounded to the lattice; where
        nothing had to be rounded, it is the same set.

        Parameters
        ----------
        n : int
            Each edge falls into n equal parts, each triangle into n².
        edge_length : float
            Or: edges are halved until none is longer, in model units.

        Raises
        ------
        InvalidParameterError
            If not just one of the two is given, or it is out of range.
        LimitError
            If there would be more than ten million triangles.
        UnboundedError
            If the solid reaches to infinity.

        Examples
        --------
        >>> import bspcsg as b
        >>> fine = b.cube(1).refine(4)
        >>> len(fine.faces), fine == b.cube(1)
        (192, True)
        """
        finer: Solid = above("refine")(self, n, edge_length)
        return finer

    def warp(
        self, f: Callable[[FloatArray], Any], *, winding: WindingRule | None = None
    ) -> "Solid":
        """Return the solid with its corners moved by a function; faces stay flat (see `refine`).

        Parameters
        ----------
        f : callable
            Takes all corners at once, (n, 3) float64 in model units, and returns where they go, an
            array of the same shape. It may turn the solid inside out.
        winding : {"positive", "nonzero", "even-odd"}, optional
            What is inside a result that crosses itself. By default such a result is refused.

        Raises
        ------
        InvalidMeshError
            If faces cross or overlap afterwards ("self_crossing"; `where` lists them), nothing is
            left of any face ("empty_mesh"), or `f` returns another shape or numbers that are not
            finite.
        UnboundedError
            If the solid reaches to infinity.

        Examples
        --------
        >>> import bspcsg as b
        >>> wedge = b.cube(2).warp(lambda p: p * [1, 1, 0.5] + p[:, :1] * [0, 0, 0.25])
        >>> wedge.volume, len(wedge.faces)
        (4.0, 12)
        """
        moved: Solid = above("warp")(self, f, winding)
        return moved
