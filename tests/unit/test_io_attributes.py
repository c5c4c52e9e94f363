"""Attributes in files: each format with each kind that it can store, and with others."""

import io
import math
import re
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import bspcsg as b
from bspcsg.io import RawMesh, encoded, read, write
from support.pictures import PIXEL

# What is left out is asked of findings here; that it is warned of, test_attribute_matrix.py says.
pytestmark = pytest.mark.filterwarnings("ignore::bspcsg.LossWarning")


RNG = np.random.default_rng(3)

VERTEX: dict[str, npt.NDArray[Any]] = {
    "color": RNG.integers(0, 256, (8, 4)).astype(np.uint8),
    "weight": RNG.normal(size=8),
    "pair": RNG.normal(size=(8, 2)).astype(np.float32),
    "rank": np.arange(8, dtype=np.int32) - 3,
    "flag": RNG.integers(0, 2, 8).astype(bool),
    "text": np.array(list("abcdefgh")),
}
CORNER: dict[str, npt.NDArray[Any]] = {
    "uv": RNG.uniform(size=(12, 3, 2)),
    "normal": RNG.normal(size=(12, 3, 3)),
    "heat": RNG.normal(size=(12, 3)),
    "tint": RNG.integers(0, 256, (12, 3, 3)).astype(np.uint8),
}
FACE: dict[str, npt.NDArray[Any]] = {
    "material": np.array(["red"] * 5 + [""] * 2 + ["my glass"] * 5),
    "id": np.arange(12) * 7,
    "large": np.arange(12) + 2**40,
    "area": RNG.normal(size=(12, 3)),
}
MATERIALS = {
    "red": b.Material((1, 0, 0)),
    "my glass": b.Material((0.2, 0.4, 0.6, 0.8), PIXEL),
}

#: The attributes of these that each form of each format holds.
HELD: dict[str, set[str]] = {
    ".ply": {
        *["color", "weight", "pair", "rank", "flag", "uv", "normal", "heat", "tint", "id", "area"]
    },
    ".off": {"color"},
    ".obj": {"color", "uv", "normal", "material"},
    ".3mf": {"material", "uv"},
    ".glb": {"color", "weight", "pair", "uv", "normal", "heat", "material"},
    ".stl": set(),
    ".vtu": set(),
}

FORMS = [(suffix, False) for suffix in sorted(HELD)] + [
    (suffix, True) for suffix in (".ply", ".stl", ".obj", ".off")
]


def part() -> b.Solid:
    mesh = b.cube(2).to_mesh()
    return b.Solid(
        mesh.vertices,
        mesh.faces,
        vertex_attributes=VERTEX,
        corner_attributes=CORNER,
        face_attributes=FACE,
        materials=MATERIALS,
    )


def of(mesh: b.Mesh | RawMesh, name: str) -> npt.NDArray[Any]:
    assert mesh.attributes is not None
    return mesh.attributes.at_corners(name)


@pytest.mark.parametrize(("suffix", "text"), FORMS)
def test_what_a_format_holds_reads_back(tmp_path: Path, suffix: str, text: bool) -> None:
    mesh = part().to_mesh()
    findings = write(mesh, tmp_path / f"x{suffix}", text=text)
    raw = read(tmp_path / f"x{suffix}")
    names: set[str] = set() if raw.attributes is None else set(raw.attributes.names)
    assert names == HELD[suffix]
    codes = {one.code: one for one in findings}
    left = codes["attributes_left_out"]
    assert left.count == len({*VERTEX, *CORNER, *FACE} - names)
    for name in names:
        meant, told = of(mesh, name), of(raw, name)
        if meant.dtype.kind == "f" and suffix == ".glb":
            assert np.allclose(told, meant, atol=1e-6)
        elif (suffix, name) == (".3mf", "uv"):
            # What has no picture has no place on it.
            has_picture = FACE["material"] == "my glass"
            assert np.array_equal(told[has_picture], meant[has_picture])
            assert np.isnan(told[~has_picture]).all()
        elif (suffix, name) == (".obj", "color"):
            assert np.allclose(told, meant[..., :3] / 255) and "colors_left_out" in codes
        elif meant.dtype.kind == "b":
            assert np.array_equal(told, meant.astype(np.uint8))
        else:
            assert np.array_equal(told, meant)


@pytest.mark.parametrize("suffix", [".obj", ".glb", ".3mf"])
def test_materials_read_back_with_their_pictures(tmp_path: Path, suffix: str) -> None:
    findings = write(part().to_mesh(), tmp_path / f"my part{suffix}")
    raw = read(tmp_path / f"my part{suffix}")
    assert raw.attributes is not None
    told = raw.attributes.materials
    assert set(told) == {"red", "my glass"}
    assert list(told["red"].color) == [1, 0, 0, 1]
    assert told["my glass"].texture == PIXEL
    behind = (1, 1, 1, 1) if suffix == ".3mf" else (0.2, 0.4, 0.6, 0.8)
    assert np.allclose(told["my glass"].color, behind)
    codes = [one.code for one in findings]
    assert ("colors_left_out" in codes) == (suffix != ".glb")


@pytest.mark.parametrize(
    ("suffix", "kind"),
    [(".3mf", "vertex"), (".3mf", "corner"), (".3mf", "face"), (".glb", "face"), (".off", "face")],
)
def test_colours_of_any_kind_read_back(tmp_path: Path, suffix: str, kind: str) -> None:
    shape = {"vertex": (8,), "corner": (12, 3), "face": (12,)}[kind]
    colors = RNG.integers(0, 256, (*shape, 4)).astype(np.uint8)
    mesh = b.cube(2).to_mesh()
    given: dict[str, Any] = {f"{kind}_attributes": {"color": colors}}
    solid = b.Solid(mesh.vertices, mesh.faces, **given)
    solid.save(tmp_path / f"x{suffix}")
    again = b.load(tmp_path / f"x{suffix}").to_mesh()
    assert np.array_equal(of(again, "color"), of(solid.to_mesh(), "color"))


def test_float_colours_of_vertices_are_those_of_obj(tmp_path: Path) -> None:
    mesh = b.cube(2).to_mesh()
    colors = RNG.uniform(size=(8, 3))
    b.Solid(mesh.vertices, mesh.faces, vertex_attributes={"color": colors}).save(tmp_path / "x.obj")
    assert np.array_equal(b.load(tmp_path / "x.obj").to_mesh().vertex_attributes["color"], colors)


# Found: a colour of 16 bits was another one in OBJ than in 3MF, GLB and OFF.
@pytest.mark.parametrize("suffix", [".obj", ".3mf", ".glb", ".off"])
def test_colours_of_sixteen_bits_are_the_same_in_any_format(tmp_path: Path, suffix: str) -> None:
    mesh = b.cube(2).to_mesh()
    colors: dict[str, Any] = {"color": np.tile(np.array([65535, 32768, 255], np.uint16), (8, 1))}
    b.Solid(mesh.vertices, mesh.faces, vertex_attributes=colors).save(tmp_path / f"x{suffix}")
    told = of(read(tmp_path / f"x{suffix}"), "color")[..., :3].reshape(-1, 3)
    scale = 1 if told.dtype.kind == "f" else 255
    assert np.allclose(told / scale, [1, 0.5, 0], atol=0.005)


# Found: vertices without a colour were `nan nan nan` in OBJ.
def test_vertices_without_a_colour_are_white_in_an_obj(tmp_path: Path) -> None:
    mesh = b.cube(2).to_mesh()
    colors: dict[str, Any] = {"color": np.full((8, 3), 0.5)}
    solid = b.Solid(mesh.vertices, mesh.faces, vertex_attributes=colors)
    (solid | b.cube(2).translate(5, 0, 0)).save(tmp_path / "x.obj")
    assert "nan" not in (tmp_path / "x.obj").read_text()
    told = of(read(tmp_path / "x.obj"), "color").reshape(-1, 3)
    assert {tuple(row) for row in told.tolist()} == {(0.5,) * 3, (1.0,) * 3}


# Found: texture coordinates of which one number is NaN ended in `write_mismatch` in OBJ.
def test_a_corner_of_half_a_place_has_none_in_an_obj(tmp_path: Path) -> None:
    mesh = b.cube(2).to_mesh()
    places = RNG.uniform(size=(12, 3, 2))
    places[0, 0, 1] = math.nan
    b.Solid(mesh.vertices, mesh.faces, corner_attributes={"uv": places}).save(tmp_path / "x.obj")
    places[0, 0] = math.nan
    assert np.array_equal(of(read(tmp_path / "x.obj"), "uv"), places, equal_nan=True)


def test_places_that_no_corner_has_are_left_out_of_an_obj(tmp_path: Path) -> None:
    mesh = b.cube(2).to_mesh()
    given: dict[str, Any] = {"uv": np.full((12, 3, 2), math.nan)}
    findings = b.save(
        b.Solid(mesh.vertices, mesh.faces, corner_attributes=given), tmp_path / "x.obj"
    )
    assert [one.code for one in findings] == ["attributes_left_out"]


# Found: long doubles ended in a `KeyError` in PLY.
@pytest.mark.parametrize("kind", [np.float16, np.float32, np.float64, np.longdouble])
def test_floats_of_any_width_go_to_ply(tmp_path: Path, kind: Any) -> None:
    mesh = b.cube(2).to_mesh()
    given: dict[str, Any] = {"q": np.arange(8).astype(kind) / 4}
    b.Solid(mesh.vertices, mesh.faces, vertex_attributes=given).save(tmp_path / "x.ply")
    assert np.array_equal(of(read(tmp_path / "x.ply"), "q"), given["q"][mesh.faces])


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".glb", ".3mf", ".off"])
def test_a_result_of_files_keeps_what_they_said(tmp_path: Path, suffix: str) -> None:
    part().save(tmp_path / f"x{suffix}")
    made = b.load(tmp_path / f"x{suffix}") - b.cube(1).translate(1.5, 1.5, 1.5)
    made.save(tmp_path / f"y{suffix}")
    again = read(tmp_path / f"y{suffix}")
    told: set[str] = set() if again.attributes is None else set(again.attributes.names)
    # Both sides of the cut have colours of their own, and GLB cannot say that there is no number.
    lost = {".off": {"color"}, ".obj": {"color"}, ".glb": {"weight", "pair", "heat"}}.get(
        suffix, set()
    )
    assert told == HELD[suffix] - lost


def test_attributes_can_be_left_in_the_file(tmp_path: Path) -> None:
    part().save(tmp_path / "x.ply")
    assert b.load(tmp_path / "x.ply", attributes=False).to_mesh().carried is None


@pytest.mark.parametrize("wrong", [-1, 7, "x", None])
def test_a_material_that_does_not_exist_is_refused(tmp_path: Path, wrong: Any) -> None:
    import json

    part().save(tmp_path / "x.glb")
    data = (tmp_path / "x.glb").read_bytes()
    size = int.from_bytes(data[12:16], "little")
    tree = json.loads(data[20 : 20 + size])
    tree["meshes"][0]["primitives"][0]["material"] = wrong
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + size :]
    head = b"glTF" + (2).to_bytes(4, "little") + (20 + len(text) + len(rest)).to_bytes(4, "little")
    (tmp_path / "y.glb").write_bytes(head + len(text).to_bytes(4, "little") + b"JSON" + text + rest)
    with pytest.raises(b.FormatError):
        read(tmp_path / "y.glb")


def test_objects_in_one_file_keep_their_own(tmp_path: Path) -> None:
    mesh = part().to_mesh()
    both = RawMesh(
        np.concatenate([mesh.vertices, mesh.vertices + 5]),
        np.concatenate([mesh.faces, mesh.faces + 8]),
        objects=(("lid", 12), ("body", 12)),
        attributes=None,
    )
    said = b.Solid(
        both.vertices, both.faces, face_attributes={"material": np.repeat(["a", "b"], 12)}
    ).to_mesh()
    both = replace(both, attributes=said.attributes)
    for suffix in (".glb", ".3mf", ".obj"):
        write(both, tmp_path / f"x{suffix}")
        raw = read(tmp_path / f"x{suffix}")
        assert raw.objects == both.objects
        assert raw.attributes is not None
        assert raw.attributes.face["material"].tolist() == ["a"] * 12 + ["b"] * 12


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".glb", ".3mf", ".off"])
def test_meshes_without_attributes_have_the_bytes_they_had(suffix: str) -> None:
    mesh = b.cube(2).to_mesh()
    bare = b"".join(encoded(mesh, "x", suffix).chunks)
    again = b"".join(encoded(RawMesh(mesh.vertices, mesh.faces), "x", suffix).chunks)
    assert bare == again
    assert b"color" not in bare
    assert b"material" not in bare


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".glb", ".3mf", ".off"])
def test_the_proof_sees_a_value_that_is_another(suffix: str) -> None:
    mesh = part().to_mesh()
    made = encoded(mesh, "x", suffix)
    data = b"".join(made.chunks)
    made.prove(io.BytesIO(data))
    given: dict[str, Any] = {".off": VERTEX["color"]}
    other = {**VERTEX, "color": np.roll(given.get(suffix, VERTEX["color"]), 1, axis=0)}
    faces = {**FACE, "material": FACE["material"][::-1]}
    changed = b.Solid(
        mesh.vertices,
        mesh.faces,
        vertex_attributes=other,
        corner_attributes=CORNER,
        face_attributes=faces,
        materials=MATERIALS,
    ).to_mesh()
    with pytest.raises(b.FormatError) as caught:
        made.prove(io.BytesIO(b"".join(encoded(changed, "x", suffix).chunks)))
    assert caught.value.code == "write_mismatch"
    with pytest.raises(b.FormatError):
        made.prove(io.BytesIO(b"".join(encoded(b.cube(2).to_mesh(), "x", suffix).chunks)))


def test_columns_of_other_programs_are_known(tmp_path: Path) -> None:
    header = (
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
        "property float texture_u\nproperty float texture_v\nproperty uchar red\n"
        "property uchar green\nproperty uchar blue\nproperty float quality\n"
        "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\n"
        "property list uchar float texcoord\nend_header\n"
    )
    corners = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"]
    rows = "".join(f"{place} 0 0 1 0.5 0.25 1 2 3 9.5\n" for place in corners)
    (tmp_path / "x.ply").write_text(header + rows + "4 0 1 2 3 7 8 0 0 1 0 1 1 0 1\n")
    raw = read(tmp_path / "x.ply")
    assert raw.attributes is not None
    assert set(raw.attributes.vertex) == {"normal", "uv", "color", "quality"}
    assert raw.attributes.vertex["color"].tolist() == [[1, 2, 3]] * 4
    assert raw.attributes.face["red"].tolist() == [7, 7]


def test_an_obj_without_its_library_keeps_the_names(tmp_path: Path) -> None:
    (tmp_path / "x.obj").write_text(
        "mtllib no.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl red\nf 1 3 2\n"
    )
    raw = read(tmp_path / "x.obj")
    assert raw.attributes is not None
    assert raw.attributes.face["material"].tolist() == ["", "red"]
    assert not raw.attributes.materials
    assert any("no.mtl" in one.message for one in raw.findings)


@pytest.mark.parametrize("name", ["../x.mtl", "/etc/passwd", "sub/x.mtl", ".."])
def test_a_library_lies_beside_its_obj(tmp_path: Path, name: str) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "x.mtl").write_text("newmtl red\nKd 1 0 0\n")
    (tmp_path / "in" / "x.obj").write_text(
        f"mtllib {name}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"
    )
    raw = read(tmp_path / "in" / "x.obj")
    assert raw.attributes is not None and not raw.attributes.materials


#: Materials of a cube's sides, all but the last with a picture; the names are hard to write down.
NAMES = ["a/b", "a_b", "ä 1%", "..", "A/B", "red"]


def pictured() -> b.Solid:
    mesh = b.cube(2).to_mesh()
    return b.Solid(
        mesh.vertices,
        mesh.faces,
        corner_attributes={"uv": CORNER["uv"].astype(np.float32)},
        face_attributes={"material": np.repeat(NAMES, 2)},
        materials={name: b.Material(texture=PIXEL) for name in NAMES[:-1]},
    )


def test_names_of_pictures_are_fit_for_parts(tmp_path: Path) -> None:
    pictured().save(tmp_path / "x.3mf")
    again = b.load(tmp_path / "x.3mf").to_mesh()
    fit = ["a_b_", "a_b", "ä 1%", "__", "A_B", "red"]
    assert again.face_attributes["material"].tolist() == np.repeat(fit, 2).tolist()
    assert all(again.materials[name].texture == PIXEL for name in fit[:-1])
    assert again.materials["red"].texture is None
    assert np.array_equal(of(again, "uv")[:10], CORNER["uv"][:10].astype(np.float32))


def test_pictures_stay_through_operations_and_assemblies(tmp_path: Path) -> None:
    pictured().save(tmp_path / "x.3mf")
    whole = b.Assembly.load(tmp_path / "x.3mf").to_solid()
    made = whole - b.cube(1).translate(1.5, 1.5, 1.5)
    made.save(tmp_path / "y.3mf")
    mesh = b.load(tmp_path / "y.3mf").to_mesh()
    flat = mesh.face_attributes["material"] == "ä 1%"
    assert flat.any() and mesh.materials["ä 1%"].texture == PIXEL
    assert not np.isnan(of(mesh, "uv")[flat]).any()


def repacked(source: Path, target: Path, change: dict[str, tuple[bytes, bytes]]) -> Path:
    """Copy an archive with text in some members replaced."""
    with zipfile.ZipFile(source) as given, zipfile.ZipFile(target, "w") as made:
        for name in given.namelist():
            old, new = change.get(name, (b"", b""))
            if old or name not in change:
                made.writestr(name, given.read(name).replace(old, new, 1 if old else 0))
    return target


def test_packages_of_pictures_are_as_the_standard_has_them(tmp_path: Path) -> None:
    pictured().save(tmp_path / "x.3mf")
    with zipfile.ZipFile(tmp_path / "x.3mf") as archive:
        parts = set(archive.namelist())
        types = archive.read("[Content_Types].xml").decode()
        relations = archive.read("3D/_rels/3dmodel.model.rels").decode()
        model = archive.read("3D/3dmodel.model").decode()
    paths = re.findall(r'<m:texture2d id="\d+" path="([^"]*)" contenttype="image/png"/>', model)
    assert len(paths) == 5 and "/3D/Textures/5/%C3%A4%201%25.png" in paths
    assert set(re.findall('Target="([^"]*)"', relations)) == set(paths)
    assert {path[1:] for path in paths} < parts and 'Extension="png"' in types


def test_pictures_that_are_missing_are_told(tmp_path: Path) -> None:
    pictured().save(tmp_path / "x.3mf")
    gone = {"3D/Textures/5/%C3%A4%201%25.png": (b"", b"")}
    raw = read(repacked(tmp_path / "x.3mf", tmp_path / "y.3mf", gone))
    assert raw.attributes is not None and raw.dropped == ("textures",)
    assert raw.attributes.materials["ä 1%"] == b.Material()
    for old, new in ((b'texid="', b'texid="9'), (b' u="', b' u="nan'), (b' u="', b' u="x')):
        wrong = {"3D/3dmodel.model": (old, new)}
        with pytest.raises(b.FormatError):
            read(repacked(tmp_path / "x.3mf", tmp_path / "z.3mf", wrong))


def test_a_wrong_property_of_3mf_is_refused(tmp_path: Path) -> None:
    mesh = b.cube(1).to_mesh()
    solid = b.Solid(
        mesh.vertices, mesh.faces, face_attributes={"color": np.zeros((12, 3), np.uint8)}
    )
    solid.save(tmp_path / "x.3mf")
    with zipfile.ZipFile(tmp_path / "x.3mf") as archive:
        model = archive.read("3D/3dmodel.model")
    for wrong in (b'p1="9"', b'p1="-1"', b'p1="x"'):
        with zipfile.ZipFile(tmp_path / "y.3mf", "w") as archive:
            archive.writestr("3D/3dmodel.model", model.replace(b'p1="0"', wrong, 1))
        with pytest.raises(b.FormatError):
            read(tmp_path / "y.3mf")


# Found: names of materials that a 3MF or a GLB cannot hold, and attributes called `color`, `uv`
# or `normal` that are none, ended in `write_mismatch` or a raw UnicodeEncodeError.
@pytest.mark.parametrize("texture", [None, PIXEL])
@pytest.mark.parametrize("suffix", [".glb", ".3mf"])
def test_names_of_materials_are_fit_for_files(
    tmp_path: Path, suffix: str, texture: bytes | None
) -> None:
    bad = "a\ud800"
    fit = "a?" if suffix == ".glb" else "a\ufffd"
    mesh = b.cube(1).to_mesh()
    colored = b.Solid(
        mesh.vertices,
        mesh.faces,
        corner_attributes={"uv": np.zeros((12, 3, 2))},
        face_attributes={"material": np.repeat([bad, fit, "x\x01y"], 4)},
        materials={bad: b.Material(texture=texture), "x\x01y": b.Material((0, 0, 1))},
    )
    for save in (colored.save, b.Assembly("all", [colored]).save):
        save(tmp_path / f"x{suffix}")
        again = b.load(tmp_path / f"x{suffix}").to_mesh()
        third = "x\x01y" if suffix == ".glb" else "x\ufffdy"
        names = [f"{fit} (2)", fit, third]
        assert again.face_attributes["material"].tolist() == np.repeat(names, 4).tolist()
        assert again.materials[names[0]].texture == texture
        assert again.materials[third].color == (0, 0, 1, 1)


# Found: a solid whose faces have no material any more, though others of the same source had,
# ended in `write_mismatch` in 3MF and GLB.
@pytest.mark.parametrize("suffix", [".glb", ".3mf"])
def test_faces_without_any_material_have_their_colours(tmp_path: Path, suffix: str) -> None:
    mesh = b.cube(1).to_mesh()
    bare = {"material": np.full(12, "")}
    colors = np.full((12, 4), 51, "u1")
    both = b.Solid(mesh.vertices, mesh.faces, face_attributes={**bare, "color": colors})
    both.save(tmp_path / f"x{suffix}")
    assert (of(b.load(tmp_path / f"x{suffix}").to_mesh(), "color") == 51).all()
    plain = b.Solid(mesh.vertices, mesh.faces, face_attributes=bare)
    plain.save(tmp_path / f"x{suffix}")
    blue = (0.0, 0.0, 1.0, 1.0)
    b.Assembly("blue", [plain], color=blue).save(tmp_path / f"y{suffix}")
    assert b.Assembly.load(tmp_path / f"y{suffix}").parts[0].color == blue


# Found: a solid whose faces have no material any more ended in `write_mismatch` in OBJ.
def test_an_obj_of_faces_without_any_material_is_written_without(tmp_path: Path) -> None:
    mesh = b.cube(1).to_mesh()
    bare = {"material": np.full(12, "")}
    plain = b.Solid(mesh.vertices, mesh.faces, face_attributes=bare)
    plain.save(tmp_path / "x.obj")
    assert read(tmp_path / "x.obj").attributes is None
    assert not (tmp_path / "x.mtl").exists()


# Found: numbers of faces called `material` beside materials ended in `write_mismatch` in PLY.
@pytest.mark.parametrize("suffix", [".ply", ".obj", ".3mf", ".glb"])
def test_numbers_called_materials_name_none(tmp_path: Path, suffix: str) -> None:
    mesh = b.cube(1).to_mesh()
    solid = b.Solid(
        mesh.vertices,
        mesh.faces,
        face_attributes={"material": np.arange(12)},
        materials={"red": b.Material((1, 0, 0))},
    )
    solid.save(tmp_path / f"x{suffix}")
    said = read(tmp_path / f"x{suffix}").attributes
    assert (said is None) == (suffix != ".ply")
    assert said is None or said.face["material"].tolist() == list(range(12))


# Found: a material with a picture whose name is not fit for a part of a 3MF took that of another
# material, and was refused.
def test_a_picture_fit_for_a_part_has_no_name_of_another_material(tmp_path: Path) -> None:
    mesh = b.cube(1).to_mesh()
    said = b.Solid(
        mesh.vertices,
        mesh.faces,
        corner_attributes={"uv": np.zeros((12, 3, 2))},
        face_attributes={"material": np.repeat(["a/b", "a_b"], 6)},
        materials={"a/b": b.Material(texture=PIXEL), "a_b": b.Material((1, 0, 0))},
    )
    said.save(tmp_path / "x.3mf")
    again = b.load(tmp_path / "x.3mf").to_mesh()
    assert again.face_attributes["material"].tolist() == ["a_b_"] * 6 + ["a_b"] * 6
    assert again.materials["a_b_"].texture == PIXEL and again.materials["a_b"].texture is None


@pytest.mark.parametrize(
    "name", ["color", "normal", "uv", "NORMAL", "COLOR_0", "_", "material", "x\ud800", "x\x01"]
)
def test_floats_of_any_name_are_held_or_left_out(tmp_path: Path, name: str) -> None:
    mesh = b.cube(1).to_mesh()
    values = np.linspace(0, 1, len(mesh.vertices), dtype="f4")
    named = b.Solid(mesh.vertices, mesh.faces, vertex_attributes={name: values})
    codes = [one.code for one in b.save(named, tmp_path / "x.glb")]
    again = b.load(tmp_path / "x.glb").to_mesh()
    held = {} if again.carried is None else again.vertex_attributes
    assert list(held) == ([] if "attributes_left_out" in codes else [name])
    assert ("attributes_left_out" in codes) == (
        name in ("color", "normal", "uv", "material", "x\ud800")
    )
