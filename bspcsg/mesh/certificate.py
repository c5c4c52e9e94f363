"""`Certificate`: the result of an exact check of a mesh in its own precision.

The check takes arrays only, and its arithmetic is exact.
"""

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from .._core import mesh_counts, mesh_faults
from .._types import FloatArray, IndexArray
from ..errors import core_errors

#: The floating-point precision of coordinates.
Precision: TypeAlias = Literal["double", "single"]


@dataclass(frozen=True)
class Certificate:
    """The result of an exact check of a mesh with its coordinates unrounded.

    Parameters
    ----------
    precision : {"double", "single"}
        Single if single precision represents all coordinates exactly, else double.
    triangles : int
        The number of checked triangles.
    open_edges : int
        The number of directed edges that do not have exactly one opposite edge, by vertex index.
    crossings : tuple of (int, int)
        Pairs of triangles that cross or overlap. Surfaces may touch. At an edge of more than two
        triangles, surfaces count as crossing only if they cross for every pairing of the triangles.
    flat : tuple of int
        Numbers of the triangles without area.

    Examples
    --------
    >>> import bspcsg as csg
    >>> proof = (csg.cube(2) - csg.cube(1)).to_mesh().certificate
    >>> proof.ok, proof.triangles, proof.crossings
    (True, 24, ())
    """

    precision: Precision
    triangles: int
    open_edges: int
    crossings: tuple[tuple[int, int], ...]
    flat: tuple[int, ...]

    @property
    def ok(self) -> bool:
        """True if the mesh is closed, crosses itself nowhere, and each triangle has area."""
        return not (self.open_edges or self.crossings or self.flat)


def certify(vertices: FloatArray, faces: IndexArray) -> Certificate:
    """Check exactly whether a mesh is closed, crosses itself, or has triangles without area.

    Parameters
    ----------
    vertices : (n, 3) float64
    faces : (m, 3) int64
        Indices of `vertices`.

    Raises
    ------
    InvalidMeshError
        If a coordinate is not finite or an index is out of range.

    Notes
    -----
    The time grows with the number of triangles plus the number of pairs whose boxes overlap.
    """
    with core_errors():
        found = mesh_faults(vertices, faces)
        _, _, open_edges, _ = mesh_counts(faces, len(vertices))
    with np.errstate(over="ignore"):
        is_single = bool((vertices.astype(np.float32) == vertices).all())
    return Certificate(
        "single" if is_single else "double",
        len(faces),
        open_edges,
        tuple((int(t), int(u)) for t, u in found["crossings"]),
        tuple(int(t) for t in found["flat"]),
    )
