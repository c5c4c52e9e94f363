"""`CommandLine`: the work of a command-line call that reads two STL files and writes one."""

import sys
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import numpy as np

from .._types import MeshArrays
from ..formats import stl
from ..formats.raw import RawMesh
from ..formats.source import Source
from .engines import ENGINES, Engine, EngineError
from .meter import run_metered
from .result_facts import mesh_volume
from .targets import MAIN_RIVAL
from .workloads import Evidence, Outcome, StepCallback, SurfaceExtent, Work, extent_of

_BOOT = Path(__file__).with_name("start_worker.py")

#: The largest relative error of a coordinate in an STL file.
_SINGLE = 2.0**-24


@dataclass(frozen=True)
class CommandLine(Work):
    """The difference of two STL files by the command ``bspcsg difference``.

    Parameters
    ----------
    first, second : (vertices, faces)
    options : tuple of str
    folder : Path
        The folder for the files; the process that starts a worker removes it.
    """

    first: MeshArrays
    second: MeshArrays
    options: tuple[str, ...] = ()
    folder: Path = field(default_factory=lambda: Path(mkdtemp()))

    def extent(self) -> SurfaceExtent:
        """Return the total extent of both operands."""
        return extent_of([self.first, self.second])

    def prepare(self, engine: Engine) -> list[str]:
        """Write both operands to STL files and return their paths."""
        paths = [self.folder / name for name in ("a.stl", "b.stl")]
        for path, mesh in zip(paths, (self.first, self.second), strict=True):
            if not path.exists():
                path.write_bytes(b"".join(stl.binary(RawMesh(*mesh, path.stem))))
        return [str(path) for path in paths]

    def run(self, engine: Engine, prepared: Any, tell: StepCallback) -> Outcome:
        """Run the command and read its output file."""
        answer = self.folder / "c.stl"
        asked = ["difference", *prepared, "-o", str(answer), "-q", *self.options]
        used = run_metered([*_ours(), *asked])
        if used.code:
            raise EngineError(used.said)
        return Outcome(_read(answer), process=used)

    def proof(self, answer: MeshArrays) -> Evidence:
        """Compare the volume with the main rival's volume for the same files."""
        operands = [_read(Path(name)) for name in self.prepare(ENGINES[MAIN_RIVAL]())]
        theirs = mesh_volume(ENGINES[MAIN_RIVAL]().boolean(operands[0], operands[1], "difference"))
        ours, extent = mesh_volume(answer), self.extent()
        apart = abs(ours.value - theirs.value)
        # Rounding moves each of the three coordinates of a vertex.
        moved = extent.area * extent.size * 3**0.5 * 2 * _SINGLE
        allowed = moved + ours.error + theirs.error
        return Evidence(apart <= allowed, f"of {MAIN_RIVAL} {apart:.1e}, {allowed:.1e} allowed")


def _ours() -> list[str]:
    """Return the start of the command line of this package with this process's core."""
    root = Path(__file__).resolve().parents[2]
    core = import_module("bspcsg._core").__file__
    return [sys.executable, "-P", str(_BOOT), str(root), str(core), "--"]


def _read(path: Path) -> MeshArrays:
    raw = stl.read(Source(path.name, path.read_bytes()))
    return np.asarray(raw.vertices), np.asarray(raw.faces)
