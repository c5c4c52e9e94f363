"""Write paintings as SVG: one path for each coplanar set, without the lines of the tree's cuts."""

from itertools import groupby, pairwise

import numpy as np

from ..._types import FloatArray
from ...attributes.colours import hexadecimal
from .clip import next_corners
from .colours import ColourArray
from .outline import DirectedEdge, GridPoint, outlines, polylines, straightened
from .painting import Painting

#: The number of grid points in a pixel: coordinates in the file are integers of this grid.
_GRID = 50

#: The line width, in pixels, with which polygons are stroked in their own colour, to hide seams.
_SEAM = 0.7

_INK = "#1a1c20"


def svg(painting: Painting, background: ColourArray | None, line: float) -> str:
    """Return a painting as the text of an SVG file.

    Parameters
    ----------
    painting : Painting
    background : (3,) uint8, optional
        The colour of the background; None for transparent.
    line : float
        The width of edges, in pixels.
    """
    width, height = painting.size
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}"'
        f' viewBox="0 0 {width * _GRID} {height * _GRID}">'
    )
    rules = (
        f"path{{stroke-width:{_SEAM * _GRID:g};stroke-linejoin:round;stroke-linecap:round}}"
        f".e{{fill:none;stroke:{_INK};stroke-width:{line * _GRID:g}}}"
    )
    lines = [head, f"<style>{rules}</style>"]
    if background is not None:
        lines.append(f'<rect width="100%" height="100%" fill="{_hex(background)}"/>')
    return "\n".join([*lines, *_paths(painting), "</svg>", ""])


def _hex(value: ColourArray) -> str:
    return hexadecimal((value / 255).tolist())


def _paths(painting: Painting) -> list[str]:
    polygons = painting.polygons
    spots = _grid_points(polygons.corners)
    after = next_corners(polygons.offsets).tolist()
    marked, starts = polygons.marked.tolist(), polygons.offsets.tolist()
    paths = []
    for _, members in groupby(range(len(painting.group)), key=painting.group.tolist().__getitem__):
        group = list(members)
        if painting.fills is not None:
            pieces = [_turned(spots[starts[i] : starts[i + 1]]) for i in group]
            paths += _filled(pieces, _hex(painting.fills[group[0]]))
        corners = (corner for i in group for corner in range(starts[i], starts[i + 1]))
        paths += _drawn([(spots[c], spots[after[c]]) for c in corners if marked[c]])
    ends = _grid_points(painting.lines.reshape(-1, 2))
    return paths + _drawn(list(zip(ends[::2], ends[1::2], strict=True)))


def _grid_points(points: FloatArray) -> list[GridPoint]:
    return [(x, y) for x, y in np.rint(points * _GRID).astype(np.int64).tolist()]


def _turned(polygon: list[GridPoint]) -> list[GridPoint]:
    """Return the polygon with positive area: itself or reversed."""
    pairs = zip(polygon, polygon[1:] + polygon[:1], strict=True)
    area = sum(ax * by - ay * bx for (ax, ay), (bx, by) in pairs)
    return polygon if area >= 0 else polygon[::-1]


def _filled(pieces: list[list[GridPoint]], fill: str) -> list[str]:
    loops = [straightened(loop) for loop in outlines(pieces)]
    path = "".join(_relative(loop) + "z" for loop in loops if len(loop) > 2)
    return [f'<path fill="{fill}" stroke="{fill}" d="{path}"/>'] if path else []


def _drawn(steps: list[DirectedEdge]) -> list[str]:
    path = "".join(map(_relative, polylines(steps)))
    return [f'<path class="e" d="{path}"/>'] if path else []


def _relative(spots: list[GridPoint]) -> str:
    """Return the path commands that go to the first point and then relatively to each next."""
    (x, y), *_ = spots
    steps = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(spots)]
    return f"M{x},{y}l" + " ".join(f"{dx},{dy}" for dx, dy in steps)
