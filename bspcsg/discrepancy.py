"""How much two meshes differ as sets, and how thick the difference is.

A volume alone does not tell rounding from error: a film of one lattice step over a large body has
more of it than a small lost part. So the symmetric difference is built exactly, taken apart into
its connected pieces, and judged by the thickest one.
"""

import math
from dataclasses import dataclass, field
from fractions import Fraction

from .errors import LimitError
from .mesh import Mesh
from .pieces import Pieces
from .solid import Solid

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


def difference_of(
    a: Mesh, b: Mesh, pitch: int, film: float = 0.0
) -> tuple[SetDifference, Pieces | None]:
    """Return the symmetric difference of the sets that two closed meshes bound.

    Parameters
    ----------
    a, b : Mesh
    pitch : int
        Of the lattice that both are read onto.
    film : float
        Thickness in model units below which nothing need be known exactly.

    Returns
    -------
    SetDifference
    Pieces or None
        Of the difference, if it is not empty.

    Raises
    ------
    InvalidMeshError
        If a mesh is not closed.
    """
    difference = _solid(a, pitch) ^ _solid(b, pitch)
    volume = difference.volume_near
    if volume == 0:
        return SetDifference(volume), None
    mesh = difference.normalized().to_mesh()
    if len(mesh.faces) == 0 or mesh.area == 0:
        return SetDifference(volume), None
    pieces = Pieces.of(mesh, film)
    worst = pieces.thickest
    # The exact volume also counts what rounding to doubles has pressed flat.
    thickness = max(float(pieces.thickness[worst]), 2 * float(volume) / mesh.area)
    return SetDifference(volume, mesh.area, thickness, pieces.corner_of(worst)), pieces


def _solid(mesh: Mesh, pitch: int) -> Solid:
    if len(mesh.faces) == 0:
        return Solid.empty()
    try:
        return Solid(mesh.vertices, mesh.faces, pitch=pitch)
    except LimitError:
        return Solid(mesh.vertices, mesh.faces)
