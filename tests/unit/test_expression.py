"""Expressions that are not evaluated yet: plans, sharing, depth, and freed memory."""

import gc
import threading
import weakref

import numpy as np
import pytest

import bspcsg as b
from bspcsg.solid.expression import Pending, evaluate, make_plan
from bspcsg.solid.leaf import TreeLeaf


def operators(solid: b.Solid) -> list[str]:
    return [name for name, _ in make_plan(solid._node).program]


def test_nested_unions_become_one_line() -> None:
    cubes = [b.cube(1).translate(k, 0, 0) for k in range(5)]
    plan = make_plan(sum(cubes)._node)  # type: ignore[union-attr]
    assert plan.program[-1] == ("or", [0, 1, 2, 3, 4])
    assert len(plan.operands) == 5


def test_a_chain_of_differences_becomes_one_line() -> None:
    solid = b.cube(3) - b.cube(1) - b.sphere(1) - b.cone(1, 1)
    assert operators(solid).count("and") == 1
    assert operators(solid).count("not") == 3


def test_operands_come_in_reading_order_and_once() -> None:
    a, c, d = b.cube(1), b.cube(2), b.cube(3)
    plan = make_plan(((d - a) | (c & a) | d)._node)
    assert [operand.node for operand in plan.operands] == [d._node, a._node, c._node]


def test_a_shared_operation_keeps_one_line() -> None:
    shared = b.cube(1) | b.cube(2)
    plan = make_plan(((shared | b.cube(3)) ^ shared)._node)
    assert [name for name, _ in plan.program].count("or") == 2
    assert len(plan.operands) == 3


def test_double_complement_is_the_original() -> None:
    a = b.cube(1)
    assert (~~a)._node is a._node
    moved = a.translate(1, 0, 0)
    assert (~~moved)._node is a._node
    assert (~~moved)._factors == moved._factors


def test_common_factors_move_to_the_result() -> None:
    a, c = b.cube(1).rotate(30), b.cube(1).translate(1, 0, 0).rotate(30)
    union = a | c
    assert len(union._factors) == 1
    assert [len(operand.factors) for operand in union._node.content.operands] == [0, 1]  # type: ignore[union-attr]


def test_a_complement_takes_its_transform_inside() -> None:
    difference = b.cube(3) - b.cube(1).rotate(30)
    plan = make_plan(difference._node)
    assert [name for name, _ in plan.program] == ["leaf", "leaf", "not", "and"]
    assert len(plan.operands[1].factors) == 1


def test_moved_sub_expressions_are_operands_of_their_own() -> None:
    part = (b.cube(2) - b.cube(1)).rotate(30)
    plan = make_plan((part | b.cube(5))._node)
    assert isinstance(plan.operands[0].node.content, Pending)
    assert [name for name, _ in plan.program] == ["leaf", "leaf", "or"]


def test_building_does_not_evaluate_and_evaluating_is_kept() -> None:
    solid = b.cube(2) - b.cube(1)
    assert isinstance(solid._node.content, Pending)
    leaf = evaluate(solid._node)
    assert isinstance(leaf, TreeLeaf)
    assert evaluate(solid._node) is leaf


def test_evaluation_lets_the_graph_go() -> None:
    inner = b.cube(2) - b.cube(1)
    watched = weakref.ref(inner._node)
    outer = inner | b.sphere(1, 8)
    del inner
    assert watched() is not None
    assert outer.volume > 0
    gc.collect()
    assert watched() is None


def test_a_long_chain_keeps_only_its_last_operation() -> None:
    solid = b.cube(100)
    watched = []
    for k in range(20):
        solid = solid - b.cube(1).translate(2 * k, 0, 0)
        assert not solid.is_empty
        watched.append(weakref.ref(solid._node.content))
    gc.collect()
    assert [reference() is not None for reference in watched[:-1]] == [False] * 19


@pytest.mark.parametrize("count", [5_000, pytest.param(50_000, marks=pytest.mark.deep)])
def test_deep_expressions_need_no_deep_stack(count: int) -> None:
    a, c = b.cube(1), b.cube(2)
    solid = a
    for k in range(count):
        solid = (solid | c) if k % 2 else (solid & c)
    assert len(make_plan(solid._node).operands) == 2
    assert repr(solid) == "Solid(pending: 2 operands)"
    del solid
    gc.collect()


def test_deep_nesting_under_transforms_is_evaluated_from_within() -> None:
    solid = b.cube(1)
    for _ in range(200):
        solid = (solid | b.cube(1)).translate(1, 0, 0)
    assert solid.volume == 200


def test_threads_may_ask_the_same_solid() -> None:
    solid = sum(b.cube(1).translate(k, 0, 0) for k in range(8))
    assert isinstance(solid, b.Solid)
    answers: list[float] = []
    threads = [threading.Thread(target=lambda: answers.append(solid.volume)) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert answers == [8.0] * 8


def test_a_failed_evaluation_leaves_the_expression_as_it_was() -> None:
    far = b.cube(1).translate(1e12, 0, 0)
    solid = b.sphere(1) | far
    for _ in range(2):
        with pytest.raises(b.LimitError) as caught:
            solid.to_mesh()
        assert caught.value.code == "too_large"
    assert far.volume == 1


def test_the_last_operation_is_remembered() -> None:
    a, c = b.cube(2), b.cube(1).translate(1.5, 0, 0)
    result = a - c
    operation = result.last_operation
    assert operation is not None
    assert [name for name, _ in operation.program] == ["leaf", "leaf", "not", "and"]
    assert [operand.volume for operand in operation.operands] == [8, 1]
    assert operation.result.equals(result)
    assert a.last_operation is None


def test_the_last_operation_leaves_a_common_transform_out() -> None:
    turned = (b.cube(2) - b.cube(1)).rotate(30)
    operation = turned.last_operation
    assert operation is not None
    assert operation.result.bounds is not None
    assert np.array_equal(operation.result.bounds, [[0, 0, 0], [2, 2, 2]])


# Found: half-spaces that were turned, complemented and looked at some 200 times ended in a
# `RecursionError`.
def test_operands_of_unbounded_sets_move_at_any_depth() -> None:
    """What was made of half-spaces has no mesh: it moves by its operands, and those by theirs."""
    solid = plane = b.half_space((1, 2, 3), 0.5)
    for _ in range(250):
        solid, plane = ~solid.rotate(1), plane.rotate(1)
        assert not solid.is_empty
    assert solid == plane


def test_a_profile_tells_the_stages_and_why_work_was_handed_on() -> None:
    cube = b.cube(2)
    pair = (cube - b.cube(1).translate(1.5, 1.5, 1.5)).profile()
    assert [stage.name for stage in pair.stages] == ["candidates", "contacts", "faces"]
    assert all(stage.count > 0 and stage.seconds >= 0 for stage in pair.stages)
    assert pair.handed_on is None
    assert [(k.name, k.asked, k.took) for k in pair.kernels] == [
        *[("arrangement", 1, 1), ("orthogonal", 0, 0), ("general", 0, 0), ("trees", 0, 0)]
    ]
    made = cube - b.cube(1).translate(-0.5, -0.5, -0.5)
    assert made.volume == 7.875
    step = (made - b.cube(1).translate(1.5, 1.5, 1.5)).profile()
    assert [stage.name for stage in step.stages] == ["descent"]
    assert "different, unchanged input meshes" in str(step)
    assert "orthogonal: asked 1, took 1\n" in str(step)
    (reason,) = step.kernels[0].refused
    assert "different, unchanged input meshes" in reason and step.kernels[0].took == 0
    three = (cube - b.cube(1) - b.cube(1).translate(1.5, 1.5, 1.5)).profile()
    assert three.handed_on is None and three.kernels[0].took == 1
    vertices, faces = cube.to_mesh().vertices, cube.to_mesh().faces
    twice = b.Solid(np.vstack([vertices, vertices + 1]), np.vstack([faces, faces + 8]))
    resolved = (twice - b.cube(1).translate(1.5, 1.5, 1.5)).profile()
    assert "own pairs" in [stage.name for stage in resolved.stages]
    assert "pairs of faces" in str(resolved)
    apart = (cube | b.cube(1).translate(5, 5, 5)).profile()
    assert "do not overlap" in (apart.handed_on or "")
    assert (
        str(apart).splitlines()[-1]
        == "left to the descent: the bounding boxes of the meshes do not overlap"
    )
    assert cube.profile().lines() == []


def test_a_profile_tells_which_kernels_were_asked_and_why_they_refused() -> None:
    turned = [b.cube(2).rotate(20 * k, (1, 2, 3)) for k in range(5)]
    crossing = b.union(turned).profile()
    orthogonal, general, _ = crossing.kernels[1:]
    assert orthogonal.refused == {"faces not perpendicular to axes": orthogonal.asked}
    assert general.took > 0
    assert all(k.asked == k.took + sum(k.refused.values()) for k in crossing.kernels)
    touching = b.union([*turned, turned[0].rotate(90, (1, 2, 3))]).profile()
    assert "general: asked" in str(touching)
