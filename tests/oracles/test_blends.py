"""Chamfers and fillets of random solids, tested at points that they must or must not move."""

from typing import NamedTuple

import numpy as np
import pytest

import bspcsg as b
from support import drawn

#: The largest distance of a blend from its edge, in widths of the blend: where blends of a convex
#: and a concave edge meet, one begins a width from the edge and ends a square's diagonal farther.
FARTHEST = 1.01 * (1 + 2**0.5)

#: Bodies whose edges were forgotten, cut far from where they end, or met in a bend of no angle.
BROKEN = [994, 1075, 1117, 1558, 1657, 1866, 2265, 2484]


class Case(NamedTuple):
    body: b.Solid
    edges: b.EdgeSelection
    size: float
    is_round: bool
    segments: int

    def blended(self) -> b.Solid:
        if self.is_round:
            return self.body.fillet(self.edges, self.size, segments=self.segments)
        return self.body.chamfer(self.edges, self.size)

    def widths(self) -> np.ndarray:
        """Return the width of each blend on both faces."""
        return (
            self.size / np.tan(self._half())
            if self.is_round
            else np.full(len(self.edges), self.size)
        )

    def _half(self) -> np.ndarray:
        return np.radians(np.minimum(self.edges.angle, 360 - self.edges.angle)) / 2


def case_of(seed: int) -> Case | None:
    """Return a random solid of boxes and prisms with some of its edges; None if there are none."""
    rng = np.random.default_rng(seed)
    body = b.Solid.empty()
    for part in range(rng.integers(1, 4)):
        low = rng.integers(0, 6, 3)
        more = b.box(*rng.integers(2, 7, 3).tolist()).translate(low.tolist())
        kind = rng.integers(0, 5)
        if kind == 0:
            radius, height, sides = rng.integers((1, 3, 3), (4, 8, 9)).tolist()
            more = b.cylinder(radius, height, segments=sides).translate(low.tolist())
        if kind == 1:
            more = more.rotate((0, 0, float(rng.integers(1, 90))))
        body = body | more if not part or rng.random() < 0.6 else body - more
    if rng.random() < 0.3:
        body = body.rotate(tuple(rng.uniform(0, 360, 3).round(2).tolist()))
    edges = body.edges()
    edges = edges.where(rng.random(len(edges)) < rng.choice([0.1, 0.3, 0.6, 1.0]))
    size, is_round = float(rng.choice([0.01, 0.1, 0.25, 0.5, 1.0])), rng.random() >= 0.4
    segments = int(rng.choice([4, 8, 16, 32]))
    return Case(body, edges, size, is_round, segments) if len(edges) else None


def distances(points: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return the distance of each point from a segment."""
    along = ends[1] - ends[0]
    share = np.clip((points - ends[0]) @ along / (along @ along), 0, 1)
    return np.asarray(np.linalg.norm(points - ends[0] - share[:, None] * along, axis=1))


def reaches(case: Case) -> np.ndarray:
    """Return the largest possible distance of each blend from its edge, given its end planes."""
    around = case.body.edges()
    sines = []
    for ends, direction in zip(case.edges.ends, case.edges.direction, strict=True):
        meets = [(np.linalg.norm(around.ends - end, axis=2) < 1e-6).any(axis=1) for end in ends]
        leans = np.abs(around.normals[meets[0] | meets[1]].reshape(-1, 3) @ direction)
        sines.append(leans[leans > 1e-6].min(initial=1))
    return np.asarray(FARTHEST * case.widths() / np.array(sines))


def moved(case: Case, after: b.Solid, rng: np.random.Generator) -> np.ndarray:
    """Return random points whose side differs before and after the blends."""
    corners = after.vertices[rng.integers(0, len(after.vertices), 2000)]
    assert case.body.bounds is not None
    low, high = case.body.bounds
    near = [corners + rng.normal(0, share * case.size, (2000, 3)) for share in (0.02, 0.3)]
    points = np.concatenate([*near, rng.uniform(low - case.size, high + case.size, (2000, 3))])
    return points[case.body.classify(points) * after.classify(points) < 0]


def cut(case: Case) -> tuple[np.ndarray, np.ndarray]:
    """Return points at middles of edges that must change sides, and points beyond that must not."""
    inward = -case.edges.normals.sum(axis=1)
    away = np.where(case.edges.is_convex, 1, -1) / np.linalg.norm(inward, axis=1)
    inward = inward * away[:, None]
    half, widths = case._half(), case.widths()
    nearest = case.size / np.sin(half) - case.size if case.is_round else widths * np.cos(half)
    farthest = widths * np.cos(half) * 1.02
    middle = case.edges.middle
    at, beyond = (middle + inward * far[:, None] for far in (nearest / 2, farthest))
    clear = case.edges.length > 4 * widths
    others = [
        min(
            (distances(at[k : k + 1], ends)[0] for i, ends in enumerate(case.edges.ends) if i != k),
            default=np.inf,
        )
        for k in range(len(at))
    ]
    clear &= np.array(others) > 2.5 * widths.max()
    clear &= case.body.classify(beyond) == np.where(case.edges.is_convex, 1, -1)
    return at[clear], beyond[clear]


# Found: fillets and chamfers of convex and concave edges together left edges out without an error,
# cut far beyond the ends of edges, or ended in a `ValueError`.
@pytest.mark.parametrize("seed", [*drawn(range(60), 3), *BROKEN])
def test_blends_are_where_their_edges_are(seed: int) -> None:
    case = case_of(seed)
    if case is None:
        return
    try:
        after = case.blended()
    except b.InvalidParameterError:
        return  # no room, or kinds of edges that meet in a way without a blend
    points = moved(case, after, np.random.default_rng(seed))
    parts = zip(case.edges.ends, reaches(case), strict=True)
    assert np.any([distances(points, ends) <= reach for ends, reach in parts], axis=0).all()
    at, beyond = cut(case)
    assert (case.body.classify(at) * after.classify(at) == -1).all()
    assert (case.body.classify(beyond) == after.classify(beyond)).all()
