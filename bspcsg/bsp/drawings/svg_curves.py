"""Compute the corners of SVG shapes, for all curves of a drawing at once.

# Source
SVG 1.1, F.6 (elliptical arcs).
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ..._types import FloatArray, IndexArray
from .svg_paths import Segments

#: An array of points as complex numbers x + iy.
_Points: TypeAlias = np.ndarray[Any, Any]

#: The largest number of chords of a curve.
_MAX_CHORDS = 1 << 12

#: The number of points in one array operation, which bounds the memory.
_POINTS_PER_BATCH = 1 << 16


class Cubics(NamedTuple):
    """The cubic Bézier curves of all shapes of a drawing.

    Parameters
    ----------
    owner, segment : (n,) int
        The index of each curve's shape, and of its segment among the segments of all shapes.
    corners : (n, 4) complex
    """

    owner: IndexArray
    segment: IndexArray
    corners: _Points

    def at(self, which: IndexArray, t: FloatArray) -> _Points:
        """Return points of the curves `which`: row k at the parameters t, for curve which[k]."""
        a, b, c, d = (column[:, None] for column in self.corners[which].T)
        s = 1 - t
        points: _Points = (
            a * (s * s * s) + 3 * (b * (s * s * t) + c * (s * t * t)) + d * (t * t * t)
        )
        return np.asarray(points, dtype=np.complex128)


class Arcs(NamedTuple):
    """The elliptic arcs of all shapes of a drawing.

    Parameters
    ----------
    owner, segment : (n,) int
        The index of each arc's shape, and of its segment among the segments of all shapes.
    center, wide, high : (n,) complex
        The centre and the two half axes of each arc's ellipse, as complex numbers.
    begin, sweep : (n,) float64
        The angle at which each arc begins, and the signed angle that it covers, in radians.
    """

    owner: IndexArray
    segment: IndexArray
    center: _Points
    wide: _Points
    high: _Points
    begin: FloatArray
    sweep: FloatArray

    def at(self, which: IndexArray, t: FloatArray) -> _Points:
        """Return points of the arcs `which`: row k at the parameters t, for arc which[k]."""
        center, wide, high, begin, sweep = (column[which, None] for column in self[2:])
        angles = begin + sweep * t
        return center + wide * np.cos(angles) + high * np.sin(angles)


Curves: TypeAlias = Cubics | Arcs

#: A function that returns the number of chords of each curve.
Steps: TypeAlias = Callable[[Curves], IndexArray]


def outlines(
    shapes: Sequence[Segments], matrices: FloatArray, steps: Steps
) -> list[list[tuple[FloatArray, bool]]]:
    """Return for each shape its subpaths: the corners, (n, 2), y upwards, and whether it is closed.

    Parameters
    ----------
    shapes : sequence of Segments
    matrices : (n, 6) float64
        The transform of each shape, with its entries in SVG's order (a, b, c, d, e, f).
    steps : callable
    """
    ends = np.array([end for shape in shapes for end in shape.ends], dtype=np.complex128)
    if not len(ends):
        return [[] for _ in shapes]
    owner = np.repeat(np.arange(len(shapes)), [len(shape.ends) for shape in shapes])
    before = np.searchsorted(owner, np.arange(len(shapes)))
    with np.errstate(all="ignore"):  # what is not finite is refused with the outline
        families = [(curves, steps(curves)) for curves in _curves(shapes, before)]
        points, counts = _filled(ends, families)
        corners = _transformed(points, matrices[np.repeat(owner, counts)])
    firsts = np.concatenate(
        [
            np.array(shape.firsts, dtype=np.int64) + at
            for shape, at in zip(shapes, before, strict=True)
        ]
    )
    parts = iter(_without_repeats(corners, (np.cumsum(counts) - counts)[firsts]))
    return [[(next(parts), closed) for closed in shape.closed] for shape in shapes]


def chord_counts_within(chords: FloatArray) -> Steps:
    """Return a function that chooses numbers of chords, so that each curve is close to its chords.

    `chords` has the largest distance for each shape; it is tested at points between the corners.
    """

    def steps(curves: Curves) -> IndexArray:
        counts = np.full(len(curves.owner), 2)
        middle = curves.at(np.arange(len(counts)), np.array([0.5]))[:, 0]
        left, count = np.flatnonzero(np.isfinite(middle)), 2
        while len(left) and count < _MAX_CHORDS:
            far = [
                _distance(curves.at(some, _shares(4 * count))) for some in _batches(left, 4 * count)
            ]
            left = left[~(np.concatenate(far) <= chords[curves.owner[left]])]
            count *= 2
            counts[left] = count
        return counts

    return steps


def _shares(count: int) -> FloatArray:
    return np.arange(count + 1) / count


def _batches(which: IndexArray, points: int) -> Iterator[IndexArray]:
    """Yield the curves `which` in batches that compute `points` points on each curve."""
    size = max(1, _POINTS_PER_BATCH // points)
    return (which[start : start + size] for start in range(0, len(which), size))


def _distance(points: _Points) -> FloatArray:
    """Return for each curve the largest distance of its points from its chords.

    A row of `points` has four points for each chord.
    """
    start, end = points[:, :-4:4, None], points[:, 4::4, None]
    offset = points[:, :-1].reshape(len(points), -1, 4)[:, :, 1:] - start
    along = end - start
    length = np.abs(along)
    height = np.abs((offset * np.conj(along)).imag) / length
    far: FloatArray = np.where(length > 0, height, np.abs(offset)).max(axis=(1, 2))
    return far


def _curves(shapes: Sequence[Segments], before: IndexArray) -> Iterator[Curves]:
    """Yield the curves of all shapes by kind; ``before[k]`` segments precede those of shape k."""

    def gathered(name: str) -> tuple[IndexArray, IndexArray, list[Any]]:
        rows = [getattr(shape, name) for shape in shapes]
        owner = np.repeat(np.arange(len(shapes)), list(map(len, rows)))
        number, *columns = zip(*(row for some in rows for row in some), strict=True)
        return owner, np.array(number) + before[owner], [np.array(column) for column in columns]

    if any(shape.cubics for shape in shapes):
        owner, segment, columns = gathered("cubics")
        yield Cubics(owner, segment, np.stack(columns, axis=1))
    if any(shape.turns for shape in shapes):
        owner, segment, columns = gathered("turns")
        yield Arcs(owner, segment, *columns)
    if any(shape.chords for shape in shapes):
        owner, segment, columns = gathered("chords")
        yield Arcs(owner, segment, *_around_centers(*columns))


def _around_centers(
    start: _Points,
    end: _Points,
    width: FloatArray,
    height: FloatArray,
    rotation: FloatArray,
    is_large: IndexArray,
    is_positive: IndexArray,
) -> tuple[_Points, _Points, _Points, FloatArray, FloatArray]:
    """Return arcs as centre, two half axes, first angle and angle covered, given their ends."""
    turned = np.exp(1j * np.radians(rotation))
    seen = (start - end) / 2 * np.conj(turned)
    # Half the chord, in coordinates in which the ellipse is the unit circle.
    half = seen.real / width + 1j * (seen.imag / height)
    length = np.abs(half)
    # SVG enlarges an ellipse that is too small for its chord.
    grown = np.maximum(length, 1.0)
    half, length, width, height = half / grown, length / grown, width * grown, height * grown
    side = np.where(is_large == is_positive, 1j, -1j)
    center = side * np.sqrt((1 - length) * (1 + length)) * (half / length)
    sweep = 2 * np.arcsin(np.minimum(length, 1.0))
    sweep = np.where(is_large, 2 * np.pi - sweep, sweep) * np.where(is_positive, 1, -1)
    wide, high = width * turned, 1j * height * turned
    middle = (start + end) / 2 + wide * center.real + high * center.imag
    return middle, wide, high, np.angle(half - center), sweep


def _filled(
    ends: _Points, families: Sequence[tuple[Curves, IndexArray]]
) -> tuple[_Points, IndexArray]:
    """Return the points of all segments, and the number of points of each.

    The last point of a segment is its end; the points of curves come before it.
    """
    counts = np.ones(len(ends), dtype=np.int64)
    for curves, steps in families:
        counts[curves.segment] = steps
    after = np.cumsum(counts)
    points = np.empty(after[-1], dtype=np.complex128)
    points[after - 1] = ends
    for curves, steps in families:
        for count in np.unique(steps).tolist():
            inner = np.arange(1, count)
            for some in _batches(np.flatnonzero(steps == count), count):
                places = (after[curves.segment[some]] - count)[:, None] + inner - 1
                points[places] = curves.at(some, inner / count)
    return points, counts


def _transformed(points: _Points, matrices: FloatArray) -> FloatArray:
    """Return points transformed by one matrix each, (n, 2), y upwards."""
    a, b, c, d, e, f = matrices.T
    x, y = points.real, points.imag
    return np.stack([x * a + y * c + e, -(x * b + y * d + f)], axis=1) + 0.0


def _without_repeats(corners: FloatArray, firsts: IndexArray) -> list[FloatArray]:
    """Return the corners of each subpath without corners that equal their predecessor."""
    previous = np.arange(len(corners)) - 1
    previous[firsts] = np.append(firsts[1:], len(corners)) - 1
    differs = np.any(corners != corners[previous], axis=1)
    kept = np.add.reduceat(differs.astype(np.int64), firsts)
    return np.split(corners[differs], np.cumsum(kept)[:-1])
