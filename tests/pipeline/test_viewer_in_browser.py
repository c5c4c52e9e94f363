"""The viewer of a model works in a real browser."""

import base64
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from selenium.webdriver.common.keys import Keys

import bspcsg as b
from bspcsg.io import read
from bspcsg.report.viewer.landmark import Landmark
from bspcsg.report.viewer.layer import Layer
from bspcsg.report.viewer.layer_making import (
    layers_of_file,
    layers_of_solid,
    with_distinct_colours,
    with_thickness,
)
from bspcsg.report.viewer.paint import Labels
from bspcsg.report.viewer.view_page import view_page
from support.browser import Browser
from support.shapes import icosphere

_DRAWN = "document.querySelector('.stage[data-drawn]')"


@pytest.fixture(scope="module")
def part(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the page of a plate with a hole, and a ball beside it."""
    plate = b.box((8, 6, 2)) - b.cylinder(h=4, r=1, segments=32).translate(4, 3, -1)
    ball = b.sphere(r=1, segments=16).translate(12, 3, 1)
    layers = [*layers_of_solid(plate, "plate"), *layers_of_solid(ball, "ball")]
    layers = [with_thickness(layer) for layer in with_distinct_colours(layers)]
    place = Landmark("the hole", np.array([4.0, 3.0, 2.0]), 1.0)
    page = tmp_path_factory.mktemp("view") / "part.html"
    text = view_page(layers, "plate & ball", unit="mm", landmarks=[place])
    page.write_text(text, encoding="utf-8")
    return page


@pytest.fixture
def opened(browser: Browser, part: Path) -> Browser:
    browser.open(part)
    browser.wait(_DRAWN)
    browser.run("window.view = document.querySelector('.stage').view")
    return browser


def _looks(browser: Browser) -> "np.ndarray[Any, Any]":
    return browser.pixels("canvas").astype(int)


def _change(before: "np.ndarray[Any, Any]", after: "np.ndarray[Any, Any]") -> float:
    return float((np.abs(before - after).max(axis=2) > 12).mean())


def _point(browser: Browser, *place: float) -> list[float]:
    """Return the position on the canvas of a point of the model."""
    script = """
        // A picture that is still to come would move the camera.
        view.render();
        const { low, high, longest } = view.model;
        const at = arguments[0].map((x, i) => ((x - (low[i] + high[i]) / 2) * 2) / longest);
        return view.measure.onCanvas(view.eye.controls.target.clone().set(...at)).slice(0, 2);
    """
    return [float(x) for x in browser.run(script, list(place))]


def _measured(browser: Browser, kind: str, *places: tuple[float, float, float]) -> str:
    browser.choose("Measure", kind)
    for place in places:
        browser.press("canvas", *_point(browser, *place))
    return browser.texts(".told")[0]


def test_distances_angles_and_radii(opened: Browser) -> None:
    told = _measured(opened, "distance", (8, 0, 2), (8, 6, 2))
    assert told == "Distance 6 mm · Δx 0 mm, Δy 6 mm, Δz 0 mm"
    corner = _measured(opened, "angle", (0, 0, 2), (8, 0, 2), (8, 6, 2))
    assert corner == "Angle 90°"
    round_ = [(4 + np.cos(a), 3 + np.sin(a), 2.0) for a in (0, np.pi / 2, np.pi)]
    told = _measured(opened, "radius", *round_)
    assert told == "Radius 1 mm · diameter 2 mm · center (4, 3, 2)"
    opened.type("canvas", Keys.ESCAPE)
    assert opened.texts(".told")[0].startswith("Click three points")
    assert opened.errors() == []


def test_points_are_taken_from_the_keyboard(opened: Browser) -> None:
    opened.type("canvas", "6", "m")
    assert opened.texts(".told") == ["Click two points."]
    opened.type("canvas", Keys.ENTER)
    assert opened.texts(".told")[0].startswith("1 of 2: (")
    opened.type("canvas", Keys.SHIFT, Keys.LEFT, Keys.NULL, Keys.ENTER)
    assert opened.texts(".told")[0].startswith("Distance ")


def _eye(browser: Browser) -> "tuple[np.ndarray[Any, Any], float, np.ndarray[Any, Any]]":
    """Return the direction and the distance of the eye, and its target."""
    arm, target = browser.run(
        "return [view.eye.arm.toArray(), view.eye.controls.target.toArray()]",
    )
    distance = float(np.linalg.norm(arm))
    return np.array(arm) / distance, distance, np.array(target)


def test_mouse_and_fingers_turn_zoom_and_move(opened: Browser) -> None:
    x, y = opened.run(
        "const box = view.canvas.getBoundingClientRect();"
        "return [box.left + box.width / 2, box.top + box.height / 2]"
    )
    home = _eye(opened)

    def is_changed(now: Any) -> list[bool]:
        found = [
            np.abs(now[0] - home[0]).max() > 0.05,
            abs(now[1] / home[1] - 1) > 0.05,
            np.abs(now[2] - home[2]).max() > 0.02,
        ]
        opened.press_button("reset")
        return found

    turned, zoomed, moved = [True, False, False], [False, True, False], [False, False, True]
    path = [(x, y), (x + 20, y), (x + 60, y), (x + 60, y)]
    opened.drag(*path)
    assert is_changed(_eye(opened)) == turned
    opened.drag(*path, button="right")
    assert is_changed(_eye(opened)) == moved
    opened.wheel(x, y, 200)
    opened.wait(f"Math.abs(view.eye.arm.length() / {home[1]} - 1) > 0.05")
    assert is_changed(_eye(opened)) == zoomed
    opened.touch([(x, y)], [(x + 30, y)], [(x + 70, y)])
    assert is_changed(_eye(opened)) == turned
    # Two fingers zoom and move at once.
    opened.touch(*([(x - d, y), (x + d, y)] for d in (30, 50, 90)))
    assert is_changed(_eye(opened))[:2] == zoomed[:2]
    opened.touch(*([(x + d - 30, y), (x + d + 30, y)] for d in (0, 20, 60)))
    assert is_changed(_eye(opened))[::2] == moved[::2]
    assert opened.errors() == []


def test_projections_and_sides(opened: Browser) -> None:
    first = _looks(opened)
    opened.type("canvas", "p")
    assert opened.run("return view.eye.isParallel") and _change(first, _looks(opened)) > 0.01
    opened.choose("View from", "front")
    left, right = _point(opened, 0, 0, 0), _point(opened, 8, 0, 0)
    far = _point(opened, 0, 6, 0)
    assert left[1] == pytest.approx(right[1], abs=0.01) and far == pytest.approx(left, abs=0.01)
    opened.type("canvas", "p", Keys.HOME)
    assert _change(first, _looks(opened)) < 0.02


@pytest.mark.parametrize("keys", ["", "p"], ids=["perspective", "parallel"])
def test_the_model_fills_the_picture_from_every_side(opened: Browser, keys: str) -> None:
    for key in ("Home", *keys):
        opened.type("canvas", getattr(Keys, key.upper(), key))
    sides = ("iso", "front", "back", "left", "right", "top", "bottom")
    for side in sides:
        reached = opened.run(
            "view.look(arguments[0]); view.eye.enclose();"
            "const { camera } = view.eye; camera.updateMatrixWorld();"
            "const reach = [0, 0]; const point = view.eye.arm;"
            "for (const { positions } of view.model.layers)"
            " for (let at = 0; at < positions.length; at += 3) {"
            "  point.fromArray(positions, at).project(camera);"
            "  reach[0] = Math.max(reach[0], Math.abs(point.x));"
            "  reach[1] = Math.max(reach[1], Math.abs(point.y));"
            " }"
            "return reach",
            side,
        )
        assert max(reached) == pytest.approx(1 / 1.08, abs=0.002), side
    assert opened.errors() == []


def test_shading_follows_the_angle(opened: Browser) -> None:
    opened.choose("Edges", "none")
    smooth = _looks(opened)
    opened.slide("smooth up to", 0)
    opened.wait("view.settings.crease === 0")
    faceted = _looks(opened)
    assert _change(smooth, faceted) > 0.0004
    counts = []
    for crease in (0, 30, 180):
        opened.run("return view.dress({ crease: arguments[0] })", crease)
        counts.append(opened.run("return view.layers[1].fine.geometry.attributes.position.count"))
    # The ball's corners are one each if smooth; the plate's edges are sharp below 90 degrees.
    vertices = opened.run("return view.layers[1].given.vertices")
    assert counts == [vertices] * 3
    opened.run("return view.dress({ crease: 30 })")
    shown = opened.run("return view.layers[0].fine.geometry.attributes.position.count")
    assert shown > opened.run("return view.layers[0].given.vertices")


def test_parts_move_apart_and_let_through(opened: Browser) -> None:
    first = _looks(opened)
    before = _point(opened, 12, 3, 1)
    opened.slide("opacity", 30)
    seen = _looks(opened)
    assert _change(first, seen) > 0.02
    opened.slide("opacity", 100)
    assert _change(first, _looks(opened)) < 0.001
    opened.slide("explode", 50)
    assert _change(first, _looks(opened)) > 0.02
    moved = opened.run("return view.layers[1].group.position.x")
    assert moved > 0.3 and before == pytest.approx(_point(opened, 12, 3, 1), abs=30)
    assert opened.errors() == []


def test_colours_say_what_they_mean(opened: Browser) -> None:
    plain = _looks(opened)
    opened.choose("Colours", "origin")
    by_origin = _looks(opened)
    assert _change(plain, by_origin) > 0.003
    assert opened.texts(".legend > span") == [
        "operand 1: 12 triangles",
        "operand 2: 124 triangles",
    ]
    opened.choose("Colours", "thickness")
    assert _change(by_origin, _looks(opened)) > 0.02
    assert opened.texts(".legend > span")[0] == "thickness"
    opened.choose("Colours", "")
    assert _change(plain, _looks(opened)) < 0.001 and opened.texts(".legend > span") == []


def test_lines_alone_and_all_edges(opened: Browser) -> None:
    first = _looks(opened)
    opened.type("canvas", "e")
    every = _looks(opened)
    opened.type("canvas", "e")
    wire = _looks(opened)
    assert _change(first, every) > 0.003 and _change(every, wire) > 0.1


def test_a_section_from_the_other_side(opened: Browser) -> None:
    opened.choose("Section", "0")
    one = _looks(opened)
    opened.press_button("flip")
    assert _change(one, _looks(opened)) > 0.05


# Found: the canvas stayed light in dark mode.
def test_the_canvas_follows_the_theme_until_it_is_chosen(opened: Browser) -> None:
    light = _looks(opened)
    opened.prefer("dark")
    dark = _looks(opened)
    assert light[60, 60].min() > 200 and dark[60, 60].max() < 80
    opened.run("document.querySelector('.more').open = true")
    opened.press_button("dark canvas")
    opened.prefer("light")
    opened.prefer("dark")
    assert _looks(opened)[60, 60].min() > 200
    opened.prefer("light")


def test_a_picture_is_saved(opened: Browser) -> None:
    script = """
        const done = arguments[0];
        view.picture("#ffffff").then(async (blob) => {
          const reader = new FileReader();
          reader.onload = () => done([blob.type, reader.result]);
          reader.readAsDataURL(blob);
        });
    """
    kind, address = opened.run_later(script)
    data = base64.b64decode(address.partition(",")[2])
    with Image.open(io.BytesIO(data)) as image:
        pixels = np.asarray(image.convert("RGB")).astype(int)
    assert kind == "image/png" and (pixels[2, 2] == 255).all()
    assert (np.ptp(pixels, axis=2) > 40).mean() > 0.02
    opened.run("HTMLAnchorElement.prototype.click = function () { window.saved = this.download; }")
    opened.type("canvas", "s")
    opened.wait("window.saved")
    assert opened.run("return window.saved") == "plate-ball.png"


def test_places_are_looked_at(opened: Browser) -> None:
    first = _looks(opened)
    opened.choose("Places", "0")
    assert _change(first, _looks(opened)) > 0.1
    middle = opened.run("return [view.host.clientWidth / 2, view.host.clientHeight / 2]")
    assert _point(opened, 4, 3, 2) == pytest.approx(middle, abs=1)
    assert opened.run("return document.querySelectorAll('.overlay .ring').length") == 1


def test_the_sheet_hides_nothing_beside_it(browser: Browser, part: Path) -> None:
    browser.device({"width": 900, "height": 900, "deviceScaleFactor": 1, "mobile": False})
    browser.open(part)
    browser.wait(_DRAWN)
    closed = _looks(browser)
    browser.run("document.querySelector('.more').open = true")
    top = browser.run(
        "const [sheet, canvas] = ['.sheet', 'canvas'].map("
        "name => document.querySelector(name).getBoundingClientRect().top);"
        "return Math.floor(sheet - canvas) - 30"
    )
    above, whole = (_change(closed[:end], _looks(browser)[:end]) for end in (top, None))
    browser.device(None)
    # The sheet's shadow is all that reaches up there.
    assert top > 200 and above < 0.001 < 0.1 < whole


def test_every_control_has_a_name(opened: Browser) -> None:
    opened.run("document.querySelector('.more').open = true")
    nameless = opened.run(
        "return [...document.querySelectorAll('button, select, input, summary, canvas')]"
        ".filter(e => !(e.ariaLabel || e.textContent.trim() || e.closest('label')))"
        ".map(e => e.outerHTML)"
    )
    assert nameless == []
    assert opened.run("return document.querySelectorAll('main').length") == 1


def _checkered() -> bytes:
    """Return a PNG of coloured squares, each with a darker corner."""
    squares = np.random.default_rng(1).integers(60, 255, (8, 8, 3), dtype=np.uint8)
    pixels = squares.repeat(16, axis=0).repeat(16, axis=1)
    pixels.reshape(8, 16, 8, 16, 3)[:, 10:, :, :6] //= 3
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "PNG")
    return stream.getvalue()


def _textured_ball() -> b.Solid:
    vertices, faces = icosphere(2)
    x, y, z = vertices[faces].transpose(2, 0, 1)
    around = np.arctan2(y, x) / (2 * np.pi) + 0.5
    # Where a face reaches over the seam, some of its corners are a turn further.
    around += (around < 0.5) & (np.ptp(around, axis=1) > 0.5)[:, None]
    uv = np.stack([2 * around, np.arcsin(np.clip(z, -1, 1)) / np.pi + 0.5], axis=-1)
    return b.Solid(
        vertices,
        faces,
        corner_attributes={"uv": uv.astype(np.float32)},
        face_attributes={"material": np.full(len(faces), "squares")},
        materials={"squares": b.Material((1, 1, 1, 1), _checkered())},
    )


def test_a_textured_file_cut_in_two_looks_the_same(browser: Browser, tmp_path: Path) -> None:
    _textured_ball().save(tmp_path / "ball.glb")
    whole = b.Solid.load(tmp_path / "ball.glb")
    halves = whole.split((1, -0.3, 0.2), 0.05)
    for name, half in zip("ab", halves, strict=True):
        half.save(tmp_path / f"{name}.glb")
    looks = []
    for names in (["ball"], ["a", "b"], ["a"]):
        raws = [read(tmp_path / f"{name}.glb") for name in names]
        layers = [layer for raw in raws for layer in layers_of_file(raw, "part")]
        page = tmp_path / "view.html"
        page.write_text(view_page(layers, "ball"), encoding="utf-8")
        browser.open(page)
        browser.wait(_DRAWN)
        browser.choose("Edges", "none")
        # Smooth normals would be those of one half along the cut.
        browser.run(
            "document.querySelector('.legend').hidden = true;"
            "return document.querySelector('.stage').view.dress({ crease: 0 })"
        )
        looks.append(_looks(browser))
    ball, together, alone = looks
    # Many colours, so a texture is to be seen; along the cut pixels are drawn of both.
    assert len({tuple(colour) for colour in (ball // 32).reshape(-1, 3).tolist()}) > 60
    assert np.abs(ball - together).mean() < 0.15 and _change(ball, together) < 0.004
    assert _change(ball, alone) > 0.05 and browser.errors() == []


def test_large_models_are_rough_while_they_move(browser: Browser, tmp_path: Path) -> None:
    vertices, faces = icosphere(6)
    paint = Labels("half", faces[:, 0] % 2, ["even", "odd"], ["#c02020", "#2020c0"])
    layer = Layer("ball", vertices, faces, paints=(paint,))
    page = tmp_path / "ball.html"
    page.write_text(view_page([layer], "ball"), encoding="utf-8")
    browser.open(page)
    browser.wait(_DRAWN)
    browser.run("window.view = document.querySelector('.stage').view")
    still = _looks(browser)
    # In one go, or it stands still in between.
    counts = browser.run(
        "view.pace.level = 2; view.eye.turn(0.1, 0); view.move(); view.render();"
        "const { rough, fine } = view.layers[0];"
        "return [rough.visible, fine.visible, rough.geometry.index.count / 3]"
    )
    assert counts[:2] == [True, False] and 1000 < counts[2] <= 20_000
    browser.wait("view.layers[0].fine.visible")
    browser.run("view.eye.turn(-0.1, 0); view.move()")
    browser.wait("!view.isMoving && view.layers[0].fine.visible")
    assert _change(still, _looks(browser)) < 0.002
    browser.choose("Colours", "half")
    roughly = "view.pace.level = 2; view.move(); view.render(); return view.layers[0].rough.visible"
    assert browser.run(roughly)
    assert browser.errors() == []


def test_the_time_of_pictures_says_how_a_view_moves(opened: Browser) -> None:
    """In one go, or the page's own pictures count, too."""
    levels = opened.run(
        """
        const { pace } = view;
        const after = (kind, times, count = 1) => {
          for (let i = 0; i < count; i += 1) pace[kind](times);
          return pace.level;
        };
        return [
          after("stood", 20), after("stood", 60), after("stood", 400),
          // One pause among quick pictures is no reason.
          after("moved", 20, 20), after("moved", 900), after("moved", 20, 20),
          after("moved", 45, 5), after("moved", 45, 5), after("moved", 45, 50),
          after("moved", 5, 10), after("moved", 5, 100),
          after("stood", 60), after("stood", 20),
        ];
        """
    )
    assert levels == [0, 1, 2, 2, 2, 2, 3, 4, 4, 3, 2, 2, 0]


def test_edges_are_smooth_where_that_is_not_too_slow(opened: Browser) -> None:
    """Pixels on the outline are drawn in part where there are several samples."""
    smooth, plain, coarse = opened.run(
        """
        const inPart = (level) => {
          Object.assign(view, { isMoving: true });
          view.pace.level = level;
          view.render();
          const copy = document.createElement("canvas");
          Object.assign(copy, { width: view.canvas.width, height: view.canvas.height });
          const drawn = copy.getContext("2d");
          drawn.drawImage(view.canvas, 0, 0);
          const { data } = drawn.getImageData(0, 0, copy.width, copy.height);
          const alphas = data.filter((_, at) => at % 4 === 3);
          const some = alphas.filter((alpha) => alpha > 0).length;
          return [copy.width, some, alphas.filter((alpha) => alpha > 0 && alpha < 255).length];
        };
        view.drawLines("none");
        return [0, 1, 4].map(inPart);
        """
    )
    assert smooth[0] == plain[0] and coarse[0] == plain[0] // 2
    assert 0 == plain[2] == coarse[2] < 100 < smooth[2] < smooth[1] / 10
    assert smooth[1] == pytest.approx(plain[1], rel=0.05) == pytest.approx(4 * coarse[1], rel=0.05)
