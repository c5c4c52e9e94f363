"""Read the operands of a case and place them, as solids."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ..._types import FloatArray, MeshArrays
from ...errors import InvalidMeshError, not_none
from ...formats.files import read
from ...solid.solid import Solid
from .case import Case, Operand
from .poses import OF_THE_FIRST, placed, pose_matrix, shuffled

#: The largest number of files that a worker keeps in memory, since consecutive cases use the same
#: pair.
_MAX_FILES_KEPT = 8


def operands_of(case: Case) -> tuple[list[Solid], list[FloatArray | None]]:
    """Return the placed operands of a case as solids, and the rows of the affine maps, or None.

    Raises
    ------
    FormatError
        If a file cannot be read.
    InvalidMeshError, LimitError
        If a mesh is not a solid; the message has the name of its file.
    """
    meshes = [_mesh_of(operand) for operand in case.operands]
    rows = [_given_pose(operand) for operand in case.operands]
    if case.pose is not None:
        meshes[1], rows[1] = _in_pose(case, meshes)
    elif any(pose is not None for pose in rows):
        meshes = [
            mesh if pose is None else placed(mesh, pose)
            for mesh, pose in zip(meshes, rows, strict=True)
        ]
    solids = [_solid(mesh, operand) for mesh, operand in zip(meshes, case.operands, strict=True)]
    return solids, rows


def _in_pose(case: Case, meshes: Sequence[MeshArrays]) -> tuple[MeshArrays, FloatArray]:
    """Return the second mesh of a case in its pose, and the rows of the pose."""
    pose = not_none(case.pose, "the pose")
    seed, number = not_none(case.seed, "the seed"), not_none(case.number, "the number")
    first, second = meshes
    second = first if pose in OF_THE_FIRST else second
    rows = pose_matrix(pose, _used_vertices(first), _used_vertices(second), seed, number)
    moved = placed(second, rows)
    return shuffled(moved, seed, number) if pose == "same" else moved, rows


def _used_vertices(mesh: MeshArrays) -> FloatArray:
    """Return the vertices that belong to a face, (n, 3)."""
    used: FloatArray = mesh[0][np.unique(mesh[1])]
    if len(used) == 0:
        raise InvalidMeshError(
            "The operand has no faces, so it cannot be placed in a pose; choose a mesh with faces.",
            "empty_mesh",
        )
    return used


def _given_pose(operand: Operand) -> FloatArray | None:
    return None if operand.pose is None else np.array(operand.pose, dtype=np.float64)


def _mesh_of(operand: Operand) -> MeshArrays:
    if operand.file is None:
        given: dict[str, Any] = operand.mesh or {}
        vertices = np.array(given["vertices"], dtype=np.float64).reshape(-1, 3)
        return vertices, np.array(given["faces"], dtype=np.int64).reshape(-1, 3)
    return _read(operand.file, operand.sha256)


@lru_cache(maxsize=_MAX_FILES_KEPT)
def _read(file: str, sha256: str) -> MeshArrays:
    del sha256  # only a key of the cache, for files that change
    raw = read(file)
    return raw.vertices, raw.faces


def _solid(mesh: MeshArrays, operand: Operand) -> Solid:
    try:
        return Solid(*mesh)
    except InvalidMeshError as error:
        name = operand.file or f"operand {operand.name}"
        raise InvalidMeshError(f"{name}: {error.message}", error.code, error.where) from error
