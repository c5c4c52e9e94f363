"""The attributes of a mesh through operations, transforms and copies."""

import pickle
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import bspcsg as b
from bspcsg._types import FloatArray, WindingRule
from bspcsg.attributes.barycentric import weights
from bspcsg.attributes.colours import as_bytes
from bspcsg.formats.raw import RawMesh, joined
from bspcsg.mesh.visuals import attributes_from
from support.pictures import PIXEL


def cube(size: float = 2.0, at: float = 0.0, **options: Any) -> b.Solid:
    mesh = b.cube(size).to_mesh()
    return b.Solid(mesh.vertices + at, mesh.faces, **options)


def normals() -> FloatArray:
    mesh = b.cube(2).to_mesh()
    a, c, d = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    outward: FloatArray = np.cross(c - a, d - a) / 4
    return outward


def test_an_untouched_mesh_keeps_every_bit() -> None:
    rng = np.random.default_rng(1)
    given: dict[str, npt.NDArray[Any]] = {
        "float": rng.normal(size=(8, 2)),
        "single": rng.normal(size=8).astype(np.float32),
        "byte": rng.integers(0, 256, (8, 4)).astype(np.uint8),
        "large": np.arange(8) + 2**62,
        "flag": rng.integers(0, 2, 8).astype(bool),
        "text": np.array(list("abcdefgh")),
    }
    mesh = (cube(vertex_attributes=given) | b.cube(1).translate(5, 0, 0)).to_mesh()
    corners = mesh.attributes.at_corners
    for name, values in given.items():
        own = mesh.source[:, 0] == 0
        assert corners(name).dtype == values.dtype
        meant = values[b.cube(2).to_mesh().faces[mesh.source[own, 1]]]
        assert np.array_equal(corners(name)[own], meant)


def test_what_an_operand_lacks_has_the_default() -> None:
    given = {"float": np.ones(12), "int": np.ones(12, int), "flag": np.ones(12, bool)}
    one = cube(face_attributes={**given, "text": np.full(12, "x")})
    mesh = (one | b.cube(1).translate(5, 0, 0)).to_mesh()
    assert np.isnan(mesh.face_attributes["float"][12:]).all()
    assert (mesh.face_attributes["int"][12:] == 0).all()
    assert not mesh.face_attributes["flag"][12:].any()
    assert (mesh.face_attributes["text"][12:] == "").all()


@pytest.mark.parametrize(
    ("color", "blank"),
    [
        ("red", [255, 255, 255]),
        ("#ff000080", [255, 255, 255, 255]),
        (np.array([65535, 0, 0], np.uint16), [65535, 65535, 65535]),
        ((1.0, 0.0, 0.0, 0.5), [np.nan] * 4),
    ],
)
def test_faces_without_colour_beside_coloured_ones_are_white(
    color: Any, blank: list[float]
) -> None:
    """Not black, and not transparent."""
    colored, plain = b.cube(1).tagged(color=color), b.cube(1).translate(5, 0, 0)
    for parts in ((colored, plain), (plain, colored)):
        union = b.union(*parts)
        rest = union.to_mesh().source[:, 0] == parts.index(plain)
        shown = union.to_mesh().face_attributes["color"][rest]
        assert np.array_equal(shown, np.full_like(shown, blank), equal_nan=True)
        assert (as_bytes(shown) == 255).all()
        known = b.Solid.from_mesh(union.to_manifold()).to_mesh()
        assert (as_bytes(known.attributes.at_corners("color")) == 255).all(axis=(1, 2)).sum() == 12


def test_objects_without_colour_beside_coloured_ones_are_white() -> None:
    red, plain = b.cube(1).tagged(color="red").to_mesh(), b.cube(1).to_mesh()
    meshes = [
        RawMesh(red.vertices, red.faces, attributes=red.attributes),
        RawMesh(plain.vertices, plain.faces),
    ]
    said = joined(meshes).attributes
    assert said is not None
    assert (said.face["color"][12:] == 255).all()


def test_faces_of_one_plane_are_joined_only_if_they_say_the_same() -> None:
    plain = len((cube() - b.cube(1)).faces)
    same = cube(face_attributes={"color": np.full((12, 3), 7, np.uint8)}) - b.cube(1)
    assert len(same.faces) == plain
    mesh = (cube(face_attributes={"id": np.arange(12)}) - b.cube(1)).to_mesh()
    own = mesh.source[:, 0] == 0
    assert np.array_equal(mesh.face_attributes["id"][own], mesh.source[own, 1])


def test_whole_numbers_are_rounded_and_text_is_that_of_the_nearest_corner() -> None:
    half = b.cube(4).translate(-1, -1, -3)  # leaves z from 1 to 2
    high = cube().to_mesh().vertices[:, 2] > 1
    given = {"int": np.where(high, 5, 0), "text": np.where(high, "up", "down")}
    mesh = (cube(vertex_attributes=given) - half).to_mesh()
    cut = mesh.vertices[:, 2] == 1
    told = mesh.attributes.at_corners("int")[mesh.source[:, 0] == 0]
    assert set(np.unique(told)) == {2, 5}  # 2.5 is rounded to even
    assert cut.any()
    assert set(np.unique(mesh.attributes.at_corners("text"))) <= {"up", "down", ""}


def test_seams_stay_seams_and_cuts_keep_both_sides() -> None:
    noise = np.random.default_rng(2).normal(size=(12, 3))
    mesh = (cube(corner_attributes={"u": noise}) | b.cube(1).translate(9, 0, 0)).to_mesh()
    assert np.array_equal(mesh.corner_attributes["u"][:12], noise)
    one = cube(vertex_attributes={"w": np.zeros(8)})
    other = cube(at=1.0, vertex_attributes={"w": np.ones(8)})
    mesh = (one | other).to_mesh()
    assert "w" not in mesh.vertex_attributes
    assert np.array_equal(
        mesh.corner_attributes["w"], np.repeat(mesh.source[:, :1] == 1, 3, axis=1)
    )


def test_vertices_stay_vertices_where_all_agree() -> None:
    mesh = b.cube(2).to_mesh()
    one = cube(vertex_attributes={"w": mesh.vertices @ [1, 2, 4]})
    other = cube(at=0.5, vertex_attributes={"w": (mesh.vertices + 0.5) @ [1, 2, 4]})
    mesh = (one - other).to_mesh()
    assert np.allclose(mesh.vertex_attributes["w"], mesh.vertices @ [1, 2, 4], rtol=1e-14)
    assert not mesh.corner_attributes


@pytest.mark.parametrize(
    "move",
    [
        lambda s: s,
        lambda s: s.rotate(90, "x"),
        lambda s: s.mirror((1, 0, 0)).translate(1, 2, 3),
        lambda s: s.rotate(33, (1, 2, 3)),
        lambda s: s.mirror((1, 2, 3)).scale((1, 2, 3)),
    ],
)
@pytest.mark.parametrize("evaluated", [False, True])
def test_normals_turn_with_the_solid_and_flip_where_it_is_subtracted(
    move: Callable[[b.Solid], b.Solid], evaluated: bool
) -> None:
    block = b.cube(9).translate(-4, -4, -4)
    made = block - cube(corner_attributes={"normal": np.repeat(normals()[:, None], 3, axis=1)})
    if evaluated:
        assert made.volume > 0
    mesh = move(made).to_mesh()
    told = mesh.corner_attributes["normal"]
    inner = ~np.isnan(told).any(axis=(1, 2))
    assert inner.sum() == 12
    a, c, d = (mesh.vertices[mesh.faces[inner, k]] for k in range(3))
    outward = np.cross(c - a, d - a)
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    assert np.allclose(told[inner], outward[:, None], atol=1e-8)


def test_a_chain_of_general_transforms_keeps_values_with_their_places() -> None:
    mesh = b.cube(2).to_mesh()
    part = cube(vertex_attributes={"where": mesh.vertices}) - b.cube(1)
    turned = part.rotate(20, (1, 1, 0)).translate(0.1, 0, 0)
    cut = (turned - b.cube(1).translate(0.5, 0.5, 0.5)).rotate(-7, "y").mirror((0, 1, 1))
    mesh = (cut | b.cube(1).translate(20, 0, 0)).to_mesh()
    told = mesh.attributes.at_corners("where")
    known = ~np.isnan(told).any(axis=2)
    assert known.any()
    factors = [np.eye(4)]
    one = b.cube(1)
    for moved in (one.rotate(20, (1, 1, 0)), one.translate(0.1, 0, 0), one.rotate(-7, "y")):
        factors.insert(0, moved._factors.product)
    factors.insert(0, one.mirror((0, 1, 1))._factors.product)
    matrix = np.linalg.multi_dot(factors)
    image = told[known] @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.allclose(image, mesh.vertices[mesh.faces[known]], atol=1e-8)


def test_attributes_travel_through_a_mesh_and_through_pickling() -> None:
    part = cube(face_attributes={"id": np.arange(12)}, materials={"m": b.Material((1, 0, 0))})
    made = (part - b.cube(1)).to_mesh()
    again = b.Solid.from_mesh(made) - b.cube(0.5).translate(1.5, 1.5, 1.5)
    assert set(again.to_mesh().face_attributes["id"].tolist()) == set(range(12))
    moved = (part - b.cube(1)).translate(1, 2, 3)
    copy = pickle.loads(pickle.dumps(moved)).to_mesh()
    assert np.array_equal(copy.face_attributes["id"], moved.to_mesh().face_attributes["id"])
    assert copy.materials == {"m": b.Material((1, 0, 0))}
    sent = pickle.loads(pickle.dumps(made))
    assert np.array_equal(sent.face_attributes["id"], made.face_attributes["id"])


def test_solids_without_attributes_pickle_as_ever() -> None:
    assert len(b.cube(1).__reduce__()[1]) == 2
    assert len((b.cube(1) - b.cube(0.5)).__reduce__()[1]) == 2
    assert b.cube(1).to_mesh().carried is None


def test_the_reduced_mesh_and_other_winding_rules_keep_attributes() -> None:
    mesh = b.cube(2).to_mesh()
    vertices = np.concatenate([mesh.vertices, mesh.vertices + 1])
    faces = np.concatenate([mesh.faces, mesh.faces + 8])
    given = {"body": np.repeat([1, 2], 12)}
    rules: list[tuple[WindingRule, float]] = [("positive", 15.0), ("even-odd", 14.0)]
    for rule, volume in rules:
        solid = b.Solid(vertices, faces, winding=rule, face_attributes=given)
        assert solid.volume == volume
        told = solid.normalized().to_mesh().face_attributes["body"]
        assert set(told.tolist()) == {1, 2}
        assert (told == np.where(solid.normalized().to_mesh().source[:, 1] < 12, 1, 2)).all()


def test_faces_left_out_at_import_keep_the_numbers_of_the_others() -> None:
    mesh = b.cube(2).to_mesh()
    faces = np.insert(mesh.faces, 3, [0, 0, 1], axis=0)
    solid = b.Solid(mesh.vertices, faces, face_attributes={"id": np.arange(13)})
    told = (solid - b.cube(1)).to_mesh()
    own = told.source[:, 0] == 0
    assert np.array_equal(told.face_attributes["id"][own], told.source[own, 1])


def test_equal_names_of_different_materials_stay_two() -> None:
    def painted(color: Any, at: float) -> b.Solid:
        given = {"material": np.full(12, "paint")}
        return cube(at=at, face_attributes=given, materials={"paint": b.Material(color)})

    mesh = (painted((1, 0, 0), 0.0) | painted((0, 1, 0), 1.0)).to_mesh()
    named = {name: mesh.materials[name].color[:3] for name in mesh.materials}
    assert named == {"paint": (1, 0, 0), "paint (2)": (0, 1, 0)}
    second = mesh.face_attributes["material"] == "paint (2)"
    assert np.array_equal(second, mesh.source[:, 0] == 1)


def test_attributes_are_made_for_whoever_asks() -> None:
    mesh = (cube(face_attributes={"id": np.arange(12)}) - b.cube(1)).to_mesh()
    assert mesh.carried is not None and mesh.carried._made is None
    assert mesh.face_attributes["id"] is mesh.face_attributes["id"]


def test_different_shapes_under_one_name_are_refused_when_asked_for() -> None:
    one = cube(face_attributes={"c": np.zeros((12, 3))})
    other = cube(at=1.0, face_attributes={"c": np.zeros((12, 4))})
    mesh = (one | other).to_mesh()
    with pytest.raises(b.InvalidMeshError, match="shapes") as caught:
        _ = mesh.face_attributes
    assert caught.value.code == "attributes"
    text = cube(at=1.0, face_attributes={"c": np.full((12, 3), "x")})
    with pytest.raises(b.InvalidMeshError, match="text"):
        _ = (one | text).to_mesh().face_attributes


# Found: colours in bytes beside colours in floats became numbers like 200.0 in silence, and three
# numbers beside four refused the whole operation.
@pytest.mark.parametrize("kind", ["vertex", "face"])
def test_colours_of_operands_come_in_one_form(kind: str) -> None:
    count = {"vertex": 8, "face": 12}[kind]

    def painted(rows: list[Any], at: float, dtype: Any) -> b.Solid:
        colors = np.tile(np.array(rows, dtype), (count, 1))
        said: dict[str, Any] = {f"{kind}_attributes": {"color": colors}}
        return cube(at=at, **said)

    def colors(*solids: b.Solid) -> npt.NDArray[Any]:
        found = b.union(solids).to_mesh().attributes.at_corners("color")
        return np.unique(found.reshape(-1, found.shape[2]), axis=0)

    floats, few = painted([0, 0.5, 1], 0, "f4"), painted([51, 102, 0], 4, "u1")
    mixed = colors(floats, few)
    assert mixed.dtype == np.float32
    assert np.array_equal(mixed, np.array([[0, 0.5, 1], [0.2, 0.4, 0]], "f4"))
    four = painted([51, 102, 0, 51], 8, "u1")
    assert colors(few, four).tolist() == [[51, 102, 0, 51], [51, 102, 0, 255]]
    assert np.allclose(
        colors(floats, four), [[0, 0.5, 1, 1], [0.2, 0.4, 0, 0.2]], rtol=1e-7, atol=0
    )


@pytest.mark.parametrize(
    "options",
    [
        {"vertex_attributes": {"a": np.zeros(7)}},
        {"corner_attributes": {"a": np.zeros((12, 2))}},
        {"face_attributes": {"a": np.zeros(11)}},
        {"face_attributes": {"a": [object()] * 12}},
        {"face_attributes": {"a": np.zeros(12)}, "vertex_attributes": {"a": np.zeros(8)}},
        {"face_attributes": {"": np.zeros(12)}},
        {"face_attributes": {3: np.zeros(12)}},
        {"face_attributes": [1, 2]},
        {"face_attributes": {"a": [[1], [2, 3]]}},
        {"face_attributes": {"a": np.zeros(12)}, "materials": {"m": "red"}},
    ],
)
def test_what_is_no_array_over_the_mesh_is_refused(options: dict[str, Any]) -> None:
    with pytest.raises(b.InvalidMeshError) as caught:
        cube(**options)
    assert caught.value.code == "attributes"


def test_materials_check_what_they_are_given() -> None:
    assert b.Material((1, 0, 0)).color == (1, 0, 0, 1)
    assert b.Material(texture=PIXEL).media == "image/png"
    for wrong in ({"color": (2.0, 0, 0)}, {"color": (1, 0)}, {"texture": b"GIF89a"}):
        with pytest.raises(b.InvalidMeshError):
            b.Material(**wrong)


# Found: assigning to `mesh.face_attributes` changed all later results of the solid.
def test_given_arrays_can_be_changed_afterwards() -> None:
    values = np.arange(12)
    part = cube(face_attributes={"id": values})
    values[:] = 0
    assert part.to_mesh().face_attributes["id"].tolist() == list(range(12))
    with pytest.raises(ValueError, match="read-only"):
        part.to_mesh().face_attributes["id"][0] = 3
    handed_out: Any = part.to_mesh().face_attributes
    with pytest.raises(TypeError):
        handed_out["id"] = 3


def test_trimesh_colours_textures_and_arrays_come_along() -> None:
    import trimesh
    from PIL import Image

    box = trimesh.creation.box((2, 2, 2))
    box.visual.vertex_colors = np.arange(32, dtype=np.uint8).reshape(8, 4)
    mesh = b.Solid.from_mesh(box).to_mesh()
    assert np.array_equal(mesh.vertex_attributes["color"], box.visual.vertex_colors)
    box.visual.face_colors = np.arange(48, dtype=np.uint8).reshape(12, 4)
    box.face_attributes["id"] = np.arange(12)
    mesh = b.Solid.from_mesh(box).to_mesh()
    assert np.array_equal(mesh.face_attributes["color"], box.visual.face_colors)
    assert mesh.face_attributes["id"].tolist() == list(range(12))
    visuals: Any = trimesh.visual
    material = visuals.material.SimpleMaterial(image=Image.new("RGB", (2, 2)))
    box.visual = visuals.TextureVisuals(uv=np.zeros((8, 2)), material=material)
    mesh = b.Solid.from_mesh(box).to_mesh()
    assert mesh.vertex_attributes["uv"].shape == (8, 2)
    (name,) = mesh.materials
    assert mesh.materials[name].media == "image/png"
    assert (mesh.face_attributes["material"] == name).all()
    assert b.Solid.from_mesh(trimesh.creation.box((1, 1, 1))).to_mesh().carried is None


def test_properties_of_manifold_come_along() -> None:
    import manifold3d

    body = manifold3d.Manifold.cube((2, 2, 2)).calculate_normals(0, 30)
    mesh = b.Solid.from_mesh(body).to_mesh()
    told = mesh.corner_attributes["properties"]
    a, c, d = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    outward = np.cross(c - a, d - a)
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    assert np.allclose(told, outward[:, None])


def test_arrays_of_quads_and_of_other_lengths_are_left() -> None:
    vertices, quads = b.cube(1).to_mesh().vertices, [[0, 1, 3, 2]]
    held = SimpleNamespace(face_attributes={"id": [1]}, vertex_attributes={"short": [1, 2]})
    assert attributes_from(held, vertices, quads) == {}


def test_weights_in_slivers_are_as_exact_as_in_others() -> None:
    height = 2.0**-60
    thin = np.array([[[0, 0, 0], [1, 0, 0], [0.5, height, 0]]])
    found = weights(np.array([[0.5, height / 2, 0]]), thin)
    assert np.array_equal(found, [[0.25, 0.25, 0.5]])
    far = np.array([[[1e8, 0, 0], [1e8 + 1, 0, 0], [1e8, 0, 1]]])
    assert np.array_equal(weights(np.array([[1e8 + 0.25, 0, 0.5]]), far), [[0.25, 0.25, 0.5]])


# Found: a half-space that was tagged could not be turned any more.
def test_tagged_half_spaces_are_turned_as_others_are() -> None:
    room = b.box(20, 20, 20, center=True)
    assert (b.half_space("z", 0).tagged(layer=1).rotate(30, "x") & room).volume == 4000
    assert b.Solid.full().tagged(layer=1) == b.Solid.full()


def layers_and_sides(solid: b.Solid) -> set[tuple[int, bool]]:
    """Return the layers of faces, each with whether the face lies beyond x = 2."""
    mesh = solid.to_mesh()
    beyond = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 2
    layers = mesh.face_attributes["layer"]
    return set(zip(layers[layers > 0].tolist(), beyond[layers > 0].tolist(), strict=True))


# Found: if one solid was tagged twice, or once tagged and once not, both had the last tag after
# they were combined.
@pytest.mark.parametrize("shift", [(0, 0, 0), (0, 0, 5)])
def test_each_of_two_tags_of_one_solid_stays_where_it_was_said(
    shift: tuple[float, float, float],
) -> None:
    body = b.cube(4)
    left, right = b.box(1, 9, 9).translate(-0.5, -1, -1), b.box(9, 9, 9).translate(3, -1, -1)
    for tags in ((1, 2), (0, 2)):
        first, second = (body.tagged(layer=tag) if tag else body for tag in tags)
        both = (first & left).translate(*shift) | (second & right).translate(*shift)
        wanted = {(tags[0], False), (tags[1], True)}
        assert layers_and_sides(both) == {(tag, beyond) for tag, beyond in wanted if tag}
    assert first.sources == body.sources
    assert not set(second.sources) & set(body.sources)


def test_tags_change_nothing_but_names() -> None:
    worn = b.sphere(5, segments=40).rotate(20, "x") - b.cube(4) - b.sphere(2).translate(0, 0, -4)
    said = worn.tagged(layer=3)
    for kind in (worn, worn.normalized()):
        told = kind.tagged(layer=3).to_mesh()
        assert np.array_equal(told.vertices, kind.to_mesh().vertices)
        assert np.array_equal(told.faces, kind.to_mesh().faces)
    assert said.volume_exact == worn.volume_exact
    assert said == worn and len(said.sources) == len(worn.sources)
    assert set(said.normalized().to_mesh().face_attributes["layer"].tolist()) == {3}


# Found: the tags of an unbounded solid with operands vanished when it was turned.
def test_tags_of_what_reaches_to_infinity_stay_when_it_is_turned() -> None:
    wedge = (b.cube(4) | b.half_space((1, 0, 0), -3)).tagged(layer=7).tagged(kind=1)
    mesh = (wedge.rotate(30, (1, 2, 3)) & b.sphere(5)).to_mesh()
    assert set(mesh.face_attributes["layer"].tolist()) == {0, 7}
    assert set(mesh.face_attributes["kind"].tolist()) == {0, 1}


# Found: unpickled empty sets that had been tagged could not be combined: a ValueError.
@pytest.mark.parametrize("full", [False, True])
def test_nothing_that_was_tagged_comes_back_from_other_lattices(full: bool) -> None:
    tagged, other = b.cube(1).tagged(layer=1), b.cube(1).translate(5, 5, 5)
    empty = tagged & other
    constant = ~empty if full else empty
    for copy in (pickle.loads(pickle.dumps(constant)), constant):
        again = pickle.loads(pickle.dumps(copy)).tagged(layer=2)
        for kind in (copy, again):
            assert ((kind | other) if not full else (kind & other)).volume == 1
            assert (kind ^ b.Solid(other.vertices, other.faces, pitch=-12)).is_bounded != full
