"""Roofs over plane figures, with a slope of 45 degrees on all sides."""

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from ..._types import FloatArray
from ...bsp import Region
from ...errors import LimitError
from ...geometry.polygon import signed_area, triangulate
from ...operations import setops
from ...solid.solid import Solid
from .shrinking_outlines import Contacts, ShrinkingOutlines, SidePart, Walls, contacts_at

#: The largest number of corners of one connected part of a figure. The time grows with its cube.
_MAX_CORNERS = 1000

#: Corners and sides have met if their distance is below this, relative to the figure's extent.
_NEAR = 1e-8

#: The largest relative error of a roof: of the area that its sides cover, and of the distance of
#: its nodes from the planes of the sides.
_OFF = 1e-6


def roof(figure: Region) -> Solid:
    """Return the roof over a bounded figure, with a slope of 45 degrees on all sides.

    A plane rises from each side of the outline; the planes meet above the straight skeleton of the
    figure.

    Raises
    ------
    LimitError
        If a part of the figure has more than 1,000 corners, or doubles cannot decide how its sides
        meet.

    Examples
    --------
    >>> from bspcsg import Region
    >>> from bspcsg.modelling.making.roofs import roof
    >>> roof(Region.rectangle(6, 6)).volume
    36.0
    """
    return setops.union([_roof_of_part(part.to_polygons()) for part in figure.components])


def is_convex(figure: Region) -> bool:
    """Return True if a figure has no reflex corner, and hence no hole."""
    for loop in figure.to_polygons():
        front = _first_outlines([loop])
        if front.walls.are_reflex(front.before, front.after).any():
            return False
    return True


def corner_speeds(figure: Region) -> FloatArray:
    """Return the displacement of each corner if all sides move inwards by 1, (n, 2)."""
    return np.concatenate([_first_outlines([loop]).speeds() for loop in figure.to_polygons()])


def _roof_of_part(loops: Sequence[FloatArray]) -> Solid:
    count = sum(map(len, loops))
    if count > _MAX_CORNERS:
        message = (
            f"a part of the roof has {count:,} corners, and at most {_MAX_CORNERS:,} are allowed;"
            " simplify its outline."
        )
        raise LimitError(message, "too_large")
    building = _RoofBuilder(loops)
    building.raise_sides()
    return building.solid(sum(map(signed_area, loops)))


def _first_outlines(loops: Sequence[FloatArray]) -> ShrinkingOutlines:
    points = np.concatenate(loops)
    sides = np.concatenate([np.roll(loop, -1, axis=0) - loop for loop in loops])
    directions = sides / np.linalg.norm(sides, axis=1)[:, None]
    walls = Walls(directions, np.column_stack([-directions[:, 1], directions[:, 0]]))
    starts = np.cumsum([0, *map(len, loops)])[:-1]
    numbers = [start + np.arange(len(loop)) for start, loop in zip(starts, loops, strict=True)]
    before = np.concatenate([np.roll(one, 1) for one in numbers])
    following = np.concatenate([np.roll(one, -1) for one in numbers])
    own = np.arange(len(points))
    return ShrinkingOutlines(own, points, np.zeros(len(points)), before, own, following, walls)


class _RoofBuilder:
    """A roof under construction: its nodes (points), and the edges of each roof side."""

    def __init__(self, loops: Sequence[FloatArray]) -> None:
        self._front = _first_outlines(loops)
        self._points = self._front.start_position
        self._walls = self._front.walls
        self._nearness = _NEAR * float(np.ptp(self._points, axis=0).max())
        self._nodes: list[tuple[float, float, float]] = []
        self._bounds: list[list[tuple[int, int]]] = [[] for _ in self._points]
        self._base: list[SidePart] = []

    def raise_sides(self) -> None:
        """Shrink the outline until it vanishes, and record the edges of the roof on the way.

        Raise `LimitError` if doubles cannot decide how the sides meet.
        """
        now = 0.0
        self._change(now)
        for _ in range(8 * len(self._points)):
            if not len(self._front):
                return
            now = self._front.next_time(now, self._nearness)
            if now == np.inf:
                break
            self._change(now)
        raise _unclear()

    def _change(self, now: float) -> None:
        """Reconnect the shrinking outline where corners and sides meet at a time."""
        contacts = contacts_at(self._front, now, self._nearness)
        if not contacts.is_clear:
            raise _unclear()
        nodes = self._nodes_of(contacts)
        if now == 0:
            self._base = [(nodes[a], nodes[b], wall) for a, b, wall in contacts.pieces]
            for low, high, wall in self._base:
                self._bounds[wall].append((low, high))
        for (a, b, wall), (_, _, other) in contacts.ridges:
            self._bounds[wall].append((nodes[b], nodes[a]))
            self._bounds[other].append((nodes[a], nodes[b]))
        self._front = self._next_front(contacts, nodes)

    def _nodes_of(self, contacts: Contacts) -> dict[int, int]:
        """Make a roof node at each point where the outline changes, and record the edges to it.

        Return a dictionary from the number of such a point in `contacts` to the number of its node.
        """
        front, nodes = self._front, {}
        for spot, corners in enumerate(contacts.corners):
            if contacts.time > 0 and contacts.is_calm(spot, front):
                continue
            x, y = contacts.positions[corners].mean(axis=0).tolist()
            nodes[spot] = len(self._nodes)
            self._nodes.append((x, y, contacts.time))
            # At time 0 the corners are on the floor, and no edge leads to their nodes.
            for corner in corners if contacts.time > 0 else ():
                ahead, behind = int(front.before[corner]), int(front.after[corner])
                self._trace(int(front.node[corner]), nodes[spot], ahead, behind)
        return nodes

    def _trace(self, low: int, high: int, ahead: int, behind: int) -> None:
        """Record a roof edge between two nodes, along which two sides of the roof meet."""
        if ahead != behind:
            self._bounds[ahead].append((low, high))
            self._bounds[behind].append((high, low))

    def _next_front(self, contacts: Contacts, nodes: dict[int, int]) -> ShrinkingOutlines:
        """Return the shrinking outline after a change: unchanged corners, and new ones at nodes."""
        rows: list[tuple[int, int, int, int]] = []
        origins: list[tuple[float, float, float]] = []
        begun: dict[int, int] = {}
        for spot, pairs in enumerate(contacts.pairs):
            corner = contacts.corners[spot][0]
            node = nodes[spot] if spot in nodes else int(self._front.node[corner])
            for pair in pairs:
                begun[pair[0]] = len(rows)
                rows.append((node, *contacts.walls_of(pair), pair[1]))
                origins.append(self._nodes[node])
        node_of, before, after, piece = np.array(rows, dtype=np.int64).reshape(-1, 4).T
        origin = np.array(origins, dtype=np.float64).reshape(-1, 3)
        following = np.array([begun[one] for one in piece.tolist()], dtype=np.int64)
        where, since = origin[:, :2], origin[:, 2]
        return ShrinkingOutlines(node_of, where, since, before, after, following, self._walls)

    def solid(self, area: float) -> Solid:
        """Return the finished roof over a floor of the given area.

        Raises
        ------
        LimitError
            If the roof's sides do not cover the floor, or a node is not in the plane of a side.
        """
        nodes = np.array(self._nodes)
        rings = [(wall, ring) for wall, edges in enumerate(self._bounds) for ring in _rings(edges)]
        covered = 0.0
        triangles = []
        for wall, ring in rings:
            corners = nodes[ring]
            away = (corners[:, :2] - self._points[wall]) @ self._walls.normals[wall]
            if np.abs(away - corners[:, 2]).max() > _OFF / _NEAR * self._nearness:
                raise _unclear()
            triangles.append(np.array(ring)[triangulate([corners[:, :2]])])
            a, b, c = (nodes[triangles[-1][:, k], :2] for k in range(3))
            across = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
            # Overlaps and inverted parts make the sum exceed the area.
            covered += float(np.abs(across).sum()) / 2
        if abs(covered - area) > _OFF * area:
            raise _unclear()
        floor = _rings([(a, b) for a, b, _ in self._base])
        below = np.concatenate(floor)[triangulate([nodes[ring][:, :2] for ring in floor])]
        return Solid(nodes, np.concatenate([*triangles, below[:, ::-1]]))


def _rings(edges: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Divide directed edges into closed rings that visit no node twice, as node numbers."""
    leaving = defaultdict(list)
    for start, end in edges:
        leaving[start].append(end)
    rings = []
    for first in list(leaving):
        way = [first]
        while leaving[way[-1]]:
            node = leaving[way[-1]].pop()
            if node in way:
                at = way.index(node)
                rings.append(way[at:])
                del way[at + 1 :]
            else:
                way.append(node)
    return [ring for ring in rings if len(ring) > 2]


def _unclear() -> LimitError:
    message = (
        "the sides of the roof nearly coincide somewhere, so doubles cannot decide how they meet;"
        " simplify the outline of the roof."
    )
    return LimitError(message, "not_told_apart")
