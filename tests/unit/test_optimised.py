"""Python without asserts and docstrings: `python -O` and `python -OO`."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

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


# Found: `python -O` removed what an `assert` did.
@pytest.mark.timeout(600)
@pytest.mark.parametrize("level", [pytest.param("-O", marks=pytest.mark.deep), "-OO"])
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


def test_a_script_that_makes_no_solid_is_refused_without_asserts() -> None:
    flat = "polyhedron(points = [[0,0,0],[1,0,0],[0,1,0]], faces = [[0,1,2]]);"
    code = f"import bspcsg.csg as c\ntry: c.loads({flat!r})\nexcept Exception as e: print(e.code)"
    plain, optimised = (
        subprocess.run(
            [sys.executable, *level, "-c", code],
            cwd=REPOSITORY,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for level in ([], ["-OO"])
    )
    assert plain == optimised == "not_closed\n"
