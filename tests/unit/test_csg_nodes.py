"""Nodes of scripts that combine, move and measure bodies."""

from pathlib import Path

import pytest

import bspcsg as b
from bspcsg import csg
from support.scripts import TETRAHEDRON, moved, region, volume

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
    with pytest.warns(csg.CsgWarning, match=r"<csg>:1:1: union\(\).*2D children are ignored"):
        assert volume("union() { cube(1); square(5); }") == 1
    with pytest.warns(csg.CsgWarning, match="3D children are ignored"):
        assert region("union() { square(2); cube(1); }").area == 4


def test_plane_figures_combine() -> None:
    text = f"difference() {{ square(4); {moved(1, 1, 9)} square(2); }}"
    assert region(text).area == 12
    assert region(f"intersection() {{ square(4); {moved(3, 3, 0)} square(4); }}").area == 1
    assert region("square([0, 3]);").is_empty
    with pytest.raises(b.FormatError, match="solid is needed; put linear_extrude"):
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
        with pytest.warns(csg.CsgWarning, match="not a finite number; this node is left out"):
            assert csg.loads(text).is_empty
    with pytest.warns(csg.CsgWarning, match="would flatten its children"):
        flat = "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,0,0],[0,0,0,1]])"
        assert csg.loads(f"{flat} cube(2);").is_empty
    # The third row and column do not concern the plane.
    assert region(f"{flat} square(2);").area == 4


# Found: matrices of whole numbers in trees made by hand were refused.
def test_matrices_of_whole_numbers() -> None:
    rows = ((2, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 5), (0, 0, 0, 1))
    node = csg.Node("multmatrix", (csg.Argument("m", rows),), csg.parse("cube(1);").nodes)
    for polish in (False, True):
        body = csg.evaluate(csg.CsgTree((node,)), polish=polish)
        assert isinstance(body, b.Solid)
        assert body.equals(b.cube((2, 1, 1)).translate(0, 0, 5))


# Polyhedra


def test_polyhedra_run_clockwise_but_need_not() -> None:
    outward = "faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]"
    inward = "faces = [[2, 1, 0], [1, 3, 0], [3, 2, 0], [2, 3, 1]]"
    for faces in (outward, inward, outward.replace("faces", "triangles")):
        assert volume(f"polyhedron({TETRAHEDRON}, {faces});") == pytest.approx(1)


# Found: polyhedra that are not closed made the whole script fail.
def test_open_polyhedra_are_errors_or_left_out() -> None:
    text = f"cube(1); polyhedron({TETRAHEDRON}, faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3]]);"
    with pytest.raises(b.InvalidMeshError, match=r"^<csg>:1:10: polyhedron\(\): .*not closed"):
        csg.loads(text)
    with pytest.warns(csg.CsgWarning, match="left out"):
        assert volume(text, on_invalid="warn") == 1


# Found: `hull()` refused polyhedra that only list points, and lost those that are flat.
@pytest.mark.parametrize("faces", ["[[0, 1, 2, 3]]", "[[0, 1, 2], [3, 0, 1]]"])
def test_hulls_take_the_corners_of_meshes_that_are_not_closed(faces: str) -> None:
    open_one = f"polyhedron({TETRAHEDRON}, faces = {faces});"
    for treatment in ("error", "warn", "repair"):
        assert volume(f"hull() {open_one}", on_invalid=treatment) == pytest.approx(1)
    for text in (f"hull() {open_one} {open_one}", f"{open_one} hull() {open_one}"):
        # One of them stands beside the hull.
        with pytest.raises(b.InvalidMeshError, match="not closed"):
            csg.loads(text)


def test_hulls_take_the_corners_of_files_that_are_not_closed(tmp_path: Path) -> None:
    (tmp_path / "open.off").write_text("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")
    text = f'hull() {{ import("open.off"); {moved(0, 0, 4)} cube(1); }}'
    assert csg.loads(text, folder=tmp_path).volume == 5


def test_hulls_take_the_corners_of_flat_meshes() -> None:
    sheet = "polyhedron([[0,0,0],[3,0,0],[0,3,0]], faces = [[0,1,2],[2,1,0]]);"
    tip = f"{moved(0, 0, 2)} cube(1);"
    both = b.hull(b.cube(1).translate(0, 0, 2), [[0, 0, 0], [3, 0, 0], [0, 3, 0]])
    assert csg.loads(f"hull() {{ {sheet} {tip} }}").equals(both)


def test_equal_points_are_one() -> None:
    points = "[[0,0,0],[1,0,0],[0,1,0],[0,0,1],[0,0,0]]"
    faces = "[[0,1,2],[4,3,1],[4,2,3],[1,3,2],[0,4,1]]"
    assert volume(f"polyhedron(points = {points}, faces = {faces});") == pytest.approx(1 / 6)


# Solids as scripts


def test_solids_survive_as_polyhedra(tmp_path: Path) -> None:
    part = b.cube(3) - b.cylinder(h=9, r=1, segments=7).rotate(20, "x")
    csg.dump(part, tmp_path / "part.csg")
    read = b.load(tmp_path / "part.csg")
    assert (read ^ part).volume < 1e-7
    assert csg.loads(csg.dumps(read)).equals(read)
    assert csg.dumps(b.Solid.empty()) == ""
