"""Questions to another engine, and its answers."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..._types import IndexArray, ProgramLine
from ...mesh.mesh import Mesh
from ...mesh.weld import welded


class NoOpinionError(Exception):
    """An engine gave no usable answer; the message says why."""


@dataclass(frozen=True, eq=False)
class Question:
    """A question to an engine.

    Parameters
    ----------
    operation : str
    program : sequence of (str, list of int)
    operands : sequence of Mesh
        Reduced boundaries.
    ours : Mesh
    pitch : int
        Of the lattice of our result.
    timeout : float
        Seconds for one engine.
    snapped_by : float
        The most that coordinates of operands moved onto a lattice, possibly a coarser one.
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
    """The answer of an engine.

    Parameters
    ----------
    version : str
    mesh : Mesh
    shift : float
        The largest distance of a vertex from its true place due to the output format, in model
        units.
    complaint : str
        The engine's message on what failed although it gave an answer, or empty.
    """

    version: str
    mesh: Mesh
    shift: float = 0.0
    complaint: str = ""


def mesh_of(vertices: np.ndarray, faces: np.ndarray) -> Mesh:
    """Return a mesh from another program's output, with equal corners joined."""
    points = np.ascontiguousarray(vertices, dtype=np.float64).reshape(-1, 3)
    corners: IndexArray = np.ascontiguousarray(faces, dtype=np.int64).reshape(-1, 3)
    if len(corners):
        points, same = welded(points)
        corners = same[corners]
    return Mesh(points, corners, np.zeros((len(corners), 2), dtype=np.int64))
