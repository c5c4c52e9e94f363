"""The errors of scripts, and the parts of scripts that are left out."""

from pathlib import Path

import pytest

import bspcsg as b
from bspcsg import csg
from support.scripts import moved

# Errors


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (
            "multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1e-320]]) cube(1);",
            "its matrix has an entry beyond ±1e100",
        ),
        ('cube(size = "a");', 'size must be 3 numbers from -1e100 to 1e100, not "a"'),
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
        ("rotate_extrude() square(2, center = true);", "must lie on one side"),
        ('linear_extrude(file = "../a.dxf");', "outside the script's folder"),
        ("linear_extrude(height = 1, v = [1, 0]) square(1);", "v must be 3 numbers"),
        ("sphere(r = 1, $fn = 1e9);", "more than 4,000,000 corners"),
        ("linear_extrude(height = 1, twist = 1, slices = 1e12) square(1);", "corners"),
        ("text(text = 3);", "text must be a string"),
        ('text("a", size = "b");', "size must be a number"),
        ("tent() square(1);", "tent() is not supported. Supported: circle color"),
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


# What is left out


# Found: infinite numbers and missing files made the whole script fail.
@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('import(file = "none.stl");', "the file “none.stl” does not exist"),
        ('import(file = ".");', "does not exist"),
        ('import(file = "a\\x01b.stl");', "does not exist"),
        ('linear_extrude(1) import(file = "none.svg");', "does not exist"),
        ('surface(file = "none.dat");', "does not exist"),
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
    assert message.endswith("This node is left out.")


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


BAD_CHILDREN = [
    "tent() square(1);",
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
    assert message.startswith("part.csg:2:") and message.endswith("This node is left out.")


def test_a_lenient_evaluation_repairs_what_it_is_told_to(tmp_path: Path) -> None:
    with pytest.warns(csg.CsgWarning, match="This mesh is repaired"):
        solid = csg.loads(BAD_CHILDREN[1], lenient=True, on_invalid="repair")
    assert solid.volume == pytest.approx(1 / 6)


# Found: a polyhedron with open edges that lie on one line, and so bound nothing, was kept, where
# OpenSCAD leaves it out.
def test_a_lenient_evaluation_drops_polyhedra_whose_faces_do_not_close() -> None:
    # A tetrahedron whose third edge is divided for one of its two faces only.
    points = "[[0,0,0], [2,0,0], [0,2,0], [0,0,2], [1,0,0]]"
    faces = "[[0,4,1,2], [0,3,1], [0,2,3], [1,3,2]]"
    text = f"cube(9);\n  polyhedron({points}, {faces});"
    assert csg.loads(f"polyhedron({points}, {faces});").volume == pytest.approx(8 / 6)
    with pytest.warns(csg.CsgWarning) as told:
        found = csg.loads(f"polyhedron({points}, {faces});", lenient=True)
        assert csg.loads(text, name="part.csg", lenient=True).volume == 729
    assert found.is_empty
    assert str(told[-1].message).startswith(
        "part.csg:2:3: polyhedron(): its faces do not form a closed surface: 3 edges"
    )
    # Four faces at one edge are closed.
    pair = b.cube(1) | b.cube(1).translate(1, 1, 0)
    assert csg.loads(csg.dumps(pair, flat=True), lenient=True).equals(pair)
    kept = csg.loads(f"polyhedron({points}, {faces});", lenient=True, on_invalid="repair")
    assert kept.volume == pytest.approx(8 / 6)
    assert csg.loads(f"hull() polyhedron({points}, {faces});", lenient=True).volume > 1


def test_what_is_not_the_scripts_fault_is_never_dropped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.svg").write_text("<svg/>")
    monkeypatch.setitem(__import__("sys").modules, "svgelements", None)
    with pytest.raises(b.MissingPartError, match=r"pip install svgelements"):
        csg.loads('linear_extrude(1) import("a.svg");', folder=tmp_path, lenient=True)
    with pytest.raises(b.FormatError, match=r"part\.csg:1"):
        csg.loads("cube(", name="part.csg", lenient=True)


# Found: errors about scripts quoted line breaks and control characters.
@pytest.mark.parametrize("word", ['"\n -2 "', '"\x1b[31m"', "\x00"])
def test_errors_are_one_line_that_prints_whatever_they_quote(word: str) -> None:
    with pytest.raises(b.FormatError) as caught:
        csg.loads(f"cube(-2 {word});")
    assert str(caught.value).isprintable()


# Found: `cube(true)` and `cube(1)` shared one solid, so that the second was lost or no error was
# told.
def test_true_is_not_one() -> None:
    assert csg.parse("cube(true);") != csg.parse("cube(1);")
    for text in ("cube(true); cube(1);", "cube(1); cube(true);"):
        with pytest.raises(b.FormatError, match="not true"):
            csg.loads(text)
        with pytest.warns(csg.CsgWarning, match="not true"):
            left = csg.loads(text, lenient=True)
        assert left.volume == 1


# Found: what a matrix of a script moved beyond all lattices was an error without a place, which a
# lenient evaluation did not leave out.
@pytest.mark.parametrize(
    "move",
    [
        "multmatrix([[1, 0, 0, 1e99], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])",
        "resize([1e99, 1, 1])",
    ],
)
def test_what_is_moved_beyond_all_lattices_is_an_error_of_its_node(move: str) -> None:
    text = f"cube(1); {move} {{ cube(1); }}"
    with pytest.raises(b.LimitError, match=r"<csg>:1:10: (multmatrix|resize)\(\)"):
        csg.evaluate(csg.parse(text))
    with pytest.warns(csg.CsgWarning, match=r"This node is left out"):
        assert csg.loads(text, lenient=True).volume == 1


# Found: of several equal nodes that are left out, only the first was reported.
def test_each_node_that_is_left_out_is_told_at_its_place() -> None:
    with pytest.warns(csg.CsgWarning) as told:
        csg.loads('sphere(r = "two"); cube(1); sphere(r = "two");', lenient=True)
    assert [str(one.message)[:9] for one in told] == ["<csg>:1:1", "<csg>:1:2"]


# Found: `!` had an effect inside a node that `*` disables.
def test_nodes_in_one_that_does_not_exist_do_not_count_alone() -> None:
    for text in ("*group() { !cube(2); } cube(5);", "*!cube(2); cube(5);"):
        assert csg.loads(text).volume == 125
        simplified = csg.simplified(csg.parse(text))
        assert csg.loads(csg.dumps(simplified)).volume == 125


# Found: `csg.simplified` took groups of both dimensions apart, so that children counted that did
# not before.
@pytest.mark.filterwarnings("ignore::bspcsg.csg.CsgWarning")
def test_children_of_another_dimension_do_not_count_once_simplified() -> None:
    for text in (
        "cube(1); group() { square(1); cube(5); }",
        "cube(1); group() { group() { square(1); cube(5); } }",
        "color() { cube(1); union() { group() { projection() cube(1); } cube(5); } }",
        'cube(1); group() { text("a"); group() { cube(5); cube(4); } }',
    ):
        simplified = csg.simplified(csg.parse(text))
        assert csg.loads(csg.dumps(simplified)).volume == csg.loads(text).volume == 1


# Found: a node marked `!` lost the `$fn`, `$fa` and `$fs` of the nodes around it.
def test_a_node_that_counts_alone_keeps_the_variables_around_it() -> None:
    tree = csg.parse("union($fn = 40) { group($fn = 4) { cube(9); !sphere(1); } }")
    alone = csg.loads("sphere(1, $fn = 4);")
    for one in (tree, csg.simplified(tree)):
        assert csg.loads(csg.dumps(one)).equals(alone)


# Found: errors of scripts were their own cause, so that a scheduler on other machines could not
# send them.
def test_no_error_is_its_own_cause() -> None:
    with pytest.raises(b.BspcsgError) as caught:
        csg.loads("polyhedron(points = [[0,0,0],[1,0,0],[0,1,0]], faces = [[0,1,2]]);")
    chain: list[BaseException] = []
    cause: BaseException | None = caught.value
    while cause is not None:
        assert cause not in chain
        chain.append(cause)
        cause = cause.__cause__ or cause.__context__
