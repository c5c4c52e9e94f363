"""Assemblies: trees of named, coloured, placed solids."""

import math
from collections.abc import Iterable
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from support.pictures import PIXEL

# What is left out is asked of findings here; that it is warned of, test_attribute_matrix.py says.
pytestmark = pytest.mark.filterwarnings("ignore::bspcsg.LossWarning")


RED, GREY = (1.0, 0.0, 0.0, 1.0), (0.2, 0.2, 0.2, 1.0)

#: The findings that files of a format always come with.
UNITS = {".3mf": [], ".glb": ["unit"]}


def codes_of(findings: Iterable[b.Finding]) -> list[str]:
    return [finding.code for finding in findings]


def car() -> b.Assembly:
    wheel = b.Assembly("wheel", b.cylinder(h=2, r=5, segments=16), color=GREY, density=2)
    axle = b.Assembly("axle", [wheel, wheel.translate(0, 0, 20)])
    body = b.Assembly("body", b.box((10, 10, 10)).translate(0, 0, 6), color=RED)
    return b.Assembly("car", [axle, axle.translate(40, 0, 0), body], density=1)


def test_parts_have_paths_places_and_what_they_inherit() -> None:
    made = car()
    assert [part.path for part in made] == [
        "car/axle/wheel",
        "car/axle/wheel (2)",
        "car/axle/wheel (3)",
        "car/axle/wheel (4)",
        "car/body",
    ]
    assert len({id(part.shape) for part in made.parts[:4]}) == 1
    assert made["car/axle/wheel (4)"].solid.bounds is not None
    assert np.allclose(made["car/axle/wheel (4)"].solid.centroid, [40, 0, 21])
    assert made["body"].color == RED and made["body"].density == 1
    assert made["car/axle/wheel"].density == 2
    with pytest.raises(KeyError, match="wheel"):
        made["wheel"]
    assert repr(made) == "Assembly('car', 5 parts)"
    assert len(made) == 5
    assert made.bounds is not None
    assert np.allclose(made.bounds, [[-5, -5, 0], [45, 10, 22]])
    assert b.Assembly("none").bounds is None


@pytest.mark.parametrize(
    "move",
    [
        lambda x: x.translate(1, 2, 3),
        lambda x: x.rotate(30, (1, 2, 3)),
        lambda x: x.rotate((10, 20, 30)),
        lambda x: x.scale(2),
        lambda x: x.mirror((1, 0, 0)),
        lambda x: x.transform(np.diag([1, 2, 3, 1])),
    ],
)
def test_transforms_are_those_of_solids(move: object) -> None:
    assert callable(move)
    made = move(car()).rotate(15)
    for part, old in zip(made, car(), strict=True):
        assert part.solid == move(old.solid).rotate(15)
        assert part.shape.volume == old.shape.volume


def test_a_tool_cuts_part_by_part_and_leaves_the_others_shared() -> None:
    made = car()
    cut = made - b.box((100, 100, 4)).translate(-50, -50, -3)
    for part, old in zip(cut, made, strict=True):
        assert part.path == old.path and part.color == old.color
    assert cut.parts[0].solid.volume == pytest.approx(made.parts[0].solid.volume / 2)
    assert cut.parts[1].shape is made.parts[1].shape
    assert cut["body"].solid == made["body"].solid
    kept = made & b.box((100, 100, 4)).translate(-50, -50, -3)
    assert math.isclose(
        sum(part.solid.volume for part in kept) + sum(part.solid.volume for part in cut),
        made.bill().volume,
    )
    again = made - made
    assert all(part.solid.is_empty for part in again)
    assert (b.Assembly("x", [b.cube(1)]) - (np.zeros((0, 3)), [])).parts[0].solid.volume == 1


def test_clashes_tell_who_how_much_and_where() -> None:
    made = b.Assembly(
        "box",
        [
            b.Assembly("a", b.cube(2)),
            b.Assembly("b", b.cube(2).translate(1, 0, 0)),
            b.Assembly("c", b.cube(2).translate(3, 0, 0)),
            b.Assembly("d", b.cube(2).translate(5.25, 0, 0)),
            b.Assembly("nothing", b.Solid.empty()),
        ],
    )
    (only,) = made.clashes()
    assert (only.first, only.second, only.volume, only.gap) == ("box/a", "box/b", 4.0, 0.0)
    assert only.place.tolist() == [1.5, 1, 1]
    assert "volume 4" in repr(only)
    near = made.clashes(clearance=0.5)
    assert [(one.first[-1], one.second[-1], one.gap) for one in near] == [
        ("a", "b", 0.0),
        ("b", "c", 0.0),
        ("c", "d", 0.25),
    ]
    assert near[2].place[0] == 5.125
    with pytest.raises(b.InvalidParameterError):
        made.clashes(-1)


def test_the_bill_counts_shapes_and_weighs_them() -> None:
    bill = car().bill()
    wheel = b.cylinder(h=2, r=5, segments=16).volume
    assert [(row.name, row.count) for row in bill.rows] == [("wheel", 4), ("body", 1)]
    assert bill.rows[0].mass == pytest.approx(8 * wheel)
    assert bill.mass == pytest.approx(8 * wheel + 1000)
    assert bill.volume == pytest.approx(4 * wheel + 1000)
    assert str(bill).splitlines()[-1].split()[:2] == ["all", "5"]
    assert bill.to_dict()["rows"][1]["volume"] == 1000
    double = b.Assembly("x", [b.cube(1), b.Assembly("y", b.cube(1)).scale(2)]).bill()
    assert [row.volume for row in double.rows] == [1, 8]
    assert double.rows[0].mass is None and "–" in str(double)


def test_the_union_says_of_each_face_which_part_it_is_of() -> None:
    mesh = car().to_solid().to_mesh()
    told = mesh.face_attributes["part"]
    assert set(told.tolist()) == {part.path for part in car()}
    red = mesh.face_attributes["color"][told == "car/body"]
    assert (red == [255, 0, 0, 255]).all()
    assert b.Assembly().to_solid().is_empty
    assert b.Solid.from_mesh(car()).volume == car().to_solid().volume


# Found: naming parts of one name took time that grew with the square of their number.
def test_many_parts_of_one_name_are_counted_once() -> None:
    screw, second = (b.Assembly(name, b.cube(1)) for name in ("screw", "screw (2)"))
    found = b.Assembly("", [screw, second, screw, screw, second, screw])
    assert [part.path for part in found] == [
        "screw",
        "screw (2)",
        "screw (3)",
        "screw (4)",
        "screw (2) (2)",
        "screw (5)",
    ]
    start = process_time()
    assert len(b.Assembly("", [screw] * 20_000)) == 20_000
    assert process_time() - start < 5


@pytest.mark.parametrize("suffix", [".3mf", ".glb"])
def test_trees_names_colours_and_instances_survive_files(tmp_path: Path, suffix: str) -> None:
    wheel = b.cylinder(h=2, r=5, segments=4)
    made = b.Assembly(
        "root & all",
        [
            b.Assembly("left", wheel, color=GREY).rotate(30, (1, 2, 3)),
            b.Assembly("right", wheel, color=GREY).translate(0.1, 0.2, 0.3).mirror((1, 0, 0)),
            b.Assembly("plain", wheel).scale((1, 2, 3)),
            b.Assembly("group", [b.Assembly("inner", b.cube(1), color=RED)]).rotate(90),
        ],
    ).translate(1, 2, 3)
    assert codes_of(made.save(tmp_path / f"x{suffix}")) == UNITS[suffix]
    again = b.Assembly.load(tmp_path / f"x{suffix}")
    assert [part.path for part in again] == [part.path for part in made]
    assert [part.color for part in again] == [part.color for part in made]
    assert again.parts[0].shape is again.parts[1].shape
    for part, old in zip(again, made, strict=True):
        assert part.shape == old.shape
        assert part.solid.volume == pytest.approx(old.solid.volume)
        assert part.solid.bounds is not None and old.solid.bounds is not None
        assert np.allclose(part.solid.bounds, old.solid.bounds)
    again.save(tmp_path / f"y{suffix}")
    once_more = b.Assembly.load(tmp_path / f"y{suffix}")
    assert [part.path for part in once_more] == [part.path for part in made]
    data = [(tmp_path / f"{name}{suffix}").read_bytes() for name in "xy"]
    assert data[0] == data[1]
    whole = b.load(tmp_path / f"x{suffix}")
    assert whole.volume == pytest.approx(made.to_solid().volume)


# Found: assemblies with an instance without a name of a part that has one could not be written as
# GLB.
@pytest.mark.parametrize("suffix", [".3mf", ".glb"])
def test_instances_of_a_named_part_may_have_no_name(tmp_path: Path, suffix: str) -> None:
    cube = b.cube(1)
    b.Assembly("a", [b.Assembly("wheel", cube), cube]).save(tmp_path / f"x{suffix}")
    again = b.Assembly.load(tmp_path / f"x{suffix}")
    assert [part.path for part in again] == ["a/wheel", "a/part"]


# Found: an assembly 64 deep with two names of one solid could not be written as 3MF.
@pytest.mark.parametrize("suffix", [".3mf", ".glb"])
def test_the_deepest_assembly_can_be_saved(tmp_path: Path, suffix: str) -> None:
    cube = b.cube(1)
    made = b.Assembly("0", [b.Assembly("a", cube), b.Assembly("b", cube).translate(3, 0, 0)])
    for depth in range(1, 63):
        made = b.Assembly(str(depth), [made])
    with pytest.raises(b.InvalidParameterError):
        b.Assembly("", [made])
    made.save(tmp_path / f"x{suffix}")
    again = b.Assembly.load(tmp_path / f"x{suffix}")
    assert [part.path for part in again] == [part.path for part in made]
    assert b.load(tmp_path / f"x{suffix}").volume == 2


# Found: a solid whose one material is called after its colour, and two colours of parts that are
# the same in bytes, ended in `write_mismatch` in a GLB of an assembly.
def test_materials_called_after_their_colours_can_be_saved_again(tmp_path: Path) -> None:
    near = (1.0, 0.0, 0.0, 0.9999)
    parts = [b.Assembly("x", b.cube(1)), b.Assembly("y", b.cube(1).translate(3, 0, 0), color=near)]
    b.Assembly("a", parts, color=RED).save(tmp_path / "x.glb")
    again = b.Assembly("b", [b.load(tmp_path / "x.glb"), b.Assembly.load(tmp_path / "x.glb")])
    again.save(tmp_path / "y.glb")
    found = [part.color for part in b.Assembly.load(tmp_path / "y.glb")]
    assert found == [None, RED, near]
    b.Assembly("c", [b.load(tmp_path / "x.glb") & b.cube(2)]).save(tmp_path / "z.glb")
    assert b.Assembly.load(tmp_path / "z.glb").parts[0].color == RED


@pytest.mark.parametrize("suffix", [".3mf", ".glb"])
def test_empty_parts_and_names_that_files_cannot_hold(tmp_path: Path, suffix: str) -> None:
    gone = b.Assembly("gone", [b.cube(1) - b.cube(1)])
    made = b.Assembly("a\x01\ud800b", [b.cube(1), gone])
    assert [part.path for part in made] == ["a\x01\ud800b/part", "a\x01\ud800b/gone/part"]
    finding, *others = made.save(tmp_path / f"x{suffix}")
    assert (finding.code, finding.count) == ("empty_parts", 1)
    assert codes_of(others) == UNITS[suffix]
    again = b.Assembly.load(tmp_path / f"x{suffix}")
    assert [part.solid.volume for part in again] == [1]
    with pytest.raises(b.FormatError) as caught:
        gone.save(tmp_path / f"y{suffix}")
    assert caught.value.code == "empty"
    far = b.Assembly("far", b.cube(1e40))
    if suffix == ".glb":
        with pytest.raises(b.FormatError) as caught:
            far.save(tmp_path / "far.glb")
        assert caught.value.code == "too_large"


def test_parts_of_which_single_precision_leaves_nothing_are_said(tmp_path: Path) -> None:
    slab = b.box((1e-9, 1, 1)).translate(1, 0, 0)
    made = b.Assembly("both", [b.Assembly("slab", slab), b.Assembly("twin", slab), b.cube(1)])
    findings = made.save(tmp_path / "x.glb")
    assert codes_of(findings) == codes_of(b.save(slab, tmp_path / "slab.glb"))
    finding = findings[-1]
    assert (finding.code, finding.count) == ("thickened_in_single", 12)
    assert finding.message.startswith("“slab”: the whole mesh is so thin")
    parts = b.Assembly.load(tmp_path / "x.glb")
    assert [part.solid.volume > 0 for part in parts] == [True, True, True]
    assert made.save(tmp_path / "x.3mf") == ()


def test_instances_take_the_room_of_one(tmp_path: Path) -> None:
    ball = b.Assembly("ball", b.sphere(1, segments=64))
    many = b.Assembly("many", [ball.translate(3 * k, 0, 0) for k in range(50)])
    for suffix in (".glb", ".3mf"):
        many.save(tmp_path / f"many{suffix}")
        b.Assembly("one", [ball]).save(tmp_path / f"one{suffix}")
        sizes = [(tmp_path / f"{name}{suffix}").stat().st_size for name in ("many", "one")]
        assert sizes[0] < 1.5 * sizes[1]


@pytest.mark.parametrize("suffix", [".3mf", ".glb"])
def test_textures_and_colours_travel_with_parts(tmp_path: Path, suffix: str) -> None:
    mesh = b.cube(1).to_mesh()
    uv = np.arange(72).reshape(12, 3, 2) / 64

    def said(**given: Any) -> b.Solid:
        return b.Solid(mesh.vertices, mesh.faces, **given)

    wood = said(
        face_attributes={"material": np.repeat(["wood", "paint", ""], 4)},
        corner_attributes={"uv": uv},
        materials={"wood": b.Material(texture=PIXEL), "paint": b.Material((0, 0.2, 1))},
    )
    other = said(
        face_attributes={"material": np.full(12, "wood")},
        corner_attributes={"uv": uv + 1},
        materials={"wood": b.Material(texture=PIXEL)},
    )
    colors = np.arange(48, dtype=np.uint8).reshape(12, 4)
    top = b.Assembly("top", wood)
    parts = [top, top.translate(3, 0, 0), b.Assembly("side", other)]
    parts += [b.Assembly("plate", said(face_attributes={"color": colors}))]
    made = b.Assembly("desk", [*parts, b.Assembly("leg", b.cube(1), color=RED)])
    assert codes_of(made.save(tmp_path / f"x{suffix}")) == UNITS[suffix]
    again = b.Assembly.load(tmp_path / f"x{suffix}")
    assert again.parts[0].shape is again.parts[1].shape and again["desk/leg"].color == RED
    found = again["desk/top"].solid.to_mesh()
    assert found.attributes is not None and found.materials["wood"].texture == PIXEL
    names = found.face_attributes["material"]
    assert names.tolist() == ["wood"] * 4 + ["paint"] * 4 + [""] * 4
    assert np.allclose(found.attributes.at_corners("uv")[:4], uv[:4])
    side = again["desk/side"].solid.to_mesh()
    assert side.attributes is not None and set(side.materials) == {"wood"}
    assert np.allclose(side.attributes.at_corners("uv"), uv + 1)
    plate = again["desk/plate"].solid.to_mesh()
    assert plate.attributes is not None
    assert (plate.attributes.at_corners("color")[:, 0] == colors).all()


def test_what_parts_say_that_3mf_cannot_hold_is_named(tmp_path: Path) -> None:
    mesh = b.cube(1).to_mesh()
    warm = b.Solid(mesh.vertices, mesh.faces, vertex_attributes={"heat": np.arange(8.0)})
    (finding,) = b.Assembly("stove", [b.Assembly("top", warm)]).save(tmp_path / "x.3mf")
    assert finding.code == "attributes_left_out" and "“heat”" in finding.message


# Found: what files of assemblies and scripts could not keep was not told: attributes in GLB and
# `.csg`, coordinates and units in GLB, densities.
@pytest.mark.parametrize("suffix", [".3mf", ".glb", ".csg", ".obj"])
def test_what_files_cannot_hold_of_assemblies_is_named(tmp_path: Path, suffix: str) -> None:
    third = b.cube(1 / 3).tagged(layer=1)
    path = tmp_path / f"x{suffix}"
    part = b.Assembly("", third)
    found = codes_of(b.Assembly("", [part, part.translate(3, 0, 0)], density=2).save(path))
    assert sorted(found) == sorted([*codes_of(b.save(third, path)), "densities_left_out"])
    assert "attributes_left_out" in found
    assert ("single_precision" in found) == (suffix == ".glb")


# Found: an assembly of parts with attributes of one name and other types could not be written as
# OBJ, which holds none of them.
def test_parts_of_an_obj_may_have_attributes_of_other_types(tmp_path: Path) -> None:
    parts = [b.Assembly(str(tag), b.cube(1).tagged(tag=tag)) for tag in ("a", 1)]
    (finding,) = b.Assembly("both", parts).save(tmp_path / "x.obj")
    assert finding.code == "attributes_left_out" and "“tag”" in finding.message
    assert len(list(b.Assembly.load(tmp_path / "x.obj"))) == 2


# Found: parts without a colour beside parts with colours in bytes were black in an OBJ of an
# assembly.
def test_parts_without_a_colour_are_white_in_an_obj(tmp_path: Path) -> None:
    mesh = b.cube(1).to_mesh()
    blue = {"color": np.full((8, 3), [0, 0, 255], "u1")}
    painted = b.Solid(mesh.vertices, mesh.faces, vertex_attributes=blue)
    b.Assembly("both", [painted, b.cube(1).translate(3, 0, 0)]).save(tmp_path / "x.obj")
    colors = b.load(tmp_path / "x.obj").to_mesh().vertex_attributes["color"]
    assert np.unique(colors, axis=0).tolist() == [[0, 0, 1], [1, 1, 1]]


def test_colours_of_parts_and_of_faces_share_an_obj(tmp_path: Path) -> None:
    halves = b.cube(1).tagged(color="blue") - b.cube(0.5).tagged(color="#ff000080")
    kinds = [b.Assembly("part", b.cube(1), color="orange"), b.Assembly("faces", halves)]
    assert not b.Assembly("both", kinds).save(tmp_path / "x.obj")
    found = b.load(tmp_path / "x.obj").to_mesh().materials.values()
    told = ("orange", "blue", "#ff000080")
    assert {one.color for one in found} == {b.Material(one).color for one in told}


def test_objects_of_obj_are_parts_in_their_places(tmp_path: Path) -> None:
    car().save(tmp_path / "x.obj")
    again = b.Assembly.load(tmp_path / "x.obj")
    assert [part.name for part in again] == [part.path for part in car()]
    for part, old in zip(again, car(), strict=True):
        assert part.solid == old.solid
    told = again.parts[4].solid.to_mesh()
    assert [one.color for one in told.materials.values()] == [RED]
    b.cube(2).save(tmp_path / "x.stl")
    assert b.Assembly.load(tmp_path / "x.stl").to_solid().volume == 8


# Found: parts of an assembly that have attributes lost their colours in OBJ, and in the union
# those without any material any more did.
@pytest.mark.parametrize("suffix", [".3mf", ".obj"])
def test_colours_of_parts_with_attributes_survive_files(tmp_path: Path, suffix: str) -> None:
    mesh = b.cube(1).to_mesh()
    bare = b.Solid(
        mesh.vertices, mesh.faces, face_attributes={"material": np.full(12, ""), "id": [7] * 12}
    )
    red = {"material": np.full(12, "red")}
    own = b.Solid(
        mesh.vertices, mesh.faces, face_attributes=red, materials={"red": b.Material(RED[:3])}
    )
    blue = (0.0, 0.0, 1.0, 1.0)
    parts = [b.Assembly("bare", bare, color=blue), b.Assembly("own", own, color=blue)]
    made = b.Assembly("both", [parts[0], parts[1].translate(3, 0, 0)])
    (finding,) = made.save(tmp_path / f"x{suffix}")
    assert finding.code == "attributes_left_out"
    colors = []
    for part in b.Assembly.load(tmp_path / f"x{suffix}"):
        materials = part.solid.to_mesh().materials.values()
        colors += [part.color] if part.color else [one.color for one in materials]
    assert colors == [blue, RED]
    united = made.to_solid().to_mesh().attributes
    assert {tuple(one) for one in united.at_corners("color")[:, 0].tolist()} >= {(0, 0, 255, 255)}


# Found: an assembly with a colour on a part that has texture coordinates, normals or other
# attributes could not be written as GLB: `write_mismatch`.
@pytest.mark.parametrize("name", ["uv", "heat"])
def test_colours_and_attributes_of_parts_share_a_glb(tmp_path: Path, name: str) -> None:
    mesh = b.cube(1).to_mesh()
    values = {name: np.arange(16.0).reshape(8, 2) / 16}
    part = b.Assembly("part", b.Solid(mesh.vertices, mesh.faces, vertex_attributes=values))
    parts = [b.Assembly("red", [part], color=RED), b.Assembly("grey", [part], color=GREY)]
    b.Assembly("both", [*parts, parts[0].translate(3, 0, 0)]).save(tmp_path / "x.glb")
    again = b.Assembly.load(tmp_path / "x.glb")
    again.save(tmp_path / "x.glb")
    found = list(b.Assembly.load(tmp_path / "x.glb"))
    assert [one.color for one in found] == [one.color for one in again] == [RED, GREY, RED]
    assert found[0].shape is found[2].shape
    said = [one.solid.to_mesh().attributes for one in found]
    assert [one.names for one in said] == [(name,)] * 3
    corners = np.arange(16.0).reshape(8, 2)[mesh.faces] / 16
    assert all((one.at_corners(name) == corners).all() for one in said)


def test_what_cannot_be_written_or_read_is_refused(tmp_path: Path) -> None:
    with pytest.raises(b.FormatError) as caught:
        car().save(tmp_path / "x.stl")
    assert caught.value.code == "unknown_format"
    with pytest.raises(b.FormatError):
        b.Assembly.load(tmp_path / "none.3mf")
    for suffix in (".3mf", ".glb"):
        (tmp_path / f"bad{suffix}").write_bytes(b"nonsense")
        with pytest.raises(b.FormatError):
            b.Assembly.load(tmp_path / f"bad{suffix}")


def test_bad_assemblies_are_refused() -> None:
    deep = b.Assembly("x", b.cube(1))
    for _ in range(63):
        deep = b.Assembly("x", [deep])
    with pytest.raises(b.InvalidParameterError, match="64"):
        b.Assembly("x", [deep])
    with pytest.raises(b.InvalidParameterError):
        b.Assembly("x", density=-1)
    with pytest.raises(b.InvalidMeshError):
        b.Assembly("x", color=(1, 2, 300))
    with pytest.raises(b.InvalidMeshError):
        b.Assembly("x", [3])


def test_tags_are_said_by_every_face() -> None:
    part = b.cube(2).tagged(layer=1, who="me", color=np.array([1, 2, 3], np.uint8))
    mesh = (part - b.cube(1).tagged(layer=2)).rotate(30).to_mesh()
    assert set(mesh.face_attributes["layer"].tolist()) == {1, 2}
    assert set(mesh.face_attributes["who"].tolist()) == {"me", ""}
    assert part.volume == 8
    again = part.tagged(who="you").to_mesh()
    assert set(again.face_attributes["who"].tolist()) == {"you"}
    assert again.face_attributes["color"].dtype == np.uint8
    assert b.Solid.empty().tagged(x=1).is_empty
    assert (b.half_space((0, 0, 1), 1).tagged(x=1) & b.cube(2)).volume == 4


# Found: parts of assemblies in scripts lost the `$fn`, `$fa` and `$fs` of the nodes around them.
def test_parts_of_scripts_keep_the_variables_around_them(tmp_path: Path) -> None:
    (tmp_path / "x.csg").write_text("group($fn = 4) { color([1, 0, 0]) sphere(1); cube(1); }")
    made = b.Assembly.load(tmp_path / "x.csg")
    assert made.to_solid() == b.load(tmp_path / "x.csg")


def test_colours_of_scripts_are_those_of_parts(tmp_path: Path) -> None:
    (tmp_path / "x.csg").write_text(
        "group() { color([1, 0, 0, 1]) { cube(size = 2); color([0, 1, 0, 1]) cylinder(h = 1,"
        " r1 = 1, r2 = 1, $fn = 4); } multmatrix([[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0],"
        " [0, 0, 0, 1]]) { union() { color([0, 0, 1, 0.5]) sphere(r = 1, $fn = 8); } }"
        " difference() { cube(size = 3); color([0, 1, 0, 1]) cube(size = 1); } %cube(size = 9); }"
    )
    made = b.Assembly.load(tmp_path / "x.csg")
    told = [(part.name, part.color) for part in made]
    blue = (0.0, 0.0, 1.0, 0.5)
    assert told == [("cube", RED), ("cylinder", RED), ("sphere", blue), ("difference", None)]
    assert made["sphere"].solid.centroid[0] == pytest.approx(5)
    assert made.to_solid() == b.load(tmp_path / "x.csg")
    (finding,) = made.save(tmp_path / "y.csg")
    assert finding.code == "names_left_out"
    again = b.Assembly.load(tmp_path / "y.csg")
    assert [part.color for part in again] == [part.color for part in made]
    assert [part.solid.volume for part in again] == [part.solid.volume for part in made]
