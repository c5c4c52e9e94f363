"""Colours in GLB are linear; ours are sRGB."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg.formats.glb import linear_colours

#: Colours of the screen and their light, from the definition of sRGB, to eight digits.
KNOWN = [
    (0.0, 0.0),
    (0.04, 0.00309598),
    (0.2, 0.03310477),
    (0.5, 0.21404114),
    (0.735356983, 0.5),
    (1.0, 1.0),
]


def parts_of(path: Path) -> tuple[dict[str, Any], bytes]:
    data = path.read_bytes()
    size = int.from_bytes(data[12:16], "little")
    return json.loads(data[20 : 20 + size]), data[28 + size :]


@pytest.mark.parametrize(("screen", "amount"), KNOWN)
def test_the_curve_has_known_values(screen: float, amount: float) -> None:
    assert linear_colours.to_linear([screen] * 3 + [0.5]).tolist() == pytest.approx(
        [amount] * 3 + [0.5], abs=1e-8
    )
    assert linear_colours.to_srgb([amount] * 3).tolist() == pytest.approx([screen] * 3, abs=1e-7)


def test_all_bytes_come_back() -> None:
    colors = np.repeat(np.arange(256, dtype=np.uint8)[:, None], 4, axis=1)
    words = linear_colours.linear_words(colors)
    assert len(np.unique(words[:, 0])) == 256
    assert np.array_equal(
        linear_colours.srgb_colours(words / np.float32(65535), is_whole=True)[:, :3], colors[:, :3]
    )


def test_vertices_are_written_as_light_and_read_as_colours(tmp_path: Path) -> None:
    mesh = b.cube(1).to_mesh()
    grey = np.full((8, 4), 128, np.uint8)
    path = tmp_path / "x.glb"
    b.Solid(mesh.vertices, mesh.faces, vertex_attributes={"color": grey}).save(path)
    tree, data = parts_of(path)
    number = tree["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"]
    accessor = tree["accessors"][number]
    assert accessor["componentType"] == 5123 and accessor["normalized"]
    start = tree["bufferViews"][accessor["bufferView"]]["byteOffset"]
    first = np.frombuffer(data, "<u2", 4, start) / 65535
    # 128 of 255 is 21.6 % of the light; opacity is no light.
    assert first.tolist() == pytest.approx([0.2158605] * 3 + [128 / 255], abs=1e-5)
    read = b.load(path).to_mesh()
    values = {**read.vertex_attributes, **read.corner_attributes}["color"]
    assert values.dtype == np.uint8 and (values == 128).all()


def test_materials_are_written_as_light_and_read_as_colours(tmp_path: Path) -> None:
    path = tmp_path / "x.glb"
    color = (0.5, 0.2, 1 / 3, 0.75)
    b.Assembly("part", b.cube(1), color=color).save(path)
    (material,) = parts_of(path)[0]["materials"]
    factor = material["pbrMetallicRoughness"]["baseColorFactor"]
    assert factor == pytest.approx([0.21404114, 0.03310477, 0.09084171, 0.75], abs=1e-7)
    assert b.Assembly.load(path).color == pytest.approx(color, abs=1e-12)
    # What is read again is written again as it is.
    again = b.Assembly.load(path)
    again.save(path)
    assert b.Assembly.load(path).color == again.color


def test_light_in_floats_becomes_colours_in_floats() -> None:
    found = linear_colours.srgb_colours(np.array([[0.5, 0.0, 1.0]], np.float32), is_whole=False)
    assert found.dtype == np.float32 and found[0].tolist() == pytest.approx([0.7353570, 0, 1])
