"""3MF: units, transforms, components, and what is refused."""

import re
import zipfile
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg.errors import not_none
from bspcsg.formats.threemf import package as threemf
from bspcsg.io import RawMesh, read, write
from support.io import cube_mesh, refusal

NAMESPACE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"


def mesh_xml(mesh: RawMesh) -> str:
    vertices = "".join(
        '<vertex x="{}" y="{}" z="{}"/>'.format(*point) for point in mesh.vertices.tolist()
    )
    faces = "".join(
        '<triangle v1="{}" v2="{}" v3="{}"/>'.format(*face) for face in mesh.faces.tolist()
    )
    return f"<mesh><vertices>{vertices}</vertices><triangles>{faces}</triangles></mesh>"


def model(objects: str, items: str, unit: str = "") -> str:
    return (
        f'<model xmlns="{NAMESPACE}" {unit}><resources>{objects}</resources>'
        f"<build>{items}</build></model>"
    )


def package(path: Path, xml: str) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", xml)
    return path


CUBE = f'<object id="1">{mesh_xml(cube_mesh())}</object>'
ITEM = '<item objectid="1"/>'


def volume(mesh: RawMesh) -> float:
    a, b, c = (mesh.vertices[mesh.faces[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij->", np.cross(a, b), c) / 6)


@pytest.mark.parametrize(("unit", "size"), [("", 1), ('unit="inch"', 25.4), ('unit="meter"', 1e3)])
def test_units(tmp_path: Path, unit: str, size: float) -> None:
    raw = read(package(tmp_path / "x.3mf", model(CUBE, ITEM, unit)))
    assert raw.vertices.max() == size
    assert [finding.code for finding in raw.findings] == (["unit"] if unit else [])


# Found: a part of a 3MF in another unit than its root was read in that of the root in silence.
@pytest.mark.parametrize("unit", ["", 'unit="inch"'])
def test_units_that_differ_from_part_to_part_are_told(tmp_path: Path, unit: str) -> None:
    space = 'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06"'
    path = package(
        tmp_path / "x.3mf",
        model("", '<item objectid="1" p:path="/3D/o.model"/>', f"{unit} {space}"),
    )
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("3D/o.model", model(CUBE, "", 'unit="inch"'))
    raw = read(path)
    assert raw.vertices.max() == (25.4 if unit else 1)
    (finding,) = raw.findings
    assert (finding.code, finding.severity) == ("unit", "note" if unit else "warning")
    assert unit or "3D/o.model (inch)" in finding.message


def test_transforms_of_items_and_components(tmp_path: Path) -> None:
    pair = (
        '<object id="2"><components><component objectid="1"/>'
        '<component objectid="1" transform="-1 0 0 0 1 0 0 0 1 5 0 0"/></components></object>'
    )
    items = '<item objectid="2" transform="2 0 0 0 2 0 0 0 2 0 0 7"/>' + ITEM
    raw = read(package(tmp_path / "x.3mf", model(CUBE + pair, items)))
    assert len(raw.faces) == 36
    assert volume(raw) == 17
    assert raw.vertices[:8].min(axis=0).tolist() == [0, 0, 7]
    assert raw.vertices[8:16].min(axis=0).tolist() == [8, 0, 7]


def test_support_is_left_out(tmp_path: Path) -> None:
    support = CUBE.replace('id="1"', 'id="2" type="support"')
    items = ITEM + '<item objectid="2"/>'
    raw = read(package(tmp_path / "x.3mf", model(CUBE + support, items)))
    assert len(raw.faces) == 12
    assert [finding.code for finding in raw.findings] == ["ignored"]


# Found: `1_0` in a transform of a 3MF was taken for 10.
@pytest.mark.parametrize(
    ("old", "new", "code"),
    [
        ('x="1.0"', 'x="nan"', "syntax"),
        ('x="1.0"', "", "syntax"),
        ('v1="0"', 'v1="8"', "index_out_of_range"),
        ('v1="0"', 'v1="-1"', "syntax"),
        ('<item objectid="1"/>', '<item objectid="7"/>', "index_out_of_range"),
        ('<item objectid="1"/>', '<item objectid="1" transform="1 0 0"/>', "syntax"),
        ('<item objectid="1"/>', f'<item objectid="1" transform="1_0{" 0" * 11}"/>', "syntax"),
        ("<model ", '<!DOCTYPE x [<!ENTITY a "a">]><model ', "syntax"),
        ("</build>", "", "syntax"),
        ("<model ", '<model unit="parsec" ', "syntax"),
    ],
)
def test_refused_models(tmp_path: Path, old: str, new: str, code: str) -> None:
    xml = model(CUBE, ITEM)
    assert old in xml
    path = package(tmp_path / "bad.3mf", xml.replace(old, new, 1))
    refusal(path, path.read_bytes(), code)


MATERIALS = 'xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02"'


# Found: a fault of an element was reported twice, at line 1 and as a fault of the encoding.
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("<vertices>", "<vertices><vertex x='0' y='0'/>", "“z” is missing"),
        ("<vertices>", "<vertices><vertex x='0' y='0' z='a'/>", "“vertex” is not valid"),
        ("<triangles>", "<triangles><triangle v1='0' v2='1'/>", "“v3” is missing"),
        ("<object id", "<m:colorgroup id='9'><m:color/></m:colorgroup><object id", "“color” is"),
        ("<object id", "<m:colorgroup/><object id", "“id” is missing"),
        ("<object id", "<m:texture2dgroup id='9'/><object id", "“texid” is missing"),
        ("<object id", "<m:tex2coord u='0' v='0'/><object id", "“tex2coord” is not valid"),
        ("<object id", "<object/><object id", "“id” is missing"),
        ("<item ", "<item/><item ", "“objectid” is missing"),
        ("<item ", "<<item ", "not well-formed"),
    ],
)
def test_faults_of_elements_keep_their_line(tmp_path: Path, old: str, new: str, told: str) -> None:
    xml = model(CUBE, ITEM, MATERIALS)
    head, tail = xml.split(old, 1)
    head = head.replace("><", ">\n<")
    path = package(tmp_path / "x.3mf", head + new.removesuffix(old) + old + tail)
    message = refusal(path, path.read_bytes(), "syntax")
    assert message.startswith(f"{path}/3D/3dmodel.model:{head.count(chr(10)) + 1}: ")
    assert message.count("3dmodel.model") == 1 and told in message


@pytest.mark.parametrize("document", ["<!DOCTYPE model>", "<?xml version='1.0' encoding='x'?>"])
def test_documents_that_are_refused_keep_their_line(tmp_path: Path, document: str) -> None:
    path = package(tmp_path / "x.3mf", document + model(CUBE, ITEM))
    message = refusal(path, path.read_bytes(), "syntax")
    assert message.startswith(f"{path}/3D/3dmodel.model:1: ")
    assert message.count("3dmodel.model") == 1


# Found: a reference to a colour that does not exist was reported as a damaged archive.
@pytest.mark.parametrize(
    "group",
    [
        '<m:colorgroup id="5"><m:color color="#FF0000"/></m:colorgroup>',
        '<basematerials id="5"><base name="a" displaycolor="#FF0000"/></basematerials>',
        '<m:texture2d id="6" path="/a.png" contenttype="image/png"/>'
        '<m:texture2dgroup id="5" texid="6"><m:tex2coord u="0" v="0"/></m:texture2dgroup>',
        '<m:texture2dgroup id="5" texid="7"><m:tex2coord u="0" v="0"/></m:texture2dgroup>',
    ],
)
@pytest.mark.parametrize("place", ["triangle", "object"])
def test_properties_that_do_not_exist(tmp_path: Path, group: str, place: str) -> None:
    cube = CUBE.replace("<object ", '<object pid="5" pindex="1" ')
    if place == "triangle":
        cube = CUBE.replace("<triangle ", '<triangle pid="5" p1="1" ', 1)
    path = package(tmp_path / "x.3mf", model(group + cube, ITEM, MATERIALS))
    message = refusal(path, path.read_bytes(), "index_out_of_range")
    assert "object 1 in 3D/3dmodel.model: " in message and "damaged" not in message


def test_objects_that_contain_each_other(tmp_path: Path) -> None:
    loop = '<object id="1"><components><component objectid="1"/></components></object>'
    path = package(tmp_path / "loop.3mf", model(loop, ITEM))
    refusal(path, path.read_bytes(), "too_large")


def test_objects_that_multiply(tmp_path: Path) -> None:
    doubled = "".join(
        f'<object id="{n}"><components><component objectid="{n - 1}"/>'
        f'<component objectid="{n - 1}"/></components></object>'
        for n in range(2, 50)
    )
    path = package(tmp_path / "many.3mf", model(CUBE + doubled, '<item objectid="49"/>'))
    refusal(path, path.read_bytes(), "too_large")


@pytest.mark.parametrize("cut", [10, 100])
def test_damaged_archives(tmp_path: Path, cut: int) -> None:
    path = package(tmp_path / "cut.3mf", model(CUBE, ITEM))
    refusal(path, path.read_bytes()[:-cut], "truncated")


def test_damaged_part(tmp_path: Path) -> None:
    data = bytearray(package(tmp_path / "x.3mf", model(CUBE, ITEM)).read_bytes())
    data[60:90] = bytes(30)
    refusal(tmp_path / "x.3mf", bytes(data), "truncated")


def test_archive_without_a_model(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "x.3mf", "w") as archive:
        archive.writestr("readme.txt", "nothing")
    refusal(tmp_path / "x.3mf", (tmp_path / "x.3mf").read_bytes(), "truncated")


@pytest.mark.parametrize("depth", [1000, 300_000])
def test_deep_xml_is_no_harm(tmp_path: Path, depth: int) -> None:
    deep = "<metadatagroup>" * depth + "</metadatagroup>" * depth
    raw = read(package(tmp_path / "deep.3mf", model(CUBE + deep, ITEM)))
    assert len(raw.faces) == 12
    path = package(tmp_path / "open.3mf", "<model>" * depth)
    refusal(path, path.read_bytes(), "syntax")


def test_parts_that_unpack_to_too_much(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threemf, "_MIN_BYTE_LIMIT", 1000)
    path = package(tmp_path / "bomb.3mf", model(CUBE, ITEM) + " " * 10**7)
    assert path.stat().st_size < 20_000
    assert "unpacks to too much data" in refusal(path, path.read_bytes(), "too_large")


def test_archives_of_too_many_parts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threemf, "_MAX_PARTS", 0)
    path = package(tmp_path / "x.3mf", model(CUBE, ITEM))
    refusal(path, path.read_bytes(), "too_large")
    with pytest.raises(b.FormatError, match="more than 0 parts"):
        b.Assembly.load(path)


REUSED = (
    f'<object id="1" name="lid">{mesh_xml(cube_mesh())}</object>'
    f'<object id="2" name="lid">{mesh_xml(cube_mesh(2.0))}</object>'
    '<object id="3" name="pair"><components><component objectid="1"/>'
    '<component objectid="1" transform="-1 0 0 0 1 0 0 0 1 -5 0 0"/>'
    '<component objectid="2" transform="1 0 0 0 1 0 0 0 1 0 9 0"/></components></object>'
    '<object id="4"><components><component objectid="3"/>'
    '<component objectid="3" transform="1 0 0 0 -1 0 0 0 1 0 -20 0"/></components></object>'
)


# Found: a component used twice lost half of its volume.
@pytest.mark.parametrize("suffix", [".glb", ".3mf", ".obj", ".stl", ".ply"])
def test_reused_components_go_everywhere(tmp_path: Path, suffix: str) -> None:
    """Equal names, one component at several places, mirrored ones, pairs in pairs."""
    xml = model(
        REUSED, '<item objectid="4"/><item objectid="3" transform="1 0 0 0 1 0 0 0 1 50 0 0"/>'
    )
    raw = read(package(tmp_path / "in.3mf", xml))
    assert [name for name, _ in raw.objects] == ["lid"] * 9 and volume(raw) == 30
    write(raw, tmp_path / f"out{suffix}", text=suffix == ".stl")
    found = read(tmp_path / f"out{suffix}")
    assert len(found.faces) == 108 and volume(found) == 30
    assert b.load(tmp_path / f"out{suffix}").volume == 30
    if suffix != ".ply":
        assert found.objects == raw.objects


def test_objects_of_one_number_are_refused(tmp_path: Path) -> None:
    twice = CUBE + CUBE.replace('<vertex x="0.0"', '<vertex x="-9.0"')
    path = package(tmp_path / "x.3mf", model(twice, ITEM))
    assert "two objects have the number 1" in refusal(path, path.read_bytes(), "syntax")


def test_objects_outside_the_build_are_told(tmp_path: Path) -> None:
    other = CUBE.replace('id="1"', 'id="2"')
    raw = read(package(tmp_path / "x.3mf", model(CUBE + other, ITEM)))
    assert [finding.message for finding in raw.findings] == [
        "1 objects that the build does not use were ignored."
    ]
    assert raw.passed_by and len(raw.faces) == 12


BOOLEANS = "http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07"


def shape(number: int, base: int, operation: str, *operands: str, moved: str = "") -> str:
    """Return the XML of an object that is a boolean shape; operands are attributes of elements."""
    inner = "".join(f"<bo:boolean {words}/>" for words in operands)
    told = f'operation="{operation}"' if operation else ""
    head = f'<bo:booleanshape xmlns:bo="{BOOLEANS}" objectid="{base}" {told} {moved}>'
    return f'<object id="{number}" name="shape {number}">{head}{inner}</bo:booleanshape></object>'


def by(x: float, y: float = 0, z: float = 0) -> str:
    return f'transform="1 0 0 0 1 0 0 0 1 {x} {y} {z}"'


@pytest.mark.parametrize(
    ("operation", "shifts", "size"),
    [
        ("", (0.5, -0.75), 2.25),
        ("union", (0.5, -0.75), 2.25),
        ("difference", (0.5, -0.75), 0.25),
        ("intersection", (0.5, 0.75), 0.25),
        ("intersection", (0.5, -0.75), 0),
        ("difference", (0,), 0),
    ],
)
def test_boolean_shapes_are_evaluated(
    tmp_path: Path, operation: str, shifts: tuple[float, ...], size: float
) -> None:
    objects = CUBE + shape(2, 1, operation, *(f'objectid="1" {by(x)}' for x in shifts))
    path = package(tmp_path / "x.3mf", model(objects, '<item objectid="2"/>'))
    raw = read(path)
    assert volume(raw) == size and b.load(path).volume == size
    assert [found.code for found in raw.findings] == (["empty"] if size == 0 else [])
    assert [name for name, _ in raw.objects] == (["shape 2"] if size else [])
    assert b.Assembly.load(path).to_solid().volume == size


def test_boolean_shapes_of_each_other_in_their_places(tmp_path: Path) -> None:
    """Half a cube, mirrored and taken from a larger one, twice in inches, once in an assembly."""
    half = shape(2, 1, "difference", f'objectid="1" {by(0.5)}')
    mirrored = 'objectid="2" transform="-1 0 0 0 1 0 0 0 1 2 0.5 0.5"'
    large = shape(3, 1, "difference", mirrored, moved='transform="2 0 0 0 2 0 0 0 2 0 0 0"')
    twice = f'<component objectid="3"/><component objectid="3" {by(9)}/>'
    pair = f'<object id="4"><components>{twice}</components></object>'
    path = package(tmp_path / "x.3mf", model(CUBE + half + large + pair, '<item objectid="4"/>'))
    box = b.box(2, 2, 2) - b.box(0.5, 1, 1).translate(1.5, 0.5, 0.5)
    assert b.load(path) == (box | box.translate(9, 0, 0))
    assert [found.message for found in read(path).findings] == []
    assembly = b.Assembly.load(path)
    assert assembly.to_solid() == b.load(path)
    inches = model(CUBE + half + large, '<item objectid="3"/>', 'unit="inch"')
    assert b.load(package(path, inches)).volume == pytest.approx(7.5 * 25.4**3)


def test_a_cut_has_the_colours_of_what_it_was_cut_with(tmp_path: Path) -> None:
    bases = (
        '<basematerials id="9"><base name="red" displaycolor="#FF0000"/>'
        '<base name="blue" displaycolor="#0000FF"/></basematerials>'
    )
    red = CUBE.replace('id="1"', 'id="1" pid="9" pindex="0"')
    blue = CUBE.replace('id="1"', 'id="2" pid="9" pindex="1"')
    objects = bases + red + blue + shape(3, 1, "difference", f'objectid="2" {by(0.5)}')
    raw = read(package(tmp_path / "x.3mf", model(objects, '<item objectid="3"/>')))
    said = not_none(raw.attributes, "attributes")
    at_cut = (raw.vertices[raw.faces][:, :, 0] == 0.5).all(axis=1)
    assert set(said.face["material"][at_cut]) == {"blue"}
    assert set(said.face["material"][~at_cut]) == {"red"}
    assert said.materials["blue"].color == (0, 0, 1, 1)


def test_parts_of_boolean_shapes_may_lie_in_another_part(tmp_path: Path) -> None:
    space = 'xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06"'
    operand = f'objectid="1" {space} p:path="/3D/other.model" {by(0.5)}'
    objects = CUBE + shape(2, 1, "difference", operand)
    with zipfile.ZipFile(tmp_path / "x.3mf", "w") as archive:
        archive.writestr("3D/3dmodel.model", model(objects, '<item objectid="2"/>'))
        archive.writestr("3D/other.model", model(CUBE, ""))
    assert b.load(tmp_path / "x.3mf") == b.box(0.5, 1, 1)


OPEN = CUBE.replace('<triangle v1="0"', '<t v1="0"', 1)


@pytest.mark.parametrize(
    ("objects", "code"),
    [
        (CUBE + shape(2, 1, "xor", 'objectid="1"'), "syntax"),
        (CUBE + shape(2, 7, "union", 'objectid="1"'), "index_out_of_range"),
        (CUBE + shape(2, 2, "union", 'objectid="1"'), "too_large"),
        (
            CUBE + shape(2, 1, "union", 'objectid="1" transform="0 0 0 0 1 0 0 0 1 0 0 0"'),
            "unsupported",
        ),
        (OPEN + shape(2, 1, "union", 'objectid="1"'), "not_closed"),
        (CUBE.replace("id=", 'type="support" id=') + shape(2, 1, ""), "unsupported"),
        (
            '<object id="1"><components/></object>' + shape(2, 1, "union", 'objectid="1"'),
            "unsupported",
        ),
        (CUBE + f'<object id="2"><boolean xmlns="{BOOLEANS}" objectid="1"/></object>', "syntax"),
    ],
)
def test_boolean_shapes_that_are_none(tmp_path: Path, objects: str, code: str) -> None:
    path = package(tmp_path / "x.3mf", model(objects, '<item objectid="2"/>'))
    refusal(path, path.read_bytes(), code)


def test_a_fault_of_ours_is_no_damage_of_the_archive(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise b.InternalError("an invariant failed", "internal")

    monkeypatch.setattr("bspcsg.formats.threemf.objects.combine", fail)
    objects = CUBE + shape(2, 1, "union", 'objectid="1"')
    path = package(tmp_path / "x.3mf", model(objects, '<item objectid="2"/>'))
    with pytest.raises(b.InternalError, match="an invariant failed"):
        read(path)


def test_boolean_shapes_that_multiply(tmp_path: Path) -> None:
    doubled = "".join(
        shape(n, n - 1, "union", f'objectid="{n - 1}" {by(2.0 ** (n - 1))}') for n in range(2, 60)
    )
    path = package(tmp_path / "x.3mf", model(CUBE + doubled, '<item objectid="59"/>'))
    refusal(path, path.read_bytes(), "too_large")


@pytest.mark.parametrize(
    ("space", "is_read"),
    [
        ("http://schemas.microsoft.com/3dmanufacturing/material/2015/02", True),
        ("http://schemas.microsoft.com/3dmanufacturing/production/2015/06", True),
        (BOOLEANS, True),
        ("http://schemas.microsoft.com/3dmanufacturing/slice/2015/07", False),
        ("http://schemas.microsoft.com/3dmanufacturing/securecontent/2019/07", False),
        ("http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01", False),
    ],
)
def test_a_model_that_needs_an_extension(tmp_path: Path, space: str, is_read: bool) -> None:
    said = f'xmlns:x="{space}" requiredextensions="x"'
    path = package(tmp_path / "x.3mf", model(CUBE, ITEM, said))
    if is_read:
        assert len(read(path).faces) == 12
    else:
        assert space in refusal(path, path.read_bytes(), "unsupported")


def test_objects_without_triangles_are_told(tmp_path: Path) -> None:
    hollow = '<object id="2"><levelset functionid="7"/></object>'
    raw = read(package(tmp_path / "x.3mf", model(CUBE + hollow, ITEM + '<item objectid="2"/>')))
    assert [found.message for found in raw.findings] == [
        "1 objects without triangles were ignored."
    ]


def painted(bases: str) -> str:
    """Return the XML of a cube with two materials on alternating triangles."""
    told = CUBE
    for k in range(12):
        told = told.replace('"/><triangle', f'" pid="9" p1="{k % 2}" /><triangle', 1)
    told = told.replace('"/></triangles>', '" pid="9" p1="1"/></triangles>')
    return f'<basematerials id="9">{bases}</basematerials>' + told


# Found: two base materials of one name in a 3MF became one, with the colour of the last, and
# those without a name were lost when written again.
@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (("PLA", "PLA"), ["PLA", "PLA (1)"]),
        (("", ""), ["material 0", "material 1"]),
        (("", "material 0"), ["material 0 (0)", "material 0"]),
    ],
)
def test_materials_of_one_name_stay_apart(
    tmp_path: Path, names: tuple[str, str], expected: list[str]
) -> None:
    red, blue = (
        f'<base name="{name}" displaycolor="#{color}"/>'
        for name, color in zip(names, ("FF0000", "0000FF"), strict=True)
    )
    path = package(tmp_path / "x.3mf", model(painted(red + blue), ITEM))
    write(read(path), path)
    said = not_none(read(path).attributes, "the attributes")
    assert said.face["material"].tolist() == expected * 6
    colors = [said.materials[name].color for name in expected]
    assert colors == [(1, 0, 0, 1), (0, 0, 1, 1)]


FLAT = '<item objectid="2" transform="0 0 0 0 0 0 0 0 0 5 0 0"/>'


# Found: `Assembly.load` took support of a 3MF as a part, and refused files with surfaces, lines,
# or a part scaled to nothing, which `load` passes by.
@pytest.mark.parametrize(
    ("kind", "item"),
    [("support", '<item objectid="2"/>'), ("surface", '<item objectid="2"/>'), ("model", FLAT)],
)
def test_assemblies_pass_by_what_loading_does(tmp_path: Path, kind: str, item: str) -> None:
    other = CUBE.replace('id="1"', f'id="2" type="{kind}"')
    if kind == "surface":
        other = re.sub("<triangle [^>]*/>", "", other, count=1)
    path = package(tmp_path / "x.3mf", model(CUBE + other, ITEM + item))
    assert b.load(path).volume == 1
    assert [part.solid.volume for part in b.Assembly.load(path)] == [1]
    package(path, model(other, item))
    for load in (b.load, b.Assembly.load):
        with pytest.raises(b.InvalidMeshError) as caught:
            load(path)
        assert caught.value.code == "empty_mesh"


# Found: a 3MF with slices, which need not be understood, was refused: their points were taken for
# vertices.
def test_elements_of_other_namespaces_are_passed_by(tmp_path: Path) -> None:
    space = "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07"
    slices = (
        f'<s:slicestack xmlns:s="{space}" id="7" zbottom="0"><s:slice ztop="1"><s:vertices>'
        '<s:vertex x="0" y="0"/></s:vertices></s:slice></s:slicestack>'
    )
    path = package(tmp_path / "x.3mf", model(slices + CUBE, ITEM))
    assert b.load(path).volume == 1
    package(path, model(CUBE + slices, ITEM))
    assert b.load(path).volume == 1
