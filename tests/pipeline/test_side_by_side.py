"""The same parts as scripts for several tools: the scripts run, and the parts are equal."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import bspcsg as b
from bspcsg import csg
from bspcsg.csg import read_scad
from manual import PARTS, script
from support import DEEP

#: The largest relative difference of volumes: tools make balls, curves and letters of other facets.
_MAX_VOLUME_DIFFERENCE = 0.015


def _present(tool: str) -> list[str]:
    return [part for part in PARTS if script(part, tool).exists()]


def _volume(path: Path) -> float:
    """Return the volume that a script prints."""
    done = subprocess.run(
        [sys.executable, str(path)], capture_output=True, text=True, timeout=110, check=False
    )
    assert done.returncode == 0, done.stderr
    return float(done.stdout)


@pytest.fixture(scope="module")
def volumes() -> dict[str, float]:
    """Return the volume of each part made by our script."""
    found = {}
    for part in PARTS:
        names: dict[str, object] = {}
        exec(compile(script(part, "bspcsg").read_text("utf-8"), part, "exec"), names)
        solid = names["part"]
        assert isinstance(solid, b.Solid) and not solid.to_mesh().open_edges
        found[part] = solid.volume
    return found


@pytest.mark.parametrize("tool", ["manifold3d", "trimesh"])
def test_others_make_the_same_parts(tool: str, volumes: dict[str, float]) -> None:
    for part in _present(tool):
        assert _volume(script(part, tool)) == pytest.approx(
            volumes[part], rel=_MAX_VOLUME_DIFFERENCE
        ), part


@pytest.mark.skipif(not DEEP, reason="build123d takes seconds to import, for each part")
def test_build123d_makes_the_same_parts(volumes: dict[str, float]) -> None:
    pytest.importorskip("build123d")
    for part in _present("build123d"):
        found = _volume(script(part, "build123d"))
        assert found == pytest.approx(volumes[part], rel=_MAX_VOLUME_DIFFERENCE), part


@pytest.mark.skipif(shutil.which("openscad") is None, reason="openscad is not installed")
def test_openscad_makes_the_same_parts(volumes: dict[str, float]) -> None:
    for part in _present("openscad"):
        solid = csg.evaluate(read_scad(script(part, "openscad")))
        assert isinstance(solid, b.Solid)
        assert solid.volume == pytest.approx(volumes[part], rel=_MAX_VOLUME_DIFFERENCE), part
