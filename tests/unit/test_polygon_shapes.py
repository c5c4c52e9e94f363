"""Shapes of shapely as regions and profiles: their meaning, and time linear in their number."""

import sys
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg.bsp import Region
from bspcsg.geometry.polygon import runs_clockwise

shapely = pytest.importorskip("shapely")


def squares(count: int, step: float = 2.0) -> list[Any]:
    """Return unit squares in rows, as shapely shapes."""
    side = int(np.ceil(np.sqrt(count)))
    corners = [(step * (k % side), step * (k // side)) for k in range(count)]
    return [shapely.box(x, y, x + 1, y + 1) for x, y in corners]


def with_holes(count: int) -> list[Any]:
    hole = np.array([(0.2, 0.2), (0.6, 0.2), (0.6, 0.6)])
    return [
        shapely.Polygon(one.exterior.coords, [hole + one.bounds[:2], hole[::-1] + 0.3])
        if k == 0
        else shapely.Polygon(one.exterior.coords, [hole + one.bounds[:2]])
        for k, one in enumerate(squares(count))
    ]


def calls_of(work: Callable[[], object]) -> int:
    """Return the number of function calls that the work makes."""
    count = 0

    def note(frame: object, event: str, argument: object) -> None:
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(note)
    try:
        work()
    finally:
        sys.setprofile(None)
    return count


#: Functions that make a shape of so many polygons.
SHAPES_BY_COUNT: dict[str, Callable[[int], Any]] = {
    "apart": lambda n: shapely.MultiPolygon(squares(n)),
    "touching": lambda n: shapely.MultiPolygon(squares(n, 1.0)),
    "with holes": lambda n: shapely.MultiPolygon(with_holes(n)),
    "list": squares,
    "overlapping list": lambda n: squares(n, 0.5),
    "collection": lambda n: shapely.GeometryCollection([*squares(n), shapely.Point(0, 0)]),
    "bow-ties": lambda n: shapely.MultiPolygon(
        [
            shapely.Polygon([(2 * k, 0), (2 * k + 1, 1), (2 * k + 1, 0), (2 * k, 1)])
            for k in range(n)
        ]
    ),
}


@pytest.mark.parametrize("make", SHAPES_BY_COUNT.values(), ids=SHAPES_BY_COUNT)
def test_each_polygon_costs_the_same_however_many_there_are(make: Callable[[int], Any]) -> None:
    few, many = make(100), make(400)
    assert calls_of(lambda: Region(many)) < 5 * calls_of(lambda: Region(few))
    assert calls_of(lambda: b.extrude(many, 1)) < 5 * calls_of(lambda: b.extrude(few, 1))


def test_bare_contours_meet_only_those_nearby() -> None:
    def contours(count: int) -> list[Any]:
        return [np.array(one.exterior.coords) for one in squares(count, 1.0)]

    few, many = contours(100), contours(400)
    assert calls_of(lambda: b.extrude(many, 1)) < 5 * calls_of(lambda: b.extrude(few, 1))


@pytest.mark.parametrize("make", SHAPES_BY_COUNT.values(), ids=SHAPES_BY_COUNT)
def test_what_shapes_mean(make: Callable[[int], Any]) -> None:
    shape = make(30)
    parts = list(getattr(shape, "geoms", shape))
    # Each part by itself, united one by one.
    expected = Region.empty()
    for part in parts:
        if part.area or part.geom_type == "Polygon":
            expected |= Region(part)
    assert Region(shape).equals(expected)
    if shapely.is_valid(shape).all():
        assert Region(shape).area == pytest.approx(shapely.union_all(shape).area, rel=1e-12)
        assert b.extrude(shape, 1).volume_exact == Region(shape).area_exact


def test_an_island_in_a_hole_and_a_polygon_inside_another() -> None:
    big, hole, island = (shapely.box(-k, -k, k, k) for k in (3, 2, 1))
    ring = shapely.Polygon(big.exterior.coords, [hole.exterior.coords])
    assert Region(shapely.MultiPolygon([ring, island])).area == 24
    # Not valid, but each of its polygons is: the region is what any of them holds.
    assert Region(shapely.MultiPolygon([big, island])).equals(Region(big))
    assert Region([ring, hole]).equals(Region(big))


def test_orientation_is_that_of_the_shape_not_of_its_coordinates() -> None:
    outer, inner = shapely.box(0, 0, 4, 4), shapely.box(1, 1, 2, 2)
    for first in (1, -1):
        for second in (1, -1):
            rings = [outer.exterior.coords[::first], inner.exterior.coords[::second]]
            assert Region(shapely.Polygon(rings[0], rings[1:])).area_exact == 15


def test_parts_without_area() -> None:
    line, point = shapely.LineString([(0, 0), (1, 1)]), shapely.Point(1, 2)
    mixed = shapely.GeometryCollection([line, *squares(1), point, shapely.MultiPoint([(1, 1)])])
    assert Region(mixed).area == 1
    assert Region(shapely.GeometryCollection([mixed, shapely.Polygon()])).area == 1
    # Two squares that touch have no area in common.
    touch = shapely.intersection(shapely.box(0, 0, 1, 1), shapely.box(1, 0, 2, 1))
    assert Region(shapely.GeometryCollection([touch])).is_empty
    assert Region(shapely.GeometryCollection()).is_empty
    assert Region(shapely.MultiPolygon()).is_empty
    for shape in (
        line,
        point,
        shapely.MultiLineString([line]),
        shapely.LinearRing(squares(1)[0].exterior),
    ):
        with pytest.raises(b.InvalidMeshError):
            Region(shape)
    with pytest.raises(b.InvalidMeshError, match="no contour"):
        b.extrude(shapely.GeometryCollection([line]), 1)


def test_the_sign_of_an_area_is_exact() -> None:
    # 2**-52 high and 2**26 long, far from the origin: products of doubles lose the area.
    for sign in (1, -1):
        thin = np.array(
            [(0.0, 1.0), (2.0**26, 1.0 + 2**-52), (2.0**27, 1.0 + 2**-51 + sign * 2**-52)]
        )
        (ax, ay), (bx, by), (cx, cy) = [[Fraction(c) for c in p] for p in thin.tolist()]
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        assert runs_clockwise(thin) == (area < 0) == (sign < 0)
