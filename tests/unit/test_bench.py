"""The parts of the benchmarks: their meshes, error bounds, and targets."""

import sys
import tempfile
import time
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import bspcsg as b
from bspcsg._types import MeshArrays
from bspcsg.bench import (
    command_line,
    dense_meshes,
    engines,
    meter,
    public_meshes,
    runner,
    shapes,
    table,
)
from bspcsg.bench.cases import CASES, SHORT
from bspcsg.bench.dense_cases import DENSE_CASES
from bspcsg.bench.engines import Operation
from bspcsg.bench.result_facts import facts_of, mesh_volume
from bspcsg.bench.runner import with_volumes_compared
from bspcsg.bench.targets import (
    DoublingTarget,
    Faster,
    GrowthTarget,
    MeanFaster,
    ScratchWithin,
    SteadySteps,
    StepWithin,
    Within,
    WorkWithin,
)
from bspcsg.bench.worker import Task, perform
from bspcsg.bench.workloads import Expression, OneMesh, OverlappingPair, Pair, PairAsBalls, Work
from bspcsg.machine import machine
from support.shapes import exact_volume


@pytest.mark.parametrize("n", [1, 2, 5])
def test_octaspheres_are_closed_and_have_8_n_squared_triangles(n: int) -> None:
    facts = facts_of(shapes.octasphere(n))
    assert (facts.triangles, facts.euler_number, facts.open_edges) == (8 * n * n, 2, 0)
    assert 0 < facts.volume < 4 / 3 * np.pi


def test_all_shapes_are_closed() -> None:
    block, balls = shapes.dome(3)
    meshes = [block, *balls, *shapes.needles(20), *shapes.random_boxes(3)]
    meshes += [shapes.icosphere(1), *shapes.drilled_plate(2)[1], *shapes.drilled_cube(2)[1]]
    meshes += [*shapes.milled_by_balls(30)[1], *shapes.milled_by_cylinders(30)[1]]
    for mesh in meshes:
        facts = facts_of(mesh)
        assert facts.open_edges == 0 and facts.euler_number == 2
        assert facts.volume > 0


@pytest.mark.parametrize("name", DENSE_CASES)
def test_operands_of_dense_places_are_closed_and_twice_as_many(name: str, tmp_path: Path) -> None:
    less, more = (make(tmp_path) for make in DENSE_CASES[name].small.values())
    for work in (less, more):
        for mesh in _operands(work):
            facts = facts_of(mesh)
            pieces = trimesh.Trimesh(*mesh, process=False).body_count
            assert facts.open_edges == 0 and facts.euler_number == 2 * pieces
            assert facts.volume > 0
    # Base and plate count once; a ball has whole rows.
    assert 1.5 <= more.extent().triangles / less.extent().triangles <= 8


def _operands(work: Work) -> list[MeshArrays]:
    if isinstance(work, OneMesh):
        return list(work.parts)
    if isinstance(work, Pair):
        return [work.first, work.second]
    assert isinstance(work, Expression)
    return [work.base, *(mesh for group in work.groups for mesh in group)]


def test_needles_of_a_bundle_are_apart() -> None:
    bundle, _ = dense_meshes.bundles(20)
    lows = bundle[0].reshape(20, 4, 3).min(axis=1)
    highs = bundle[0].reshape(20, 4, 3).max(axis=1)
    for i in range(20):
        overlap = (lows[i] <= highs).all(axis=1) & (lows <= highs[i]).all(axis=1)
        assert overlap.sum() == 1


@pytest.mark.parametrize("depth", [1, 2, 3])
def test_holes_of_the_sponge_are_disjoint_and_leave_20_of_27_each(depth: int) -> None:
    cube, (along_x, along_y, along_z) = shapes.menger(depth)
    side = 3**depth
    left = np.ones((side,) * 3, dtype=bool)
    for holes in (along_x, along_y, along_z):
        assert len(holes) == (8**depth - 1) // 7
        for vertices, _ in holes:
            low, high = vertices.min(axis=0).astype(int), vertices.max(axis=0).astype(int)
            left[tuple(slice(a, b) for a, b in zip(low, high, strict=True))] = False
    assert Fraction(int(left.sum()), side**3) == Fraction(20, 27) ** depth
    assert exact_volume(cube) == side**3


def test_the_error_of_a_volume_is_bounded() -> None:
    far = shapes.moved(shapes.octasphere(3), (1e3, -2e3, 5e2))
    # Coordinates in steps of the lattice, so that the exact volume is that of the doubles.
    far = np.round(far[0], 6), far[1]
    found = mesh_volume(far)
    assert abs(Fraction(found.value) - exact_volume(far)) <= Fraction(found.error)
    assert found.error < 1e-9


def test_tools_of_the_swept_chain_are_turned_right_side_out(shared_meshes: Path) -> None:
    base, tools = public_meshes.swept_capsules(shared_meshes.parent)
    assert mesh_volume(base).value == pytest.approx(1)
    assert len(tools) == 100
    assert all(mesh_volume(tool).value > 0 for tool in tools)


def _result(seconds: float, volume: float = 1.0, **more: Any) -> dict[str, Any]:
    facts = {"volume": volume, "volume_error": 1e-15, "euler_number": 2, "open_edges": 0}
    return {
        "state": "ok",
        "median": seconds,
        "cpu": seconds,
        "volumes": [volume],
        "runs": 1,
        "facts": facts,
    } | more


def _item(ours: float, theirs: float, volume: float = 1.0, **more: Any) -> dict[str, Any]:
    engines = {"bspcsg": _result(ours), "manifold3d": _result(theirs, volume)}
    return with_volumes_compared(
        {"item": "x", "area": 6.0, "size": 1.0, "engines": engines, **more}
    )


def test_ratios_count_only_if_answers_agree() -> None:
    right, wrong = _item(1.0, 4.0), _item(1.0, 9.0, volume=1.0001)
    assert right["engines"]["manifold3d"]["agrees"]
    assert not wrong["engines"]["manifold3d"]["agrees"]
    assert Faster(4).reached([right, wrong]).met
    assert Faster(4).reached([right, wrong]).value == 4
    assert Faster(4).reached([wrong]).value is None


def test_the_least_ratio_counts_and_the_mean_is_geometric() -> None:
    items = [_item(1.0, 2.0), _item(1.0, 8.0)]
    assert Faster(3).reached(items).met is False
    assert MeanFaster(4).reached(items).value == pytest.approx(4)


def test_an_engine_that_was_stopped_gives_a_bound() -> None:
    stopped = {"state": "stopped", "median": None, "stopped_after": 30.0}
    item = {"engines": {"bspcsg": _result(1.0), "manifold3d": stopped}}
    enough, too_little = Faster(20).reached([item]), Faster(50).reached([item])
    assert (enough.met, enough.text) == (True, "> 30 ×")
    assert too_little.met is None


def test_times_and_their_growth() -> None:
    items = [_item(1e-6 * n**1.1, 1.0, triangles=n) for n in (10_000, 40_000, 160_000)]
    assert GrowthTarget(1.05).reached(items).value == pytest.approx(1.1)
    assert GrowthTarget(1.05).reached(items).met is False
    missing = {"triangles": 640_000, "engines": {"bspcsg": {"state": "stopped"}}}
    assert GrowthTarget(1.2).reached(items).met
    assert GrowthTarget(1.2).reached([*items, missing]).met is None
    assert Within(1.0).reached(items).met
    chain = _result(1.0, windows={"thousandth": 0.002, "last": 0.005})
    steady = SteadySteps(2).reached([{"engines": {"bspcsg": chain}}])
    assert (steady.value, steady.met) == (2.5, False)


def _sized(triangles: int, answer: int, cpu: float) -> dict[str, Any]:
    found = _result(cpu)
    found["facts"]["triangles"] = answer
    return {"triangles": triangles, "engines": {"bspcsg": found}}


def test_cost_may_grow_as_input_and_answer_and_a_little_more() -> None:
    small = _sized(100, 300, 1.0)
    steady = DoublingTarget().reached([small, _sized(200, 600, 2.2)])
    assert steady.value == pytest.approx(1.1) and steady.met
    # The answer is four times as large.
    assert DoublingTarget().reached([small, _sized(200, 1200, 4.0)]).met
    assert DoublingTarget().reached([small, _sized(200, 600, 2.4)]).met is False
    # An answer that stays small is no reason to be faster than reading takes.
    assert DoublingTarget().reached([small, _sized(200, 10, 2.2)]).met
    assert DoublingTarget().reached([small]).met is None


def test_a_size_at_which_we_are_stopped_is_a_cliff() -> None:
    stopped = {"state": "stopped", "median": None, "cpu": None, "stopped_after": 30.0}
    items = [_sized(100, 300, 1.0), {"triangles": 200, "engines": {"bspcsg": stopped}}]
    assert DoublingTarget().reached(items).met is False


def test_the_mean_says_over_how_many_and_what_processors_did() -> None:
    items = [_item(1.0, 2.0), _item(1.0, 8.0), _item(1.0, 9.0, volume=1.0001)]
    assert MeanFaster(4).reached(items).text == "4 × (processor 4 ×) over 2 of 3"


def test_work_steps_and_scratch_are_held_against_what_is_allowed() -> None:
    chain = _result(0.3, parts={"build": 5.0, "steps": 0.2}, steps=1000)
    items = [{"triangles": 1_000_000, "engines": {"bspcsg": chain}}]
    assert WorkWithin(0.3).reached(items).met and not WorkWithin(0.29).reached(items).met
    assert StepWithin(0.2e-3).reached(items).met and not StepWithin(0.19e-3).reached(items).met
    assert StepWithin(1).reached([_item(1.0, 1.0)]).met is None
    chain |= {"memory_mb": 100.0, "answer_mb": 40.0}
    assert ScratchWithin(60).reached(items).value == 60
    assert not ScratchWithin(59).reached(items).met
    assert WorkWithin(1).reached([{"engines": {}}]).met is False


def test_huge_spheres_are_compared_with_balls() -> None:
    work = CASES["huge"].small["2 × 2048"](Path())
    assert isinstance(work, PairAsBalls)
    first, second = b.Solid(*work.first), b.Solid(*work.second)
    vertices, faces = (first - second).to_mesh()
    assert work.proof((vertices, faces)).agrees
    assert not work.proof((vertices * 1.1, faces)).agrees
    corners = np.linalg.norm(work.first[0][work.first[1]].mean(axis=1), axis=1)
    assert 1 - corners.min() <= work.depth


def test_sets_that_overlap_themselves_are_checked_at_points() -> None:
    first = shapes.joined(dense_meshes.turned_cubes(3))
    work = OverlappingPair(first, shapes.box((0, 0, 0), (1, 1, 1)), samples=30)
    vertices, faces = b.difference(b.Solid(*first), b.Solid(*work.second)).to_mesh()
    assert work.proof((vertices, faces)).agrees
    assert not work.proof(first).agrees


@pytest.mark.parametrize("operation", ["union", "intersection", "difference"])
def test_a_result_of_another_operation_is_refuted(operation: Operation) -> None:
    first, second = shapes.box((0, 0, 0), (1, 1, 1)), shapes.box((0.5, 0, 0), (2, 1, 1))
    work = OverlappingPair(first, second, operation, samples=30)
    ours = engines.ENGINES["bspcsg"]()
    assert work.proof(ours.boolean(first, second, operation)).agrees
    other: Operation = "union" if operation != "union" else "difference"
    assert not work.proof(ours.boolean(first, second, other)).agrees


def test_real_pairs_are_drawn_from_all_solids_that_are_not_too_large(shared_meshes: Path) -> None:
    shared = shared_meshes.parent
    pairs, names = public_meshes.real_pairs(shared), public_meshes.solid_names(shared)
    drawn = {name for pair in pairs for name in pair.names}
    assert len(pairs) == 60 and len(names) > 90 and drawn < {*names}
    first, second = pairs[0].meshes(shared)
    assert facts_of(first).open_edges == facts_of(second).open_edges == 0
    assert np.ptp(first[0], axis=0).max() == pytest.approx(1)
    assert np.abs(first[0].mean(axis=0)).max() < 1e-12
    assert np.abs(second[0].mean(axis=0)).max() <= 0.25
    turn = pairs[0].turn
    assert np.allclose(turn @ turn.T, np.eye(3)) and np.linalg.det(turn) > 0


def test_rotations_by_quaternions() -> None:
    for w, x, y, z in np.random.default_rng(1).normal(size=(9, 4)):
        turn = shapes.rotation_of(np.array([w, x, y, z]))
        expected = np.array(
            [w * w + x * x - y * y - z * z, 2 * (x * y + w * z), 2 * (x * z - w * y)]
        )
        assert np.allclose(turn[:, 0], expected / (w * w + x * x + y * y + z * z))
        assert np.allclose(turn @ (x, y, z), (x, y, z))


def test_real_pairs_belong_to_the_case_of_their_kind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(public_meshes, "kinds", lambda _: ["tiny", "overlap", "tiny"])
    labels = CASES["tiny-pairs"].labels(Path(), small=False)
    assert labels[::2] == ["pair 0, union", "pair 0, difference", "pair 2, intersection"]
    assert {*labels} < {*CASES["tiny-pairs"].items}
    assert CASES["tiny-pairs"].labels(Path(), small=True) == labels[:2]
    assert CASES["overlap-pairs"].labels(Path(), small=False)[0] == "pair 1, union"
    assert CASES["large-pairs"].labels(Path(), small=False) == []


def test_kinds_of_pairs() -> None:
    ball, box = shapes.octasphere(12), shapes.box((0, 0, 0), (1, 1, 1))
    overlapping = shapes.joined(dense_meshes.turned_cubes(2))
    assert public_meshes.kind_of((box, box)) == "tiny"
    assert public_meshes.kind_of((ball, box)) == "medium"
    assert public_meshes.kind_of((shapes.octasphere(25), box)) == "large"
    assert public_meshes.kind_of((ball, overlapping)) == "overlap"


def test_remarks_name_the_worst_results() -> None:
    items = [_item(2.0, k, triangles=90, names=["a.stl", "b.off"]) for k in (1.0, 6.0)]
    row = {"case": "tiny-pairs", "title": "pairs", "small": True, "items": items}
    assert table.remarks({"cases": [row]}) == [
        "Worst: 0.5 × (processor 0.5 ×) manifold3d, tiny-pairs, x of a.stl and b.off"
        " (90 triangles), 2 s / 2 s (1) against 1 s / 1 s (1).",
        "Worst: 3 × (processor 3 ×) manifold3d, tiny-pairs, x of a.stl and b.off"
        " (90 triangles), 2 s / 2 s (1) against 6 s / 6 s (1).",
    ]


def test_the_command_line_is_metered_in_a_process_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    work = CASES["files-unchecked"].small["2 × 5 120"](Path())
    assert isinstance(work, command_line.CommandLine)
    ours = engines.ENGINES["bspcsg"]()
    done = work.run(ours, work.prepare(ours), lambda _: None)
    assert done.process is not None and 20 < done.process.peak_mb < 500
    assert done.process.cpu > 0 and done.process.seconds > 0
    assert work.proof(done.mesh).agrees
    assert not work.proof(work.first).agrees
    assert {path.name for path in work.folder.iterdir()} == {"a.stl", "b.stl", "c.stl"}
    wrong = command_line.CommandLine(work.first, work.second, ("--no-such-option",))
    with pytest.raises(engines.EngineError, match="help"):
        wrong.run(ours, wrong.prepare(ours), lambda _: None)


def test_a_meter_tells_exit_codes_and_memory_of_the_command_alone() -> None:
    held = np.ones(30_000_000)
    said = "import sys; a = b'x' * 50_000_000; sys.stderr.write('no'); sys.exit(3)"
    found = meter.run_metered([sys.executable, "-c", said])
    assert (found.code, found.said) == (3, "no")
    assert 50 < found.peak_mb < held.nbytes / 1e6


def test_items_that_do_not_fit_are_left_out_and_named(monkeypatch: pytest.MonkeyPatch) -> None:
    none_left = {**machine(), "memory_gb": 1.0}
    monkeypatch.setattr(runner, "machine", lambda: none_left)
    row = runner.run_case("huge", runner.Settings(["bspcsg"]), lambda _: None)
    assert row["items"] == [] and list(row["too_large"]) == list(CASES["huge"].items)
    record = {"cases": [row]}
    assert "huge, 2 × 20 M: left out, needs 18 GB of memory" in "\n".join(table.remarks(record))
    assert table.lines_of({**record}, titles=False)[1][2] == "—"


def test_remarks_name_what_was_missed() -> None:
    slow = _item(2.0, 1.0, triangles=100)
    slow["engines"]["bspcsg"]["facts"]["triangles"] = 50
    twice = _item(5.0, 6.0, triangles=200)
    twice["engines"]["bspcsg"]["facts"]["triangles"] = 100
    rows = [
        {"case": "dense-cones", "title": "cones", "items": [slow, twice]},
        {"case": "menger-3", "title": "sponge", "items": [_item(1.0, 8.5)]},
        {"case": "menger-4", "title": "sponge", "items": [{"item": "x", "engines": {}}]},
        {"case": "cubes", "title": "cubes", "small": True, "items": [_item(1.0, 1.0)]},
    ]
    assert table.remarks({"cases": rows}) == [
        "Reached: 1 of 4 targets. Missed: dense-cones. No figure: menger-4.",
        "Dense places: 1. Slower than manifold3d: 1 (dense-cones)."
        " Cost grows more than allowed: 1 (dense-cones).",
    ]


def test_what_is_measured_without_names_are_cases() -> None:
    assert {*SHORT} < {*CASES}


def test_short_work_is_repeated_and_counted_by_call() -> None:
    said: list[dict[str, Any]] = []
    task = Task("cubes", "2 × 12", True, ["bspcsg"], runs=1, budget=9, shared=".")
    began = time.perf_counter()
    perform(task, said.append)
    first, second = (line for line in said if line["say"] == "run")
    rest = time.perf_counter() - began - first["seconds"]
    # A first call of less than 2 ms plans ten for the second run, and all fit into what is left.
    assert 0 < 10 * second["seconds"] < rest
    assert first["faults"] >= 0 < first["answer_mb"]


def test_an_engine_that_uses_up_its_budget_has_one_run() -> None:
    said: list[dict[str, Any]] = []
    task = Task("cubes", "2 × 12", True, ["bspcsg"], runs=5, budget=1e-9, shared=".")
    perform(task, said.append)
    assert [line["say"] for line in said] == ["extent", "begin", "plan", "run", "end"]
    assert said[3]["facts"]["euler_number"] == 2
