"""SVG files: nested views, symbols and uses, and elements that are not drawn."""

from pathlib import Path

import numpy as np
import pytest

import bspcsg as b
from bspcsg import Region, bsp
from bspcsg.bsp.drawings import svg_tree

SPACES = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
SQUARE = '<rect width="10" height="10"/>'

#: Left, upper, right and lower side as the drawing counts them, y downwards.
Box = tuple[float, float, float, float]


def region_of(folder: Path, body: str, root: str = 'viewBox="0 0 100 100"') -> Region:
    path = folder / "x.svg"
    path.write_text(f"<svg {SPACES} {root}>{body}</svg>")
    return Region.from_svg(path)


def is_box(region: Region, box: Box) -> bool:
    left, upper, right, lower = box
    expected = Region.rectangle(right - left, lower - upper).translate(left, -lower)
    return (region ^ expected).area <= 1e-9 * expected.area


VIEWS: dict[str, tuple[str, Box]] = {
    "without a box": (f'<svg x="50" y="3">{SQUARE}</svg>', (50, 3, 60, 13)),
    "half as large": (
        f'<svg x="50" width="10" height="10" viewBox="0 0 20 20">{SQUARE}</svg>',
        (50, 0, 55, 5),
    ),
    "twice as large": (
        f'<svg x="50" y="3" width="20" height="20" viewBox="0 0 10 10">{SQUARE}</svg>',
        (50, 3, 70, 23),
    ),
    "in the middle": (
        f'<svg x="50" y="3" width="20" height="40" viewBox="0 0 10 10">{SQUARE}</svg>',
        (50, 13, 70, 33),
    ),
    "at the end": (
        '<svg width="20" height="40" viewBox="0 0 10 10" preserveAspectRatio="xMidYMax meet">'
        f"{SQUARE}</svg>",
        (0, 20, 20, 40),
    ),
    "filled": (
        '<svg width="20" height="40" viewBox="0 0 10 10" preserveAspectRatio="xMinYMin slice">'
        f"{SQUARE}</svg>",
        (0, 0, 40, 40),
    ),
    "stretched": (
        '<svg width="20" height="40" viewBox="0 0 10 10" preserveAspectRatio="none">'
        f"{SQUARE}</svg>",
        (0, 0, 20, 40),
    ),
    "with a shifted box": (
        f'<svg width="20" height="20" viewBox="-5 5 10 10">{SQUARE}</svg>',
        (10, -10, 30, 10),
    ),
    "in a view": (
        '<svg x="10" width="40" height="40" viewBox="0 0 20 20">'
        f'<svg x="5" width="50%" height="50%" viewBox="0 0 10 10">{SQUARE}</svg></svg>',
        (20, 0, 40, 20),
    ),
    "in a turned group": (
        f'<g transform="rotate(90)"><svg x="50" y="-20">{SQUARE}</svg></g>',
        (10, 50, 20, 60),
    ),
}


@pytest.mark.parametrize("name", VIEWS)
def test_views_are_fitted_into_their_places(tmp_path: Path, name: str) -> None:
    body, box = VIEWS[name]
    assert is_box(region_of(tmp_path, body), box)


SYMBOL = f'<symbol id="s" viewBox="0 0 10 10">{SQUARE}</symbol>'
USES: dict[str, tuple[str, Box]] = {
    "a symbol": (f'{SYMBOL}<use href="#s" x="5" width="20" height="20"/>', (5, 0, 25, 20)),
    "a symbol among definitions": (
        f'<defs>{SYMBOL}</defs><use xlink:href="#s" width="20" height="20"/>',
        (0, 0, 20, 20),
    ),
    "a symbol before it is declared": (
        f'<use href="#s" x="5" width="20" height="20"/>{SYMBOL}',
        (5, 0, 25, 20),
    ),
    "a symbol that is moved": (
        f'<symbol id="s" viewBox="-25 -25 50 50">{SQUARE}</symbol>'
        '<use href="#s" x="-25" y="-25" width="50" height="50" transform="translate(100 0)"/>',
        (100, 0, 110, 10),
    ),
    "a symbol as large as the drawing": (f'{SYMBOL}<use href="#s"/>', (0, 0, 100, 100)),
    "a symbol of any size": (f'{SYMBOL}<use href="#s" width="auto"/>', (0, 0, 100, 100)),
    "a symbol without a box": (
        f'<symbol id="s">{SQUARE}</symbol><use href="#s" x="5" y="2"/>',
        (5, 2, 15, 12),
    ),
    "a use": (
        f'<defs><g id="s">{SQUARE}</g><use id="t" href="#s" y="3"/></defs><use href="#t" x="5"/>',
        (5, 3, 15, 13),
    ),
}


@pytest.mark.parametrize("name", USES)
def test_what_is_used(tmp_path: Path, name: str) -> None:
    body, box = USES[name]
    assert is_box(region_of(tmp_path, body), box)


# Found: SVG: symbols, masks and markers were drawn where they are declared; views and symbols lay
# elsewhere.
@pytest.mark.parametrize(
    "declared", ["symbol", "mask", "marker", "pattern", "clipPath", "defs", "foreignObject"]
)
def test_what_is_declared_shows_nothing(tmp_path: Path, declared: str) -> None:
    with pytest.warns(bsp.DrawingWarning, match="region is empty"):
        assert region_of(tmp_path, f'<{declared} id="x">{SQUARE}</{declared}>').is_empty


@pytest.mark.parametrize(
    "shape",
    ["<path/>", '<path d=""/>', '<rect width="-4" height="5"/>', '<circle r="-1"/>'],
)
def test_shapes_that_show_nothing_leave_the_others(tmp_path: Path, shape: str) -> None:
    assert is_box(region_of(tmp_path, shape + SQUARE), (0, 0, 10, 10))


def test_the_first_child_of_a_switch_that_needs_nothing(tmp_path: Path) -> None:
    other = '<rect width="50" height="1" requiredExtensions="http://example.com/"/>'
    body = f'<switch>{other}<g>{SQUARE}</g><circle r="40"/></switch>'
    assert is_box(region_of(tmp_path, body), (0, 0, 10, 10))


@pytest.mark.parametrize(
    "root",
    [
        'viewBox="3 -7 80 40"',
        'width="80" height="40"',
        'width="8cm" viewBox="0 0 80 40"',
        'width="80" height="40" viewBox="none"',
        'width="80" height="40" viewBox="0 0 inf 1"',
        'width="auto" viewBox="0,0,80,40"',
    ],
)
def test_percentages_are_parts_of_the_drawing(tmp_path: Path, root: str) -> None:
    region = region_of(tmp_path, '<rect width="50%" height="50%"/>', root)
    assert is_box(region, (0, 0, 40, 20))


def uses_of_uses(levels: int, times: int) -> str:
    body = f'<g id="g0">{SQUARE}</g>'
    for level in range(1, levels + 1):
        body += f'<g id="g{level}">' + f'<use href="#g{level - 1}"/>' * times + "</g>"
    return f'<defs>{body}</defs><use href="#g{levels}"/>'


# Found: SVG and DXF: uses of uses and blocks in blocks could take forever; a path without data
# refused the file.
def test_uses_that_show_too_much_are_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert is_box(region_of(tmp_path, uses_of_uses(2, 3)), (0, 0, 10, 10))
    with pytest.raises(b.FormatError, match="repeat more than"):
        region_of(tmp_path, uses_of_uses(12, 10))
    monkeypatch.setattr(svg_tree, "_MAX_ELEMENTS_SHOWN", 8)
    with pytest.raises(b.FormatError, match="repeat more than"):
        region_of(tmp_path, uses_of_uses(2, 3))


def test_uses_in_one_another(tmp_path: Path) -> None:
    assert is_box(region_of(tmp_path, uses_of_uses(60, 1)), (0, 0, 10, 10))
    for body in (uses_of_uses(99, 1), f'<g id="s">{SQUARE}<use href="#s"/></g>'):
        with pytest.raises(b.FormatError, match="nested deeper"):
            region_of(tmp_path, body)


def test_many_shapes_are_united_at_once(tmp_path: Path) -> None:
    places = [(k % 30, k // 30) for k in range(900)]
    body = "".join(f'<rect x="{3 * x}" y="{3 * y}" width="2" height="2"/>' for x, y in places)
    region = region_of(tmp_path, body)
    assert region.area == 3600 and len(region.outlines) == 900
    assert region.bounds is not None and np.array_equal(region.bounds, [[0, -89], [89, 0]])
