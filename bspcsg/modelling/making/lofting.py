"""Lofts: solids through a sequence of profiles."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..._types import FloatArray, IndexArray
from ...errors import invalid_parameter
from ...geometry.polygon import directed_edges
from ...parameters import refuse_many_corners, truth_value
from ...solid.ledger import counted
from ...solid.solid import Solid
from .rings import solid_of, walls
from .sections import Section, aligned_section, section_of, shortest_band


@counted
def loft(profiles: Sequence[Any], *, closed: bool = False) -> Solid:
    """Return the solid through a sequence of profiles, joined by straight walls.

    Parameters
    ----------
    profiles : sequence
        At least two profiles (three for a closed loft). Each is a pair of a profile (a `Region` or
        what `extrude` takes) and its height z or (4, 4) matrix; or (n, 3) points of a loop in
        space. The first or last profile may be a single point, a tip.
    closed : bool
        True if the last profile is joined to the first.

    Raises
    ------
    InvalidParameterError
        If a profile is invalid or empty, or its numbers of outlines and holes differ from the
        profile before it (`where` is its number); if there are too few profiles; or if they enclose
        nothing.
    LimitError
        If the solid would have too many corners.

    Notes
    -----
    Each outline is joined to the outline, and each hole to the hole, with the nearest middle in the
    next profile. Outlines with equal numbers of corners are joined corner by corner, and must run
    in the same direction; outlines of regions start at the corner that fits best. Outlines with
    different numbers of corners are joined by the band with the least total edge length, from their
    first corners on. Points with a positive winding number are inside.

    Examples
    --------
    >>> import bspcsg as csg
    >>> square, point = [(-1, -1), (1, -1), (1, 1), (-1, 1)], [(0, 0, 3)]
    >>> csg.loft([(square, 0), point]).volume
    4.0
    >>> csg.loft([(csg.Region.rectangle(4, center=True), 0), (csg.Region.circle(1), 5)]).genus
    0
    """
    try:
        sections = [section_of(given, place) for place, given in enumerate(profiles)]
    except TypeError as error:
        raise invalid_parameter("profiles must be a list of profiles.") from error
    is_ring = truth_value(closed, "closed")
    if len(sections) < 2 + is_ring:
        raise invalid_parameter(
            f"A loft needs at least {2 + is_ring} profiles, not {len(sections)}."
        )
    _refuse_inner_tips(sections, is_ring)
    for k in range(1, len(sections)):
        sections[k] = aligned_section(sections[k - 1], sections[k], k)
    rings = [np.concatenate(section.loops) for section in sections]
    starts = np.cumsum([0, *map(len, rings)])
    refuse_many_corners(int(starts[-1]), "This loft")
    faces = [
        _between(sections[k], sections[k + 1], starts[k], starts[k + 1])
        for k in range(len(sections) - 1)
    ]
    if is_ring:
        first = aligned_section(sections[-1], sections[0], 0)
        rings.append(np.concatenate(first.loops))
        faces.append(_between(sections[-1], first, starts[-2], starts[-1]))
    else:
        faces += [sections[0].cap()[:, ::-1], sections[-1].cap() + starts[-2]]
    return _outward(np.concatenate(rings), np.concatenate(faces))


def _refuse_inner_tips(sections: Sequence[Section], closed: bool) -> None:
    for place, section in enumerate(sections):
        if section.is_tip and (closed or 0 < place < len(sections) - 1):
            message = (
                f"Profile {place} of the loft is a single point, which is allowed only for the"
                " first and last profile of an open loft."
            )
            raise invalid_parameter(message, [place])


def _between(low: Section, high: Section, below: int, above: int) -> IndexArray:
    """Return the triangles between two sections, given the first corner number of each."""
    faces = []
    for a, c in zip(low.loops, high.loops, strict=True):
        if len(a) == len(c):
            band = walls(np.array([a, c]), directed_edges([a]))
        else:
            band = shortest_band(a, c)
        names = np.concatenate([below + np.arange(len(a)), above + np.arange(len(c))])
        faces.append(names[band])
        below, above = below + len(a), above + len(c)
    return np.concatenate(faces)


def _outward(vertices: FloatArray, faces: IndexArray) -> Solid:
    """Return the solid of a mesh, whose faces are reversed if its volume is negative."""
    a, b, c = (vertices[faces[:, corner]] - vertices.mean(axis=0) for corner in range(3))
    volume = float(np.einsum("ij,ij->", np.cross(a, b), c))
    if volume == 0:
        raise invalid_parameter(
            "The loft has no volume, because its profiles lie in one plane or are flat; move the"
            " profiles apart."
        )
    return solid_of(vertices, faces if volume > 0 else faces[:, ::-1])
