"""Rounding of a mesh's coordinates to fewer digits."""

from dataclasses import replace
from typing import TypeVar

import numpy as np

from ..errors import Finding
from ..mesh.mesh import Mesh
from .raw import RawMesh

_Kind = TypeVar("_Kind", bound=Mesh | RawMesh)


def rounded(mesh: _Kind, digits: int) -> tuple[_Kind, tuple[Finding, ...]]:
    """Round coordinates to significant digits; return the mesh, and a finding on the change.

    If no coordinate changes, there is no finding. Faces that are closer to each other than the
    rounding may cross, and triangles thinner than the rounding may lose their area.

    Parameters
    ----------
    mesh : Mesh or RawMesh
    digits : int
        From 1 to 17.
    """
    texts = [f"{value:.{digits - 1}e}" for value in mesh.vertices.ravel().tolist()]
    vertices = np.array(texts, dtype=np.float64).reshape(-1, 3)
    shift = float(np.abs(vertices - mesh.vertices).max(initial=0))
    if shift == 0:
        return mesh, ()
    message = f"rounding to {digits} significant digits changed coordinates by up to {shift:.3g}"
    return replace(mesh, vertices=vertices), (Finding("rounded", "note", message, (), 1),)
