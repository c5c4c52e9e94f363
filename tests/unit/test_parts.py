"""Connected components with their cavities, and the parts on both sides of a plane."""

import pickle
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from bspcsg.operations import parts as parts_module
from bspcsg.operations.parts import connected_parts, sides_of_plane
from support.checks import assert_sound
from support.shapes import cuboid, flipped, joined
from support.timing import seconds


def solid_of(part: b.Mesh) -> b.Solid:
    return b.Solid(part.vertices, part.faces)


def test_components_the_largest_first() -> None:
    whole = b.Solid(*joined(cuboid((0, 0, 0), (1, 1, 1)), cuboid((5, 0, 0), (7, 2, 2))))
    parts = connected_parts(whole)
    assert [part.volume for part in parts] == [8, 1]
    assert b.union(solid_of(part) for part in parts).equals(whole)


def test_cavities_stay_with_what_is_around_them() -> None:
    # A box in the cavity of a box in the cavity of a box: three parts, two with a cavity.
    sizes = [(0, 10), (1, 9), (2, 8), (3, 7), (4, 6)]
    shells = [cuboid((low,) * 3, (high,) * 3) for low, high in sizes]
    nested = [shell if k % 2 == 0 else flipped(shell) for k, shell in enumerate(shells)]
    parts = connected_parts(b.Solid(*joined(*nested)))
    assert [solid_of(part).volume_exact for part in parts] == [1000 - 512, 216 - 64, 8]


def test_a_cavity_in_the_box_of_another_part() -> None:
    # The long bar's box contains the small hollow cube that lies beside it.
    frame = b.box((10, 10, 2)) - b.box((9, 9, 2)).translate(1, 1, 0)
    hollow = (b.cube(2) - b.cube(1).translate(0.5, 0.5, 0.5)).translate(4, 4, 0)
    parts = connected_parts(frame | hollow)
    assert [solid_of(part).volume_exact for part in parts] == [200 - 162, 7]


def test_many_cavities_ask_the_shell_around_them_once(monkeypatch: pytest.MonkeyPatch) -> None:
    cavities = [b.cube(1).translate(2 * k + 1, 1, 1) for k in range(30)]
    whole = b.box(62, 3, 3) - b.union(cavities)
    whole.to_mesh()
    shells = []

    def counted(*arrays: Any, **options: Any) -> b.Solid:
        shells.append(arrays)
        return b.Solid(*arrays, **options)

    monkeypatch.setattr(parts_module, "Solid", counted)
    (part,) = connected_parts(whole)
    assert part.surface_count == 31 and len(shells) == 1


def test_nothing_has_no_parts() -> None:
    assert connected_parts(b.Solid.empty()) == []


def grooved(depth: float, tags: Any = None) -> b.Solid:
    """Return a block with a groove from below; a groove of depth 4 touches the top from inside."""
    groove = b.Region.polygon([(1, -1), (3, -1), (2, depth)]).extrude(6).rotate(90, "x")
    block = b.box(4, 4, 4)
    return (block if tags is None else block.tagged(**tags)) - groove.translate(0, 5, 0)


# Found: parts that touch along an edge in the middle of a face were one for `decompose`,
# `components` and `genus` (of 1 000 prisms over random triangles 630 meshes did not tell them
# apart).
def test_a_face_that_goes_on_across_an_edge_joins_no_parts() -> None:
    pinched, whole = grooved(4), grooved(3.9)
    assert [part.volume for part in pinched.decompose()] == pytest.approx([pinched.volume / 2] * 2)
    assert (pinched.surface_count, whole.surface_count) == (2, 1)
    left, right = pinched.split("x", 2)
    assert pinched.decompose()[0] in (left, right)
    # The mesh, which is closed without that, does not divide the top.
    assert pinched.to_mesh().surface_count == 1
    for same in (left | right, b.Solid.from_mesh(pinched.to_mesh()), pinched.translate(1, 2, 3)):
        assert (same.surface_count, len(same.decompose())) == (2, 2)


def test_parts_beside_an_edge_keep_what_is_said_of_their_faces() -> None:
    parts = grooved(4, tags={"colour": 7}).decompose()
    assert len(parts) == 2
    for part in parts:
        mesh = part.to_mesh()
        top = (mesh.vertices[mesh.faces][:, :, 2] == 4).all(axis=1)
        assert top.any() and (mesh.face_attributes["colour"][top] == 7).all()


def test_a_slit_in_a_face_parts_nothing() -> None:
    corners = [(1, 2, 4), (3, 2, 4), (2, 1, 3), (2, 3, 3)]
    slit = b.Solid(corners, [(0, 1, 3), (0, 2, 1), (0, 3, 2), (1, 2, 3)])
    block = b.box(4, 4, 4) - slit
    assert block.volume_exact == 64 - slit.volume_exact
    assert [part.volume_exact for part in block.decompose()] == [block.volume_exact]


def test_a_ring_that_touches_both_faces_cuts_out_its_middle() -> None:
    # Of diamonds around an axis: it touches the plate's faces in two squares from inside.
    profile = b.Region.polygon([(3, 0), (4, 1), (3, 2), (2, 1)])
    plate = b.box(12, 12, 2).translate(-6, -6, 0)
    parts = (plate - profile.revolve(segments=4)).decompose()
    assert len(parts) == 2
    assert [part.genus for part in parts] == [1, 0]


def plate_with_grooves(count: int) -> b.Solid:
    """Return a plate that grooves divide into pieces, each touching the next along an edge."""
    groove = b.Region.polygon([(0.2, -1), (0.8, -1), (0.5, 4)]).extrude(20).rotate(90, "x")
    grooves = b.union(groove.translate(at, 15, 0) for at in range(count))
    return (b.box(count, 10, 4) - grooves).normalized()


def test_many_edges_in_one_face_cost_each_alike() -> None:
    times = {}
    for count in (100, 400):
        plate = plate_with_grooves(count)
        plate.to_mesh()
        assert plate.surface_count == count + 1
        times[count] = seconds(partial(getattr, plate, "components"), 3)
    assert times[400] < 10 * times[100]


@pytest.mark.parametrize("normal", [(0, 0, 1), (1, 1, 1), (0.3, -2, 0.7)])
def test_sides_make_the_whole(normal: tuple[float, float, float]) -> None:
    whole = b.cube(2) - b.sphere(1, segments=8)
    below, above = sides_of_plane(whole, normal, Fraction(1, 2))  # type: ignore[arg-type]
    assert_sound(below)
    assert_sound(above)
    assert (below | above).equals(whole) and below.isdisjoint(above)
    assert below.volume_exact + above.volume_exact == whole.volume_exact


def test_unbounded_solids_have_no_parts() -> None:
    with pytest.raises(b.UnboundedError):
        connected_parts(~b.cube(1))


def cone(sides: int) -> b.Solid:
    """Return a cone with apex and base centre as corners of all its faces."""
    turns = np.arange(sides) * 2 * np.pi / sides
    rim = np.stack([10 * np.cos(turns), 10 * np.sin(turns), 0 * turns], axis=1)
    near = np.arange(sides)
    far = (near + 1) % sides
    base = np.stack([0 * near, 2 + far, 2 + near], axis=1)
    mantle = np.stack([0 * near + 1, 2 + near, 2 + far], axis=1)
    return b.Solid(np.concatenate([[[0, 0, 0], [0, 0, 10]], rim]), np.concatenate([base, mantle]))


# Found: pairing the edges around a vertex took time quadratic in the number of its faces, and did
# not respond to signals.
def test_faces_around_a_corner_cost_each_alike() -> None:
    times = {}
    for sides in (4_000, 16_000):
        whole = cone(sides)
        whole.to_mesh()
        times[sides] = seconds(partial(connected_parts, whole), 3)
    assert times[16_000] < 8 * times[4_000]


def test_components_are_the_parts() -> None:
    pair = (b.cube(3) - b.cube(1).translate(1, 1, 1)) | b.cube(1).translate(x=5)
    assert [part.volume for part in pair.components] == [26, 1]
    assert (len(pair.components), pair.surface_count, b.Solid.empty().components) == (2, 3, ())
    assert isinstance(pair.components, tuple) and pair.components == pair.components
    assert pickle.loads(pickle.dumps(pair.components)) == pair.components


def test_components_as_a_number_warn() -> None:
    hollow = b.cube(3) - b.cube(1).translate(1, 1, 1)
    parts: Any = hollow.components
    for is_so in (parts.__eq__, lambda count: not parts.__ne__(count)):
        with pytest.warns(DeprecationWarning, match="surface_count") as warned:
            assert is_so(2)
        assert warned[0].filename == __file__
    with pytest.warns(DeprecationWarning, match="surface_count"):
        assert hollow.to_mesh().components == 2
