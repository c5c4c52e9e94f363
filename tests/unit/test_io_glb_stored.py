"""GLB of other programs: quantised, sparse and interleaved numbers, and instances."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg.errors import FormatError
from bspcsg.io import RawMesh, read
from corpus.broken import glb_of
from support.glb import Numbers, Scene
from support.io import refusal
from support.pictures import PIXEL
from support.shapes import cube


def scene_of(vertices: Numbers | None = None, stride: int = 0, **accessor: Any) -> Scene:
    """Return a GLB scene with a cube of edge 2 metres, or with other vertices."""
    usual, faces = cube(2.0)
    points = np.asarray(usual, "f4") if vertices is None else vertices
    return Scene(points, faces, stride, **accessor)


def read_back(scene: Scene, folder: Path) -> RawMesh:
    path = folder / "x.glb"
    path.write_bytes(scene.bytes())
    return read(path)


def volume(mesh: RawMesh) -> float:
    """Return the volume of a mesh in cubic metres."""
    return b.Solid(mesh.vertices, mesh.faces).volume / 1e9


@pytest.mark.parametrize("kind", ["i1", "u1", "i2", "u2"])
@pytest.mark.parametrize("is_fraction", [False, True])
def test_positions_in_few_bytes(tmp_path: Path, kind: str, is_fraction: bool) -> None:
    largest = np.iinfo(kind).max
    corners = (cube(1.0)[0] * largest).astype(kind)
    scene = scene_of(corners, stride=8, normalized=is_fraction)
    scene.node["scale"] = [2.0] * 3 if is_fraction else [2.0 / largest] * 3
    scene.tree["extensionsRequired"] = ["KHR_mesh_quantization"]
    assert volume(read_back(scene, tmp_path)) == pytest.approx(8, rel=1e-6)


def test_the_least_number_is_no_less_than_minus_one(tmp_path: Path) -> None:
    corners = np.where(cube(1.0)[0] > 0, 127, -128).astype("i1")
    mesh = read_back(scene_of(corners, stride=4, normalized=True), tmp_path)
    assert mesh.vertices.min() == -1000 and mesh.vertices.max() == 1000


def test_positions_of_other_kinds_are_refused(tmp_path: Path) -> None:
    scene = scene_of(np.asarray(cube(2.0)[0], "u4"))
    refusal(tmp_path / "x.glb", scene.bytes(), "syntax")


def test_what_replaces_elements_of_an_accessor(tmp_path: Path) -> None:
    scene = scene_of()
    (corner,) = np.flatnonzero((cube(2.0)[0] == 2).all(axis=1))
    scene.replace(0, [int(corner)], np.array([[3, 3, 3]], "f4"))
    plain = scene_of(np.where(np.arange(8)[:, None] == corner, 3, cube(2.0)[0]).astype("f4"))
    found, expected = read_back(scene, tmp_path), read_back(plain, tmp_path)
    assert np.array_equal(found.vertices, expected.vertices)
    assert np.array_equal(found.faces, expected.faces)


def outside(sparse: dict[str, Any]) -> None:
    sparse["values"]["byteOffset"] = 1 << 20


def before(sparse: dict[str, Any]) -> None:
    sparse["values"]["byteOffset"] = -4


def counted_back(sparse: dict[str, Any]) -> None:
    sparse["indices"]["componentType"] = 5120


def too_many(sparse: dict[str, Any]) -> None:
    sparse["count"] = 9


@pytest.mark.parametrize(
    ("place", "edit", "code"),
    [
        (8, lambda sparse: None, "index_out_of_range"),
        (255, counted_back, "index_out_of_range"),
        (7, outside, "truncated"),
        (7, before, "truncated"),
        (7, too_many, "syntax"),
        (7, lambda sparse: sparse.pop("values"), "syntax"),
    ],
)
def test_replacements_that_are_not_there(
    tmp_path: Path, place: int, edit: Callable[[dict[str, Any]], Any], code: str
) -> None:
    scene = scene_of()
    edit(scene.replace(0, [place], np.ones((1, 3), "f4")))
    refusal(tmp_path / "x.glb", scene.bytes(), code)


# Found: GLB: an accessor that nobody reads refused the file if it was sparse.
def test_shapes_that_it_could_take_are_dropped_by_name(tmp_path: Path) -> None:
    """Blender stores only the corners that move, on no others: nobody needs to read them."""
    scene = scene_of()
    scene.tree["accessors"].append({"componentType": 5126, "count": 8, "type": "VEC3"})
    scene.replace(2, [3], np.ones((1, 3), "f4"))
    scene.primitive["targets"] = [{"POSITION": 2}]
    mesh = read_back(scene, tmp_path)
    assert volume(mesh) == pytest.approx(8) and mesh.dropped == ("morph targets",)


# Found: an accessor of a GLB of which only some elements are given, the others being zeros, was
# refused.
def test_what_has_no_data_is_zeros_but_for_what_replaces_them(tmp_path: Path) -> None:
    scene = scene_of()
    points = np.asarray(cube(2.0)[0], "f4")
    places = np.flatnonzero(points.any(axis=1)).tolist()
    scene.tree["accessors"].append({"componentType": 5126, "count": 8, "type": "VEC3"})
    scene.replace(2, places, points[places])
    scene.primitive["attributes"]["POSITION"] = 2
    assert volume(read_back(scene, tmp_path)) == 8
    scene.tree["accessors"][2] |= {"count": 1 << 40}
    said = refusal(tmp_path / "x.glb", scene.bytes(), "too_large")
    assert "accessor 2" in said
    scene.tree["accessors"][2] |= {"count": -1}
    refusal(tmp_path / "x.glb", scene.bytes(), "syntax")


# Found: a GLB that needs an extension that is not known was read without a word.
@pytest.mark.parametrize(
    ("extension", "is_read"),
    [("KHR_materials_unlit", True), ("KHR_texture_basisu", True), ("CESIUM_RTC", False)],
)
def test_a_file_that_needs_an_extension(tmp_path: Path, extension: str, is_read: bool) -> None:
    scene = scene_of()
    scene.tree["extensionsRequired"] = [extension]
    if is_read:
        assert volume(read_back(scene, tmp_path)) == pytest.approx(8)
    else:
        assert extension in refusal(tmp_path / "x.glb", scene.bytes(), "unsupported")


# Found: a GLB with its data as text in the description was refused because it lay in another
# file.
def test_data_written_as_text_is_refused_as_such(tmp_path: Path) -> None:
    scene = scene_of()
    data = scene.bytes()
    path = tmp_path / "x.glb"
    text = json.dumps(scene.tree | {"buffers": [{"byteLength": 3, "uri": "data:;base64,AAAA"}]})
    assert "as text" in refusal(path, glb_of(text.encode(), scene.data), "unsupported")
    path.write_bytes(data)
    assert volume(read(path)) == pytest.approx(8)


# Found: GLB: a mesh that an extension shows at many places was read at one, in silence.
def test_a_mesh_at_many_places(tmp_path: Path) -> None:
    scene = scene_of()
    scene.node["scale"] = [0.5, 0.5, 0.5]
    scene.place(
        TRANSLATION=np.array([[0, 0, 0], [10, 0, 0], [0, 20, 0]], "f4"),
        ROTATION=np.array([[0, 0, 0, 32767], [0, 0, 32767, 0], [0, 0, 23170, 23170]], "i2"),
        SCALE=np.array([[1, 1, 1], [2, 1, 1], [1, -1, 3]], "f4"),
    )
    mesh = read_back(scene, tmp_path)
    assert [name for name, _ in mesh.objects] == ["part"] * 3
    parts = b.Solid(mesh.vertices, mesh.faces).decompose()
    assert [part.volume / 1e9 for part in parts] == pytest.approx([3, 2, 1], rel=1e-4)
    boxes = [np.round(np.array(part.bounds) / 1000, 3).tolist() for part in parts]
    # The half turn about z takes the second to negative x and y, the quarter turn of what was
    # turned over in y the third to positive ones. Up is y in the file.
    assert boxes == [
        [[0, -3, 10], [1, 0, 11]],
        [[3, -1, -1], [5, 0, 0]],
        [[0, -1, 0], [1, 0, 1]],
    ]


def test_many_places_share_their_mesh_in_an_assembly(tmp_path: Path) -> None:
    scene = scene_of()
    scene.place(TRANSLATION=np.array([[0, 0, 0], [10, 0, 0]], "f4"))
    scene.tree["extensionsRequired"] = []
    (tmp_path / "x.glb").write_bytes(scene.bytes())
    assembly = b.Assembly.load(tmp_path / "x.glb")
    first, second = assembly.parts
    assert first.shape is second.shape
    assert first.solid.volume + second.solid.volume == pytest.approx(16e9)


@pytest.mark.parametrize(
    ("given", "code"),
    [
        ({}, "syntax"),
        ({"TRANSLATION": (2, 3), "SCALE": (3, 3)}, "syntax"),
        ({"TRANSLATION": (2, 4)}, "syntax"),
        ({"SCALE": (12 << 20, 3)}, "too_large"),
    ],
)
def test_places_that_do_not_fit(
    tmp_path: Path, given: dict[str, tuple[int, int]], code: str
) -> None:
    scene = scene_of()
    scene.place(**{key: np.ones(shape, "u1") for key, shape in given.items()})
    refusal(tmp_path / "x.glb", scene.bytes(), code)


# Found: GLB: texture coordinates in bytes were 255 times too large; those of another set were
# taken for those of the picture.
def test_texture_coordinates_in_bytes_and_the_set_that_a_material_means(tmp_path: Path) -> None:
    scene = scene_of()
    first, second = np.full((8, 2), 51, "u1"), np.full((8, 2), 0.25, "f4")
    scene.primitive["attributes"] |= {
        "TEXCOORD_0": scene.add(first, normalized=True),
        "TEXCOORD_1": scene.add(second),
    }
    mesh = read_back(scene, tmp_path)
    assert mesh.attributes is not None and mesh.dropped == ("further texture coordinates",)
    assert np.allclose(mesh.attributes.vertex["uv"], [0.2, 0.8])
    picture = {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": {"scale": [2]}}}
    scene.tree["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": picture}}]
    scene.primitive["material"] = 0
    mesh = read_back(scene, tmp_path)
    assert mesh.attributes is not None
    assert mesh.dropped == ("further texture coordinates", "texture transforms")
    assert np.allclose(mesh.attributes.vertex["uv"], [0.25, 0.75])


def test_what_is_not_read_is_named(tmp_path: Path) -> None:
    scene = scene_of()
    four = scene.add(np.zeros((8, 4), "f4"))
    scene.primitive["attributes"] |= dict.fromkeys(["COLOR_1", "TANGENT", "WEIGHTS_0"], four)
    assert read_back(scene, tmp_path).dropped == ("further colours", "tangents", "weights")


# Found: GLB: a picture in WebP or KTX2, or one in another file, was lost in silence.
@pytest.mark.parametrize(
    ("texture", "is_kept"),
    [
        ({"source": 1}, True),
        ({"source": 0}, False),
        ({"extensions": {"EXT_texture_webp": {"source": 0}}}, False),
        ({"extensions": {"KHR_texture_basisu": {"source": 0}}}, False),
        ({"source": 1, "extensions": {"EXT_texture_webp": {"source": 0}}}, True),
    ],
)
def test_pictures_that_are_not_kept_are_told(
    tmp_path: Path, texture: dict[str, Any], is_kept: bool
) -> None:
    scene = scene_of()
    webp = b"RIFF\x10\0\0\0WEBPVP8 "
    views = [scene.view(np.frombuffer(picture, "u1")) for picture in (webp, PIXEL)]
    scene.tree["images"] = [
        {"bufferView": view, "mimeType": f"image/{kind}"}
        for view, kind in zip(views, ("webp", "png"), strict=True)
    ]
    scene.tree["textures"] = [texture]
    scene.tree["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    scene.primitive["material"] = 0
    mesh = read_back(scene, tmp_path)
    assert mesh.attributes is not None
    (material,) = mesh.attributes.materials.values()
    assert material.texture == (PIXEL if is_kept else None)
    told = ("pictures other than PNG and JPEG in the file",)
    assert mesh.dropped == (() if is_kept else told)


def test_a_compressed_mesh_is_refused(tmp_path: Path) -> None:
    scene = scene_of()
    scene.tree["extensionsRequired"] = ["EXT_meshopt_compression"]
    with pytest.raises(FormatError, match="EXT_meshopt_compression"):
        read_back(scene, tmp_path)


def test_colours_of_a_mesh_come_in_one_form(tmp_path: Path) -> None:
    scene = scene_of()
    scene.primitive["attributes"]["COLOR_0"] = scene.add(
        np.full((8, 4), 255, "u1"), normalized=True
    )
    other = dict(scene.primitive["attributes"], COLOR_0=scene.add(np.full((8, 3), 0.5, "f4")))
    other["POSITION"] = scene.add(np.asarray(cube(2.0)[0] + 5, "f4"))
    scene.tree["meshes"][0]["primitives"].append(scene.primitive | {"attributes": other})
    said = read_back(scene, tmp_path).attributes
    assert said is not None
    colors = said.at_corners("color")
    assert colors.dtype == np.float32
    assert np.allclose(colors[0, 0], 1, rtol=0, atol=1e-6)
    assert np.allclose(colors[-1, 0], [0.7353570] * 3 + [1], rtol=0, atol=1e-6)


@pytest.mark.parametrize("is_flat", [False, True])
def test_assemblies_pass_by_lines_and_what_is_flat(tmp_path: Path, is_flat: bool) -> None:
    scene = scene_of()
    primitive = scene.primitive if is_flat else scene.primitive | {"mode": 1}
    scene.tree["meshes"].append({"primitives": [primitive]})
    scene.tree["nodes"].append({"mesh": 1, "scale": [1, 1, int(not is_flat)]})
    path = tmp_path / "x.glb"
    path.write_bytes(scene.bytes())
    assert b.load(path).volume == 8e9
    assert [part.solid.volume for part in b.Assembly.load(path)] == [8e9]
