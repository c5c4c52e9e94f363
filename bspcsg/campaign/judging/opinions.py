"""Opinions on a case of further engines: pymeshlab, OpenSCAD, and exact counts of crossings.

They are asked if our result and manifold3d's differ. Each opinion says whether the engine's result
equals ours. For scripts only OpenSCAD is asked, because they are in its language.
"""

import shutil
import time
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from ..._core import __version__
from ...errors import BspcsgError, missing_part
from ...solid.solid import Solid
from ...verify.check import TOLERANCES, same_set_bound
from ...verify.discrepancy import SetDifference, difference_of
from ...verify.referee import count_agreeing
from ..engines.engine_request import EngineAnswer, EngineRequest, NoOpinionError
from ..engines.openscad import ask_openscad, run_script
from ..engines.pymeshlab import ask_pymeshlab
from ..record import OracleRecord
from .mesh_facts import facts_of

#: The engines by name, with the command that installs an optional one.
ENGINES = {
    "manifold3d": "",
    "pymeshlab": 'pip install "bspcsg[repair]"',
    "openscad": "apt-get install openscad",
}

#: The number of points at which crossings are counted, half of them near the surfaces.
_POINTS_COUNTED = 24

#: The typical distance of points near the surfaces, as a fraction of the diagonal of the bounding
#: box.
_NEAR_DISTANCE = 1e-4


def is_installed(engine: str) -> bool:
    """Return true if an engine is installed."""
    return bool(shutil.which(engine)) if engine == "openscad" else find_spec(engine) is not None


def require(engines: Sequence[str]) -> None:
    """Raise an error if one of the engines is not installed.

    Raises
    ------
    MissingPartError
    """
    for engine in engines:
        if not is_installed(engine):
            raise missing_part(engine, "for comparisons", ENGINES[engine])


def opinion(engine: str, question: EngineRequest) -> OracleRecord:
    """Return the record of an engine's result, compared with ours as sets."""
    return _recorded(engine, question, lambda: _ENGINE_FUNCTIONS[engine](question))


def script_opinion(path: Path, ours: Solid, timeout: float) -> OracleRecord:
    """Return the record of OpenSCAD's result for a script, compared with our solid."""
    mesh = ours.normalized().to_mesh()
    question = EngineRequest("csg", [], [], mesh, ours.pitch, timeout, ours.tree.snapped_by)
    return _recorded("openscad", question, lambda: run_script(path, timeout))


def _recorded(
    engine: str, question: EngineRequest, ask: Callable[[], EngineAnswer]
) -> OracleRecord:
    began = time.perf_counter()
    version = ""
    try:
        answer = ask()
        version, record = answer.version, _compared(question, answer)
    except NoOpinionError as error:
        record = _no_opinion(str(error))
    seconds = round(time.perf_counter() - began, 4)
    return {**record, "name": engine, "version": version, "seconds": seconds}


def crossings_opinion(question: EngineRequest, seed: int = 0) -> OracleRecord:
    """Return the record of whether exact counts of crossings at points confirm our result."""
    began = time.perf_counter()
    points = _points(question, np.random.default_rng(seed))
    agreeing, settled = count_agreeing(
        question.program, question.operands, question.ours, points.tolist()
    )
    record = _no_opinion(
        f"{agreeing} of {settled} test points are correctly classified as inside or outside"
    )
    record["name"], record["version"] = "crossing counts", __version__
    record["agrees"] = agreeing == settled if settled else None
    record["seconds"] = round(time.perf_counter() - began, 4)
    return record


def _no_opinion(says: str) -> OracleRecord:
    return {"name": "", "version": "", "agrees": None, "says": says, "facts": None, "seconds": 0.0}


def _compared(question: EngineRequest, answer: EngineAnswer) -> OracleRecord:
    mesh = answer.mesh
    meshes = (question.ours, mesh)
    film = same_set_bound(question.pitch, *meshes, snapped_by=question.snapped_by)
    bound = film + TOLERANCES * answer.shift
    try:
        found, _ = difference_of(question.ours, mesh, question.pitch, bound)
    except BspcsgError as error:
        record = _no_opinion(f"its mesh cannot be compared: {error.message}")
        return {**record, "facts": facts_of(mesh)}
    agrees = found.thickness <= bound
    record = _no_opinion(_difference_text(found, bound))
    if not agrees and answer.complaint:
        record = _no_opinion(f"{record['says']}; but it said: {answer.complaint}")
        return {**record, "facts": facts_of(mesh)}
    return {**record, "agrees": agrees, "facts": facts_of(mesh)}


def _difference_text(found: SetDifference, bound: float) -> str:
    if found.volume == 0:
        return "exactly the same set"
    words = f"differs by volume {found.volume:.6g}, {found.thickness:.3g} thick"
    return f"{words}; rounding explains {bound:.2g}"


_ENGINE_FUNCTIONS: dict[str, Callable[[EngineRequest], EngineAnswer]] = {
    "pymeshlab": ask_pymeshlab,
    "openscad": ask_openscad,
}


def _points(question: EngineRequest, rng: np.random.Generator) -> np.ndarray:
    """Return sample points throughout the box of all meshes and near their surfaces, (n, 3)."""
    meshes = [mesh for mesh in (*question.operands, question.ours) if len(mesh.faces)]
    if not meshes:
        return np.zeros((0, 3))
    used = np.concatenate([mesh.vertices[np.unique(mesh.faces)] for mesh in meshes])
    low, high = used.min(axis=0), used.max(axis=0)
    anywhere = rng.uniform(low, high, (_POINTS_COUNTED // 2, 3))
    beside = []
    for _ in range(_POINTS_COUNTED // 2):
        mesh = meshes[int(rng.integers(len(meshes)))]
        corners = mesh.vertices[mesh.faces[int(rng.integers(len(mesh.faces)))]]
        on_face = rng.dirichlet((1, 1, 1)) @ corners
        beside.append(on_face + rng.normal(size=3) * _NEAR_DISTANCE * np.linalg.norm(high - low))
    return np.concatenate([anywhere, np.array(beside)])
