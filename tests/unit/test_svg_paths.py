"""SVG files: path data and curves."""

from pathlib import Path
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

from bspcsg import Region, bsp
from bspcsg._types import FloatArray
from bspcsg.bsp.drawings.svg_curves import outlines
from bspcsg.bsp.drawings.svg_paths import path_segments, shape_segments
from support.timing import seconds

elements = pytest.importorskip("svgelements")

#: Chords of each curve.
STEPS = 7


def region_of(folder: Path, body: str) -> Region:
    path = folder / "x.svg"
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">{body}</svg>')
    return bsp.load_svg(path)


def corners_of(data: str) -> list[tuple[FloatArray, bool]]:
    segments = path_segments(data)
    assert segments is not None
    matrices = np.array([(1.0, 0, 0, 1, 0, 0)])
    (found,) = outlines([segments], matrices, lambda curves: np.full(len(curves.owner), STEPS))
    return found


def points_of_svgelements(segment: Any) -> FloatArray:
    if isinstance(segment, (elements.Move, elements.Line, elements.Close)):
        return np.array([(segment.end.x, segment.end.y)])
    return np.array(segment.npoint(np.arange(1, STEPS + 1) / STEPS))


def is_same(found: FloatArray, expected: FloatArray) -> bool:
    # The centre of an arc is as far off as the root of the rounding in its radii.
    bound = 1e-6 * (1 + float(np.abs(expected).max(initial=0)))
    return found.shape == expected.shape and np.allclose(found, expected, rtol=0, atol=bound)


numbers = st.one_of(
    st.integers(-30, 30).map(str),
    st.floats(0.001, 0.999).map(lambda x: f"{x:.3f}".lstrip("0")),
    st.sampled_from(["1e1", "-2.5E-1", "+4", "-.5e+1"]),
)
flags = st.sampled_from(["0", "1"])
sizes = st.integers(1, 40).map(str)
blanks = st.sampled_from([" ", ",", " , ", "\n"])


def joined(parts: list[st.SearchStrategy[str]]) -> st.SearchStrategy[str]:
    """Return a strategy for the arguments of a command, once or twice."""
    once = st.tuples(blanks, *parts).map(lambda words: words[0].join(words[1:]))
    return st.lists(once, min_size=1, max_size=2).map(" ".join)


arcs = st.tuples(sizes, sizes, numbers, flags, flags, numbers, numbers).map(
    lambda a: f"{a[0]} {a[1]},{a[2]} {a[3]}{a[4]}{a[5]} {a[6]}"
)
takes = {
    "L": joined([numbers] * 2),
    "H": joined([numbers]),
    "V": joined([numbers]),
    "C": joined([numbers] * 6),
    "Q": joined([numbers] * 4),
    "A": arcs,
}
#: Smooth curves go on from their like: after another curve, svgelements mirrors where it must not.
smooth = {"C": ("S", joined([numbers] * 4)), "Q": ("T", joined([numbers] * 2))}


@st.composite
def path_data(draw: st.DrawFn) -> str:
    data = ""
    for _ in range(draw(st.integers(1, 3))):
        pair = draw(st.tuples(numbers, numbers))
        data += draw(st.sampled_from("Mm")) + " ".join(pair)
        for name in draw(st.lists(st.sampled_from("LHVCQA"), max_size=4)):
            names = [(name, takes[name])]
            if name in smooth and draw(st.booleans()):
                names.append(smooth[name])
            for one, arguments in names:
                data += (one if draw(st.booleans()) else one.lower()) + draw(arguments)
        data += draw(st.sampled_from(["", "z", " Z "]))
    return data


@given(path_data())
def test_points_of_paths_are_those_of_svgelements(data: str) -> None:
    found = corners_of(data)
    subpaths = list(elements.Path(data).as_subpaths())
    assert len(found) == len(subpaths)
    for (corners, is_closed), subpath in zip(found, subpaths, strict=True):
        expected = np.concatenate([points_of_svgelements(one) for one in subpath])
        differs = np.hypot(*(expected - np.roll(expected, 1, axis=0)).T) > 1e-9
        gaps = np.hypot(*(corners - np.roll(corners, 1, axis=0)).T) > 1e-9
        assert is_same(corners[gaps] * (1, -1), expected[differs])
        assert is_closed == any(isinstance(one, elements.Close) for one in subpath)


@pytest.mark.parametrize(
    ("short", "long"),
    [
        ("M1 1a1 1 0 0110 10", "M 1,1 A 1 1 0 0 1 11 11"),
        ("M1 1A4 3 0 01.5.5L-5 5", "M 1 1 A 4 3 0 0 1 0.5 0.5 L -5 5"),
        ("M1-1.5.5 2", "M 1 -1.5 L 0.5 2"),
        ("m1 1 2 0h-1v1", "M1 1L3 1L2 1L2 2"),
        # A smooth curve mirrors nothing but its like.
        ("M0 0Q1 2 3 0S5 6 7 8", "M0 0Q1 2 3 0C3 0 5 6 7 8"),
        ("M0 0C0 1 1 2 3 0T7 8", "M0 0C0 1 1 2 3 0Q3 0 7 8"),
        ("M0 0L3 0s5 6 7 8", "M0 0L3 0C3 0 8 6 10 8"),
        # After its end, a subpath goes on where it began.
        ("M1 1h1v1zl3 0 0 1", "M1 1h1v1zM1 1L4 1L4 2"),
        ("M1 1h1v1zm2 0h1v1z", "M1 1h1v1zM3 1h1v1z"),
    ],
)
def test_short_data_stand_for_long_ones(short: str, long: str) -> None:
    for found, expected in zip(corners_of(short), corners_of(long), strict=True):
        assert is_same(found[0], expected[0])


@pytest.mark.parametrize(
    "data",
    [
        *("", "x", "L1 1", "M1", "M1 1L", "M1 1 2", "M1 1zz 3", "M1 1L1. 2", "M1 1#"),
        *("M1 1A1 1 0 2 1 3 3", "M1 1A1 1 0 1 3 3", "M1 1A1 1 011 3 3", "M1 1e999", "M1 1H-1e999"),
    ],
)
def test_data_with_faults_are_left_to_svgelements(data: str) -> None:
    assert path_segments(data) is None


def test_a_path_is_drawn_up_to_its_fault(tmp_path: Path) -> None:
    assert region_of(tmp_path, '<path d="M0 0H4V4H0 L x"/>').area == 16


def test_a_shape_in_a_path_is_another(tmp_path: Path) -> None:
    body = '<path d="M0 0H1V1H0z"><rect x="5" width="2" height="2"/></path>'
    assert region_of(tmp_path, body).area == 5


def test_a_path_that_is_used_is_placed_by_its_use(tmp_path: Path) -> None:
    body = '<path id="a" d="M0 0H1V1H0z"/><g transform="scale(2)"><use href="#a" x="3"/></g>'
    region = region_of(tmp_path, body)
    assert region.area == 5
    assert region.bounds is not None and region.bounds[1].tolist() == [8, 0]


def test_a_subpath_goes_on_where_the_last_one_began(tmp_path: Path) -> None:
    assert region_of(tmp_path, '<path d="M1 1h-1v-1zl4 0 0 4"/>').area == pytest.approx(8.5)
    # With a fault at its end.
    assert region_of(tmp_path, '<path d="M1 1h-1v-1zl4 0 0 4x"/>').area == pytest.approx(8.5)


@pytest.mark.parametrize(
    "arc",
    [
        "3 3 0 0 1 6 0",
        # Too small for its chord.
        "1 1 0 0 1 6 0",
        # Nearly half of a circle, whose angle is known no better from its cosine.
        "3.0000000001 3.0000000001 0 0 1 6 0",
    ],
)
def test_half_circles_go_through_their_tops(arc: str) -> None:
    ((corners, _),) = corners_of(f"M0 0A{arc}")
    radii = np.hypot(*(corners - (3, 0)).T)
    assert radii == pytest.approx(np.full(len(corners), 3), abs=1e-4)
    assert corners[:, 1].min() == 0 and corners[:, 1].max() > 2.9


def test_arcs_without_an_extent_are_straight() -> None:
    for arc in ("0 2 0 1 1 5 0", "2 0 0 1 1 5 0"):
        ((corners, _),) = corners_of(f"M0 0A{arc}L5 5")
        assert corners.tolist() == [[0, 0], [5, 0], [5, -5]]
    ((corners, _),) = corners_of("M0 0A2 2 0 1 1 0 0L5 5")
    assert corners.tolist() == [[0, 0], [5, -5]]


def test_round_shapes_are_those_of_svgelements() -> None:
    shapes = elements.Circle(cx=1, cy=2, r=3), elements.Ellipse(cx=1, cy=2, rx=3, ry=0.5)
    for shape in shapes:
        (((corners, is_closed),),) = outlines(
            [shape_segments(shape)],
            np.array([(1.0, 0, 0, 1, 0, 0)]),
            lambda curves: np.full(len(curves.owner), STEPS),
        )
        expected = np.concatenate([points_of_svgelements(one) for one in elements.Path(shape)])
        assert is_closed and len(corners) == 4 * STEPS
        assert is_same(corners * (1, -1), expected[1:-1])


# Found: 10 000 arcs of a path took three seconds, for each was measured and cut alone.
def test_many_arcs_are_cut_at_once(tmp_path: Path) -> None:
    arcs = "a1 1 0 0 1 2 0" * 10_000
    body = f'<path d="M0 0{arcs}v20000h-20000z"/>'
    assert seconds(lambda: region_of(tmp_path, body), 2) < 2
