"""Traversals of a partition tree: in painter's order, by distance, pre-, in- and postorder."""

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ..._types import FloatArray, IndexArray, SideArray
from ...errors import core_errors, invalid_parameter
from ...geometry.arrays import doubles
from ...parameters import one_of, shown
from .fragments import Fragments, concatenated_ranges
from .node import Leaf, Node, Visitor

if TYPE_CHECKING:
    from .tree import PartitionTree


def back_to_front(tree: "PartitionTree", eye: Any, direction: Any) -> Fragments:
    """Return the tree's fragments in an order in which none hides a later one: farthest first."""
    return tree.fragments.take(_painted(tree, eye, direction))


def front_to_back(tree: "PartitionTree", eye: Any, direction: Any) -> Fragments:
    """Return the tree's fragments, nearest first: no fragment hides an earlier one."""
    return tree.fragments.take(_painted(tree, eye, direction)[::-1])


def _painted(tree: "PartitionTree", eye: Any, direction: Any) -> IndexArray:
    place, at_infinity = _viewpoint(tree, eye, direction)
    with core_errors():
        order = tree.core.order(place, at_infinity)
    arrays = tree.arrays
    return concatenated_ranges(arrays["start"][order], arrays["end"][order])


def _viewpoint(tree: "PartitionTree", eye: Any, direction: Any) -> tuple[list[float], bool]:
    if (eye is None) == (direction is None):
        raise invalid_parameter("Give exactly one of eye and direction.")
    at_infinity = eye is None
    name = "direction" if at_infinity else "eye"
    refusal = invalid_parameter(f"The {name} must be {tree.dimension} numbers.")
    given = np.atleast_1d(doubles(direction if at_infinity else eye, refusal))
    if given.shape != (tree.dimension,):
        message = f"The {name} must have {tree.dimension} coordinates, not {given.shape}."
        raise invalid_parameter(message)
    # The eye of a parallel projection is infinitely far away, opposite to the direction of view.
    full: FloatArray = np.zeros(3)
    full[: tree.dimension] = -given if at_infinity else given
    return full.tolist(), at_infinity


def near_to_far(tree: "PartitionTree", eye: Any, direction: Any) -> Iterator[Node | Leaf]:
    """Yield nodes and leaves by distance: child on the eye's side, node, other child."""
    return _by_distance(tree, _sides(tree, eye, direction))


def far_to_near(tree: "PartitionTree", eye: Any, direction: Any) -> Iterator[Node | Leaf]:
    """Yield nodes and leaves from far to near: far child, node, child on the eye's side."""
    return _by_distance(tree, -_sides(tree, eye, direction), ties_minus_first=False)


def _sides(tree: "PartitionTree", eye: Any, direction: Any) -> SideArray:
    place, at_infinity = _viewpoint(tree, eye, direction)
    with core_errors():
        return tree.core.sides(place, at_infinity)


def _by_distance(
    tree: "PartitionTree", sides: Any, ties_minus_first: bool = True
) -> Iterator[Node | Leaf]:
    def arranged(node: Node) -> Sequence[Node | Leaf]:
        side = sides[node.index]
        minus, plus = node.children
        first_minus = side < 0 or (side == 0 and ties_minus_first)
        return (minus, node, plus) if first_minus else (plus, node, minus)

    return _traversed(tree, arranged)


def walk(tree: "PartitionTree", order: Literal["pre", "in", "post"]) -> Iterator[Node | Leaf]:
    """Yield all nodes and leaves, minus child first; "in": a node between its two children."""
    orders = ("pre", "in", "post")
    place = orders.index(one_of(orders, order, "order"))

    def arranged(node: Node) -> Sequence[Node | Leaf]:
        steps: list[Node | Leaf] = list(node.children)
        steps.insert(place, node)
        return steps

    return _traversed(tree, arranged)


def _traversed(
    tree: "PartitionTree", arranged: Callable[[Node], Sequence[Node | Leaf]]
) -> Iterator[Node | Leaf]:
    """Yield all nodes and leaves; `arranged` returns the order of a node and its two children."""
    pending: list[tuple[Node | Leaf, bool]] = [(tree.root or Leaf(tree, None, "minus"), False)]
    while pending:
        place, opened = pending.pop()
        if isinstance(place, Leaf) or opened:
            yield place
            continue
        pending += [(step, step is place) for step in reversed(arranged(place))]


def visit(tree: "PartitionTree", visitor: Visitor, order: Literal["pre", "in", "post"]) -> None:
    """Call ``visitor.node(node)`` or ``visitor.leaf(leaf)`` for each, in the order given."""
    if not (hasattr(visitor, "node") and hasattr(visitor, "leaf")):
        raise invalid_parameter(
            f"visitor must be an object with methods node() and leaf(), not {shown(visitor)}."
        )
    for place in walk(tree, order):
        if isinstance(place, Leaf):
            visitor.leaf(place)
        else:
            visitor.node(place)
