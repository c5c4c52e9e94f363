"""Standard parts have the sizes of their standards, are closed, and fit their counterparts."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg import parts
from support.refusals import Row, assert_refused_at_once, missing_parameters

#: Size, coarse pitch (ISO 261), pitch and minor diameter (ISO 724), root diameter (ISO 68-1 with
#: the round root of H/6), height of head and width across flats (ISO 4014), height of nut
#: (ISO 4032), length of thread up to 125 mm (ISO 4014), least allowance of 6g in µm (ISO 965-1).
TABLE = """
M3    0.5   2.675  2.459  2.387   2.0  5.5   2.4  12  20
M3.5  0.6   3.110  2.850  2.764   2.4  6     2.8  13  21
M4    0.7   3.545  3.242  3.141   2.8  7     3.2  14  22
M5    0.8   4.480  4.134  4.019   3.5  8     4.7  16  24
M6    1     5.350  4.917  4.773   4.0  10    5.2  18  26
M8    1.25  7.188  6.647  6.466   5.3  13    6.8  22  28
M10   1.5   9.026  8.376  8.160   6.4  16    8.4  26  32
M12   1.75  10.863 10.106 9.853   7.5  18   10.8  30  34
M14   2     12.701 11.835 11.546  8.8  21   12.8  34  38
M16   2     14.701 13.835 13.546 10.0  24   14.8  38  38
M18   2.5   16.376 15.294 14.933 11.5  27   15.8  42  42
M20   2.5   18.376 17.294 16.933 12.5  30   18.0  46  42
"""
ROWS = {name: [float(x) for x in rest] for name, *rest in map(str.split, TABLE.split("\n")[1:-1])}
SIZES = sorted(ROWS, key=lambda name: float(name[1:]))


def box_of(part: b.Solid) -> np.ndarray[Any, Any]:
    """Return the minimum and the maximum corner of a part."""
    assert part.bounds is not None
    return part.bounds


def is_sound(part: b.Solid, genus: int = 0) -> bool:
    """Return true if a part is one closed body of this genus, without findings."""
    mesh = part.to_mesh()
    whole = part.surface_count == 1 and part.genus == genus
    return whole and mesh.certificate.ok and not part.findings and part.volume > 0


def across(part: b.Solid, z: float) -> float:
    """Return the greatest distance of a section's outline from the axis."""
    return max(float(np.hypot(*loop.T).max()) for loop in part.slice(z).to_polygons())


# Threads, bolts and nuts


def test_sizes_are_those_of_the_standards() -> None:
    assert list(parts.METRIC) == SIZES
    for name, row in ROWS.items():
        size = parts.metric(name.lower())
        found = [
            size.pitch,
            size.pitch_diameter,
            size.minor_diameter,
            size.root_diameter,
            size.head,
        ]
        found += [size.flats, size.nut, size.threaded(120), size.allowance * 1000]
        assert np.allclose(found, row, atol=5.1e-4) and size.diameter == float(name[1:])
    assert [parts.metric("M10").threaded(long) for long in (20, 125, 150, 300)] == [20, 26, 32, 45]


@pytest.mark.parametrize("name", SIZES)
def test_threads_have_the_profile_of_the_standard(name: str) -> None:
    size = parts.METRIC[name]
    rod = parts.threaded_rod(name, 6 * size.pitch)
    assert is_sound(rod)
    assert np.hypot(*rod.vertices[:, :2].T).max() == pytest.approx(
        (size.diameter - size.allowance) / 2, abs=1e-6
    )
    wall = b.cube(60, center=True) - parts.tap(name, 60).translate(0, 0, -30)
    assert is_sound(wall, 1)
    # Both ends may cut through the middle of a facet.
    inner = np.hypot(*wall.vertices[:, :2].T).min() / (size.minor_diameter / 2)
    assert math.cos(math.pi / 32) < inner < 1 + 1e-6
    # In a plane through the axis, where facets have their corners: crests are an eighth of the
    # pitch wide, roots a sixth, and flanks stand at 30 degrees.
    side = parts.threaded_rod(name, 9 * size.pitch, clearance=0).slice(0, (0, 1, 0))
    widths = []
    for x in (size.diameter / 2 - 1e-6, size.pitch_diameter / 2, size.root_diameter / 2 + 1e-6):
        column = b.Region.rectangle(size.pitch, 1e-6).translate(4.25 * size.pitch, x - 5e-7)
        widths.append((side & column).area / 1e-6 / size.pitch)
    assert np.allclose(widths, [1 / 8, 1 / 2, 5 / 6], atol=1e-3)


@pytest.mark.parametrize("name", SIZES)
def test_bolts_and_nuts_have_their_sizes_and_fit(name: str) -> None:
    size = parts.METRIC[name]
    bolt, nut = parts.hex_bolt(name, 60), parts.hex_nut(name)
    assert is_sound(bolt) and is_sound(nut, 1)
    for part, low, high in ((bolt, -size.head, 60.0), (nut, 0.0, size.nut)):
        assert box_of(part)[:, 2].tolist() == [low, high]
        assert box_of(part)[:, 1] == pytest.approx([-size.flats / 2, size.flats / 2])
        assert box_of(part)[1, 0] == pytest.approx(size.flats / math.sqrt(3))
    plain = (size.diameter - size.allowance) / 2
    assert bolt.slice(60 - size.threaded(60) - 0.01).area == pytest.approx(
        16 * math.sin(math.tau / 32) * plain**2
    )
    assert across(bolt, 59.99) < size.root_diameter / 2 + 0.02
    # Anywhere on the thread, turned with the pitch.
    for turn in (0, 90, 225):
        height = 60 - size.nut - 2 * size.pitch
        height += -height % size.pitch + size.pitch * turn / 360
        placed = nut.rotate(turn).translate(0, 0, height - size.pitch)
        assert bolt.isdisjoint(placed)
        # The allowance of the diameter is a quarter of that across the flanks.
        assert bolt.min_gap(placed) == pytest.approx(size.allowance / 4, rel=0.2)
    # Off by half a pitch, ridges meet ridges.
    assert not bolt.isdisjoint(nut.translate(0, 0, (40 // size.pitch + 0.5) * size.pitch))


def test_clearance_is_what_printers_ask_for() -> None:
    bolt, nut = parts.hex_bolt("M8", 30, clearance=0.3), parts.hex_nut("M8", clearance=0.3)
    assert bolt.min_gap(nut.translate(0, 0, 12.5)) == pytest.approx(0.6 / 4, rel=0.05)


def test_bolts_are_threaded_as_far_as_asked() -> None:
    for thread, length in ((0, 20), (20, 20), (5, 20), (None, 10), (3, 3), (19.9, 20)):
        bolt = parts.hex_bolt("M6", length, thread=thread)
        assert is_sound(bolt) and box_of(bolt)[1, 2] == length
    assert parts.hex_bolt("M6", 20, thread=0) < parts.hex_bolt("M6", 20, thread=0, clearance=0)
    assert is_sound(parts.threaded_rod("M20", 0.5)) and is_sound(parts.tap("M3", 0.1))


# Gears


@pytest.mark.parametrize("angle", [14.5, 20, 25])
@pytest.mark.parametrize("teeth", [6, 11, 17, 18, 24, 40])
def test_gears_have_the_sizes_of_iso_53(teeth: int, angle: float) -> None:
    gear = parts.spur_gear(2, teeth, 5, pressure_angle=angle, backlash=0.1)
    assert is_sound(gear)
    radii = np.hypot(*gear.vertices[:, :2].T)
    # Tips a module above the reference circle, feet 1.25 below.
    assert radii.max() == pytest.approx(teeth + 2) and radii.min() == pytest.approx(teeth - 2.5)
    # On the reference circle a tooth is as wide as a space, but for the backlash.
    circle = b.Region.circle(teeth + 1e-3, 720 * teeth) - b.Region.circle(teeth - 1e-3, 720 * teeth)
    share = (gear.slice(2) & circle).area / circle.area
    wide = math.pi * 2 / 2 - 0.1
    # But for teeth that are undercut beyond it.
    if teeth * math.sin(math.radians(angle)) ** 2 > 1:
        assert share == pytest.approx(wide / math.tau, abs=6e-3)
    else:
        assert share < wide / math.tau


def test_flanks_are_involutes() -> None:
    """Lines that are square to an involute touch its base circle."""
    gear = parts.spur_gear(1, 30, 1, segments=128).slice(0.5)
    (points,) = gear.to_polygons()
    base = 15 * math.cos(math.radians(20))
    middle, along = (points + np.roll(points, -1, axis=0)) / 2, np.roll(points, -1, axis=0) - points
    radii = np.hypot(*middle.T)
    flank = (radii > 14.2) & (radii < 15.9)
    arms = np.abs((middle * along).sum(axis=1)) / np.hypot(*along.T)
    assert flank.sum() > 1000 and np.allclose(arms[flank], base, atol=2e-3)


@pytest.mark.parametrize(("one", "other"), [(6, 6), (6, 40), (8, 25), (17, 18), (24, 24), (30, 61)])
def test_gears_mesh_without_a_clash(one: int, other: int) -> None:
    pinion, wheel = parts.spur_gear(2, one, 3), parts.spur_gear(2, other, 3)
    wheel = wheel.rotate(0 if other % 2 else 180 / other)
    gaps = []
    for step in range(5):
        turn = 360 / one * step / 5
        placed = wheel.rotate(-turn * one / other).translate(one + other, 0, 0)
        turned = pinion.rotate(turn)
        assert (turned & placed).volume < 1e-7
        gaps.append(turned.min_gap(placed))
    # They touch, so that one turns the other; with six teeth only some of the time.
    assert min(gaps) < 0.02 and (one == 6 or max(gaps) < 0.02)


def test_gears_have_play_and_bores() -> None:
    gear = parts.spur_gear(2, 20, 3, backlash=0.2, bore=10)
    assert is_sound(gear, 1)
    mate = gear.rotate(180 / 20)
    # Both gears together have twice the backlash, half of it on either side.
    for share, free in ((0.9, True), (1.1, False)):
        turned = mate.rotate(math.degrees(0.2 * share / 20)).translate(40, 0, 0)
        assert ((gear & turned).volume < 1e-7) == free


# Snap fits


@pytest.mark.parametrize("retention", [45, 70, 90])
@pytest.mark.parametrize("entrance", [20, 30, 45])
def test_hooks_sit_in_their_sockets_and_are_held(entrance: float, retention: float) -> None:
    sizes: dict[str, Any] = {"entrance": entrance, "retention": retention}
    hook = parts.snap_hook(12, 6, 2, 1, **sizes)
    socket = parts.snap_socket(12, 6, 2, 1, clearance=0.2, **sizes)
    wall = b.box(12, 14, 30).translate(-5, -7, 0) - socket
    assert is_sound(hook) and is_sound(wall)
    assert box_of(hook)[:, :2].tolist() == [[0, -3], [3, 3]]
    assert wall.min_gap(hook) == pytest.approx(0.2)
    # Pulled, it catches; bent by its undercut, it comes out.
    assert not wall.isdisjoint(hook.translate(0, 0, -0.5))
    assert all(wall.isdisjoint(hook.translate(-1, 0, -z)) for z in range(0, 30, 2))


def test_strain_of_a_hook_is_that_of_a_bent_beam() -> None:
    # Bayer's design guide: the undercut that a strain allows is 0.67 times strain * l² / h.
    strain = parts.snap_strain(19, 3.5, 0.67 * 0.02 * 19**2 / 3.5)
    assert strain == pytest.approx(0.02, rel=0.01)


# Refusals


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: parts.metric("M7"), "Unknown metric size 'M7'; known are M3, M3.5,"),
        (
            lambda: parts.hex_bolt("M6", 10, thread=11),
            "thread, the length of the threaded part, must be at most",
        ),
        (
            lambda: parts.threaded_rod("M3", 10, clearance=2),
            "clearance must be smaller than the pitch",
        ),
        (lambda: parts.threaded_rod("M3", 10, segments=7), "at least 8"),
        (lambda: parts.spur_gear(1, 5, 3), "teeth must be an integer of at least 6"),
        (lambda: parts.spur_gear(1, 12, 3, bore=9.5), "bore must be below 9.5"),
        (lambda: parts.spur_gear(1, 12, 3, backlash=1.6), "larger than the thickness of the teeth"),
        (lambda: parts.spur_gear(1, 12, 3, pressure_angle=30), "from 14 to 25"),
        (lambda: parts.hex_nut("M6", clearance=1), "clearance must be smaller than the pitch"),
        (lambda: parts.spur_gear(1, 6, 3, pressure_angle=25, backlash=0.7), "pointed"),
        (lambda: parts.snap_hook(12, 6, 20, 1), "thickness and undercut must be"),
        (lambda: parts.snap_socket(12, 6, 2, 1, clearance=12), "smaller than the length"),
        (lambda: parts.snap_hook(12, 6, 2, 1, entrance=5), "from 10 to 60"),
        (lambda: parts.snap_socket(12, 6, 2, 1, retention=20), "from 30 to 90"),
    ],
)
def test_parts_refuse_what_makes_no_sense(call: Callable[[], Any], word: str) -> None:
    with pytest.raises(b.InvalidParameterError, match=word):
        call()


HOOK: dict[str, Any] = {"length": 12, "width": 6, "thickness": 2, "undercut": 1}
SLOPES: dict[str, Any] = {"entrance": 30, "retention": 80}
TOOTHED: dict[str, Any] = {"module": 1, "teeth": 8, "width": 3, "pressure_angle": 20}
ASKED: dict[str, Row] = {
    "metric": (parts.metric, {"size": "M3"}),
    "threaded_rod": (
        parts.threaded_rod,
        {"size": "M3", "length": 3, "clearance": 0.1, "segments": 8},
    ),
    "tap": (parts.tap, {"size": "M3", "length": 3, "clearance": 0.1, "segments": 8}),
    "hex_bolt": (
        parts.hex_bolt,
        {"size": "M3", "length": 3, "thread": 2, "clearance": 0.1, "segments": 8},
    ),
    "hex_nut": (parts.hex_nut, {"size": "M3", "clearance": 0.1, "segments": 8}),
    "spur_gear": (parts.spur_gear, {**TOOTHED, "backlash": 0.1, "bore": 1, "segments": 8}),
    "snap_hook": (parts.snap_hook, {**HOOK, **SLOPES}),
    "snap_socket": (parts.snap_socket, {**HOOK, **SLOPES, "clearance": 0.1}),
    "snap_strain": (parts.snap_strain, {"length": 12, "thickness": 2, "undercut": 1}),
}


@pytest.mark.parametrize("name", ASKED)
def test_parts_refuse_bad_values(name: str) -> None:
    assert_refused_at_once(name, ASKED[name], {})


def test_no_part_is_missing() -> None:
    assert {name for name in parts.__all__ if name.islower()} == set(ASKED)
    assert not missing_parameters(ASKED, parts, set())
