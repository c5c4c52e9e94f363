"""Evaluation of the transform nodes multmatrix and resize."""

import math
from collections.abc import Sequence

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...errors import invalid_parameter
from ...geometry.transform import determinant_sign
from ...solid.solid import Solid
from ..making.polish import polished_matrix
from ..syntax.arguments import MAX_NUMBER, Arguments, is_number
from ..syntax.tree import Node
from .registry import Evaluation, Geometry, node
from .set_operations import union_of
from .signature import Signature

#: A matrix with an entry above this may move a solid outside the range of all lattices.
_MAX_SAFE_ENTRY = 1e15


@node("multmatrix", takes=Signature(("m",)), makes_corners=False)
def multmatrix(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Transform the children by a matrix; with a singular or infinite one, omit them and warn."""
    body = union_of(owner, children, run)
    arguments = run.arguments(owner)
    matrix = _matrix(arguments)
    if matrix is None:
        run.warn(
            owner, "its matrix has an entry that is not a finite number; this node is left out"
        )
        return None
    return _moved(owner, body, polished_matrix(matrix) if run.polish else matrix, run)


def _moved(owner: Node, body: Geometry, matrix: FloatArray, run: Evaluation) -> Geometry:
    if body is None or np.array_equal(matrix, np.eye(4)):
        return body
    if determinant_sign(_flat_map(matrix) if isinstance(body, Region) else matrix) == 0:
        run.warn(
            owner,
            "its matrix has determinant 0 and would flatten its children; this node is left out",
        )
        return None
    if isinstance(body, Region):
        return body.transform(matrix[:2, [0, 1, 3]])
    moved = body.transform(matrix)
    if np.abs(matrix).max() > _MAX_SAFE_ENTRY:
        moved.tree  # noqa: B018  builds it, so that errors name this node
    return moved


def _flat_map(matrix: FloatArray) -> FloatArray:
    """Return a (4, 4) matrix that acts on x and y as the given one and leaves z unchanged."""
    flat = np.eye(4)
    flat[:2, :2] = matrix[:2, :2]
    return flat


def _matrix(arguments: Arguments) -> FloatArray | None:
    """Return the (4, 4) matrix of a node, divided by its last entry; None if it is not finite."""
    value = arguments.value("m")
    rows = value if isinstance(value, tuple) else ()
    if not 3 <= len(rows) <= 4 or not all(map(_is_row, rows)):
        raise arguments.error("its argument must be a matrix of 4 rows of 4 numbers.")
    matrix = np.eye(4)
    matrix[: len(rows)] = rows
    if not np.isfinite(matrix).all():
        return None
    if matrix[3, :3].any() or matrix[3, 3] == 0:
        raise arguments.error("the last row of its matrix must be 0, 0, 0, 1.")
    with np.errstate(over="ignore"):
        matrix /= matrix[3, 3]
    if np.abs(matrix).max() > MAX_NUMBER:
        raise arguments.error("its matrix has an entry beyond ±1e100.")
    return matrix


def _is_row(row: object) -> bool:
    return isinstance(row, tuple) and len(row) == 4 and all(map(is_number, row))


@node("resize", takes=Signature(("newsize", "auto", "convexity")), makes_corners=False)
def resize(owner: Node, children: list[Geometry], run: Evaluation) -> Geometry:
    """Scale the children to new lengths along the axes.

    A length of 0 keeps the present one, or with `auto` scales that axis like the axis of the
    largest new length. Missing lengths are 0; in the plane only x and y matter.
    """
    arguments = run.arguments(owner)
    body = union_of(owner, children, run)
    sizes = arguments.padded("newsize", 3)
    bounds = None if body is None else _bounds(body)
    if body is None or bounds is None:
        return body
    old = np.ptp(bounds, axis=0).tolist()
    factors = _factors(sizes[: len(old)], _auto(arguments)[: len(old)], old)
    return _moved(owner, body, np.diag([*factors, 1.0, 1.0][:4]), run)


def _auto(arguments: Arguments) -> list[bool]:
    value = arguments.value("auto")
    flags = value if isinstance(value, tuple) else (value,) * 3
    return [bool(flag) for flag in (*flags, False, False, False)[:3]]


def _bounds(body: Solid | Region) -> FloatArray | None:
    if isinstance(body, Region):
        return body.bounds
    return None if body.is_empty else body.normalized().to_mesh().bounds


def _factors(sizes: Sequence[float], auto: Sequence[bool], old: Sequence[float]) -> list[float]:
    factors = [
        new / length if new > 0 and length > 0 else 1.0
        for new, length in zip(sizes, old, strict=True)
    ]
    leader = factors[int(np.argmax(sizes))]
    chosen = zip(sizes, auto, factors, strict=True)
    result = [leader if new == 0 and follows else own for new, follows, own in chosen]
    if not all(map(math.isfinite, result)):
        raise invalid_parameter(
            "the new size is too large a multiple of the old size for doubles; choose a smaller"
            " new size."
        )
    return result
