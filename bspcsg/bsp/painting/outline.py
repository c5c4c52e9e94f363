"""Merge polygons into common outlines, in which opposite edges cancel."""

from collections import Counter, defaultdict
from collections.abc import Iterable

#: A point on a grid, as two integers.
GridPoint = tuple[int, int]

#: A directed edge: its start and its end point.
DirectedEdge = tuple[GridPoint, GridPoint]


def outlines(polygons: Iterable[list[GridPoint]]) -> list[list[GridPoint]]:
    """Return closed loops; their winding number at a point is the sum of the polygons'.

    Parameters
    ----------
    polygons : iterable of list of (int, int)
        Polygons that all have the same orientation.
    """
    return _chained(_uncancelled(polygons))


def _uncancelled(polygons: Iterable[list[GridPoint]]) -> "Counter[DirectedEdge]":
    counts: Counter[DirectedEdge] = Counter()
    for polygon in polygons:
        for start, end in zip(polygon, polygon[1:] + polygon[:1], strict=True):
            if start == end:
                continue
            if counts[end, start] > 0:
                counts[end, start] -= 1
            else:
                counts[start, end] += 1
    return counts


def _chained(counts: "Counter[DirectedEdge]") -> list[list[GridPoint]]:
    """Return closed loops that use each directed edge as often as `counts` says.

    Any choice of loops gives the same winding numbers.
    """
    onwards: defaultdict[GridPoint, list[GridPoint]] = defaultdict(list)
    for start, end in counts.elements():
        onwards[start].append(end)
    loops = []
    for start in list(onwards):
        while onwards[start]:
            loops.append(_loop(onwards, start))
    return [loop for loop in loops if len(loop) > 2]


def _loop(onwards: "defaultdict[GridPoint, list[GridPoint]]", start: GridPoint) -> list[GridPoint]:
    loop, spot = [start], onwards[start].pop()
    while spot != start:
        loop.append(spot)
        spot = onwards[spot].pop()
    return loop


def straightened(loop: list[GridPoint]) -> list[GridPoint]:
    """Return a loop without the corners at which it goes straight on."""
    corners = []
    before = loop[-1]
    for spot, after in zip(loop, loop[1:] + loop[:1], strict=True):
        (ax, ay), (bx, by), (cx, cy) = before, spot, after
        if (bx - ax) * (cy - by) != (by - ay) * (cx - bx):
            corners.append(spot)
            before = spot
    return corners


def polylines(steps: Iterable[DirectedEdge]) -> list[list[GridPoint]]:
    """Return open or closed polylines that cover each edge once, in either direction."""
    links: defaultdict[GridPoint, set[GridPoint]] = defaultdict(set)
    for start, end in steps:
        if start != end:
            links[start].add(end)
            links[end].add(start)
    # Start at ends and forks first; the edges that remain then form closed loops.
    forks = [spot for spot, ways in links.items() if len(ways) != 2]
    lines = []
    for start in forks + list(links):
        while links[start]:
            lines.append(_line(links, start))
    return lines


def _line(links: "defaultdict[GridPoint, set[GridPoint]]", start: GridPoint) -> list[GridPoint]:
    line = [start]
    while links[line[-1]]:
        spot = line[-1]
        after = min(links[spot])
        links[spot].discard(after)
        links[after].discard(spot)
        line.append(after)
    return line
