"""Components with their cavities, and the two sides of a plane."""

from fractions import Fraction
from typing import Any

import pytest

import bspcsg as b
from bspcsg.operations import parts as parts_module
from bspcsg.operations.parts import connected_parts, sides_of_plane
from support.checks import assert_sound
from support.shapes import cuboid, flipped, joined


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
    assert part.components == 31 and len(shells) == 1


def test_nothing_has_no_parts() -> None:
    assert connected_parts(b.Solid.empty()) == []


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
