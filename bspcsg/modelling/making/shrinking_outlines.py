"""Shrinking outlines ("fronts") of a figure, for straight skeletons and roofs.

Each side of the outlines moves inwards at speed one, parallel to itself. A front changes when a
side shrinks to a point, or when a reflex corner hits another side; then the sides that meet there
are reconnected (Aichholzer et al., A Novel Type of Skeleton for Polygons, 1995). Events within a
distance of `nearness` count as simultaneous, so symmetric figures are not treated separately.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import numpy as np

from ..._types import BoolArray, FloatArray, IndexArray

#: The least sine of the angle between two sides at a corner that counts as a bend.
_STRAIGHT = 1e-12


@dataclass(frozen=True, eq=False)
class Walls:
    """The lines of a figure's sides, which move inwards at speed one.

    Parameters
    ----------
    directions, normals : (n, 2) float64
        Unit vectors along the sides, and perpendicular to them, to the left, which is inside.
    """

    directions: FloatArray
    normals: FloatArray

    def speeds(self, before: IndexArray, after: IndexArray) -> FloatArray:
        """Return the velocity of each corner, (n, 2), given the walls before and after it."""
        sums = self.normals[before] + self.normals[after]
        return np.asarray(2 * sums / np.square(sums).sum(axis=1)[:, None])

    def are_reflex(self, before: IndexArray, after: IndexArray) -> BoolArray:
        """Return a mask of the reflex corners, given the walls before and after each corner."""
        a, b = self.directions[before], self.directions[after]
        return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] < -_STRAIGHT)


@dataclass(frozen=True, eq=False)
class ShrinkingOutlines:
    """The corners of a figure's shrinking outlines (a "front"), each with its next corner.

    Parameters
    ----------
    node : (n,) int64
        The skeleton node at which each corner started.
    start_position : (n, 2) float64
    start_time : (n,) float64
        The position and the time at which each corner started.
    before, after : (n,) int64
        The walls of the sides that end and begin at each corner.
    following : (n,) int64
        The number of the next corner along the outline.
    walls : Walls
        The lines of the sides.
    """

    node: IndexArray
    start_position: FloatArray
    start_time: FloatArray
    before: IndexArray
    after: IndexArray
    following: IndexArray
    walls: Walls

    def __len__(self) -> int:
        """Return the number of corners."""
        return len(self.node)

    def at(self, time: float) -> FloatArray:
        """Return the positions of the corners at a time, (n, 2)."""
        return np.asarray(self.start_position + self.speeds() * (time - self.start_time)[:, None])

    def speeds(self) -> FloatArray:
        """Return the velocities of the corners, (n, 2)."""
        return self.walls.speeds(self.before, self.after)

    def next_time(self, now: float, nearness: float) -> float:
        """Return the next time at which a side vanishes or a corner hits one; infinity if never."""
        places, speeds = self.at(now), self.speeds()
        sides = self._next_vanishing(places, speeds)
        return now + min(sides, self._next_hit(places, speeds, nearness))

    def _lengths(self, places: FloatArray, speeds: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the signed lengths of the sides, and the rates at which they grow, (n,) each.

        A length is negative if the side runs against its wall's direction.
        """
        along = self.walls.directions[self.after]
        return tuple(
            ((ends[self.following] - ends) * along).sum(axis=1) for ends in (places, speeds)
        )

    def vanished(self, places: FloatArray, nearness: float) -> IndexArray:
        """Return the numbers of the shrinking sides whose length is at most `nearness`.

        A length may be negative by rounding, if other sides vanished at the same time.
        """
        lengths, growth = self._lengths(places, self.speeds())
        return np.flatnonzero((lengths <= nearness) & (growth < 0))

    def _next_vanishing(self, places: FloatArray, speeds: FloatArray) -> float:
        lengths, growth = self._lengths(places, speeds)
        shrinks = growth < 0
        times = lengths[shrinks] / -growth[shrinks]
        return max(float(times.min(initial=math.inf)), 0.0)

    def _next_hit(self, places: FloatArray, speeds: FloatArray, nearness: float) -> float:
        """Return the time until a reflex corner first hits a side; infinity if none ever does."""
        reflex = np.flatnonzero(self.walls.are_reflex(self.before, self.after))
        normals, along = self.walls.normals[self.after], self.walls.directions[self.after]
        levels = (places * normals).sum(axis=1)
        ahead = _products(places[reflex], normals) - levels
        closing = 1 - _products(speeds[reflex], normals)
        corner, side = np.nonzero((ahead > nearness) & (closing > 0))
        times = ahead[corner, side] / closing[corner, side]
        corner = reflex[corner]
        hits = places[corner] + speeds[corner] * times[:, None]
        ends = (side, self.following[side])
        first, last = (places[end] + speeds[end] * times[:, None] for end in ends)
        from_first = ((hits - first) * along[side]).sum(axis=1)
        to_last = ((last - hits) * along[side]).sum(axis=1)
        is_hit = (from_first >= -nearness) & (to_last >= -nearness)
        return float(times[is_hit].min(initial=math.inf))

    def touching(self, places: FloatArray, nearness: float) -> tuple[IndexArray, IndexArray]:
        """Return pairs of a corner and a side in whose interior it lies, as arrays of numbers."""
        normals, along = self.walls.normals[self.after], self.walls.directions[self.after]
        away = _products(places, normals) - (places * normals).sum(axis=1)
        corner, side = np.nonzero(np.abs(away) <= nearness)
        from_first = ((places[corner] - places[side]) * along[side]).sum(axis=1)
        to_last = ((places[self.following[side]] - places[corner]) * along[side]).sum(axis=1)
        inside = (from_first > nearness) & (to_last > nearness)
        return corner[inside], side[inside]


#: A part of a side between two consecutive spots: the start spot, the end spot, and the wall.
#: A spot is a point where corners have met.
SidePart: TypeAlias = tuple[int, int, int]


@dataclass(frozen=True, eq=False)
class Contacts:
    """The points at which corners and sides of shrinking outlines (a "front") meet at one time.

    A spot is the common position of corners that have met, or the position of a single corner. A
    piece is the part of a side between two consecutive spots.

    Parameters
    ----------
    time : float
    positions : (n, 2) float64
        Positions of the corners of the front.
    corners : list of list of int
        The corners at each spot.
    pieces : list of SidePart
        The parts of sides that continue to move; sides are divided at corners on them.
    ridges : list of (SidePart, SidePart)
        Pairs of pieces that have met over their whole length.
    pairs : list of list of (int, int)
        At each spot, the piece that ends and the piece that follows it, as numbers in `pieces`.
    """

    time: float
    positions: FloatArray
    corners: list[list[int]]
    pieces: list[SidePart]
    ridges: list[tuple[SidePart, SidePart]]
    pairs: list[list[tuple[int, int]]]

    @property
    def is_clear(self) -> bool:
        """True if each part of a side that continues to move has a successor on the outline."""
        return sum(map(len, self.pairs)) == len(self.pieces)

    def walls_of(self, pair: tuple[int, int]) -> tuple[int, int]:
        """Return the walls of two parts of sides, given by their numbers in `pieces`."""
        ending, beginning = pair
        return self.pieces[ending][2], self.pieces[beginning][2]

    def is_calm(self, point: int, front: ShrinkingOutlines) -> bool:
        """Return True if only one corner is at a spot, and its two walls stay the same."""
        [corner, *others] = self.corners[point]
        walls = int(front.before[corner]), int(front.after[corner])
        return not others and [walls] == [self.walls_of(pair) for pair in self.pairs[point]]


def contacts_at(front: ShrinkingOutlines, time: float, nearness: float) -> Contacts:
    """Return where corners and sides of shrinking outlines meet at a time.

    Distances up to `nearness` count as contact.
    """
    places = front.at(time)
    ended = front.vanished(places, nearness)
    spots = _contact_groups(places, np.column_stack([ended, front.following[ended]]), nearness)
    corners: list[list[int]] = [[] for _ in range(int(spots.max(initial=-1)) + 1)]
    for corner, spot in enumerate(spots.tolist()):
        corners[spot].append(corner)
    pieces, ridges = _without_ridges(_side_parts(front, places, spots, nearness))
    pairs = _joined(pieces, front.walls)
    following = [pairs.get(spot, []) for spot in range(len(corners))]
    return Contacts(time, places, corners, pieces, ridges, following)


def _products(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return the dot products of all pairs of plane vectors of two lists, (m, n).

    With two columns, a BLAS library is slower, since its threads would wait for each other.
    """
    return np.asarray(one[:, :1] * other[:, 0] + one[:, 1:] * other[:, 1])


def _contact_groups(places: FloatArray, pairs: IndexArray, nearness: float) -> IndexArray:
    """Return a group number for each position, equal for positions near each other or paired.

    The relation is transitive: two positions that are both near a third are in one group.
    """
    parent = list(range(len(places)))

    def root(one: int) -> int:
        while parent[one] != one:
            parent[one] = one = parent[parent[one]]
        return one

    for one, other in [*_near_pairs(places, nearness), *pairs.tolist()]:
        parent[root(one)] = root(other)
    roots = [root(one) for one in range(len(places))]
    return np.unique(np.array(roots, dtype=np.int64), return_inverse=True)[1]


def _near_pairs(places: FloatArray, nearness: float) -> Iterator[tuple[int, int]]:
    order = np.argsort(places[:, 0], kind="stable")
    ordered = places[order]
    for step in range(1, len(places)):
        gaps = ordered[step:] - ordered[:-step]
        if gaps[:, 0].min() > nearness:
            break
        for one in np.flatnonzero(np.abs(gaps).max(axis=1) <= nearness).tolist():
            yield int(order[one]), int(order[one + step])


def _side_parts(
    front: ShrinkingOutlines, places: FloatArray, numbers: IndexArray, nearness: float
) -> list[SidePart]:
    """Return the sides of shrinking outlines, divided where a corner lies inside a side.

    `numbers` has, for each corner, the number of the point at which it is.
    """
    on_side: dict[int, list[tuple[float, int]]] = defaultdict(list)
    for corner, side in zip(*map(np.ndarray.tolist, front.touching(places, nearness)), strict=True):
        along = float((places[corner] - places[side]) @ front.walls.directions[front.after[side]])
        on_side[side].append((along, int(numbers[corner])))
    pieces = []
    for side, wall in enumerate(front.after.tolist()):
        ends = int(numbers[side]), int(numbers[front.following[side]])
        way = [ends[0], *(number for _, number in sorted(on_side[side])), ends[1]]
        pieces += [(a, b, wall) for a, b in pairwise(way) if a != b]
    return pieces


def _without_ridges(
    pieces: Sequence[SidePart],
) -> tuple[list[SidePart], list[tuple[SidePart, SidePart]]]:
    """Return the parts of sides that continue to move, and pairs of opposite parts that met."""
    left: dict[tuple[int, int], list[SidePart]] = defaultdict(list)
    ridges = []
    for piece in pieces:
        start, end, _ = piece
        if left[end, start]:
            ridges.append((left[end, start].pop(), piece))
        else:
            left[start, end].append(piece)
    return [piece for some in left.values() for piece in some], ridges


def _joined(pieces: Sequence[SidePart], walls: Walls) -> dict[int, list[tuple[int, int]]]:
    """Return, for each point, pairs of a part of a side that ends and one that begins there.

    The parts, `pieces`, are given by their numbers. Between the two parts of a pair is a sector of
    the inside, which is left of each part: counter-clockwise around the point, the ending part
    comes next after the beginning one.
    """
    rays: dict[int, list[tuple[float, int, int]]] = defaultdict(list)
    for number, (start, end, wall) in enumerate(pieces):
        x, y = walls.directions[wall].tolist()
        rays[start].append((math.atan2(y, x), 1, number))
        rays[end].append((math.atan2(-y, -x), 0, number))
    return {place: _sectors(sorted(around)) for place, around in rays.items()}


def _sectors(around: Sequence[tuple[float, int, int]]) -> list[tuple[int, int]]:
    found = []
    for k, (_, begins, number) in enumerate(around):
        _, other_begins, other = around[(k + 1) % len(around)]
        if begins and not other_begins:
            found.append((other, number))
    return found
