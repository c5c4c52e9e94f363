"""Assemblies written by every writer and read back: triangles, volumes, objects, names, bytes."""

import math
import tempfile
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bspcsg.formats.raw import parts_of
from bspcsg.io import FORMATS, RawMesh, encoded, read, write
from support.shapes import Arrays, cuboid, joined, octahedron, tetrahedron

FORMS = [(suffix, False) for suffix in FORMATS] + [(".stl", True), (".ply", True)]

#: Formats that tell objects apart, and what keeps every letter of a name.
TELLING = {".stl", ".obj", ".3mf", ".glb"}
EXACT_NAMES = {".glb"}

PLAIN = st.sampled_from(["", "lid", "lid", "body", "Lid", "lid 1", "körper", "部品", "unnamed 1"])
ODD = st.text(max_size=6) | st.sampled_from(
    [
        "a#b",
        "ends in \\",
        "two\nlines",
        "a\tb",
        "  spaces  ",
        "\0",
        "\ud800",
        "<&\">'",
        "👨‍👩‍👧",
        "solid",
        "facet",
        "endsolid lid",
        "o x",
        "f 1 2 3",
        "]]>",
        "</object>",
        "1 2 3",
        "-->",
    ]
)


@st.composite
def assemblies(draw: st.DrawFn, names: st.SearchStrategy[str]) -> RawMesh:
    """Return some bodies side by side; some have equal names or are mirror images."""
    bodies: list[Arrays] = []
    objects = []
    for number in range(draw(st.integers(1, 5))):
        size = draw(st.sampled_from([1.0, 0.1, 1 / 3, 12.5, 1e-3]))
        kind = draw(st.sampled_from(["box", "octahedron", "tetrahedron", "nothing"]))
        vertices, faces = {
            "box": cuboid((0, 0, 0), (1, 2, 3)),
            "octahedron": octahedron(),
            "tetrahedron": tetrahedron([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]),
            "nothing": (np.zeros((0, 3)), np.zeros((0, 3), np.int64)),
        }[kind]
        vertices = vertices * size + (number * 40, 0, 0)
        if draw(st.booleans()):
            vertices, faces = vertices * (-1, 1, 1), faces[:, ::-1]
        bodies.append((vertices, faces))
        objects.append((draw(names), len(faces)))
    return RawMesh(*joined(*bodies), objects=tuple(objects))


def volumes(mesh: RawMesh) -> list[Fraction]:
    """Return six times the exact signed volume of each object that has one."""
    found = []
    for _, faces in parts_of(mesh):
        points = [[list(map(Fraction, corner)) for corner in face] for face in mesh.vertices[faces]]
        found.append(sum((determinant(*corners) for corners in points), Fraction(0)))
    return [volume for volume in found if volume]


def determinant(a: list[Fraction], b: list[Fraction], c: list[Fraction]) -> Fraction:
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def written(mesh: RawMesh, suffix: str, text: bool) -> RawMesh:
    """Assert that writing a mesh twice gives the same bytes, and return the mesh read back."""
    first, second = (b"".join(encoded(mesh, "x", suffix, text).chunks) for _ in range(2))
    assert first == second
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"x{suffix}"
        write(mesh, path, text=text)
        assert path.read_bytes() == first
        return read(path)


def in_single(mesh: RawMesh) -> RawMesh:
    return replace(mesh, vertices=mesh.vertices.astype(np.float32).astype(np.float64))


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("suffix", "text"), FORMS)
@given(mesh=assemblies(PLAIN | ODD))
@settings(deadline=None, max_examples=40)
def test_nothing_is_lost(suffix: str, text: bool, mesh: RawMesh) -> None:
    if len(mesh.faces) == 0:
        return
    found = written(mesh, suffix, text)
    is_single = suffix == ".glb" or (suffix == ".stl" and not text)
    meant = in_single(mesh) if is_single else mesh
    assert len(found.faces) == len(mesh.faces)
    tells = suffix in TELLING and (text or suffix != ".stl")
    expected = volumes(meant) if tells else [sum(volumes(meant))]
    assert volumes(found) == [volume for volume in expected if volume]
    if tells:
        _check_names(found, mesh, suffix)


def _check_names(found: RawMesh, mesh: RawMesh, suffix: str) -> None:
    """Assert that equal names stay equal, and usual names stay the same."""
    before = [name for name, count in mesh.objects if count]
    after = [name for name, count in found.objects if count] or [found.name]
    if len(before) == 1:
        return  # one object may be called by the file's name
    assert len(after) == len(before)
    for one, other in zip(before, after, strict=True):
        is_usual = one == " ".join(one.split()) and one.isprintable() and not set("#\\") & set(one)
        if (is_usual or suffix in EXACT_NAMES) and "\ud800" not in one and one:
            assert other == one


@pytest.mark.parametrize("middle", [".3mf", ".glb", ".obj"])
@given(mesh=assemblies(PLAIN))
@settings(deadline=None, max_examples=20)
def test_from_format_to_format(middle: str, mesh: RawMesh) -> None:
    """Converting through another format and back keeps what single precision can store."""
    if len(mesh.faces) == 0:
        return
    mesh = in_single(mesh)
    through = written(written(mesh, middle, False), ".3mf", False)
    # One body without a name may be called by the file's, whatever empty ones were beside it.
    is_one = sum(count > 0 for _, count in mesh.objects) == 1
    assert is_one or through.objects == written(mesh, ".3mf", False).objects
    assert volumes(through) == volumes(mesh)
    assert math.isclose(float(sum(volumes(through))), float(sum(volumes(mesh))))
