"""Extrusions with slanted walls, some of which end below the top."""

from collections.abc import Sequence

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...shapes.primitives import box, half_space
from ...solid.solid import Solid
from .roofs import corner_speeds, roof


def extrude_slanted(contours: Sequence[FloatArray], height: float, inset: float) -> Solid:
    """Return the extrusion of contours with slanted walls.

    If walls slant inwards, it is the roof over the figure, as steep as the walls, cut off at the
    given height. If they slant outwards, it is a box minus the roof over the figure's surroundings.

    Parameters
    ----------
    contours : sequence of (n, 2) float64
        Outlines with the inside on their left.
    height : float
    inset : float
        The distance by which the walls are moved inwards at the top; negative for outwards.
    """
    figure = Region(list(contours))
    if inset > 0:
        return _steep(figure, height / inset) & half_space((0, 0, 1), height)
    corners = np.concatenate(figure.to_polygons())
    reach = -inset * max(1.0, float(np.linalg.norm(corner_speeds(figure), axis=1).max()))
    # The outer border of the surroundings moves inwards, too, and must not reach the result.
    low, high = corners.min(axis=0), corners.max(axis=0)
    around = Region.rectangle(*(high - low + 6 * reach)).translate(low - 3 * reach)
    wide, deep = high - low + 3 * reach
    slab = box(wide, deep, height).translate(*(low - 1.5 * reach), 0)
    return slab - _steep(around - figure, height / -inset)


def _steep(figure: Region, slope: float) -> Solid:
    """Return the roof over a figure, with sides of the given slope."""
    return roof(figure).scale((1, 1, slope))
