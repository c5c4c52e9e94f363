"""The `repr` of a solid, which shows only known facts and evaluates nothing."""

from typing import Any

import numpy as np

from ..errors import LimitError
from ..geometry import transform
from ..geometry.chain import FactorChain
from ..mesh.mesh import Mesh
from .expression import ExpressionNode, Pending, make_plan
from .leaf import ConstantLeaf, MeshLeaf, PlaneLeaf


def describe(node: ExpressionNode, factors: FactorChain, mesh: Mesh | None) -> str:
    """Return the text of the `repr` of an expression under a transform, with its mesh if known."""
    content = node.content
    moved = ", transformed" if factors else ""
    if mesh is not None:
        return _size(len(mesh.faces), mesh.bounds)
    if isinstance(content, Pending):
        count = len(make_plan(node).operands)
        return f"pending: {count} operand{'' if count == 1 else 's'}{moved}"
    if isinstance(content, MeshLeaf):
        vertices, faces = content.arrays()
        try:
            points = transform.apply(factors.product, vertices) if factors else vertices
        except LimitError:
            return f"{len(faces)} triangles{moved} beyond all doubles"
        return _size(len(faces), np.array([points.min(axis=0), points.max(axis=0)]))
    if isinstance(content, PlaneLeaf):
        return "half-space" + moved
    if isinstance(content, ConstantLeaf):
        return "all of space" if content.full else "empty"
    # The bounds are unknown until a mesh is made.
    return ("empty" if content.result.is_empty else "evaluated, without a mesh") + moved


def _size(faces: int, bounds: Any) -> str:
    return "empty" if bounds is None else f"{faces} triangles, bounds {_box(bounds)}"


def _box(bounds: Any) -> str:
    low, high = ("(" + ", ".join(f"{x + 0.0:.6g}" for x in corner) + ")" for corner in bounds)
    return f"{low} to {high}"
