"""The oracle: manifold3d carries out the same program of set operations.

manifold3d has no complements, so every value here is a bounded solid with a flag that is true for
its complement; De Morgan's laws reduce all operations to operations on bounded solids.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from .._types import ProgramLine
from ..mesh import interop
from ..mesh.mesh import Mesh
from ..solid.program import Algebra

if TYPE_CHECKING:
    import manifold3d


class OracleRefusedError(Exception):
    """manifold3d cannot carry out the program: the result is unbounded or an operand refused."""


class OracleFailedError(Exception):
    """manifold3d carried out the program but raised an error or gave an invalid result."""


@dataclass(frozen=True, eq=False)
class Answer:
    """The result of manifold3d for a program.

    Parameters
    ----------
    mesh : Mesh
        The resulting mesh; its `source` is zero.
    tolerance : float
        The largest tolerance of manifold3d over operands and result: points within this distance,
        in model units, may be merged.
    """

    mesh: Mesh
    tolerance: float


def versioned_name() -> str:
    """Return the text "manifold3d" with its version."""
    return f"manifold3d {_version()}"


@cache
def _version() -> str:
    """Return manifold3d's version from the name of its metadata folder, which is fastest."""
    import manifold3d

    found = list(Path(manifold3d.__file__).parent.glob("manifold3d-*.dist-info"))
    if len(found) == 1:
        return found[0].stem.partition("-")[2]
    from importlib.metadata import version

    return version("manifold3d")


def status_of(mesh: Mesh) -> str:
    """Return manifold3d's status of a mesh in double precision; ``"NoError"`` means accepted."""
    return "NoError" if len(mesh.faces) == 0 else str(interop.to_manifold(mesh).status().name)


def manifold_result(
    program: Sequence[ProgramLine], operands: Iterable[Mesh], inside: Mesh | None = None
) -> Answer:
    """Return manifold3d's result of a program of set operations.

    Parameters
    ----------
    program : sequence of (str, list of int)
        The lines (operation, operands), in the form that the core takes.
    operands : iterable of Mesh
    inside : Mesh, optional
        A mesh; the result is intersected with it.

    Raises
    ------
    OracleRefusedError
        If an operand is refused, or the result is unbounded.
    OracleFailedError
        If an operation raises, or its result is invalid.
    """
    result, tolerance = _result_of(program, operands, inside)
    return Answer(_mesh_of(result), tolerance)


def _result_of(
    program: Sequence[ProgramLine], operands: Iterable[Mesh], inside: Mesh | None
) -> "tuple[manifold3d.Manifold, float]":
    """Return manifold3d's resulting solid and the largest tolerance of operands and result."""
    solids = [_taken(number, operand) for number, operand in enumerate(operands, 1)]
    limit = None if inside is None else interop.to_manifold(inside)
    # An empty solid's tolerance is negative.
    tolerance = max([0.0, *(solid.get_tolerance() for solid in solids)])
    try:
        result, outside = _carried_out(program, solids)
        if limit is not None:
            result, outside = _and([(result, outside), (limit, False)])
        status = result.status().name
    except (RuntimeError, MemoryError, ValueError) as error:
        raise OracleFailedError(f"manifold3d raised {type(error).__name__}: {error}") from error
    if outside:
        raise OracleRefusedError(
            "the result is unbounded, and manifold3d cannot represent unbounded solids"
        )
    if status != "NoError":
        raise OracleFailedError(f"manifold3d's result has the status {status}")
    return result, max(tolerance, result.get_tolerance())


_Value: TypeAlias = "tuple[manifold3d.Manifold, bool]"


def _taken(number: int, operand: Mesh) -> "manifold3d.Manifold":
    if len(operand.faces) == 0:
        return _empty()
    solid = interop.to_manifold(operand)
    status = solid.status().name
    if status != "NoError":
        raise OracleRefusedError(f"manifold3d refuses operand {number}: {status}")
    # manifold3d accepts inverted meshes silently, but its results for them are meaningless.
    if solid.volume() <= 0 < operand.volume:
        raise OracleRefusedError(f"operand {number} has no positive volume in manifold3d")
    return solid


def _empty() -> "manifold3d.Manifold":
    import manifold3d

    return manifold3d.Manifold()


def _carried_out(program: Sequence[ProgramLine], solids: list["manifold3d.Manifold"]) -> _Value:
    return _MANIFOLDS.evaluate(program, [(solid, False) for solid in solids])


def _not(value: _Value) -> _Value:
    solid, outside = value
    return solid, not outside


def _and(values: Sequence[_Value]) -> _Value:
    bounded = [solid for solid, outside in values if not outside]
    holes = [solid for solid, outside in values if outside]
    if not bounded:
        return _batch(holes, "Add"), True
    common = _batch(bounded, "Intersect")
    return (common - _batch(holes, "Add") if holes else common), False


def _or(values: Sequence[_Value]) -> _Value:
    return _not(_and([_not(value) for value in values]))


def _xor(values: Sequence[_Value]) -> _Value:
    (a, a_outside), (b, b_outside) = values
    return (a - b) + (b - a), a_outside != b_outside


_MANIFOLDS: Algebra[_Value] = Algebra(_or, _and, _xor, _not)


def _batch(solids: list["manifold3d.Manifold"], operation: str) -> "manifold3d.Manifold":
    import manifold3d

    if len(solids) == 1:
        return solids[0]
    return manifold3d.Manifold.batch_boolean(solids, getattr(manifold3d.OpType, operation))


def _mesh_of(solid: Any) -> Mesh:
    found = solid.to_mesh64()
    vertices = np.array(found.vert_properties[:, :3], dtype=np.float64, order="C")
    faces = np.array(found.tri_verts, dtype=np.int64, order="C").reshape(-1, 3)
    return Mesh(vertices.reshape(-1, 3), faces, np.zeros((len(faces), 2), dtype=np.int64))
