"""What single precision changes about a mesh: binary STL and GLB hold no more."""

import numpy as np

from .._types import FloatArray
from ..errors import Finding
from ..mesh import Mesh
from ..weld import welded
from .raw import RawMesh


def losses(mesh: Mesh | RawMesh, format_name: str) -> tuple[Finding, ...]:
    """Return what single precision would change about a mesh.

    Parameters
    ----------
    mesh : Mesh or RawMesh
    format_name : str
        What to call the format in the message.

    Raises
    ------
    OverflowError
        If a coordinate is beyond single precision.
    """
    with np.errstate(over="ignore"):
        rounded = mesh.vertices.astype(np.float32).astype(np.float64)
    if not np.isfinite(rounded).all():
        raise OverflowError
    shift = float(np.abs(rounded - mesh.vertices).max(initial=0.0))
    if shift == 0:
        return ()
    message = (
        f"{format_name} holds single precision: coordinates moved by up to {shift:.2g}."
        " PLY, OBJ, OFF, 3MF and ASCII STL keep every digit."
    )
    return Finding("single_precision", "note", message, (), 1), *_merged(mesh, rounded)


def _merged(mesh: Mesh | RawMesh, rounded: FloatArray) -> tuple[Finding, ...]:
    before, after = len(welded(mesh.vertices)[0]), welded(rounded)[1]
    lost = before - len(np.unique(after))
    if not lost:
        return ()
    faces = after[mesh.faces]
    flat = (faces == np.roll(faces, 1, axis=1)).any(axis=1)
    message = (
        f"single precision merges {lost} vertices with others and flattens {int(flat.sum())}"
        " triangles; write PLY, OBJ, OFF or 3MF to keep the mesh as it is."
    )
    where = tuple(np.flatnonzero(flat)[:8].tolist())
    return (Finding("merged_by_rounding", "warning", message, where, lost),)
