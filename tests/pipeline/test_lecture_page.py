"""The interactive lecture in a real browser: every control, by mouse, keyboard and touch."""

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from selenium.webdriver.common.keys import Keys

import bspcsg
from bspcsg.bsp import Intervals, PartitionTree, Region
from bspcsg.bsp.trees.analysis import shielding_distance
from bspcsg.report.lecture.page import CHAPTERS, SCRIPTS, lecture_page
from support.browser import Browser

_MAX_PAGE_BYTES = 2_000_000
_READY = "document.documentElement.dataset.ready === 'yes'"
_PHONE = {"width": 375, "height": 844, "deviceScaleFactor": 1, "mobile": True}


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("lecture") / "lecture.html"
    path.write_text(lecture_page(), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def browser(browser: Browser, page: Path) -> Browser:
    """Return the browser of all tests, with the lecture opened."""
    browser.open(page)
    browser.wait(_READY)
    return browser


def _tile(browser: Browser, figure: str, key: str) -> str:
    return browser.texts(f"#{figure} dd[data-key={key}]")[0]


def _press(browser: Browser, selector: str, *keys: str) -> None:
    """Send keys to the first element that matches a selector, also in SVG."""
    for key in keys:
        browser.run(
            "const e = document.querySelector(arguments[0]); e.focus();"
            "e.dispatchEvent(new KeyboardEvent('keydown', "
            "{key: arguments[1], bubbles: true, cancelable: true}))",
            selector,
            key,
        )


def _drag(browser: Browser, selector: str, by: tuple[int, int]) -> None:
    """Drag an element by an offset in pixels, with pointer events."""
    browser.run(
        "const e = document.querySelector(arguments[0]), [dx, dy] = arguments[1];"
        "e.scrollIntoView({block: 'center', behavior: 'instant'});"
        "const b = e.getBoundingClientRect(), x = b.left + b.width / 2, y = b.top + b.height / 2;"
        "e.setPointerCapture = () => {}; e.hasPointerCapture = () => true;"
        "const told = (kind, at) => e.dispatchEvent(new PointerEvent(kind, {pointerId: 1,"
        " clientX: at[0], clientY: at[1], bubbles: true, cancelable: true}));"
        "told('pointerdown', [x, y]); told('pointermove', [x + dx / 2, y + dy / 2]);"
        "told('pointermove', [x + dx, y + dy]); told('pointerup', [x + dx, y + dy]);",
        selector,
        list(by),
    )


def _core(browser: Browser, expression: str) -> Any:
    """Return the JSON result of an expression that calls the page's own core."""
    return json.loads(browser.run(f"return {expression}"))


def test_every_script_is_in_the_page() -> None:
    folder = Path(bspcsg.__file__).parent / "report" / "assets" / "lecture"
    written = {p.relative_to(folder).as_posix() for p in folder.rglob("*.js")} - {"core.js"}
    assert written == set(SCRIPTS)


def test_no_crossing_covers_the_number_of_a_segment(browser: Browser) -> None:
    places = browser.run(
        "const at = (kind) => [...document.querySelectorAll(`#fig-shield circle.${kind}`)]"
        ".map(e => [e.cx.baseVal.value, e.cy.baseVal.value]); return [at('crossing'), at('badge')]"
    )
    crossings, badges = (np.array(found) for found in places)
    assert len(crossings) == 4 and len(badges) == 8
    assert np.linalg.norm(crossings[:, None] - badges, axis=2).min() > 15


def test_the_names_of_edges_do_not_cover_each_other(browser: Browser) -> None:
    places = browser.run(
        "return [...document.querySelectorAll('#fig-merge circle.badge')]"
        ".map(e => [e.cx.baseVal.value, e.cy.baseVal.value])"
    )
    apart = np.linalg.norm(np.array(places)[:, None] - places, axis=2)
    assert len(places) == 9 and apart[~np.eye(9, dtype=bool)].min() > 18


def test_equal_costs_are_equally_good(browser: Browser) -> None:
    cells = browser.run(
        "return [...document.querySelectorAll('#fig-policies tbody tr')]"
        ".map(row => [row.lastChild.textContent, row.lastChild.className === 'best'])"
    )
    least = min(float(cost) for cost, _ in cells)
    assert [best for _, best in cells] == [float(cost) == least for cost, _ in cells]
    assert sum(best for _, best in cells) > 1


def test_few_divisions_do_the_work_of_a_whole_tree(browser: Browser) -> None:
    """Nodes and tests together: to visit one leaf and test all that is in it is no gain."""
    browser.click("#fig-adaptive .buttons button", 3)
    browser.click("#fig-adaptive .shoot-one")
    assert _tile(browser, "fig-adaptive", "mine") == "13.0"
    for _ in range(5):
        browser.click("#fig-adaptive .shoot-many")
    mine, other = (float(_tile(browser, "fig-adaptive", key)) for key in ("mine", "other"))
    assert 1 < mine < 1.2 * other
    assert int(_tile(browser, "fig-adaptive", "divisions")) < 12 / 2


# Found: the page said that the tree adapts, but did not show when that pays off.
def test_the_tree_that_organises_itself_pays_where_rays_go_one_way(browser: Browser) -> None:
    rows = browser.run(
        "return [...document.querySelectorAll('#fig-adaptive tbody tr')]"
        ".map(row => [...row.children].map(cell => cell.textContent))"
    )
    figures = {(row[0], row[1]): [float(text) for text in row[2:]] for row in rows}
    assert len(figures) == 4
    nodes, whole, _, _, last, still = figures["200", "one direction"]
    assert nodes < whole / 3 and last < still
    nodes, whole, first, ready, last, still = figures["200", "anywhere"]
    assert nodes > 0.8 * whole and first > 2 * ready and last > 0.9 * still


# Found: the button "Play" had the icon of fast forward, and "step" had the icon of "Play".
def test_icons_say_what_buttons_do(browser: Browser) -> None:
    bar = "#fig-autopartition .stepper"
    paths = browser.run(
        f"return [...document.querySelectorAll('{bar} button')].map(e => [e.title,"
        " [...e.querySelectorAll('path')].filter(p => p.checkVisibility()).map(p =>"
        " [p.getAttribute('d').split('M').length - 1, p.getAttribute('d').endsWith('z')])])"
    )
    shapes = dict(paths)
    assert shapes["Play"] == [[1, True]]
    assert shapes["Step back"] == shapes["Step forward"] == [[1, False]]
    assert shapes["First step"] == shapes["Last step"] == [[2, False]]
    browser.click(f"{bar} .player")
    still = f"document.querySelector('{bar} [data-when=still]').checkVisibility()"
    assert not browser.run(f"return {still}")
    browser.click(f"{bar} .player")
    assert browser.run(f"return {still}")


# Found: the last chapter was cut off at the usual width of a desktop.
def test_all_chapters_are_in_sight_on_a_desktop(browser: Browser) -> None:
    browser.device({"width": 1280, "height": 900, "deviceScaleFactor": 1, "mobile": False})
    try:
        for id_, _ in CHAPTERS:
            browser.run(f"document.getElementById('{id_}').scrollIntoView({{behavior: 'instant'}})")
            browser.wait(f"document.querySelector('nav a[aria-current]').hash === '#{id_}'")
            bar = "document.querySelector('nav ol')"
            assert browser.run(f"return {bar}.scrollWidth <= {bar}.clientWidth")
    finally:
        browser.device(None)


def test_each_chapter_has_three_exercises_with_answers(browser: Browser) -> None:
    for id_, _ in CHAPTERS:
        assert len(browser.texts(f"#{id_} .exercises > ol > li > p")) == 3
        answers = browser.run(
            f"return [...document.querySelectorAll('#{id_} .exercises details p')]"
            ".map(e => e.textContent)"
        )
        assert len(answers) == 3 and all(len(answer) > 50 for answer in answers)


def test_the_page_is_small_and_asks_for_nothing(browser: Browser, page: Path) -> None:
    assert page.stat().st_size < _MAX_PAGE_BYTES
    assert browser.requests() == [page.as_uri()] and browser.errors() == []
    assert not re.search(r'(?:src|href)="https?:', page.read_text(encoding="utf-8"))
    assert len(browser.texts("main > section")) == len(CHAPTERS)
    assert browser.texts("figure .say") == []


def test_every_figure_is_drawn(browser: Browser) -> None:
    empty = "return [...document.querySelectorAll('svg.room, svg.tree, svg.plot, svg.strip')]"
    assert browser.run(f"{empty}.filter(e => e.querySelectorAll('*').length < 3).length") == 0
    assert browser.run(f"{empty}.length") > 25


def test_every_button_can_be_pressed(browser: Browser, page: Path) -> None:
    count = browser.run("return document.querySelectorAll('figure button').length")
    assert count > 90
    browser.run(
        "for (const figure of document.querySelectorAll('figure'))"
        " for (let i = 0; i < figure.querySelectorAll('button').length; i += 1)"
        "  figure.querySelectorAll('button')[i].click();"
    )
    browser.run(
        "for (const e of document.querySelectorAll('figure input'))"
        " for (const value of [e.min, e.max]) {"
        "  e.value = value; e.dispatchEvent(new Event('input')); }"
    )
    assert browser.errors() == []
    assert not browser.run("return document.body.textContent.includes('NaN')")
    browser.open(page)
    browser.wait(_READY)


def test_every_knob_moves_by_keyboard_and_pointer(browser: Browser, page: Path) -> None:
    stuck = browser.run(
        "const stuck = [];"
        "for (const e of document.querySelectorAll('.handle')) {"
        "  const before = e.getAttribute('aria-valuetext');"
        "  for (const key of ['ArrowLeft', 'ArrowUp', 'ArrowRight', 'ArrowRight'])"
        "    e.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true}));"
        "  if (e.getAttribute('aria-valuetext') === before) stuck.push(e.ariaLabel);"
        "} return stuck"
    )
    assert stuck == [] and browser.errors() == []
    before = _tile(browser, "fig-hyperplane", "value")
    _drag(browser, "#fig-hyperplane .handle.eye", (30, 60))
    assert _tile(browser, "fig-hyperplane", "value") != before
    browser.open(page)
    browser.wait(_READY)


def test_everything_is_named_and_focus_is_seen(browser: Browser) -> None:
    nameless = browser.run(
        "return [...document.querySelectorAll('button, input, [tabindex]')].filter(e =>"
        " !(e.ariaLabel || e.textContent.trim() || e.closest('label')?.textContent.trim())).length"
    )
    assert nameless == 0
    browser.type("#fig-autopartition .forward", Keys.TAB)
    outline = "return getComputedStyle(document.activeElement).outlineStyle"
    assert browser.run(outline) == "solid"


def test_the_side_of_a_point(browser: Browser) -> None:
    assert _tile(browser, "fig-hyperplane", "side").startswith("minus")
    _press(browser, "#fig-hyperplane .handle.eye", *["ArrowDown"] * 22)
    assert _tile(browser, "fig-hyperplane", "side").startswith("plus")


def test_a_search_asks_as_many_cuts_as_its_path_has(browser: Browser) -> None:
    browser.click("#fig-search .buttons button", 1)
    assert _tile(browser, "fig-search", "depth") == "7"
    browser.click("#fig-search .buttons button", 0)
    assert _tile(browser, "fig-search", "depth") == "3"
    assert _tile(browser, "fig-search", "steps") == "3"


# Found: the page drew only the final tree.
def test_steps_go_to_and_fro_and_orders_change_the_tree(browser: Browser) -> None:
    def figure(key: str) -> int:
        return int(_tile(browser, "fig-autopartition", key))

    place = "#fig-autopartition .place"
    count = int(browser.texts(place)[0].split("/")[1])
    for _ in range(count):
        browser.click("#fig-autopartition .back")
    assert browser.texts(place) == [f"0 / {count}"] and figure("fragments") == figure("n")
    before = 0
    for step in range(1, count + 1):
        browser.click("#fig-autopartition .forward")
        assert browser.texts(place) == [f"{step} / {count}"]
        before = max(before, figure("fragments"))
    assert figure("fragments") == before == count and figure("nodes") == 2 * count + 1
    words = browser.texts("#fig-autopartition .step-words")
    chips = browser.texts("#fig-autopartition .chip")
    _press(browser, f"#fig-autopartition .chip[data-facet='{int(chips[2]) - 1}']", "ArrowLeft")
    moved = browser.texts("#fig-autopartition .chip")
    assert moved[1] == chips[2] and moved[2] == chips[1]
    browser.click("#fig-autopartition .chip", 4)
    assert browser.texts("#fig-autopartition .chip")[0] == moved[4] and words


_SEGMENTS = [[[60, 190], [104, 204]], [[158, 130], [166, 300]], [[214, 150], [206, 330]]]
_SEGMENTS += [[[262, 180], [286, 340]], [[40, 60], [230, 84]], [[330, 20], [200, 40]]]


def _flat(rows: Any) -> str:
    return f"new Float64Array({np.asarray(rows, dtype=float).ravel().tolist()})"


def _scene(segments: Any) -> str:
    offsets = list(range(0, 2 * len(segments) + 1, 2))
    room = _flat([0, 0, 420, 380])
    return (
        f"new wasm_bindgen.Autopartition(2, {_flat(segments)}, new Int32Array({offsets}), {room})"
    )


def test_the_core_in_the_page_makes_the_trees_of_the_library(browser: Browser) -> None:
    view = _core(browser, f"{_scene(_SEGMENTS)}.view()")
    tree = PartitionTree(_SEGMENTS, "first", pitch=-3)
    assert [node["pivot"] for node in view["nodes"]] == tree.arrays["cut"][:, 1].tolist()
    assert view["fragments"] == tree.stats().fragments and view["cuts"] == len(tree.splits)
    eye = (205.0, 196.5)
    order, _ = _core(browser, f"{_scene(_SEGMENTS)}.order({eye[0]}, {eye[1]}, 0)")
    assert order == tree.core.order([*eye, 0.0], False).tolist()


def test_shields_are_those_of_the_analysis(browser: Browser) -> None:
    for i in range(len(_SEGMENTS)):
        rows = _core(browser, f"{_scene(_SEGMENTS)}.shields({i})")
        found = [-1 if row is None else row[0] for row in rows]
        assert found == shielding_distance(np.array(_SEGMENTS), i).tolist()


def test_random_orders_keep_to_the_bound(browser: Browser) -> None:
    n, trials = len(_SEGMENTS), 3000
    found = _core(browser, f"{_scene(_SEGMENTS)}.orders({trials}, 3)")
    assert n <= np.mean(found["fragments"]) <= n + 2 * n * math.log(n)
    share = np.array(found["cuts"]).reshape(n, n) / trials
    for i in range(n):
        distance = shielding_distance(np.array(_SEGMENTS), i)
        bound = np.where(distance >= 0, 1 / (distance + 2.0), 0.0)
        # Five standard deviations of a share of so many trials.
        assert (share[i] <= bound + 5 * 0.5 / math.sqrt(trials)).all()
        assert (share[i][distance < 0] == 0).all()


def test_the_painter_follows_the_eye(browser: Browser) -> None:
    badges = "#fig-painter .badge-text"
    before = browser.texts(badges)
    _press(browser, "#fig-painter .handle.eye", *["ArrowUp"] * 14)
    assert sorted(browser.texts(badges)) == sorted(before)
    strokes = browser.run("return document.querySelectorAll('#fig-painter .stroke').length")
    browser.click("#fig-painter .back")
    fewer = browser.run("return document.querySelectorAll('#fig-painter .stroke').length")
    assert fewer < strokes and "fragment" in browser.texts("#fig-painter .step-words")[0]


def test_a_ray_costs_at_most_depth_times_leaves(browser: Browser) -> None:
    for key in ["ArrowUp", "ArrowRight", "ArrowDown", "ArrowDown"]:
        _press(browser, "#fig-ray .handle.aim", *[key] * 9)
        nodes, bound = (_tile(browser, "fig-ray", key) for key in ("nodes", "bound"))
        assert 0 < int(nodes) <= int(bound.split("=")[1])
        leaves = int(_tile(browser, "fig-ray", "leaves"))
        assert leaves == browser.run("return document.querySelectorAll('#fig-ray .stabbed').length")


def test_rules_differ_and_the_best_are_marked(browser: Browser) -> None:
    rows = browser.texts("#fig-policies tbody td.best")
    assert len(rows) >= 3
    browser.click("#fig-policies .choice button", 2)
    assert browser.texts("#fig-policies tbody td:nth-child(3)") == ["10"] * 5


def test_rays_grow_the_tree(browser: Browser) -> None:
    browser.click("#fig-adaptive .buttons button", 3)
    assert _tile(browser, "fig-adaptive", "rays") == "0"
    browser.click("#fig-adaptive .shoot-many")
    browser.click("#fig-adaptive .shoot-one")
    assert _tile(browser, "fig-adaptive", "rays") == "41"
    divided = int(_tile(browser, "fig-adaptive", "divisions"))
    assert divided > 0
    root = int(browser.texts("#fig-adaptive .tree .note")[-1])
    assert root == 41
    _drag(browser, "#fig-adaptive svg.room", (60, 20))
    assert int(_tile(browser, "fig-adaptive", "rays")) > 41


def _labels(view: dict[str, Any], low: float, high: float) -> list[tuple[float, float]]:
    """Return the intervals of the in-leaves of a 1D tree, joined where they touch."""
    inside = [node["region"] for node in view["nodes"] if node["label"] == "In"]
    ends: list[tuple[float, float]] = []
    for a, b in sorted(sorted(wall[0][0] for wall in region) for region in inside):
        if ends and ends[-1][1] == a:
            ends[-1] = (ends[-1][0], b)
        else:
            ends.append((a, b))
    assert all(low <= a < b <= high for a, b in ends)
    return ends


@pytest.mark.parametrize("operation", ["union", "intersection", "difference", "xor"])
def test_merges_are_those_of_the_library(browser: Browser, operation: str) -> None:
    first, second = [60.0, 180, 250, 330], [120.0, 290]
    found = _core(
        browser,
        f"wasm_bindgen.merge(1, {_flat(first)}, new Int32Array([0, 4]), {_flat(second)},"
        f" new Int32Array([0, 2]), '{operation}', {_flat([0, 420])})",
    )
    a, b = (Intervals(list(zip(x[::2], x[1::2], strict=True))) for x in (first, second))
    expected = {"union": a | b, "intersection": a & b, "difference": a - b, "xor": a ^ b}[operation]
    shown = _labels(found["result"], 0, 420)
    assert shown == [tuple(pair) for pair in expected.pairs.tolist()]


@pytest.mark.parametrize("operation", ["union", "intersection", "difference", "xor"])
def test_cells_of_a_merge_fill_the_region_of_the_library(browser: Browser, operation: str) -> None:
    first = [[60, 80], [270, 60], [290, 230], [150, 280]]
    second = [[180, 150], [370, 130], [340, 330], [240, 240], [160, 330]]
    found = _core(
        browser,
        f"wasm_bindgen.merge(2, {_flat(first)}, new Int32Array([0, 4]), {_flat(second)},"
        f" new Int32Array([0, 5]), '{operation}', {_flat([0, 0, 420, 380])})",
    )
    a, b = Region(first), Region(second)
    expected = {"union": a | b, "intersection": a & b, "difference": a - b, "xor": a ^ b}[operation]
    cells = [node["region"] for node in found["result"]["nodes"] if node["label"] == "In"]
    assert sum(map(_area, cells)) == pytest.approx(expected.area, rel=1e-9)


def _area(walls: list[list[list[float]]]) -> float:
    """Return the area of a region to the left of its walls."""
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in walls) / 2


def test_a_merge_is_stepped_through_with_its_cases(browser: Browser) -> None:
    count = int(browser.texts("#fig-merge .place")[0].split("/")[1])
    told = []
    browser.run("document.querySelector('#fig-merge .stepper button').click()")
    for _ in range(count):
        browser.run("document.querySelector('#fig-merge .forward').click()")
        told.append(browser.texts("#fig-merge .step-words")[0])
    kinds = {words.split()[0] for words in told}
    assert kinds == {"Pair", "Split", "Join"}
    assert any("mixed" in words for words in told) and any("one-sided" in words for words in told)
    pairs = int(_tile(browser, "fig-merge", "pairs"))
    assert pairs == sum(words.startswith("Pair") for words in told)
    before = _tile(browser, "fig-merge", "nodes")
    browser.click("#fig-merge .choice button", 1)
    assert _tile(browser, "fig-merge", "nodes") != before


def test_a_split_names_every_case(browser: Browser) -> None:
    count = int(browser.texts("#fig-split .place")[0].split("/")[1])
    told = set()
    for _ in range(count):
        told.add(re.findall(r"Case: ([\w-]+)", browser.texts("#fig-split .step-words")[0])[0])
        browser.run("document.querySelector('#fig-split .back').click()")
    assert {"leaf", "mixed", "one-sided"} <= told


def test_the_polygons_of_space_turn(browser: Browser) -> None:
    all_faces = "[...document.querySelectorAll('#fig-space .face')]"
    faces = f"return {all_faces}.map(e => e.getAttribute('points'))"
    before = browser.run(faces)
    _press(browser, "#fig-space .orbit", "ArrowLeft", "ArrowUp")
    assert browser.run(faces) != before and len(before) == int(
        _tile(browser, "fig-space", "fragments")
    )
    _press(browser, "#fig-solids .orbit", "ArrowLeft")
    assert int(_tile(browser, "fig-solids", "cells")) > 1 and browser.errors() == []


def test_a_phone_shows_it_all_without_scrolling_sideways(browser: Browser) -> None:
    browser.device(_PHONE)
    wide = "return document.documentElement.scrollWidth"
    assert browser.run(wide) <= _PHONE["width"]
    cut = browser.run(
        "return [...document.querySelectorAll('math[display=block], #fig-shield td')].filter(e =>"
        " e.scrollWidth > e.clientWidth + 1 || e.getBoundingClientRect().right > innerWidth)"
        ".map(e => e.textContent)"
    )
    assert cut == []
    small = browser.run(
        "return [...document.querySelectorAll('figure button')].filter(e =>"
        " e.offsetParent && e.getBoundingClientRect().height < 28).length"
    )
    assert small == 0
    browser.device(None)
