import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import csg
from bspcsg.bsp import Region

MOVED = "multmatrix([[1, 0, 0, {}], [0, 1, 0, {}], [0, 0, 1, {}], [0, 0, 0, 1]])"
TETRAHEDRON = "points = [[0, 0, 0], [6, 0, 0], [0, 1, 0], [0, 0, 1]]"


def moved(x: float, y: float, z: float) -> str:
    return MOVED.format(x, y, z)


def region(text: str) -> Region:
    found = csg.evaluate(csg.parse(text))
    assert isinstance(found, Region)
    return found


def volume(text: str, **options: Any) -> float:
    return csg.loads(text, **options).volume


# Tessellation


@pytest.mark.parametrize(
    ("arguments", "sides"),
    [
        ("r = 1", 5),
        ("r = 10", 30),
        ("r = 0.1", 5),
        ("r = 1, $fn = 2", 3),
        ("r = 1, $fn = 12.9", 12),
        ("r = 1, $fn = nan", 3),
        ("r = 10, $fa = 5, $fs = 0.1", 72),
        ("d = 20", 30),
    ],
)
def test_circles_have_openscads_sides(arguments: str, sides: int) -> None:
    (outline,) = region(f"circle({arguments});").outlines
    assert len(outline.points) == sides


def test_special_variables_hold_inside_a_node() -> None:
    def sides(text: str) -> int:
        return len(region(text).to_polygons()[0])

    assert sides("union($fn = 8) circle(r = 1);") == 8
    assert sides("union($fn = 8) group($fa = 1) circle(r = 1, $fn = 4);") == 4
    assert sides("union($fn = 8); circle(r = 1);") == 5


@pytest.mark.parametrize(("r", "faces", "sides"), [(1, 22, 5), (10, 842, 30)])
def test_spheres_have_no_poles(r: int, faces: int, sides: int) -> None:
    mesh = csg.loads(f"sphere(r = {r});").to_mesh()
    rings = (sides + 1) // 2
    assert len(mesh.vertices) == rings * sides
    assert len(mesh.faces) == 2 * (sides - 2) + 2 * sides * (rings - 1)
    # OpenSCAD counts each cap as one.
    assert faces == 2 + 2 * sides * (rings - 1)
    assert mesh.vertices[:, 2].max() == pytest.approx(r * math.cos(math.pi / 2 / rings))


def test_first_ring_of_a_sphere() -> None:
    bounds = csg.loads("sphere(r = 10, $fn = 8);").bounds
    assert bounds is not None
    assert bounds[1, 2] == pytest.approx(9.238795325, abs=1e-9)


# Operations


def test_top_nodes_and_groups_are_united() -> None:
    assert volume(f"cube(1); group() {{ {moved(2, 0, 0)} cube(1); cube(1); }}") == 2


def test_ignored_and_root_nodes() -> None:
    assert volume("difference() { %cube(9); *cube(9); #cube(2); cube(1); }") == 7
    assert volume("cube(5); group() { !cube(2); } !cube(1);") == 8
    assert csg.loads("%cube(1);").is_empty


def test_nothing_first_leaves_nothing() -> None:
    assert csg.loads("difference() { group(); cube(1); }").is_empty
    assert csg.loads("difference() { cube(size = [0, 1, 1]); cube(1); }").is_empty
    assert csg.loads("intersection() { group(); cube(1); }").is_empty
    assert csg.loads("intersection();").is_empty
    assert csg.loads("").is_empty


def test_first_child_says_the_dimension() -> None:
    with pytest.warns(csg.CsgWarning, match=r"<csg>:1:1: union\(\).*plane figures .* ignored"):
        assert volume("union() { cube(1); square(5); }") == 1
    with pytest.warns(csg.CsgWarning, match="solids among them are ignored"):
        assert region("union() { square(2); cube(1); }").area == 4


def test_plane_figures_combine() -> None:
    text = f"difference() {{ square(4); {moved(1, 1, 9)} square(2); }}"
    assert region(text).area == 12
    assert region(f"intersection() {{ square(4); {moved(3, 3, 0)} square(4); }}").area == 1
    assert region("square([0, 3]);").is_empty
    with pytest.raises(b.FormatError, match="plane figure; put linear_extrude"):
        csg.loads("square(4);")


def test_repeated_parts_are_one_solid() -> None:
    tree = csg.parse(f"cube(1); {moved(3, 0, 0)} cube(1); {moved(6, 0, 0)} cube(1);")
    solid = csg.evaluate(tree)
    assert isinstance(solid, b.Solid)
    assert solid.volume == 3
    operation = solid.last_operation
    assert operation is not None
    assert len(operation.operands) == 3


def test_matrices() -> None:
    assert volume(f"{moved(1, 2, 3)} cube(2);") == 8
    assert volume("multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]) cube(2);") == 1
    assert volume("multmatrix([[-2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) cube(2);") == 16
    for wrong in ("inf", "nan"):
        text = f"multmatrix([[{wrong},0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) cube(2);"
        with pytest.warns(csg.CsgWarning, match="not finite; it is left out"):
            assert csg.loads(text).is_empty
    with pytest.warns(csg.CsgWarning, match="flattens its children"):
        flat = "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,0,0],[0,0,0,1]])"
        assert csg.loads(f"{flat} cube(2);").is_empty
    # The third row and column do not concern the plane.
    assert region(f"{flat} square(2);").area == 4


# Polyhedra


def test_polyhedra_run_clockwise_but_need_not() -> None:
    outward = "faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]"
    inward = "faces = [[2, 1, 0], [1, 3, 0], [3, 2, 0], [2, 3, 1]]"
    for faces in (outward, inward, outward.replace("faces", "triangles")):
        assert volume(f"polyhedron({TETRAHEDRON}, {faces});") == pytest.approx(1)


def test_open_polyhedra_are_errors_or_left_out() -> None:
    text = f"cube(1); polyhedron({TETRAHEDRON}, faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3]]);"
    with pytest.raises(b.InvalidMeshError, match=r"^<csg>:1:10: polyhedron\(\): .*not closed"):
        csg.loads(text)
    with pytest.warns(csg.CsgWarning, match="left out"):
        assert volume(text, on_invalid="warn") == 1


def test_equal_points_are_one() -> None:
    points = "[[0,0,0],[1,0,0],[0,1,0],[0,0,1],[0,0,0]]"
    faces = "[[0,1,2],[4,3,1],[4,2,3],[1,3,2],[0,4,1]]"
    assert volume(f"polyhedron(points = {points}, faces = {faces});") == pytest.approx(1 / 6)


# Sweeps and hulls


def test_straight_and_tapered_extrusions() -> None:
    assert volume("linear_extrude(height = 3, center = true) square(2);") == 12
    pyramid = "linear_extrude(height = 3, scale = 0) square(2, center = true);"
    assert volume(pyramid) == pytest.approx(4)
    assert csg.loads("linear_extrude(height = -3) square(2);").is_empty
    assert csg.loads("linear_extrude(height = 3) group();").is_empty


def test_turned_extrusions() -> None:
    ring = f"rotate_extrude({{}}$fn = 4) {moved(2, 0, 0)} square(1);"
    assert volume(ring.format("")) == pytest.approx(10)
    assert volume(ring.format("angle = 400, ")) == pytest.approx(10)
    assert volume(ring.format("angle = 90, ")) == pytest.approx(2.5)
    assert csg.loads(ring.format("angle = 0, ")).is_empty
    bounds = csg.loads(ring.format("angle = -90, ")).bounds
    np.testing.assert_array_equal(bounds, [[0, -3, 0], [3, 0, 1]])


def test_hulls() -> None:
    assert volume(f"hull() {{ cube(1); {moved(0, 0, 4)} cube(1); }}") == 5
    assert region(f"hull() {{ square(1); {moved(4, 0, 0)} square(1); }}").area == 5
    assert csg.loads("hull();").is_empty
    assert csg.loads("hull() { group(); cube(size = [0, 1, 1]); }").is_empty


def test_minkowski_sums() -> None:
    assert volume("minkowski() { cube(2); cube(1); cube(1); }") == 64
    assert region("minkowski() { square(2); square([1, 3]); }").area == 15
    corner = f"difference() {{ cube(4); {moved(1, 1, -1)} cube(9); }}"
    assert volume(f"minkowski() {{ {corner} cube(1); }}") == 5 * (25 - 9)


@pytest.mark.parametrize(
    ("children", "expected"),
    [
        ("cube(2); cube(0);", 8),
        ("cube(0); cube(2);", 8),
        ("cube(2); group(); cube(1);", 27),
        ("cube(0);", 0),
        ("cube(0); sphere(0);", 0),
    ],
)
def test_minkowski_leaves_empty_solids_out(children: str, expected: float) -> None:
    assert volume(f"minkowski() {{ {children} }}") == expected


@pytest.mark.parametrize(
    ("children", "area"),
    [
        ("square(2);", 4),
        ("square(0);", 0),
        ("square(2); square(0);", 0),
        ("square(0); square(2);", 0),
        ("square(2); group();", 0),
        ("square(2); square(1); square(0);", 9),
        ("square(2); square(0); square(1);", 9),
    ],
)
def test_minkowski_in_the_plane_keeps_openscads_rule(children: str, area: float) -> None:
    assert region(f"minkowski() {{ {children} }}").area == area


@pytest.mark.filterwarnings("ignore::bspcsg.csg.CsgWarning")
def test_intersections_of_both_dimensions_are_empty() -> None:
    assert csg.loads("intersection() { cube(5); circle(2); }").is_empty
    assert region("intersection() { circle(2); cube(5); }").is_empty
    assert volume("difference() { cube(5); circle(2); }") == 125
    assert volume("union() { cube(5); circle(2); }") == 125
    with pytest.warns(csg.CsgWarning, match="2D and 3D"):
        csg.loads("intersection() { cube(5); circle(2); }")


def test_minkowski_of_what_is_far_from_convex() -> None:
    ball = "difference() { sphere(r = 20, $fn = 80); cube(3); }"
    with pytest.raises(
        b.FormatError, match=r":1:1: minkowski\(\): a solid is not convex"
    ) as caught:
        csg.loads(f"minkowski() {{ {ball} cube(1); }}")
    assert caught.value.code == "too_large"


def test_sizes() -> None:
    assert volume("resize(newsize = [4, 0, 0]) cube(2);") == 16
    assert volume("resize(newsize = [4, 0, 0], auto = [0, 1, 0]) cube(2);") == 32
    assert volume("resize(newsize = [4, 0, 6], auto = true) cube(2);") == 4 * 6 * 6
    assert region("resize(newsize = [4, 6, 9]) square(2);").area == 24


def test_projections() -> None:
    ball = moved(0, 0, 3) + " cube(2, center = true);"
    assert region(f"projection() {ball}").area == 4
    assert region(f"projection(cut = true) {ball}").is_empty
    assert region("projection(cut = true) cube(2);").area == 4
    with pytest.warns(csg.CsgWarning, match="plane figures; they are ignored"):
        assert csg.evaluate(csg.parse("projection() square(1);")) is None


def test_offsets() -> None:
    assert region("offset(delta = 1) square(2);").area == 16
    assert region("offset(delta = -0.5) square(2);").area == 1
    assert region("offset(delta = -5) square(2);").is_empty
    assert region("offset(r = 1, $fn = 4) square(2);").area == pytest.approx(4 + 8 + 2)
    with pytest.warns(csg.CsgWarning, match="solids; they are ignored"):
        assert csg.evaluate(csg.parse("offset(r = 1) cube(1);")) is None


@pytest.mark.parametrize("hair", [1e-5, 1e-4])
@pytest.mark.parametrize("around", ["union()", "group() union()", "union() { union()"])
def test_offsets_do_not_widen_what_six_digits_part(hair: float, around: str) -> None:
    parts = f"square(10); {moved(10 + hair, 0, 0)} square(10); {moved(5, 5, 0)} square(10);"
    figure = f"{around} {{ {parts} }}" + " }" * around.count("{")
    inner = region(f"offset(delta = -0.3) {{ {figure} }}")
    # Two rectangles, and 0.3 off all around.
    assert inner.area == pytest.approx(19.4 * 9.4 + 9.4 * 5, abs=2 * hair * 30)


def test_offsets_do_not_draw_out_what_six_digits_leave_over() -> None:
    sliver = "polygon([[0, 0], [20, 0], [0, 0.0002]]);"
    assert region(f"offset(delta = 0.5) {{ square(10); {sliver} }}").area == pytest.approx(
        121, abs=0.001 * 40
    )


def test_fine_figures_are_grown_as_they_are() -> None:
    ring = region("circle(r = 0.0005, $fn = 100);")
    grown = region("offset(delta = 0.0005) circle(r = 0.0005, $fn = 100);")
    assert grown.area == pytest.approx(4 * ring.area, rel=2e-3)
    assert len(grown.outlines[0].points) == 100


# Files


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ("1 2 3\n4 5 6\n7 8\n", (12 + 16 + 24 + 19) / 4),
        ("1 2 3\n4 5 6\n7 8", (12 + 16 + 24 + 19) / 4),
        ("1 1 1\n1 1 1\n1\n", 1 + 1 + 3 / 4 + 2 / 4),
        ("1 1 1\n\n# two\n1\n1 1 1\n", (3 + 2) / 2),
        ("-1 -1\n-1\n", 2 - 3 / 4),
    ],
)
def test_rows_of_a_surface_may_be_shorter(tmp_path: Path, rows: str, expected: float) -> None:
    (tmp_path / "x.dat").write_text(rows)
    text = 'surface(file = "x.dat");'
    assert csg.loads(text, folder=tmp_path).volume == pytest.approx(expected)


DRAWING = '<svg xmlns="http://www.w3.org/2000/svg">{}</svg>'


@pytest.mark.parametrize(
    ("shapes", "area"),
    [
        ('<path fill="none" d="M0 0 L10 0 L10 10 L0 10 Z"/>', 100),
        ('<rect style="fill:none" width="10" height="2"/>', 20),
        ('<path fill-rule="nonzero" d="M0 0H10V10H0Z M2 2H4V4H2Z"/>', 96),
        ('<polyline points="0,0 10,0" stroke-width="2" stroke-linecap="butt"/>', 20),
        ('<line x2="10" stroke-width="2"/>', 24),
        ('<g transform="scale(2)"><path d="M0 0H10" stroke-linecap="butt"/></g>', 40),
        ('<rect display="none" width="10" height="2"/>', 0),
    ],
)
def test_drawings_are_filled_as_openscad_fills_them(
    tmp_path: Path, shapes: str, area: float
) -> None:
    pytest.importorskip("svgelements")
    (tmp_path / "x.svg").write_text(DRAWING.format(shapes))
    found = csg.evaluate(csg.parse('import("x.svg");', folder=tmp_path))
    assert isinstance(found, Region) and found.area == pytest.approx(area)


def test_imports_are_relative_to_the_script(tmp_path: Path) -> None:
    b.cube(2).save(tmp_path / "part.stl")
    b.cube(2).save(tmp_path / "part.off")
    for name in ("part.stl", "part.off"):
        (tmp_path / "all.csg").write_text(f'import(file = "{name}", layer = "", timestamp = 1);')
        assert b.load(tmp_path / "all.csg").volume == 8


def inside_and_outside(folder: Path) -> Path:
    """Return a script's folder beside which, and by a link in which, lie other files."""
    own = folder / "own"
    (own / "parts").mkdir(parents=True)
    (own / "parts" / "table.dat").write_text("1 1\n1 1\n")
    (folder / "table.dat").write_text("secret 1\n1 1\n")
    (folder / "heights.dat").write_text("1 1\n1 1\n")
    (own / "link.dat").symlink_to(folder / "heights.dat")
    (own / "round.dat").symlink_to(own / "round.dat")
    return own


@pytest.mark.parametrize("name", ["parts/table.dat", "parts/../parts/table.dat"])
def test_files_in_the_scripts_folder_are_read(tmp_path: Path, name: str) -> None:
    own = inside_and_outside(tmp_path)
    assert csg.loads(f'surface("{name}");', folder=own).volume == 1


@pytest.mark.parametrize("node", ["surface", "import"])
@pytest.mark.parametrize(
    "name", ["../heights.dat", "../none.dat", "link.dat", "parts/../../heights.dat", "/etc/passwd"]
)
def test_files_elsewhere_are_not_even_looked_for(tmp_path: Path, node: str, name: str) -> None:
    own = inside_and_outside(tmp_path)
    with pytest.raises(b.FormatError, match="outside the script's folder") as caught:
        csg.loads(f'{node}("{name}");', folder=own)
    assert caught.value.code == "forbidden_path" and caught.value.where == (1, 1)


def test_further_folders_can_be_allowed(tmp_path: Path) -> None:
    own = inside_and_outside(tmp_path)
    for name in ("../heights.dat", "link.dat"):
        text = f'surface("{name}");'
        assert csg.loads(text, folder=own, allow_paths=[tmp_path]).volume == 1
        assert csg.evaluate(csg.parse(text, folder=own), allow_paths=[str(tmp_path)]) is not None
    with pytest.raises(b.FormatError, match="outside"):
        csg.loads('surface("../heights.dat");', folder=own, allow_paths=[own / "parts"])
    with pytest.raises(b.FormatError):
        csg.loads('surface("round.dat");', folder=own)


def test_errors_do_not_repeat_what_stands_in_files(tmp_path: Path) -> None:
    own = inside_and_outside(tmp_path)
    with pytest.raises(b.FormatError, match=r"table.dat:1: a word is no number") as caught:
        csg.loads('surface("../table.dat");', folder=own, allow_paths=[tmp_path])
    assert "secret" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "code", "says"),
    [
        ('import(file = "x.amf");', "unsupported", "“.amf” files are not supported"),
        ('import(file = "x.stl");', "empty_file", "empty"),
        ('surface(file = "x.amf");', "syntax", "two rows and columns"),
        ('surface(file = "words.dat");', "syntax", "words.dat:1"),
        ('surface(file = "x.png");', "malformed", "x.png"),
        ('surface(file = "words.png");', "malformed", "cannot be read as PNG"),
        ('import(file = "words.dxf");', "syntax", "no valid DXF"),
        ('import(file = "words.svg");', "syntax", "words.svg"),
    ],
)
def test_files_that_are_not_what_they_should(
    tmp_path: Path, text: str, code: str, says: str
) -> None:
    for name in ("x.amf", "x.stl", "x.png"):
        (tmp_path / name).touch()
    for name in ("words.dat", "words.dxf", "words.svg", "words.png"):
        (tmp_path / name).write_text("not at all\n")
    with pytest.raises(b.FormatError) as caught:
        csg.loads(text, folder=tmp_path)
    assert caught.value.code == code
    assert str(caught.value).startswith("<csg>:1:1: ")
    assert says in str(caught.value)


# Errors


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('cube(size = "a");', 'size must be 3 numbers within ±1e100, not "a"'),
        ("cube(size = [1, 2]);", "size must be 3 numbers"),
        ("cube(1e300);", "size must be 3 numbers"),
        ('cube(1, center = "yes");', "center must be true or false"),
        ("sphere(r = true);", "r must be a number"),
        ("multmatrix(3) cube(1);", "matrix of 4 rows"),
        ("multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,1,1]]) cube(1);", "last row"),
        ("polyhedron(points = [[0, 0]], faces = []);", "points[0] must be 3"),
        ("polyhedron(points = [[0, 0, 0]], faces = [[0, 1, 2]]);", "from 0 to 0"),
        ("polygon(points = 3);", "points must be a list of points"),
        ("polygon(points = [[0, 0]], paths = [[0.5]]);", "whole numbers"),
        ("rotate_extrude() square(2, center = true);", "must not cross the axis"),
        ('linear_extrude(file = "../a.dxf");', "outside the script's folder"),
        ("linear_extrude(height = 1, v = [1, 0, 1]) square(1);", "only v = [0, 0, 1]"),
        ("sphere(r = 1, $fn = 1e9);", "more than 4,000,000 corners"),
        ("linear_extrude(height = 1, twist = 1, slices = 1e12) square(1);", "corners"),
        ("text(text = 3);", "text must be a text"),
        ('text("a", size = "b");', "size must be a number"),
        ("roof() square(1);", "roof() is not supported. Supported: circle color"),
    ],
)
def test_errors_name_node_line_and_column(text: str, says: str) -> None:
    with pytest.raises(b.FormatError) as caught:
        csg.loads("group() {\n  " + text + " }", name="part.csg")
    assert str(caught.value).startswith("part.csg:2:3: ")
    assert caught.value.where == (2, 3)
    assert says in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "cube(1e-300);",
        "cube(1e99);",
        f"{moved(1e90, 0, 0)} cube(1);",
        "resize([1e90, 0, 0]) cube(1);",
    ],
)
def test_sizes_beyond_the_lattice_are_errors_not_crashes(text: str) -> None:
    with pytest.raises((b.LimitError, b.InvalidMeshError), match=r"^<csg>:"):
        csg.loads(text)


# Solids as scripts


def test_solids_survive_as_polyhedra(tmp_path: Path) -> None:
    part = b.cube(3) - b.cylinder(h=9, r=1, segments=7).rotate(20, "x")
    csg.dump(part, tmp_path / "part.csg")
    read = b.load(tmp_path / "part.csg")
    assert (read ^ part).volume < 1e-7
    assert csg.loads(csg.dumps(read)).equals(read)
    assert csg.dumps(b.Solid.empty()) == ""


# Polish


def test_polish_makes_turned_boxes_meet() -> None:
    turn = (
        "multmatrix([[0.866025, -0.5, 0, {}], [0.5, 0.866025, 0, {}], [0, 0, 1, 0], [0, 0, 0, 1]])"
    )
    # 25.9808 is 30 cos 30°, to six digits; 30 times 0.866025 is less.
    text = turn.format(0, 0) + "cube([30, 10, 10]);" + turn.format("25.9808", 15) + "cube(10);"
    rough, polished = csg.loads(text), csg.loads(text, polish=True)
    assert len(rough.to_trimesh().vertices) == 16
    assert len(polished.to_trimesh().vertices) == 12
    assert polished.volume == pytest.approx(4000, rel=2e-5)
    assert polished.tree.pitch == -4


@pytest.mark.parametrize("size", [0.03, 10, 700])
@pytest.mark.parametrize("offset", [0, 40, 500, 12345])
def test_polish_moves_corners_by_what_it_says_and_no_farther(size: float, offset: float) -> None:
    turn = (
        "multmatrix([[0.866025, -0.5, 0, {}], [0.5, 0.866025, 0, {}], [0, 0, 1, 0], [0, 0, 0, 1]])"
    )
    x, y = 3 * size * math.cos(math.pi / 6), 1.5 * size
    near = f"{turn.format(0, 0)} cube([{3 * size:g}, {size:g}, {size:g}]);"
    near += f"{turn.format(format(x, '.6g'), format(y, '.6g'))} cube({size:g});"
    far = f"multmatrix([[1, 0, 0, {offset}], [0, 1, 0, -9], [0, 0, 1, 0], [0, 0, 0, 1]]) cube(1);"
    told: list[csg.Polish] = []
    text = near + far if offset else near
    polished = csg.loads(text, polish=True, on_polish=told.append)
    found = polished.to_mesh().vertices
    assert len(found) == (20 if offset else 12) and told[0].pitch is not None
    assert told[0].pitch == polished.tree.pitch
    np.testing.assert_array_equal(found, np.round(found, -told[0].pitch))
    along, across = np.array([x, y, 0]) / 3, np.array([-y, x, 0]) / 3
    places = [i * along + j * across for i in (0, 3, 4) for j in (0, 1)]
    exact = np.array([place + [0, 0, k * size] for place in places for k in (0, 1)])
    gaps = np.linalg.norm(exact[:, None] - found, axis=2).min(axis=1)
    bound = math.sqrt(3) / 2 * 10.0 ** told[0].pitch
    # The numbers in the text are off by half a unit of the sixth digit.
    written = 10.0 ** (math.floor(math.log10(4 * size)) - 5)
    assert 0 < told[0].moved <= bound and gaps.max() <= told[0].moved + written
    assert 10.0 ** told[0].pitch <= 10 * written


def test_polish_moves_nothing_where_nothing_meets_by_it() -> None:
    thin = "cube([1, 1, 0.000123]);"
    far = "multmatrix([[1, 0, 0, 5000], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])"
    large = "multmatrix([[5000, 0, 0, 0], [0, 5000, 0, 0], [0, 0, 5000, 0], [0, 0, 0, 1]])"
    parts = "union() { cube(0.001234); cube([0.004321, 0.001, 0.001]); }"
    told: list[csg.Polish] = []
    for text in f"{far} cube(1.23457);", f"{large} {parts}", thin:
        polished = csg.loads(text, polish=True, on_polish=told.append)
        assert polished.equals(csg.loads(text)) and told.pop() == (None, 0.0)


def test_polish_spares_small_parts() -> None:
    turn = (
        "multmatrix([[0.866025, -0.5, 0, {}], [0.5, 0.866025, 0, {}], [0, 0, 1, 0], [0, 0, 0, 1]])"
    )
    large = f"{turn.format(0, 0)} cube([3000, 1000, 1000]);"
    large += f"{turn.format('2598.08', 1500)} cube(1000);"
    ball = f"{moved(-1, 0, 0)} sphere(r = 0.03, $fn = 16);"
    polished = csg.loads(large + ball, polish=True)
    assert len(csg.loads(large + ball).to_mesh().vertices) == 16 + 128
    assert len(polished.to_mesh().vertices) in (16 + 128, 12 + 128)


def test_polish_lets_plane_figures_meet() -> None:
    move = "multmatrix([[1, 0, 0, 3.33333], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])"
    tree = csg.parse(f"square([3.333333, 2]); {move} square([1, 2]);")
    told: list[csg.Polish] = []
    figure = csg.evaluate(tree, polish=True, on_polish=told.append)
    assert isinstance(figure, Region)
    assert told[0].pitch == -5 and told[0].moved == pytest.approx(3e-6)
    assert len(np.concatenate(figure.to_polygons())) == 4


def test_polish_keeps_what_is_no_rotation() -> None:
    shear = "multmatrix([[1, 0.01, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])"
    bounds = csg.loads(f"{shear} cube(10);", polish=True).bounds
    assert bounds is not None
    assert bounds[1, 0] == pytest.approx(10.1)
    assert csg.loads("", polish=True).is_empty


def test_extrusions_that_name_their_drawing(tmp_path: Path) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new()
    document.modelspace().add_lwpolyline([(1, 0), (3, 0), (3, 2)], close=True)
    document.saveas(tmp_path / "a.dxf")
    upright = 'linear_extrude(file = "a.dxf", origin = [1, 0], height = 3, scale = [0, 0]);'
    assert csg.loads(upright, folder=tmp_path).volume == 2
    turned = csg.loads('rotate_extrude(file = "a.dxf", $fn = 4);', folder=tmp_path)
    assert turned == csg.loads('rotate_extrude($fn = 4) import("a.dxf");', folder=tmp_path)


def test_round_pens_have_openscads_corners(tmp_path: Path) -> None:
    line = '<path d="m 10,30 25,-20 25,20" fill="none" stroke="black" stroke-width="12" {}/>'
    styles = ["", 'stroke-linecap="round"', 'stroke-linejoin="round"', 'stroke-linejoin="bevel"']
    areas = []
    for style in styles:
        (tmp_path / "a.svg").write_text(f"<svg>{line.format(style)}</svg>")
        found = csg.evaluate(csg.parse('import("a.svg");', folder=tmp_path))
        assert isinstance(found, Region)
        areas.append(found.area)
        assert len(found.outlines[0].points) < 2000
    plain, cap, joint, bevel = areas
    # Two half discs in place of two half squares, and a sector in place of a kite.
    assert plain - cap == pytest.approx(144 - 36 * math.pi, rel=1e-4)
    turn = 2 * math.atan(20 / 25)
    assert plain - joint == pytest.approx(36 * (math.tan(turn / 2) - turn / 2), rel=1e-3)
    assert joint < plain and bevel < plain


# What is left out


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('import(file = "none.stl");', "there is no file “none.stl”"),
        ('import(file = ".");', "there is no file"),
        ('import(file = "a\\x01b.stl");', "there is no file"),
        ('linear_extrude(1) import(file = "none.svg");', "there is no file"),
        ('surface(file = "none.dat");', "there is no file"),
        ("import();", "file is missing"),
        ("cube(size = [nan, 1, 1]);", "size must be 3 numbers"),
        ("cube(inf);", "size must be 3 numbers"),
        ("sphere(r = -inf);", "r must be a number"),
        ("cylinder(h = nan, r = 1);", "h must be a number"),
        ("polyhedron(points = [[0, 0, inf]], faces = []);", "points"),
        ("polyhedron(points = undef, faces = undef);", "points is missing"),
        ("linear_extrude(1) circle(inf);", "r must be a number"),
        ("linear_extrude(1) square([1, nan]);", "size must be 2 numbers"),
        ("linear_extrude(1) polygon(points = undef, paths = undef);", "points is missing"),
        ("linear_extrude(1) offset(r = inf) square(1);", "r must be a number"),
        ('linear_extrude(1) text("a", size = inf);', "size must be a number"),
    ],
)
def test_what_openscad_leaves_out_is_left_out_and_told(text: str, says: str) -> None:
    with pytest.warns(csg.CsgWarning) as told:
        solid = csg.loads("cube(2);\n" + text, name="part.csg")
    assert solid.volume == 8
    [message] = [str(one.message) for one in told]
    assert message.startswith("part.csg:2:") and says in message
    assert message.endswith("It is left out.")


@pytest.mark.parametrize(
    ("text", "volume"),
    [
        ('intersection() { cube(3); import("none.stl"); }', 0),
        ('difference() { cube(3); import("none.stl"); }', 27),
        ('difference() { import("none.stl"); cube(3); }', 0),
        ('minkowski() { cube(3); import("none.stl"); }', 27),
        ('linear_extrude(1) minkowski() { square(3); import("none.svg"); }', 0),
        ("hull() { cube(3); sphere(inf); }", 27),
    ],
)
def test_what_is_left_out_counts_as_openscads_empty_set(text: str, volume: float) -> None:
    with pytest.warns(csg.CsgWarning):
        assert csg.loads(text).volume == volume


@pytest.mark.parametrize(
    ("argument", "faces"), [("$fa = nan", 5), ("$fa = inf", 5), ("$fs = nan", 30)]
)
def test_sides_that_are_no_numbers(argument: str, faces: int) -> None:
    assert len(region(f"circle(r = 1, {argument});").to_polygons()[0]) == faces


BAD_CHILDREN = [
    "roof() square(1);",
    "polyhedron(points = [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], faces = [[0,1,2],[0,3,1],[1,3,2]]);",
    "polyhedron(points = [[0,0,0]], faces = [[0,1,2]]);",
    "rotate_extrude() square(2, center = true);",
    'cube("a");',
    "linear_extrude(1) polygon(points = 3);",
    "sphere(r = 1, $fn = 1e9);",
    'import("words.stl");',
    "multmatrix(3) cube(1);",
]


@pytest.mark.parametrize("text", BAD_CHILDREN)
def test_a_lenient_evaluation_drops_bad_children_with_their_place(
    text: str, tmp_path: Path
) -> None:
    (tmp_path / "words.stl").write_text("not at all\n")
    script = f"difference() {{ cube(4);\n  {text}\n  cube(2); }}"
    with pytest.raises(b.BspcsgError):
        csg.loads(script, folder=tmp_path)
    with pytest.warns(csg.CsgWarning) as told:
        assert csg.loads(script, name="part.csg", folder=tmp_path, lenient=True).volume == 56
    [message] = [str(one.message) for one in told]
    assert message.startswith("part.csg:2:") and message.endswith("It is left out.")


def test_a_lenient_evaluation_repairs_what_it_is_told_to(tmp_path: Path) -> None:
    with pytest.warns(csg.CsgWarning, match="It is repaired"):
        solid = csg.loads(BAD_CHILDREN[1], lenient=True, on_invalid="repair")
    assert solid.volume == pytest.approx(1 / 6)


def test_what_is_not_the_scripts_fault_is_never_dropped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.svg").write_text("<svg/>")
    monkeypatch.setitem(__import__("sys").modules, "svgelements", None)
    with pytest.raises(b.BspcsgError, match=r"bspcsg\[2d\]"):
        csg.loads('linear_extrude(1) import("a.svg");', folder=tmp_path, lenient=True)
    with pytest.raises(b.FormatError, match=r"part\.csg:1"):
        csg.loads("cube(", name="part.csg", lenient=True)


# Surfaces of pictures


def picture(path: Path, pixels: Any, dtype: Any = np.uint8) -> Path:
    image = pytest.importorskip("PIL.Image")
    image.fromarray(np.array(pixels, dtype=dtype)).save(path)
    return path


@pytest.mark.parametrize(
    ("pixels", "dtype", "heights"),
    [
        ([[0, 51], [102, 255]], np.uint8, [[40, 100], [0, 20]]),
        # Of 16 bits the upper half counts.
        ([[0, 51 * 256 + 255], [102 * 256, 65535]], np.uint16, [[40, 100], [0, 20]]),
        ([[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [255, 255, 255]]], np.uint8,
         [[7.22, 100], [21.26, 71.52]]),
        # However opaque.
        ([[[0, 0, 0, 9], [51, 51, 51, 0]], [[102, 102, 102, 1], [255] * 4]], np.uint8,
         [[40, 100], [0, 20]]),
    ],
)  # fmt: skip
def test_pictures_are_tables_of_heights(
    tmp_path: Path, pixels: Any, dtype: Any, heights: list[list[float]]
) -> None:
    path = picture(tmp_path / "a.png", pixels, dtype)
    assert b.surface(path) == b.surface(np.round(heights, 9))
    assert csg.loads('surface("a.png");', folder=tmp_path) == b.surface(path)
    turned = csg.loads('surface("a.png", invert = true);', folder=tmp_path)
    assert turned == b.surface(100 / 255 - np.array(heights))


def test_pictures_that_are_none_are_refused(tmp_path: Path) -> None:
    with pytest.raises(b.FormatError, match="two rows and columns of pixels"):
        b.surface(picture(tmp_path / "a.png", [[1, 2, 3]]))
    with pytest.raises(b.LimitError, match="This surface"):
        b.surface(picture(tmp_path / "b.png", np.zeros((1500, 1500))))
