"""Objects keep their names through set operations of the command line."""

import json
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg.io import RawMesh, read, write
from support.cli import Capture, put, ran
from support.shapes import cuboid, joined


@pytest.fixture
def files(folder: Path) -> Path:
    """Add an assembly of a body with a pin in it and a separate knob, and a lid."""
    parts = [
        b.Assembly("body", b.box(2, 2, 2)),
        b.Assembly("pin", b.box(1, 1, 4)),
        b.Assembly("knob", b.box(1, 1, 1).translate(0, 0, 9)),
    ]
    b.Assembly("machine", parts).save("machine.3mf")
    b.Assembly("cover", [b.Assembly("lid", b.box(2, 2, 1).translate(5, 0, 0))]).save("cover.3mf")
    put("block.off", cuboid((0.5, 0.5, 8), (3, 3, 12)))
    put("slit.off", cuboid((-1, 0.9, -1), (9, 1.1, 9.5)))
    return folder


# Found: a union joined the named objects of its files into one object without a name.
@pytest.mark.parametrize(
    ("line", "names"),
    [
        ("union machine.3mf cover.3mf -o x.3mf", ["body + pin", "lid", "knob"]),
        ("union machine.3mf cover.3mf -o x.glb", ["body + pin", "lid", "knob"]),
        ("union machine.3mf cover.3mf -o x.obj", ["body + pin", "lid", "knob"]),
        ("union machine.3mf cover.3mf -o x.stl --ascii", ["body + pin", "lid", "knob"]),
        ("union machine.3mf block.off -o x.3mf", ["knob + block", "body + pin"]),
        ("difference cover.3mf slit.off -o x.3mf", ["lid", "lid"]),
        ("intersection machine.3mf block.off -o x.3mf", ["knob + block"]),
        ("eval cover.3mf-slit.off", None),
        ("xor cover.3mf a.off -o x.3mf", ["a", "lid"]),
    ],
)
def test_parts_are_called_as_the_objects_they_are_of(
    files: Path, capsys: Capture, line: str, names: list[str] | None
) -> None:
    if names is None:
        line_words = ["eval", "cover.3mf - (slit.off | a.off)", "-o", "x.3mf"]
        names = ["lid", "lid"]
    else:
        line_words = line.split()
    code, out, err = ran(capsys, *line_words)
    assert code == 0 and "agree" in out, err
    (written,) = Path().glob("x.*")
    found = read(written)
    assert sorted(name for name, _ in found.objects) == sorted(names)
    assert sum(count for _, count in found.objects) == len(found.faces)


def test_the_set_is_what_it_was(files: Path, capsys: Capture) -> None:
    line = ["union", "machine.3mf", "cover.3mf", "--json", "-o"]
    named = json.loads(ran(capsys, *line, "x.3mf")[1])
    assert ran(capsys, *line, "y.ply")[0] == 0
    assert b.load("x.3mf") == b.load("y.ply")
    assert named["volume_exact"] == "15"


def test_files_without_names_stay_one_object(files: Path, capsys: Capture) -> None:
    assert ran(capsys, "union", "a.off", "c.stl", "-o", "x.3mf")[0] == 0
    assert [name for name, _ in read("x.3mf").objects] == [""]


# Found: `--on-invalid repair` gave the parts of a repaired file the names of other objects.
def test_parts_of_repaired_files_keep_their_names(files: Path, capsys: Capture) -> None:
    vertices, faces = joined(cuboid((0, 0, 4), (1, 1, 5)), cuboid((0, 0, 7), (1, 1, 8)))
    write(RawMesh(vertices, faces[1:], objects=(("left", 11), ("right", 12))), "open.obj")
    line = ["union", "open.obj", "cover.3mf", "-o", "x.3mf", "--on-invalid", "repair"]
    assert ran(capsys, *line)[0] == 0
    assert sorted(name for name, _ in read("x.3mf").objects) == ["left", "lid", "right"]


def test_hulls_have_no_names(files: Path, capsys: Capture) -> None:
    assert ran(capsys, "hull", "machine.3mf", "cover.3mf", "-o", "x.3mf")[0] == 0
    assert [name for name, _ in read("x.3mf").objects] == [""]


def test_many_objects_that_became_one_are_counted(files: Path, capsys: Capture) -> None:
    parts = [b.Assembly(f"p{k}", b.box(2, 1, 1 + k).translate(k, 0, 0)) for k in range(6)]
    b.Assembly("row", parts).save("row.3mf")
    assert ran(capsys, "union", "row.3mf", "cover.3mf", "-o", "x.3mf")[0] == 0
    assert [name for name, _ in read("x.3mf").objects] == ["p0 + p1 + p2 + 4 more"]
