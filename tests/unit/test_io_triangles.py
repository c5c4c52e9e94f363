"""Triangles that single precision flattens, merges or reverses, counted exactly."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from bspcsg._types import FloatArray
from bspcsg.formats.triangles import are_flat, are_turned
from bspcsg.io import RawMesh, write
from bspcsg.mesh.weld import distinct_count, welded
from support.shapes import cube, icosphere, moved

Vector = tuple[Fraction, ...]


def exact_normal(triangle: FloatArray) -> Vector:
    a, b, c = (tuple(map(Fraction, corner)) for corner in triangle.tolist())
    p, q = (tuple(x - y for x, y in zip(end, a, strict=True)) for end in (b, c))
    pairs = ((1, 2), (2, 0), (0, 1))
    return tuple(p[i] * q[j] - p[j] * q[i] for i, j in pairs)


def nasty(rng: np.random.Generator, count: int) -> FloatArray:
    """Return difficult random triangles: with few digits, flat, of all sizes, and far out."""
    corners = rng.integers(-3, 4, (count, 3, 3)).astype(np.float64)
    corners *= rng.choice([1, 1e-20, 1e20, 0.1, 2.0**-30, 1e-160, 1e150], (count, 1, 1))
    corners += rng.choice([0, 0, 1.0, 1e5, 0.1], (count, 1, 3))
    corners[::2] = corners[::2].astype(np.float32, casting="unsafe") if count else corners[::2]
    return np.where(np.isfinite(corners), corners, 0.0)


@pytest.mark.filterwarnings("ignore:overflow encountered")
def test_flat_and_turned_against_fractions() -> None:
    rng = np.random.default_rng(1)
    before = nasty(rng, 3000)
    noise = rng.choice([0, 1e-3, 1e-16, 0.5], before.shape) * rng.normal(size=before.shape)
    after = before + noise * np.abs(before).max(axis=(1, 2), keepdims=True)
    expected = [not any(exact_normal(triangle)) for triangle in before]
    assert are_flat(before).tolist() == expected and 100 < sum(expected) < 2900
    turned = [
        sum(x * y for x, y in zip(exact_normal(one), exact_normal(other), strict=True)) < 0
        for one, other in zip(before, after, strict=True)
    ]
    assert are_turned(before, after).tolist() == turned and 100 < sum(turned) < 2900


def test_distinct_counts_what_welding_leaves() -> None:
    rng = np.random.default_rng(2)
    for high in (2, 5, 10**6):
        points = rng.integers(0, high, (500, 3)).astype(np.float64)
        points[::3] *= -0.0
        assert distinct_count(points) == len(welded(points)[0])
    assert distinct_count(np.zeros((0, 3))) == 0


@pytest.mark.parametrize("suffix", [".stl", ".glb"])
def test_flattened_and_merged(tmp_path: Path, suffix: str) -> None:
    """Fans to a point that single precision does not tell from its neighbour."""
    vertices, faces = cube()
    vertices = vertices.copy()
    vertices[vertices[:, 2] > 0, 2] = 1e-9
    findings = write(RawMesh(vertices + 1000, faces), tmp_path / f"x{suffix}")
    counts = {finding.code: finding.count for finding in findings}
    assert counts["merged_by_rounding"] == 4 and counts["flattened_by_rounding"] == 8


@pytest.mark.parametrize("suffix", [".stl", ".glb"])
def test_turned(tmp_path: Path, suffix: str) -> None:
    """A corner just beside a long edge, which rounding takes to its other side."""
    step = float(np.spacing(np.float32(1)))
    corners = np.array([(0, 0, 0), (1, 1 + 0.6 * step, 0), (0.75, 0.75 + 0.46 * step, 0)])
    mesh = RawMesh(corners, np.array([[0, 1, 2]]))
    rounded = corners.astype(np.float32).astype(np.float64)
    before, after = exact_normal(corners)[2], exact_normal(rounded)[2]
    assert before < 0 < after or after < 0 < before
    findings = write(mesh, tmp_path / f"x{suffix}")
    (turned,) = [finding for finding in findings if finding.code == "turned_by_rounding"]
    assert (turned.count, turned.where, turned.severity) == (1, (0,), "warning")


def test_what_is_flat_before_is_not_counted(tmp_path: Path) -> None:
    corners = np.array([(0, 0, 0), (1 / 3, 1 / 3, 0), (2 / 3, 2 / 3, 0)])
    findings = write(RawMesh(corners, np.array([[0, 1, 2], [0, 0, 1]])), tmp_path / "x.stl")
    assert [finding.code for finding in findings] == ["single_precision"]


def test_a_ball_far_out(tmp_path: Path) -> None:
    vertices, faces = moved(icosphere(3), (0, 0, 1e7))
    findings = write(RawMesh(vertices, faces), tmp_path / "x.stl")
    rounded = vertices.astype(np.float32).astype(np.float64)
    flat = sum(not any(exact_normal(triangle)) for triangle in rounded[faces])
    counts = {finding.code: finding.count for finding in findings}
    assert counts.get("flattened_by_rounding", 0) == flat > 0
    assert counts["merged_by_rounding"] == len(vertices) - len(np.unique(rounded, axis=0))


def test_double_precision_loses_nothing(tmp_path: Path) -> None:
    mesh = RawMesh(*moved(icosphere(3), (0, 0, 1e7)))
    for name in ("x.ply", "x.obj", "x.off", "x.3mf"):
        assert write(mesh, tmp_path / name) == ()
