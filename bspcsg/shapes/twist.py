"""Extrusions with twist, scale or slanted walls."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from .._types import FloatArray, IndexArray
from ..errors import InvalidParameterError, invalid_parameter
from ..geometry.polygon import directed_edges, runs_clockwise, triangulate
from ..geometry.transform import cos_sin
from ..mesh.weld import welded
from ..solid.solid import Solid

#: Diagonals count as equal if the relative difference of their lengths is at most this.
_EQUAL = 1e-5

#: The least value of one plus the cosine of the angle between the normals of two adjacent walls.
#: Below it, their corner moves more than a thousand times as far as the walls.
_SHARPEST = 1e-6


@dataclass(frozen=True)
class Rise:
    """The change of a figure from the lower to the upper end of an extrusion.

    Parameters
    ----------
    height, base : float
        The length along z, and the z of the lower end.
    twist : float
        Rotation of the upper end in degrees, clockwise seen from above.
    scale : (float, float)
        Scale factors of the upper end along x and y.
    slices : int
        The number of levels above the lower end.
    inset : float
        The distance by which the walls are moved inwards at the upper end.
    """

    height: float
    base: float = 0.0
    twist: float = 0.0
    scale: tuple[float, float] = (1.0, 1.0)
    slices: int = 1
    inset: float = 0.0

    @property
    def is_upright(self) -> bool:
        """True if the figure does not change from the lower to the upper end."""
        return self.only_leans and self.inset == 0

    @property
    def only_leans(self) -> bool:
        """True if there is no twist and no scale; walls may be slanted."""
        return self.twist == 0 and self.scale == (1.0, 1.0)

    def section(self, points: FloatArray, lean: FloatArray, level: int) -> FloatArray:
        """Return the (n, 3) points of the extruded figure at a level; level 0 is the lower end.

        Parameters
        ----------
        points, lean : (n, 2) float64
            The corners of the lower end, and the vectors by which they move to the upper end.
        """
        part = level / self.slices
        cosine, sine = cos_sin(-self.twist * part)
        x, y = (points + lean * part).T
        scale = [1 - (1 - end) * part for end in self.scale]
        turned = np.column_stack([x * cosine - y * sine, x * sine + y * cosine]) * scale
        return np.column_stack([turned, np.full(len(points), self.base + self.height * part)])


def extruded(contours: Sequence[FloatArray], rise: Rise) -> Solid:
    """Return the extrusion of contours with twist, scale or slanted walls.

    Parameters
    ----------
    contours : sequence of (n, 2) float64
        Closed outlines with the inside on their left.

    Raises
    ------
    InvalidParameterError
        If a slanted wall loses its upper edge and there is also a twist or a scale.
    """
    lean, lost = _corner_displacements(contours, rise.inset)
    if lost is not None and rise.only_leans:
        from ..modelling.making.slanted_extrusion import extrude_slanted

        return extrude_slanted(contours, rise.height, rise.inset).translate(0, 0, rise.base)
    if lost is not None:
        raise _no_room(*lost, "the edge that starts there would vanish")
    points = np.concatenate(contours)
    holes = np.concatenate([np.full(len(c), runs_clockwise(c)) for c in contours])
    levels = [rise.section(points, lean, k) for k in range(rise.slices + 1)]
    edges = directed_edges(contours)
    bands = [
        _band(levels[k], levels[k + 1], edges, holes, rise) + k * len(points)
        for k in range(rise.slices)
    ]
    cap = triangulate(contours)
    faces = np.concatenate([cap[:, ::-1], *bands, cap + rise.slices * len(points)])
    return _closed(np.concatenate(levels), faces)


#: A contour, and the number of one of its corners.
_ContourCorner: TypeAlias = tuple[FloatArray, int]


def _corner_displacements(
    contours: Sequence[FloatArray], inset: float
) -> tuple[FloatArray, _ContourCorner | None]:
    """Return the displacement of each corner, (n, 2), if all walls move inwards by `inset`.

    Also return the first corner whose outgoing edge vanishes, or None.
    """
    if inset == 0:
        return np.zeros((sum(map(len, contours)), 2)), None
    found = [_corner_moves(contour, inset) for contour in contours]
    lost = (
        (contour, int(gone[0]))
        for contour, (_, gone) in zip(contours, found, strict=True)
        if len(gone)
    )
    return np.concatenate([moves for moves, _ in found]), next(lost, None)


def _corner_moves(contour: FloatArray, inset: float) -> tuple[FloatArray, IndexArray]:
    """Return the displacement of each corner if walls move inwards, and which edges vanish.

    An edge is given by the number of its first corner.
    """
    along = np.roll(contour, -1, axis=0) - contour
    inward = np.column_stack([-along[:, 1], along[:, 0]])
    inward /= np.linalg.norm(inward, axis=1)[:, None]
    before = np.roll(inward, 1, axis=0)
    opening = 1 + (inward * before).sum(axis=1)
    for corner in np.flatnonzero(opening < _SHARPEST).tolist():
        raise _no_room(contour, corner, "the outline turns back on itself there")
    moves = inset * (inward + before) / opening[:, None]
    shrunk = along + np.roll(moves, -1, axis=0) - moves
    return moves, np.flatnonzero((shrunk * along).sum(axis=1) <= 0)


def _no_room(contour: FloatArray, corner: int, reason: str) -> InvalidParameterError:
    x, y = contour[corner].tolist()
    message = (
        f"The taper is too large at the corner ({x:g}, {y:g}): {reason}. Choose a smaller taper."
    )
    return invalid_parameter(message, [corner])


def _band(
    low: FloatArray, high: FloatArray, edges: IndexArray, holes: FloatArray, rise: Rise
) -> IndexArray:
    """Return the triangles between two levels, each quadrilateral cut along its shorter diagonal.

    If the diagonals are equal, the direction of the twist and whether the edge belongs to a hole
    decide. Below an upper end without area, the other diagonal is used.
    """
    start, end = edges.T
    up, down = (
        np.linalg.norm((a - b)[:, :2], axis=1)
        for a, b in ((low[start], high[end]), (low[end], high[start]))
    )
    equal = 2 * np.abs(up - down) <= _EQUAL * (up + down)
    flipped = np.asarray(holes[start], dtype=bool) ^ (rise.twist <= 0)
    rising = np.where(equal, ~flipped, up < down)
    if _is_flat(high):
        rising = ~rising
    above = len(low)
    first = np.column_stack([start, end, np.where(rising, end, start) + above])
    second = np.column_stack([np.where(rising, start, end), end + above, start + above])
    return np.concatenate([first, second])


def _is_flat(level: FloatArray) -> bool:
    return bool((np.ptp(level[:, :2], axis=0) == 0).any())


def _closed(vertices: FloatArray, faces: IndexArray) -> Solid:
    """Return the solid of a mesh whose corners may coincide and whose faces may cross.

    Faces may cross because contours cross, or because twisted walls are not plane.
    """
    points, same = welded(vertices)
    triangles = same[faces]
    proper = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return Solid(points, np.ascontiguousarray(triangles[proper]))
