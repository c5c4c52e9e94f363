"""Cases of GEOS for sets of the plane, and of shapely's own tests.

Points and lines where operands touch are no part of our results, which are regularised sets. All
else must be exactly equal.
"""

from collections.abc import Iterator
from pathlib import Path

import pytest
import shapely

from bspcsg import Region

CASES = Path(__file__).parents[1] / "corpus" / "regions" / "geos.txt"
OPERATIONS = {
    "union": lambda a, b: a | b,
    "intersection": lambda a, b: a & b,
    "difference": lambda a, b: a - b,
    "reverse": lambda a, b: b - a,
    "xor": lambda a, b: a ^ b,
}


def cases() -> Iterator[tuple[str, str, str, str, str]]:
    """Yield name, operation, both operands and the result of each case."""
    name = a = b = ""
    for line in CASES.read_text("utf-8").splitlines():
        word, _, rest = line.partition(" ")
        if word == "case":
            name = rest
        elif word == "a":
            a = rest
        elif word == "b":
            b = rest
        elif word != "#":
            yield name, word, a, b, rest


ALL = list(cases())


def region(text: str) -> Region:
    return Region(shapely.from_wkt(text))


def test_the_cases_are_all_there() -> None:
    assert len({name for name, *_ in ALL}) == 29
    assert len(ALL) == 106


@pytest.mark.parametrize(("name", "operation", "a", "b", "expected"), ALL)
def test_overlays(name: str, operation: str, a: str, b: str, expected: str) -> None:
    result = OPERATIONS[operation](region(a), region(b))
    assert result == region(expected), name
    assert shapely.equals(result.to_shapely(), shapely.from_wkt(expected))


@pytest.mark.parametrize("count", range(1, 5))
def test_boxes_reduced(count: int) -> None:
    """shapely/tests/test_set_operations.py: all at once, or one after another."""
    corners = [(0, 5), (2, 7), (4, 9), (5, 10)][:count]
    boxes = [Region(shapely.box(low, low, high, high)) for low, high in corners]
    union = xor = boxes[0]
    for box in boxes[1:]:
        union, xor = union | box, xor ^ box
    assert Region.compose(boxes) == union
    parts = [shapely.box(low, low, high, high) for low, high in corners]
    assert union == Region(shapely.union_all(parts))
    expected = parts[0]
    for part in parts[1:]:
        expected = shapely.symmetric_difference(expected, part)
    assert xor == Region(expected)


def test_a_coverage_becomes_one_box() -> None:
    """shapely/tests/test_set_operations.py: three boxes side by side."""
    boxes = [shapely.box(k, 0, k + 1, 1) for k in range(3)]
    for count in range(1, 4):
        union = Region.compose(map(Region, boxes[:count]))
        assert union == Region(shapely.box(0, 0, count, 1))
        assert len(union.outlines[0].points) == 4


@pytest.mark.parametrize(
    ("pitch", "expected"),
    [
        (-9, "((0 .2, 0 10, 5.1 10, 5.1 .2, 5 .2, 5 .1, .1 .1, .1 .2, 0 .2))"),
        (-1, "((0 .2, 0 10, 5.1 10, 5.1 .2, 5 .2, 5 .1, .1 .1, .1 .2, 0 .2))"),
        (0, "((0 0, 5 0, 5 10, 0 10, 0 0))"),
        (2, "EMPTY"),
    ],
)
def test_lattices_are_grids(pitch: int, expected: str) -> None:
    """shapely/tests/test_set_operations.py::test_union_all_prec, its grid sizes as pitches.

    The grid size 10 is left out: halves go away from zero here (5 becomes 10) and to even there.
    """
    boxes = [shapely.box(0.1, 0.1, 5, 5), shapely.box(0, 0.2, 5.1, 10)]
    union = Region.compose(Region(box, pitch=pitch) for box in boxes)
    assert union == region(f"POLYGON {expected}")


def test_what_is_no_valid_polygon() -> None:
    """shapely/tests/legacy/test_operations.py::test_relate, whose hole leaves its shell.

    GEOS refuses the polygon. Here a shell and a hole are what winds around them.
    """
    made = region(
        "POLYGON ((40 100, 80 100, 80 60, 40 60, 40 100), (60 60, 80 60, 80 40, 60 40, 60 60))"
    )
    assert made == region("POLYGON ((40 100, 80 100, 80 60, 40 60, 40 100))")
