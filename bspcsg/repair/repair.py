"""Closing and orienting meshes that are not solids, by pymeshlab in a process of its own."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .._types import BoolArray
from ..errors import BspcsgError, Finding, InvalidMeshError, invalid_parameter, missing_part
from ..formats.raw import RawMesh
from ..mesh.boxes import boxes_around, boxes_of
from ..mesh.mesh import Mesh, surfaces_of
from ..mesh.weld import welded
from ..processes import run_program

#: The steps of a repair in the order in which they are taken.
STEPS = ("weld", "dedup", "drop", "split", "orient", "fill")

_CHILD = Path(__file__).with_name("pymeshlab_child.py")
_MISSING = 6

#: The largest limit of edges around a hole that pymeshlab accepts, a 32-bit number.
_MAX_HOLE_EDGES = 2**31 - 1

#: The largest number of names that a message shows.
_MAX_NAMES_SHOWN = 4


@dataclass(frozen=True, eq=False)
class Repair:
    """The result of a repair.

    Parameters
    ----------
    mesh : RawMesh
    failed : dict of str to str
        The reason by the name of each step that failed.
    turned : int
        The number of triangles reversed because they faced inwards.
    dropped : int
        The number of removed triangles of stray fragments, pieces of surface that enclose nothing.
    lost : tuple of Finding
        Findings about names and attributes, which a repair loses.
    """

    mesh: RawMesh
    failed: dict[str, str]
    turned: int
    dropped: int = 0
    lost: tuple[Finding, ...] = ()


def repair(
    raw: RawMesh,
    steps: Sequence[str] = STEPS,
    *,
    weld: float = 0.0,
    max_hole: int = 1000,
    timeout: float | None = None,
) -> Repair:
    """Close and orient a mesh: remove duplicates and fragments, orient faces and fill holes.

    Names of several objects and all attributes are lost, and reported in `lost`.

    Parameters
    ----------
    raw : RawMesh
    steps : sequence of str
        Names from `STEPS`; they are taken in the order of `STEPS`: join vertices, drop repeated and
        flat triangles, drop stray fragments, split edges with more than two triangles, orient, fill
        holes.
    weld : float
        Distance in model units up to which vertices are joined; equal vertices always are.
    max_hole : int
        The largest number of edges around a hole that is filled.
    timeout : float, optional
        Seconds after which the repair is stopped.

    Raises
    ------
    InvalidMeshError
        If the mesh has no triangle.
    InvalidParameterError
        If a step is unknown.
    MissingPartError
        If pymeshlab, or a system library it needs, is missing.
    BspcsgError
        If pymeshlab crashes ("repair_failed") or takes too long ("timed_out").
    """
    unknown = set(steps) - set(STEPS)
    if unknown:
        message = f"Unknown repair step {sorted(unknown)[0]!r}; known are {', '.join(STEPS)}."
        raise invalid_parameter(message)
    if len(raw.faces) == 0:
        message = f"{raw.name or 'the mesh'}: the mesh has no triangles, so it cannot be repaired."
        raise InvalidMeshError(message, "empty_mesh")
    ordered = [step for step in STEPS if step in steps]
    settings = {"steps": ordered, "weld": weld, "max_hole": min(max_hole, _MAX_HOLE_EDGES)}
    with tempfile.TemporaryDirectory() as folder:
        np.savez(
            Path(folder) / "mesh.npz",
            vertices=raw.vertices,
            faces=raw.faces,
            settings=np.array(json.dumps(settings)),
        )
        said = _run_child(Path(folder), timeout)
        with np.load(Path(folder) / "repaired.npz", allow_pickle=False) as found:
            vertices = np.ascontiguousarray(found["vertices"], dtype=np.float64).reshape(-1, 3)
            faces = np.ascontiguousarray(found["faces"], dtype=np.int64).reshape(-1, 3)
    inward = _facing_inwards(Mesh(vertices, faces, faces[:, :2])) if "orient" in steps else None
    turned = 0 if inward is None else int(inward.sum())
    if inward is not None and turned:
        faces[inward] = faces[inward][:, ::-1]
    # Join equal vertices again, which the steps “split” and “orient” may have separated.
    points, same = welded(vertices[faces].reshape(-1, 3))
    called = tuple((name, len(faces)) for name, _ in raw.objects) if len(raw.objects) == 1 else ()
    mesh = RawMesh(points, same.reshape(-1, 3), raw.name, (), called, raw.unit)
    return Repair(mesh, said["failed"], turned, said["dropped"], losses_of(raw))


def losses_of(raw: RawMesh) -> tuple[Finding, ...]:
    """Return findings about names of objects and attributes, which a repair of `raw` would lose."""
    objects = [name for name, _ in raw.objects if name] if len(raw.objects) > 1 else []
    attributes = () if raw.attributes is None else raw.attributes.names
    kinds = (
        ("names_left_out", "names of objects", dict.fromkeys(objects)),
        ("attributes_left_out", "attributes", attributes),
    )
    found = []
    for code, kind, names in kinds:
        if names:
            told = ", ".join(f"“{name}”" for name in list(names)[:_MAX_NAMES_SHOWN])
            more = (
                f" and {len(names) - _MAX_NAMES_SHOWN} more"
                if len(names) > _MAX_NAMES_SHOWN
                else ""
            )
            message = f"the repair cannot keep {kind}, so {told}{more} were left out."
            found.append(Finding(code, "warning", message, (), len(names)))
    return tuple(found)


def _run_child(folder: Path, timeout: float | None) -> dict[str, Any]:
    """Run ``pymeshlab_child.py`` on a folder; return the failed steps and removed triangles."""
    # Without -P, modules in the child's folder would hide modules of the standard library.
    command = [sys.executable, "-P", os.fspath(_CHILD), os.fspath(folder)]
    try:
        done = run_program(command, timeout)
    except subprocess.TimeoutExpired as error:
        message = (
            f"the repair took longer than the time limit of {timeout:g} s and was stopped; raise"
            " the limit, or leave out steps."
        )
        raise BspcsgError(message, "timed_out") from error
    path = folder / "said.json"
    said: dict[str, Any] = json.loads(path.read_text("utf-8")) if path.exists() else {}
    if done.returncode == _MISSING and "missing" in said:
        raise missing_part(
            "pymeshlab",
            f"for repairs: {said['missing']} cannot be imported",
            install_command(said["missing"]),
        )
    if done.returncode != 0:
        last = done.stderr.strip().splitlines()[-1:] or ["no message"]
        message = f"pymeshlab failed with exit code {done.returncode}: {last[0]}"
        raise BspcsgError(message, "repair_failed")
    return said


def install_command(reason: str) -> str:
    """Return the shell command that installs what is missing, pymeshlab or a system library."""
    if "libGL" in reason or "libOpenGL" in reason or "plug-ins" in reason:
        return "apt-get install --no-install-recommends libgl1 libopengl0"
    return 'pip install "bspcsg[repair]"'


def _facing_inwards(mesh: Mesh) -> BoolArray:
    """Say for each face whether it belongs to a connected surface that is inside out.

    A surface inside the box of another may be the wall of a cavity; it counts as inside out only if
    the mesh as a whole is.
    """
    if len(mesh.faces) == 0:
        return np.zeros(0, dtype=np.bool_)
    owner = surfaces_of(mesh.faces, len(mesh.vertices))
    corners = mesh.vertices[mesh.faces]
    boxes = boxes_of(corners, owner)
    # The volume relative to the centre of the surface's box, which also suits a surface with holes.
    a, b, c = (corners[:, k] - boxes.mean(axis=1)[owner] for k in range(3))
    volumes = np.bincount(owner, np.einsum("ij,ij->i", np.cross(a, b), c))
    # If the whole mesh is inside out, so are the cavities.
    sign = -1 if volumes.sum() < 0 else 1
    is_inner = np.array([len(around) > 1 for around in boxes_around(boxes, boxes)])
    is_inward: BoolArray = np.where(is_inner, sign, volumes)[owner] < 0
    return is_inward
