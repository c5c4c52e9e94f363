"""Programs of set operations, evaluated in any algebra."""

import operator
from collections.abc import Callable, Sequence
from functools import partial, reduce
from itertools import product

import pytest

from bspcsg import InvalidMeshError
from bspcsg.solid.program import COMPLEMENT, TRUTH, Algebra, name_of, program_of

MEANING: dict[str, Callable[[Sequence[bool]], bool]] = {
    "union": any,
    "intersection": all,
    "difference": lambda inside: inside[0] and not any(inside[1:]),
    "xor": lambda inside: sum(inside) % 2 == 1,
}

#: Regions of eight cells as whole numbers: another algebra for the same programs.
BITS: Algebra[int] = Algebra(
    union=partial(reduce, operator.or_),
    intersection=partial(reduce, operator.and_),
    xor=partial(reduce, operator.xor),
    complement=partial(operator.xor, 0xFF),
)


@pytest.mark.parametrize("count", [1, 2, 3, 4])
@pytest.mark.parametrize("op", MEANING)
def test_named_programs_mean_what_their_names_say(op: str, count: int) -> None:
    program = program_of(op, count)
    for inside in product((False, True), repeat=count):
        assert TRUTH.evaluate(program, inside) == MEANING[op](inside)


def test_every_algebra_carries_out_the_same_program() -> None:
    operands = [0b1111_0000, 0b1100_1100, 0b1010_1010]
    for op in MEANING:
        program = program_of(op, 3)
        cells = BITS.evaluate(program, operands)
        for cell in range(8):
            inside = [bool(operand >> cell & 1) for operand in operands]
            assert bool(cells >> cell & 1) == TRUTH.evaluate(program, inside)


def test_the_complement_of_the_only_operand() -> None:
    assert BITS.evaluate(COMPLEMENT, [0b0000_1111]) == 0b1111_0000


@pytest.mark.parametrize("op", MEANING)
def test_programs_of_two_operands_have_the_names_they_were_made_by(op: str) -> None:
    assert name_of(program_of(op, 2)) == op
    assert name_of(COMPLEMENT) == "complement"
    assert name_of([*program_of("union", 2), ("not", [2])]) == "expression"


@pytest.mark.parametrize(("op", "count"), [("sum", 2), ("union", 0)])
def test_what_is_no_operation_is_refused(op: str, count: int) -> None:
    with pytest.raises(InvalidMeshError, match=r"no operands|Unknown operation"):
        program_of(op, count)
