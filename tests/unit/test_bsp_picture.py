"""Pictures: their content, files, and refusals."""

import builtins
import io
import re
import time
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

import bspcsg as b
from bspcsg import BspcsgError, FormatError, InvalidMeshError, LimitError, bsp
from bspcsg.bsp.painting import picture as painting_picture
from support import shapes

SQUARE = [[[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]]]
TOP = bsp.Camera.orthographic((0, 0, -1), scale=4, target=(1, 1, 0))


def pixels(picture: bsp.Picture) -> npt.NDArray[np.uint8]:
    return np.asarray(Image.open(io.BytesIO(picture.png)))


def total(ends: npt.NDArray[np.float64]) -> float:
    return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())


# What is seen


def test_a_square_fills_a_quarter_of_the_picture() -> None:
    tree = bsp.PartitionTree(SQUARE)
    seen = pixels(bsp.picture(tree, camera=TOP, size=(80, 80), edges="none", background="black"))
    assert seen.shape == (80, 80, 3)
    covered = seen.max(axis=2) > 0
    assert covered[22:58, 22:58].all()
    assert not covered[:19].any() and not covered[:, 61:].any()


def test_the_background_can_be_transparent() -> None:
    tree = bsp.PartitionTree(SQUARE)
    picture = bsp.picture(tree, camera=TOP, size=(80, 80), background=None)
    seen = pixels(picture)
    assert seen[0, 0].tolist() == [0, 0, 0, 0]
    assert seen[40, 40, 3] == 255
    assert "<rect" not in picture.svg
    assert '<rect width="100%" height="100%" fill="#ffffff"/>' in bsp.picture(tree).svg


def test_cut_lines_are_not_drawn() -> None:
    # A wall seen edge-on cuts the square in two.
    wall = [[1, -1, -1], [1, 3, -1], [1, 3, -2], [1, -1, -2]]
    tree = bsp.PartitionTree([wall, *SQUARE], "first")
    assert tree.fragments.source.tolist().count(1) == 2
    picture = bsp.picture(tree, camera=TOP, size=(80, 80))
    # Each side of the square is 40 pixels long; the wall is a line of 80, half of it below.
    lengths = np.abs(picture.painting.lines[:, 1] - picture.painting.lines[:, 0]).sum(axis=1)
    middle = np.abs(picture.painting.lines[:, :, 0] - 40).max(axis=1) < 1e-9
    assert lengths[~middle].sum() == pytest.approx(160)
    assert not (np.abs(picture.painting.lines[middle][:, :, 1] - 40) < 19).any()


def test_hidden_lines_are_not_drawn() -> None:
    above = [[[-1, 0.5, 1], [1, 0.5, 1], [1, 1.5, 1], [-1, 1.5, 1]]]
    picture = bsp.picture(
        bsp.PartitionTree(SQUARE + above), camera=TOP, size=(80, 80), style="hidden"
    )
    # 160 for the outline below, 120 for the one above, less what that hides: 20 pixels.
    assert total(picture.painting.lines) == pytest.approx(160 + 120 - 20, abs=0.1)
    through = bsp.picture(
        bsp.PartitionTree(SQUARE + above), camera=TOP, size=(80, 80), style="edges"
    )
    assert total(through.painting.lines) == pytest.approx(160 + 120)
    assert through.painting.fills is None
    assert "fill=" not in through.svg.split("<rect")[1].split("/>", 1)[1]


def test_an_edge_exactly_below_a_cut_is_hidden() -> None:
    wall = [[1, -1, 1], [1, 3, 1], [1, 3, 2], [1, -1, 2]]
    low = [[1, 0.5, -1], [1, 1.5, -1], [1.5, 1.5, -1], [1.5, 0.5, -1]]
    tree = bsp.PartitionTree([wall, *SQUARE, low], "first")
    assert tree.fragments.source.tolist().count(1) == 2
    lines = bsp.picture(tree, camera=TOP, size=(80, 80)).painting.lines
    inside = (np.abs(lines - 40) < 19).all(axis=(1, 2))
    # Of the wall, which is in front of everything, nothing but a line is seen.
    assert (np.abs(lines[inside][:, :, 0] - 40) < 1e-9).all()


def test_edges_of_a_cube() -> None:
    cube = shapes.cube()
    looks: dict[str, Any] = {"view": "front", "size": (100, 100)}
    outline = bsp.picture(cube, **looks).painting.lines
    with_diagonal = bsp.picture(cube, edges="all", **looks).painting.lines
    none = bsp.picture(cube, edges="none", **looks).painting
    assert total(outline) == pytest.approx(4 * 92)
    assert total(with_diagonal) == pytest.approx((4 + 2 * 2**0.5) * 92)
    assert len(none.lines) == 0 and not none.polygons.marked.any()


def test_smooth_surfaces_show_creases_and_contours_only() -> None:
    tube = b.cylinder(h=4, r=1, segments=48)
    lines = bsp.picture(tube, "front", size=(100, 100)).painting.lines
    # The rims are 46 wide and the contours 92 high: all seen from the front is their rectangle.
    assert total(lines) == pytest.approx(2 * 92 + 2 * 46, rel=1e-2)
    every = bsp.picture(tube, "front", size=(100, 100), crease=5).painting.lines
    assert total(every) > 2 * total(lines)


def test_too_many_edges_are_painted_with_their_polygons(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = bsp.picture(shapes.icosphere(2), edges="all", size=(120, 120))
    monkeypatch.setattr("bspcsg.bsp.painting.hidden_lines._MAX_NEAR_PAIRS", 10)
    simple = bsp.picture(shapes.icosphere(2), edges="all", size=(120, 120))
    assert len(simple.painting.lines) == 0 and simple.painting.polygons.marked.any()
    assert len(whole.painting.lines) and not whole.painting.polygons.marked.any()
    difference = np.abs(pixels(whole).astype(int) - pixels(simple)).mean()
    assert difference < 6
    assert simple.svg.count('class="e"') > 1


def test_facets_of_one_plane_and_colour_are_one_path() -> None:
    picture = bsp.picture(shapes.cube(), "front", size=(100, 100))
    paths = re.findall(r'<path fill="#\w+" stroke="#\w+" d="([^"]*)"', picture.svg)
    assert len(paths) == 1
    assert len(re.findall(r"-?\d+,-?\d+", paths[0])) == 4


def test_colours_of_facets() -> None:
    two = [SQUARE[0], [[4, 0, 0], [6, 0, 0], [6, 2, 0], [4, 2, 0]]]
    tree = bsp.PartitionTree(two)
    for colors in (["#f00", "#0000ff"], [(1, 0, 0), (0, 0, 1)]):
        seen = pixels(bsp.picture(tree, "top", size=(60, 30), colors=colors, samples=1))
        assert seen[15, 10, 0] > 0 == seen[15, 10, 2]
        assert seen[15, 50, 2] > 0 == seen[15, 50, 0]
    one = bsp.picture(tree, colors=(0.5, 0.25, 1)).painting.fills
    assert one is not None and len(np.unique(one, axis=0)) == 1


def test_hidden_line_pictures_are_black_and_white() -> None:
    picture = bsp.picture(shapes.octahedron(), style="hidden", colors="#f00")
    assert picture.painting.fills is not None and (picture.painting.fills == 255).all()


def test_light_comes_from_above() -> None:
    box = bsp.picture(shapes.cube()).painting
    assert box.fills is not None
    brightness = {s: int(f.sum()) for s, f in zip(box.source.tolist(), box.fills, strict=True)}
    assert len(set(brightness.values())) == 3


# Where the eye is


def test_an_eye_in_a_facets_plane_does_not_see_it() -> None:
    camera = bsp.Camera.perspective((5, 1, 0), (0, 1, 0))
    picture = bsp.picture(bsp.PartitionTree(SQUARE), camera=camera, size=(40, 40), edges="none")
    areas = np.abs(picture.painting.polygons.corners[:, 1] - 20)
    assert areas.max(initial=0) < 1e-9


def test_facets_that_reach_behind_the_eye_are_clipped() -> None:
    floor = [[[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]]]
    camera = bsp.Camera.perspective((0, 0, 1), (0, 5, 1), field_of_view=60)
    picture = bsp.picture(bsp.PartitionTree(floor), camera=camera, size=(60, 60), edges="none")
    seen = pixels(picture) != 255
    assert seen[40:].any(axis=2).all()
    assert not seen[:28].any()
    assert np.abs(picture.painting.polygons.corners - 30).max() < 40


def test_what_is_behind_the_eye_is_not_seen() -> None:
    camera = bsp.Camera.perspective((1, 1, 5), (1, 1, 9))
    assert len(bsp.picture(bsp.PartitionTree(SQUARE), camera=camera).painting.source) == 0


def test_an_eye_inside_sees_the_inside() -> None:
    camera = bsp.Camera.perspective((0.5, 0.5, 0.5), (1, 0.5, 0.5))
    seen = pixels(bsp.picture(shapes.cube(), camera=camera, size=(30, 30), edges="none"))
    assert (seen != 255).any(axis=2).all()
    culled = bsp.picture(shapes.cube(), camera=camera, cull=True)
    assert len(culled.painting.source) == 0


def test_an_inside_out_mesh_is_not_culled() -> None:
    vertices, faces = shapes.cube()
    picture = bsp.picture((vertices, faces[:, ::-1]), "front", edges="none")
    assert len(set(picture.painting.source.tolist())) > 2


@pytest.mark.parametrize(
    "scene",
    [
        bsp.PartitionTree(np.zeros((0, 3, 3))),
        (np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)),
        (np.zeros((3, 3)), np.array([[0, 1, 2]])),
    ],
)
@pytest.mark.parametrize("style", ["shaded", "hidden", "edges"])
def test_an_empty_scene_is_background(scene: Any, style: Any) -> None:
    picture = bsp.picture(scene, size=(20, 10), style=style)
    assert (pixels(picture) == 255).all()
    assert "<path" not in picture.svg


def test_the_smallest_picture() -> None:
    assert pixels(bsp.picture(shapes.cube(), size=(1, 1))).shape == (1, 1, 3)


def test_faces_without_area_keep_the_numbers_of_the_others() -> None:
    vertices, faces = shapes.cube()
    with_flat = np.vstack([[[0, 0, 1]], faces])
    colors = np.vstack([[[1, 0, 0]], np.tile([0, 0, 1], (len(faces), 1))])
    fills = bsp.picture((vertices, with_flat), colors=colors).painting.fills
    assert fills is not None and (fills[:, 0] == 0).all()


# Files


def test_files(tmp_path: Path) -> None:
    picture = bsp.picture(shapes.octahedron(), size=(64, 48))
    picture.save(tmp_path / "a.svg")
    picture.save(str(tmp_path / "a.PNG"))
    root = ElementTree.parse(tmp_path / "a.svg").getroot()
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    assert (root.get("width"), root.get("height")) == ("64", "48")
    with Image.open(tmp_path / "a.PNG") as image:
        assert image.size == (64, 48)
    assert picture._repr_svg_() == picture.svg and picture._repr_png_() is None
    large = bsp.picture(shapes.icosphere(5), size=(64, 48))
    assert large._repr_png_() == large.png and large._repr_svg_() is None
    assert repr(picture).startswith("Picture(64 x 48, ")


def test_pictures_are_the_same_each_time() -> None:
    mesh = shapes.icosphere(2)
    first, second = (bsp.picture(mesh, size=(90, 90)) for _ in range(2))
    assert first.svg == second.svg and first.png == second.png


def test_other_endings_are_refused(tmp_path: Path) -> None:
    picture = bsp.picture(shapes.octahedron())
    for name in ("a.jpg", "a"):
        with pytest.raises(FormatError, match=r"\.svg or \.png"):
            picture.save(tmp_path / name)


def test_svg_needs_no_pillow(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without(name: str, *rest: Any, **more: Any) -> Any:
        if name.startswith("PIL"):
            raise ImportError(name)
        return real(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", without)
    picture = bsp.picture(shapes.octahedron())
    assert picture.svg
    with pytest.raises(BspcsgError, match=r"pip install pillow"):
        _ = picture.png


# Refused


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"size": (0, 10)}, "width"),
        ({"size": (10, 2.5)}, "height"),
        ({"size": 10}, "pair .width, height."),
        ({"size": (10, 20000)}, "at most"),
        ({"style": "wire"}, "style"),
        ({"edges": "some"}, "edges"),
        ({"view": "above"}, "view"),
        ({"camera": "above"}, "camera"),
        ({"crease": float("nan")}, "crease"),
        ({"colors": "blue-ish"}, "colors"),
        ({"colors": [(1, 0, 0)] * 3}, "shape"),
        ({"colors": ["#fff"] * 3}, "12 colours"),
        ({"colors": (0.0, 2, 0)}, "0 to 1"),
        ({"background": "#12345"}, "background"),
        ({"line_width": 0}, "line_width"),
        ({"samples": 0}, "samples"),
    ],
)
def test_refused(change: dict[str, Any], text: str) -> None:
    with pytest.raises(InvalidMeshError, match=text):
        bsp.picture(shapes.cube(), **change)


@pytest.mark.parametrize("camera", [None, TOP, bsp.Camera.perspective((5, 5, 5), (0, 0, 0))])
def test_coordinates_that_are_no_places(camera: bsp.Camera | None) -> None:
    vertices, faces = shapes.cube()
    for bad in (float("nan"), float("inf")):
        broken = vertices.copy()
        broken[faces[3, 0]] = bad
        with pytest.raises(InvalidMeshError, match="finite") as caught:
            bsp.picture((broken, faces), camera=camera)
        assert 3 in caught.value.where
    with pytest.raises(LimitError, match="scale"):
        bsp.picture((vertices * 1e200, faces), camera=camera)


@pytest.mark.parametrize("scale", [1e-12, 1e-6, 1e9, 1e20])
def test_the_size_of_a_scene_makes_no_difference(scale: float) -> None:
    vertices, faces = shapes.octahedron()
    unit, scaled = (bsp.picture((vertices * s, faces), size=(60, 50)) for s in (1, scale))
    assert np.abs(pixels(unit).astype(int) - pixels(scaled)).mean() < 1


def test_only_facets_in_space() -> None:
    with pytest.raises(InvalidMeshError, match="panorama"):
        bsp.picture(bsp.PartitionTree([[[0, 0], [1, 0]]]))


def test_too_many_samples_are_refused() -> None:
    picture = bsp.picture(shapes.cube(), size=(16000, 16000), samples=4)
    with pytest.raises(LimitError, match="samples"):
        _ = picture.png


@pytest.mark.deep
def test_a_hundred_thousand_triangles_take_less_than_five_seconds() -> None:
    vertices, faces = shapes.icosphere(6)
    x, y, z = vertices.T
    bumpy = vertices * (1 + 0.15 * np.sin(5 * x) * np.cos(7 * y) + 0.1 * np.sin(9 * z))[:, None]
    ball = shapes.icosphere(5)
    both = np.vstack([bumpy, ball[0] + [2, 0, 0]]), np.vstack([faces, ball[1] + len(bumpy)])
    assert len(both[1]) > 100_000
    start = time.process_time()
    assert len(bsp.picture(both).png) > 10_000
    assert time.process_time() - start < 5


# Very many triangles

BOTH_WAYS: dict[str, tuple[Any, dict[str, Any]]] = {
    "a cube with a hole": ((b.cube(4, center=True) - b.sphere(2.4)).rotate((10, 20, 30)), {}),
    "in perspective": (
        b.torus(3, 1),
        {"camera": bsp.Camera.perspective((9, 6, 5), (0, 0, 0)), "background": None},
    ),
    "hidden lines": (b.cylinder(4, 2) - b.cylinder(9, 1, center=True), {"style": "hidden"}),
    "all edges": (b.cylinder(4, 2, segments=9), {"edges": "all", "colors": "orange"}),
    "no edges": (b.sphere(2), {"edges": "none", "background": "black", "samples": 2}),
    "both sides": (b.cube(3).to_mesh(), {"cull": False, "view": "front"}),
    "a part of it": (b.cube(3), {"camera": bsp.Camera.orthographic((1, 2, -3), scale=1)}),
}


def by_buffer(monkeypatch: pytest.MonkeyPatch, scene: Any, **looks: Any) -> bsp.Picture:
    """Return a picture made with the z-buffer, as for very large meshes."""
    with monkeypatch.context() as patch:
        patch.setattr(painting_picture, "_MAX_TRIANGLES_ORDERED", 0)
        return bsp.picture(scene, **looks)


# Found: a picture of 1.3 million triangles took 47 seconds.
@pytest.mark.parametrize("name", BOTH_WAYS)
def test_a_buffer_shows_what_the_painter_shows(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene, given = BOTH_WAYS[name]
    looks = {"size": (400, 300), **given}
    large, small = by_buffer(monkeypatch, scene, **looks), bsp.picture(scene, **looks)
    seen, expected = pixels(large).astype(int), pixels(small).astype(int)
    assert seen.shape == expected.shape
    gaps = np.abs(seen - expected).max(axis=2)
    assert gaps.mean() < 2.5 and (gaps > 60).mean() < 0.015
    assert large.svg == small.svg and "polygons" in repr(large)


def test_open_and_crossing_triangles_are_seen_as_they_lie(monkeypatch: pytest.MonkeyPatch) -> None:
    vertices = np.array([(0, 0, 0), (4, 0, 4), (0, 4, 0), (0, 0, 4), (4, 0, 0), (0, 4, 4)], float)
    faces = np.array([(0, 1, 2), (3, 4, 5)])
    colors = [(1.0, 0, 0), (0, 1.0, 0)]
    looks: dict[str, Any] = {"view": "top", "size": (400, 400), "edges": "none"}
    looks["colors"] = colors
    seen = pixels(by_buffer(monkeypatch, (vertices, faces), **looks))
    expected = pixels(bsp.picture((vertices, faces), **looks))
    differ = (np.abs(seen.astype(int) - expected).max(axis=2) > 60).mean()
    assert differ < 0.02
    assert (seen[..., 0] > seen[..., 1] + 50).any() and (seen[..., 1] > seen[..., 0] + 50).any()


def test_no_sample_between_triangles_is_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    ball = b.sphere(1, segments=90).rotate((3, 5, 7))
    looks: dict[str, Any] = {"edges": "none", "background": "black", "samples": 1}
    seen = pixels(by_buffer(monkeypatch, ball, size=(300, 300), **looks)).max(axis=2) > 0
    rows = [np.flatnonzero(row) for row in seen if row.any()]
    assert len(rows) > 200 and all(len(row) == row[-1] - row[0] + 1 for row in rows)


def test_points_behind_the_eye_are_left_to_the_painter(monkeypatch: pytest.MonkeyPatch) -> None:
    inside = bsp.Camera.perspective((0.1, 0.2, 0.3), (1, 0, 0))
    looks: dict[str, Any] = {"camera": inside, "size": (80, 60)}
    room = b.cube(2, center=True)
    assert by_buffer(monkeypatch, room, **looks).png == bsp.picture(room, **looks).png


def test_large_scenes_refuse_what_small_ones_do(monkeypatch: pytest.MonkeyPatch) -> None:
    for given in ({"samples": 0}, {"line_width": -1}, {"crease": "x"}, {"colors": "nothing"}):
        with pytest.raises(InvalidMeshError):
            by_buffer(monkeypatch, b.cube(1), **given)
    with pytest.raises(LimitError, match="fewer samples"):
        _ = by_buffer(monkeypatch, b.cube(1), size=(16000, 16000)).png


@pytest.mark.deep
def test_a_million_triangles_take_seconds() -> None:
    ball = b.sphere(1, segments=1140).to_mesh()
    began = time.process_time()
    assert len(bsp.picture(ball).png) > 1000 and len(ball.faces) > 1_290_000
    assert time.process_time() - began < 5
