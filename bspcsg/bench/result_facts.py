"""The facts about a result that are compared and shown, with bounds of the rounding."""

from dataclasses import dataclass
from math import log2

import numpy as np

from .._types import FloatArray, IndexArray, MeshArrays

#: The unit roundoff of doubles.
_ROUNDOFF = 2.0**-53

#: The number of rounded operations in one term of the volume: three differences, five of the
#: product.
_TERM = 8

#: The number of rounded additions in a block: numpy sums blocks of 128 in eight strands, then pairs
#: of blocks.
_BLOCK_SUM = 128 // 8 + 3


@dataclass(frozen=True)
class Volume:
    """A volume, and a bound of its rounding error."""

    value: float
    error: float


@dataclass(frozen=True)
class ResultFacts:
    """The numbers of triangles and open edges, the Euler number and the volume of a result.

    Parameters
    ----------
    triangles, euler_number, open_edges : int
        The Euler number counts vertices by index; open edges are directed edges without an opposite
        edge.
    volume : float
    volume_error : float
        A bound of the rounding error of `volume`.
    """

    triangles: int
    euler_number: int
    open_edges: int
    volume: float
    volume_error: float


def facts_of(mesh: MeshArrays) -> ResultFacts:
    """Return the facts about a mesh."""
    faces = np.asarray(mesh[1], dtype=np.int64)
    volume = mesh_volume((mesh[0], faces))
    return ResultFacts(
        triangles=len(faces),
        euler_number=len(np.unique(faces)) - len(faces) // 2,
        open_edges=_open_edges(faces, len(mesh[0])),
        volume=volume.value,
        volume_error=volume.error,
    )


def mesh_volume(mesh: MeshArrays) -> Volume:
    """Return the signed volume that a mesh bounds, with a bound of its rounding error."""
    vertices, faces = np.asarray(mesh[0], dtype=np.float64), np.asarray(mesh[1], dtype=np.int64)
    if len(faces) == 0:
        return Volume(0.0, 0.0)
    # Relative to the centre of the bounding box, so that terms are small.
    corners = (vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2)[faces]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    terms = np.einsum("ij,ij->i", np.cross(a, b), c) / 6
    # A bound of the absolute values of the six products of each term.
    sizes = np.abs(corners).sum(axis=2).prod(axis=1) / 6
    steps = _TERM + _BLOCK_SUM + max(log2(len(faces) / 128), 0)
    return Volume(float(terms.sum()), float(steps * _ROUNDOFF * sizes.sum()))


def area(mesh: MeshArrays) -> float:
    """Return the area of a mesh."""
    corners = mesh[0][mesh[1]]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return float(np.linalg.norm(across, axis=1).sum() / 2)


def size_of(vertices: FloatArray) -> float:
    """Return the largest absolute value of a coordinate."""
    return float(np.abs(vertices).max(initial=0.0))


def _open_edges(faces: IndexArray, count: int) -> int:
    """Return the number of directed edges without an opposite edge of their own."""
    starts, ends = faces[:, [0, 1, 2]].ravel(), faces[:, [1, 2, 0]].ravel()
    forward, back = np.sort(starts * count + ends), np.sort(ends * count + starts)
    return int((forward != back).sum())
