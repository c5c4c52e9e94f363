"""`panorama`: a map of segments in the plane, above the view that the painter's algorithm gives."""

from typing import Any

import numpy as np

from ..._types import FloatArray, IndexArray
from ...errors import invalid_parameter
from ...parameters import at_least
from ..trees.fragments import Fragments
from ..trees.tree import PartitionTree
from .clip import Polygons, clip
from .colours import ColourArray, colour, colours
from .painting import Painting
from .picture import Picture, checked_size

_PALETTE = ["#d1495b", "#edae49", "#00798c", "#7a9e4b", "#30638e", "#9c6b98", "#c9713b", "#5f6b73"]
_INK = np.array([26, 28, 32], dtype=np.uint8)

#: The width of the empty margin around the map and around the strip, in pixels.
_MARGIN = 12.0

#: The fraction of the picture's height that the strip takes.
_STRIP = 0.16

#: Half of the line width of segments on the map, in pixels.
_HALF_LINE_WIDTH = 2.0


def panorama(
    scene: Any,
    *,
    eye: Any = None,
    direction: Any = None,
    size: tuple[int, int] = (640, 480),
    colors: Any = None,
    background: Any = "white",
    samples: int = 3,
) -> Picture:
    """Return a map of segments, and below it a strip with the view of a viewer in the plane.

    The strip is painted from the farthest to the nearest fragment. For an eye the strip shows the
    full circle, with +y in the middle and clockwise to the right; for a direction it shows a
    parallel view.

    Parameters
    ----------
    scene : PartitionTree or (n, 2, 2) array_like
        A tree of segments, or segments, from which a tree is built.
    eye : (2,) array_like, optional
        The viewpoint, drawn as a dot on the map.
    direction : (2,) array_like, optional
        Instead of an eye: the direction of view, drawn as an arrow on the map.
    size : (int, int)
        Width and height in pixels, at least 64 each.
    colors : optional
        As for `picture`, for each segment; by default eight colours in turn.
    background : optional
        A colour, or None for transparent.
    samples : int
        Each pixel of a PNG is the mean of `samples` × `samples` samples.

    Returns
    -------
    Picture
        Segments on a line through the eye have no extent in the strip.

    Raises
    ------
    InvalidParameterError
        If the scene is not in the plane, not exactly one of eye and direction is given, one is not
        two finite numbers, the direction is zero, or a parameter is not one of those above.
    """
    frame = checked_size(size)
    if min(frame) < 64:
        raise invalid_parameter(
            "The size of a panorama must be at least 64 pixels in width and height, not"
            f" {min(frame)}."
        )
    tree = scene if isinstance(scene, PartitionTree) else PartitionTree(scene)
    if tree.dimension != 2:
        raise invalid_parameter(
            f"panorama takes segments in the plane, but this scene has {tree.dimension}"
            " dimensions; use picture for triangles and polygons."
        )
    fragments = tree.back_to_front(eye=eye, direction=direction)
    viewpoint = np.asarray(eye if direction is None else direction, dtype=np.float64)
    strip, strip_source = _strip(fragments, viewpoint, direction is not None, frame)
    flat, flat_source = _map(fragments, viewpoint, direction is not None, frame)
    source = np.concatenate([flat_source, strip_source])
    fills = _fills(source, len(tree.core.lattice()[1]) - 1, colors)
    polygons = _joined(flat, strip)
    painting = Painting(frame, polygons, _border(frame), fills, source, np.arange(len(source)))
    back = None if background is None else colour(background, "background")
    return Picture(painting, back, 1.0, at_least(1, samples, "samples"))


def _fills(source: IndexArray, count: int, colors: Any) -> ColourArray:
    """Return the colour of each polygon, (k, 3); for the eye or arrow (source -1) it is `_INK`."""
    if colors is None:
        colors = [_PALETTE[k % len(_PALETTE)] for k in range(count)]
    base = colours(colors, count, "colors") if count else np.zeros((0, 3), dtype=np.uint8)
    return np.vstack([base, _INK[None]])[source]


def _joined(first: Polygons, second: Polygons) -> Polygons:
    offsets = np.concatenate([first.offsets, second.offsets[1:] + first.offsets[-1]])
    corners = np.concatenate([first.corners, second.corners])
    return Polygons(corners, offsets, np.zeros(len(corners), dtype=bool))


def _quads(corners: FloatArray) -> Polygons:
    """Return the polygons with the given (k, m, 2) corners."""
    count, sides, _ = corners.shape
    flat = corners.reshape(-1, 2)
    return Polygons(flat, sides * np.arange(count + 1), np.zeros(len(flat), dtype=bool))


def _strip(
    fragments: Fragments, viewpoint: FloatArray, parallel: bool, frame: tuple[int, int]
) -> tuple[Polygons, IndexArray]:
    ends = fragments.vertices.reshape(-1, 2, 2)
    spans, of = (
        _parallel_intervals(ends, viewpoint)
        if parallel
        else _perspective_intervals(ends, viewpoint)
    )
    width, height = frame
    left, right = (_MARGIN + spans * (width - 2 * _MARGIN)).T
    top, bottom = height * (1 - _STRIP), height - _MARGIN
    corners = [(left, top), (right, top), (right, bottom), (left, bottom)]
    quads = _quads(np.stack([np.stack(np.broadcast_arrays(*c), axis=1) for c in corners], axis=1))
    right_side = np.array([-1.0, 0.0])
    quads, inner = clip(quads, -right_side, _MARGIN)
    quads, left_over = clip(quads, right_side, _MARGIN - width)
    return quads, fragments.source[of[inner[left_over]]]


def _border(frame: tuple[int, int]) -> FloatArray:
    """Return the four sides of the strip as segments in pixels, (4, 2, 2)."""
    left, right = _MARGIN, frame[0] - _MARGIN
    top, bottom = frame[1] * (1 - _STRIP), frame[1] - _MARGIN
    around = np.array([(left, top), (right, top), (right, bottom), (left, bottom)])
    return np.stack([around, np.roll(around, -1, axis=0)], axis=1)


def _parallel_intervals(ends: FloatArray, direction: FloatArray) -> tuple[FloatArray, IndexArray]:
    """Return the interval of the strip's width, from 0 to 1, of each segment in a parallel view.

    The second array has the index of the segment of each interval.
    """
    scaled = direction / np.abs(direction).max()
    places = ends @ np.array([scaled[1], -scaled[0]])
    low, high = (places.min(), places.max()) if len(places) else (0.0, 1.0)
    shares = (np.sort(places, axis=1) - low) / (high - low if high > low else 1.0)
    return shares, np.arange(len(ends))


def _perspective_intervals(ends: FloatArray, eye: FloatArray) -> tuple[FloatArray, IndexArray]:
    """Return intervals of the strip's width, from 0 to 1, of segments seen from an eye.

    The second array has the segment of each interval. Each interval is repeated one strip width to
    the left and to the right, for segments behind the viewer, who looks along +y.
    """
    arms = ends - eye
    turns = np.arctan2(arms[..., 0], arms[..., 1]) / (2 * np.pi) + 0.5
    cross = arms[:, 0, 0] * arms[:, 1, 1] - arms[:, 0, 1] * arms[:, 1, 0]
    seen = np.flatnonzero(cross != 0)
    first, second = turns[seen].T
    # A segment spans less than half of the circle.
    gap = (second - first + 0.5) % 1.0 - 0.5
    spans = np.sort(np.stack([first, first + gap], axis=1), axis=1)
    twice = np.stack([spans - 1, spans, spans + 1], axis=1).reshape(-1, 2)
    return twice, np.repeat(seen, 3)


def _map(
    fragments: Fragments, viewpoint: FloatArray, parallel: bool, frame: tuple[int, int]
) -> tuple[Polygons, IndexArray]:
    ends = fragments.vertices.reshape(-1, 2, 2)
    points = ends.reshape(-1, 2) if parallel else np.vstack([ends.reshape(-1, 2), viewpoint])
    points = points if len(points) else np.zeros((1, 2))
    low, high = points.min(axis=0), points.max(axis=0)
    width, height = frame[0] - 4 * _MARGIN, frame[1] * (1 - _STRIP) - 4 * _MARGIN
    extent = high - low
    # A flat scene fills the width of the picture; a single point may have any scale.
    extent = np.maximum(extent, 1e-9 * float(extent.max())) if extent.any() else np.ones(2)
    scale = float((np.array([width, height]) / extent).min())
    middle = np.array([frame[0] / 2, frame[1] * (1 - _STRIP) / 2])

    def pixels(of: FloatArray) -> FloatArray:
        turned: FloatArray = middle + (of - (low + high) / 2) * np.array([scale, -scale])
        return turned

    bands = _bands(pixels(ends))
    marker = _arrow_outline(viewpoint) if parallel else pixels(viewpoint) + _dot()
    marks = _quads(marker[None])
    source = np.concatenate([fragments.source, np.array([-1])])
    return _joined(bands, marks), source


def _bands(ends: FloatArray) -> Polygons:
    along = ends[:, 1] - ends[:, 0]
    lengths = np.hypot(along[:, 0], along[:, 1])[:, None]
    side = (
        _HALF_LINE_WIDTH
        * np.column_stack([-along[:, 1], along[:, 0]])
        / np.where(lengths > 0, lengths, 1)
    )
    a, b = ends[:, 0], ends[:, 1]
    return _quads(np.stack([a + side, b + side, b - side, a - side], axis=1))


def _dot() -> FloatArray:
    angles = np.arange(16) * (np.pi / 8)
    return 5 * np.column_stack([np.cos(angles), np.sin(angles)])


def _arrow_outline(direction: FloatArray) -> FloatArray:
    scaled = direction / np.abs(direction).max()
    x, y = scaled / np.hypot(*scaled)
    # Pixel coordinates grow downwards.
    along, side = np.array([x, -y]), np.array([y, x])
    tip = np.array([2.5 * _MARGIN, 2.5 * _MARGIN]) + 14 * along
    back = tip - 28 * along
    neck = tip - 10 * along
    outline = [tip, neck + 6 * side, neck + 1.5 * side, back + 1.5 * side]
    return np.array([*outline, back - 1.5 * side, neck - 1.5 * side, neck - 6 * side])
