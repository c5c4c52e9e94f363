"""Formulas over file names: precedence, names, and the positions of errors."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bspcsg.cli.options.formula import FormulaError, evaluated, files_of, parse

SETS = {"a": {1, 2, 3, 4}, "b": {3, 4, 5, 6}, "c": {2, 4, 6, 8}}
EVERYTHING = set(range(10))


def value(text: str) -> set[int]:
    def combine(name: str, sets: list[set[int]]) -> set[int]:
        if name == "complement":
            return EVERYTHING - sets[0]
        left, right = sets
        operations = {
            "union": left | right,
            "intersection": left & right,
            "difference": left - right,
            "xor": left ^ right,
        }
        return operations[name]

    return evaluated(parse(text), lambda file: SETS[file.name], combine)


ATOMS = st.sampled_from(["a", "b", "c"])
FORMULAS = st.recursive(
    ATOMS,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(["|", "&", "-", "^"]), inner).map(" ".join),
        inner.map(lambda text: f"({text})"),
    ),
    max_leaves=12,
)


@given(FORMULAS)
def test_operators_bind_as_in_python(text: str) -> None:
    assert value(text) == eval(text, dict(SETS))


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("a + b - c", "(a | b) - c"),
        ("a | b - c", "a | (b - c)"),
        ("~a & b", "b - a"),
        ("~~a", "a"),
        ("a|b&c", "a | (b & c)"),
        ("a\t-\nb", "a - b"),
    ],
)
def test_meanings(text: str, same: str) -> None:
    assert value(text) == value(same)


def test_names() -> None:
    text = "my-part+1~.stl - \"with blanks.stl\" | 'it & that.stl'|x.stl"
    assert [file.name for file in files_of(parse(text))] == [
        "my-part+1~.stl",
        "with blanks.stl",
        "it & that.stl",
        "x.stl",
    ]


def test_a_file_is_listed_once() -> None:
    assert [file.name for file in files_of(parse("b - (a | b) - a"))] == ["b", "a"]


@pytest.mark.parametrize(
    ("text", "column", "words"),
    [
        ("", 0, "is empty"),
        ("a -", 3, "found the end"),
        ("a | | b", 4, "found “|”"),
        ("a b", 2, "expected an operator"),
        ("(a", 2, "expected an operator or “)”"),
        ("a)", 1, "expected an operator or the end"),
        ("()", 1, "expected a file name"),
        ("a | 'b", 4, "no closing mark"),
        ('a | ""', 4, "is empty"),
        ("(" * 500 + "a" + ")" * 500, 101, "nested deeper"),
        ("~" * 500 + "a", 101, "nested deeper"),
    ],
)
def test_errors_point_at_the_place(text: str, column: int, words: str) -> None:
    with pytest.raises(FormulaError) as caught:
        parse(text)
    assert caught.value.column == column and words in caught.value.message


# Found: `eval` ended as a defect on a chain of a thousand operators.
def test_values_of_long_chains() -> None:
    assert value(" | ".join(["a", "b", "c - a"] * 1000)) == {1, 2, 3, 4, 5, 6, 8}


def test_a_long_chain_is_no_deep_one() -> None:
    assert value(" | ".join(["a"] * 300)) == SETS["a"]
