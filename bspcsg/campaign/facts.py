"""Facts about meshes, as records hold them."""

import math
from fractions import Fraction

import numpy as np

from ..errors import BspcsgError
from ..mesh import Mesh
from ..solid import Solid
from ..verdict import Facts
from .record import FactsRecord


def facts_of(mesh: Mesh, facts: Facts | None = None, crossings: bool = False) -> FactsRecord:
    """Return the facts of a mesh.

    Parameters
    ----------
    mesh : Mesh
    facts : Facts, optional
        Those that are known already.
    crossings : bool
        Whether to look for faces that cross.
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
        "centroid": _finite(mesh.centroid.tolist()),
        "inertia": _inertia(mesh),
        "self_intersections": _crossings(mesh) if crossings else None,
    }


def exact_text(volume: Fraction) -> str:
    """Return a rational number as ``p/q``."""
    return f"{volume.numerator}/{volume.denominator}"


def _finite(numbers: list[float]) -> list[float] | None:
    return numbers if all(map(math.isfinite, numbers)) else None


def _inertia(mesh: Mesh) -> list[list[float]] | None:
    """Return the moments of inertia about the centre of volume, at density 1."""
    from trimesh.triangles import mass_properties

    if len(mesh.faces) == 0 or not mesh.volume:
        return None
    # From near the middle, far-away models keep their digits.
    corners = (mesh.vertices - mesh.centroid)[mesh.faces]
    with np.errstate(all="ignore"):
        found = np.asarray(mass_properties(corners, density=1.0)["inertia"])
    return found.tolist() if np.isfinite(found).all() else None


def _crossings(mesh: Mesh) -> int | None:
    """Return 0 if no two faces of a mesh cross, exactly; None if that cannot be said."""
    if len(mesh.faces) == 0:
        return 0
    try:
        solid = Solid(mesh.vertices, mesh.faces)
        solid.normalized()
    except BspcsgError:
        return None
    return 0 if solid.tree.simple is True else None
