"""The engine OpenSCAD, whose set operations are exact but whose output has six digits."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from ...errors import BspcsgError
from ...formats.files import read
from ...mesh.mesh import Mesh
from ...processes import run_program
from .engine_request import EngineAnswer, EngineRequest, NoOpinionError, mesh_of

#: The number of significant digits of coordinates that OpenSCAD writes.
_DIGITS = 6

#: The step of OpenSCAD's grid for plane figures, in model units.
_PLANE_GRID = 2.0**-16

#: The largest number of triangles for OpenSCAD: its exact engine takes minutes for more.
_MAX_TRIANGLES = 3000

#: The time limit for OpenSCAD to print its version, in seconds.
_VERSION_TIMEOUT = 30


def ask_openscad(question: EngineRequest) -> EngineAnswer:
    """Return OpenSCAD's result for the operands, passed as polyhedra with all digits.

    Raises
    ------
    NoOpinionError
        If OpenSCAD is not installed, fails or takes too long, or the operands have too many
        triangles.
    """
    count = sum(len(mesh.faces) for mesh in question.operands)
    if count > _MAX_TRIANGLES:
        raise NoOpinionError(
            f"the exact engine of OpenSCAD takes at most {_MAX_TRIANGLES} triangles, not {count}"
        )
    with tempfile.TemporaryDirectory(prefix="bspcsg-") as name:
        script = Path(name, "question.csg")
        script.write_text(_as_script(question), encoding="utf-8")
        return run_script(script, question.timeout)


def _as_script(question: EngineRequest) -> str:
    """Return the operation as a script in OpenSCAD's language, with all digits."""
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
    # OpenSCAD's polyhedra have their corners clockwise.
    faces = mesh.faces[:, ::-1].tolist()
    return f"polyhedron(points = {mesh.vertices.tolist()}, faces = {faces});\n"


def _scad_version() -> str:
    if shutil.which("openscad") is None:
        raise NoOpinionError("openscad is not on the PATH")
    done = _ran(["openscad", "--version"], _VERSION_TIMEOUT)
    return (done.stderr or done.stdout).strip().rpartition(" ")[2]


def run_script(path: Path, timeout: float) -> EngineAnswer:
    """Return OpenSCAD's result for a script.

    Raises
    ------
    NoOpinionError
        If OpenSCAD is not installed, fails or takes too long.
    """
    version = _scad_version()
    with tempfile.TemporaryDirectory(prefix="bspcsg-") as name:
        target = Path(name, "answer.stl")
        done = _ran(["openscad", "-o", str(target), str(path.absolute())], timeout)
        # OpenSCAD omits nodes that it cannot convert, reports an ERROR, and exits with 0.
        errors = [line.strip() for line in done.stderr.splitlines() if "ERROR" in line]
        mesh = _written(target, done)
    return EngineAnswer(version, mesh, _shift(mesh), errors[0] if errors else "")


def _written(target: Path, done: "subprocess.CompletedProcess[str]") -> Mesh:
    """Return the mesh that OpenSCAD wrote, or an empty mesh if it reports an empty result."""
    if "Current top level object is empty" in done.stderr:
        return mesh_of(np.zeros((0, 3)), np.zeros((0, 3)))
    if done.returncode != 0 or not target.is_file():
        lines = [line.strip() for line in done.stderr.splitlines() if line.strip()]
        raise NoOpinionError(f"OpenSCAD failed: {(lines or ['no message'])[-1]}")
    try:
        raw = read(target)
    except BspcsgError as error:
        raise NoOpinionError(
            f"the STL that OpenSCAD wrote cannot be read: {error.message}"
        ) from error
    return mesh_of(raw.vertices, raw.faces)


def _shift(mesh: Mesh) -> float:
    """Return the largest distance by which OpenSCAD's rounding may move a vertex."""
    largest = float(np.abs(mesh.vertices).max(initial=0))
    unit = 10.0 ** (len(str(int(largest))) - _DIGITS)
    return 3**0.5 * (unit / 2 + _PLANE_GRID)


def _ran(command: list[str], timeout: float) -> "subprocess.CompletedProcess[str]":
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen"}
    try:
        return run_program(command, timeout, environment)
    except subprocess.TimeoutExpired as error:
        raise NoOpinionError(f"OpenSCAD took longer than {timeout:g} s") from error
