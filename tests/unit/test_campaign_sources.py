"""The cases that files and options on a command line stand for."""

import json
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

import bspcsg as b
from bspcsg.campaign.cases.sources import PairSelection, cases_of, inputs_in
from bspcsg.cli.options.patterns import files_of
from bspcsg.parameters import SET_OPS
from support.cli import put
from support.shapes import cube


@pytest.fixture
def parts(tmp_path: Path) -> Path:
    """Return a folder with three meshes, a script, and other files."""
    folder = tmp_path / "parts"
    (folder / "deep").mkdir(parents=True)
    for side, name in enumerate(("a.off", "b.stl", "deep/c.obj"), 1):
        put(str(folder / name), cube(side))
    (folder / "m.csg").write_text("cube(size = 1);")
    (folder / "notes.txt").write_text("nothing")
    (folder / "settings.json").write_text("{}")
    return folder


def inside(folder: Path) -> list[Path]:
    """Return the files that the command crosscheck uses of a folder."""
    return files_of([folder], Counter(), also=(".csg",))


def test_folder_is_paired_with_itself(parts: Path) -> None:
    cases = cases_of(inputs_in(inside(parts)), ("union", "xor"), PairSelection())
    names = [case.name for case in cases]
    named = ("0000-a-b", "0001-a-c", "0002-b-c")
    assert names == [*(f"{pair}-{op}" for pair in named for op in ("union", "xor")), "m.csg"]
    pairs = {tuple(Path(str(one.file)).name for one in case.operands) for case in cases}
    assert pairs == {("a.off", "b.stl"), ("a.off", "c.obj"), ("b.stl", "c.obj"), ("m.csg",)}


# Found: reports named cases by numbers, not by files.
def test_cases_are_called_by_their_files(parts: Path) -> None:
    (parts / "elsewhere").mkdir()
    (parts / "elsewhere" / "b.off").write_bytes((parts / "a.off").read_bytes())
    files = [parts / "a.off", parts / "b.stl", parts / "elsewhere" / "b.off"]
    cases = cases_of(inputs_in(files), ("xor",), PairSelection())
    assert [case.name for case in cases] == ["0000-a-b-xor", "0001-a-b-xor", "0002-b-b-xor"]


def test_draws_are_the_same_each_time(parts: Path) -> None:
    draws = [
        cases_of(inputs_in(inside(parts)), SET_OPS, PairSelection(20, seed)) for seed in (1, 1, 2)
    ]
    assert draws[0] == draws[1] and [case.key for case in draws[0]] == [c.key for c in draws[1]]
    assert draws[0] != draws[2]
    poses = Counter(case.pose for case in draws[0] if case.kind == "pose")
    assert poses["random"] == 40 and sum(poses.values()) == 80 and len(poses) > 3
    longer = cases_of(inputs_in(inside(parts)), SET_OPS, PairSelection(30, 1))
    assert longer[:80] == draws[0][:80]


def test_pose_can_be_named(parts: Path) -> None:
    cases = cases_of(
        inputs_in([parts / "a.off", parts / "b.stl"]), ("union",), PairSelection(pose="beside")
    )
    assert [(case.pose, case.number) for case in cases] == [("beside", 0)]
    one = cases_of(
        inputs_in([parts / "a.off"]), ("union",), PairSelection(seed=3, pose="copy", number=7)
    )
    assert [(case.name, case.seed) for case in one] == [("0007-a-a-copy-union", 3)]
    assert one[0].command.endswith("--op union --pose copy:7 --seed 3")


MESH = {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "faces": [[0, 2, 1]]}


@pytest.mark.parametrize(
    "document",
    [
        "nonsense",
        "[]",
        '{"cases": 3}',
        '{"cases": [3]}',
        {"cases": [{"operands": [{**MESH, "faces": [[0, 2, 1, 3]]}]}]},
        {"cases": [{"operation": "sum", "operands": [MESH]}]},
        {"cases": [{"operands": [{"vertices": [1, 2], "faces": []}]}]},
        {"cases": [{"operands": [{"vertices": [["x"]], "faces": [[0]]}]}]},
        {"cases": [{"operands": [{**MESH, "pose": [[1, 2], [3, 4]]}]}]},
        {"cases": [{"operands": ["a.off"]}]},
        {"cases": [{"name": "no operands"}]},
    ],
)
def test_other_files_of_cases_are_refused(tmp_path: Path, document: Any) -> None:
    path = tmp_path / "cases.json"
    path.write_text(document if isinstance(document, str) else json.dumps(document))
    with pytest.raises(
        b.FormatError, match=r"cases\.json: the file is not a valid list of cases"
    ) as caught:
        cases_of(inputs_in([path]), SET_OPS, PairSelection())
    assert '{"cases": [{"operation"' in caught.value.message


def test_missing_operand_is_named(tmp_path: Path) -> None:
    path = tmp_path / "cases.json"
    path.write_text(json.dumps({"cases": [{"operands": [{"file": "gone.stl"}]}]}))
    with pytest.raises(b.FormatError, match=r"gone\.stl: cannot read"):
        cases_of(inputs_in([path]), SET_OPS, PairSelection())
