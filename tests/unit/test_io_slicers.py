"""3MF files of slicers, with parts that are subtracted or are no solids."""

import zipfile
from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg.io import RawMesh, read
from support.io import cube_mesh
from support.shapes import cuboid

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
CURA = "http://software.ultimaker.com/xml/cura/3mf/2015/10"

BODY = RawMesh(*cuboid((0, 0, 0), (4, 4, 4)))
UPPER = RawMesh(*cuboid((-1, -1, 2), (5, 5, 5)))
INSIDE = RawMesh(*cuboid((1, 1, 1), (2, 2, 2)))
BESIDE = RawMesh(*cuboid((9, 0, 0), (10, 1, 1)))
OPEN = RawMesh(cube_mesh(2.0).vertices, cube_mesh(2.0).faces[:-1])

Part = tuple[RawMesh, str]


def mesh_xml(*meshes: RawMesh) -> str:
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    points = np.concatenate([mesh.vertices for mesh in meshes]).tolist()
    faces = np.concatenate([mesh.faces + k for mesh, k in zip(meshes, starts, strict=False)])
    return (
        "<mesh><vertices>"
        + "".join('<vertex x="{}" y="{}" z="{}"/>'.format(*point) for point in points)
        + "</vertices><triangles>"
        + "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*face) for face in faces.tolist())
        + "</triangles></mesh>"
    )


def packed(path: Path, objects: str, build: str, **parts: str) -> Path:
    names = f'xmlns="{CORE}" xmlns:p="{PRODUCTION}" xmlns:cura="{CURA}"'
    with zipfile.ZipFile(path, "w") as archive:
        text = f"<model {names}><resources>{objects}</resources><build>{build}</build></model>"
        archive.writestr("3D/3dmodel.model", text)
        for name, text in parts.items():
            archive.writestr(_NAMES[name], text)
    return path


_NAMES = {
    "prusa": "Metadata/Slic3r_PE_model.config",
    "bambu": "Metadata/model_settings.config",
    "inner": "3D/Objects/object_1.model",
}


def volumes(parts: list[Part], key: str = "volume_type") -> str:
    ends = np.cumsum([0, *(len(mesh.faces) for mesh, _ in parts)]).tolist()
    said = "".join(
        f'<volume firstid="{first}" lastid="{end - 1}">'
        f'<metadata type="volume" key="{key}" value="{kind}"/></volume>'
        for (_, kind), first, end in zip(parts, ends, ends[1:], strict=False)
    )
    return f'<config><object id="1"><metadata type="object" key="name"/>{said}</object></config>'


def prusa(path: Path, parts: list[Part]) -> Path:
    mesh = mesh_xml(*(mesh for mesh, _ in parts))
    item = '<item objectid="1"/>'
    return packed(path, f'<object id="1">{mesh}</object>', item, prusa=volumes(parts))


def bambu(path: Path, parts: list[Part], moved: str = "") -> Path:
    inner = "".join(
        f'<object id="{k}" name="n{k}">{mesh_xml(mesh)}</object>'
        for k, (mesh, _) in enumerate(parts, 1)
    )
    components = "".join(
        f'<component p:path="/3D/Objects/object_1.model" objectid="{k}"{moved}/>'
        for k in range(1, len(parts) + 1)
    )
    said = "".join(f'<part id="{k}" subtype="{kind}"/>' for k, (_, kind) in enumerate(parts, 1))
    return packed(
        path,
        f'<object id="9"><components>{components}</components></object>',
        '<item objectid="9"/>',
        inner=f'<model xmlns="{CORE}"><resources>{inner}</resources><build/></model>',
        bambu=f'<config><object id="9">{said}</object></config>',
    )


def cura(path: Path, parts: list[Part], word: str = "True") -> Path:
    objects = "".join(
        f'<object id="{k}"><metadatagroup><metadata name="cura:{kind}">{word}</metadata>'
        f"</metadatagroup>{mesh_xml(mesh)}</object>"
        for k, (mesh, kind) in enumerate(parts)
    )
    return packed(path, objects, "".join(f'<item objectid="{k}"/>' for k in range(len(parts))))


# Found: what slicers take away, modifiers and supports were all read as solid in silence.
@pytest.mark.parametrize(
    ("make", "body", "other", "volume"),
    [
        (prusa, "ModelPart", (UPPER, "NegativeVolume"), 32),
        (prusa, "ModelPart", (INSIDE, "NegativeVolume"), 63),
        (prusa, "ModelPart", (BESIDE, "NegativeVolume"), 64),
        (prusa, "ModelPart", (UPPER, "ParameterModifier"), 64),
        (prusa, "ModelPart", (BESIDE, "SupportBlocker"), 64),
        (prusa, "ModelPart", (BESIDE, "SupportEnforcer"), 64),
        (bambu, "normal_part", (UPPER, "negative_part"), 32),
        (bambu, "normal_part", (INSIDE, "negative_part"), 63),
        (bambu, "normal_part", (UPPER, "modifier_part"), 64),
        (bambu, "normal_part", (BESIDE, "support_blocker"), 64),
        (bambu, "normal_part", (BESIDE, "support_enforcer"), 64),
        (cura, "drop_to_buildplate", (BESIDE, "anti_overhang_mesh"), 64),
        (cura, "drop_to_buildplate", (BESIDE, "support_mesh"), 64),
        (cura, "drop_to_buildplate", (UPPER, "infill_mesh"), 64),
        (cura, "drop_to_buildplate", (UPPER, "cutting_mesh"), 64),
    ],
)
@pytest.mark.parametrize("is_first", [False, True])
def test_parts_are_what_slicers_call_them(
    tmp_path: Path, make: object, body: str, other: Part, volume: float, is_first: bool
) -> None:
    assert callable(make)
    parts = [other, (BODY, body)] if is_first else [(BODY, body), other]
    path = make(tmp_path / "x.3mf", parts)
    raw = read(path)
    assert b.load(path).volume == volume
    (told,) = raw.findings
    is_taken = other[1].lower().startswith("negative")
    assert told.code == ("negative_volumes" if is_taken else "ignored")
    assert is_taken or len(raw.passed_by) == 1
    assert sum(part.solid.volume for part in b.Assembly.load(path).parts) == volume


@pytest.mark.parametrize(
    ("make", "kind"), [(prusa, "ModelPart"), (bambu, "normal_part"), (cura, "drop_to_buildplate")]
)
def test_parts_of_material_stay(tmp_path: Path, make: object, kind: str) -> None:
    assert callable(make)
    path = make(tmp_path / "x.3mf", [(BODY, kind), (BESIDE, kind)])
    assert b.load(path).volume == 65
    assert read(path).findings == ()


def test_cura_may_say_no(tmp_path: Path) -> None:
    path = cura(tmp_path / "x.3mf", [(BODY, "support_mesh"), (BESIDE, "infill_mesh")], "False")
    assert b.load(path).volume == 65


def test_what_old_files_call_a_modifier(tmp_path: Path) -> None:
    parts = [(BODY, "0"), (UPPER, "1")]
    said = volumes(parts, "modifier")
    objects = f'<object id="1">{mesh_xml(BODY, UPPER)}</object>'
    path = packed(tmp_path / "x.3mf", objects, '<item objectid="1"/>', prusa=said)
    assert b.load(path).volume == 64
    assert read(path).passed_by == (
        "1 modifiers of a slicer, which are not material, were ignored.",
    )


def test_several_parts_and_negative_volumes_of_an_object(tmp_path: Path) -> None:
    for make, body, negative in (
        (prusa, "ModelPart", "NegativeVolume"),
        (bambu, "normal_part", "negative_part"),
    ):
        parts = [(BODY, body), (UPPER, negative), (BESIDE, body), (INSIDE, negative)]
        path = make(tmp_path / "x.3mf", parts)
        assert b.load(path).volume == 32
        assert [found.count for found in read(path).findings] == [2]


def test_components_are_taken_away_where_they_are(tmp_path: Path) -> None:
    moved = ' transform="0 1 0 -1 0 0 0 0 1 7 8 9"'
    parts = [(BODY, "normal_part"), (UPPER, "negative_part")]
    path = bambu(tmp_path / "x.3mf", parts, moved)
    solid = b.load(path)
    assert solid.volume == 32
    assert solid.bounds is not None
    assert np.array_equal(solid.bounds, [[3, 8, 9], [7, 12, 11]])
    assert [name for name, _ in read(path).objects] == ["n1"]


def test_what_cannot_be_taken_away_is_told(tmp_path: Path) -> None:
    for make, body, negative in (
        (prusa, "ModelPart", "NegativeVolume"),
        (bambu, "normal_part", "negative_part"),
    ):
        for parts in ([(BODY, body), (OPEN, negative)], [(OPEN, body), (BODY, negative)]):
            raw = read(make(tmp_path / "x.3mf", parts))
            assert len(raw.faces) == len(parts[0][0].faces)
            (told,) = raw.passed_by
            assert told.startswith("negative volumes of a slicer were ignored") and "closed" in told


def test_what_there_is_nothing_to_take_away_from_is_told(tmp_path: Path) -> None:
    inner = "".join(
        f'<object id="{k}">{mesh_xml(mesh)}</object>' for k, mesh in ((1, BODY), (3, INSIDE))
    )
    group = '<object id="2"><components><component objectid="1"/></components></object>'
    whole = '<components><component objectid="2"/><component objectid="3"/></components>'
    path = packed(
        tmp_path / "x.3mf",
        f'{inner}{group}<object id="9">{whole}</object>',
        '<item objectid="9"/>',
        bambu='<config><object id="9"><part id="3" subtype="negative_part"/></object></config>',
    )
    assert b.load(path).volume == 64
    (told,) = read(path).findings
    assert told.code == "ignored" and told.message.endswith("object 2 is not a mesh.")
    for make, kind in ((prusa, "NegativeVolume"), (bambu, "negative_part")):
        with pytest.raises(b.InvalidMeshError, match=r"negative volumes .* there is no part"):
            b.load(make(tmp_path / "x.3mf", [(BODY, kind)]))


def test_other_places_of_an_object(tmp_path: Path) -> None:
    """PrusaSlicer writes further instances as objects of one component."""
    parts = [(BODY, "ModelPart"), (INSIDE, "NegativeVolume")]
    again = '<object id="2"><components><component objectid="1"/></components></object>'
    moved = '<item objectid="2" transform="-1 0 0 0 1 0 0 0 1 50 0 0"/>'
    path = packed(
        tmp_path / "x.3mf",
        f'<object id="1" name="p">{mesh_xml(BODY, INSIDE)}</object>{again}',
        f'<item objectid="1"/>{moved}',
        prusa=volumes(parts),
    )
    assert b.load(path).volume == 126
    assert [name for name, _ in read(path).objects] == ["p", "p"]


def test_a_body_that_is_taken_away_as_a_whole_is_nothing(tmp_path: Path) -> None:
    path = prusa(tmp_path / "x.3mf", [(INSIDE, "ModelPart"), (BODY, "NegativeVolume")])
    assert b.load(path).is_empty


def test_nothing_but_what_is_no_material(tmp_path: Path) -> None:
    path = cura(tmp_path / "x.3mf", [(BODY, "support_mesh")])
    with pytest.raises(b.InvalidMeshError, match="1 objects of the type “support”"):
        b.load(path)
    path = bambu(tmp_path / "x.3mf", [(BODY, "modifier_part")])
    with pytest.raises(b.InvalidMeshError, match="1 modifiers of a slicer"):
        b.load(path)


@pytest.mark.parametrize(
    "said", ["<config", "<config><object/></config>", '<config><object id="1"><volume/></object>']
)
def test_settings_that_cannot_be_read_are_told(tmp_path: Path, said: str) -> None:
    objects = f'<object id="1">{mesh_xml(BODY)}</object>'
    path = packed(tmp_path / "x.3mf", objects, '<item objectid="1"/>', prusa=said)
    assert b.load(path).volume == 64
    (told,) = read(path).passed_by
    assert told.startswith("the settings of a slicer in the file cannot be read")


def test_numbers_out_of_range_and_kinds_that_are_not_known(tmp_path: Path) -> None:
    said = volumes([(BODY, "ModelPart"), (BODY, "SupportBlocker"), (BODY, "Label")])
    objects = f'<object id="1">{mesh_xml(BODY)}</object>'
    path = packed(tmp_path / "x.3mf", objects, '<item objectid="1"/>', prusa=said)
    assert b.load(path).volume == 64
    assert {found.code for found in read(path).findings} == {"ignored", "unknown_part"}
