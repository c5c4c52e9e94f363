"""Runs every case in `cases/`, and fails if there is none."""

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bspcsg as b
from fuzzing.scenes import CALLS
from support.checks import assert_sound
from support.shapes import cuboid

FOLDER = Path(__file__).parent / "cases"
CASES = sorted(FOLDER.glob("*.json"))


def test_there_are_cases() -> None:
    assert len(CASES) > 10


def operand(description: dict[str, Any]) -> "b.Solid":
    """Return the solid of an operand's description in a case."""
    if "box" in description:
        return b.Solid(*cuboid(*description["box"]))
    if "half_space" in description:
        return b.half_space(*description["half_space"])
    vertices = np.array(description["vertices"], dtype=np.float64)
    faces = np.array(description["faces"], dtype=np.int64)
    return b.Solid(vertices, faces, winding=description.get("winding", "positive"))


def evaluate(case: dict[str, Any]) -> "b.Solid":
    """Return the value of a case's expression over its operands."""
    names = {chr(ord("a") + k): operand(given) for k, given in enumerate(case["operands"])}
    result: b.Solid = eval(case["expression"], {"__builtins__": {}, **CALLS}, names)
    return result


def compare(solid: "b.Solid", expect: dict[str, Any]) -> None:
    """Assert everything that a case expects of its result."""
    places = expect.pop("places", [])
    found_places = solid.classify([place[:3] for place in places] or np.zeros((0, 3)))
    assert found_places.tolist() == [place[3] for place in places]
    if not solid.is_bounded:
        assert not expect
        return
    if expect.pop("thinner_than_doubles", False):
        assert not len(solid.to_mesh().faces)
        assert "mended" in {finding.code for finding in solid.findings}
        assert solid.volume_exact == Fraction(expect.pop("volume")) > 0 and not expect
        return
    mesh = assert_sound(solid)
    found = {
        "volume": solid.volume_exact,
        "area": mesh.area,
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
        "parts": mesh.surface_count,
        "euler": mesh.euler_number,
        "empty": solid.is_empty,
    }
    for name, value in expect.items():
        wanted = Fraction(value) if name == "volume" else value
        if name == "area":
            wanted = pytest.approx(value, rel=1e-9)
        assert found[name] == wanted, name


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_case(path: Path) -> None:
    case = json.loads(path.read_text("utf-8"))
    assert case["why"]
    expect = dict(case["expect"])
    code = expect.pop("code", None)
    if code is None:
        compare(evaluate(case), expect)
        return
    with pytest.raises(b.BspcsgError) as caught:
        evaluate(case).to_mesh()
    assert caught.value.code == code
