"""Regions without trees: results of sweeps over boundaries, of bounds and of boxes."""

from fractions import Fraction

import numpy as np
import pytest
import shapely

from bspcsg import Region
from bspcsg._types import FloatArray
from bspcsg.bsp import ObjectTree
from support.timing import seconds

RANDOM = np.random.default_rng(16)


def tangle(corners: int = 40, size: int = 30) -> Region:
    """Return a region whose outline crosses itself, so that most corners are off the lattice."""
    return Region(RANDOM.integers(0, size, (corners, 2)).astype(float), winding="even-odd")


def circles(count: int) -> list[Region]:
    middles = np.random.default_rng(count).random((count, 2))
    return [Region.circle(1 / count**0.5, 32).translate(*middle.tolist()) for middle in middles]


def test_a_composition_is_exact() -> None:
    """Corners between lattice points go in as they are, and unbounded regions may be among them."""
    first, second = tangle(), tangle().translate(7, 3)
    assert any(x.denominator % 7 == 0 for loop in first.exact_outlines for x, _ in loop)
    assert Region.compose([first, second]) == first | second
    half, coarse = Region.half_plane((1, 0), 11), Region([(0, 0), (9, 0), (9, 9)], pitch=-3)
    union = Region.compose([first, half, coarse, second])
    assert union == first | half | coarse | second
    assert not union.is_bounded
    assert Region.compose([]).is_empty
    assert Region.compose([~first, second, first]).is_full


@pytest.mark.parametrize("seed", range(5))
def test_an_area_is_rounded_once(seed: int) -> None:
    region = tangle(20 + 10 * seed).scale(0.37) - tangle()
    assert region.area == float(region.area_exact)
    assert region.area_exact == region.tree.measure
    x, y = region.centroid_exact or (Fraction(0), Fraction(0))
    assert region.centroid.tolist() == [float(x), float(y)]


def test_points_lie_the_same_with_a_tree_and_without() -> None:
    region, points = tangle(), RANDOM.integers(0, 60, (500, 2)) / 2
    swept = region.classify(points)
    assert set(swept.tolist()) == {-1, 0, 1}
    assert region.tree.stats()["nodes"] > 40
    assert region.classify(points).tolist() == swept.tolist()
    assert (~region).classify(points).tolist() == (-swept).tolist()


def brute_force(region: Region, points: FloatArray) -> FloatArray:
    rings = shapely.boundary(region.to_shapely())
    found: FloatArray = shapely.distance(rings, shapely.points(points))
    return found


def test_nearest_points_are_those_of_all_edges() -> None:
    region = Region.compose(circles(60)) - tangle(12, 2)
    points = RANDOM.random((300, 2)) * 3 - 1
    nearest, distance = region.nearest(points)
    assert np.abs(distance - brute_force(region, points)).max() < 1e-12
    assert np.abs(np.hypot(*(nearest - points).T) - distance).max() < 1e-15
    assert brute_force(region, nearest).max() < 1e-12


def test_nearest_points_on_edges_as_long_as_the_lattice() -> None:
    """The edge's length does not spoil the place along it; its ends are rounded at their size."""
    points = [(0.1, 3), (-1, 7), (4, -3), (1 / 3, 1e-9)]
    nearest, _ = Region.half_plane((0, 1), 0).nearest(points)
    assert nearest.tolist() == [[x, 0] for x, _ in points]
    slanted, _ = Region.half_plane((3, 4), 0).nearest([(3, 4), (-1, 7)])
    assert np.abs(slanted - [(0, 0), (-4, 3)]).max() < 2**53 * 1e-9 * 2**-53


def test_trees_of_regions_are_those_of_their_boundaries() -> None:
    """Whatever operations a region comes from, its tree divides what is there."""
    once, again = Region.compose(circles(30)), Region.compose(reversed(circles(30)))
    assert once.tree.stats() == again.tree.stats()
    assert once.tree.boundary().vertices.tolist() == again.tree.boundary().vertices.tolist()
    assert isinstance(once.tree, ObjectTree)
    assert once.tree == again.tree


def test_unbounded_regions_that_grew_move() -> None:
    """Their boundaries end at the border of the lattice, which does not move."""
    region = Region.half_plane((1, 2), 0)
    for k in range(30):
        region |= Region.circle(1, 9).translate(3 * k, 2)
    points = RANDOM.random((200, 2)) * (90, 6)
    moved = region.translate(5, -1).rotate(90)
    assert not moved.is_bounded
    images = (points + (5, -1)) @ [(0, 1), (-1, 0)]
    assert moved.classify(images).tolist() == region.classify(points).tolist()


def test_shapely_shapes_come_in_and_go_out_in_linear_time() -> None:
    def there_and_back(count: int) -> float:
        squares = [
            shapely.box(3 * i, 3 * j, 3 * i + 1, 3 * j + 1) for i in range(count) for j in range(20)
        ]
        shape = shapely.MultiPolygon(squares)
        assert Region(shape).to_shapely().area == 20 * count
        return seconds(lambda: Region(shape).to_shapely(), 3)

    # Four times as many cost four times as much, or sixteen times where something is quadratic.
    assert there_and_back(80) < 10 * there_and_back(20)


def test_many_circles_unite_at_once_in_linear_time() -> None:
    few, many = circles(100), circles(400)
    assert seconds(lambda: Region.compose(many), 3) < 10 * seconds(lambda: Region.compose(few), 3)
