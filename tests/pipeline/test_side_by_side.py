"""The same parts in several tools: they run, they are the same parts, and ours are short."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg import csg
from bspcsg.csg import read_scad
from manual_side import PARTS, TOOLS, lines, script
from support import DEEP

#: The most by which volumes may differ: tools make balls, curves and letters of other facets.
_ROUNDNESS = 0.015

#: Parts for which another tool has fewer lines; their remarks say why.
SHORTER_ELSEWHERE = {"plate": {"build123d"}}


def _present(tool: str) -> list[str]:
    return [part for part in PARTS if script(part, tool).exists()]


def _volume(path: Path) -> float:
    """Return what a script prints."""
    done = subprocess.run(
        [sys.executable, str(path)], capture_output=True, text=True, timeout=110, check=False
    )
    assert done.returncode == 0, done.stderr
    return float(done.stdout)


@pytest.fixture(scope="module")
def volumes() -> dict[str, float]:
    """Return the volumes of our parts."""
    found = {}
    for part in PARTS:
        names: dict[str, object] = {}
        exec(compile(script(part, "bspcsg").read_text("utf-8"), part, "exec"), names)
        solid = names["part"]
        assert isinstance(solid, b.Solid) and not solid.to_mesh().open_edges
        found[part] = solid.volume
    return found


def test_every_tool_makes_some_part() -> None:
    assert len(PARTS) == 6 and _present("bspcsg") == list(PARTS)
    assert all(len(_present(tool)) >= 4 for tool in TOOLS)


@pytest.mark.parametrize("tool", ["manifold3d", "trimesh"])
def test_others_make_the_same_parts(tool: str, volumes: dict[str, float]) -> None:
    for part in _present(tool):
        assert _volume(script(part, tool)) == pytest.approx(volumes[part], rel=_ROUNDNESS), part


@pytest.mark.skipif(not DEEP, reason="build123d takes seconds to import, for each part")
def test_build123d_makes_the_same_parts(volumes: dict[str, float]) -> None:
    pytest.importorskip("build123d")
    for part in _present("build123d"):
        found = _volume(script(part, "build123d"))
        assert found == pytest.approx(volumes[part], rel=_ROUNDNESS), part


@pytest.mark.skipif(shutil.which("openscad") is None, reason="openscad is not installed")
def test_openscad_makes_the_same_parts(volumes: dict[str, float]) -> None:
    for part in _present("openscad"):
        solid = csg.evaluate(read_scad(script(part, "openscad")))
        assert isinstance(solid, b.Solid)
        assert solid.volume == pytest.approx(volumes[part], rel=_ROUNDNESS), part


@pytest.mark.parametrize("part", PARTS)
def test_ours_is_the_shortest_or_the_page_says_why_not(part: str) -> None:
    ours = lines(script(part, "bspcsg"))
    others = {tool for tool in TOOLS if script(part, tool).exists()}
    shorter = {tool for tool in others if lines(script(part, tool)) < ours}
    assert shorter == SHORTER_ELSEWHERE.get(part, set())
    assert all(TOOLS[tool][0] in PARTS[part].remark for tool in shorter)
    missing = {TOOLS[tool][0] for tool in set(TOOLS) - others}
    assert all(name in PARTS[part].remark for name in missing)
