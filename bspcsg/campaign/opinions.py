"""Further engines, asked when two disagree: pymeshlab, openscad, and counts of crossings.

Each says what set it finds, and whether that is ours. None of them is asked about scripts but
openscad, whose language they are in.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from .. import __version__
from .._types import IndexArray, ProgramLine
from ..check import TOLERANCES, same_set_bound
from ..discrepancy import SetDifference, difference_of
from ..errors import BspcsgError, missing_part
from ..io import read
from ..mesh import Mesh
from ..referee import count_agreeing
from ..weld import welded
from .facts import facts_of
from .record import OracleRecord

#: Engines by name, and what installs each that is optional.
ENGINES = {
    "manifold3d": "",
    "pymeshlab": 'pip install "bspcsg[repair]"',
    "openscad": "apt-get install openscad",
}

#: Significant digits in what openscad writes.
_SCAD_DIGITS = 6

#: OpenSCAD's grid for plane figures, in units.
_PLANE_GRID = 2.0**-16

#: Triangles up to which openscad is asked: its exact engine takes minutes for more.
_SCAD_MOST = 3000

#: Points at which crossings are counted, half of them beside the surfaces.
_POINTS = 24

#: How far beside, by the size of the model.
_BESIDE = 1e-4

_CHILD = Path(__file__).with_name("pymeshlab_child.py")
_MISSING = 6


class NoOpinionError(Exception):
    """An engine gave no usable answer; the message says why."""


@dataclass(frozen=True, eq=False)
class Question:
    """What is asked of an engine.

    Parameters
    ----------
    operation : str
    program : sequence of (str, list of int)
    operands : sequence of Mesh
        Reduced boundaries.
    ours : Mesh
    pitch : int
        Of the lattice of our result.
    timeout : float
        Seconds for one engine.
    """

    operation: str
    program: Sequence[ProgramLine]
    operands: Sequence[Mesh]
    ours: Mesh
    pitch: int
    timeout: float


def is_installed(engine: str) -> bool:
    """Whether an engine can be asked."""
    return bool(shutil.which(engine)) if engine == "openscad" else find_spec(engine) is not None


def require(engines: Sequence[str]) -> None:
    """Refuse engines that are not installed.

    Raises
    ------
    MissingPartError
    """
    for engine in engines:
        if not is_installed(engine):
            raise missing_part(engine, "to compare with", ENGINES[engine])


def opinion(engine: str, question: Question) -> OracleRecord:
    """Ask an engine, and compare what it finds with ours as sets."""
    began = time.perf_counter()
    asked, digits = _ASKED[engine]
    try:
        version, mesh = asked(question)
        record = _compared(question, mesh, digits)
    except NoOpinionError as error:
        version, record = "", _silent(str(error))
    record["name"], record["version"] = engine, version
    record["seconds"] = round(time.perf_counter() - began, 4)
    return record


def crossings_opinion(question: Question, seed: int = 0) -> OracleRecord:
    """Count how rays from some points cross the operands and our result, in rational numbers."""
    began = time.perf_counter()
    points = _points(question, np.random.default_rng(seed))
    agreeing, settled = count_agreeing(
        question.program, question.operands, question.ours, points.tolist()
    )
    record = _silent(f"{agreeing} of {settled} points are where they should be")
    record["name"], record["version"] = "crossing counts", __version__
    record["agrees"] = agreeing == settled if settled else None
    record["seconds"] = round(time.perf_counter() - began, 4)
    return record


def script_opinion(path: Path, ours: Mesh, pitch: int, timeout: float) -> OracleRecord:
    """Return what openscad makes of a script."""
    began = time.perf_counter()
    version = ""
    try:
        version = _scad_version()
        mesh = _exported(path, timeout)
        question = Question("csg", [], [], ours, pitch, timeout)
        record = _compared(question, mesh, _SCAD_DIGITS)
    except NoOpinionError as error:
        record = _silent(str(error))
    record["name"], record["version"] = "openscad", version
    record["seconds"] = round(time.perf_counter() - began, 4)
    return record


def _silent(says: str) -> OracleRecord:
    return {"name": "", "version": "", "agrees": None, "says": says, "facts": None, "seconds": 0.0}


def _compared(question: Question, mesh: Mesh, digits: int | None) -> OracleRecord:
    bound = same_set_bound(question.pitch, question.ours, mesh)
    if digits is not None:
        bound += TOLERANCES * _shift(mesh, digits)
    try:
        found, _ = difference_of(question.ours, mesh, question.pitch, bound)
    except BspcsgError as error:
        record = _silent(f"its mesh cannot be compared: {error.message}")
        return {**record, "facts": facts_of(mesh)}
    record = _silent(_words(found, bound))
    return {**record, "agrees": found.thickness <= bound, "facts": facts_of(mesh)}


def _shift(mesh: Mesh, digits: int) -> float:
    """Return how far a vertex may be from where it was before it was written."""
    largest = float(np.abs(mesh.vertices).max(initial=0))
    unit = 10.0 ** (len(str(int(largest))) - digits)
    return 3**0.5 * (unit / 2 + _PLANE_GRID)


def _words(found: SetDifference, bound: float) -> str:
    if found.volume == 0:
        return "exactly the same set"
    words = f"differs by volume {found.volume:.6g}, {found.thickness:.3g} thick"
    return f"{words}; rounding explains {bound:.2g}"


# pymeshlab


def _ask_pymeshlab(question: Question) -> tuple[str, Mesh]:
    if any(len(mesh.faces) == 0 for mesh in question.operands):
        raise NoOpinionError("it takes no empty operands")
    with tempfile.TemporaryDirectory(prefix="bspcsg-") as name:
        folder = Path(name)
        _put_operands(folder, question)
        said = _asked_child(folder, question.timeout)
        if "failed" in said:
            raise NoOpinionError(f"it failed: {said['failed']}")
        with np.load(folder / "result.npz", allow_pickle=False) as found:
            return said["version"], _mesh(found["vertices"], found["faces"])


def _put_operands(folder: Path, question: Question) -> None:
    arrays: dict[str, np.ndarray] = {
        "operation": np.array(question.operation),
        "count": np.array(len(question.operands)),
    }
    for number, mesh in enumerate(question.operands):
        arrays[f"vertices{number}"], arrays[f"faces{number}"] = mesh.vertices, mesh.faces
    # The stubs of numpy take the arrays' names for its one option.
    np.savez(folder / "operands.npz", **arrays)  # type: ignore[arg-type]


def _asked_child(folder: Path, timeout: float) -> dict[str, str]:
    # Without -P, this package's own folder would hide modules of the standard library.
    command = [sys.executable, "-P", os.fspath(_CHILD), os.fspath(folder)]
    try:
        done = subprocess.run(command, capture_output=True, timeout=timeout, check=False)
    except subprocess.TimeoutExpired as error:
        raise NoOpinionError(f"it took longer than {timeout:g} s") from error
    path = folder / "said.json"
    said: dict[str, str] = json.loads(path.read_text()) if path.exists() else {}
    if done.returncode == _MISSING and "missing" in said:
        raise NoOpinionError(f"it could not be loaded: {said['missing']}")
    if done.returncode != 0 or not said:
        raise NoOpinionError(f"its process ended with {done.returncode}")
    return said


def _mesh(vertices: np.ndarray, faces: np.ndarray) -> Mesh:
    """Return a mesh of what another program gave, with equal corners joined."""
    points = np.ascontiguousarray(vertices, dtype=np.float64).reshape(-1, 3)
    corners: IndexArray = np.ascontiguousarray(faces, dtype=np.int64).reshape(-1, 3)
    if len(corners):
        points, same = welded(points)
        corners = same[corners]
    return Mesh(points, corners, np.zeros((len(corners), 2), dtype=np.int64))


# openscad


def _ask_openscad(question: Question) -> tuple[str, Mesh]:
    count = sum(len(mesh.faces) for mesh in question.operands)
    if count > _SCAD_MOST:
        raise NoOpinionError(f"{count} triangles are too many for its exact engine")
    version = _scad_version()
    with tempfile.TemporaryDirectory(prefix="bspcsg-") as name:
        script = Path(name, "question.csg")
        script.write_text(_as_script(question), encoding="utf-8")
        return version, _exported(script, question.timeout)


def _as_script(question: Question) -> str:
    """Return the question in openscad's language, with all digits."""
    bodies = [_polyhedron(mesh) for mesh in question.operands]
    if question.operation != "xor":
        return f"{question.operation}() {{\n{''.join(bodies)}}}\n"
    text = bodies[0]
    for body in bodies[1:]:
        text = f"union() {{ difference() {{ {text} {body} }} difference() {{ {body} {text} }} }}\n"
    return text


def _polyhedron(mesh: Mesh) -> str:
    if len(mesh.faces) == 0:
        return "group() { }\n"
    # Polyhedra list their corners clockwise.
    faces = mesh.faces[:, ::-1].tolist()
    return f"polyhedron(points = {mesh.vertices.tolist()}, faces = {faces});\n"


def _scad_version() -> str:
    if shutil.which("openscad") is None:
        raise NoOpinionError("openscad is not on the PATH")
    done = _ran(["openscad", "--version"], 30)
    return (done.stderr or done.stdout).strip().rpartition(" ")[2]


def _exported(path: Path, timeout: float) -> Mesh:
    """Return what openscad makes of a script."""
    with tempfile.TemporaryDirectory(prefix="bspcsg-") as name:
        target = Path(name, "answer.stl")
        done = _ran(["openscad", "-o", str(target), str(path.absolute())], timeout)
        if "Current top level object is empty" in done.stderr:
            return _mesh(np.zeros((0, 3)), np.zeros((0, 3)))
        if done.returncode != 0 or not target.is_file():
            lines = [line for line in done.stderr.splitlines() if "ERROR" in line.upper()]
            raise NoOpinionError(f"it failed: {(lines or ['no word'])[-1].strip()}")
        try:
            raw = read(target)
        except BspcsgError as error:
            raise NoOpinionError(f"its STL cannot be read: {error.message}") from error
        return _mesh(raw.vertices, raw.faces)


def _ran(command: list[str], timeout: float) -> "subprocess.CompletedProcess[str]":
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    try:
        return subprocess.run(
            command,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
            env=environment,
            check=False,
        )
    except subprocess.TimeoutExpired as error:
        raise NoOpinionError(f"it took longer than {timeout:g} s") from error


_ASKED: dict[str, tuple[Callable[[Question], tuple[str, Mesh]], int | None]] = {
    "pymeshlab": (_ask_pymeshlab, None),
    "openscad": (_ask_openscad, _SCAD_DIGITS),
}


# Crossing counts


def _points(question: Question, rng: np.random.Generator) -> np.ndarray:
    """Return points all over the operands' boxes and beside the surfaces."""
    meshes = [mesh for mesh in (*question.operands, question.ours) if len(mesh.faces)]
    if not meshes:
        return np.zeros((0, 3))
    used = np.concatenate([mesh.vertices[np.unique(mesh.faces)] for mesh in meshes])
    low, high = used.min(axis=0), used.max(axis=0)
    anywhere = rng.uniform(low, high, (_POINTS // 2, 3))
    beside = []
    for _ in range(_POINTS // 2):
        mesh = meshes[int(rng.integers(len(meshes)))]
        corners = mesh.vertices[mesh.faces[int(rng.integers(len(mesh.faces)))]]
        on_face = rng.dirichlet((1, 1, 1)) @ corners
        beside.append(on_face + rng.normal(size=3) * _BESIDE * np.linalg.norm(high - low))
    return np.concatenate([anywhere, np.array(beside)])
