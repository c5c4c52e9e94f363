"""Hidden-line removal: find the parts of edges that no later polygon covers."""

from typing import TypeAlias

import numpy as np

from ..._types import FloatArray, IndexArray
from ..trees.fragments import concatenated_ranges
from .clip import Polygons, next_corners, polygon_of_corner

#: A part of a segment as two parameters: 0 is the segment's start, 1 its end.
SegmentPart: TypeAlias = tuple[float, float]

#: Visibility is tested this many pixels to both sides of an edge: an edge at the border of a
#: polygon that is painted later is visible, an edge under the seam of two such polygons is hidden.
_TEST_OFFSET = 0.02

#: The shortest visible part of an edge, in pixels. The test to both sides of an edge finds shorter,
#: wrong parts at the ends of hidden edges.
_MIN_VISIBLE_PIXELS = 0.2

#: The largest number of pairs of an edge and a nearby polygon: more would take seconds.
_MAX_NEAR_PAIRS = 4_000_000

#: The width, in pixels, of the grid squares that find pairs of an edge and a nearby polygon.
_GRID_WIDTH = 12.0


def visible_parts(polygons: Polygons, ends: FloatArray, owner: IndexArray) -> FloatArray | None:
    """Return the parts of segments that no later polygon covers, in pixels.

    Parameters
    ----------
    polygons : Polygons
        Polygons in pixels, in the order in which they are painted.
    ends : (m, 2, 2) float64
        The ends of the segments, in pixels.
    owner : (m,) int64
        The polygon of each segment; later polygons may hide the segment.

    Returns
    -------
    (p, 2, 2) float64, or None
        The ends of the visible parts; None if there are too many pairs of a segment and a nearby
        polygon.
    """
    pairs = _near_pairs(polygons, ends, owner)
    if pairs is None:
        return None
    along = ends[:, 1] - ends[:, 0]
    lengths = np.hypot(along[:, 0], along[:, 1])
    kept = lengths > 0
    unit = along / np.where(kept, lengths, 1)[:, None]
    aside = _TEST_OFFSET * np.column_stack([-unit[:, 1], unit[:, 0]])[:, None]
    left, right = (_covered(polygons, ends + shift, *pairs) for shift in (aside, -aside))
    parts, rows = [], []
    for row in np.flatnonzero(kept).tolist():
        hidden = _common(left.get(row, []), right.get(row, []))
        seen = _gaps(hidden, _MIN_VISIBLE_PIXELS / float(lengths[row]))
        parts += seen
        rows += [row] * len(seen)
    shares = np.array(parts).reshape(-1, 2, 1)
    found: FloatArray = ends[rows, :1] + shares * along[rows][:, None]
    return found


def _near_pairs(
    polygons: Polygons, ends: FloatArray, owner: IndexArray
) -> tuple[IndexArray, IndexArray] | None:
    """Return pairs (segment, later polygon) whose boxes meet, or None if they are too many."""
    low = np.minimum.reduceat(polygons.corners, polygons.offsets[:-1]) - _TEST_OFFSET
    high = np.maximum.reduceat(polygons.corners, polygons.offsets[:-1]) + _TEST_OFFSET
    squares, members = _squares(low, high)
    order = np.argsort(squares, kind="stable")
    squares, members = squares[order], members[order]
    asked, segments = _squares(ends.min(axis=1), ends.max(axis=1))
    first, last = (np.searchsorted(squares, asked, side) for side in ("left", "right"))
    if (last - first).sum() > _MAX_NEAR_PAIRS:
        return None
    segment = np.repeat(segments, last - first)
    polygon = members[concatenated_ranges(first, last)]
    meets = polygon > owner[segment]
    meets &= (low[polygon] <= ends.max(axis=1)[segment]).all(axis=1)
    meets &= (high[polygon] >= ends.min(axis=1)[segment]).all(axis=1)
    both = np.unique(segment[meets] * len(low) + polygon[meets])
    return both // len(low), both % len(low)


def _squares(low: FloatArray, high: FloatArray) -> tuple[IndexArray, IndexArray]:
    """Return all pairs (number of a grid square, index of a box) that overlap."""
    first = np.floor(low / _GRID_WIDTH).astype(np.int64)
    sides = np.floor(high / _GRID_WIDTH).astype(np.int64) - first + 1
    counts = sides[:, 0] * sides[:, 1]
    box = np.repeat(np.arange(len(low)), counts)
    place = concatenated_ranges(np.zeros_like(counts), counts)
    column, row = np.divmod(place, sides[box, 1])
    # A picture has fewer than 1 << 20 squares in a column.
    return (first[box, 0] + column) * (1 << 20) + first[box, 1] + row, box


def _covered(
    polygons: Polygons, ends: FloatArray, segment: IndexArray, polygon: IndexArray
) -> dict[int, list[SegmentPart]]:
    """Return the parts of segments that convex polygons cover, by the segment's index."""
    low, high = _clip_parameters(polygons, ends, segment, polygon)
    some = high > low
    found: dict[int, list[SegmentPart]] = {}
    rows = zip(segment[some].tolist(), low[some].tolist(), high[some].tolist(), strict=True)
    for row, start, end in rows:
        found.setdefault(row, []).append((start, end))
    return {row: _merged_parts(parts) for row, parts in found.items()}


def _clip_parameters(
    polygons: Polygons, ends: FloatArray, segment: IndexArray, polygon: IndexArray
) -> tuple[FloatArray, FloatArray]:
    """Return where segments enter and leave convex polygons, from 0 to 1 (Cyrus, Beck 1978).

    There is one value for each pair of `segment` and `polygon`; enter ≥ leave if they do not meet.
    """
    starts, stops = polygons.offsets[:-1][polygon], polygons.offsets[1:][polygon]
    corner = concatenated_ranges(starts, stops)
    pair = np.repeat(np.arange(len(polygon)), stops - starts)
    after = next_corners(polygons.offsets)
    along = polygons.corners[after] - polygons.corners
    turn = np.sign(_areas(polygons))[polygon[pair]]
    tail, head = ends[segment[pair], 0], ends[segment[pair], 1]
    # Signed distance from each side of the polygon, times the side's length; positive inside.
    first = turn * _cross(along[corner], tail - polygons.corners[corner])
    second = turn * _cross(along[corner], head - polygons.corners[corner])
    slope = second - first
    share = -first / np.where(slope == 0, 1, slope)
    never = (slope == 0) & (first <= 0)
    enter = np.where(never, np.inf, np.where(slope > 0, share, 0.0))
    leave = np.where(slope < 0, share, 1.0)
    firsts = np.cumsum(stops - starts) - (stops - starts)
    if not len(firsts):
        return np.zeros(0), np.zeros(0)
    low = np.maximum(np.maximum.reduceat(enter, firsts), 0.0)
    high = np.minimum(np.minimum.reduceat(leave, firsts), 1.0)
    return low, high


def _areas(polygons: Polygons) -> FloatArray:
    """Return twice the signed area of each polygon, (k,)."""
    owner, after = polygon_of_corner(polygons.offsets), next_corners(polygons.offsets)
    arms = polygons.corners - polygons.corners[polygons.offsets[:-1]][owner]
    sums: FloatArray = np.add.reduceat(_cross(arms, arms[after]), polygons.offsets[:-1])
    return sums


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    product: FloatArray = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return product


def _merged_parts(parts: list[SegmentPart]) -> list[SegmentPart]:
    united: list[SegmentPart] = []
    for start, end in sorted(parts):
        # Adjacent parts share an end, up to rounding.
        if united and start <= united[-1][1] + 1e-9:
            united[-1] = (united[-1][0], max(end, united[-1][1]))
        else:
            united.append((start, end))
    return united


def _common(first: list[SegmentPart], second: list[SegmentPart]) -> list[SegmentPart]:
    """Return the intersection of two sorted lists of disjoint parts of a segment."""
    pairs = ((max(a, c), min(b, d)) for a, b in first for c, d in second)
    return [(start, end) for start, end in pairs if start < end]


def _gaps(parts: list[SegmentPart], shortest: float) -> list[SegmentPart]:
    """Return the gaps longer than `shortest` between sorted disjoint parts of a segment."""
    if not parts:
        return [(0.0, 1.0)]
    borders = [0.0, *(border for part in parts for border in part), 1.0]
    gaps = zip(borders[::2], borders[1::2], strict=True)
    return [(start, end) for start, end in gaps if end - start > shortest]
