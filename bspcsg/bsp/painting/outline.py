"""Common outlines of several polygons: opposite edges cancel."""

from collections import Counter, defaultdict
from collections.abc import Iterable

#: A point on a grid.
Spot = tuple[int, int]

#: From one point to the next.
Step = tuple[Spot, Spot]


def outlines(polygons: Iterable[list[Spot]]) -> list[list[Spot]]:
    """Return closed outlines with the total winding numbers of the polygons.

    Parameters
    ----------
    polygons : iterable of list of (int, int)
        All with the same orientation.
    """
    return _chained(_uncancelled(polygons))


def _uncancelled(polygons: Iterable[list[Spot]]) -> "Counter[Step]":
    counts: Counter[Step] = Counter()
    for polygon in polygons:
        for start, end in zip(polygon, polygon[1:] + polygon[:1], strict=True):
            if start == end:
                continue
            if counts[end, start] > 0:
                counts[end, start] -= 1
            else:
                counts[start, end] += 1
    return counts


def _chained(counts: "Counter[Step]") -> list[list[Spot]]:
    """Return loops over all edges; any choice of loops gives the same winding numbers."""
    onwards: defaultdict[Spot, list[Spot]] = defaultdict(list)
    for start, end in counts.elements():
        onwards[start].append(end)
    loops = []
    for start in list(onwards):
        while onwards[start]:
            loops.append(_loop(onwards, start))
    return [loop for loop in loops if len(loop) > 2]


def _loop(onwards: "defaultdict[Spot, list[Spot]]", start: Spot) -> list[Spot]:
    loop, spot = [start], onwards[start].pop()
    while spot != start:
        loop.append(spot)
        spot = onwards[spot].pop()
    return loop


def straightened(loop: list[Spot]) -> list[Spot]:
    """Return a loop without corners that lie straight between their neighbours."""
    corners = []
    before = loop[-1]
    for spot, after in zip(loop, loop[1:] + loop[:1], strict=True):
        (ax, ay), (bx, by), (cx, cy) = before, spot, after
        if (bx - ax) * (cy - by) != (by - ay) * (cx - bx):
            corners.append(spot)
            before = spot
    return corners


def polylines(steps: Iterable[Step]) -> list[list[Spot]]:
    """Return open or closed lines that cover each step once, in either direction."""
    links: defaultdict[Spot, set[Spot]] = defaultdict(set)
    for start, end in steps:
        if start != end:
            links[start].add(end)
            links[end].add(start)
    # First the lines from ends and forks; the remaining ones are closed.
    forks = [spot for spot, ways in links.items() if len(ways) != 2]
    lines = []
    for start in forks + list(links):
        while links[start]:
            lines.append(_line(links, start))
    return lines


def _line(links: "defaultdict[Spot, set[Spot]]", start: Spot) -> list[Spot]:
    line = [start]
    while links[line[-1]]:
        spot = line[-1]
        after = min(links[spot])
        links[spot].discard(after)
        links[after].discard(spot)
        line.append(after)
    return line
