"""Extrusions with slanted walls, some of which vanish on the way up."""

from collections.abc import Sequence

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...shapes.primitives import box, half_space
from ...solid.solid import Solid
from .roofs import corner_speeds, roof


def leaning(contours: Sequence[FloatArray], height: float, inset: float) -> Solid:
    """Return the extrusion of contours whose walls move inwards on the way up.

    It is the roof over the figure, as steep as the walls, cut off at the height. If walls move
    outwards, it is the space beside the roof over the surroundings.

    Parameters
    ----------
    contours : sequence of (n, 2) float64
        Outlines with the inside on their left.
    height : float
    inset : float
        The distance that walls have moved inwards at this height; negative for outwards.
    """
    figure = Region(list(contours))
    if inset > 0:
        return _steep(figure, height / inset) & half_space((0, 0, 1), height)
    corners = np.concatenate(figure.to_polygons())
    reach = -inset * max(1.0, float(np.linalg.norm(corner_speeds(figure), axis=1).max()))
    # The outer walls of the surroundings move inwards, too, and must not reach the result.
    low, high = corners.min(axis=0), corners.max(axis=0)
    around = Region.rectangle(*(high - low + 6 * reach)).translate(low - 3 * reach)
    wide, deep = high - low + 3 * reach
    slab = box(wide, deep, height).translate(*(low - 1.5 * reach), 0)
    return slab - _steep(around - figure, height / -inset)


def _steep(figure: Region, slope: float) -> Solid:
    """Return the roof over a figure with this slope."""
    return roof(figure).scale((1, 1, slope))
