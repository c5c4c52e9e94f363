"""Checks: correct results agree, and every kind of wrong result is detected."""

import json
import math
from collections import Counter
from fractions import Fraction
from itertools import pairwise
from types import SimpleNamespace
from typing import Any, cast

import manifold3d
import networkx as nx
import numpy as np
import pytest

import bspcsg as b
from bspcsg.operations.setops import OPERATIONS
from bspcsg.verify import oracle
from bspcsg.verify.check import Depth, Verdict, check_result, validate
from support.shapes import cube, cuboid, flipped, joined, moved, random_rotation, turned

DEPTHS: list[Depth] = ["full", "quick"]
OPS: list[Any] = ["union", "intersection", "difference", "xor"]


def boxes() -> tuple["b.Solid", "b.Solid"]:
    return b.cube(2), b.cube(2).translate(1, 1, 1)


def turned_cube(seed: int) -> "b.Solid":
    shape = turned(moved(cube(), (-0.5, -0.5, -0.5)), random_rotation(np.random.default_rng(seed)))
    return b.Solid(*moved(shape, (0.1 * seed, 0.2, 0.3)))


@pytest.mark.parametrize("op", OPS)
def test_right_results_agree(op: Any) -> None:
    report = validate(op, *boxes())
    assert report.set_difference is not None and report.set_difference.volume == 0
    assert report.ok and report.theirs is not None
    assert report.verdict is Verdict.AGREE


@pytest.mark.sampled(3)
@pytest.mark.parametrize("op", OPS)
@pytest.mark.parametrize("seed", range(4))
def test_general_position_agrees(op: Any, seed: int) -> None:
    report = validate(op, turned_cube(seed), b.sphere(0.7), turned_cube(seed + 9))
    assert report.verdict in (Verdict.AGREE, Verdict.OTHER_TOPOLOGY)
    assert report.set_difference is not None
    assert report.set_difference.thickness <= report.same_set_bound


def test_the_remembered_operation_is_checked() -> None:
    a, c = boxes()
    assert (a - c).validate().operation == "difference"
    assert ((a | c) ^ b.sphere(1)).validate().ok


@pytest.mark.parametrize(
    ("program", "name"),
    [
        (lambda a, c: a | c, "union"),
        (lambda a, c: a & c, "intersection"),
        (lambda a, c: a - c, "difference"),
        (lambda a, c: a ^ c, "xor"),
        (lambda a, c: (a | c) - (a & c), "expression"),
    ],
)
def test_operations_are_named(program: Any, name: str) -> None:
    report = program(*boxes()).validate()
    assert report.operation == name
    assert report.set_difference.volume == 0


def test_a_lost_part_is_found() -> None:
    body, crumb = b.cube(100), b.cube(0.001).translate(200, 0, 0)
    report = check_result(body, "union", [body, crumb])
    assert report.verdict is Verdict.DISAGREE and not report.ok
    assert "(200," in report.reason.replace("200.001", "200")


@pytest.mark.parametrize("depth", DEPTHS)
def test_a_bump_that_moved_is_found_although_the_volume_is_right(depth: Depth) -> None:
    body, bump = b.cube(10), b.box((1, 1, 0.001))
    wrong = body | bump.translate(1, 1, 10)
    report = check_result(wrong, "union", [body, bump.translate(5, 5, 10)], depth)
    assert report.verdict is Verdict.DISAGREE
    assert report.theirs is not None and report.ours.volume == pytest.approx(report.theirs.volume)


@pytest.mark.parametrize("op", OPS[:3])
def test_measures_and_points_at_the_seam_suffice(op: Any) -> None:
    solids = [turned_cube(1), b.sphere(0.7)]
    report = check_result(OPERATIONS[op](*solids), op, solids, "quick")
    assert report.verdict is Verdict.AGREE and report.set_difference is None
    assert report.probes > 20 and report.to_dict()["compared"] == "measures"
    assert f"area, parts, Euler number and {report.probes} points" in report.summary()


@pytest.mark.parametrize(
    "change",
    [
        lambda body: body.translate(0, 0, 1e-5),
        lambda body: body.mirror((1, 0, 0)),
        lambda body: body | b.cube(1e-3).translate(3, 0, 0),
        lambda body: body - b.cube(1e-3, center=True),
        lambda body: body.scale(1 + 1e-7),
    ],
)
def test_small_errors_are_not_missed_by_measures(change: Any) -> None:
    solids = [turned_cube(1), b.box((1, 0.8, 0.6))]
    report = check_result(change(b.union(*solids)), "union", solids, "quick")
    assert report.verdict is Verdict.DISAGREE and report.set_difference is not None


def test_a_film_of_rounding_is_no_difference() -> None:
    body = b.cube(1000)
    thicker = b.box((1000.000000001, 1000, 1000))
    report = check_result(thicker, "union", [body, body])
    assert report.verdict is Verdict.AGREE
    assert report.set_difference is not None
    assert report.set_difference.volume == 0.001


@pytest.mark.parametrize("depth", DEPTHS)
def test_a_film_that_closes_on_itself(depth: Depth) -> None:
    body = b.cube(1000, center=True)
    larger = b.cube(1000.000000002, center=True)
    assert check_result(larger, "union", [body, body], depth).verdict is Verdict.AGREE
    larger = b.cube(1000.001, center=True)
    report = check_result(larger, "union", [body, body], depth)
    assert report.verdict is Verdict.DISAGREE
    assert report.set_difference is not None
    assert report.set_difference.thickness == pytest.approx(0.0005, rel=1e-3)


@pytest.mark.parametrize("depth", DEPTHS)
def test_small_parts_refine_the_lattice_of_large_ones(depth: Depth) -> None:
    """The faces of the large one stay where the coarse lattice had them."""
    part, tiny = turned_cube(1) | b.box((1, 0.8, 0.6)), b.cube(1e-4).translate(3, 0, 0)
    both = part | tiny
    assert part.pitch > both.pitch
    report = both.validate(depth=depth)
    assert report.verdict in (Verdict.AGREE, Verdict.OTHER_TOPOLOGY), report
    assert (both - b.cube(1e-3)).validate(depth=depth).ok


@pytest.mark.parametrize("depth", DEPTHS)
def test_within_the_tolerance_of_the_oracle(depth: Depth) -> None:
    body = b.cube(1).translate(1e6, 0, 0)
    report = check_result(body.translate(0, 0, 1e-8), "union", [body, body], depth)
    assert report.verdict is Verdict.WITHIN_ROUNDING and report.ok


def test_operands_that_overlap_themselves() -> None:
    double = b.Solid(*joined(cube(), moved(cube(), (0.5, 0.5, 0.5))))
    report = validate("difference", double, b.cube(0.25))
    assert report.verdict is Verdict.AGREE
    assert [note.split(",")[0] for note in report.notes] == ["operand 1 overlaps itself"]
    assert report.set_volume == 15 / 8 - 1 / 64


@pytest.mark.parametrize("op", ["intersection", "difference"])
def test_half_spaces_are_compared_in_a_box(op: Any) -> None:
    report = validate(op, b.cube(1), b.half_space((0, 0, 1), 0.25))
    assert report.verdict is Verdict.AGREE
    assert "operand 2 is unbounded" in report.notes[0]


def test_complements() -> None:
    a, c = boxes()
    assert (~(~a | ~c)).validate().verdict is Verdict.AGREE
    assert (c & ~a).validate().verdict is Verdict.AGREE


def test_a_box_that_needs_a_coarser_lattice() -> None:
    far = b.box((8.9e6, 8.9e6, 8.9e6))
    report = validate("intersection", far, b.half_space((0, 0, 1), 0.25))
    assert report.verdict is Verdict.AGREE


def test_empty_operands_and_results() -> None:
    assert validate("difference", b.cube(1), b.cube(1)).verdict is Verdict.AGREE
    assert validate("union", b.Solid.empty(), b.Solid.empty()).verdict is Verdict.AGREE
    assert validate("intersection", b.cube(1), b.cube(1).translate(1, 0, 0)).ours.triangles == 0


@pytest.mark.parametrize("count", [1, 3, 4])
@pytest.mark.parametrize("op", OPS)
def test_any_number_of_operands(op: Any, count: int) -> None:
    solids = [b.cube(2).translate(0.5 * k, 0.25 * k, 0) for k in range(count)]
    report = validate(op, *solids)
    assert report.set_difference is not None and report.set_difference.volume == 0


def test_nothing_to_compare() -> None:
    with pytest.raises(b.InvalidMeshError):
        check_result(b.cube(1))
    with pytest.raises(b.InvalidMeshError):
        validate("union")
    with pytest.raises(b.InvalidMeshError):
        validate(cast(Any, "sum"), b.cube(1))


def test_unbounded_results_have_no_mesh() -> None:
    with pytest.raises(b.UnboundedError):
        validate("union", b.cube(1), b.half_space((0, 0, 1), 0))


class OpenResult:
    """A result whose mesh lacks one face."""

    pitch = -9
    is_bounded = True
    volume = 1.0
    tree = SimpleNamespace(snapped_by=0.0)

    def normalized(self) -> "OpenResult":
        return self

    def to_mesh(self) -> "b.Mesh":
        vertices, faces = cube()
        return b.Mesh(vertices, faces[1:], np.zeros((11, 2), np.int64))


def test_an_open_result_fails() -> None:
    report = check_result(cast(Any, OpenResult()), "union", [b.cube(1)])
    assert report.verdict is Verdict.SUBJECT_FAILED and not report.ok
    assert "3 open edges" in report.reason


def test_a_mesh_that_is_not_its_set_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(OpenResult, "to_mesh", lambda _: b.cube(2).to_mesh())
    report = check_result(cast(Any, OpenResult()), "union", [b.cube(1)])
    assert report.verdict is Verdict.SUBJECT_FAILED


def test_an_oracle_that_raises(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise RuntimeError("no luck")

    monkeypatch.setattr(oracle, "_carried_out", fail)
    report = validate("union", *boxes())
    assert report.verdict is Verdict.ORACLE_FAILED and "no luck" in report.reason
    assert report.ok and report.theirs is None


def test_operands_the_oracle_refuses() -> None:
    vertices, faces = cube()
    mesh = b.Mesh(vertices, faces[1:], np.zeros((11, 2), np.int64))
    with pytest.raises(oracle.OracleRefusedError, match="operand 1: NotManifold"):
        oracle.manifold_result([("leaf", [0])], [mesh])


def test_operands_after_a_refused_one_have_their_notes(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(number: int, _: "b.Mesh") -> None:
        raise oracle.OracleRefusedError(f"no operand {number}")

    monkeypatch.setattr(oracle, "_taken", refuse)
    double = b.Solid(*joined(cube(), moved(cube(), (0.5, 0.5, 0.5))))
    report = validate("union", b.cube(0.25), double, double.translate(1, 0, 0))
    assert (report.verdict, report.reason) == (Verdict.ORACLE_REFUSED, "no operand 1")
    told = [note.split(",")[0] for note in report.notes]
    assert told == ["operand 2 overlaps itself", "operand 3 overlaps itself"]


def test_the_oracle_knows_complements() -> None:
    a, c = (solid.to_mesh() for solid in boxes())
    leaves: list[tuple[str, list[int]]] = [("leaf", [0]), ("leaf", [1]), ("not", [1])]
    assert oracle.manifold_result([*leaves, ("and", [0, 2])], [a, c]).mesh.volume == 7
    assert (
        oracle.manifold_result([*leaves, ("xor", [0, 2]), ("not", [3])], [a, c]).mesh.volume == 14
    )
    with pytest.raises(oracle.OracleRefusedError, match="unbounded"):
        oracle.manifold_result([*leaves, ("or", [0, 2])], [a, c])


def test_reports_are_json_and_words() -> None:
    report = validate("union", turned_cube(1), b.sphere(0.5))
    found = json.loads(json.dumps(report.to_dict(), allow_nan=False))
    assert found["verdict"] == "agree" and found["ok"] is True
    assert found["set_difference"]["equal"] == (found["set_difference"]["volume"] == 0)
    assert found["oracle"] == f"manifold3d {manifold3d_version()}"
    assert str(report).startswith("union: agree with manifold3d")


def manifold3d_version() -> str:
    from importlib.metadata import version

    assert manifold3d.Manifold is not None
    return version("manifold3d")


@pytest.mark.parametrize(
    ("faces", "count"),
    [
        (cube()[1], 0),
        (cube()[1][1:], 3),
        (np.concatenate([cube()[1], cube()[1]]), 36),
        (np.concatenate([cube()[1][:-1], cube()[1][-1:, ::-1]]), 3),
        (np.zeros((0, 3), np.int64), 0),
        (np.array([[0, 0, 1]]), 1),
    ],
)
def test_open_edges(faces: "np.ndarray[Any, Any]", count: int) -> None:
    mesh = b.Mesh(cube()[0], faces, np.zeros((len(faces), 2), np.int64))
    assert mesh.open_edges == mesh.certificate.open_edges == count


def test_counts_of_random_triangles() -> None:
    rng = np.random.default_rng(1)
    for most in (4, 12, 40):
        faces = rng.integers(0, most, (most * 2, 3))
        directed = Counter((a, b) for row in faces.tolist() for a, b in pairwise([*row, row[0]]))
        is_open = [a == b or n != 1 or (b, a) not in directed for (a, b), n in directed.items()]
        edges = {tuple(sorted(edge)) for edge in directed}
        linked = nx.Graph(edges)
        mesh = b.Mesh(rng.normal(size=(most, 3)), faces, np.zeros((len(faces), 2), np.int64))
        assert mesh.open_edges == sum(is_open)
        assert mesh.surface_count == nx.number_connected_components(linked)
        assert mesh.euler_number == len(linked) - len(edges) + len(faces)


def soup(digits: int) -> b.Mesh:
    """Return triangles between points whose coordinates differ by many powers of ten."""
    rng = np.random.default_rng(2)
    vertices = rng.normal(size=(20, 3)) * 10.0 ** rng.integers(-digits, digits, (20, 1))
    return b.Mesh(vertices, rng.integers(0, 20, (500, 3)), np.zeros((500, 2), np.int64))


def test_sums_are_rounded_once() -> None:
    mesh = soup(2)
    low, high = np.asarray(mesh.bounds)
    a, *ends = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    p, q = (end - a for end in ends)
    n = [p[:, k - 2] * q[:, k - 1] - p[:, k - 1] * q[:, k - 2] for k in range(3)]
    out = (a - (low + (high - low) / 2)).T
    parts = (n[0] * out[0] + n[1] * out[1] + n[2] * out[2]) / 6
    assert mesh.volume == math.fsum(parts.tolist())


def test_sums_that_drown_in_the_rounding_of_their_parts_are_exact() -> None:
    mesh = soup(9)
    low, high = np.asarray(mesh.bounds).tolist()
    middle = [Fraction(x + (y - x) / 2) for x, y in zip(low, high, strict=True)]
    exact = Fraction(0)
    for face in mesh.faces.tolist():
        a, c, d = ([Fraction(x) for x in mesh.vertices[k].tolist()] for k in face)
        p, q, out = (
            [x - y for x, y in zip(*two, strict=True)] for two in ((c, a), (d, a), (a, middle))
        )
        n = [p[k - 2] * q[k - 1] - p[k - 1] * q[k - 2] for k in range(3)]
        exact += (out[0] * n[0] + out[1] * n[1] + out[2] * n[2]) / 6
    assert abs(Fraction(mesh.volume) / exact - 1) < 1e-15


def test_inverted_operands_are_empty_to_both() -> None:
    inverted = b.Solid(*flipped(cuboid((0, 0, 0), (1, 1, 1))))
    report = validate("union", b.cube(2), inverted)
    assert report.verdict is Verdict.AGREE and report.set_volume == 8


def test_needles_are_no_pieces() -> None:
    # Far longer than wide: in doubles, its volume is all rounding.
    from bspcsg.mesh.pieces import _exact_volume, _measures

    far = np.array([4868.5, -19325.25, 1819.875])
    tip = far + [69.4, 192.3, 187.8]
    near = far + np.array([(0, 0, 0), (1e-9, 3e-9, -2e-9), (-2e-9, 1e-9, 3e-9)])
    vertices = np.concatenate([near, tip[None]])
    faces = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)], dtype=np.int64)
    mesh = b.Mesh(vertices, faces, np.zeros((4, 2), np.int64))
    volumes, areas = _measures(mesh, np.zeros(4, np.int64), 1e-9)
    assert volumes[0] == _exact_volume(vertices[faces])
    assert 2 * abs(volumes[0]) / areas[0] < 1e-8


def test_a_wrong_oracle_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    wrong = (b.sphere(1) | b.cube(0.01).translate(3, 3, 3)).to_mesh()
    monkeypatch.setattr(oracle, "_mesh_of", lambda _: wrong)
    report = validate("union", b.sphere(1), b.sphere(0.5))
    assert report.verdict is Verdict.ORACLE_FAILED and report.ok
    assert "manifold3d's mesh is wrong" in report.reason
