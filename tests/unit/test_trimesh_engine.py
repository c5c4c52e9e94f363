"""This package as an engine of trimesh, through trimesh's own methods."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import trimesh

import bspcsg as b
from bspcsg import trimesh_engine


@pytest.fixture(autouse=True)
def engines(monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[Any, Any]]:
    """Replace trimesh's tables of engines by copies during the test."""
    monkeypatch.setattr(trimesh.boolean, "_engines", dict(trimesh.boolean._engines))
    monkeypatch.setattr(
        trimesh.boolean, "engines_available", set(trimesh.boolean.engines_available)
    )
    trimesh_engine.register()
    yield trimesh.boolean._engines


def box(size: Any = 2.0, at: Any = (0, 0, 0)) -> Any:
    mesh = trimesh.creation.box(np.broadcast_to(size, 3))
    mesh.apply_translation(at)
    return mesh


def opened() -> Any:
    mesh = box()
    return trimesh.Trimesh(mesh.vertices, mesh.faces[1:], process=False)


@pytest.mark.parametrize(
    ("operation", "volume"), [("union", 15.0), ("difference", 7.0), ("intersection", 1.0)]
)
def test_methods_of_trimesh(operation: str, volume: float) -> None:
    made = getattr(box(), operation)(box(at=(1, 1, 1)), engine="bspcsg")
    assert made.volume == volume and made.is_volume
    assert made.vertices.dtype == np.float64


@pytest.mark.parametrize("kind", ["face", "vertex"])
def test_results_are_coloured(kind: str) -> None:
    red, blue = box(), box((1, 1, 4))
    for mesh, color in ((red, (200, 40, 40, 255)), (blue, (40, 40, 200, 255))):
        setattr(mesh.visual, f"{kind}_colors", color)
    made = red.difference(blue, engine="bspcsg")
    assert made.visual.kind == "face" and made.is_volume
    is_cut = (np.abs(made.triangles_center[:, :2]) < 0.75).all(axis=1) & (
        np.abs(made.face_normals[:, 2]) < 0.5
    )
    assert is_cut.any() and not is_cut.all()
    assert (made.visual.face_colors[is_cut] == (40, 40, 200, 255)).all()
    assert (made.visual.face_colors[~is_cut] == (200, 40, 40, 255)).all()


def test_attributes_that_do_not_go_together_are_told() -> None:
    one, other = box(), box(at=(1, 1, 1))
    one.face_attributes["what"] = np.zeros(12)
    other.face_attributes["what"] = np.array(["x"] * 12)
    with pytest.warns(b.LossWarning, match="“what” is text in one operand"):
        assert one.union(other, engine="bspcsg").volume == 15


def test_more_than_two_meshes() -> None:
    pins = [box((1, 1, 4), (x, 0, 0)) for x in (-1, 1)]
    engine: Any = "bspcsg"  # trimesh types the names of its own engines only
    assert box(4).difference(pins, engine="bspcsg").volume == 56
    assert trimesh.boolean.union([box(4), *pins], engine=engine).volume == 64
    assert trimesh.boolean.intersection([box(4), *pins], engine=engine).is_empty


def test_double_precision_is_kept() -> None:
    far = [box(1, (1e6 + shift, 0, 0)) for shift in (0, 0.01)]
    volume = far[0].intersection(far[1], engine="bspcsg").volume
    assert volume == pytest.approx(0.99, abs=1e-9)
    # What trimesh does by itself, and why this engine is here.
    assert abs(far[0].intersection(far[1], engine="manifold").volume - 0.99) > 1e-3


def test_registering_again_changes_nothing(engines: dict[Any, Any]) -> None:
    before, names = dict(engines), set(trimesh.boolean.engines_available)
    trimesh_engine.register()
    assert engines == before and trimesh.boolean.engines_available == names
    assert engines[None] is not trimesh_engine.boolean


def test_as_the_default(engines: dict[Any, Any]) -> None:
    trimesh_engine.register(default=True)
    assert engines[None] is engines["bspcsg"] is trimesh_engine.boolean
    assert (box().difference(box(at=(1, 0, 0)))).volume == 4


def test_what_is_no_volume_is_refused_like_trimesh_does() -> None:
    with pytest.raises(ValueError, match="inside out: 1"):
        box().union(opened(), engine="bspcsg")
    with pytest.raises(b.InvalidMeshError) as caught:
        box().union(opened(), engine="bspcsg", check_volume=False)
    assert caught.value.code == "not_closed"


def test_volumes_are_not_asked_for_without_the_check() -> None:
    crossing = trimesh.util.concatenate([box(), box(at=(1, 0, 0))])
    assert box(8).difference(crossing, engine="bspcsg", check_volume=False).volume == 500
    assert box(8).difference(b.cube(1), engine="bspcsg").volume == 511


def test_options_reach_the_solids() -> None:
    made = box().union(box(1, (0.04, 0, 0)), engine="bspcsg", pitch=-1)
    assert np.array_equal(made.vertices, made.vertices.round(1))


@pytest.mark.parametrize(
    ("meshes", "operation"), [([box()], "difference"), ([box(), box()], "xor")]
)
def test_wrong_calls(meshes: list[Any], operation: str) -> None:
    with pytest.raises(ValueError, match=operation):
        trimesh_engine.boolean(meshes, operation)


def test_a_trimesh_without_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(trimesh.boolean, "_engines")
    with pytest.raises(b.MissingPartError, match="pip install") as caught:
        trimesh_engine.register()
    assert caught.value.code == "missing_part"
