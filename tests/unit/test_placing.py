"""Meshes that files transform: contacts do not become crossings, exact motions are exact."""

import functools
import operator
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import bspcsg as b
from bspcsg.formats.files import decoded
from bspcsg.formats.glb import scene as glb
from bspcsg.formats.mesh_placement import PlacedMesh, is_exact, placed_meshes, rescaled
from bspcsg.formats.raw import RawMesh
from bspcsg.formats.scene import SceneNode
from bspcsg.formats.solids import solid_of
from bspcsg.formats.threemf import scene as threemf
from bspcsg.geometry import transform
from support.shapes import cube

SCENES = {".glb": glb.encode, ".3mf": threemf.encode}

#: So many placings of each shape.
TURNS = 20

UNMOVED = np.eye(4)


def chain() -> "b.Solid":
    """Return boxes in a ring that touch along parts of edges or are joined."""
    ends = [
        ((0, 0, 0), (2, 2, 2)),
        ((2, 2, 0.5), (4, 4, 1.5)),
        ((0, 2, -1), (4, 4, 0)),
        ((3, 0, -1), (4, 3, 1)),
        ((1, 0, -1), (4, 1, 0.5)),
    ]
    boxes = (b.box(np.subtract(high, low)).translate(low) for low, high in ends)
    return functools.reduce(operator.or_, boxes)


def tip_on_a_face() -> "b.Solid":
    return b.box((4, 4, 4)) | b.cone(r=1, h=2, segments=8).mirror("z").translate(2, 2, 6)


def edges_apart() -> "b.Solid":
    return b.box((4, 4, 4)) | b.box((2, 2, 2)).translate(4, 4, 1)


def raw_of(solid: "b.Solid", is_soup: bool = False) -> RawMesh:
    mesh = solid.to_mesh()
    # What single precision moves would cross before it is placed.
    vertices = mesh.vertices.astype(np.float32).astype(np.float64)
    faces = mesh.faces
    if is_soup:
        vertices, faces = vertices[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3)
    return RawMesh(vertices, faces, "part")


def some_matrix(rng: np.random.Generator) -> np.ndarray:
    matrix = transform.product(transform.euler_rotation(rng.uniform(0, 360, 3)))
    matrix = matrix @ np.diag([*rng.uniform(0.3, 3, 3), 1])
    matrix[:3, 3] = rng.uniform(-100, 100, 3)
    return matrix


def read_back(node: SceneNode, suffix: str) -> RawMesh:
    return decoded(f"part{suffix}", b"".join(SCENES[suffix](node)), suffix)


def crosses(solid: "b.Solid") -> bool:
    return bool(solid.to_mesh().certificate.crossings)


def crossings(raw: RawMesh) -> int:
    return len(solid_of(raw, "part").to_mesh().certificate.crossings)


@pytest.mark.parametrize("suffix", SCENES)
@pytest.mark.parametrize("is_soup", [False, True])
@pytest.mark.parametrize("make", [chain, tip_on_a_face, edges_apart])
def test_what_touches_itself_does_not_cross_where_a_file_places_it(
    make: Callable[[], "b.Solid"], is_soup: bool, suffix: str
) -> None:
    mesh = raw_of(make(), is_soup)
    assert crossings(mesh) == 0
    volume = solid_of(mesh, "part").volume
    rng = np.random.default_rng(3)
    mended = 0
    for _ in range(TURNS):
        matrix = some_matrix(rng)
        raw = read_back(SceneNode("part", matrix, mesh), suffix)
        assert raw.objects == (("part", len(raw.faces)),)
        assert crossings(raw) == 0 and not {"crossing"} & {one.code for one in raw.findings}
        size = abs(np.linalg.det(matrix))
        assert solid_of(raw, "part").volume == pytest.approx(volume * size, rel=1e-9)
        mended += raw.is_mended
    assert mended > 0


@pytest.mark.parametrize("suffix", SCENES)
def test_parts_that_one_map_places_do_not_cross_each_other(suffix: str) -> None:
    boxes = [b.box((4, 4, 4)), b.box((2, 2, 2)).translate(4, 4, 1)]
    meshes = [replace(raw_of(box), name=f"box {n}") for n, box in enumerate(boxes)]
    parts = [SceneNode(mesh.name, UNMOVED, mesh) for mesh in meshes]
    rng = np.random.default_rng(4)
    mended = 0
    for _ in range(TURNS):
        raw = read_back(SceneNode("all", some_matrix(rng), children=tuple(parts)), suffix)
        assert [name for name, _ in raw.objects] == [part.name for part in parts]
        assert sum(count for _, count in raw.objects) == len(raw.faces)
        assert crossings(raw) == 0
        mended += raw.is_mended
    assert mended > 0


def test_a_mesh_that_crossed_itself_before_it_was_placed_stays_as_it_is() -> None:
    box = b.box((2, 2, 2)).to_mesh()
    faces = np.concatenate([box.faces, box.faces + len(box.vertices)])
    twice = RawMesh(np.concatenate([box.vertices, box.vertices + 1]), faces, "part")
    matrix = some_matrix(np.random.default_rng(6))
    for suffix in SCENES:
        raw = read_back(SceneNode("part", matrix, twice), suffix)
        assert np.array_equal(raw.faces, faces) and not raw.is_mended


def test_what_is_said_of_faces_stays_where_placing_is_mended() -> None:
    solid = chain().tagged(material="steel")
    mesh = solid.to_mesh()
    raw = RawMesh(mesh.vertices, mesh.faces, "part", attributes=mesh.attributes)
    rng = np.random.default_rng(7)
    mended = 0
    for _ in range(TURNS):
        matrix = some_matrix(rng)
        found = placed_meshes([PlacedMesh(raw, partial(transform.apply, matrix), is_exact=False)])
        assert found.attributes is not None
        assert len(found.attributes.face["material"]) == len(found.faces)
        assert np.array_equal(found.attributes.faces, found.faces)
        mended += found.is_mended
    assert mended > 0


@pytest.mark.parametrize("units", [(25.4, 1.0), (1.0, 25.4), (1.0, 10.0)])
def test_what_touches_itself_does_not_cross_in_another_unit(units: tuple[float, float]) -> None:
    rng = np.random.default_rng(8)
    mended = 0
    for make in (chain, tip_on_a_face, edges_apart) * TURNS:
        mesh = make().rotate(rng.uniform(0, 360), rng.normal(size=3)).normalized().to_mesh()
        half = len(mesh.faces) // 2
        objects = (("one", half), ("two", len(mesh.faces) - half))
        found = rescaled(RawMesh(mesh.vertices, mesh.faces, objects=objects), *units)
        assert sum(count for _, count in found.objects) == len(found.faces)
        assert [name for name, _ in found.objects] == ["one", "two"]
        # Vertices that import welds may make it cross, which is told.
        solid = solid_of(found, "part")
        assert not crosses(solid) or "self_overlap" in {told.code for told in solid.findings}
        mended += found.is_mended
    assert mended > 0


def with_t_junctions(mesh: "b.Mesh") -> RawMesh:
    """Return a mesh with every third face divided at an edge, but not the face beyond."""
    vertices, faces = mesh.vertices.tolist(), []
    for number, (a, c, d) in enumerate(mesh.faces.tolist()):
        if number % 3:
            faces.append((a, c, d))
            continue
        vertices.append(((mesh.vertices[a] + mesh.vertices[c]) / 2).tolist())
        faces += [(a, len(vertices) - 1, d), (len(vertices) - 1, c, d)]
    half = len(faces) // 2
    objects = (("one", half), ("two", len(faces) - half))
    return RawMesh(np.array(vertices), np.array(faces), "part", objects=objects)


@pytest.mark.parametrize("suffix", SCENES)
@pytest.mark.parametrize("mirrors", [False, True])
@pytest.mark.parametrize("is_soup", [False, True])
def test_t_junctions_stay_closed_where_a_file_places_them(
    suffix: str, mirrors: bool, is_soup: bool
) -> None:
    mesh = replace(with_t_junctions(chain().to_mesh()), objects=())
    if is_soup:
        corners = mesh.vertices[mesh.faces].reshape(-1, 3)
        mesh = replace(mesh, vertices=corners, faces=np.arange(len(corners)).reshape(-1, 3))
    volume = solid_of(mesh, "part").volume
    rng = np.random.default_rng(9)
    for _ in range(TURNS):
        matrix = some_matrix(rng) @ np.diag([-1 if mirrors else 1, 1, 1, 1])
        raw = read_back(SceneNode("part", matrix, mesh), suffix)
        assert raw.objects == (("part", len(raw.faces)),)
        solid = solid_of(raw, "part")
        assert solid.volume == pytest.approx(volume * abs(np.linalg.det(matrix)), rel=1e-9)
        assert solid.to_mesh().certificate.ok


def test_t_junctions_stay_closed_in_another_unit() -> None:
    mesh = chain().rotate((10, 20, 30)).normalized().to_mesh()
    # The middle between short decimals is one, and lies on its edge.
    raw = with_t_junctions(replace(mesh, vertices=np.round(mesh.vertices, 3)))
    found = rescaled(raw, 1 / 3)
    assert [name for name, _ in found.objects] == ["one", "two"]
    assert sum(count for _, count in found.objects) == len(found.faces)
    volume = solid_of(raw, "part").volume
    assert solid_of(found, "part").volume == pytest.approx(volume / 27, rel=1e-9)


def test_units_that_round_nothing_change_no_face() -> None:
    raw = raw_of(chain())
    found = rescaled(raw, 1000)
    assert np.array_equal(found.vertices, raw.vertices * 1000) and found.faces is raw.faces
    assert rescaled(raw, 1, 1) is raw


def test_what_a_map_lays_on_each_other_is_told_at_once() -> None:
    solid = b.sphere(1, segments=32) - b.sphere(0.5, segments=32).translate(0.9, 0, 0)
    mesh = solid.to_mesh()
    raw = RawMesh(mesh.vertices, mesh.faces, "part")
    began = time.process_time()
    found = placed_meshes(
        [PlacedMesh(raw, lambda points: points * (1, 1, 1e-20) + (0, 0, 1), False)]
    )
    assert time.process_time() - began < 1
    (finding,) = found.findings
    assert (finding.code, finding.severity) == ("crossing", "warning")
    assert finding.count == len(finding.where) > len(mesh.faces) / 2


@pytest.mark.parametrize(
    ("linear", "shift", "exact"),
    [
        (np.eye(3), (0, 0, 0), True),
        (np.eye(3) * 1000, (0, 0, 0), True),
        (np.eye(3)[[1, 2, 0]] * -1, (0, 0, 0), True),
        (np.eye(3), (1, 2, 3), True),
        (np.eye(3), (1e9, 0, 0), False),
        (np.eye(3), (0.1, 0, 0), False),
        (np.eye(3) * 0.1, (0, 0, 0), False),
        (np.eye(3) + np.eye(3)[[1, 2, 0]], (0, 0, 0), False),
    ],
)
def test_maps_that_round_nothing(linear: np.ndarray, shift: tuple[float, ...], exact: bool) -> None:
    points = np.random.default_rng(8).normal(size=(50, 3)).astype(np.float32).astype(np.float64)
    assert is_exact(points, linear, np.array(shift, dtype=np.float64)) == exact


def with_flat(flat: list[tuple[int, int, int]]) -> RawMesh:
    """Return a cube with a vertex within its first edge, and triangles without area."""
    vertices, faces = cube()
    start, end = vertices[faces[0, 0]], vertices[faces[0, 1]]
    middle = (start + end) / 2
    more = np.array([[faces[0, 0] if one == 0 else faces[0, 1] for one in row] for row in flat])
    more[np.array(flat) == 2] = len(vertices)
    return RawMesh(np.vstack([vertices, middle]), np.vstack([faces, more]))


# Found: where a file's unit or placement rounds coordinates, triangles without area were dropped
# without a finding.
@pytest.mark.parametrize("flat", [[(0, 0, 1)], [(0, 2, 1)], [(0, 0, 0), (0, 2, 1), (1, 1, 0)]])
@pytest.mark.parametrize("place", ["unit", "turned", "kept", "rescaled"])
def test_triangles_without_area_are_kept_or_told(
    flat: list[tuple[int, int, int]], place: str
) -> None:
    raw = with_flat(flat)
    turned = np.array([[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]])
    linear = {"unit": np.eye(3) * 25.4, "kept": np.eye(3) * 2}.get(place, turned)

    def image(points: np.ndarray) -> np.ndarray:
        return points @ linear.T

    keeps = is_exact(raw.vertices, linear, np.zeros(3))
    pieces = [PlacedMesh(raw, image, keeps, b"a"), PlacedMesh(raw, image, keeps, b"b")]
    found = rescaled(raw, 25.4) if place == "rescaled" else placed_meshes(pieces)
    told = sum(one.count for one in found.findings if one.code == "zero_area")
    count = len(raw.faces) * (1 if place == "rescaled" else 2)
    assert len(found.faces) + told == count
    assert (told == 0) == (place == "kept")
