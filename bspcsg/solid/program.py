"""Programs: serialized expressions, and their evaluation in any algebra.

A program is a list of lines, each ``("leaf", [k])`` for operand k, or an operator over earlier
lines; the last line is the result. The core executes it on trees; this module executes it on any
values with the four operations: truth values, solids of other engines, boundedness.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, Literal, TypeAlias, TypeVar

from .._types import ProgramLine
from ..errors import invalid_parameter
from ..parameters import shown
from ..suggestions import suggestion_text

Operator: TypeAlias = Literal["or", "and", "xor", "not"]

_Value = TypeVar("_Value")

#: The program that returns the complement of its only operand.
COMPLEMENT: list[ProgramLine] = [("leaf", [0]), ("not", [0])]


@dataclass(frozen=True)
class Algebra(Generic[_Value]):
    """The functions that carry out the set operations on one kind of value."""

    union: Callable[[Sequence[_Value]], _Value]
    intersection: Callable[[Sequence[_Value]], _Value]
    xor: Callable[[Sequence[_Value]], _Value]
    complement: Callable[[_Value], _Value]

    def evaluate(self, program: Sequence[ProgramLine], operands: Sequence[_Value]) -> _Value:
        """Return the result of a program, given the values of its operands."""
        values: list[_Value] = []
        for operator, arguments in program:
            if operator == "leaf":
                values.append(operands[arguments[0]])
            else:
                values.append(self._line(operator, [values[line] for line in arguments]))
        return values[-1]

    def _line(self, operator: str, found: list[_Value]) -> _Value:
        if operator == "not":
            return self.complement(found[0])
        many = {"or": self.union, "and": self.intersection, "xor": self.xor}
        return many[operator](found)


#: The algebra of truth values: whether a point is in a result, given whether it is in each operand.
TRUTH: Algebra[bool] = Algebra(
    union=any,
    intersection=all,
    xor=lambda values: sum(values) % 2 == 1,
    complement=lambda value: not value,
)


def program_of(op: str, count: int) -> list[ProgramLine]:
    """Return the program of a named set operation on `count` operands.

    Raises
    ------
    InvalidParameterError
        If there is no such operation, or no operand.
    """
    if not isinstance(op, str) or op not in _NAMED:
        message = f"Unknown operation {shown(op)}; known are {', '.join(_NAMED)}."
        raise invalid_parameter(message + suggestion_text(op, _NAMED))
    if count == 0:
        raise invalid_parameter(
            f"There are no operands, so the {op} cannot be compared; give at least one operand."
        )
    lines: list[ProgramLine] = [("leaf", [number]) for number in range(count)]
    return lines + _NAMED[op](count)


def _union(count: int) -> list[ProgramLine]:
    return [("or", list(range(count)))]


def _intersection(count: int) -> list[ProgramLine]:
    return [("and", list(range(count)))]


def _difference(count: int) -> list[ProgramLine]:
    if count == 1:
        return [("and", [0])]
    if count == 2:
        return [("not", [1]), ("and", [0, 2])]
    return [("or", list(range(1, count))), ("not", [count]), ("and", [0, count + 1])]


def _xor(count: int) -> list[ProgramLine]:
    return [("xor", [0 if k == 1 else count + k - 2, k]) for k in range(1, count)]


_NAMED: dict[str, Callable[[int], list[ProgramLine]]] = {
    "union": _union,
    "intersection": _intersection,
    "difference": _difference,
    "xor": _xor,
}


def name_of(program: Sequence[ProgramLine]) -> str:
    """Return the name of the set operation of a program, or "expression" for a longer program."""
    operators = [operator for operator, _ in program if operator != "leaf"]
    names = {"or": "union", "and": "intersection", "xor": "xor", "not": "complement"}
    if len(operators) == 1:
        return names[operators[0]]
    if operators[-1:] == ["and"] and set(operators[:-1]) == {"not"}:
        return "difference"
    return "expression"
