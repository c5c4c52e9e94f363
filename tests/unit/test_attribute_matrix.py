"""Every kind of attribute in every format, written and read back: equal, or reported as lost."""

import io
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import bspcsg as b
from bspcsg.attributes.colours import are_equal_in_bytes, is_color

RNG = np.random.default_rng(4)
VERTICES, FACES = b.cube(1).to_mesh()

ROWS: dict[str, tuple[int, ...]] = {"vertex": (8,), "corner": (12, 3), "face": (12,)}


def picture() -> bytes:
    stream = io.BytesIO()
    Image.new("RGB", (2, 2), "teal").save(stream, "PNG")
    return stream.getvalue()


MATERIALS = {"wood": b.Material("peru"), "glass": b.Material("#aaccff80")}
PICTURED = {"bark": b.Material("white", picture())}

#: What an attribute may hold, by the shape of its rows.
VALUES: dict[str, Callable[[tuple[int, ...]], Any]] = {
    "bytes": lambda rows: RNG.integers(0, 256, (*rows, 3)).astype(np.uint8),
    "see-through bytes": lambda rows: RNG.integers(0, 256, (*rows, 4)).astype(np.uint8),
    "opaque bytes": lambda rows: np.full((*rows, 4), (9, 8, 7, 255), np.uint8),
    "words": lambda rows: RNG.integers(0, 65536, (*rows, 3)).astype(np.uint16),
    "floats": lambda rows: RNG.random((*rows, 3)),
    "single floats": lambda rows: RNG.random((*rows, 4)).astype(np.float32),
    "whole numbers": lambda rows: RNG.integers(0, 256, (*rows, 3)),
    "names": lambda rows: RNG.choice(["red", "gold", "#12345678"], rows),
    "one name": lambda _: "orange",
}
COLORS = {
    f"{how} of {kind}": {f"{kind}_attributes": {"color": make(rows)}}
    for how, make in VALUES.items()
    for kind, rows in ROWS.items()
}
NUMBERS: dict[str, dict[str, Any]] = {
    f"{name} of {kind}": {f"{kind}_attributes": {name: values}}
    for kind, rows in ROWS.items()
    for name, values in {
        "weight": RNG.random(rows),
        "pair": RNG.random((*rows, 2)),
        "tensor": RNG.random((*rows, 2, 2)),
        "id": RNG.integers(-5, 2**31 - 1, rows),
        "huge": RNG.integers(2**40, 2**50, rows),
        "flag": RNG.random(rows) < 0.5,
        "who": RNG.choice(["me", "you"], rows),
        "uv": RNG.random((*rows, 2)),
        "normal": RNG.random((*rows, 3)),
        "normals": RNG.random((*rows, 3)).astype(np.float32),
        "gap": np.where(np.arange(np.prod(rows)).reshape(rows) % 3, 1.5, np.nan),
    }.items()
}
WOOD = RNG.choice(["wood", "glass"], 12)
LOOKS: dict[str, dict[str, Any]] = {
    "materials": {"face_attributes": {"material": WOOD}, "materials": MATERIALS},
    "materials and colours": {
        "face_attributes": {"material": WOOD, "color": "red"},
        "materials": MATERIALS,
    },
    "a picture": {
        "vertex_attributes": {"uv": RNG.random((8, 2))},
        "face_attributes": {"material": ["bark"] * 12},
        "materials": PICTURED,
    },
    "a picture with seams": {
        "corner_attributes": {"uv": RNG.random((12, 3, 2))},
        "face_attributes": {"material": ["bark"] * 12},
        "materials": PICTURED,
    },
    "a name without its material": {"face_attributes": {"material": ["what"] * 12}},
}

WAYS = ["x.stl", "x.obj", "x.ply", "text.ply", "x.off", "x.3mf", "x.glb", "x.csg"]
WAYS += ["to_trimesh", "to_manifold"]


def there_and_back(solid: b.Solid, way: str, folder: Path) -> b.Solid:
    if way.startswith("to_"):
        return b.Solid.from_mesh(getattr(solid, way)())
    options = {"text": True} if way.startswith("text") else {}
    solid.save(folder / way, **options)
    return b.load(folder / way)


def rows(mesh: b.Mesh, name: str) -> Any:
    """Return the values at all corners of faces, in an order that depends only on coordinates."""
    corners = mesh.vertices[mesh.faces].astype(np.float32)
    keys = [(tuple(map(tuple, sorted(f.tolist()))), tuple(c)) for f in corners for c in f.tolist()]
    order = sorted(range(len(keys)), key=keys.__getitem__)
    values = mesh.attributes.at_corners(name)
    return values.reshape(len(keys), *values.shape[2:])[order]


def is_equal(before: b.Mesh, after: b.Mesh, name: str) -> bool:
    if after.attributes.kind_of(name) is None:
        return False
    one, other = rows(before, name), rows(after, name)
    if is_color(name, one, 1) and is_color(name, other, 1):
        return are_equal_in_bytes(one, other)
    if one.shape != other.shape or (one.dtype.kind == "U") != (other.dtype.kind == "U"):
        return False
    if one.dtype.kind == "U":
        pictures = {key: found.texture for key, found in after.materials.items()}
        kept = all(pictures.get(k) == m.texture for k, m in before.materials.items())
        return bool(np.array_equal(one, other)) and (name != "material" or kept)
    return bool(np.allclose(one.astype(float), other.astype(float), atol=1e-6, equal_nan=True))


@pytest.mark.parametrize("way", WAYS)
def test_it_is_equal_or_told(tmp_path: Path, way: str) -> None:
    for what, options in (COLORS | NUMBERS | LOOKS).items():
        solid = b.Solid(VERTICES, FACES, **options)
        before = solid.to_mesh()
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            after = there_and_back(solid, way, tmp_path).to_mesh()
        told = " ".join(str(one.message) for one in caught)
        assert all(one.category is b.LossWarning for one in caught), (what, way)
        assert all(one.filename == __file__ for one in caught), (what, way)
        lost = {name for name in before.attributes.names if not is_equal(before, after, name)}
        named = {
            name
            for name in before.attributes.names
            if f"“{name}”" in told.replace(" beside “material”", "")
        }
        assert lost == named or (way == "to_trimesh" and not lost), (what, way, lost, told)
        assert not lost or way != "to_trimesh", (what, told)


#: Where a colour of one value for all faces, however it is written, has a place.
@pytest.mark.parametrize("way", ["x.obj", "x.ply", "x.off", "x.3mf", "x.glb", "to_trimesh"])
def test_colours_of_whole_solids_are_kept(tmp_path: Path, way: str) -> None:
    for color in ("red", "#ff8800", (255, 136, 0), (0.5, 0.25, 1.0), "#ff000080"):
        solid = b.cube(1).tagged(color=color) - b.cube(0.5).tagged(color="blue")
        after = there_and_back(solid, way, tmp_path).to_mesh()
        assert is_equal(solid.to_mesh(), after, "color"), (color, way)
