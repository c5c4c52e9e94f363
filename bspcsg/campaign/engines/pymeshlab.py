"""The engine pymeshlab, whose exact set operations run in a separate process."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from ...processes import run_program
from .engine_request import EngineAnswer, EngineRequest, NoOpinionError, mesh_of

_CHILD = Path(__file__).with_name("pymeshlab_child.py")
_MISSING = 6


def ask_pymeshlab(question: EngineRequest) -> EngineAnswer:
    """Return pymeshlab's result for the operands.

    Raises
    ------
    NoOpinionError
        If pymeshlab is not installed, fails, crashes or takes too long.
    """
    if any(len(mesh.faces) == 0 for mesh in question.operands):
        raise NoOpinionError("pymeshlab does not accept empty operands")
    with tempfile.TemporaryDirectory(prefix="bspcsg-") as name:
        folder = Path(name)
        _put_operands(folder, question)
        said = _run_child(folder, question.timeout)
        if "failed" in said:
            raise NoOpinionError(f"pymeshlab failed: {said['failed']}")
        with np.load(folder / "result.npz", allow_pickle=False) as found:
            return EngineAnswer(said["version"], mesh_of(found["vertices"], found["faces"]))


def _put_operands(folder: Path, question: EngineRequest) -> None:
    arrays: dict[str, np.ndarray] = {
        "operation": np.array(question.operation),
        "count": np.array(len(question.operands)),
    }
    for number, mesh in enumerate(question.operands):
        arrays[f"vertices{number}"], arrays[f"faces{number}"] = mesh.vertices, mesh.faces
    # numpy's type stubs mistake the arrays' names for the option `allow_pickle`.
    np.savez(folder / "operands.npz", **arrays)  # type: ignore[arg-type]


def _run_child(folder: Path, timeout: float) -> dict[str, str]:
    # Without -P, modules in the child's folder would hide packages of the same name.
    command = [sys.executable, "-P", os.fspath(_CHILD), os.fspath(folder)]
    try:
        done = run_program(command, timeout)
    except subprocess.TimeoutExpired as error:
        raise NoOpinionError(f"pymeshlab took longer than {timeout:g} s") from error
    path = folder / "said.json"
    said: dict[str, str] = json.loads(path.read_text("utf-8")) if path.exists() else {}
    if done.returncode == _MISSING and "missing" in said:
        raise NoOpinionError(f"pymeshlab could not be loaded: {said['missing']}")
    if done.returncode != 0 or not said:
        raise NoOpinionError(f"the process of pymeshlab ended with exit code {done.returncode}")
    return said
