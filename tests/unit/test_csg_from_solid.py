"""Solids written as scripts of the operations that made them."""

import random
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg import csg


def names(tree: csg.CsgTree) -> list[str]:
    """Return the names of all nodes of a tree."""
    found, waiting = [], list(tree.nodes)
    while waiting:
        node = waiting.pop()
        found.append(node.name)
        waiting.extend(reversed(node.children))
    return found


def rebuilt(solid: b.Solid) -> b.Solid:
    return csg.loads(csg.dumps(solid))


LEAVES = {
    "mesh": lambda: b.cube(3),
    "turned": lambda: b.cube(3).rotate(30, (1, 2, 3)).scale((1, 2, 1)),
    "mirrored": lambda: b.cube((1, 2, 3)).mirror((1, 0, 0)).translate(0.1, 0.2, 0.3),
    "self-crossing": lambda: b.Solid(*twice(b.cube(2), b.cube(2).translate(1, 0, 0))),
}


def twice(a: b.Solid, c: b.Solid) -> tuple[list[list[float]], list[list[int]]]:
    count = len(a.vertices)
    faces = [*a.faces.tolist(), *(c.faces + count).tolist()]
    return [*a.vertices.tolist(), *c.vertices.tolist()], faces


@pytest.mark.parametrize("name", LEAVES)
def test_leaves(name: str) -> None:
    solid = LEAVES[name]()
    assert rebuilt(solid).equals(solid)


@pytest.mark.parametrize("evaluated", [False, True])
def test_the_expression_is_kept(evaluated: bool) -> None:
    part = b.difference(b.cube(4), b.cube(1), b.cube(1).translate(2, 2, 3))
    assert not evaluated or part.volume == 62
    tree = csg.tree_of(part)
    moved = [] if evaluated else ["multmatrix"]
    assert names(tree) == ["difference", "polyhedron", "polyhedron", *moved, "polyhedron"]
    assert rebuilt(part).equals(part)
    assert part.to_csg() == csg.dumps(part)
    assert names(csg.tree_of(part, flat=True)) == ["polyhedron"]
    assert csg.loads(part.to_csg(flat=True)).equals(part)


def test_a_transform_of_an_expression_stays_around_it() -> None:
    part = (b.cube(4) | b.cube(5).translate(1, 0, 0)).rotate(90).translate(0.5, 0, 0)
    assert names(csg.tree_of(part))[:3] == ["multmatrix", "multmatrix", "union"]
    assert rebuilt(part).equals(part)


COMPLEMENTS = {
    "union with a complement, cut": lambda a, c, d: (a | ~c) & d,
    "no complement at all": lambda a, c, d: ~(~a & ~c) - d,
    "xor with complements": lambda a, c, d: ~a ^ ~c ^ d,
    "difference of complements": lambda a, c, d: ~a - ~c,
    "everything less something, in something": lambda a, c, d: d & (b.Solid.full() - a),
    "nothing": lambda a, c, d: a & b.Solid.empty(),
    "less nothing": lambda a, c, d: a - b.Solid.empty() | b.Solid.empty() & c,
    "all of it": lambda a, c, d: a & (c | b.Solid.full()),
}


@pytest.mark.parametrize("name", COMPLEMENTS)
def test_complements_find_something_to_be_taken_from(name: str) -> None:
    a, c, d = b.cube(4), b.cube(3).translate(2, 2, 2), b.cube(9).translate(-1, -1, -1)
    made = COMPLEMENTS[name](a, c, d)
    written = csg.dumps(made)
    assert csg.loads(written).equals(made)
    assert rebuilt(made).equals(made)  # evaluated by now


def test_half_spaces_are_written_as_what_they_cut() -> None:
    part = (b.cube(4) & b.half_space((0, 0, 1), 1)) | b.cube(1).translate(9, 0, 0)
    assert names(csg.tree_of(part)) == ["polyhedron"]
    assert rebuilt(part).volume == 17
    moved = (b.cube(4) & b.half_space((0, 0, 1), 1)).rotate(90) | b.cube(1).translate(9, 0, 0)
    assert names(csg.tree_of(moved)) == [
        "union", "multmatrix", "polyhedron", "multmatrix", "polyhedron",
    ]  # fmt: skip
    assert rebuilt(moved).equals(moved)


@pytest.mark.parametrize(
    "solid", [~b.cube(1), b.half_space((0, 0, 1)), b.Solid.full(), b.cube(1) | ~b.cube(3)]
)
def test_what_is_not_bounded_is_refused(solid: b.Solid) -> None:
    for flat in (False, True):
        with pytest.raises(b.UnboundedError, match="cannot be written"):
            csg.dumps(solid, flat=flat)


def test_random_expressions() -> None:
    dice = random.Random(5)
    for _ in range(25):
        parts = [
            b.cube(dice.randint(1, 4)).translate(*(dice.randint(0, 4) for _ in range(3)))
            for _ in range(5)
        ]
        while len(parts) > 1:
            one, other = (parts.pop(dice.randrange(len(parts))) for _ in range(2))
            made = dice.choice([one | other, one & ~other, one ^ other, ~(~one & ~other)])
            parts.append(made.rotate(90, dice.choice("xyz")) if dice.random() < 0.3 else made)
        assert rebuilt(parts[0]).equals(parts[0])


def test_deep_expressions() -> None:
    chain = b.cube(1)
    for k in range(600):
        chain = chain.translate(0, 0, 0.5) | b.cube(1).translate(k % 7, 0, 0)
    tree = csg.tree_of(chain)
    assert len(names(tree)) > 1800
    assert csg.parse(csg.dumps(tree)).nodes[0].name == "union"


def test_what_would_be_too_large_is_one_polyhedron(monkeypatch: pytest.MonkeyPatch) -> None:
    made = b.xor(b.cube(1).translate(k / 4, 0, 0) for k in range(6)) | b.cube(9)
    assert names(csg.tree_of(made)).count("polyhedron") > 60
    monkeypatch.setattr("bspcsg.csg.from_solid._MAX_BODY_SIZE", 1000)
    assert names(csg.tree_of(made)) == ["polyhedron"]
    assert rebuilt(made).equals(made)


def test_saving_by_suffix(tmp_path: Path) -> None:
    part = b.cube(2) - b.cube(1)
    part.save(tmp_path / "part.csg")
    assert "difference" in (tmp_path / "part.csg").read_text("utf-8")
    tree = csg.read_tree(tmp_path / "part.csg")
    (tmp_path / "part.json").write_text(csg.to_json(tree))
    for name in ("part.csg", "part.json"):
        assert b.load(tmp_path / name).equals(part)


# Found: `csg.dump` to a name in `.json` wrote a script that `load` refuses.
def test_trees_are_written_by_suffix(tmp_path: Path) -> None:
    part = b.cube(2) - b.cube(1)
    for name in ("part.csg", "part.json", "PART.JSON"):
        csg.dump(part, tmp_path / name)
        assert csg.read_tree(tmp_path / name) == csg.tree_of(part)
    assert (tmp_path / "part.json").read_text("utf-8").startswith("{")


# Found: `csg.dump` ended in a `UnicodeEncodeError` where a text held half of a character.
@pytest.mark.parametrize("name", ["part.csg", "part.json"])
def test_halves_of_characters_are_not_written(tmp_path: Path, name: str) -> None:
    tree = csg.CsgTree((csg.Node("text", (csg.Argument("text", "a\ud800"),)),))
    with pytest.raises(b.FormatError, match="half of a character"):
        csg.dump(tree, tmp_path / name)
    assert not list(tmp_path.iterdir())
