"""Queries of sets of the plane: outlines, areas, sections by lines, and a common lattice."""

from collections.abc import Sequence
from contextlib import suppress
from fractions import Fraction
from typing import Any

import numpy as np

from ..._core import ObjectTree as CoreTree
from ..._types import FloatArray, Vector
from ...errors import LimitError, core_errors, invalid_parameter
from ...geometry.polygon import convex_corners
from ...parameters import number, shown
from .loops import Outline, loop_segments
from .objects import ObjectTree
from .pieces import Pieces


def outlines_of(tree: CoreTree) -> tuple[Outline, ...]:
    """Return the boundary of a set of the plane as nested simple loops (see `Region.outlines`)."""
    with core_errors():
        points, offsets, parents = tree.outlines()
    points.flags.writeable = False
    loops = np.split(points, offsets[1:-1]) if len(parents) else []
    nested = zip(loops, parents.tolist(), strict=True)
    return tuple(Outline(loop, parent) for loop, parent in nested)


def exact_outlines(tree: CoreTree) -> list[list[tuple[Fraction, Fraction]]]:
    """Return the outlines of a set of the plane as lists of exact corners, in model units."""
    with core_errors():
        loops = tree.exact_outlines()
    return [[(Fraction(*x), Fraction(*y)) for x, y in loop] for loop in loops]


def rounded_area(tree: CoreTree) -> float:
    """Return the area of a set of the plane in square model units, rounded once."""
    with core_errors():
        low, high = (n / d for n, d in tree.area_bounds())
        return low if low == high else float(Fraction(*tree.measure()))


def exact_centroid(tree: CoreTree) -> tuple[Fraction, Fraction] | None:
    """Return the exact centre of area of a set of the plane, in model units; None if empty."""
    with core_errors():
        area, x, y = (Fraction(*ratio) for ratio in tree.moments())
    return None if area == 0 else (x / area, y / area)


def cast_line(tree: CoreTree, origin: Vector, direction: Vector) -> FloatArray:
    """Return the segments of a line in a set of the plane as pairs of t (see `Region.cast`)."""
    start, along = vector2(origin, "origin"), vector2(direction, "direction")
    if not np.any(along):
        raise invalid_parameter("direction must not be the zero vector.")
    with core_errors():
        points, _, _ = tree.cast(list(start), list(along))
    axis = int(np.abs(along).argmax())
    t = (points[:, axis] - start[axis]) / along[axis]
    # Points beyond this coordinate represent points at infinity.
    border = (2**53 - 2) * 10.0**tree.pitch
    t[np.abs(points).max(axis=1) > border] *= np.inf
    return np.asarray(t.reshape(-1, 2))


def convex_parts(cells: Pieces) -> list[FloatArray]:
    """Return the cells of a set of the plane as convex polygons, given the cells' edges."""
    parts: list[list[FloatArray]] = []
    for face, owner in enumerate(cells.owner.tolist()):
        if owner == len(parts):
            parts.append([])
        parts[owner].append(cells[face])
    return [convex_corners(faces) for faces in parts]


def on_one_lattice(trees: Sequence[ObjectTree]) -> list[CoreTree]:
    """Return sets of the plane on the finest lattice that contains all of their corners.

    Raises
    ------
    LimitError
        If there is no such lattice.
    """
    # The empty set and the plane fit on any lattice.
    pitches = {tree.pitch for tree in trees if not (tree.is_empty or tree.is_full)}
    finest, coarsest = min(pitches, default=trees[0].pitch), max(pitches, default=trees[0].pitch)
    for pitch in range(finest, coarsest):
        with suppress(LimitError):
            return [_on_lattice(tree, pitch) for tree in trees]
    return [_on_lattice(tree, coarsest) for tree in trees]


def _on_lattice(tree: ObjectTree, pitch: int) -> CoreTree:
    """Return a set on another lattice, which if coarser must contain all corners of the set."""
    if pitch <= tree.pitch or tree.is_empty or tree.is_full:
        return tree._refined(pitch)
    if not tree.is_bounded and (~tree).is_bounded:
        return _on_lattice(~tree, pitch).complement()
    with core_errors():
        loops = tree._tree.exact_outlines() if tree.is_bounded else None
    step = Fraction(10) ** pitch
    if loops is None or any(Fraction(*x) % step for loop in loops for p in loop for x in p):
        message = (
            "One region extends beyond the 2^53 steps of the fine lattice that the corners of"
            f" another region need. Round those corners to multiples of {float(step):g}, or"
            " cut off distant parts."
        )
        raise LimitError(message, "too_large")
    corners = [np.array([[n / d for n, d in point] for point in loop]) for loop in loops]
    with core_errors():
        return CoreTree.region(loop_segments(corners).reshape(-1, 4), pitch, "positive")


def vector2(value: Any, name: str) -> tuple[float, float]:
    """Return a vector of the plane as two floats, or raise an error that names the parameter."""
    try:
        x, y = value
    except (TypeError, ValueError) as error:
        raise invalid_parameter(f"{name} must be two numbers, not {shown(value)}.") from error
    return number(x, name), number(y, name)
