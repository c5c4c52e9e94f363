"""Models packed for the viewer of a page, unpacked here as `unpacking.js` does."""

import base64
import gzip
from typing import Any

import numpy as np
import pytest

from bspcsg.report.viewer.layer import Layer, bounds_of
from bspcsg.report.viewer.packing import compressed, packed
from support.shapes import Arrays, cube, cuboid, icosphere, moved


def unpacked(model: dict[str, Any]) -> list[Arrays]:
    """Return the layers of a packed model as meshes, with the centre of its box at the origin."""
    data = np.frombuffer(gzip.decompress(base64.b64decode(model["data"])), dtype=np.uint8)
    found, at = [], 0
    for layer in model["layers"]:
        count, size = 3 * layer["vertices"], 2 if model["quantised"] else 4
        planes = data[at : at + count * size].reshape(size, count).T.copy()
        at += count * size
        if model["quantised"]:
            steps = np.cumsum(planes.view("<u2").reshape(3, -1).astype(np.int64), axis=1) & 0xFFFF
            placed = (steps - 32767.5) * np.array(model["step"])[:, None]
        else:
            placed = planes.view("<f4").reshape(3, -1).astype(np.float64)
        count = 3 * layer["triangles"]
        zigzag = data[at : at + 4 * count].reshape(4, count).T.copy().view("<u4").ravel()
        at += 4 * count
        steps = (zigzag >> 1).astype(np.int64) ^ -(zigzag & 1).astype(np.int64)
        found.append((placed.T * model["longest"] / 2, np.cumsum(steps).reshape(-1, 3)))
    assert at == len(data)
    return found


@pytest.mark.parametrize("quantised", [True, False])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_layers_come_back(quantised: bool, offset: float) -> None:
    meshes = [moved(icosphere(2), (offset, 0, 0)), moved(cube(3), (offset, -1, 2))]
    layers = [Layer(str(k), *mesh) for k, mesh in enumerate(meshes)]
    model = packed(layers, quantised=quantised)
    low, high = bounds_of(layers)
    middle = low + (high - low) / 2
    step = (high - low).max() * (1 / 65535 if quantised else 2**-23)
    for layer, (vertices, faces) in zip(layers, unpacked(model), strict=True):
        assert (faces == layer.faces).all()
        assert np.abs(vertices + middle - layer.vertices).max() <= 0.51 * step
    assert model["low"] == low.tolist() and model["high"] == high.tolist()


def test_layers_that_touch_still_do() -> None:
    layers = [Layer("a", *cuboid((0, 0, 0), (1, 1, 1))), Layer("b", *cuboid((1, 0, 0), (3, 1, 1)))]
    (first, _), (second, _) = unpacked(packed(layers, quantised=True))
    assert first[:, 0].max() == second[:, 0].min()


def test_flat_and_empty_models() -> None:
    flat = Layer("flat", np.array([[0.0, 0, 7], [1, 0, 7], [0, 1, 7]]), np.array([[0, 1, 2]]))
    ((vertices, _),) = unpacked(packed([flat], quantised=True))
    assert (vertices[:, 2] == vertices[0, 2]).all()
    none = Layer("none", np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    model = packed([none], quantised=False)
    assert model["layers"][0]["triangles"] == 0
    assert len(unpacked(packed([none, flat], quantised=True))) == 2


def test_the_same_model_has_the_same_bytes() -> None:
    layers = [Layer("ball", *icosphere(3))]
    models = [packed(layers, quantised=True) for _ in range(2)]
    assert models[0] == models[1]
    plain = layers[0].vertices.astype("<f4").tobytes() + layers[0].faces.tobytes()
    assert len(models[0]["data"]) < 0.85 * len(compressed(plain))


def test_closed_is_what_a_section_can_fill() -> None:
    vertices, faces = cube()
    assert Layer("closed", vertices, faces).is_closed
    assert not Layer("open", vertices, faces[1:]).is_closed
    assert not Layer("turned", vertices, np.vstack([faces[1:], faces[:1, ::-1]])).is_closed


def test_simplified_keeps_the_shape_with_fewer_triangles() -> None:
    layer = Layer("ball", *icosphere(5))
    simple = layer.simplified(20)
    assert len(simple.faces) < len(layer.faces) / 4 and simple.is_closed
    for found, given in zip(bounds_of([simple]), bounds_of([layer]), strict=True):
        assert np.abs(found - given).max() < 2 / 20
    assert simple.name == "ball"
