"""How much two meshes differ as sets, and how thick the difference is.

A volume alone does not tell rounding from error: a film of one lattice step over a large body has
more of it than a small lost part. So the symmetric difference is built exactly, taken apart into
its connected pieces, and judged by the thickest one.
"""

import math
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np

from ._types import FloatArray, IndexArray
from .errors import LimitError
from .mesh import Mesh
from .solid import Solid

#: Relative rounding error of a tetrahedron's volume, by the lengths of three edges.
_NOISE = 1e-15


#: Digits beyond which an exact number is not written out.
_MOST_DIGITS = 4000


def exact_text(number: Fraction) -> str | None:
    """Return a fraction like ``"1/3"``, or None if it has thousands of digits.

    Each cut of an exact solid multiplies the denominators; those of a real part fill pages.
    """
    bits = max(number.numerator.bit_length(), number.denominator.bit_length())
    return str(number) if bits * math.log10(2) < _MOST_DIGITS else None


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

    volume: Fraction = field(repr=False)
    area: float = 0.0
    thickness: float = 0.0
    place: tuple[float, float, float] | None = None


def difference_of(a: Mesh, b: Mesh, pitch: int, film: float = 0.0) -> SetDifference:
    """Return the symmetric difference of the sets that two closed meshes bound.

    Parameters
    ----------
    a, b : Mesh
    pitch : int
        Of the lattice that both are read onto.
    film : float
        Thickness in model units below which nothing need be known exactly.

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
    thickness, place = _thickest(mesh, film)
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


def _thickest(mesh: Mesh, film: float) -> tuple[float, tuple[float, float, float] | None]:
    """Return the greatest thickness of a piece, and one of its points."""
    if len(mesh.faces) == 0:
        return 0.0, None
    surfaces = _surfaces(mesh.faces, len(mesh.vertices))
    volumes, areas = _measures(mesh, surfaces, film)
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


def _measures(mesh: Mesh, surfaces: IndexArray, film: float) -> tuple[FloatArray, FloatArray]:
    """Return volume and area of each surface, measured from a point of its own.

    A needle's volume drowns in the rounding of its length. Where that could pass for a piece
    thicker than a film, the sum is taken exactly.
    """
    _, first = np.unique(surfaces, return_index=True)
    origin = mesh.vertices[mesh.faces[first, 0]][surfaces]
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] - origin for corner in range(3))
    volumes = np.einsum("ij,ij->i", np.cross(a, b), c) / 6
    noise = np.prod([np.linalg.norm(corner, axis=1) for corner in (a, b, c)], axis=0) * _NOISE
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    total, doubt, area = (_summed(surfaces, values) for values in (volumes, noise, areas))
    unclear = (np.abs(total) < 100 * doubt) & (2 * (np.abs(total) + doubt) > film * area)
    for surface in np.flatnonzero(unclear).tolist():
        total[surface] = _exact_volume(mesh.vertices[mesh.faces[surfaces == surface]])
    return total, area


def _exact_volume(triangles: FloatArray) -> float:
    """Return the signed volume of a closed surface of (m, 3, 3) corners, rounded once."""
    six = Fraction(0)
    for a, b, c in triangles.tolist():
        (u, v, w), (x, y, z), (p, q, r) = (map(Fraction, corner) for corner in (a, b, c))
        six += u * (y * r - z * q) - v * (x * r - z * p) + w * (x * q - y * p)
    return float(six / 6)


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
