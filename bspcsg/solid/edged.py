"""The edges of a solid, and what replaces them, as methods."""

from typing import TYPE_CHECKING

from .._types import Scalar
from ..above import above
from .counting import counted, uncounted

if TYPE_CHECKING:
    from ..modelling.making.edges import EdgeSelection
    from .solid import Solid


class Edged:
    """A solid with edges between its faces."""

    __slots__ = ()

    @uncounted
    def edges(self, *, all: bool = False, angle: Scalar = 30.0) -> "EdgeSelection":  # noqa: A002
        """Return the edges at which faces bend, to choose some of them (see `EdgeSelection`).

        The lines between the facets of a round surface are none. The rim of a bore is one: it comes
        as the edges of its facets.

        Parameters
        ----------
        all : bool
            True for the edges between all plane faces, facets among them.
        angle : float
            Degrees; faces bend by more than this at an edge.

        Raises
        ------
        InvalidParameterError
            If the angle is not from 0 to below 180.
        UnboundedError
            If the solid reaches to infinity.

        Examples
        --------
        >>> import bspcsg as b
        >>> part = b.box(30, 20, 10) - b.cylinder(10, d=8).translate(15, 10, 0)
        >>> len(part.edges().parallel("z")), len(part.edges(all=True).parallel("z"))
        (4, 36)
        """
        edges: EdgeSelection = above("edges")(self, all=all, angle=angle)
        return edges

    @counted
    def chamfer(self, edges: "EdgeSelection", size: Scalar) -> "Solid":
        """Return the solid with flat surfaces instead of edges.

        Material is taken off along convex edges and filled in along concave ones. At corners the
        new surfaces run into each other. Where a concave edge ends between two convex ones, or the
        other way around, it comes first, and the two run on along the end of its new surface.

        Parameters
        ----------
        edges : EdgeSelection
            Some of the solid's own.
        size : float
            From the edge to where the new surface begins, on both faces, in model units.

        Raises
        ------
        InvalidParameterError
            If the faces leave no room, or convex and concave edges meet otherwise, or a corner is
            not convex and of more than three faces; the message names the place.
        LimitError
            If more than 10 000 edges are chosen.

        Examples
        --------
        >>> import bspcsg as b
        >>> part = b.box(10, 10, 10)
        >>> part.chamfer(part.edges().parallel("z"), 1).volume
        980.0
        """
        solid: Solid = above("chamfer")(self, edges, size)
        return solid

    @counted
    def fillet(self, edges: "EdgeSelection", radius: Scalar, segments: int = 32) -> "Solid":
        """Return the solid with round surfaces instead of edges.

        Material is taken off along convex edges and filled in along concave ones, to a cylinder
        that touches both faces. Where three such edges meet and all are chosen, the corner is part
        of a ball. Convex and concave edges that meet are taken in turn, as by `chamfer`.

        Parameters
        ----------
        edges : EdgeSelection
            Some of the solid's own.
        radius : float
            In model units.
        segments : int
            Sides of a full circle, at least 4; all edges have as many sides as the sharpest needs.

        Raises
        ------
        InvalidParameterError
            As for `chamfer`; or if more than three round edges would meet. Of edges of both kinds,
            those taken last run along the facets of the others, which leave no room where they are
            narrower than the radius; the message has the place.
        LimitError
            If more than 10 000 edges are chosen, or the solid would have too many corners.

        Examples
        --------
        >>> import bspcsg as b
        >>> part = b.box(4, 3, 2)
        >>> part.fillet(part.edges(), 0.5) == b.rounded_box((4, 3, 2), 0.5)
        True
        """
        solid: Solid = above("fillet")(self, edges, radius, segments)
        return solid
