import copy
import math
import os
import pickle
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import support
from bspcsg import BspcsgError, FormatError, InvalidParameterError, Solid, csg
from bspcsg.csg import Argument, CsgTree, Node
from bspcsg.csg.syntax.json_form import MAX_NODE_DEPTH
from support.timing import seconds

#: Levels: more than Python can go down by calls.
DEEP = 100_000 if support.DEEP else 5_000

CORPUS = Path(__file__).parent.parent / "corpus" / "csg"


def values(text: str) -> list[object]:
    return [argument.value for argument in csg.parse(f"node({text});").nodes[0].arguments]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1.0),
        ("-2.5e-3", -0.0025),
        (".5", 0.5),
        ("1.", 1.0),
        ("--3", 3.0),
        ("+4", 4.0),
        ("inf", math.inf),
        ("-inf", -math.inf),
        ("true", True),
        ("false", False),
        ("undef", None),
        ('"a\\n\\"b\\\\\\u00e9"', 'a\n"b\\é'),
        ("[]", ()),
        ("[ 0, [1,2] ,[ ] , undef]", (0.0, (1.0, 2.0), (), None)),
        ("[1, 2, ]", (1.0, 2.0)),
        ("[[1, .5], [-0.5, 1e+05], [+2, 03]]", ((1.0, 0.5), (-0.5, 1e5), (2.0, 3.0))),
        ("[[1, 2], [inf, /* one */ 3]]", ((1.0, 2.0), (math.inf, 3.0))),
    ],
)
def test_values(text: str, value: object) -> None:
    assert values(text) == [value]


def test_nan_is_a_value() -> None:
    (value,) = values("nan")
    assert isinstance(value, float)
    assert math.isnan(value)


def test_named_and_unnamed_arguments() -> None:
    node = csg.parse("sphere($fn = 0, r=2, [1], center = true);").nodes[0]
    assert [argument.name for argument in node.arguments] == ["$fn", "r", None, "center"]


def test_bodies_modifiers_comments_and_places() -> None:
    text = "// made\n%#group() { /* two\n lines */ cube(1); ; !sphere(); }\nmultmatrix() cube(2);"
    group, moved = csg.parse(text).nodes
    assert (group.modifiers, group.place) == ("%#", (2, 3))
    assert [child.name for child in group.children] == ["cube", "sphere"]
    assert group.children[0].place == (3, 11)
    assert group.children[1].modifiers == "!"
    assert [child.name for child in moved.children] == ["cube"]


def test_byte_order_mark_and_line_ends() -> None:
    assert csg.parse("\ufeffcube(1);\r\n\r\ncube(2);").nodes[1].place == (3, 1)


@pytest.mark.parametrize(
    ("text", "where", "says"),
    [
        ("cube(", [1, 6], "the end of the file"),
        ("cube(1)", [1, 1], "“;” is missing"),
        ("group() {\n cube(1);", [1, 1], "“}” is missing"),
        ("cube(size = [1, 2", [1, 18], "expected “]”"),
        ('\n  text("abc);', [2, 8], "no closing quotation mark"),
        ("cube(1); /* never", [1, 10], "comment has no closing"),
        ("}", [1, 1], "expected a node"),
        ("cube(1) );", [1, 9], "expected a node"),
        ("x = 3;", [1, 1], "no variables"),
        ("cube(1e999);", [1, 6], "too large"),
        ("cube(1.2.3);", [1, 6], "unexpected characters “1.2.3”"),
        ("cube(size == 1);", [1, 12], "expected a value"),
        ("cube(size 1);", [1, 11], "expected “=” after size"),
        ('cube(-"a");', [1, 7], "expected a value"),
        ("cube(1 2);", [1, 8], "expected “,” or “)”"),
        ("cube 1;", [1, 6], "expected “(” after cube"),
        ("cube(1);\n@", [2, 1], "unexpected characters “@”"),
        ("#", [1, 2], "expected a node"),
        ("cube([[1, 2],\n [3, 4 5]]);", [2, 8], "expected “]” to close a vector, found “5”"),
        ("cube([[1, 2], [3, -1e999]]);", [1, 20], "the number “1e999” is too large"),
        ("cube([1, NaN]);", [1, 10], "expected a value, found “NaN”"),
        ("cube([1, -Infinity]);", [1, 11], "expected a value, found “Infinity”"),
        ("cube([1, null]);", [1, 10], "expected a value, found “null”"),
        ('cube([1, {"a": 2}]);', [1, 10], "expected a value, found “{”"),
        ("cube([1, 2.]]);", [1, 13], "expected “,” or “)”, found “]”"),
    ],
)
def test_errors_name_line_and_column(text: str, where: list[int], says: str) -> None:
    with pytest.raises(FormatError) as caught:
        csg.parse(text, "part.csg")
    assert list(caught.value.where) == where
    assert caught.value.code == "syntax"
    assert str(caught.value).startswith(f"part.csg:{where[0]}:{where[1]}: ")
    assert says in str(caught.value)


def test_nodes_nest_to_any_depth() -> None:
    tree = csg.parse("group() {" * DEEP + "cube(1);" + "}" * DEEP)
    text = csg.dumps(tree)
    assert text.count("group()") == DEEP
    assert csg.parse("group() " * DEEP + "cube(1);").nodes[0].name == "group"
    assert csg.loads(text).volume == 1.0


@pytest.mark.timeout(20)
def test_a_long_text_without_its_end_is_found_at_once() -> None:
    with pytest.raises(FormatError, match="no closing quotation mark"):
        csg.parse('cube("' + "cube(size = [1, 2]); \\n" * 10_000)


def test_vectors_do_not() -> None:
    for inside in ("[" * DEEP, "[" * 65 + "1" + "]" * 65):
        with pytest.raises(FormatError, match="nested deeper than 64") as caught:
            csg.parse("cube(" + inside)
        assert list(caught.value.where) == [1, 71]
    assert str(values("[" * 64 + "1" + "]" * 64)[0]).count("(") == 64


# Found: trees of scripts 3 000 levels deep, which the parser takes, could not be compared,
# hashed, shown, pickled or copied deeply.
def test_deep_trees_are_values_as_others_are() -> None:
    text = "group() {" * DEEP + "cube({}); cube(3);" + "}" * DEEP
    one, same, other = (csg.parse(text.replace("{}", size)) for size in ("1", "1", "2"))
    assert one == same and hash(one) == hash(same)
    assert one != other and one.nodes[0] != other.nodes[0]
    assert repr(one) == repr(same) != repr(other)
    assert pickle.loads(pickle.dumps(one)) == one
    assert copy.copy(one) == one == copy.deepcopy(one)


def test_nodes_that_are_shared_stay_so() -> None:
    node = Node("cube", (Argument(None, 1.0),))
    for _ in range(60):
        node = Node("union", (), (node, node))
    again = pickle.loads(pickle.dumps(node))
    assert again.children[0] is again.children[1]
    assert again == node and hash(again) == hash(node)
    assert Node("union", (), (node,)) != node


def test_nodes_show_their_fields() -> None:
    places = "place=Place(line=0, column=0)"
    leaf = f"Node(name='cube', arguments=(), children=(), modifiers='#', {places})"
    for count, inner in ((1, f"({leaf},)"), (2, f"({leaf}, {leaf})")):
        shown = f"Node(name='union', arguments=(), children={inner}, modifiers='', {places})"
        assert repr(Node("union", (), (Node("cube", modifiers="#"),) * count)) == shown


def test_deep_trees_are_no_json() -> None:
    tree = csg.parse("group() {" * 300 + "cube(1);" + "}" * 300)
    with pytest.raises(FormatError, match="nested deeper"):
        csg.to_json(tree)
    with pytest.raises(FormatError, match="not valid JSON"):
        csg.from_json('{"nodes":' * DEEP)


@pytest.mark.parametrize("path", sorted(CORPUS.glob("*.csg")), ids=lambda path: path.stem)
def test_text_and_json_give_the_same_tree(path: Path) -> None:
    tree = csg.read_tree(path)
    assert csg.parse(csg.dumps(tree)) == tree
    assert csg.from_json(csg.to_json(tree, indent=1)) == tree


_numbers = st.floats(allow_nan=False)
_scalars = st.one_of(_numbers, st.booleans(), st.none(), st.text(st.characters(codec="utf-8")))
_values = st.recursive(_scalars, lambda inner: st.lists(inner, max_size=3).map(tuple), max_leaves=6)
_names = st.from_regex(r"\$?[a-z_][a-z0-9_]{0,5}", fullmatch=True).filter(
    lambda name: name not in {"true", "false", "undef", "inf", "nan"}
)
_arguments = st.builds(Argument, st.one_of(st.none(), _names), _values)
_nodes = st.recursive(
    st.builds(Node, _names, st.lists(_arguments, max_size=3).map(tuple)),
    lambda inner: st.builds(
        Node,
        _names,
        st.lists(_arguments, max_size=2).map(tuple),
        st.lists(inner, max_size=3).map(tuple),
        st.sampled_from(["", "#", "%", "*!"]),
    ),
    max_leaves=5,
)


@given(st.lists(_nodes, max_size=3).map(lambda nodes: CsgTree(tuple(nodes))))
def test_any_tree_survives_both_forms(tree: CsgTree) -> None:
    assert csg.parse(csg.dumps(tree)) == tree
    assert csg.from_json(csg.to_json(tree)) == tree


_vectors = st.recursive(
    st.one_of(_numbers, st.sampled_from(["undef", "1.", "- 2", "true"])),
    lambda inner: st.lists(inner, max_size=4),
    max_leaves=12,
)


@given(st.lists(_vectors, min_size=1))
def test_vectors_are_what_their_words_say(vector: list[Any]) -> None:
    text = str(vector).replace("'", "")
    # Comments let no part of it pass as JSON.
    assert values(text) == values(text.replace("[", "[/**/").replace("]", "/**/]"))


# Found: 400 000 numbers took more than two seconds, word by word.
def test_long_lists_of_numbers_are_read_at_once() -> None:
    points = [[k, 0.5, -1e-3] for k in range(100_000)]
    text = f"polyhedron(points = {points}, faces = [{list(range(100_000))}]);"
    assert seconds(lambda: csg.parse(text), 2) < 1


@given(st.text(st.sampled_from('abc(){}[],;=-+."\\/*#%! 0123456789e\n'), max_size=60))
def test_any_text_is_a_tree_or_an_error_with_a_place(text: str) -> None:
    try:
        csg.parse(text)
    except FormatError as error:
        assert len(error.where) == 2


def test_json_holds_numbers_that_json_has_not() -> None:
    tree = csg.parse("cube([inf, -inf, 1e20, 0.1]);")
    assert '{"number": "-inf"}' in csg.to_json(tree)
    assert csg.from_json(csg.to_json(tree)) == tree


# Found: JSON whose number was an array ended `csg.from_json` in a `TypeError`, and arguments
# named `true` or `undef` were taken and written to scripts that nothing reads.
@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "not valid JSON"),
        ("[]", "format"),
        ('{"format": "bspcsg-csg", "version": 2}', "version 2"),
        ('{"format": "bspcsg-csg", "version": 1}', "nodes must be a list"),
        ('{"format": "bspcsg-csg", "version": 1, "nodes": [{}]}', "nodes[0] must be a node"),
        (
            '{"format": "bspcsg-csg", "version": 1, "nodes": [{"node": "a b"}]}',
            "nodes[0] must be a node",
        ),
        (
            '{"format": "bspcsg-csg", "version": 1, "nodes": [{"node": "a", "modifiers": "?"}]}',
            "modifiers must be",
        ),
        (
            '{"format": "bspcsg-csg", "version": 1, "nodes": [{"node": "a", "arguments": [{}]}]}',
            "nodes[0].arguments[0] must be an argument",
        ),
        (
            '{"format": "bspcsg-csg", "version": 1, "nodes":'
            ' [{"node": "a", "arguments": [{"value": {"x": 1}}]}]}',
            "arguments[0].value must be",
        ),
        (
            '{"format": "bspcsg-csg", "version": 1, "nodes":'
            ' [{"node": "a", "arguments": [{"value": {"number": []}}]}]}',
            "arguments[0].value must be",
        ),
        (
            '{"format": "bspcsg-csg", "version": 1, "nodes":'
            ' [{"node": "a", "arguments": [{"name": "undef", "value": 1}]}]}',
            "arguments[0].name must be",
        ),
        # Half of a character, which no text can hold.
        (
            '{"format": "bspcsg-csg", "version": 1, "nodes":'
            ' [{"node": "text", "arguments": [{"value": "\\ud800"}]}]}',
            "arguments[0].value must be",
        ),
    ],
)
def test_wrong_json_is_refused_with_its_place(text: str, says: str) -> None:
    with pytest.raises(FormatError) as caught:
        csg.from_json(text, "tree.json")
    assert says in str(caught.value)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(FormatError, match="No such file"):
        csg.load(tmp_path / "none.csg")
    with pytest.raises(FormatError, match="directory"):
        csg.load(tmp_path)
    (tmp_path / "binary.csg").write_bytes(b"cube(\xff);")
    with pytest.raises(FormatError, match="byte 5 cannot be decoded"):
        csg.load(tmp_path / "binary.csg")
    with pytest.raises(FormatError, match="defines can be given for"):
        csg.load(CORPUS / "paths.csg", defines={})


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs a POSIX system")
def test_scad_needs_openscad(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "part.scad").write_text("cube(1);")
    monkeypatch.setenv("PATH", "")
    with pytest.raises(FormatError, match="needs the program openscad") as caught:
        csg.load(tmp_path / "part.scad")
    assert caught.value.code == "missing_program"


def stand_in(folder: Path, script: str, monkeypatch: pytest.MonkeyPatch) -> None:
    program = folder / "openscad"
    program.write_text(f"#!/bin/sh\n{script}\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")


@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell")
def test_scad_goes_through_openscad(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "part.scad").write_text("cube(w);")
    stand_in(tmp_path, 'echo "cube(${4#-Dw=});" > "$3"', monkeypatch)
    assert csg.load(tmp_path / "part.scad", defines={"w": 2.0}).volume == 8.0
    # What is asked for is the shape, and not its preview.
    stand_in(tmp_path, '[ "$1" = --render ] && echo "cube(3);" > "$3"', monkeypatch)
    assert csg.load(tmp_path / "part.scad").volume == 27.0
    stand_in(tmp_path, 'echo "ERROR: Parser error in line 1" >&2; exit 1', monkeypatch)
    with pytest.raises(
        FormatError, match="cannot evaluate the script: ERROR: Parser error in line 1"
    ):
        csg.load(tmp_path / "part.scad")
    stand_in(tmp_path, "exec sleep 5", monkeypatch)
    with pytest.raises(FormatError, match=r"time limit of 0\.2 seconds"):
        csg.read_scad(tmp_path / "part.scad", timeout=0.2)


# Found: `csg.read_scad` did not take the name of a file as a text.
@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell")
def test_scad_takes_names_of_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "part.scad"
    path.write_text("cube(w);")
    stand_in(tmp_path, 'echo "cube(3);" > "$3"', monkeypatch)
    assert csg.read_scad(str(path), timeout=None) == csg.parse("cube(3);")
    with pytest.raises(FormatError, match=r"(?i)no such file"):
        csg.read_scad("a" * 300)
    wrong: list[dict[str, Any]] = [
        {"timeout": "5"}, {"defines": "w=4"}, {"defines": {"w": [1, 2]}}, {"defines": {1: 2}}
    ]  # fmt: skip
    for one in wrong:
        with pytest.raises(InvalidParameterError, match=next(iter(one))):
            csg.read_scad(path, **one)


# Found: a tree of 200 levels was written as JSON that `from_json` refused, and JSON with a byte
# order mark was refused.
def test_the_deepest_trees_that_json_holds_are_read_again() -> None:
    tree = csg.parse("group() {" * (MAX_NODE_DEPTH - 1) + "cube(1);" + "}" * (MAX_NODE_DEPTH - 1))
    assert csg.from_json(csg.to_json(tree)) == tree
    deeper = csg.to_json(tree).replace('"children": []', '"children": [{"node": "cube"}]')
    with pytest.raises(FormatError, match="nested deeper than 200"):
        csg.from_json(deeper)


def test_json_may_begin_with_a_byte_order_mark() -> None:
    tree = csg.parse("cube(1);")
    assert csg.from_json("\ufeff" + csg.to_json(tree)) == tree


# Found: lists, numbers of NumPy and anything else in trees of scripts made by hand ended in raw
# errors of Python, or were written as scripts that nothing reads.
@pytest.mark.parametrize(
    "value",
    [[1, 2, 3], np.array([1, 2, 3]), [np.int64(1), Fraction(2), True + 2], ([1.0][0], 2, 3.0)],
)
def test_values_of_trees_made_by_hand_are_those_of_scripts(value: Any) -> None:
    made = CsgTree([Node("cube", [Argument("size", value)])])  # type: ignore[arg-type]
    read = csg.parse("cube(size = [1, 2, 3]);")
    assert (
        made == read
        and hash(made) == hash(read)
        and repr(made.nodes[0].arguments) == repr(read.nodes[0].arguments)
    )
    assert csg.parse(csg.dumps(made)) == csg.from_json(csg.to_json(made)) == made
    solid = csg.evaluate(made)
    assert isinstance(solid, Solid) and solid.volume == 6


def deep_vector() -> object:
    value: object = 1.0
    for _ in range(65):
        value = (value,)
    return value


@pytest.mark.parametrize(
    "make",
    [
        lambda: Argument("size", object()),  # type: ignore[arg-type]
        lambda: Argument("size", b"text"),  # type: ignore[arg-type]
        lambda: Argument("size", 10**400),
        lambda: Argument("size", deep_vector()),  # type: ignore[arg-type]
        lambda: Argument("si ze", 1.0),
        lambda: Argument("true", 1.0),
        lambda: Node("cu be"),
        lambda: Node(5),  # type: ignore[arg-type]
        lambda: Node("cube", modifiers="x"),
        lambda: Node("cube", (1,)),  # type: ignore[arg-type]
        lambda: Node("union", (), Node("cube")),  # type: ignore[arg-type]
        lambda: CsgTree("cube"),  # type: ignore[arg-type]
    ],
)
def test_nodes_that_no_script_can_hold_are_refused(make: Callable[[], object]) -> None:
    with pytest.raises(InvalidParameterError):
        make()


# Found: numbers of NumPy in trees were written as `np.float64(0.5)`.
def test_numbers_of_numpy_are_written_as_numbers() -> None:
    node = csg.Node("cube", (csg.Argument("size", np.float64(0.5)),))
    assert csg.dumps(CsgTree((node,))) == "cube(size = 0.5);\n"


# Found: errors in `.scad` named lines of the intermediate tree.
@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell")
@pytest.mark.parametrize(
    ("source", "made", "place", "own"),
    [
        ("// tent(\n\nt = 1;\ntent(t);", "group() {\n  tent(t = 1);\n}", "2:3", 4),
        ("tent(1);\ntent(2);", "group() {\n  tent(t = 1);\n}", "2:3", None),
        ("use <ball.scad>\ntent(1);", "group() {\n  tent(t = 1);\n}", "2:3", None),
        ("cube(1); wrap();\n/*\nwarp()*/ warp();", "cube(1);\n  warp();", "2:3", 3),
        ("cube(1);", "cube(1);\n  cube(1;", "2:9", None),
    ],
)
def test_errors_of_scad_quote_the_line_that_they_name(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    source: str,
    made: str,
    place: str,
    own: int | None,
) -> None:
    path = tmp_path / "part.scad"
    path.write_text(source)
    (tmp_path / "made").write_text(made)
    stand_in(tmp_path, f'cp "{tmp_path}/made" "$3"', monkeypatch)
    with pytest.raises(BspcsgError) as caught:
        csg.load(path)
    first, quoted, *rest = str(caught.value).splitlines()
    assert first.startswith(f"{path}, as openscad's .csg:{place}: ")
    assert quoted == f"  line 2 of the .csg: {made.splitlines()[1].strip()}"
    assert rest == ([] if own is None else [f"  from {path}:{own}"])


@pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell")
def test_warnings_of_scad_name_its_lines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "part.scad"
    path.write_text("r = 1 / 0;\ncube(1);\nsphere(r);\n")
    stand_in(tmp_path, 'printf "cube(1);\\nsphere(r = inf);\\n" > "$3"', monkeypatch)
    with pytest.warns(csg.CsgWarning) as told:
        assert csg.load(path).volume == 1
    first, quoted, own = str(told[0].message).splitlines()
    assert first.startswith(f"{path}, as openscad's .csg:2:1: sphere(): r must be a number")
    assert (
        first.endswith("This node is left out.")
        and quoted == "  line 2 of the .csg: sphere(r = inf);"
    )
    assert own == f"  from {path}:3"
