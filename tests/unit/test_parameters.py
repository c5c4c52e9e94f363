"""Parameters mean the same in all functions."""

import warnings
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import bsp
from bspcsg.parameters import at_least, not_negative, number, positive, seed_number

MESH = b.cube(2).to_mesh()
SQUARE = [[0, 0], [4, 0], [4, 4], [0, 4]]
EDGES = np.array([[[0, 0], [1, 0]], [[1, 0], [0, 1]], [[0, 1], [0, 0]]], dtype=np.float64)
ORIGIN, ALONG = [0.5, 0.25, -1.0], [0.0, 0.0, 1.0]
CASTER = bsp.RayCaster(b.cube(2))

#: Whatever takes a pitch, and returns what has one.
PITCHED: dict[str, Callable[[Any], Any]] = {
    "Solid": lambda pitch: b.Solid(*MESH, pitch=pitch),
    "Solid.from_mesh": lambda pitch: b.Solid.from_mesh(tuple(MESH), pitch=pitch),
    "Region": lambda pitch: bsp.Region(SQUARE, pitch=pitch),
    "Region.from_segments": lambda pitch: bsp.Region.from_segments(EDGES, pitch=pitch),
    "Region.polygon": lambda pitch: bsp.Region.polygon(SQUARE, pitch=pitch),
    "Region.half_plane": lambda pitch: bsp.Region.half_plane([1, 0], 1, pitch=pitch),
    "Intervals": lambda pitch: bsp.Intervals([(0, 1)], pitch=pitch),
    "ObjectTree": lambda pitch: bsp.ObjectTree([[0, 1]], pitch=pitch),
    "ObjectTree.from_mesh": lambda pitch: bsp.ObjectTree.from_mesh(tuple(MESH), pitch=pitch),
    "ObjectTree.half_space": lambda pitch: bsp.ObjectTree.half_space([1], 1, pitch=pitch),
    "ObjectTree.uniform": lambda pitch: bsp.ObjectTree.uniform(2, full=True, pitch=pitch),
    "PartitionTree": lambda pitch: bsp.PartitionTree(EDGES, pitch=pitch),
    "RayCaster": lambda pitch: bsp.RayCaster(EDGES, pitch=pitch),
    "AdaptiveTree": lambda pitch: bsp.AdaptiveTree(EDGES, pitch=pitch),
    "StaticTree": lambda pitch: bsp.StaticTree(EDGES, pitch=pitch),
}

THREADED: dict[str, Callable[[Any], Any]] = {
    "set_threads": b.set_threads,
    "first_hit": lambda threads: CASTER.first_hit(ORIGIN, ALONG, threads=threads),
    "all_hits": lambda threads: CASTER.all_hits(ORIGIN, ALONG, threads=threads),
    "intervals": lambda threads: CASTER.intervals(ORIGIN, ALONG, threads=threads),
    "occluded": lambda threads: CASTER.occluded(ORIGIN, [0, 0, 3], threads=threads),
    "occluded along": lambda threads: CASTER.occluded(ORIGIN, directions=ALONG, threads=threads),
}

SEEDED: dict[str, Callable[[Any], Any]] = {
    "ObjectTree": lambda seed: bsp.ObjectTree(EDGES, seed=seed),
    "PartitionTree": lambda seed: bsp.PartitionTree(EDGES, seed=seed),
    "StaticTree": lambda seed: bsp.StaticTree(EDGES, seed=seed),
}

TREE = bsp.PartitionTree(EDGES)
WITH_MARGIN: dict[str, Callable[[Any], Any]] = {
    "PartitionTree": lambda margin: bsp.PartitionTree(EDGES, margin=margin).margin,
    "region": lambda margin: TREE.region(margin=margin),
    "cost": lambda margin: TREE.cost(margin=margin),
}

WINDING: dict[str, Callable[[Any], Any]] = {
    "Solid": lambda winding: b.Solid(*MESH, winding=winding),
    "Region": lambda winding: bsp.Region(SQUARE, winding=winding),
    "Region.from_segments": lambda winding: bsp.Region.from_segments(EDGES, winding=winding),
    "ObjectTree": lambda winding: bsp.ObjectTree(EDGES, winding=winding),
    "intervals": lambda winding: CASTER.intervals(ORIGIN, ALONG, winding=winding),
    "intervals on the line": lambda winding: bsp.RayCaster([0.0, 1.0]).intervals(
        [0.0], [1.0], winding=winding
    ),
}


def refusal(call: Callable[[], object]) -> b.BspcsgError:
    with pytest.raises(b.BspcsgError) as caught:
        call()
    return caught.value


def test_parameters_have_an_error_of_their_own() -> None:
    error = refusal(lambda: b.cube(-1))
    assert type(error) is b.InvalidParameterError
    assert isinstance(error, (ValueError, b.InvalidMeshError))
    mesh = refusal(lambda: b.Solid([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    assert type(mesh) is b.InvalidMeshError

    # Found: a `pitch` or `threads` of another type ended in a raw error of Python.


@pytest.mark.parametrize("make", PITCHED.values(), ids=PITCHED)
class TestPitch:
    def test_whole_numbers_of_any_type(self, make: Callable[[Any], Any]) -> None:
        for pitch in (-6, np.int8(-6), np.int64(-6), -6.0, np.float32(-6)):
            assert make(pitch).pitch == -6, type(pitch)

    # Found: `pitch=1.5` became 1.
    # Found: every bad number was an error about a mesh.
    def test_anything_else_is_refused(self, make: Callable[[Any], Any]) -> None:
        for pitch in (1e-9, 1.5, True, np.True_, "-9", b"-9", [1], np.nan, np.inf):
            error = refusal(partial(make, pitch))
            assert error.code == "invalid_parameter", pitch
            assert "pitch" in error.message, pitch

    def test_out_of_range(self, make: Callable[[Any], Any]) -> None:
        for pitch in (-23, 23, 2**70, -(2**70)):
            error = refusal(partial(make, pitch))
            assert (type(error), error.code) == (b.LimitError, "too_large"), pitch


@pytest.mark.parametrize("call", THREADED.values(), ids=THREADED)
def test_threads(call: Callable[[Any], Any]) -> None:
    for threads in (-1, 2**70, 1025, 1.5, "2", True, None, np.nan):
        error = refusal(partial(call, threads))
        assert error.code == "invalid_parameter", threads
        assert "threads" in error.message, threads


def test_threads_of_other_types() -> None:
    for threads in (2, np.int8(2), 2.0):
        assert CASTER.first_hit(ORIGIN, ALONG, threads=threads).t.tolist() == [1]  # type: ignore[arg-type]


@pytest.mark.parametrize("call", SEEDED.values(), ids=SEEDED)
def test_seeds(call: Callable[[Any], Any]) -> None:
    for seed in (-1, 1.5, "1", True, None):
        error = refusal(lambda seed=seed: call(seed))  # type: ignore[misc]
        assert error.code == "invalid_parameter"
        assert "seed" in error.message
    call(2**70)


def test_large_seeds_keep_all_their_digits() -> None:
    assert seed_number(2**60 + 1) == 2**60 + 1
    assert seed_number(2**64 + 5) == 5


# Found: `margin=-5` became 0, and an error about NaN appeared twice.
@pytest.mark.parametrize("call", WITH_MARGIN.values(), ids=WITH_MARGIN)
def test_margins(call: Callable[[Any], Any]) -> None:
    for margin in (-5, -1e-300, np.nan, np.inf, "1", True):
        error = refusal(lambda margin=margin: call(margin))  # type: ignore[misc]
        assert error.code == "invalid_parameter"
        assert "margin" in error.message
    call(0)
    call(np.float32(2))


@pytest.mark.parametrize("call", WINDING.values(), ids=WINDING)
def test_winding_rules(call: Callable[[Any], Any]) -> None:
    for rule in ("odd", None, 1, ["positive"], np.array(["positive", "nonzero"])):
        error = refusal(lambda rule=rule: call(rule))  # type: ignore[misc]
        assert error.code == "invalid_parameter"
        assert "winding" in error.message
    call("nonzero")
    call(np.str_("even-odd"))


@pytest.mark.parametrize(
    "value", ["1", b"1", True, np.False_, None, [1, 2], 1j, np.complex64(1 + 2j), "nan"]
)
def test_what_is_no_number(value: Any) -> None:
    for check in (number, positive, not_negative, lambda v, name: at_least(0, v, name)):
        error = refusal(lambda check=check: check(value, "length"))  # type: ignore[misc]
        assert error.code == "invalid_parameter"
        assert error.message.startswith("length")


def test_messages_stay_short() -> None:
    for value in (10**400, 10**5000, "x" * 1000):
        error = refusal(lambda value=value: number(value, "length"))  # type: ignore[misc]
        assert len(error.message) < 200


def test_bounds_of_numbers() -> None:
    assert not_negative(0, "x") == 0.0
    assert refusal(lambda: positive(0, "x")).message == "x must be above 0, not 0."
    assert at_least(3, 2**80, "x") == 2**80
    assert refusal(lambda: at_least(3, 2, "x")).code == "invalid_parameter"
    assert refusal(lambda: at_least(3, 4.5, "x")).code == "invalid_parameter"


NAN = float("nan")
NOT_FINITE: dict[str, Callable[[], object]] = {
    "Solid": lambda: b.Solid([(NAN, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], MESH.faces[:4] % 4),
    "Region": lambda: bsp.Region([(0, 0), (1, 0), (NAN, 1)]),
    "Region.from_segments": lambda: bsp.Region.from_segments(EDGES * NAN),
    "ObjectTree": lambda: bsp.ObjectTree([[0, NAN]]),
    "PartitionTree": lambda: bsp.PartitionTree(EDGES * NAN),
    "RayCaster": lambda: bsp.RayCaster(EDGES * NAN),
    "classify": lambda: b.cube(1).classify([[0, NAN, 0]]),
    "first_hit": lambda: CASTER.first_hit([0, 0, NAN], ALONG),
    "direction": lambda: CASTER.first_hit(ORIGIN, [0, 0, NAN]),
    "nearest": lambda: bsp.Region(SQUARE).nearest([(NAN, 0)]),
}


@pytest.mark.parametrize("call", NOT_FINITE.values(), ids=NOT_FINITE)
def test_what_is_not_finite_is_said_once(call: Callable[[], object]) -> None:
    error = refusal(call)
    assert error.code == "non_finite"
    assert error.message.count("finite") == 1


#: Arrays of what is no number, though numpy would make doubles of it.
NO_NUMBERS: dict[str, Callable[[Any], Any]] = {
    "complex": lambda array: np.asarray(array, dtype=np.complex128) + 1j,
    "dates": lambda array: np.asarray(array).astype(int).astype("M8[s]"),
    "truth values": lambda array: np.asarray(array).astype(bool),
    "texts": lambda array: np.asarray(array).astype(str),
    "masked": lambda array: np.ma.array(array, mask=np.asarray(array) > 0),
}

#: Whatever takes coordinates.
COORDINATES: dict[str, tuple[Any, Callable[[Any], object]]] = {
    "Solid": (MESH.vertices, lambda array: b.Solid(array, MESH.faces)),
    "boolean": (
        MESH.vertices,
        lambda array: b.boolean(array, MESH.faces, MESH.vertices, MESH.faces, "union"),
    ),
    "hull": (MESH.vertices, b.hull),
    "classify": (MESH.vertices, b.cube(1).classify),
    "translate": ([1, 2, 3], b.cube(1).translate),
    "scale": ([1, 2, 3], b.cube(1).scale),
    "box": ([1, 2, 3], b.box),
    "warp": (MESH.vertices, lambda array: b.cube(2).warp(lambda _: array)),
    "level_set": (
        [(-1, -1, -1), (1, 1, 1)],
        lambda array: b.level_set(lambda p: p[:, 0], array, 0.5),
    ),
    "Region": (SQUARE, bsp.Region),
    "extrude": (SQUARE, lambda array: b.extrude(array, 1)),
    "Region.from_segments": (EDGES, bsp.Region.from_segments),
    "PartitionTree": (EDGES, bsp.PartitionTree),
    "RayCaster": (EDGES, bsp.RayCaster),
    "first_hit": (ORIGIN, lambda array: CASTER.first_hit(array, ALONG)),
    "max_t": ([3.0], lambda array: CASTER.occluded([ORIGIN], directions=[ALONG], max_t=array)),
    "nearest": (SQUARE, bsp.Region(SQUARE).nearest),
    "visibility_polygon": (
        EDGES,
        lambda array: bsp.visibility_polygon(array, (5, 5), (-9, -9), (9, 9)),
    ),
    "visible_sky": (EDGES, lambda array: bsp.visible_sky(array, (5, 5))),
}


# Found: imaginary parts, dates, truth values and entries that are masked out became coordinates
# in silence.
@pytest.mark.parametrize("name", COORDINATES)
def test_coordinates_are_numbers(name: str) -> None:
    array, call = COORDINATES[name]
    call(np.asarray(array, dtype=np.float32))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for kind, spoilt in NO_NUMBERS.items():
            assert _is_refused(call, spoilt(array)), kind


def _is_refused(call: Callable[[Any], Any], given: Any) -> bool:
    try:
        call(given)
    except b.BspcsgError:
        return True
    return False


def test_masked_faces_and_values_are_refused() -> None:
    masked = np.ma.array(MESH.faces, mask=MESH.faces > 3)
    assert isinstance(refusal(lambda: b.Solid(MESH.vertices, masked)), b.InvalidMeshError)
    layers = np.ma.array(np.arange(12), mask=np.arange(12) > 3)
    with pytest.raises(b.InvalidMeshError, match="masked"):
        b.Solid(*MESH, face_attributes={"layer": layers})
    assert b.Solid(*MESH, face_attributes={"layer": layers[:4].repeat(3)}).volume == 8
