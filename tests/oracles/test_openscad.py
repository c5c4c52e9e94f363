"""Random scripts have the volumes that OpenSCAD computes, if it is installed."""

import math
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from bspcsg import csg
from bspcsg.io import read
from support import DEEP

Rng = np.random.Generator
ROUNDS = 300 if DEEP else 15

#: OpenSCAD's grid for plane figures; what it writes has six digits.
GRID = 2.0**-16


def number(rng: Rng, low: float, high: float) -> str:
    return f"{rng.uniform(low, high):.6g}"


def flag(rng: Rng) -> str:
    return str(rng.choice(["true", "false"]))


def fineness(rng: Rng) -> str:
    fixed = f"$fn = {rng.integers(3, 14)}"
    return str(rng.choice(["$fn = 0", fixed, f"$fa = {number(rng, 5, 40)}, $fs = 1.3"]))


def move(rng: Rng, *, flat: bool) -> str:
    angle = math.radians(rng.choice([0, 30, 45, 90, rng.uniform(0, 360)]))
    c, s = f"{math.cos(angle):.6g}", f"{math.sin(angle):.6g}"
    minus = f"{-float(s):.6g}"
    x, y, z = (number(rng, -8, 8) for _ in range(3))
    if flat or rng.random() < 0.5:
        return f"multmatrix([[{c}, {minus}, 0, {x}], [{s}, {c}, 0, {y}], [0, 0, 1, {z}]])"
    return f"multmatrix([[1, 0, 0, {x}], [0, {c}, {minus}, {y}], [0, {s}, {c}, {z}]])"


def operation(rng: Rng) -> str:
    return str(rng.choice(["union", "difference", "intersection", "hull"])) + "()"


def figure(rng: Rng, depth: int) -> str:
    leaves: list[Callable[[], str]] = [
        lambda: f"square([{number(rng, 1, 12)}, {number(rng, 1, 12)}], center = {flag(rng)});",
        lambda: f"circle(r = {number(rng, 0.5, 8)}, {fineness(rng)});",
    ]
    inner: list[Callable[[], str]] = [
        lambda: f"{move(rng, flat=True)} {{ {figure(rng, depth - 1)} }}",
        lambda: f"{operation(rng)} {{ {figure(rng, depth - 1)} {figure(rng, depth - 1)} }}",
        lambda: f"projection(cut = {flag(rng)}) {{ {body(rng, depth - 1)} }}",
        lambda: f"offset(r = {number(rng, -1, 2)}, {fineness(rng)}) {{ {figure(rng, depth - 1)} }}",
    ]
    return one_of(rng, leaves + inner if depth > 0 else leaves)


def half(rng: Rng) -> str:
    shift = f"multmatrix([[1, 0, 0, {rng.choice([25, -25])}], [0, 1, 0, 0], [0, 0, 1, 0]])"
    return f"{shift} {{ square([50, 100], center = true); }}"


def extrusion(rng: Rng, inside: str) -> str:
    """Return a random extrusion; it has no twist if it contains a projection.

    OpenSCAD drops corners of projections that are closer to a straight line than its grid, and
    twisted faces depend on such corners.
    """
    twist = "0" if "projection" in inside else number(rng, -90, 90)
    return (
        f"linear_extrude(height = {number(rng, 1, 12)}, twist = {twist},"
        f" scale = {number(rng, 0.2, 2)}, {fineness(rng)}) {{ {inside} }}"
    )


def body(rng: Rng, depth: int) -> str:
    leaves: list[Callable[[], str]] = [
        lambda: f"cube([{number(rng, 1, 12)}, 4.5, {number(rng, 1, 9)}], center = {flag(rng)});",
        lambda: f"sphere(r = {number(rng, 0.5, 8)}, {fineness(rng)});",
        lambda: (
            f"cylinder(h = {number(rng, 1, 12)}, r1 = {number(rng, 0.5, 6)},"
            f" r2 = {rng.choice(['0', number(rng, 0.5, 6)])}, {fineness(rng)});"
        ),
    ]
    inner: list[Callable[[], str]] = [
        lambda: f"{move(rng, flat=False)} {{ {body(rng, depth - 1)} }}",
        lambda: f"{operation(rng)} {{ {body(rng, depth - 1)} {body(rng, depth - 1)} }}",
        lambda: extrusion(rng, figure(rng, depth - 1)),
        lambda: (
            f"rotate_extrude(angle = {rng.choice(['360', number(rng, -350, 350)])},"
            f" {fineness(rng)}) {{ intersection() {{ {half(rng)} {figure(rng, depth - 1)} }} }}"
        ),
        lambda: f"resize([{number(rng, 1, 9)}, 0, 0], auto = true) {{ {body(rng, depth - 1)} }}",
    ]
    return one_of(rng, leaves + inner if depth > 0 else leaves)


def one_of(rng: Rng, makers: list[Callable[[], str]]) -> str:
    return makers[int(rng.integers(len(makers)))]()


def openscads_volume(text: str, folder: Path) -> float | None:
    """Return OpenSCAD's volume of a script; None for a warning or an open mesh."""
    script, output = folder / "model.csg", folder / "model.stl"
    script.write_text(text)
    output.unlink(missing_ok=True)
    done = subprocess.run(
        ["openscad", "-o", str(output), str(script)],
        capture_output=True,
        text=True,
        env={**os.environ, "QT_QPA_PLATFORM": "offscreen"},
        timeout=60,
        check=False,
    )
    if any(word in done.stderr for word in ("ERROR", "WARNING")):
        return None
    if not output.is_file():
        return 0.0
    raw = read(output)
    a, b, c = (raw.vertices[raw.faces[:, corner]] for corner in range(3))
    return float(np.einsum("ij,ij->i", np.cross(a, b), c).sum() / 6)


@pytest.mark.skipif(shutil.which("openscad") is None, reason="openscad is not installed")
@pytest.mark.timeout(3000 if DEEP else 300)
def test_random_scripts_equal_openscad(tmp_path: Path) -> None:
    compared = 0
    for k in range(ROUNDS):
        text = body(np.random.default_rng([17, k]), 3)
        expected = openscads_volume(text, tmp_path)
        if expected is None:
            continue
        solid = csg.loads(text)
        digits = 0.0 if solid.bounds is None else 5e-6 * float(abs(solid.bounds).max())
        # Each corner moves by half a unit of the sixth digit and by the grid, along each axis.
        allowed = 1e-3 if solid.is_empty else solid.area * 3**0.5 * (digits + GRID)
        assert solid.volume == pytest.approx(expected, rel=0, abs=allowed), f"round {k}: {text}"
        compared += 1
    assert compared >= 0.8 * ROUNDS
