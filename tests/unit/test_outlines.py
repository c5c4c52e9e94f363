"""Triangulation of outlines with many corners, and of outlines that touch or cross."""

from collections import Counter
from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from bspcsg._types import FloatArray, IndexArray
from bspcsg.geometry.polygon import contours_of, directed_edges, signed_area, triangulate
from support.timing import seconds


def ring(count: int, radius: float, x: float = 0.0, y: float = 0.0) -> FloatArray:
    """Return a regular polygon of `count` corners, counterclockwise."""
    angles = 2 * np.pi * np.arange(count) / count
    return np.column_stack([x + radius * np.cos(angles), y + radius * np.sin(angles)])


def plate(side: int) -> list[FloatArray]:
    """Return the outlines of a square with rows of round holes."""
    size = 3.0 * side
    outer = np.array([(0, 0), (size, 0), (size, size), (0, size)])
    places = [(3 * i + 1.5, 3 * j + 1.5) for i in range(side) for j in range(side)]
    return [outer, *(ring(12, 1, x, y)[::-1] for x, y in places)]


def comb(teeth: int) -> list[FloatArray]:
    """Return the outline of a bar with teeth that point downwards."""
    x = 2.0 * np.arange(teeth)
    steps = [(x, 0 * x), (x + 1, 0 * x), (x + 1, 0 * x + 9), (x + 2, 0 * x + 9)]
    points = np.stack([np.column_stack(pair) for pair in steps], axis=1).reshape(-1, 2)
    return [np.concatenate([points, [(2.0 * teeth, 10.0), (0.0, 10.0)]])]


def areas(contours: list[FloatArray], triangles: IndexArray) -> FloatArray:
    """Return the signed areas of triangles, negative for clockwise ones."""
    a, b, c = np.concatenate(contours)[triangles].transpose(1, 0, 2)
    u, v = b - a, c - a
    doubled: FloatArray = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    return doubled / 2


@pytest.mark.parametrize("make", [lambda: plate(9), lambda: comb(120), lambda: [ring(1000, 5)]])
def test_outlines_of_many_corners_become_triangles_that_do_not_overlap(
    make: Callable[[], list[FloatArray]],
) -> None:
    contours = make()
    found = areas(contours, triangulate(contours))
    assert (found > 0).all()
    assert found.sum() == pytest.approx(sum(signed_area(contour) for contour in contours))
    assert len(found) == sum(map(len, contours)) + 2 * (len(contours) - 2)


def test_outlines_of_many_corners_that_touch_or_cross_keep_their_edges() -> None:
    turns = 4 * np.pi * np.arange(301) / 301
    pentagram = np.column_stack([np.cos(turns), np.sin(turns)])
    touching = [ring(300, 1), ring(300, 1, 2.0)]
    touching[1][150] = touching[0][0]
    crossed = [ring(300, 2), ring(300, 1)[::-1], ring(300, 2, 1)]
    for contours in ([pentagram], touching, [ring(300, 2), ring(300, 2, 1)], crossed):
        triangles = triangulate(contours)
        assert keeps_edges(contours, triangles)
        found = areas(contours, triangles).sum()
        assert found == pytest.approx(sum(signed_area(contour) for contour in contours))


def keeps_edges(contours: list[FloatArray], triangles: IndexArray) -> bool:
    """Return true if the triangles' edges cancel except for the edges of the contours."""
    corners = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).tolist()
    left = Counter(map(tuple, corners)) - Counter((b, a) for a, b in corners)
    return left == Counter(map(tuple, directed_edges(contours).tolist()))


def test_a_crossing_spoils_few_of_many_triangles() -> None:
    contour = ring(2000, 1)
    contour[[700, 701]] = contour[[701, 700]]
    found = areas([contour], triangulate([contour]))
    assert np.count_nonzero(found <= 0) < 5
    # With needles alone, import takes the square of their number.
    assert np.count_nonzero(found > 0.1) > 1


# Found: rounding folds a line, and the process ended where manifold3d ran out of stack.
def test_any_number_of_corners_on_a_line_become_triangles() -> None:
    line = np.arange(50_000)[:, None] * np.array([0.3, 0.7])
    assert keeps_edges([line], triangulate([line]))


# Found: outlines of thousands of holes or teeth cost their square where they become triangles,
# and holes 2 ms each where they are found.
def test_many_corners_cost_each_alike() -> None:
    for few, many in ((plate(25), plate(50)), (comb(2000), comb(8000))):
        least, most = (seconds(partial(triangulate, one), 3) for one in (few, many))
        assert most < 10 * least
    assert seconds(lambda: contours_of(plate(50)), 3) < 2
