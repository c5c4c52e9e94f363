"""3MF files as lib3mf, the reader of the 3MF consortium, reads them."""

from pathlib import Path
from typing import Any

import lib3mf
import numpy as np
import pytest

import bspcsg as b
from support.pictures import PIXEL

RNG = np.random.default_rng(33)

#: Materials of a cube's sides, all but the last two with a picture.
NAMES = ["wood", "a b", "ä", "1%/2", "..", "paint"]


def strict(path: Path) -> Any:
    """Return lib3mf's model of a file, and assert that it has no warnings."""
    model = lib3mf.Wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    assert [reader.GetWarning(k) for k in range(reader.GetWarningCount())] == []
    return model


def all_of(iterator: Any, current: str) -> list[Any]:
    found = []
    while iterator.MoveNext():
        found.append(getattr(iterator, current)())
    return found


def shape(**attributes: Any) -> b.Solid:
    mesh = b.cube(2).to_mesh()
    materials = {name: b.Material(texture=PIXEL) for name in NAMES[:-1]}
    materials["paint"] = b.Material((1, 0.2, 0))
    return b.Solid(mesh.vertices, mesh.faces, materials=materials, **attributes)


def test_pictures_are_where_corners_say(tmp_path: Path) -> None:
    uv, names = RNG.uniform(size=(12, 3, 2)), np.repeat(NAMES, 2)
    solid = shape(corner_attributes={"uv": uv}, face_attributes={"material": names})
    solid.save(tmp_path / "x.3mf")
    model = strict(tmp_path / "x.3mf")
    textures = all_of(model.GetTexture2Ds(), "GetCurrentTexture2D")
    assert [one.GetAttachment().GetStreamSize() for one in textures] == [len(PIXEL)] * 5
    (body,) = all_of(model.GetMeshObjects(), "GetCurrentMeshObject")
    groups = {
        one.GetResourceID(): one
        for one in all_of(model.GetTexture2DGroups(), "GetCurrentTexture2DGroup")
    }
    for row in range(10):
        told = body.GetTriangleProperties(row)
        group = groups[told.ResourceID]
        places = [group.GetTex2Coord(number) for number in told.PropertyIDs]
        assert [(place.U, place.V) for place in places] == [tuple(one) for one in uv[row].tolist()]
    (bases,) = all_of(model.GetBaseMaterialGroups(), "GetCurrentBaseMaterialGroup")
    assert bases.GetName(bases.GetAllPropertyIDs()[0]) == "paint"


@pytest.mark.parametrize("kind", ["face", "corner"])
def test_colours_are_as_given(tmp_path: Path, kind: str) -> None:
    colors = RNG.integers(0, 256, {"face": (12, 4), "corner": (12, 3, 4)}[kind]).astype(np.uint8)
    shape(**{f"{kind}_attributes": {"color": colors}}).save(tmp_path / "x.3mf")
    model = strict(tmp_path / "x.3mf")
    (group,) = all_of(model.GetColorGroups(), "GetCurrentColorGroup")
    (body,) = all_of(model.GetMeshObjects(), "GetCurrentMeshObject")
    wanted = np.broadcast_to(colors.reshape(12, -1, 4), (12, 3, 4))
    for row in range(12):
        numbers = body.GetTriangleProperties(row).PropertyIDs
        found = [group.GetColor(number) for number in numbers]
        assert [[c.Red, c.Green, c.Blue, c.Alpha] for c in found] == wanted[row].tolist()


def test_assemblies_are_built_of_components(tmp_path: Path) -> None:
    nut = b.Assembly("nut", b.cube(1), color=(1, 0, 0))
    given = {"face_attributes": {"material": np.full(12, "wood")}}
    wood = shape(**given, corner_attributes={"uv": RNG.uniform(size=(12, 3, 2))})
    parts = [nut, nut.translate(3, 0, 0), b.Assembly("plank", wood)]
    b.Assembly("all", parts).save(tmp_path / "x.3mf")
    model = strict(tmp_path / "x.3mf")
    (whole,) = all_of(model.GetBuildItems(), "GetCurrent")
    assert whole.GetObjectResource().GetName() == "all"
    assert len(all_of(model.GetMeshObjects(), "GetCurrentMeshObject")) == 2
    assert len(all_of(model.GetTexture2Ds(), "GetCurrentTexture2D")) == 1


def test_what_lib3mf_writes_is_read(tmp_path: Path) -> None:
    model = lib3mf.Wrapper().CreateModel()
    body = model.AddMeshObject()
    mesh = b.cube(2).to_mesh()
    corners = [lib3mf.Position(tuple(point)) for point in mesh.vertices.tolist()]
    body.SetGeometry(corners, [lib3mf.Triangle(tuple(face)) for face in mesh.faces.tolist()])
    relation = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture"
    attachment = model.AddAttachment("/3D/Texture/wood.png", relation)
    attachment.ReadFromBuffer(PIXEL)
    texture = model.AddTexture2DFromAttachment(attachment)
    texture.SetContentType(lib3mf.TextureType.PNG)
    group = model.AddTexture2DGroup(texture)
    places = [group.AddTex2Coord(lib3mf.Tex2Coord(u, v)) for u, v in ((0, 0), (1, 0), (1, 0.5))]
    told = lib3mf.TriangleProperties()
    told.ResourceID = group.GetResourceID()
    told.PropertyIDs = (type(told.PropertyIDs))(*places)
    for row in range(12):
        body.SetTriangleProperties(row, told)
    body.SetObjectLevelProperty(group.GetResourceID(), places[0])
    model.AddBuildItem(body, lib3mf.Wrapper().GetIdentityTransform())
    model.QueryWriter("3mf").WriteToFile(str(tmp_path / "x.3mf"))
    found = b.load(tmp_path / "x.3mf").to_mesh()
    assert found.materials["wood"].texture == PIXEL
    assert found.attributes is not None
    assert found.attributes.at_corners("uv")[4].tolist() == [[0, 0], [1, 0], [1, 0.5]]
