"""The views of a solid in notebooks."""

import html
import io
import re
import sys
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

import bspcsg as b
from bspcsg.report.viewer import notebook


def test_the_view_is_a_page_in_a_frame() -> None:
    shown = (b.cube(2) - b.sphere(r=1.2, segments=16))._repr_html_()
    assert shown is not None and len(shown) < 260_000
    frame = re.fullmatch(r'<iframe srcdoc="([^"]*)" title="[^"]*" sandbox="allow-scripts".*', shown)
    assert frame is not None
    page = html.unescape(frame[1])
    assert page.startswith("<!doctype html>") and "default-src 'none'" in page
    assert 'id="bspcsg-viewer"' in page


def test_the_picture_is_svg() -> None:
    drawn = (b.cube(2) - b.sphere(r=1.2, segments=16))._repr_svg_()
    assert ElementTree.fromstring(drawn).tag.endswith("svg") and drawn.count("<path") > 3


def test_pictures_of_large_solids_stay_small() -> None:
    assert len(b.sphere(r=1, segments=150)._repr_svg_()) < 150_000


@pytest.mark.parametrize(
    ("solid", "words"),
    [
        (b.Solid.empty(), "empty"),
        (b.cube(1) - b.cube(2, center=True), "empty"),
        (~b.cube(1), "reaches to infinity"),
        (b.Solid.full(), "reaches to infinity"),
        (b.half_space((0, 0, 1), 0), "reaches to infinity"),
    ],
)
def test_solids_without_a_boundary_to_show(solid: b.Solid, words: str) -> None:
    assert words in str(solid._repr_html_())
    drawn = solid._repr_svg_()
    assert words in drawn and ElementTree.fromstring(drawn).tag.endswith("svg")


def test_too_large_a_solid_is_a_picture_and_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(notebook, "_MOST_IN_VIEW", 100)
    shown = str(b.sphere(r=1, segments=24)._repr_html_())
    assert shown.startswith("<svg") and "528 triangles are too many for a notebook" in shown
    assert "iframe" not in shown


def pixels_of(data: bytes | None) -> "np.ndarray[tuple[int, ...], np.dtype[np.uint8]]":
    assert data is not None and data.startswith(b"\x89PNG")
    with Image.open(io.BytesIO(data)) as image:
        return np.asarray(image.convert("RGBA"))


# Found: there was no `_repr_png_`.
@pytest.mark.parametrize(
    "shown", [b.cube(2) - b.sphere(r=1.2, segments=16), b.Region([(0, 0), (4, 0), (0, 3)])]
)
def test_pictures_as_pixels(shown: b.Solid | b.Region) -> None:
    data = shown._repr_png_()
    pixels = pixels_of(data)
    covered = (pixels[..., 3] > 0).mean()
    assert pixels.shape == (360, 480, 4) and 0.1 < covered < 0.9
    assert data is not None and len(data) < 60_000


def test_the_picture_of_a_region_has_its_holes() -> None:
    ring = b.Region([(0, 0), (4, 0), (4, 4), (0, 4)]) - b.Region([(1, 1), (3, 1), (3, 3), (1, 3)])
    pixels = pixels_of(ring._repr_png_())
    assert pixels[180, 240, 3] == 0 and pixels[180, 120, 3] == 255
    assert ElementTree.fromstring(ring._repr_svg_() or "").tag.endswith("svg")


@pytest.mark.parametrize(
    "shown", [b.Solid.empty(), ~b.cube(1), b.Region.empty(), ~b.Region([(0, 0), (1, 0), (0, 1)])]
)
def test_nothing_to_be_seen_has_no_pixels(shown: b.Solid | b.Region) -> None:
    assert shown._repr_png_() is None


def test_without_pillow_there_are_no_pixels(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "PIL", None)
    assert b.cube(1)._repr_png_() is None and "<svg" in b.cube(1)._repr_svg_()


# Found: `PartitionTree` was text in notebooks, and traces printed thousands of characters.
def test_trees_in_the_plane_are_pictures() -> None:
    tree = b.bsp.PartitionTree([[(0, 0), (2, 1)], [(1, 0), (1, 3)]])
    drawn = tree._repr_svg_()
    assert drawn == tree.to_svg() and ElementTree.fromstring(drawn or "").tag.endswith("svg")
    assert b.bsp.PartitionTree(b.cube(1).vertices[b.cube(1).faces])._repr_svg_() is None
    assert b.bsp.PartitionTree([[(0,), (1,)]])._repr_svg_() is None


def test_trees_too_large_to_draw_are_text(monkeypatch: pytest.MonkeyPatch) -> None:
    tree = b.bsp.PartitionTree([[(0, 0), (2, 1)], [(1, 0), (1, 3)]])
    monkeypatch.setattr("bspcsg.bsp.trees.tree._MOST_DRAWN", 2)
    assert len(tree) == 3 and tree._repr_svg_() is None


def test_traces_say_how_long_they_are() -> None:
    segments = [[(k, 0), (k + 0.5, 3)] for k in range(40)]
    tree = b.bsp.PartitionTree(segments)
    traces = [
        tree.trace(),
        tree.trace_ray((-1, 1), (1, 0)),
        b.Region.circle(2).tree.trace_merge(b.Region.circle(1).tree, "union"),
    ]
    for trace in traces:
        words = repr(trace)
        assert words.startswith(type(trace).__name__) and len(words) < 80, words
