"""Views of solids in notebooks."""

import html
import io
import re
import sys
from types import ModuleType
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from PIL import Image

import bspcsg as b
from bspcsg.report.assets import bundle
from bspcsg.report.viewer import notebook, shared_script


def test_the_view_is_a_page_in_a_frame() -> None:
    shown = (b.cube(2) - b.sphere(r=1.2, segments=16))._repr_html_()
    assert shown is not None and len(shown) < 260_000
    frame = re.fullmatch(r'<iframe srcdoc="([^"]*)" title=.* sandbox="allow-scripts".*', shown)
    assert frame is not None
    page = html.unescape(frame[1])
    assert page.startswith("<!doctype html>") and "default-src 'none'" in page
    assert 'id="bspcsg-viewer"' in page


def test_the_picture_is_svg() -> None:
    drawn = str((b.cube(2) - b.sphere(r=1.2, segments=16))._repr_svg_())
    assert ElementTree.fromstring(drawn).tag.endswith("svg") and drawn.count("<path") > 3


def test_pictures_of_large_solids_stay_small() -> None:
    assert len(str(b.sphere(r=1, segments=150)._repr_svg_())) < 150_000


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
    drawn = str(solid._repr_svg_())
    assert words in drawn and ElementTree.fromstring(drawn).tag.endswith("svg")


def test_too_large_a_solid_is_a_picture_and_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(notebook, "_MAX_VIEW_TRIANGLES", 100)
    shown = str(b.sphere(r=1, segments=24)._repr_html_())
    assert (
        shown.startswith("<svg")
        and "528 triangles are too many for an interactive view in a notebook" in shown
    )
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
    assert b.cube(1)._repr_png_() is None and "<svg" in str(b.cube(1)._repr_svg_())


# Found: `PartitionTree` was shown as text in notebooks, and traces printed thousands of characters.
def test_trees_in_the_plane_are_pictures() -> None:
    tree = b.bsp.PartitionTree([[(0, 0), (2, 1)], [(1, 0), (1, 3)]])
    drawn = tree._repr_svg_()
    assert drawn == tree.to_svg() and ElementTree.fromstring(drawn or "").tag.endswith("svg")
    assert b.bsp.PartitionTree(b.cube(1).vertices[b.cube(1).faces])._repr_svg_() is None
    assert b.bsp.PartitionTree([0.0, 1.0])._repr_svg_() is None


def test_trees_too_large_to_draw_are_text(monkeypatch: pytest.MonkeyPatch) -> None:
    tree = b.bsp.PartitionTree([[(0, 0), (2, 1)], [(1, 0), (1, 3)]])
    monkeypatch.setattr("bspcsg.bsp.trees.tree._MAX_NODES_DRAWN", 2)
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


class Kernel:
    """A stand-in for a notebook's shell, with what the views use."""

    def __init__(self, named: bool) -> None:
        self.kernel = object()
        self.user_ns: dict[str, list[str]] = {"In": [""]}
        self.runs = 0
        self._named = named
        self.shown: list[Any] = []

    def run(self, cell: str, *shown: b.Solid) -> list[str]:
        """Return the views of solids in a cell that runs now."""
        self.runs += 1
        self.user_ns["In"].append(cell)
        return [str(one._repr_html_()) for one in shown]

    def get_parent(self) -> dict[str, Any]:
        header = {"msg_id": str(self.runs)}
        cell = {"cellId": self.user_ns["In"][-1]} if self._named else {}
        return {"header": header, "metadata": cell}


@pytest.fixture(params=[True, False], ids=["cells with names", "without"])
def kernel(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Kernel:
    found = Kernel(request.param)
    ipython, display = ModuleType("IPython"), ModuleType("IPython.display")
    monkeypatch.setattr(ipython, "get_ipython", lambda: found, raising=False)
    monkeypatch.setattr(display, "display", found.shown.append, raising=False)
    monkeypatch.setitem(sys.modules, "IPython", ipython)
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    monkeypatch.setattr(notebook, "NOTEBOOK", shared_script.Notebook())
    return found


SMALL, ROUND = b.cube(1), b.sphere(1, segments=120)


def frame_of(shown: str) -> str:
    """Return the page in a view's frame; assert that it is small apart from the mesh."""
    frame = re.search(r'<iframe srcdoc="([^"]*)"', shown)
    assert frame is not None
    page = html.unescape(frame[1])
    model = re.search(r'<script type="application/json" id="model">(.*?)</script>', page, re.S)
    assert model is not None and len(frame[0]) - len(model[1]) < 30_000
    return page


# Found: each displayed solid stored 240 kB of viewer.
def test_solids_in_a_notebook_share_one_viewer(kernel: Kernel) -> None:
    first, second = kernel.run("a; b", SMALL, ROUND)
    third = kernel.run("c", SMALL)[0]
    assert bundle() in first and bundle() not in second + third
    for shown in (first, second, third):
        page = frame_of(shown)
        assert bundle() not in page and f'data-ask="{shared_script.viewer_name()}"' in page
        assert "<img src=" in page
    assert "<script>" not in second.partition("<iframe")[0] + second.partition("</iframe>")[2]
    assert f'const name = "{shared_script.viewer_name()}"' in first


def test_the_cell_with_the_viewer_holds_it_when_it_runs_again(kernel: Kernel) -> None:
    assert bundle() in kernel.run("a", SMALL)[0]
    assert bundle() not in kernel.run("b", SMALL)[0]
    again = kernel.run("a", SMALL, SMALL)
    assert [bundle() in shown for shown in again] == [True, False]
    assert bundle() not in kernel.run("b", SMALL)[0]


def test_a_notebook_stores_one_picture_only(
    kernel: Kernel, monkeypatch: pytest.MonkeyPatch
) -> None:
    kernel.run("a", SMALL)
    assert SMALL._repr_svg_() is None and SMALL._repr_png_() is not None
    assert "empty" in str(b.Solid.empty()._repr_svg_())
    monkeypatch.setitem(sys.modules, "PIL", None)
    assert SMALL._repr_png_() is None and "<svg" in str(SMALL._repr_svg_())


def test_outputs_on_pages_of_their_own_are_whole(
    kernel: Kernel, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "google.colab", ModuleType("google.colab"))
    shown = kernel.run("a", SMALL) + kernel.run("b", SMALL)
    assert all(bundle() in one and "data-ask" not in one for one in shown)


def test_show_displays_in_a_notebook(kernel: Kernel) -> None:
    figure = b.Region.circle(1)
    b.show(SMALL, figure)
    figure.show()
    assert kernel.shown == [SMALL, figure, figure]
