"""Offsets of plane figures."""

import math
from collections.abc import Sequence
from typing import Any, Literal, TypeAlias, get_args

import manifold3d
import numpy as np
import pyclipper

from ..._types import FloatArray, Scalar
from ...bsp import Region
from ...errors import InvalidMeshError, LimitError, invalid_parameter
from ...parameters import SEGMENTS, number, one_of, refuse_many_corners, sides_around

#: The shape of an offset outline around a corner from which it moves away.
Join: TypeAlias = Literal["round", "miter", "square", "bevel"]

#: The default limit of mitred corners, in multiples of the distance: practically none.
_MITER_LIMIT = 1e6

#: The bound to which coordinates are scaled for pyclipper, which computes in 64-bit integers.
_CLIPPER_BOUND = 2.0**40

#: The bound to which coordinates are scaled for manifold3d, which computes in 64-bit multiples of
#: 1e-8 and so represents values up to 2**36.
_MANIFOLD_BOUND = 2.0**30

#: The largest distance of an offset, as a multiple of the figure's largest coordinate. The figure
#: then still extends over 2**20 integer steps of Clipper.
_MAX_GROWTH = 2.0**20

#: Steps per model unit to which OpenSCAD 2021.01 rounds the corners of figures that it combines.
_GRID = 2.0**16

#: The bound of coordinates, in model units: Clipper ends the process at 2**62 steps of `_GRID`.
_GRID_REACH = 2.0**62 / _GRID

#: Steps per model unit in which strokes are computed. Their arcs deviate by a quarter of a step.
_STROKE_STEPS = 10_000.0

#: OpenSCAD merges corners of a result that are closer than this, in model units, and removes
#: corners that are as close to the line through their neighbours.
_MERGE_DISTANCE = 0.001


def offset_region(
    figure: Region,
    delta: Scalar,
    join: Join = "round",
    *,
    segments: int = SEGMENTS,
    miter_limit: Scalar = _MITER_LIMIT,
) -> Region:
    """Return a region with its outline moved outwards by `delta`, or inwards if it is negative."""
    one_of(get_args(Join), join, "join")
    distance, limit = number(delta, "delta"), number(miter_limit, "miter_limit")
    sides = sides_around(3, segments, "segments")
    if limit < 1:
        raise invalid_parameter(f"miter_limit must be at least 1, not {limit:g}.")
    if distance == 0 or figure.is_empty or figure.is_full:
        return figure
    if not figure.is_bounded and (~figure).is_bounded:
        return ~offset_region(~figure, -distance, join, segments=sides, miter_limit=limit)
    refuse_far(figure, distance)
    if join == "bevel":
        return _bevelled(figure, distance)
    return offset_outline(figure, distance, join, sides, limit)


def refuse_far(figure: Region, delta: float) -> None:
    """Raise `LimitError` if an offset exceeds 2**20 times a figure's largest coordinate."""
    size = max(float(np.abs(loop).max()) for loop in figure.to_polygons())
    if delta > _MAX_GROWTH * size:
        message = (
            f"delta {delta:g} is too large for a region that extends to {size:g} from the origin;"
            f" it may be at most {_MAX_GROWTH:g} times as large."
        )
        raise LimitError(message, "too_large")


def offset_outline(
    figure: Region, delta: float, join: str, sides: int, miter_limit: float = _MITER_LIMIT
) -> Region:
    """Return a figure with its outline moved outwards by `delta`, or inwards if it is negative.

    Parameters
    ----------
    figure : Region
        A region that is not empty.
    delta : float
        The distance in model units.
    join : {"round", "square", "miter"}
        The shape of the outline around corners from which it moves away.
    sides : int
        The number of sides of a full circle, for round corners.
    miter_limit : float
        The largest length of a mitre, in multiples of `delta`; longer mitres become square.
    """
    loops = figure.to_polygons()
    if join == "round":
        refuse_many_corners(_arc_corners(loops, delta, sides), "This offset")
    scale = _scale(loops, delta)
    # With this tolerance Clipper divides a full circle into `sides` sides.
    tolerance = abs(delta) * scale * (1 - np.cos(np.pi / sides))
    pen = pyclipper.PyclipperOffset(miter_limit, tolerance)
    kind = getattr(pyclipper, f"JT_{join.upper()}")
    pen.AddPaths(_whole_numbers(loops, scale), kind, pyclipper.ET_CLOSEDPOLYGON)
    paths = pen.Execute(delta * scale)
    return Region([np.array(path) / scale for path in paths], pitch=figure.pitch)


def _arc_corners(loops: Sequence[FloatArray], delta: float, sides: int) -> int:
    """Return an upper bound of the number of corners of an offset with round joins."""
    turned, count = 0.0, 0
    for loop in loops:
        along = np.diff(loop, axis=0, append=loop[:1])
        angles = np.arctan2(along[:, 1], along[:, 0])
        turns = (angles - np.roll(angles, 1) + math.pi) % math.tau - math.pi
        turned += float(np.maximum(turns * np.sign(delta), 0).sum())
        count += 2 * len(loop)
    return count + math.ceil(turned / math.tau * sides)


def _bevelled(figure: Region, delta: float) -> Region:
    """Return the offset of a figure with bevelled corners, computed by manifold3d."""
    loops = figure.to_polygons()
    scale = _scale(loops, delta, _MANIFOLD_BOUND)
    scaled = [loop * scale for loop in loops]
    body = manifold3d.CrossSection(scaled, manifold3d.FillRule.Positive)
    grown_body = body.offset(delta * scale, manifold3d.JoinType.Bevel)
    paths = grown_body.to_polygons()
    return Region([np.asarray(path) / scale for path in paths], pitch=figure.pitch)


def openscad_union(figures: Sequence[Region]) -> Region:
    """Return the union of figures, without tiny gaps and overlaps, as OpenSCAD computes it.

    With six digits, the sides of rotated shapes may have tiny gaps or overlaps. A negative offset
    of such a figure widens a gap to a slit, and a mitred positive offset makes spikes. The result
    differs from the union by less than a thousandth of a unit. Figures without area after rounding
    are dropped.

    Raises
    ------
    LimitError
        If a coordinate exceeds the integer range; code ``"too_large"``.
    """
    loops = [loop for figure in figures for loop in figure.to_polygons()]
    largest = max((float(np.abs(loop).max()) for loop in loops), default=0.0)
    if largest >= _GRID_REACH:
        message = (
            f"a figure has coordinates up to {largest:g}, and offsets are possible up to"
            f" {_GRID_REACH:g} only; scale the figure down."
        )
        raise LimitError(message, "too_large")
    rounded = [path for path in _whole_numbers(loops, _GRID) if _has_area(path)]
    if not rounded:
        return Region.empty()
    pen = pyclipper.Pyclipper()
    pen.AddPaths(rounded, pyclipper.PT_SUBJECT)
    paths = pen.Execute(pyclipper.CT_UNION, pyclipper.PFT_NONZERO, pyclipper.PFT_NONZERO)
    kept = [pyclipper.CleanPolygon(path, _MERGE_DISTANCE * _GRID) for path in paths]
    loops = [np.array(path) / _GRID for path in kept if len(path) >= 3]
    return Region(loops, pitch=min(figure.pitch for figure in figures))


def _has_area(path: list[list[int]]) -> bool:
    """Return True if the corners of a path are not all on one line, which Clipper requires."""
    (x, y), *others = path
    arms = [(u - x, v - y) for u, v in others if (u, v) != (x, y)]
    return any(arms[0][0] * v != arms[0][1] * u for u, v in arms[1:])


def stroke_area(line: FloatArray, width: float, cap: str, join: str = "miter") -> Region:
    """Return the area that a stroke of a given width covers along a polyline.

    Parameters
    ----------
    line : (n, 2) float64
        The corners of the polyline.
    width : float
        The width of the stroke, in model units.
    cap : {"butt", "square", "round"}
        The shape of the stroke's ends.
    join : {"miter", "round", "bevel"}
        The shape of the stroke's corners. Bevelled corners are cut off at half the width from the
        polyline's corner.
    """
    scale = min(_STROKE_STEPS, _scale([line], width))
    pen = pyclipper.PyclipperOffset()
    ends = getattr(pyclipper, f"ET_OPEN{cap.upper()}")
    kinds = {"round": pyclipper.JT_ROUND, "bevel": pyclipper.JT_SQUARE}
    pen.AddPaths(_whole_numbers([line], scale), kinds.get(join, pyclipper.JT_MITER), ends)
    return Region([np.array(path) / scale for path in pen.Execute(width / 2 * scale)])


def _whole_numbers(loops: list[FloatArray], scale: float) -> list[Any]:
    if not all(np.isfinite(loop).all() for loop in loops):
        raise InvalidMeshError(
            "A drawing has a coordinate that is not a finite number.", "non_finite"
        )
    return [np.trunc(loop * scale).astype(int).tolist() for loop in loops]


def _scale(loops: list[FloatArray], delta: float, reach: float = _CLIPPER_BOUND) -> float:
    """Return the largest power of two that scales loops, grown by `delta`, to at most `reach`."""
    largest = max(float(np.abs(loop).max()) for loop in loops) + abs(delta)
    return float(2.0 ** np.floor(np.log2(reach / largest)))
