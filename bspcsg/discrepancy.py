"""How much two meshes differ as sets, and how thick the difference is.

A volume alone does not tell rounding from error: a film of one lattice step over a large body has
more of it than a small lost part. So the symmetric difference is built exactly, taken apart into
its connected pieces, and judged by the thickest one.
"""

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ._types import FloatArray, IndexArray
from .errors import LimitError
from .mesh import Mesh
from .solid import Solid


@dataclass(frozen=True)
class SetDifference:
    """The symmetric difference of two sets.

    Parameters
    ----------
    volume : Fraction
        Exact, of both meshes as they lie on the lattice.
    area : float
    thickness : float
        Of its thickest piece, in model units: twice the volume by the area, which is the thickness
        of a film, and a third of the side of a cube.
    place : tuple of float or None
        A point of that piece.
    """

    volume: Fraction
    area: float = 0.0
    thickness: float = 0.0
    place: tuple[float, float, float] | None = None


def difference_of(a: Mesh, b: Mesh, pitch: int) -> SetDifference:
    """Return the symmetric difference of the sets that two closed meshes bound.

    Raises
    ------
    InvalidMeshError
        If a mesh is not closed.
    """
    difference = _solid(a, pitch) ^ _solid(b, pitch)
    volume = difference.volume_exact
    if volume == 0:
        return SetDifference(volume)
    mesh = difference.normalized().to_mesh()
    thickness, place = _thickest(mesh)
    # The exact volume also counts what rounding to doubles has pressed flat.
    mean = 2 * float(volume) / mesh.area if mesh.area > 0 else 0.0
    return SetDifference(volume, mesh.area, max(thickness, mean), place)


def _solid(mesh: Mesh, pitch: int) -> Solid:
    if len(mesh.faces) == 0:
        return Solid.empty()
    try:
        return Solid(mesh.vertices, mesh.faces, pitch=pitch)
    except LimitError:
        return Solid(mesh.vertices, mesh.faces)


def _thickest(mesh: Mesh) -> tuple[float, tuple[float, float, float] | None]:
    """Return the greatest thickness of a piece, and one of its points."""
    if len(mesh.faces) == 0:
        return 0.0, None
    surfaces = _surfaces(mesh.faces, len(mesh.vertices))
    volumes, areas = _measures(mesh, surfaces)
    outer = _outer_surfaces(mesh, surfaces, volumes)
    volumes, areas = _summed(outer, volumes), _summed(outer, areas)
    thickness = np.divide(2 * np.abs(volumes), areas, np.zeros_like(areas), where=areas > 0)
    worst = int(thickness.argmax())
    x, y, z = mesh.vertices[mesh.faces[int((surfaces == worst).argmax()), 0]].tolist()
    return float(thickness[worst]), (x, y, z)


def _surfaces(faces: IndexArray, vertex_count: int) -> IndexArray:
    """Return for each face the number of its connected surface, from 0."""
    root = np.arange(vertex_count)
    while True:
        low = root[faces].min(axis=1)
        np.minimum.at(root, root[faces].ravel(), np.repeat(low, 3))
        while not np.array_equal(root, jumped := root[root]):
            root = jumped
        if (root[faces] == root[faces[:, :1]]).all():
            return np.unique(root[faces[:, 0]], return_inverse=True)[1]


def _measures(mesh: Mesh, surfaces: IndexArray) -> tuple[FloatArray, FloatArray]:
    """Return volume and area of each surface, measured from a point of its own."""
    _, first = np.unique(surfaces, return_index=True)
    origin = mesh.vertices[mesh.faces[first, 0]][surfaces]
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] - origin for corner in range(3))
    volumes = np.einsum("ij,ij->i", np.cross(a, b), c) / 6
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    return _summed(surfaces, volumes), _summed(surfaces, areas)


def _summed(groups: IndexArray, values: FloatArray) -> FloatArray:
    return np.bincount(groups, values).astype(np.float64)


def _outer_surfaces(mesh: Mesh, surfaces: IndexArray, volumes: FloatArray) -> IndexArray:
    """Return for each surface itself, or for the wall of a cavity what lies around it.

    A film that closes on itself is a large surface around a cavity nearly as large; only together
    do they say how thin it is. The smallest box around decides.
    """
    count = len(volumes)
    outer = np.arange(count)
    cavities = np.flatnonzero(volumes < 0)
    if len(cavities) == 0:
        return outer
    corners = mesh.vertices[mesh.faces]
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    np.minimum.at(low, surfaces, corners.min(axis=1))
    np.maximum.at(high, surfaces, corners.max(axis=1))
    for cavity in cavities.tolist():
        around = (low <= low[cavity]).all(axis=1) & (high >= high[cavity]).all(axis=1)
        around &= volumes >= -volumes[cavity]
        if around.any():
            outer[cavity] = int(np.where(around, volumes, np.inf).argmin())
    return outer
