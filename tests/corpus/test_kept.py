"""Files that released versions wrote are read as they were meant, as docs/stability.md promises."""

import json
import pickle
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg.bsp import PartitionTree
from support.cli import Capture, ran

VERSIONS = sorted(path for path in (Path(__file__).parent / "kept").iterdir() if path.is_dir())

EACH = pytest.mark.parametrize("kept", VERSIONS, ids=lambda path: path.name)


@EACH
def test_solids_scripts_and_trees(kept: Path) -> None:
    hole = b.cube(1).translate(0.5, 0.5, 1.5)
    part = b.cube(2) - hole
    solid = pickle.loads((kept / "part.pickle").read_bytes())
    assert solid == part.rotate(z=90) and solid.exact_volume() == 7.5
    assert b.load(kept / "part.csg") == part == b.load(kept / "part.json")
    for name, nodes in (("square.json", 4), ("square_cut.json", 5)):
        tree = PartitionTree.from_json((kept / name).read_text("utf-8"))
        assert tree.stats().nodes == nodes
        assert json.loads(tree.to_json()) == json.loads((kept / name).read_text("utf-8"))


@EACH
def test_cases_and_records(kept: Path, tmp_path: Path, capsys: Capture) -> None:
    page = tmp_path / "report.html"
    code, out, err = ran(capsys, "report", str(kept / "cases.jsonl"), "-o", str(page), "--json")
    assert code == 0 and json.loads(out)["cases"] == 1, err
    assert "a-b-difference" in page.read_text("utf-8")
    code, out, err = ran(capsys, "bench", "--from", str(kept / "bench.json"), "--format", "md")
    assert code == 0 and "two cubes" in out and "manifold3d" in out, err


def test_the_first_release_is_kept() -> None:
    assert "1.0.0" in {path.name for path in VERSIONS}
