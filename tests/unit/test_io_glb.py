"""GLB: metres and axes, nodes, names, single precision, and refusals."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import bspcsg as b
from bspcsg.errors import FormatError
from bspcsg.io import RawMesh, read, write
from support.io import cube_mesh, read_text, refusal, same_mesh
from support.shapes import cube, icosphere, joined, moved

Edit = Callable[[dict[str, Any]], Any]


def opened(data: bytes) -> tuple[dict[str, Any], bytes]:
    """Return the JSON document and the binary chunk of a GLB file."""
    size = int.from_bytes(data[12:16], "little")
    return json.loads(data[20 : 20 + size]), data[20 + size :]


def closed(tree: dict[str, Any], rest: bytes) -> bytes:
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    chunk = len(text).to_bytes(4, "little") + b"JSON" + text
    return (
        b"glTF"
        + (2).to_bytes(4, "little")
        + (12 + len(chunk + rest)).to_bytes(4, "little")
        + chunk
        + rest
    )


def cube_file(path: Path) -> bytes:
    write(cube_mesh(2.0), path)
    return path.read_bytes()


def edited(path: Path, edit: Edit) -> bytes:
    tree, rest = opened(cube_file(path))
    edit(tree)
    return closed(tree, rest)


def test_what_single_precision_holds_comes_back(tmp_path: Path) -> None:
    findings = write(cube_mesh(2.5), tmp_path / "x.glb")
    assert [finding.code for finding in findings] == ["unit"]
    raw = read(tmp_path / "x.glb")
    same_mesh(raw, cube_mesh(2.5))
    assert raw.unit == "mm" and [finding.code for finding in raw.findings] == ["unit"]


def test_what_it_does_not_hold_is_said(tmp_path: Path) -> None:
    ball = RawMesh(*icosphere(2))
    codes = [finding.code for finding in write(ball, tmp_path / "x.glb")]
    assert codes == ["unit", "single_precision"]
    assert np.abs(read(tmp_path / "x.glb").vertices - ball.vertices).max() < 1e-7


def test_other_readers_see_metres_with_y_upwards(tmp_path: Path) -> None:
    write(RawMesh(*b.box((1000, 2000, 3000)).normalized().to_mesh()), tmp_path / "x.glb")
    scene = trimesh.load_scene(tmp_path / "x.glb")
    assert scene.units == "meters"
    assert np.allclose(scene.bounds, [[0, 0, -2], [1, 3, 0]])


def test_objects_keep_their_names(tmp_path: Path) -> None:
    vertices, faces = cube()
    both = np.concatenate([vertices, vertices + 5]), np.concatenate([faces, faces + 8])
    write(RawMesh(*both, objects=(("lid", 12), ("körper", 12))), tmp_path / "x.glb")
    raw = read(tmp_path / "x.glb")
    assert raw.objects == (("lid", 12), ("körper", 12))
    assert b.Solid(raw.vertices, raw.faces).volume_exact == 2


def test_nodes_move_and_mirror(tmp_path: Path) -> None:
    def move(tree: dict[str, Any]) -> None:
        matrix = [-0.001, 0, 0, 0, 0, 0, -0.001, 0, 0, 0.001, 0, 0, 1, 0, 0, 1]
        tree["nodes"].append({"mesh": 0, "matrix": matrix})
        tree["scenes"][0]["nodes"].append(1)

    path = tmp_path / "x.glb"
    path.write_bytes(edited(path, move))
    raw = read(path)
    assert b.Solid(raw.vertices, raw.faces).volume_exact == 16
    assert raw.vertices.max(axis=0).tolist() == [1000, 2, 2]


def test_an_empty_mesh(tmp_path: Path) -> None:
    write(RawMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64)), tmp_path / "x.glb")
    assert len(read(tmp_path / "x.glb").faces) == 0


def test_coordinates_beyond_single_precision(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="single-precision numbers"):
        write(RawMesh(*cube(1e39)), tmp_path / "x.glb")
    assert list(tmp_path.iterdir()) == []


def set_at(*keys: Any, value: Any) -> Edit:
    def edit(tree: dict[str, Any]) -> None:
        for key in keys[:-1]:
            tree = tree[key]
        tree[keys[-1]] = value

    return edit


REFUSED: dict[str, tuple[Edit, str]] = {
    "count": (set_at("accessors", 0, "count", value=10**12), "truncated"),
    "negative count": (set_at("accessors", 0, "count", value=-3), "truncated"),
    "view": (set_at("bufferViews", 0, "byteLength", value=10**9), "truncated"),
    "view number": (set_at("accessors", 1, "bufferView", value=7), "index_out_of_range"),
    "no view": (lambda tree: tree["accessors"][1].pop("bufferView"), "unsupported"),
    "kind": (set_at("accessors", 1, "componentType", value=1), "syntax"),
    "words": (set_at("accessors", 1, "count", value="many"), "syntax"),
    "uri": (set_at("buffers", 0, "uri", value="http://example.com/x.bin"), "unsupported"),
    "draco": (
        set_at("extensionsRequired", value=["KHR_draco_mesh_compression"]),
        "unsupported",
    ),
    "loop": (set_at("nodes", 0, "children", value=[0]), "too_large"),
    "two parents": (
        set_at("nodes", value=[{"children": [2]}, {"children": [2]}, {"mesh": 0}]),
        "too_large",
    ),
    "deep": (
        set_at("nodes", value=[*({"children": [k + 1]} for k in range(99)), {"mesh": 0}]),
        "too_large",
    ),
    "meshes": (set_at("meshes", value=7), "syntax"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_descriptions(tmp_path: Path, name: str) -> None:
    edit, code = REFUSED[name]
    path = tmp_path / "x.glb"
    refusal(path, edited(path, edit), code)


@pytest.mark.parametrize("size", [1, 4, 11, 12, 19, 30, 200, -1, -100])
def test_truncations(tmp_path: Path, size: int) -> None:
    path = tmp_path / "x.glb"
    data = cube_file(path)[:size]
    path.write_bytes(data)
    with pytest.raises(FormatError):
        read(path)


def test_deep_json(tmp_path: Path) -> None:
    text = b"[" * 100_000
    head = b"glTF" + (2).to_bytes(4, "little") + (20 + len(text)).to_bytes(4, "little")
    refusal(tmp_path / "x.glb", head + len(text).to_bytes(4, "little") + b"JSON" + text, "syntax")


def test_version_1(tmp_path: Path) -> None:
    data = cube_file(tmp_path / "x.glb")
    said = refusal(tmp_path / "x.glb", data[:4] + b"\1\0\0\0" + data[8:], "syntax")
    assert "version 1" in said


@pytest.mark.parametrize(
    ("value", "code"), [(float("nan"), "non_finite"), (99, "index_out_of_range")]
)
def test_bad_numbers(tmp_path: Path, value: float, code: str) -> None:
    path = tmp_path / "x.glb"
    tree, rest = opened(cube_file(path))
    accessor = tree["accessors"][0 if code == "non_finite" else 1]
    start = 8 + tree["bufferViews"][accessor["bufferView"]]["byteOffset"]
    kind = np.float32 if code == "non_finite" else np.uint32
    rest = rest[:start] + kind(value).tobytes() + rest[start + 4 :]
    path.write_bytes(closed(tree, rest))
    with pytest.raises(FormatError) as caught:
        read(path)
    assert caught.value.code == code


def test_what_moves_is_dropped_by_name(tmp_path: Path) -> None:
    path = tmp_path / "x.glb"
    path.write_bytes(edited(path, set_at("animations", value=[{"channels": []}])))
    assert read(path).dropped == ("animations",)


def test_one_mesh_at_many_nodes(tmp_path: Path) -> None:
    """Instances inside each other, by matrices and by turns, a mirrored one among them."""

    def place(tree: dict[str, Any]) -> None:
        tree["nodes"] += [
            {"mesh": 0, "translation": [1, 0, 0], "children": [2, 3]},
            {"mesh": 0, "rotation": [0, 0.5**0.5, 0, 0.5**0.5], "translation": [0, 1, 0]},
            {"mesh": 0, "scale": [1, -1, 1]},
        ]
        tree["scenes"][0]["nodes"].append(1)

    path = tmp_path / "x.glb"
    path.write_bytes(edited(path, place))
    raw = read(path)
    assert [name for name, _ in raw.objects] == ["cube"] * 4
    theirs = trimesh.load_scene(path).to_mesh()
    x, y, z = theirs.triangles.reshape(-1, 3).T * 1000
    found = np.array(sorted(raw.vertices[raw.faces].reshape(-1, 3).round(6).tolist()))
    assert np.allclose(found, sorted(np.stack([x, -z, y], axis=1).round(6).tolist()))
    assert b.Solid(raw.vertices, raw.faces).to_mesh().volume == pytest.approx(theirs.volume * 1e9)


def test_nodes_outside_the_scene_are_told(tmp_path: Path) -> None:
    path = tmp_path / "x.glb"
    path.write_bytes(edited(path, lambda tree: tree["nodes"].append({"mesh": 0})))
    raw = read(path)
    assert len(raw.faces) == 12
    assert raw.passed_by == ("1 meshes that are not part of the scene were ignored.",)


def test_a_file_without_scenes_shows_every_node(tmp_path: Path) -> None:
    def strip(tree: dict[str, Any]) -> None:
        del tree["scenes"], tree["scene"]
        tree["nodes"][0]["children"] = [1]
        tree["nodes"].append({"mesh": 0, "translation": [0, 0, 9]})

    path = tmp_path / "x.glb"
    path.write_bytes(edited(path, strip))
    assert len(read(path).faces) == 24


def test_a_node_named_twice(tmp_path: Path) -> None:
    path = tmp_path / "x.glb"
    refusal(path, edited(path, set_at("scenes", 0, "nodes", value=[0, 0])), "index_out_of_range")


def test_strips_and_short_indices(tmp_path: Path) -> None:
    """A tetrahedron as one strip, and the cube with indices of two bytes."""
    path = tmp_path / "x.glb"
    corners = np.array([(0, 0, 0), (0, 1, 0), (1, 0, 0), (0, 0, 1)])
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    write(RawMesh(corners * 1.0, faces), path)
    tree, rest = opened(path.read_bytes())
    strip = np.array([0, 1, 2, 3, 0, 1], dtype="<u2").tobytes()
    start = 8 + tree["bufferViews"][1]["byteOffset"]
    rest = rest[:start] + strip + rest[start + len(strip) :]
    tree["accessors"][1] |= {"componentType": 5123, "count": 6}
    tree["meshes"][0]["primitives"][0]["mode"] = 5
    path.write_bytes(closed(tree, rest))
    raw = read(path)
    assert b.Solid(raw.vertices, raw.faces).volume == pytest.approx(1 / 6)


def test_fans(tmp_path: Path) -> None:
    """A tetrahedron as two fans of the same vertices: its floor, and all sides around the apex."""
    path = tmp_path / "x.glb"
    corners = np.array([(0, 0, 0), (0, 1, 0), (1, 0, 0), (0, 0, 1)])
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    write(RawMesh(corners * 1.0, faces), path)
    tree, rest = opened(path.read_bytes())
    fans = np.array([0, 1, 2, 3, 0, 2, 1, 0], dtype="<u2").tobytes()
    start = 8 + tree["bufferViews"][1]["byteOffset"]
    rest = rest[:start] + fans + rest[start + len(fans) :]
    indices = tree["accessors"][1] | {"componentType": 5123}
    tree["accessors"][1:] = [indices | {"count": 3}, indices | {"count": 5, "byteOffset": 6}]
    (floor,) = tree["meshes"][0]["primitives"]
    floor["mode"] = 6
    tree["meshes"][0]["primitives"] = [floor, floor | {"indices": 2}]
    path.write_bytes(closed(tree, rest))
    raw = read(path)
    assert b.Solid(raw.vertices, raw.faces).volume == pytest.approx(1 / 6)


@pytest.mark.parametrize("mode", [5, 6])
def test_strips_and_fans_of_two_vertices_have_no_triangle(tmp_path: Path, mode: int) -> None:
    path = tmp_path / "x.glb"
    write(RawMesh(*cube()), path)
    tree, rest = opened(path.read_bytes())
    tree["accessors"].append(tree["accessors"][1] | {"count": 2})
    (primitive,) = tree["meshes"][0]["primitives"]
    tree["meshes"][0]["primitives"].append(primitive | {"indices": 2, "mode": mode})
    path.write_bytes(closed(tree, rest))
    assert len(read(path).faces) == 12


# Found: the refusal of packed data did not say how to unpack it, which the manual does.
@pytest.mark.parametrize("name", ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "X_y"])
def test_packed_data_are_refused_with_the_way_out(tmp_path: Path, name: str) -> None:
    def required(tree: dict[str, Any]) -> None:
        tree["extensionsUsed"] = tree["extensionsRequired"] = [name]

    def used(tree: dict[str, Any]) -> None:
        tree["extensionsUsed"] = [name]
        del tree["accessors"][1]["bufferView"]

    path = tmp_path / "x.glb"
    for edit in (required, used):
        message = refusal(path, edited(path, edit), "unsupported")
        assert message.endswith(
            "“gltf-transform copy in.glb out.glb” removes the compression."
        ) == (name != "X_y")


# Found: one primitive without positions made the whole file "not valid".
@pytest.mark.parametrize(
    "bare",
    [
        {"attributes": {}},
        {"attributes": {"NORMAL": 0}},
        {"attributes": {"NORMAL": 0}, "indices": 1},
        {"attributes": {}, "mode": 0},
        {"attributes": {}, "indices": 99, "material": 9},
        {"attributes": {"COLOR_0": 0}, "extensions": {"KHR_draco_mesh_compression": {}}},
    ],
)
@pytest.mark.parametrize("at", [0, 1])
def test_primitives_without_positions_are_told(
    tmp_path: Path, bare: dict[str, Any], at: int
) -> None:
    def edit(tree: dict[str, Any]) -> None:
        tree["meshes"][0]["primitives"].insert(at, bare)

    path = tmp_path / "x.glb"
    raw = read_text(path, edited(path, edit))
    assert len(raw.faces) == 12
    assert raw.passed_by == ("1 primitives without vertex positions were ignored.",)


# Found: GLB lost objects that share a name.
def test_names_are_kept_as_they_are(tmp_path: Path) -> None:
    names = ("lid", "lid", "", "lid_1", "unnamed 1", 'a\nb\0"')
    bodies = [moved(cube(), (3 * number, 0, 0)) for number in range(len(names))]
    objects = tuple((name, 12) for name in names)
    write(RawMesh(*joined(*bodies), objects=objects), tmp_path / "x.glb")
    assert read(tmp_path / "x.glb").objects == objects
    assert len(trimesh.load_scene(tmp_path / "x.glb").geometry) == len(names)
    assert trimesh.load_scene(tmp_path / "x.glb").to_mesh().volume == pytest.approx(6e-9)
