"""OBJ: references of all kinds, polygons, continued lines, and refusals."""

import math
import zipfile
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg.errors import not_none
from bspcsg.io import RawMesh, decoded, loads, read, write
from support.io import area, cube_mesh, read_text, refusal, same_mesh, signed_area
from support.pictures import PIXEL

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def test_round_trip(tmp_path: Path) -> None:
    write(cube_mesh(1 / 3), tmp_path / "cube.obj")
    same_mesh(read(tmp_path / "cube.obj"), cube_mesh(1 / 3))


@pytest.mark.parametrize(
    "face",
    [
        "f 1 2 3",
        "f 1/7 2/8 3/9",
        "f 1//7 2//8 3//9",
        "f 1/7/7 2/8/8 3/9/9",
        "f -4 -3 -2",
        "f -4/-1/-1 2 -2//-1",
        "\tf   1 2\\\n 3",
        "f 1 \\\n2 \\\n3  # said in three lines",
    ],
)
def test_references(tmp_path: Path, face: str) -> None:
    text = f"# a comment\nmtllib x.mtl\no thing\ng a b\ns off\n{SQUARE}vn 0 0 1\nvt 0 0\n{face}\n"
    raw = read_text(tmp_path / "x.obj", text)
    assert raw.faces.tolist() == [[0, 1, 2]]
    assert raw.name == "thing"


# Found: the name of an OBJ object that ends in a backslash swallowed the line after it.
@pytest.mark.parametrize(
    ("line", "name"),
    [("o C:\\tmp\\\n", "C:\\tmp\\"), ("o a\\\nb\n", "a b"), ("o a \\\nv\n", "a v")],
)
def test_names_may_end_in_a_backslash(tmp_path: Path, line: str, name: str) -> None:
    raw = read_text(tmp_path / "x.obj", f"{line}{SQUARE}f 1 2 3\n")
    assert (raw.name, len(raw.vertices)) == (name, 4)


# Found: groups of an OBJ whose names end in a backslash swallowed a vertex, a face or a material
# after them.
@pytest.mark.parametrize("word", ["g", "o", "usemtl", "mtllib", "usemap", "shadow_obj"])
@pytest.mark.parametrize("name", ["part\\", "one two\\", "part \\", "part\\\n# a comment"])
@pytest.mark.parametrize("second", ["v 9 9 9", "f 1 2 3", "vn 0 0 1", "l 1 2"])
def test_names_that_end_in_a_backslash_take_no_statement(
    tmp_path: Path, word: str, name: str, second: str
) -> None:
    text = f"{SQUARE}{{}}{second}\nf -4 -3 -2\n"
    wanted = read_text(tmp_path / "x.obj", text.format(""))
    raw = read_text(tmp_path / "x.obj", text.format(f"{word} {name}\n"))
    same_mesh(raw, wanted)
    assert raw.dropped == wanted.dropped


def test_groups_that_go_on_and_names_at_the_end(tmp_path: Path) -> None:
    text = f"g a \\\nb\\\nc\n{SQUARE}f 1 2 3\ng last\\"
    raw = read_text(tmp_path / "x.obj", text)
    assert (raw.vertices.shape, raw.faces.tolist()) == ((4, 3), [[0, 1, 2]])
    refusal(tmp_path / "x.obj", f"{SQUARE}f 1 2 3\\", "truncated")


def test_negative_references_count_from_where_they_stand(tmp_path: Path) -> None:
    triangle = "v {0} 0 0\nv {0} 1 0\nv {0} 0 1\nf -3 -2 -1\n"
    raw = read_text(tmp_path / "x.obj", triangle.format(0) + triangle.format(1))
    assert raw.faces.tolist() == [[0, 1, 2], [3, 4, 5]]


def test_negative_references_to_texture_and_normal_count_from_where_they_stand(
    tmp_path: Path,
) -> None:
    rows = "v {0} 0 0\nv {0} 1 0\nv {0} 0 1\nvt {0} 0\nvt {0} 1\nvn {0} 0 1\n"
    face = "f -3/-2/-1 -2/-1/-1 -1/-3/-1\n"  # the third names no texture the first time
    texts = (rows.format(number) + face for number in (0, 5))
    corner = not_none(read_text(tmp_path / "x.obj", "".join(texts)).attributes, "said").corner
    nowhere = [math.nan, math.nan]
    expected = [[[0, 0], [0, 1], nowhere], [[5, 0], [5, 1], [0, 1]]]
    np.testing.assert_array_equal(corner["uv"], expected)
    np.testing.assert_array_equal(corner["normal"][:, 0, 0], [0, 5])


# Found: an OBJ face whose first corner names no texture lost those of the others.
def test_the_first_corner_may_name_no_texture(tmp_path: Path) -> None:
    raw = read_text(tmp_path / "x.obj", f"{SQUARE}vt 7 8\nf 1 2/1 3/1\n")
    uv = not_none(raw.attributes, "said").corner["uv"]
    np.testing.assert_array_equal(uv, [[[math.nan] * 2, [7, 8], [7, 8]]])


def test_colours_and_weights_are_passed_by(tmp_path: Path) -> None:
    text = "v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 1 1 0 .1 .2 .3 1\nf 1 2 3\n"
    assert read_text(tmp_path / "x.obj", text).vertices.shape == (3, 3)


@pytest.mark.parametrize("start", range(6))
@pytest.mark.parametrize("backwards", [False, True])
def test_concave_polygon_from_any_corner(tmp_path: Path, start: int, backwards: bool) -> None:
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    corners = [*range(start, 6), *range(start)]
    corners = corners[::-1] if backwards else corners
    text = "".join(f"v {x} {y} 0\n" for x, y in outline)
    raw = read_text(tmp_path / "l.obj", text + "f " + " ".join(str(c + 1) for c in corners))
    assert len(raw.faces) == 4
    assert signed_area(raw) == (-3 if backwards else 3)
    assert area(raw) == 3


def test_concave_quad(tmp_path: Path) -> None:
    # An arrow head: only the diagonal through the notch lies inside.
    text = "v 0 0 0\nv 2 -1 0\nv 1 0 0\nv 2 1 0\n"
    for start in range(4):
        face = " ".join(str((start + k) % 4 + 1) for k in range(4))
        raw = read_text(tmp_path / "arrow.obj", f"{text}f {face}\n")
        assert (signed_area(raw), area(raw)) == (1, 1)


def test_polygons_far_out_keep_their_shape(tmp_path: Path) -> None:
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    text = "".join(f"v {x + 1e9} {y + 3e9} 7e8\n" for x, y in outline)
    raw = read_text(tmp_path / "far.obj", text + "f 2 3 4 5 6 1\n")
    assert (signed_area(raw), area(raw)) == (3, 3)


def test_mixed_polygons_keep_their_order(tmp_path: Path) -> None:
    raw = read_text(tmp_path / "x.obj", SQUARE + "f 1 2 3 4\nf 1 2 3\nf 4 3 2 1\n")
    assert len(raw.faces) == 5
    assert raw.faces[2].tolist() == [0, 1, 2]


@pytest.mark.parametrize(
    ("text", "line", "code"),
    [
        (SQUARE + "f 1 2 5\n", 5, "index_out_of_range"),
        (SQUARE + "f 1 2 0\n", 5, "index_out_of_range"),
        (SQUARE + "f -1 -2 -5\n", 5, "index_out_of_range"),
        (SQUARE + "f 1 2 99999999999999999999999\n", 5, "index_out_of_range"),
        (SQUARE + "f 1 2\n", 5, "syntax"),
        (SQUARE + "f\n", 5, "syntax"),
        (SQUARE + "f 1 2 x\n", 5, "syntax"),
        (SQUARE + "f 1 2 1.5\n", 5, "syntax"),
        ("v 0 0\nf 1 1 1\n", 1, "syntax"),
        ("v 0 0 zero\n", 1, "syntax"),
        ("v 0 0 0\nv 0 nan 0\n", 2, "non_finite"),
        ("v 0 0 0\nv 0 -inf 0\n", 2, "non_finite"),
        (SQUARE + "f 1 2 3 \\", 5, "truncated"),
    ],
)
def test_errors_name_the_line(tmp_path: Path, text: str, line: int, code: str) -> None:
    assert f"x.obj:{line}:" in refusal(tmp_path / "x.obj", text, code)


def test_no_mesh_at_all(tmp_path: Path) -> None:
    refusal(tmp_path / "x.obj", "# only a comment\n", "syntax")


def test_curves_are_reported(tmp_path: Path) -> None:
    raw = read_text(tmp_path / "x.obj", SQUARE + "cstype bezier\nf 1 2 3\n")
    assert [finding.code for finding in raw.findings] == ["curves_ignored"]


def painted(names: list[str], files: dict[str, bytes], library: str = "m.mtl") -> RawMesh:
    """Return a square whose two triangles have materials of these names."""
    first, second = names
    faces = f"usemtl {first}\nf 1 2 3\nusemtl {second}\nf 1 3 4\n"
    return decoded("x.obj", f"mtllib {library}\n{SQUARE}{faces}".encode(), ".obj", files)


def colors(raw: RawMesh) -> list[tuple[float, ...]]:
    """Return the colour of each triangle's material."""
    said = not_none(raw.attributes, "said")
    return [said.materials[name].color[:3] for name in said.face["material"].tolist()]


RED, BLUE = (1, 0, 0), (0, 0, 1)


# Found: materials of an OBJ whose names hold a `#` or blanks beyond ASCII were mixed up or lost
# in silence.
@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("Color #1", "Color #2"),
        ("a\u00a0b", "a b"),
        ("a\u3000b", "a\u2003b"),
        ("a # a comment", "b"),
    ],
)
def test_materials_are_found_by_names_of_any_kind(first: str, second: str) -> None:
    library = f"newmtl {first}\nKd 1 0 0\nnewmtl {second}\nKd 0 0 1 # blue\n"
    raw = painted([first, second], {"m.mtl": library.encode()})
    assert colors(raw) == [RED, BLUE]
    assert not raw.dropped and not raw.findings


# Found: names of materials that differ only in Latin-1 characters became one name.
def test_names_that_are_no_utf_8_stay_apart() -> None:
    library = "newmtl \xe4\nKd 1 0 0\nnewmtl \xf6\nKd 0 0 1\n".encode("latin-1")
    text = f"mtllib m.mtl\n{SQUARE}usemtl \xe4\nf 1 2 3\nusemtl \xf6\nf 1 3 4\n".encode("latin-1")
    assert colors(decoded("x.obj", text, ".obj", {"m.mtl": library})) == [RED, BLUE]


# Found: a byte order mark hid the first material of a library.
def test_a_byte_order_mark_hides_no_material() -> None:
    library = "\ufeffnewmtl a\nKd 1 0 0\n".encode()
    assert colors(painted(["a", "a"], {"m.mtl": library})) == [RED, RED]


# Found: a picture that is neither PNG nor JPEG took the material's colour with it, in silence.
def test_a_picture_of_another_kind_leaves_the_colour() -> None:
    library = b"newmtl a\nKd 1 0 0\nd .5\nmap_Kd t.tga\n"
    raw = painted(["a", "a"], {"m.mtl": library, "t.tga": bytes(40)})
    assert not_none(raw.attributes, "said").materials["a"] == b.Material((1, 0, 0, 0.5))
    assert raw.dropped == ("pictures that are neither PNG nor JPEG",)


# Found: `Kd 0.5`, colours above 1 and opacities that are none made a material of an OBJ plain and
# took its picture.
@pytest.mark.parametrize(
    ("color", "meant"),
    [
        ("Kd .5", (0.5, 0.5, 0.5)),
        ("Kd 2 0 -1", (1, 0, 0)),
        ("Kd spectral x.rfl", (0.8, 0.8, 0.8)),
        ("Kd", (0.8, 0.8, 0.8)),
        ("Kd 1 nan 0", (0.8, 0.8, 0.8)),
        ("Kd 1 0 0\nTr x", RED),
        ("Kd 1 0 0\nd -halo 1", RED),
    ],
)
def test_colours_as_libraries_write_them(color: str, meant: tuple[float, ...]) -> None:
    raw = painted(
        ["a", "a"], {"m.mtl": f"newmtl a\n{color}\nmap_Kd p.png".encode(), "p.png": PIXEL}
    )
    material = not_none(raw.attributes, "said").materials["a"]
    assert (material.color[:3], material.texture) == (meant, PIXEL)
    assert bool(raw.dropped) == (meant == (0.8, 0.8, 0.8))


# Found: an `mtllib` of several files was taken for one.
@pytest.mark.parametrize(
    "library", ["m.mtl n.mtl", "n.mtl m.mtl", "m.mtl # n.mtl", "my library.mtl"]
)
def test_a_statement_names_several_libraries(library: str) -> None:
    red = b"newmtl a\nKd 1 0 0\n"
    files = {"m.mtl": red, "n.mtl": b"", "my library.mtl": red}
    raw = painted(["a", "a"], files, library)
    assert colors(raw) == [RED, RED] and not raw.findings


def test_libraries_that_are_missing_are_told_one_by_one() -> None:
    raw = painted(["a", "a"], {"m.mtl": b"newmtl a\nmap_Kd my pic.png\n"}, "m.mtl n.mtl")
    (finding,) = raw.findings
    assert "“my pic.png”, “n.mtl”" in finding.message


# Found: `map_Kd` of a name with a blank was cut to its last word.
@pytest.mark.parametrize("words", ["my pic.png", "-s 1 1 1 my pic.png", "-clamp on pic.png"])
def test_a_picture_is_found_by_its_whole_name(words: str) -> None:
    files = {"m.mtl": f"newmtl a\nmap_Kd {words}\n".encode(), "my pic.png": PIXEL}
    files["pic.png"] = PIXEL if words.startswith("-clamp") else b"another"
    raw = painted(["a", "a"], files)
    assert not_none(raw.attributes, "said").materials["a"].texture == PIXEL


# Found: materials whose names OBJ writes alike became one.
def test_materials_whose_names_become_one_get_names_of_their_own(tmp_path: Path) -> None:
    mesh = b.cube(1).to_mesh()
    names = ["a#", "a_", "a_ (2)", "a b", "a\u00a0b", "\n"]
    given = {name: b.Material((k / 8, 0, 0)) for k, name in enumerate(names)}
    solid = b.Solid(
        mesh.vertices,
        mesh.faces,
        face_attributes={"material": np.repeat(names, 2)},
        materials=given,
    )
    solid.save(tmp_path / "x.obj")
    again = b.load(tmp_path / "x.obj").to_mesh()
    told = [again.materials[name] for name in again.face_attributes["material"].tolist()]
    assert told == [given[name] for name in np.repeat(names, 2).tolist()]
    assert {"a_", "a_ (2)", "a b"} <= set(again.materials)


def of_color(color: tuple[float, ...]) -> b.Solid:
    """Return a cube with one material of this colour."""
    mesh = b.cube(1).to_mesh()
    return b.Solid(
        mesh.vertices,
        mesh.faces,
        face_attributes={"material": np.full(12, "a")},
        materials={"a": b.Material(color, PIXEL)},
    )


def color_in(path: Path) -> tuple[float, ...]:
    """Return the colour of the material "a" in a file."""
    return b.load(path).to_mesh().materials["a"].color[:3]


# Found: an OBJ was replaced although a file beside it could not be written.
@pytest.mark.parametrize("folder", ["q.mtl", "q-0.png"])
def test_an_obj_stays_where_a_file_beside_it_cannot_be(tmp_path: Path, folder: str) -> None:
    (tmp_path / folder).mkdir()
    (tmp_path / "q.obj").write_text("old")
    with pytest.raises(b.FormatError, match=f"{folder}: cannot write this file"):
        of_color(RED).save(tmp_path / "q.obj")
    assert (tmp_path / "q.obj").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([folder, "q.obj"])


# Found: `part 1.obj` replaced the materials of `part_1.obj`.
def test_libraries_of_several_objs_stay_apart(tmp_path: Path) -> None:
    stems = ["part_1", "part 1", "part#1", "part~201", "part\u00a01", "part\\1"]
    for k, stem in enumerate(stems):
        of_color((k / 8, 0, 0)).save(tmp_path / f"{stem}.obj")
    found = [color_in(tmp_path / f"{stem}.obj")[0] for stem in stems]
    assert found == [k / 8 for k in range(len(stems))]
    assert "mtllib part~201.mtl\n" in (tmp_path / "part 1.obj").read_text()


# Found: an OBJ written through a link had its materials in the link's folder.
def test_a_link_and_its_obj_have_one_library(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "link.obj").symlink_to(tmp_path / "in" / "x.obj")
    of_color(BLUE).save(tmp_path / "link.obj")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in", "link.obj"]
    assert color_in(tmp_path / "in" / "x.obj") == color_in(tmp_path / "link.obj") == BLUE


# Found: an OBJ in bytes, in an archive or on standard input took materials and pictures from the
# working folder.
def test_bytes_have_nothing_beside_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    of_color((1, 0, 0)).save(tmp_path / "x.obj")
    monkeypatch.chdir(tmp_path)
    assert not loads(Path("x.obj").read_bytes(), "obj").to_mesh().materials
    with zipfile.ZipFile("x.zip", "w") as archive:
        archive.write("x.obj")
    with zipfile.ZipFile("x.zip") as archive, archive.open("x.obj") as member:
        assert not loads(member, "obj").to_mesh().materials
    with Path("x.obj").open("rb") as file:
        assert len(loads(file, "obj").to_mesh().materials) == 1


# Found: names of objects in Latin-1 became one name in OBJ and STL.
def test_names_of_objects_that_are_no_utf_8_stay_apart() -> None:
    text = f"{SQUARE}o \xe4\nf 1 2 3\no \xf6\nf 1 3 4\n".encode("latin-1")
    assert decoded("x.obj", text, ".obj").objects == (("ä", 1), ("ö", 1))


def test_a_material_that_is_called_like_a_colour_stays_one(tmp_path: Path) -> None:
    vertices, faces = b.cube(1).to_mesh()
    name = "color_ff0000ff"
    red = b.Solid(
        vertices,
        faces,
        face_attributes={"material": [name] * 12},
        materials={name: b.Material("red")},
    )
    red.save(tmp_path / "x.obj")
    assert b.load(tmp_path / "x.obj").to_mesh().materials == {"color_ff0000ff_": b.Material("red")}
