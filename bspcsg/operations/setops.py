"""Set operations on any number of solids or regions, and on two meshes given as arrays."""

import operator
from collections.abc import Callable, Iterable, Sequence
from functools import reduce
from typing import Any, TypeVar, overload

from .._core import CoreError, Tree
from .._types import FloatArray, IndexArray, SetOp
from ..errors import LimitError, core_errors, invalid_parameter
from ..geometry.arrays import is_masked
from ..mesh import interop
from ..solid.leaf import Pitches
from ..solid.ledger import counted
from ..solid.point_set import PointSet
from ..solid.program import Operator, program_of
from ..solid.solid import Solid, combine
from .block import Unfilled

#: The type of all operands of one operation: solids, regions or intervals.
Set = TypeVar("Set", bound=PointSet)


@overload
def union() -> Unfilled: ...
@overload
def union(*sets: Solid | Iterable[Solid]) -> Solid: ...
@overload
def union(*sets: Set | Iterable[Set]) -> Set: ...
def union(*sets: Any) -> Any:
    """Return the union of the operands; the empty set if there are none.

    Parameters
    ----------
    *sets : Solid or Region, or iterable of them
        All solids or all regions. Without any, ``with union() as u:`` opens a block
        (see `bspcsg.block`).

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.union(csg.cube(1).translate(i, 0, 0) for i in range(3)).volume
    3.0
    >>> csg.union(csg.Region.rectangle(3, 1), csg.Region.rectangle(1, 2)).area
    4.0
    """
    return _applied("union", sets) if sets else Unfilled(_united)


@overload
def intersection() -> Unfilled: ...
@overload
def intersection(*sets: Solid | Iterable[Solid]) -> Solid: ...
@overload
def intersection(*sets: Set | Iterable[Set]) -> Set: ...
def intersection(*sets: Any) -> Any:
    """Return the intersection of the operands; all of space if there are none.

    Parameters
    ----------
    *sets : Solid or Region, or iterable of them
        All solids or all regions. Without any, ``with intersection() as i:`` opens a block
        (see `bspcsg.block`).

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.intersection(csg.cube(2), csg.cube(2).translate(1, 1, 1)).volume
    1.0
    """
    return _applied("intersection", sets) if sets else Unfilled(_intersected, full=True)


@overload
def difference() -> Unfilled: ...
@overload
def difference(*sets: Solid | Iterable[Solid]) -> Solid: ...
@overload
def difference(*sets: Set | Iterable[Set]) -> Set: ...
def difference(*sets: Any) -> Any:
    """Return the first operand minus all other operands; the empty set without operands.

    Parameters
    ----------
    *sets : Solid or Region, or iterable of them
        All solids or all regions. Without any, ``with difference() as d:`` opens a block
        (see `bspcsg.block`).

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.difference(csg.cube(3), [csg.cube(1), csg.cube(1).translate(2, 0, 0)]).volume
    25.0
    >>> with csg.difference() as plate:
    ...     body = csg.cube((20, 20, 10))
    ...     hole = csg.prism(4, h=10, r=3).translate(10, 10, 0)
    >>> plate.solid.volume
    3820.0
    """
    return _applied("difference", sets) if sets else Unfilled(_less)


@overload
def xor() -> Unfilled: ...
@overload
def xor(*sets: Solid | Iterable[Solid]) -> Solid: ...
@overload
def xor(*sets: Set | Iterable[Set]) -> Set: ...
def xor(*sets: Any) -> Any:
    """Return the set of points inside an odd number of operands; the empty set without operands.

    Parameters
    ----------
    *sets : Solid or Region, or iterable of them
        All solids or all regions. Without any, ``with xor() as x:`` opens a block
        (see `bspcsg.block`).

    Examples
    --------
    >>> import bspcsg as csg
    >>> csg.xor(csg.cube(2), csg.cube(2)).is_empty
    True
    """
    return _applied("xor", sets) if sets else Unfilled(_odd)


def boolean(va: Any, fa: Any, vb: Any, fb: Any, op: SetOp) -> tuple[FloatArray, IndexArray]:
    """Return the result of a set operation on two meshes, given and returned as arrays.

    Parameters
    ----------
    va, vb : (n, 3) array_like of float
        Vertices of the two meshes, in model units.
    fa, fb : (m, 3) array_like of int
        Triangles as row numbers of `va` and `vb`, counter-clockwise seen from outside.
    op : {"union", "intersection", "difference", "xor"}
        The set operation.

    Returns
    -------
    vertices : (n, 3) float64
    faces : (m, 3) int64

    Raises
    ------
    InvalidMeshError
        If a mesh is not closed, as for `Solid`, or the operation is unknown.

    Examples
    --------
    >>> import bspcsg as csg
    >>> a, c = csg.cube(2).to_mesh(), csg.cube(2).translate(1, 1, 1).to_mesh()
    >>> vertices, faces = csg.boolean(*a, *c, "intersection")
    >>> vertices.shape, faces.shape
    ((8, 3), (12, 3))
    """
    program = program_of(op, 2)
    trees = [_tree(va, fa), _tree(vb, fb)]
    pitch = min(tree.pitch for tree in trees)
    try:
        operands = [Pitches().of(tree, pitch) for tree in trees]
    except LimitError:
        # The class Solid chooses a lattice that fits both meshes.
        mesh = OPERATIONS[op](Solid(va, fa), Solid(vb, fb)).to_mesh()
        return mesh.vertices.copy(), mesh.faces.copy()
    with core_errors():
        vertices, faces = Tree.evaluate(program, operands).to_mesh()
    return vertices, faces


#: The set operations by name; each takes any number of solids.
OPERATIONS: dict[str, Callable[..., Solid]] = {
    "union": union,
    "intersection": intersection,
    "difference": difference,
    "xor": xor,
}


def _tree(vertices: Any, faces: Any) -> Tree:
    if is_masked(vertices) or is_masked(faces):
        return _converted_tree(vertices, faces)
    try:
        return Tree.from_mesh(vertices, faces)
    except (TypeError, CoreError):
        # The arrays do not have the core's types; convert them, which is slower.
        return _converted_tree(vertices, faces)


def _converted_tree(vertices: Any, faces: Any) -> Tree:
    points = interop.points_array(vertices, "Vertices")
    triangles = interop.face_array(faces, points)
    with core_errors():
        return Tree.from_mesh(points, triangles)


@counted
def _united(solids: Sequence[Solid]) -> Solid:
    return _combined("or", solids) if solids else Solid.empty()


@counted
def _intersected(solids: Sequence[Solid]) -> Solid:
    return _combined("and", solids) if solids else Solid.full()


@counted
def _less(solids: Sequence[Solid]) -> Solid:
    operands = [*solids[:1], *(~other for other in solids[1:])]
    return _combined("and", operands) if operands else Solid.empty()


@counted
def _odd(solids: Sequence[Solid]) -> Solid:
    return reduce(operator.xor, solids) if solids else Solid.empty()


def _combined(op: Operator, operands: Sequence[Solid]) -> Solid:
    return operands[0] if len(operands) == 1 else combine(op, operands)


_OF_SOLIDS: dict[SetOp, Callable[[Sequence[Solid]], Solid]] = {
    "union": _united,
    "intersection": _intersected,
    "difference": _less,
    "xor": _odd,
}

_OF_TREES: dict[SetOp, Callable[[Any, Any], Any]] = {
    "union": operator.or_,
    "intersection": operator.and_,
    "xor": operator.xor,
}


def _applied(op: SetOp, entries: Iterable[Any]) -> Any:
    sets = _flat(entries)
    if all(isinstance(entry, Solid) for entry in sets):
        return _OF_SOLIDS[op](sets)
    for entry in sets:
        if not sets[0]._is_alike(entry):
            raise invalid_parameter(
                "All operands must be of the same kind and dimension, but they are"
                f" {type(sets[0]).__name__} and {type(entry).__name__}."
            )
    if op == "difference":
        return sets[0] - _balanced(operator.or_, sets[1:]) if sets[1:] else sets[0]
    return _balanced(_OF_TREES[op], sets)


def _balanced(merge: Callable[[Any, Any], Any], trees: Sequence[Any]) -> Any:
    """Merge a list to one value: merge pairs of neighbours, then of the results, and so on."""
    while len(trees) > 1:
        pairs = [trees[k : k + 2] for k in range(0, len(trees), 2)]
        trees = [merge(*pair) if len(pair) == 2 else pair[0] for pair in pairs]
    return trees[0]


def _flat(entries: Iterable[Any]) -> list[Any]:
    flat: list[Any] = []
    for entry in entries:
        is_list = isinstance(entry, Iterable) and not isinstance(entry, PointSet)
        flat.extend(entry if is_list else [entry])
    for entry in flat:
        if not isinstance(entry, PointSet):
            raise invalid_parameter(
                "The operands must be Solid objects or sets of one kind, such as Region, not"
                f" {type(entry).__name__}."
            )
    return flat
