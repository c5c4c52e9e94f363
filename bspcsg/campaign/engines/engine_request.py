"""`EngineRequest` and `EngineAnswer`: an operation for another engine, and the engine's result."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..._types import IndexArray, ProgramLine
from ...mesh.mesh import Mesh
from ...mesh.weld import welded


class NoOpinionError(Exception):
    """An engine gave no usable result; the message has the reason."""


@dataclass(frozen=True, eq=False)
class EngineRequest:
    """An operation on operands for another engine, with our result.

    Parameters
    ----------
    operation : str
    program : sequence of (str, list of int)
    operands : sequence of Mesh
        The reduced boundaries of the operands.
    ours : Mesh
    pitch : int
        The pitch of the lattice of our result.
    timeout : float
        The time limit of one engine, in seconds.
    snapped_by : float
        The largest distance by which snapping to a lattice moved coordinates of operands.
    """

    operation: str
    program: Sequence[ProgramLine]
    operands: Sequence[Mesh]
    ours: Mesh
    pitch: int
    timeout: float
    snapped_by: float = 0.0


@dataclass(frozen=True, eq=False)
class EngineAnswer:
    """The result of an engine for an operation.

    Parameters
    ----------
    version : str
    mesh : Mesh
    shift : float
        The largest distance by which the output format may have moved a vertex, in model units.
    complaint : str
        The engine's error message if a part failed although it gave a result, or empty.
    """

    version: str
    mesh: Mesh
    shift: float = 0.0
    complaint: str = ""


def mesh_of(vertices: np.ndarray, faces: np.ndarray) -> Mesh:
    """Return another program's vertices and faces as a `Mesh`, with equal vertices joined."""
    points = np.ascontiguousarray(vertices, dtype=np.float64).reshape(-1, 3)
    corners: IndexArray = np.ascontiguousarray(faces, dtype=np.int64).reshape(-1, 3)
    if len(corners):
        points, same = welded(points)
        corners = same[corners]
    return Mesh(points, corners, np.zeros((len(corners), 2), dtype=np.int64))
