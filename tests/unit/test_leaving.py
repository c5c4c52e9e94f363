"""Attributes of solids converted to meshes of trimesh and manifold3d, and back."""

import io
from typing import Any

import manifold3d
import numpy as np
import pytest
import trimesh
import trimesh.visual as looks
from PIL import Image

import bspcsg as b

VERTICES, FACES = b.cube(2).to_mesh()


def solid(**options: Any) -> b.Solid:
    return b.Solid(VERTICES, FACES, **options)


def picture(kind: str) -> bytes:
    stream = io.BytesIO()
    Image.effect_noise((8, 8), 50).convert("RGB").save(stream, kind)
    return stream.getvalue()


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
def test_a_picture_is_the_visual(kind: str) -> None:
    wood = b.Material("white", picture(kind))
    uv = np.linspace(0, 1, 16).reshape(8, 2)
    given = solid(
        vertex_attributes={"uv": uv},
        face_attributes={"material": ["wood"] * 12, "color": "red"},
        materials={"wood": wood},
    )
    made: Any = given.to_trimesh()
    assert made.is_volume and made.visual.kind == "texture"
    assert np.array_equal(made.visual.uv, uv)
    assert made.visual.material.baseColorTexture.size == (8, 8)
    back = b.Solid.from_mesh(made).to_mesh()
    assert np.array_equal(back.vertex_attributes["uv"], uv)
    assert back.materials == {"wood": wood}
    assert (back.face_attributes["color"] == (255, 0, 0)).all()
    again = b.Solid.from_mesh(made.export(file_type="glb"), format="glb").to_mesh()
    assert set(again.materials) == {"wood"} and again.materials["wood"].texture
    # What was changed there counts.
    made.visual.material.baseColorTexture = Image.new("RGB", (1, 1))
    assert b.Solid.from_mesh(made).to_mesh().materials["wood"].texture != wood.texture


def test_materials_are_seen_in_their_colours() -> None:
    materials = {"a": b.Material("red"), "b": b.Material("blue")}
    made: Any = solid(
        face_attributes={"material": ["a"] * 6 + ["b"] * 6}, materials=materials
    ).to_trimesh()
    assert made.visual.face_colors[[0, 11]].tolist() == [[255, 0, 0, 255], [0, 0, 255, 255]]
    back = b.Solid.from_mesh(made).to_mesh()
    assert back.attributes.names == ("material",) and back.materials == materials
    made.visual.face_colors[0] = (1, 2, 3, 255)
    assert b.Solid.from_mesh(made).to_mesh().face_attributes["color"][0].tolist() == [1, 2, 3, 255]


def test_pictures_of_several_materials_are_told() -> None:
    materials = {"a": b.Material("red", picture("PNG")), "b": b.Material("blue")}
    given = solid(
        vertex_attributes={"uv": np.zeros((8, 2))},
        face_attributes={"material": ["a"] * 6 + ["b"] * 6},
        materials=materials,
    )
    with pytest.warns(b.LossWarning, match="pictures") as caught:
        made: Any = given.to_trimesh()
    assert caught[0].filename == __file__
    assert b.Solid.from_mesh(made).to_mesh().materials == materials


def test_values_of_corners_hold_for_the_faces_they_are_of() -> None:
    colors = np.arange(12 * 9, dtype=np.uint8).reshape(12, 3, 3)
    with pytest.warns(b.LossWarning, match="mean"):
        made: Any = solid(corner_attributes={"color": colors}).to_trimesh()
    back = b.Solid.from_mesh(made).to_mesh()
    assert np.array_equal(back.corner_attributes["color"], colors)
    turned: Any = trimesh.Trimesh(
        made.vertices, made.faces[:, [1, 2, 0]], metadata=made.metadata, process=False
    )
    turned.visual.face_colors = made.visual.face_colors
    said = b.Solid.from_mesh(turned).to_mesh()
    assert not said.corner_attributes and len(said.face_attributes["color"]) == 12


def test_materials_without_places_come_in() -> None:
    box = trimesh.creation.box()
    library: Any = looks
    kinds = [library.material.PBRMaterial(name=n, baseColorFactor=c) for n, c in PAIRS]
    box.visual = library.TextureVisuals(material=kinds[0])
    assert b.Solid.from_mesh(box).to_mesh().materials == {"x": b.Material("red")}
    several = library.material.MultiMaterial(kinds)
    box.visual = library.TextureVisuals(material=several, face_materials=[0, 1] * 6)
    mesh = b.Solid.from_mesh(box).to_mesh()
    assert mesh.materials == {"x": b.Material("red"), "y": b.Material("blue")}
    assert mesh.face_attributes["material"].tolist() == ["x", "y"] * 6


PAIRS = (("x", [255, 0, 0, 255]), ("y", [0, 0, 255, 255]))


def test_names_of_properties_survive_manifolds_operations() -> None:
    red, blue = (b.cube(2).tagged(color=c, layer=k) for k, c in enumerate(["red", "#00f8"]))
    rest = red.to_manifold() - blue.translate(1, 1, 1).to_manifold()
    mesh = b.Solid.from_mesh(rest).to_mesh()
    assert mesh.volume == 7 and sorted(mesh.face_attributes) == ["color", "layer"]
    at_cut = mesh.face_attributes["layer"] == 1
    assert (mesh.face_attributes["color"][at_cut] == (0, 0, 255, 136)).all() and at_cut.any()
    assert (mesh.face_attributes["color"][~at_cut] == (255, 0, 0, 255)).all()


def test_properties_of_manifold_come_back_in_their_columns() -> None:
    theirs = manifold3d.Manifold.cube((1, 1, 1)).set_properties(2, lambda p, _: [p[0], 7.0])
    again = b.Solid.from_mesh(theirs).tagged(layer=5).to_manifold()
    assert again.num_prop() == 3
    table = again.to_mesh64().vert_properties
    assert (table[:, 3] == table[:, 0]).all() and (table[:, 4:] == (7, 5)).all()
    # Beside properties without names there is no telling which is which.
    mixed = again + theirs.translate((5, 0, 0))
    assert b.Solid.from_mesh(mixed).to_mesh().attributes.names == ("properties",)


@pytest.mark.parametrize("value", [np.nan, np.inf, "text"])
def test_what_is_no_finite_number_stays_here(value: Any) -> None:
    with pytest.warns(b.LossWarning, match="“x”"):
        made = b.cube(1).tagged(x=value, y=1).to_manifold()
    assert made.num_prop() == 1 and made.status().name == "NoError"


@pytest.mark.parametrize("through", ["to_trimesh", "to_manifold"])
def test_empty_and_bare_solids_leave_as_before(through: str) -> None:
    for each in (b.Solid.empty().tagged(x=1), b.cube(1), b.cube(1) - b.cube(2).tagged(x=1)):
        made = getattr(each, through)()
        assert b.Solid.from_mesh(made).volume == each.volume
