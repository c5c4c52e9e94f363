"""Cases of Apache Commons Geometry for sets of the plane, with their expected results.

From RegionBSPTree2DTest.java of commons-geometry-euclidean. What differs there: trees can be
changed, rectangles have two opposite corners, an unbounded size is infinite (here it is refused),
and paths of unbounded boundaries have ends at infinity (here the boundary's pieces end at the
border of the lattice).
"""

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from bspcsg import InvalidParameterError, Region, UnboundedError
from bspcsg.bsp import ObjectTree

HALF = Region.half_plane((0, -1))  # y >= 0: the minus side of the x axis
QUADRANT = HALF & Region.half_plane((1, 0))  # of the y axis, too
TRIANGLE = Region([(0, 0), (1, 0), (2, 1)])


def rect(x: float, y: float, width: float, height: float) -> Region:
    return Region.rectangle(width, height).translate(x, y)


def corners(region: Region) -> list[list[list[float]]]:
    return [outline.points.tolist() for outline in region.outlines]


def sides(region: Region, points: Any) -> list[int]:
    return region.classify(points).tolist()  # type: ignore[no-any-return]


def test_full_and_empty() -> None:
    """testCtor_booleanArg_true and _false, testFull_ and testEmpty_factoryMethod."""
    assert Region.full().is_full
    assert not Region.full().is_empty
    assert Region.full().tree.stats()["leaves"] == 1
    assert Region().is_empty
    assert Region.empty() == Region()
    assert Region.empty().tree.stats()["leaves"] == 1


def test_convex_parts() -> None:
    """testToConvex_full, _empty, _halfSpace, _quadrantComplement, _square, _multipleConvexAreas.

    Convex parts of unbounded sets are refused here.
    """
    assert Region.empty().convex_parts() == []
    for unbounded in (Region.full(), HALF):
        with pytest.raises(UnboundedError):
            unbounded.convex_parts()
    (square,) = rect(0, 0, 1, 1).convex_parts()
    assert Region([square]) == rect(0, 0, 1, 1)
    # A square along whose diagonal two segments run against each other: the tree may cut there.
    triangles = Region([[(0, 0), (1, 1), (0, 1)], [(0, 0), (1, 0), (1, 1)]])
    assert triangles == rect(0, 0, 1, 1)
    assert sum(Region([part]).area_exact for part in triangles.convex_parts()) == 1


def test_places() -> None:
    """checkClassify of testToConvex_halfSpace, _quadrantComplement and _square."""
    assert sides(HALF, [(0, 1), (0, 0), (0, -1)]) == [1, 0, -1]
    quarter = ~(Region.half_plane((0, 1)) | Region.half_plane((1, 0)))
    found = sides(quarter, [(1, 1), (0, 0), (1, 0), (0, 1), (1, -1), (-1, -1), (-1, 1)])
    assert found == [1, 0, 0, 0, -1, -1, -1]
    square = rect(0, 0, 1, 1)
    found = sides(square, [(0.5, 0.5), (0, 0), (1, 1), (0.5, -1), (0.5, 2), (-1, 0.5), (2, 0.5)])
    assert found == [1, 0, 0, -1, -1, -1, -1]


def test_node_regions() -> None:
    """testGetNodeRegion: the parts into which two lines cut the plane."""
    ring = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)]
    left = HALF & Region.half_plane((1, 0))
    assert sides(HALF, ring) == [0, 1, 1, 1, 0, -1, -1, -1]
    assert sides(left, ring) == [-1, -1, 0, 1, 0, -1, -1, -1]
    assert sides(HALF - left, ring) == [0, 1, 0, -1, -1, -1, -1, -1]


def test_splits() -> None:
    """testSplit_full, _empty, _bothSides, _plusSideOnly and _minusSideOnly.

    Both halves of a split are always sets here, empty where nothing is on a side.
    """
    minus, plus = Region.full().split((1, -1), 1)
    assert (sides(minus, [(0, 1), (1, -1)]), sides(plus, [(0, 1), (1, -1)])) == ([1, -1], [-1, 1])
    assert [half.is_empty for half in Region.empty().split((1, -1), 1)] == [True, True]
    both = rect(0, 0, 2, 1)
    minus, plus = both.split((1, -1), 0)
    assert corners(minus) == [[[0, 0], [1, 1], [0, 1]]]
    assert corners(plus) == [[[0, 0], [2, 0], [2, 1], [1, 1]]]
    minus, plus = both.split((1, -1), -1)
    assert minus.is_empty
    assert plus == both
    minus, plus = both.split((-1, 1), 1)
    assert plus.is_empty
    assert minus == both


@pytest.mark.parametrize("region", [Region.full(), HALF, ~HALF, QUADRANT, ~QUADRANT])
def test_measures_of_unbounded_sets(region: Region) -> None:
    """testGeometricProperties_full, _halfSpace, _quadrant and their complements."""
    for ask in ("area", "centroid", "outlines"):
        with pytest.raises(UnboundedError):
            getattr(region, ask)
    assert region.is_full or len(region.tree.boundary()) in (1, 2)


def test_measures_of_nothing() -> None:
    """testGeometricProperties_empty."""
    assert Region.empty().area == Region.empty().perimeter == Region.full().perimeter == 0
    assert np.isnan(Region.empty().centroid).all()
    assert Region.empty().outlines == ()


def test_boundaries_of_a_quadrant() -> None:
    """testGeometricProperties_quadrant: two rays that meet in the origin."""
    pieces = QUADRANT.tree.boundary()
    ends = {tuple(corner) for k in range(len(pieces)) for corner in pieces[k].tolist()}
    assert (0, 0) in ends
    assert len(pieces) == 2
    assert all(tuple(c) == (0, 0) or max(map(abs, c)) > 9e6 for c in ends)


def test_a_triangle() -> None:
    """testGeometricProperties_closedRegion and _complementedClosedRegion."""
    assert TRIANGLE.area_exact == Fraction(1, 2)
    assert TRIANGLE.centroid_exact == (Fraction(1), Fraction(1, 3))
    length = 1 + math.sqrt(2) + math.sqrt(5)
    assert TRIANGLE.perimeter == (~TRIANGLE).perimeter == pytest.approx(length, rel=1e-15)
    assert corners(TRIANGLE) == [[[0, 0], [1, 0], [2, 1]]]
    assert not (~TRIANGLE).is_bounded
    assert sides(~TRIANGLE, [(1, 0.25), (5, 5), (1, 0.5)]) == [-1, 1, 0]


def test_a_hole() -> None:
    """testGeometricProperties_regionWithHole and _complementedRegionWithHole."""
    ring = rect(0, 0, 3, 3) - rect(1, 1, 1, 1)
    assert ring.area == 8
    assert ring.centroid.tolist() == [1.5, 1.5]
    assert ring.perimeter == (~ring).perimeter == 16
    outer = [[0, 0], [3, 0], [3, 3], [0, 3]]
    assert corners(ring) == [outer, [[1, 1], [1, 2], [2, 2], [2, 1]]]
    # The complement is the hole and what is around: its loops run the other way.
    assert corners(~ring & rect(1, 1, 1, 1)) == [[[1, 1], [2, 1], [2, 2], [1, 2]]]
    assert (~ring | rect(1, 1, 1, 1)) == ~(rect(0, 0, 3, 3) - rect(1, 1, 1, 1))


def test_rectangles() -> None:
    """testRect_pointArguments and testRect_pointAndDeltas."""
    region = rect(1, 1, 2, 1)
    assert (region.area, region.perimeter, region.centroid.tolist()) == (2, 6, [2, 1.5])
    points = [(0.5, 1.5), (3.5, 0.5), (2, 0.5), (2, 2.5), (2, 1.5)]
    assert sides(region, points) == [-1, -1, -1, -1, 1]


@pytest.mark.parametrize("size", [(0, 2), (2, 0), (0, 0)])
def test_rectangles_without_area(size: tuple[float, float]) -> None:
    """testRect_zeroSize."""
    with pytest.raises(InvalidParameterError):
        Region.rectangle(*size)


def test_nearest_points() -> None:
    """testProject_fullAndEmpty, _halfSpace and _rect."""
    for nothing in (Region.full(), Region.empty()):
        with pytest.raises(InvalidParameterError):
            nothing.nearest([(0, 0)])
    found, _ = HALF.nearest([(0, 0), (-1, 0), (2, -1), (-3, 1)])
    assert found.tolist() == [[0, 0], [-1, 0], [2, 0], [-3, 0]]
    asked: list[tuple[float, float]]
    asked = [(0, 0), (1, 0), (1.5, 0), (2, 0), (3, 0), (1, 3), (1.5, 3), (2, 3), (3, 3)]
    asked += [(0, 1.5), (1.25, 1.5), (3, 1.5)]
    expected: list[list[float]]
    expected = [[1, 1], [1, 1], [1.5, 1], [2, 1], [2, 1], [1, 2], [1.5, 2], [2, 2], [2, 2]]
    expected += [[1, 1.5], [1, 1.5], [2, 1.5]]
    assert rect(1, 1, 1, 1).nearest(asked)[0].tolist() == expected


def test_a_point_as_near_to_four_sides() -> None:
    """testProject_rect in its middle: any side is right, and here it is one of the boundary's."""
    nearest, distance = rect(1, 1, 1, 1).nearest([(1.5, 1.5)])
    assert distance.tolist() == [0.5]
    assert rect(1, 1, 1, 1).classify(nearest).tolist() == [0]


def test_transforms() -> None:
    """testTransform, _halfSpace, _fullAndEmpty, _reflection and _doubleReflection."""
    moved = rect(1, 1, 2, 1).scale((0.5, 2)).rotate(90).translate(0, -1)
    assert corners(moved) == [[[-4, -0.5], [-2, -0.5], [-2, 0.5], [-4, 0.5]]]
    half = Region.half_plane((0, -1), -1).rotate(90).translate(1, 0)
    assert half == Region.half_plane((1, 0), 0)
    assert Region.full().rotate(90).is_full
    assert Region.empty().rotate(90).is_empty
    square = rect(1, 1, 1, 1)
    assert corners(square.mirror((1, 0))) == [[[-2, 1], [-1, 1], [-1, 2], [-2, 2]]]
    assert corners(square.rotate(180)) == [[[-2, -2], [-1, -2], [-1, -1], [-2, -1]]]


def test_operations_one_after_another() -> None:
    """testBooleanOperations."""
    region = rect(0, 0, 3, 3) & ~rect(1, 1, 1, 1)
    region = (region | rect(3, 0, 3, 3)) - rect(2, 1, 3, 1)
    region ^= Region.full()
    assert region == ~(rect(0, 0, 6, 3) - rect(1, 1, 4, 1))
    assert corners(~region) == [
        [[0, 0], [6, 0], [6, 3], [0, 3]],
        [[1, 1], [1, 2], [5, 2], [5, 1]],
    ]
    inserted = ObjectTree([[(0, 0), (1, 0)], [(1, 0), (2, 1)], [(2, 1), (0, 0)]])
    assert inserted == TRIANGLE.tree
