"""The HTML pages that the commands check and compare write."""

import json
import os
import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as Xml

import numpy as np
import pytest

import bspcsg as b
from bspcsg.io import RawMesh, write
from bspcsg.repair.defective_elements import defective_elements_of
from support.browser import Browser
from support.cli import Capture, put, ran
from support.shapes import cube, cuboid, joined


def models(page: str) -> list[dict[str, Any]]:
    """Return the models, as JSON values, that a page gives to its viewers."""
    text = Path(page).read_text(encoding="utf-8")
    found = re.findall(r'<script type="application/json" id="[a-z0-9-]*model">(.*?)</script>', text)
    return [json.loads(one) for one in found]


def model(page: str) -> dict[str, Any]:
    """Return the model of a page with one viewer."""
    (found,) = models(page)
    return found


def layers(page: str) -> dict[str, int]:
    """Return for each layer of a page the number of its triangles, or else of its segments."""
    return {one["name"]: one["triangles"] or one["segments"] for one in model(page)["layers"]}


def names(page: str) -> list[str]:
    return [place["name"] for place in model(page)["places"]]


def test_what_only_one_has_is_shown(folder: Path, capsys: Capture) -> None:
    put("b.off", cuboid((0, 0, 0), (2, 2, 3)))
    code, out, err = ran(capsys, "compare", "a.off", "b.off", "--html", "x.html")
    assert (code, err) == (1, "") and "The sets differ." in out
    assert layers("x.html") == {"a.off": 12, "b.off": 12, "only in b.off": 12}
    assert names("x.html") == ["thickest difference: 0.5"]
    (paint,) = model("x.html")["layers"][1]["paints"]
    assert (paint["name"], paint["low"], paint["high"]) == ("difference", 0.0, 1.0)
    assert "The sets differ." in Path("x.html").read_text(encoding="utf-8")


def test_equal_sets_are_said_to_be(folder: Path, capsys: Capture) -> None:
    assert ran(capsys, "compare", "a.off", "a.off", "--html", "x.html")[0] == 0
    assert layers("x.html") == {"a.off": 12, "a.off (2)": 12}
    assert "equal, exactly" in Path("x.html").read_text(encoding="utf-8") and not names("x.html")


def test_holes_are_marked(folder: Path, capsys: Capture) -> None:
    vertices, faces = b.sphere(r=1, segments=16).to_mesh()
    put("open.off", (vertices, np.delete(faces, [0, 40, 41], axis=0)))
    code, out, _ = ran(capsys, "check", "open.off", "--html", "x.html")
    assert code == 1 and "not closed" in out
    found = layers("x.html")
    assert found["mesh"] == len(faces) - 3 and found["open edges"] in (7, 9)
    assert [name.split(":")[0] for name in names("x.html")] == ["hole 1", "hole 2"]


def test_thin_walls_are_marked(folder: Path, capsys: Capture) -> None:
    (b.cube(10) - b.box((8, 8, 9.5)).translate(1, 1, 0.5)).save("cup.off")
    assert ran(capsys, "check", "cup.off", "--html", "x.html", "--thin", "0.6mm")[0] == 0
    assert layers("x.html")["thinner than 0.6"] == 4
    assert names("x.html") == ["thinnest: 0.5"]
    assert ran(capsys, "check", "cup.off", "--html", "x.html")[0] == 0
    assert list(layers("x.html")) == ["mesh"]
    (paint,) = model("x.html")["layers"][0]["paints"]
    assert paint["name"] == "thickness" and paint["low"] == pytest.approx(0.5)


def test_crossings_are_marked(folder: Path, capsys: Capture) -> None:
    one, other = cuboid((0, 0, 0), (2, 2, 2)), cuboid((1, 1, 1), (3, 3, 3))
    both = np.concatenate([one[0], other[0]]), np.concatenate([one[1], other[1] + len(one[0])])
    put("both.off", both)
    ran(capsys, "check", "both.off", "--html", "x.html")
    marks = defective_elements_of(RawMesh(*both))
    assert layers("x.html")["crossing triangles"] == len(np.unique(marks.crossings)) > 0
    assert names("x.html")[0].startswith("crossing 1: triangles ")


def test_other_faults_are_marked(folder: Path) -> None:
    vertices, faces = cube()
    turned = np.concatenate([faces[:-1], faces[-1:, ::-1]])
    assert len(defective_elements_of(RawMesh(vertices, turned)).turned) == 3
    fin = np.vstack([faces, [[*faces[0][:2], len(vertices)]]])
    marks = defective_elements_of(RawMesh(np.vstack([vertices, [[5.0, 5, 5]]]), fin))
    assert len(marks.crowded) == 1 and len(marks.open) == 2 and len(set(marks.holes.tolist())) == 1
    flat = np.vstack([faces, [[0, 0, 1]], faces[:1]])
    marks = defective_elements_of(RawMesh(vertices, flat))
    assert marks.flat.tolist() == [12] and marks.repeated.tolist() == [13]


def reported(capsys: Capture) -> tuple[int, list[tuple[str, str]], dict[str, dict[str, str]]]:
    """Check a folder of five files; return the exit code, the page's cards and the JUnit cases."""
    Path("in/deep").mkdir(parents=True)
    Path("a.off").rename("in/a.off")
    vertices, faces = cube()
    write(RawMesh(vertices, faces[1:], "open"), "in/open.ply")
    body, lid = b.box((3, 2, 1)), b.box((3, 2, 1)).translate(0, 0, 1)
    b.Assembly("x", [b.Assembly("body", body), b.Assembly("lid", lid)]).save("in/deep/box.3mf")
    Path("in/bad.ply").write_text("ply\n")
    Path("in/a.mtl").touch()
    code, _, _ = ran(capsys, "check", "in", "-o", "x.html", "-o", "x.json", "-o", "x.xml")
    text = Path("x.html").read_text(encoding="utf-8")
    pattern = r"<h3>(.*?)</h3>\s*<span class=\"badge tone-\w+\">(.*?)</span>"
    cases = {
        f"{one.get('classname')}: {one.get('name')}": {
            part.tag: part.get("type") or "" for part in one if part.tag != "system-out"
        }
        for one in Xml.parse("x.xml").iter("testcase")
    }
    return code, re.findall(pattern, text), cases


def test_a_folder_becomes_a_page_data_and_test_cases(folder: Path, capsys: Capture) -> None:
    code, cards, cases = reported(capsys)
    assert code == 3
    assert cards == [
        ("in/a.off", "solid"),
        ("in/bad.ply", "unreadable"),
        ("in/deep/box.3mf", "solid"),
        ("in/deep/box.3mf: body", "solid"),
        ("in/deep/box.3mf: lid", "solid"),
        ("in/open.ply", "not closed"),
    ]
    assert cases == {
        "in/a.off: a.off": {},
        "in/bad.ply: bad.ply": {"error": "unreadable"},
        "in/deep/box.3mf: body": {},
        "in/deep/box.3mf: lid": {},
        "in/open.ply: open.ply": {"failure": "not closed"},
    }
    document = json.loads(Path("x.json").read_text(encoding="utf-8"))
    files = document["files"]
    assert document["skipped"] == {".mtl": 1} and document["schema"] == 1
    assert [one["verdict"] for one in files] == ["solid", "unreadable", "solid", "not closed"]
    assert [one["name"] for one in files[2]["objects"]] == ["body", "lid"]
    assert json.loads(ran(capsys, "check", "in", "--json")[1]) == document


def test_each_mesh_of_a_page_has_pictures_and_a_view(folder: Path, capsys: Capture) -> None:
    reported(capsys)
    text = Path("x.html").read_text(encoding="utf-8")
    # Two pictures each, and over those of the mesh with a hole a ring.
    assert len(re.findall(r'<img src="data:image/', text)) == 2 * 5 + 2
    views = models("x.html")
    assert [len(one["layers"]) for one in views] == [1, 2, 1, 1, 2]
    assert [place["name"] for place in views[-1]["places"]] == ["hole 1: 3 edges"]
    assert views[-1]["layers"][1]["name"] == "open edges"
    reports = [Path(name).read_bytes() for name in ("x.html", "x.json", "x.xml")]
    ran(capsys, "check", "in", "-o", "x.html", "-o", "x.json", "-o", "x.xml")
    assert [Path(name).read_bytes() for name in ("x.html", "x.json", "x.xml")] == reports


def test_warnings_fail_test_cases_on_request(folder: Path, capsys: Capture) -> None:
    one, other = cuboid((0, 0, 0), (2, 2, 2)), cuboid((1, 1, 1), (3, 3, 3))
    write(RawMesh(*joined(one, other), objects=(("one", 12), ("other", 12))), "both.3mf")
    for options, failures in ([], "0"), (["--strict"], "1"):
        code, _, _ = ran(capsys, "check", "both.3mf", "-o", "x.xml", *options)
        root = Xml.parse("x.xml").getroot()
        assert (root.get("tests"), root.get("failures"), code) == ("3", failures, int(failures))


def test_a_page_of_several_opens_a_view_and_filters(
    folder: Path, capsys: Capture, browser: Browser
) -> None:
    reported(capsys)
    browser.open(folder / "x.html")
    assert browser.texts("#count") == ["6 of 6 meshes and objects"]
    browser.click("button[data-verdict]", 1)
    assert browser.texts("#count") == ["1 of 6 meshes and objects"]
    browser.click("#mesh-6 .opener", 0)
    browser.wait("document.querySelector('#mesh-6 .stage[data-drawn]')")
    assert browser.errors() == []


def test_marks_are_drawn(folder: Path, capsys: Capture, browser: Browser) -> None:
    vertices, faces = b.sphere(r=1, segments=16).to_mesh()
    put("open.off", (vertices, np.delete(faces, [100, 101], axis=0)))
    ran(capsys, "check", "open.off", "--html", "x.html")
    browser.open(folder / "x.html")
    browser.wait("document.querySelector('.stage[data-drawn]')")
    seen = browser.pixels("canvas").astype(int)
    assert ((seen[:, :, 0] > 150) & (seen[:, :, 1:] < 130).all(axis=2)).sum() > 50
    assert browser.errors() == []


def test_differences_are_coloured_and_laid_over_each_other(
    folder: Path, capsys: Capture, browser: Browser
) -> None:
    put("b.off", cuboid((0, 0, 0), (2, 2, 3)))
    ran(capsys, "compare", "a.off", "b.off", "--html", "x.html")
    browser.open(folder / "x.html")
    browser.wait("document.querySelector('.stage[data-drawn]')")
    seen = browser.pixels("canvas").astype(int)
    assert browser.texts(".layers button") == ["a.off", "b.off", "only in b.off"]
    browser.choose("Colours", "difference")
    assert browser.texts(".legend > span")[0] == "difference"
    coloured = browser.pixels("canvas").astype(int)
    assert (np.abs(seen - coloured).max(axis=2) > 12).mean() > 0.02
    browser.click(".layers button", 1)
    assert (np.abs(coloured - browser.pixels("canvas")).max(axis=2) > 12).mean() > 0.02
    assert browser.errors() == []


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["compare", "a.off", "c.stl", "--html", "x.png"], 3, "must end in .html"),
        (
            ["compare", "a.off", "c.stl", "--html", "no/x.html"],
            5,
            "does not exist or is not writable",
        ),
        (["check", "a.off", "--thin", "1"], 2, "add -o check.html"),
        (["check", "a.off", "-o", "x.json", "--thin", "1"], 2, "add -o check.html"),
        (["check", "a.off", "-o", "x.pdf"], 3, "must end in .html, .json or .xml"),
        (["check", "a.off", "-o", "no/x.xml"], 5, "does not exist or is not writable"),
        (["check", "a.off", "-o", "-"], 2, "--json prints the document"),
        (["check", "a.off", "m.json", "-o", "m.json"], 2, "would overwrite the input"),
        (["check", "a.off", "--html", "x.html", "--thin", "-1"], 2, "not a length"),
    ],
)
def test_refusals(
    folder: Path, capsys: Capture, arguments: list[str], code: int, words: str
) -> None:
    Path("m.json").touch()
    before = sorted(os.listdir())
    found, out, err = ran(capsys, *arguments)
    assert (found, out) == (code, "") and words in err and sorted(os.listdir()) == before
