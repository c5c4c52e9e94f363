"""Facts about meshes as the JSON values that records store."""

from typing import Any

import numpy as np

from ..._types import FloatArray
from ...errors import BspcsgError
from ...mesh.mesh import Mesh
from ...solid.solid import Solid
from ...verify.verdict import Facts
from ..record import FactsRecord


def facts_of(mesh: Mesh, facts: Facts | None = None, crossings: bool = False) -> FactsRecord:
    """Return the facts about a mesh as JSON values.

    Parameters
    ----------
    mesh : Mesh
    facts : Facts, optional
        The facts about the mesh, if they are already computed.
    crossings : bool
        True to test whether faces cross.
    """
    known = facts or Facts.of(mesh)
    return {
        "vertices": known.vertices,
        "triangles": known.triangles,
        "volume": known.volume,
        "area": known.area,
        "euler_number": known.euler_number,
        "components": known.components,
        "open_edges": known.open_edges,
        "centroid": _finite(mesh.centroid),
        "inertia": _finite(mesh.inertia),
        "self_intersections": _crossings(mesh) if crossings else None,
    }


def _finite(array: FloatArray) -> Any:
    """Return an array as nested lists, or None if a number is not finite."""
    return array.tolist() if np.isfinite(array).all() else None


def _crossings(mesh: Mesh) -> int | None:
    """Return 0 if it is certain that no two faces of a mesh cross, else None."""
    if len(mesh.faces) == 0:
        return 0
    try:
        solid = Solid(mesh.vertices, mesh.faces)
        solid.normalized()
    except BspcsgError:
        return None
    return 0 if solid.tree.simple is True else None
