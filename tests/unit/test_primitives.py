"""Primitives: sizes, positions, topology, exactness, and refusals."""

import inspect
import math
from collections.abc import Callable
from typing import Any, cast

import numpy as np
import pytest

import bspcsg as b
from bspcsg.geometry.polygon import (
    contours_of,
    directed_edges,
    signed_area,
    triangulate,
    triangulate_face,
)
from bspcsg.shapes.sweep import unit_circle

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]
HOLE = [(1, 1), (3, 1), (3, 3), (1, 3)]
ISLAND = [(1.5, 1.5), (2.5, 1.5), (2.5, 2.5), (1.5, 2.5)]
ARROW = [(0, 0), (4, 2), (0, 4), (1, 2)]


def ngon(sides: int) -> float:
    """Return the area of the regular polygon in the unit circle."""
    return sides / 2 * math.sin(2 * math.pi / sides)


#: Solid, volume, genus, lowest and highest z.
SHAPES: dict[str, tuple[Callable[[], b.Solid], float, int, tuple[float, float]]] = {
    "box": (lambda: b.box((1, 2, 3)), 6, 0, (0, 3)),
    "box, centred": (lambda: b.box((1, 2, 3), center=True), 6, 0, (-1.5, 1.5)),
    "box of one size": (lambda: b.box(2), 8, 0, (0, 2)),
    "cube": (lambda: b.cube(2), 8, 0, (0, 2)),
    "cube, centred": (lambda: b.cube(2, True), 8, 0, (-1, 1)),
    "octahedron": (lambda: b.sphere(1, segments=4), 4 / 3, 0, (-1, 1)),
    "sphere": (lambda: b.sphere(2, segments=128), 4 / 3 * math.pi * 8, 0, (-2, 2)),
    "cylinder": (lambda: b.cylinder(3, 1, segments=7), 3 * ngon(7), 0, (0, 3)),
    "cylinder, centred": (lambda: b.cylinder(3, 1, center=True), 3 * ngon(32), 0, (-1.5, 1.5)),
    "frustum": (lambda: b.cylinder(3, r1=2, r2=1, segments=5), 7 * ngon(5), 0, (0, 3)),
    "cone up": (lambda: b.cylinder(3, r1=2, r2=0, segments=5), 4 * ngon(5), 0, (0, 3)),
    "cone down": (lambda: b.cylinder(3, r1=0, r2=2, segments=5), 4 * ngon(5), 0, (0, 3)),
    "cone": (lambda: b.cone(3, 2, segments=3), 4 * ngon(3), 0, (0, 3)),
    "torus": (
        lambda: b.torus(3, 1, segments=12, tube_segments=8),
        3 * 12 * math.sin(math.pi / 6) * ngon(8),
        1,
        (-1, 1),
    ),
    "prism": (lambda: b.prism(6, 2, 1), 2 * ngon(6), 0, (0, 2)),
    "extruded": (lambda: b.extrude(SQUARE, 2), 32, 0, (0, 2)),
    "extruded, concave": (lambda: b.extrude(ARROW, 2, center=True), 12, 0, (-1, 1)),
    "extruded, holed": (lambda: b.extrude([HOLE, SQUARE], 2), 24, 1, (0, 2)),
    "extruded, island": (lambda: b.extrude([SQUARE, ISLAND, HOLE], 1), 13, 1, (0, 1)),
    "revolved": (
        lambda: b.revolve([(0, 0), (1, 0), (1, 2), (0, 1)], segments=6),
        ngon(6) * 5 / 3,
        0,
        (0, 2),
    ),
    "revolved ring": (
        lambda: b.revolve([(1, 0), (2, 0), (2, 1), (1, 1)], segments=6),
        3 * ngon(6),
        1,
        (0, 1),
    ),
    "revolved in part": (
        lambda: b.revolve([(0, 0), (1, 0), (1, 1), (0, 1)], angle=90, segments=1),
        0.5,
        0,
        (0, 1),
    ),
    "revolved, holed": (
        lambda: b.revolve(
            [[(x + 1, y) for x, y in SQUARE], [(x + 1, y) for x, y in HOLE]], angle=180
        ),
        math.pi * 36 * ngon(64) / math.pi,
        1,
        (0, 4),
    ),
}


@pytest.mark.parametrize("name", SHAPES)
def test_volume_genus_and_height(name: str) -> None:
    make, volume, genus, height = SHAPES[name]
    solid = make()
    assert solid.volume == pytest.approx(volume, rel=2e-3 if name == "sphere" else 1e-8)
    assert solid.genus == genus
    assert solid.bounds is not None
    assert solid.bounds[:, 2].tolist() == list(height)
    assert solid.to_manifold().status().name == "NoError"
    assert solid.to_trimesh().is_volume


@pytest.mark.parametrize("count", [3, 4, 5, 6, 7, 12, 16, 30, 100, 360])
def test_circles_are_symmetric_bit_by_bit(count: int) -> None:
    points = {(x, y) for x, y in unit_circle(count).tolist()}
    assert len(points) == count
    assert {(x, -y) for x, y in points} == points
    if count % 4 == 0:
        assert {(y, x) for x, y in points} == points
        assert {(1, 0), (0, 1), (-1, 0), (0, -1)} <= points


@pytest.mark.parametrize("sides", [3, 4, 5, 32, 101])
def test_caps_are_plane_and_triangle_counts_are_least(sides: int) -> None:
    mesh = b.prism(sides, 1, 1).to_mesh()
    assert len(mesh.faces) == 4 * sides - 4
    assert len(mesh.vertices) == 2 * sides
    mesh = b.cone(1, 1, segments=sides).to_mesh()
    assert (len(mesh.faces), len(mesh.vertices)) == (2 * sides - 2, sides + 1)


def test_odd_spheres_still_have_both_poles() -> None:
    bounds = b.sphere(1, segments=7).bounds
    assert bounds is not None
    assert bounds[:, 2].tolist() == [-1, 1]
    assert b.sphere(1, segments=3).euler_number == 2


def test_primitives_need_no_check_but_fine_ones_get_it() -> None:
    assert b.sphere(1, segments=64).tree.simple is True
    thin = b.cylinder(1e-8, 1)
    assert thin._node.content._trusted is False  # type: ignore[union-attr]


def test_bodies_thinner_than_the_lattice_are_empty() -> None:
    assert b.cone(1e-10, 1).is_empty
    assert b.cylinder(h=1e-10, r1=1, r2=0.5).is_empty


@pytest.mark.parametrize("turn", [1, -1])
def test_contours_may_run_either_way_round(turn: int) -> None:
    assert b.extrude([SQUARE[::turn], HOLE[::-turn]], 1).volume == 12
    assert b.extrude([SQUARE[::turn], HOLE[::turn]], 1).volume == 12


def test_polygons_of_other_libraries() -> None:
    import manifold3d

    class Ring:
        def __init__(self, coords: list[tuple[int, int]]) -> None:
            self.coords = [*coords, coords[0]]

    class Polygon:
        exterior = Ring(SQUARE)
        interiors = (Ring(HOLE),)

    class MultiPolygon:
        geoms = (Polygon(), Polygon())

    assert b.extrude(Polygon(), 1).volume == 12
    assert len(contours_of(MultiPolygon())) == 4
    section = manifold3d.CrossSection([SQUARE, HOLE[::-1]])
    assert b.extrude(section, 1).volume == 12
    assert b.extrude(np.array(SQUARE, dtype=np.float32), 1).volume == 16


def test_touching_contours_are_fine() -> None:
    touching = [(0, 0), (2, 0), (2, 2), (0, 2)]
    corner = [(2, 2), (4, 2), (4, 4), (2, 4)]
    assert b.extrude([touching, corner], 1).volume == 8
    inner = [(0, 0), (1, 0), (1, 1), (0, 1)]
    assert b.extrude([touching, [(x + 0.5, y) for x, y in inner]], 1).volume_exact == 3


def test_triangulation_has_the_border_of_its_contours() -> None:
    rng = np.random.default_rng(5)
    for _ in range(50):
        crossing = [rng.integers(0, 5, (9, 2)).astype(float) for _ in range(2)]
        triangles = triangulate(crossing)
        edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        balance: dict[tuple[int, int], int] = {}
        for start, end in edges.tolist():
            balance[start, end] = balance.get((start, end), 0) + 1
            balance[end, start] = balance.get((end, start), 0) - 1
        for start, end in directed_edges(crossing).tolist():
            balance[start, end] = balance.get((start, end), 0) - 1
            balance[end, start] = balance.get((end, start), 0) + 1
        assert not any(balance.values())


def test_faces_in_space_are_triangulated_as_seen_from_outside() -> None:
    flat = np.array([(x, y, 0.0) for x, y in ARROW])
    for corners in (flat, flat[::-1], flat[:, [1, 2, 0]], flat[::-1, [2, 0, 1]]):
        triangles = triangulate_face(corners)
        normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0) / 2
        a, c, d = (corners[triangles[:, k]] for k in range(3))
        normals = np.cross(c - a, d - a) / 2
        assert normals.sum(axis=0).tolist() == normal.tolist()
        assert np.linalg.norm(normals, axis=1).sum() == np.linalg.norm(normal)


def test_areas_have_a_sign() -> None:
    assert signed_area(np.array(SQUARE, dtype=float)) == 16
    assert signed_area(np.array(SQUARE[::-1], dtype=float)) == -16


NAN = float("nan")

WRONG: dict[str, Callable[[], Any]] = {
    "zero size": lambda: b.cube(0),
    "negative size": lambda: b.box((1, -1, 1)),
    "NaN size": lambda: b.box((1, NAN, 1)),
    "two sizes": lambda: b.box((1, 2)),
    "no number": lambda: b.cube("big"),  # type: ignore[arg-type]
    "zero radius": lambda: b.sphere(0),
    "infinite radius": lambda: b.sphere(float("inf")),
    "few segments": lambda: b.sphere(1, segments=2),
    "broken segments": lambda: b.sphere(1, segments=4.5),  # type: ignore[arg-type]
    "zero height": lambda: b.cylinder(0, 1),
    "no radius": lambda: b.cylinder(1),
    "one radius": lambda: b.cylinder(1, r1=1),
    "two zero radii": lambda: b.cylinder(1, r1=0, r2=0),
    "negative radius": lambda: b.cylinder(1, r1=-1, r2=1),
    "two sides": lambda: b.prism(2, 1, 1),
    "thick tube": lambda: b.torus(1, 1),
    "empty polygon": lambda: b.extrude([], 1),
    "two points": lambda: b.extrude([(0, 0), (1, 1)], 1),
    "same points": lambda: b.extrude([(0, 0), (1, 1), (1, 1), (0, 0)], 1),
    "points in space": lambda: b.extrude([(0, 0, 0), (1, 1, 1), (2, 0, 0)], 1),
    "NaN point": lambda: b.extrude([(0, 0), (1, NAN), (1, 1)], 1),
    "words": lambda: b.extrude("polygon", 1),
    "number": lambda: b.extrude(7, 1),
    "no height": lambda: b.extrude(SQUARE, NAN),
    "behind the axis": lambda: b.revolve([(-1, 0), (1, 0), (1, 1)]),
    "no angle": lambda: b.revolve(SQUARE, angle=0),
    "too far round": lambda: b.revolve(SQUARE, angle=361),
    "no offset": lambda: b.half_space((0, 0, 1), NAN),
}


@pytest.mark.parametrize("name", WRONG)
def test_parameters_that_make_no_solid_are_refused(name: str) -> None:
    with pytest.raises(b.InvalidMeshError) as caught:
        WRONG[name]()
    assert caught.value.code == "invalid_parameter"
    assert len(str(caught.value)) > 10


# Found: half-spaces accepted time spans as numbers.
@pytest.mark.parametrize(
    "normal", [(0, 0, 0), (NAN, 0, 1), (1, 2), "up", 3, (0, 0, np.timedelta64(3))]
)
def test_half_spaces_need_a_normal(normal: Any) -> None:
    with pytest.raises(b.InvalidMeshError) as caught:
        b.half_space(normal, 0)
    assert caught.value.code == "bad_normal"


def test_half_spaces_take_any_length_of_normal() -> None:
    box = b.cube(2, center=True)
    assert (box & b.half_space((0, 0, 1e300), 0)).volume == 4
    assert (box & b.half_space((0, 0, 1e-300), 0)).volume == 4


# Found: `cylinder(d=)`, `box(1, 2, 3)` were missing.
def test_sizes_as_people_type_them() -> None:
    assert b.box(1, 2, 3) == b.box((1, 2, 3)) == b.box(size=[1, 2, 3])
    assert b.box(1, 2, 3, center=True) == b.box((1, 2, 3), True) == b.cube((1, 2, 3), center=True)
    assert b.sphere(d=2) == b.sphere(1) == b.sphere(r=1)
    assert b.cylinder(5, d=4) == b.cylinder(5, 2) == b.cylinder(h=5, r=2)
    assert b.cylinder(5, d1=4, d2=2) == b.cylinder(5, r1=2, r2=1) == b.cylinder(5, 2, d2=2)
    assert b.cone(5, d=4) == b.cone(5, 2) == b.cylinder(5, d=4, r2=0)


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: b.box(1, 2), "one edge length or three"),
        (lambda: b.box(1, z=2), "one edge length or three"),
        (lambda: b.box((1, 2, 3), 4, 5), "three"),
        (lambda: b.box(1, 2, 0), "above 0"),
        (lambda: b.box(1, True, 3), "one edge length"),
        (b.sphere, "needs a radius"),
        (lambda: b.sphere(1, d=2), "give one of them"),
        (lambda: b.sphere(d=-2), "at least 0"),
        (lambda: b.cylinder(5), "needs a radius"),
        (lambda: b.cylinder(5, 1, d=2), "give one of them"),
        (lambda: b.cylinder(5, d1=2), "needs a radius"),
        (lambda: b.cylinder(5, r1=1, d1=2, r2=1), "give one of them"),
        (lambda: b.cylinder(5, d=cast("Any", "2")), "number"),
        (lambda: b.cone(5), "needs a radius"),
    ],
)
def test_sizes_that_do_not_fit_are_refused(call: Callable[[], Any], word: str) -> None:
    with pytest.raises(b.InvalidParameterError, match=word):
        call()


def test_wrong_sizes_are_told_as_they_were_given() -> None:
    with pytest.raises(b.InvalidParameterError, match=r"^d must be at least 0, not -2"):
        b.cylinder(h=1, d=-2)
    with pytest.raises(b.InvalidParameterError, match=r"^r must be at least 0, not -2"):
        b.cylinder(h=1, r1=-2, r2=1)


@pytest.mark.parametrize(
    ("by_radius", "by_diameter"),
    [
        (b.sphere(2), b.sphere(d=4)),
        (b.cylinder(3, 2), b.cylinder(3, d=4)),
        (b.cone(3, 2), b.cone(3, d=4)),
        (b.prism(5, 3, 2), b.prism(5, 3, d=4)),
        (b.torus(3, 1), b.torus(d=6, tube_d=2)),
        (b.Region.circle(2), b.Region.circle(d=4)),
        (b.pipe([(0, 0), (9, 0)], 2, inner=1), b.pipe([(0, 0), (9, 0)], d=4, inner_d=2)),
    ],
)
def test_round_shapes_take_a_diameter(by_radius: Any, by_diameter: Any) -> None:
    assert by_radius == by_diameter


@pytest.mark.parametrize(
    "make",
    [
        b.sphere,
        b.Region.circle,
        lambda **given: b.cylinder(3, **given),
        lambda **given: b.cone(3, **given),
        lambda **given: b.prism(5, 3, **given),
        lambda **given: b.torus(tube=0.1, **given),
        lambda **given: b.pipe([(0, 0), (9, 0)], **given),
    ],
)
def test_round_shapes_need_one_radius_above_0(make: Callable[..., Any]) -> None:
    for given, words in (
        ({"r": 1, "d": 2}, "give one of them"),
        ({}, "needs a radius or a diameter"),
        ({"d": -1}, "d must be at least 0"),
        ({"d": 0}, "above 0"),
        ({"d": "2"}, "d must be a number"),
    ):
        with pytest.raises(b.InvalidParameterError, match=words) as caught:
            make(**given)
        assert caught.value.code == "invalid_parameter"


def test_sizes_are_numbers_or_one_tuple() -> None:
    assert len({b.box(1, 2, 3), b.box((1, 2, 3)), b.cube(1, 2, 3), b.cube((1, 2, 3))}) == 1
    rectangle = b.Region.rectangle
    assert len({rectangle(2, 3), rectangle((2, 3)), rectangle(np.array([2, 3]))}) == 1
    assert rectangle(2) == rectangle((2, 2)) and rectangle((2, 3), center=True).bounds is not None
    rounded = b.rounded_box((4, 3, 2), 0.5)
    assert len({rounded, b.rounded_box(4, 3, 2, 0.5), b.rounded_box(4, 3, 2, r=0.5)}) == 1


@pytest.mark.parametrize(
    "call",
    [
        lambda: b.Region.rectangle((1, 2, 3)),
        lambda: b.Region.rectangle((1, 2), 3),
        lambda: b.Region.rectangle((1, -2)),
        lambda: b.rounded_box(4),
        lambda: b.rounded_box(4, 3, 2),
        lambda: b.rounded_box(4, 0.5, r=0.5),
        lambda: b.rounded_box((4, 3, 2), 4, 3, 0.5),
        lambda: b.cube(1, 2),
    ],
)
def test_sizes_of_another_number_are_refused(call: Callable[[], Any]) -> None:
    with pytest.raises(b.InvalidParameterError) as caught:
        call()
    assert caught.value.code == "invalid_parameter"


def test_circles_have_one_default_of_segments() -> None:
    found = {}
    for owner in (b, b.bsp, b.Solid, b.Region):
        calls = {name: getattr(owner, name) for name in dir(owner) if not name.startswith("_")}
        for name, call in calls.items():
            taken = inspect.signature(call).parameters if inspect.isroutine(call) else {}
            if "segments" in taken and taken["segments"].default is not inspect.Parameter.empty:
                found[f"{owner.__name__}.{name}"] = taken["segments"].default
    # Of a spline these are the chords from one point to the next.
    del found["bspcsg.spline"]
    assert len(found) > 10 and {*found.values()} == {32}, found
