"""Python without asserts and docstrings: `python -O` and `python -OO`."""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

import bspcsg as b
from bspcsg import bsp, csg
from bspcsg.cli.main import run

REPOSITORY = Path(__file__).resolve().parents[2]

#: Tests of each layer: solids, files, scripts with their errors, partition trees, the command line.
SOME = [
    "unit/test_solid.py",
    "unit/test_expression.py",
    "unit/test_block.py",
    "unit/test_io_stl.py",
    "unit/test_io_files.py",
    "unit/test_csg_nodes.py",
    "unit/test_script.py",
    "unit/test_bsp_tree.py",
    "unit/test_bsp_region.py",
    "pipeline/test_cli.py",
]

FLAT = "polyhedron(points = [[0,0,0],[1,0,0],[0,1,0]], faces = [[0,1,2]]);"

#: What each layer has to refuse.
REFUSED: list[Callable[[], object]] = [
    lambda: b.Solid([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]),
    lambda: b.cube(-1),
    lambda: b.cube(1).refine(0),
    lambda: b.cube(1) | b.load("none.stl"),
    lambda: b.sphere(1) <= b.cube(1).translate(1e12, 0, 0),
    lambda: b.half_space((0, 0, 1)).to_mesh(),
    lambda: b.box(4, 3, 2).chamfer(b.box(4, 3, 2).edges(), 1),
    lambda: b.Region.polygon([(0, 0), (1, float("nan"))]),
    lambda: bsp.PartitionTree.from_json("{}"),
    lambda: csg.loads(FLAT),
    lambda: csg.parse("cube("),
    lambda: csg.from_json("[]"),
    lambda: b.run_script("none.py"),
]


def findings() -> Iterator[object]:
    """Yield the result or the error of some calls of each layer."""
    for call in REFUSED:
        try:
            yield call()
        except b.BspcsgError as error:
            yield error.code, error.message
    part = (b.cube(2) - b.sphere(1, segments=12)).rotate(10, "x") & b.half_space((1, 2, 3), 2)
    yield part.volume_exact, part.genus, part.slice(0.5).offset(0.1).area_exact
    tree = bsp.PartitionTree.from_json(
        bsp.PartitionTree([[[-5, 0], [5, 0]], [[0, -5], [0, 5]]]).to_json()
    )
    yield tree.to_json(), part.simplify(0.1).volume_exact
    yield csg.loads("difference() { sphere(2, $fn = 12); cube(1); }").volume_exact
    with TemporaryDirectory() as folder:
        for suffix in ("stl", "ply", "obj", "off", "3mf", "glb"):
            path = str(Path(folder, f"part.{suffix}"))
            part.save(path)
            yield b.load(path).volume_exact, run(["check", path]), run(["check", f"{path}.none"])


# Found: `python -O` removed work that was done inside an `assert`.
def test_a_little_of_each_layer_works_without_asserts_and_docstrings() -> None:
    ended = subprocess.run(
        [sys.executable, "-OO", __file__],
        cwd=REPOSITORY,
        env={**os.environ, "PYTHONPATH": str(REPOSITORY), "PYTHONIOENCODING": "utf-8"},
        capture_output=True,
        encoding="utf-8",
        check=True,
    )
    *_, last = ended.stdout.splitlines()
    assert last == repr(list(findings()))
    assert "not_closed" in last


@pytest.mark.deep
@pytest.mark.timeout(600)
@pytest.mark.parametrize("level", ["-O", "-OO"])
def test_the_suite_passes_without_asserts_and_docstrings(level: str) -> None:
    files = [str(REPOSITORY / "tests" / name) for name in SOME]
    # pytest rewrites the asserts of tests, and warns that it does not rewrite those of plugins.
    quiet = ["-W", "ignore::pytest.PytestConfigWarning", "-p", "no:cacheprovider"]
    ended = subprocess.run(
        [sys.executable, level, "-m", "pytest", "-q", "-x", *quiet, *files],
        cwd=REPOSITORY,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert ended.returncode == 0, ended.stdout[-4000:] + ended.stderr[-2000:]


if __name__ == "__main__":
    sys.stdout.write(repr(list(findings())))
