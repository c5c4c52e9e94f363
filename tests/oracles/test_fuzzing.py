"""Some of the random scenes, files and scripts of `scripts/fuzz`, and tests of their judges."""

import dataclasses
import json
from fractions import Fraction
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import bspcsg as b
from corpus.test_corpus import compare, evaluate
from fuzzing.files import (
    FORMATS,
    File,
    damaged,
    good_file,
    judge_file,
    random_file,
    same_meaning,
)
from fuzzing.judge import Kernel, judge
from fuzzing.models import random_model
from fuzzing.places import Balls, Below, Point, Surface, Triangle, location, windings
from fuzzing.scenes import UNIT, Body, Part, Scene, cuboid_part, random_scene
from fuzzing.shrink import case_of, keep_case, shrunk
from fuzzing.sizes import a_size, ball, far_and_wide, judge_sized, sized_scene, thresholds
from support import DEEP, drawn
from support.shapes import cuboid, octahedron

ROUNDS = drawn(range(2000 if DEEP else 25), 3)
SIZED = drawn(range(500 if DEEP else 5), 2)


def triangles(low: Point, high: Point) -> tuple[Triangle, ...]:
    vertices, faces = cuboid(low, high)
    corners = whole(vertices)
    return tuple((corners[p], corners[q], corners[r]) for p, q, r in faces.tolist())


def whole(vertices: npt.NDArray[np.float64]) -> list[Point]:
    return [(int(x), int(y), int(z)) for x, y, z in vertices.tolist()]


BOX = Surface(triangles((0, 0, 0), (2, 4, 6)))


@pytest.mark.parametrize(
    ("point", "expected"),
    [((1, 1, 1), 1), ((0, 0, 0), 0), ((1, 0, 3), 0), ((0, 4, 5), 0), ((-1, 0, 0), -1)],
)
def test_places_of_a_box(point: Point, expected: int) -> None:
    assert location([BOX], lambda inside: inside[0], point) == expected
    assert location([BOX], lambda inside: not inside[0], point) == -expected


def test_a_common_wall_is_inside_a_union() -> None:
    beside = Surface(triangles((2, 0, 0), (4, 4, 6)))
    for point, expected in {(2, 1, 1): 1, (2, 0, 0): 0, (2, 4, 3): 0, (2, 2, 6): 0}.items():
        assert location([BOX, beside], any, point) == expected
        assert location([BOX, beside], all, point) == -1


def test_a_wedge_of_one_step_is_seen() -> None:
    far = 10**10
    above = Below(((0, 0, 0), (far, 0, 1), (0, far, 0)))
    below = Below(((0, 0, 0), (far, 0, 0), (0, far, 0)))
    between = lambda inside: inside[0] and not inside[1]  # noqa: E731
    assert location([above, below], between, (0, 0, 0)) == 0
    assert location([above, below], between, (far, 0, 0)) == 0
    assert location([above, below], between, (-far, 0, 0)) == -1


def test_rules_count_windings() -> None:
    twice = BOX.triangles * 2
    assert list(windings(Balls(twice), (1, 1, 1), [()])) == [2]
    found = {rule: Surface(twice, rule).sides((1, 1, 1), [()]) for rule in ("nonzero", "even-odd")}
    assert found == {"nonzero": [True], "even-odd": [False]}


@pytest.mark.timeout(3600 if DEEP else 240)
def test_random_scenes() -> None:
    wrong = {k: judge(random_scene(np.random.default_rng([0, k]))) for k in ROUNDS}
    assert not {k: found for k, found in wrong.items() if found}


@pytest.mark.timeout(3600 if DEEP else 240)
def test_random_scenes_of_sizes() -> None:
    wrong = {k: judge_sized(sized_scene(np.random.default_rng([7, k]))) for k in SIZED}
    assert not {k: found for k, found in wrong.items() if found}


def test_sizes_lie_on_both_sides_of_each_threshold_of_the_core() -> None:
    found = thresholds()
    assert {16, 512, 1 << 13, 1 << 14} <= set(found) and len(found) > 12
    drawn = {a_size(np.random.default_rng([3, k])) for k in range(1000)}
    assert drawn == {size + more for size in found for more in (-1, 0, 1)}
    counts = {k: len(ball(np.random.default_rng(k)).faces) for k in range(60)}
    assert set(counts.values()) <= {size + more for size in found for more in (-2, -1, 0, 1)}
    assert max(counts.values()) > 8000


class Forgetful(Kernel):
    """A wrong kernel that loses a face far from the tool, or differs with several threads."""

    def __init__(self, threads: int = 0) -> None:
        self.threads, self.calls = threads, 0

    def mesh(self, solid: "b.Solid") -> "b.Mesh":
        mesh = super().mesh(solid)
        self.calls += 1
        if self.threads and self.calls <= self.threads:
            return mesh
        far = np.argsort(mesh.vertices[mesh.faces].mean(axis=1)[:, 0])
        faces = np.roll(mesh.faces, 1, axis=0) if self.threads else mesh.faces[far[1:]]
        return dataclasses.replace(mesh, faces=faces)


def test_the_judge_of_sizes_notices() -> None:
    vertices, faces = octahedron()
    corners = tuple((x * 64 * UNIT, y * 64 * UNIT, z * 64 * UNIT) for x, y, z in whole(vertices))
    large = Part(corners, tuple((p, q, r) for p, q, r in faces.tolist()), True)
    tiny = cuboid_part((64 * UNIT - 5, -1, -1), (64 * UNIT + 5, 1, 1))
    scene = Scene((Body((large,)), Body((tiny,))), ("-", 0, 1), ())
    assert judge_sized(scene) == []
    assert next(far_and_wide(scene, Forgetful())).startswith("untouched: the face")
    assert list(far_and_wide(scene, Forgetful(threads=2))) == ["threads: 2 unchanged input meshes"]
    turned = dataclasses.replace(scene, expression=("-", 1, 0))
    assert judge_sized(turned) == []


def test_scenes_ask_about_the_boundary() -> None:
    found: list[int] = []
    for k in range(20):
        scene = random_scene(np.random.default_rng([0, k]))
        found += [location(scene.known(), scene.value, point) for point in scene.points]
    assert {side: found.count(side) > 50 for side in (-1, 0, 1)} == {-1: True, 0: True, 1: True}


def test_an_archive_that_says_it_is_encrypted_is_damaged_further() -> None:
    good = good_file(np.random.default_rng(1), ".3mf").data
    # The flags of a member stand 8 bytes after the mark of the directory's entry.
    at = good.index(b"PK\x01\x02") + 8
    locked = good[:at] + bytes([good[at] | 1]) + good[at + 1 :]
    for seed in range(20):
        assert isinstance(damaged(np.random.default_rng(seed), ".3mf", locked), bytes)


@pytest.mark.parametrize("kind", FORMATS)
def test_random_files(kind: str, tmp_path: Path) -> None:
    for k in drawn(range(2000 if DEEP else 12), 3):
        file = random_file(np.random.default_rng([0, k]), kind)
        assert judge_file(file, tmp_path) == [], k


def test_the_judge_of_files_knows_volumes(tmp_path: Path) -> None:
    text, volume = random_model(np.random.default_rng(4))
    assert volume is not None and volume > 0
    assert judge_file(File(".csg", text.encode(), volume), tmp_path) == []
    assert judge_file(File(".csg", text.encode(), volume + 1), tmp_path)[0].startswith("volume")
    assert judge_file(File(".csg", b"cube(", volume), tmp_path)[0].startswith("refused")


def test_the_same_in_other_words_is_not_the_same_bytes() -> None:
    good = File(
        ".off",
        b"".join(
            b.io.encoded(b.io.RawMesh(*cuboid((0, 0, 0), (1, 1, 1)), "x"), "x", ".off").chunks
        ),
    )
    others = {same_meaning(np.random.default_rng(k), good).data for k in range(9)}
    assert len(others) > 2


class Shifted(Kernel):
    """A wrong kernel that classifies points of unions wrongly."""

    def classify(self, solid: "b.Solid", points: object) -> list[int]:
        found = super().classify(solid, points)  # type: ignore[arg-type]
        made = solid.last_operation
        operators = [] if made is None else [operator for operator, _ in made.program]
        return [-each for each in found] if "or" in operators else found


def test_what_is_wrong_is_made_small(tmp_path: Path) -> None:
    cube = triangles((0, 0, 0), (UNIT, UNIT, UNIT))
    corners = tuple(dict.fromkeys(p for each in cube for p in each))
    part = Part(corners, tuple(tuple(corners.index(p) for p in t) for t in cube), True)  # type: ignore[misc]
    bodies = tuple(Body((part, part.turned(), part)[:k]) for k in (1, 2, 3))
    scene = Scene(
        bodies, ("-", ("|", 0, ("copied", ("&", 1, 2))), 1), ((1, 2, 3), (0, 0, 0), (5, 5, 5))
    )
    small = shrunk(scene, lambda each: judge(each, Shifted()))
    assert judge(small, Shifted()) and judge(small) == []
    assert len(small.bodies) == 1 and len(small.points) == 1
    assert small.expression == ("|", 0, 0) and len(small.bodies[0].parts) == 1
    case = json.loads(keep_case(tmp_path, "small", small, "A test.").read_text("utf-8"))
    assert case == case_of(small, "A test.") and case["expect"]["places"]
    compare(evaluate(case), case["expect"])


def test_the_volume_of_a_plain_operand_is_known() -> None:
    scene = random_scene(np.random.default_rng([0, 3]))
    known = [body for k in range(30) for body in random_scene(np.random.default_rng([0, k])).bodies]
    volumes = [body.volume for body in known if body.volume is not None]
    assert scene.bodies and len(volumes) > 20 and all(isinstance(v, Fraction) for v in volumes)
