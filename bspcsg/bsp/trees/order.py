"""Traversals of a partition tree: back to front, by distance, and plain ones."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ..._core import FragmentTree
from ..._types import FloatArray, IndexArray, SideArray
from ...errors import core_errors, invalid_parameter
from ...geometry.arrays import doubles
from ...parameters import shown, word
from .fragments import Fragments, ranges
from .node import Leaf, Node, Visitor

if TYPE_CHECKING:
    from .tree import PartitionTree


class Ordered(ABC):
    """The traversals of a tree."""

    core: FragmentTree

    @property
    def root(self) -> Node | None:
        """The root, None if there are no facets."""
        return Node(self._tree, 0) if len(self.core) else None

    def back_to_front(self, *, eye: Any = None, direction: Any = None) -> Fragments:
        """Return the fragments so that none hides one that comes after it.

        Parameters
        ----------
        eye : (d,) array_like, optional
            The viewpoint, in model units. It is not snapped: sides are decided for these doubles.
        direction : (d,) array_like, optional
            Instead of an eye: the direction of view of a parallel projection, away from the viewer.

        Returns
        -------
        Fragments
            Farthest first. Where the eye lies in a node's hyperplane, its fragments are seen
            edge-on and neither side hides the other; the plus side comes first.

        Raises
        ------
        InvalidParameterError
            If not exactly one of the two is given, one is not finite, or the direction is zero.

        Notes
        -----
        Fuchs, Kedem, Naylor 1980. Overlapping fragments of one coplanar set come in the order of
        the construction.
        """
        return self._tree.fragments.take(self._painted(eye, direction))

    def front_to_back(self, *, eye: Any = None, direction: Any = None) -> Fragments:
        """Return the reverse of `back_to_front`: the nearest fragments first."""
        return self._tree.fragments.take(self._painted(eye, direction)[::-1])

    def _painted(self, eye: Any, direction: Any) -> IndexArray:
        place, at_infinity = self._viewpoint(eye, direction)
        with core_errors():
            order = self.core.order(place, at_infinity)
        arrays = self._tree.arrays
        return ranges(arrays["start"][order], arrays["end"][order])

    def _viewpoint(self, eye: Any, direction: Any) -> tuple[list[float], bool]:
        if (eye is None) == (direction is None):
            raise invalid_parameter("Give exactly one of eye and direction.")
        at_infinity = eye is None
        name = "direction" if at_infinity else "eye"
        refusal = invalid_parameter(f"The {name} must be {self.core.dimension} numbers.")
        given = np.atleast_1d(doubles(direction if at_infinity else eye, refusal))
        if given.shape != (self.core.dimension,):
            message = f"The {name} must have {self.core.dimension} coordinates, not {given.shape}."
            raise invalid_parameter(message)
        # A viewer who looks along a direction is infinitely far away in the opposite direction.
        full: FloatArray = np.zeros(3)
        full[: self.core.dimension] = -given if at_infinity else given
        return full.tolist(), at_infinity

    def near_to_far(self, *, eye: Any = None, direction: Any = None) -> Iterator[Node | Leaf]:
        """Yield nodes and leaves from near to far: near side, node, far side."""
        return self._by_distance(self._sides(eye, direction))

    def far_to_near(self, *, eye: Any = None, direction: Any = None) -> Iterator[Node | Leaf]:
        """Yield nodes and leaves in the reverse order of `near_to_far`."""
        return self._by_distance(-self._sides(eye, direction), ties_minus_first=False)

    def _sides(self, eye: Any, direction: Any) -> SideArray:
        place, at_infinity = self._viewpoint(eye, direction)
        with core_errors():
            return self.core.sides(place, at_infinity)

    def _by_distance(self, sides: Any, ties_minus_first: bool = True) -> Iterator[Node | Leaf]:
        def arranged(node: Node) -> Sequence[Node | Leaf]:
            side = sides[node.index]
            minus, plus = node.children
            first_minus = side < 0 or (side == 0 and ties_minus_first)
            return (minus, node, plus) if first_minus else (plus, node, minus)

        return self._traversed(arranged)

    def walk(self, order: Literal["pre", "in", "post"] = "pre") -> Iterator[Node | Leaf]:
        """Yield all nodes and leaves, minus before plus; a node before, between or after both."""
        orders = ("pre", "in", "post")
        place = orders.index(word(orders, order, "order"))

        def arranged(node: Node) -> Sequence[Node | Leaf]:
            steps: list[Node | Leaf] = list(node.children)
            steps.insert(place, node)
            return steps

        return self._traversed(arranged)

    def _traversed(
        self, arranged: Callable[[Node], Sequence[Node | Leaf]]
    ) -> Iterator[Node | Leaf]:
        """Yield nodes and leaves, given the order of each node and its two children."""
        pending: list[tuple[Node | Leaf, bool]] = [(self._start(), False)]
        while pending:
            place, opened = pending.pop()
            if isinstance(place, Leaf) or opened:
                yield place
                continue
            pending += [(step, step is place) for step in reversed(arranged(place))]

    def visit(self, visitor: Visitor, order: Literal["pre", "in", "post"] = "pre") -> None:
        """Call ``visitor.node(node)`` or ``visitor.leaf(leaf)`` for each, in an order of `walk`."""
        if not (hasattr(visitor, "node") and hasattr(visitor, "leaf")):
            raise invalid_parameter(
                f"visitor must be an object with methods node() and leaf(), not {shown(visitor)}."
            )
        for place in self.walk(order):
            if isinstance(place, Leaf):
                visitor.leaf(place)
            else:
                visitor.node(place)

    def _start(self) -> Node | Leaf:
        return self.root or Leaf(self._tree, None, "minus")

    @property
    @abstractmethod
    def _tree(self) -> "PartitionTree":
        """The tree itself."""
