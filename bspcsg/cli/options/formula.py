"""Parsing of set formulas over file names, such as ``(a.stl - b.stl) | "my part.stl"``.

Operators bind as Python's do: ``~`` before ``+ -`` before ``&`` before ``^`` before ``|``. A name
without quotes ends at a blank, a parenthesis, a quote or one of ``| & ^``; it may contain
``+ - ~``, which are operators only where a name could begin.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

_Value = TypeVar("_Value")

#: The characters that end a name without quotes, and those that are operators only where a name
#: could begin.
_ENDS = "|&^()\"'"
_SIGNS = "+-~"

#: Binary operators by precedence, the lowest first, each with the name of its operation.
_LEVELS: tuple[dict[str, str], ...] = (
    {"|": "union"},
    {"^": "xor"},
    {"&": "intersection"},
    {"+": "union", "-": "difference"},
)

#: The largest depth of nested parentheses and complements.
_MAX_DEPTH = 100


class FormulaError(Exception):
    """An error: a text is no valid formula.

    Parameters
    ----------
    message : str
    column : int
        The column of the error, counted from 0.
    """

    def __init__(self, message: str, column: int) -> None:
        super().__init__(message, column)
        self.message = message
        self.column = column


@dataclass(frozen=True)
class File:
    """A file name in a formula, and its column, counted from 0."""

    name: str
    column: int


@dataclass(frozen=True)
class NamedOperation:
    """An operation of a formula: union, difference, intersection, xor or complement."""

    name: str
    operands: "tuple[Formula, ...]"


Formula: TypeAlias = File | NamedOperation


@dataclass(frozen=True)
class _Token:
    """A token of a formula: an operator or parenthesis, a file name, or the end."""

    kind: str
    text: str
    column: int


def parse(text: str) -> Formula:
    """Parse a set formula over file names.

    Raises
    ------
    FormulaError
        If the text is no formula; the error has the column.
    """
    if not text.strip():
        raise FormulaError(
            "the formula is empty; give file names joined by operators, as in 'a.stl - b.stl'.", 0
        )
    parser = _Parser(_tokens(text))
    found = parser.level(0, 0)
    parser.expect("end", "an operator or the end of the formula")
    return found


def files_of(formula: Formula) -> list[File]:
    """Return the files of a formula, each once, in the order of their first occurrence."""
    found: dict[str, File] = {}
    waiting = [formula]
    while waiting:
        node = waiting.pop()
        if isinstance(node, File):
            found.setdefault(node.name, node)
        else:
            waiting.extend(reversed(node.operands))
    return list(found.values())


def subtracted(formula: Formula) -> set[str]:
    """Return the names of files that the formula subtracts or complements at every occurrence."""
    signs: dict[str, set[bool]] = {}
    waiting = [(formula, True)]
    while waiting:
        node, added = waiting.pop()
        if isinstance(node, File):
            signs.setdefault(node.name, set()).add(added)
            continue
        for number, operand in enumerate(node.operands):
            turned = node.name == "complement" or (node.name == "difference" and number > 0)
            waiting.append((operand, added != turned))
    return {name for name, found in signs.items() if found == {False}}


def evaluated(
    formula: Formula,
    leaf: Callable[[File], _Value],
    combine: Callable[[str, list[_Value]], _Value],
) -> _Value:
    """Evaluate a formula: `leaf` returns a file's value, `combine` an operation's value."""
    # Chains such as a - b - c are nested on the left, maybe deeper than the limit of recursion.
    leaning: list[NamedOperation] = []
    while isinstance(formula, NamedOperation):
        leaning.append(formula)
        formula = formula.operands[0]
    value = leaf(formula)
    for node in reversed(leaning):
        others = [evaluated(operand, leaf, combine) for operand in node.operands[1:]]
        value = combine(node.name, [value, *others])
    return value


def _tokens(text: str) -> list[_Token]:
    tokens: list[_Token] = []
    at = 0
    while at < len(text):
        letter = text[at]
        if letter.isspace():
            at += 1
        elif letter in "\"'":
            end = text.find(letter, at + 1)
            if end < 0:
                raise FormulaError("this quotation mark has no closing mark.", at)
            if end == at + 1:
                raise FormulaError("the file name between these quotation marks is empty.", at)
            tokens.append(_Token("file", text[at + 1 : end], at))
            at = end + 1
        elif letter in _ENDS + _SIGNS:
            tokens.append(_Token(letter, letter, at))
            at += 1
        else:
            end = _end_of_name(text, at)
            tokens.append(_Token("file", text[at:end], at))
            at = end
    return [*tokens, _Token("end", "", len(text))]


def _end_of_name(text: str, start: int) -> int:
    end = start
    while end < len(text) and not text[end].isspace() and text[end] not in _ENDS:
        end += 1
    return end


class _Parser:
    """A recursive-descent parser of a formula's tokens."""

    def __init__(self, tokens: list[_Token]) -> None:
        self._tokens = tokens
        self._next = 0

    def level(self, number: int, depth: int) -> Formula:
        """Parse operands joined by operators of `_LEVELS[number]` or of higher precedence.

        `depth` is the number of parentheses and complements around them.
        """
        if number == len(_LEVELS):
            return self._operand(depth)
        found = self.level(number + 1, depth)
        while self._peek().kind in _LEVELS[number]:
            name = _LEVELS[number][self._take().kind]
            found = NamedOperation(name, (found, self.level(number + 1, depth)))
        return found

    def expect(self, kind: str, expected: str) -> _Token:
        """Consume a token of a kind; raise an error that says `expected` for any other token."""
        token = self._peek()
        if token.kind != kind:
            raise FormulaError(f"expected {expected}, found {_called(token)}.", token.column)
        return self._take()

    def _operand(self, depth: int) -> Formula:
        token = self._peek()
        if depth > _MAX_DEPTH:
            raise FormulaError(
                f"parentheses are nested deeper than {_MAX_DEPTH} levels here.", token.column
            )
        if token.kind == "~":
            self._take()
            return NamedOperation("complement", (self._operand(depth + 1),))
        if token.kind == "(":
            self._take()
            inner = self.level(0, depth + 1)
            self.expect(")", "an operator or “)”")
            return inner
        found = self.expect("file", "a file name or “(”")
        return File(found.text, found.column)

    def _peek(self) -> _Token:
        return self._tokens[self._next]

    def _take(self) -> _Token:
        token = self._tokens[self._next]
        self._next += 1
        return token


def _called(token: _Token) -> str:
    return "the end" if token.kind == "end" else f"“{token.text}”"
