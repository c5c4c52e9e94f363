"""Blocks: the solids of a with statement, and how they are combined."""

import asyncio
import pickle
import threading
from pathlib import Path
from typing import Any

import pytest

import bspcsg as b
from bspcsg.solid import ledger


def test_a_difference_takes_the_first_less_the_rest() -> None:
    with b.difference() as d:
        b.cube((20, 20, 10))
        b.cube((1, 1, 10))
        b.cube((1, 1, 10)).translate(5, 5, 0)
    assert d.solid.volume == 3980


@pytest.mark.parametrize(
    ("operation", "volume"), [(b.union, 15), (b.intersection, 1), (b.xor, 14), (b.difference, 7)]
)
def test_every_operation_has_a_block(operation: Any, volume: float) -> None:
    with operation() as made:
        b.cube(2)
        b.cube(2).translate(1, 1, 1)
    assert made.solid.volume == volume


def test_functions_are_as_they_were() -> None:
    a, c = b.cube(2), b.cube(1)
    assert b.difference(a, c).volume == 7 and b.difference([a, c]).volume == 7
    assert b.union().is_empty and b.xor().is_empty and b.difference().is_empty
    assert (~b.intersection()).is_empty
    assert b.union([]).is_empty and (b.union() | a).volume == 8
    assert pickle.loads(pickle.dumps(b.union())).is_empty


def test_operations_use_their_operands_up() -> None:
    with b.union() as u:
        part = b.cube(4) - b.cube(2)
        part |= b.cube(1).translate(9, 0, 0)
    assert u.solids == (part,)
    assert u.solid.volume == 57


def test_transforms_take_the_place_of_the_original() -> None:
    with b.difference() as d:
        body = b.cube(4).translate(0, 0, 0).translate(1, 0, 0).rotate(90)
        hole = b.cube(1).mirror((1, 0, 0)).scale(2)
    assert d.solids == (body, hole)


def test_a_result_stands_where_its_first_operand_stood() -> None:
    with b.difference() as d:
        body = b.cube(4)
        hole = b.cube(1)
        whole = body | b.cube(5)
    assert d.solids == (whole, hole)
    assert d.solid.volume == 124


def test_more_copies_of_one_solid_count_each() -> None:
    with b.union() as u:
        pin = b.cube(1)
        pins = [pin.translate(2 * k, 0, 0) for k in range(4)]
    assert u.solids == tuple(pins)


def test_what_a_call_hands_back_as_it_came_counts_for_itself() -> None:
    with b.union() as u:
        pin = b.cube(1)
        kept = [b.union(pin), b.Solid.from_mesh(pin), pin.rotate(0)]
        moved = pin.translate(1, 0, 0)
    assert u.solids == (*kept, moved) and all(one.equals(pin) for one in kept)


def test_generators_inside_operations() -> None:
    with b.union() as u:
        row = b.union(b.cube(1).translate(2 * k, 0, 0) for k in range(3))
    assert u.solids == (row,)


def test_queries_use_nothing_up() -> None:
    with b.union() as u:
        a, c = b.cube(2), b.cube(1)
        assert c <= a and not a.isdisjoint(c) and not a.equals(c)
        assert (a - c).validate().ok
        assert a.volume == 8 and c.to_trimesh().volume == 1
        assert len(a.slice(1).outlines) == 1
    assert len(u.solids) == 1  # what was checked, made of both


def test_one_call_counts_once(tmp_path: Path) -> None:
    b.cube(3).save(tmp_path / "cube.off")
    (tmp_path / "part.csg").write_text("difference() { cube(2); group() cube(1); }")
    mesh = b.cube(3).to_mesh()
    with b.union() as u:
        made = [
            b.load(tmp_path / "cube.off"),
            b.load(tmp_path / "part.csg"),
            b.csg.loads("cube(2);"),
            b.Solid.from_mesh(mesh),
            b.Solid(*mesh),
            b.prism(4, h=1, r=1),
            b.cone(1, 1),
            b.extrude([(0, 0), (1, 0), (0, 1)], 1),
            b.half_space((0, 0, 1)),
            b.Solid.empty(),
        ]
    assert u.solids == tuple(made)


def test_solids_from_outside() -> None:
    base, helper = b.cube(4), b.cube(1)
    with b.difference() as d:
        d.add(base)
        helper.translate(1, 1, 1)
        gone = b.cube(3)
        d.discard(gone, helper)
    assert d.solid.volume == 63


def test_blocks_nest() -> None:
    with b.union() as outer:
        b.cube(1)
        with b.difference() as inner:
            b.cube(4).translate(5, 0, 0)
            with b.intersection() as innermost:
                b.cube(2).translate(5, 0, 0)
                b.cube(2).translate(6, 1, 1)
        b.cube(1).translate(0, 0, 5)
    assert innermost.solid.volume == 1
    assert inner.solid.volume == 63
    assert len(outer.solids) == 3 and outer.solids[1] is inner.solid
    assert outer.solid.volume == 65


def test_a_block_uses_up_what_counted_around_it() -> None:
    with b.union() as outer:
        body = b.cube(4)
        with b.difference() as inner:
            inner.add(body)
            b.cube(1)
    assert outer.solids == (inner.solid,)
    assert outer.solid.volume == 63


def test_a_solid_of_a_block_may_be_moved_in_the_block_around_it() -> None:
    with b.union() as outer:
        with b.union() as inner:
            b.cube(1)
        moved = inner.solid.translate(1, 0, 0)
    assert outer.solids == (moved,)


def test_an_empty_block_is_the_operation_on_nothing() -> None:
    with b.difference() as d:
        pass
    with b.intersection() as i:
        pass
    assert d.solid.is_empty and not i.solid.is_bounded


def test_errors_leave_no_solid_and_no_open_block() -> None:
    with b.union() as outer:
        with pytest.raises(ZeroDivisionError), b.union() as inner:
            b.cube(1)
            raise ZeroDivisionError
        b.cube(2)
    assert outer.solid.volume == 8
    with pytest.raises(b.InvalidMeshError) as caught:
        _ = inner.solid
    assert caught.value.code == "open_block"
    assert ledger.current_ledger() is None


def test_an_open_block_has_no_solid_yet() -> None:
    with b.union() as u, pytest.raises(b.InvalidMeshError, match="after its with statement"):
        _ = u.solid
    with pytest.raises(b.InvalidMeshError, match="has ended"):
        u.add(b.cube(1))


def test_only_solids_are_added() -> None:
    with b.union() as u, pytest.raises(b.InvalidMeshError, match="not int"):
        u.add(7)  # type: ignore[arg-type]


def test_one_opening_may_be_entered_again() -> None:
    opening = b.union()
    with opening as outer:
        b.cube(1)
        with opening as inner:
            b.cube(2)
    assert inner.solid.volume == 8 and outer.solid.volume == 8
    assert outer.solids == (outer.solids[0], inner.solid)


def test_threads_do_not_see_the_blocks_of_others() -> None:
    made: list[b.Solid] = []
    with b.union() as u:
        thread = threading.Thread(target=lambda: made.append(b.cube(3)))
        thread.start()
        thread.join()
        b.cube(1)
    assert len(made) == 1 and u.solid.volume == 1


def test_blocks_of_many_threads_at_once() -> None:
    volumes: dict[int, float] = {}
    barrier = threading.Barrier(8)

    def work(number: int) -> None:
        with b.union() as u:
            for k in range(5):
                barrier.wait()
                b.cube(1).translate(2 * k, 0, number)
        volumes[number] = u.solid.volume

    threads = [threading.Thread(target=work, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert volumes == dict.fromkeys(range(8), 5)


def test_tasks_have_blocks_of_their_own() -> None:
    async def work(size: float) -> float:
        with b.union() as u:
            b.cube(size)
            await asyncio.sleep(0)
            b.cube(size).translate(0, 0, 10)
            await asyncio.sleep(0)
        return u.solid.volume

    async def main() -> list[float]:
        return list(await asyncio.gather(work(1), work(2), work(3)))

    assert asyncio.run(main()) == [2, 16, 54]


def test_a_task_counts_in_the_block_that_it_was_started_in_while_that_is_open() -> None:
    async def main() -> tuple[b.Solid, ...]:
        again = asyncio.Event()

        async def work() -> None:
            b.cube(1)
            await again.wait()
            b.cube(2)

        with b.union() as u:
            task = asyncio.create_task(work())
            await asyncio.sleep(0)
            await asyncio.to_thread(b.cube, 3)
        again.set()
        await task
        return u.solids

    assert [solid.volume for solid in asyncio.run(main())] == [1, 27]


# Found: in a block, `align` consumed the target solid, to which another is aligned.
def test_what_a_solid_is_aligned_with_still_counts() -> None:
    with b.union() as u:
        table = b.box((8, 8, 1))
        b.cube(2).align(x="center", z=("min", "max"), to=table)
    assert u.solid.volume == 72


# Found: in a block, `hull` of a generator consumed none of its operands.
def test_hulls_use_up_what_any_iterable_holds() -> None:
    with b.xor() as x:
        pins = [b.cube(1), b.cube(1).translate(3, 0, 0)]
        b.hull(pin for pin in pins)
    assert x.solid.volume == 4
