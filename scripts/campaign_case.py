"""One case of the campaign, in a process of its own: a JSON line in, a JSON line out."""

import json
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import bspcsg as b
from support.checks import manifold_status, open_edges
from support.shapes import Arrays, Vertices, random_rotation

MEMORY_LIMIT = 12 * 2**30
QUARTER_TURN = np.array([(0.0, -1, 0), (1, 0, 0), (0, 0, 1)])

#: What exact volumes are compared by.
PRIMES = np.array([2**61 - 1, 2**61 - 31], dtype=object)

Pose = Callable[[Arrays, Arrays, np.random.Generator], Arrays]


def run(case: dict[str, Any]) -> dict[str, Any]:
    """Run a case and say what came out; an error of the package is an answer too."""
    began = time.perf_counter()
    try:
        answer = run_file(case) if case["kind"] == "file" else run_pair(case)
    except b.BspcsgError as error:
        where = [int(index) for index in error.where[:5]]
        verdict = "defect" if error.code == "internal" else "refused"
        answer = {"verdict": verdict, "code": error.code, "where": where, "says": str(error)}
    except Exception as error:
        answer = {"verdict": "crash", "says": f"{type(error).__name__}: {error}"}
    return {**case, **answer, "seconds": round(time.perf_counter() - began, 3)}


def run_file(case: dict[str, Any]) -> dict[str, Any]:
    """Load a file, and look at the solid that it holds."""
    solid = b.Solid.load(Path(case["folder"]) / case["file"])
    findings = sorted({finding.code for finding in solid.findings})
    answer = {"verdict": "loaded", "triangles": len(solid.to_mesh().faces), "findings": findings}
    return {**answer, "faults": mesh_faults(solid)}


def mesh_faults(solid: "b.Solid") -> list[str]:
    """Return what is wrong with the mesh of a solid."""
    import trimesh

    mesh = solid.normalized().to_mesh()
    if solid.is_empty:
        return [] if len(mesh.faces) == 0 else ["faces of the empty set"]
    faults = []
    if loose := open_edges(mesh.faces):
        faults.append(f"{len(loose)} open edges")
    if (status := manifold_status(mesh.vertices, mesh.faces)) != "NoError":
        faults.append(f"manifold3d says {status}")
    if not trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).is_volume:
        faults.append("trimesh says no volume")
    return faults


def run_pair(case: dict[str, Any]) -> dict[str, Any]:
    """Combine two meshes in four ways, check each result and their volumes together."""
    rng = np.random.default_rng([case["seed"], case["number"]])
    first = arrays_of(case, "first")
    second = POSES[case["pose"]](first, arrays_of(case, "second"), rng)
    a, c = b.Solid(*first), b.Solid(*second)
    results = {"union": a | c, "intersection": a & c, "difference": a - c, "xor": a ^ c}
    operations = {name: run_operation(result, case["check"]) for name, result in results.items()}
    volumes = {name: residues(result) for name, result in results.items()}
    faults = identity_faults(residues(a), residues(c), volumes)
    return {"verdict": "done", "operations": operations, "faults": faults}


def run_operation(result: "b.Solid", check: bool) -> dict[str, Any]:
    """Time one result, look at its mesh, and compare it with manifold3d's if asked."""
    began = time.perf_counter()
    triangles = len(result.to_mesh().faces)
    seconds = round(time.perf_counter() - began, 4)
    answer = {"triangles": triangles, "seconds": seconds, "faults": mesh_faults(result)}
    if not check:
        return {**answer, "verdict": "not checked", "reason": ""}
    report = result.check()
    return {**answer, "verdict": str(report.verdict), "reason": report.reason}


def residues(solid: "b.Solid") -> np.ndarray:
    """Return the exact volume modulo two primes, as Python integers."""
    found = solid.volume_residues
    if found is None:
        raise ArithmeticError("a denominator is a multiple of a prime")
    return np.array(found, dtype=object)


def identity_faults(a: np.ndarray, c: np.ndarray, volumes: dict[str, np.ndarray]) -> list[str]:
    """Return the identities of exact volumes that do not hold modulo the two primes."""
    common = volumes["intersection"]
    gaps = {
        "inclusion-exclusion": volumes["union"] + common - a - c,
        "difference": volumes["difference"] + common - a,
        "symmetric difference": volumes["xor"] - a - c + 2 * common,
    }
    return [f"{name} does not add up" for name, gap in gaps.items() if any(gap % PRIMES)]


def arrays_of(case: dict[str, Any], which: str) -> Arrays:
    """Return a file's mesh as it came."""
    mesh = b.Solid.load(Path(case["folder"]) / case[which]).to_mesh()
    return mesh.vertices, mesh.faces


def _middle(mesh: Arrays) -> Vertices:
    middle: Vertices = (mesh[0].min(axis=0) + mesh[0].max(axis=0)) / 2
    return middle


def _size(mesh: Arrays) -> float:
    return float(np.linalg.norm(np.ptp(mesh[0], axis=0)))


def pose_random(first: Arrays, second: Arrays, rng: np.random.Generator) -> Arrays:
    """Turn, scale and shift the second mesh so that the two overlap in general position."""
    scale = _size(first) / _size(second) * rng.uniform(0.5, 1.5)
    turned = (second[0] - _middle(second)) @ random_rotation(rng).T * scale
    shift = rng.uniform(-0.4, 0.4, 3) * np.ptp(first[0], axis=0)
    return turned + _middle(first) + shift, second[1]


def _alike_in_size(first: Arrays, second: Arrays) -> Vertices:
    # A power of ten keeps short decimals short, and coplanar faces coplanar.
    exponent = round(float(np.log10(_size(first) / _size(second))))
    scaled: Vertices = second[0] * 10.0**exponent
    return scaled


def pose_corner(first: Arrays, second: Arrays, rng: np.random.Generator) -> Arrays:
    """Put the lowest corners of both boxes together: outer faces become coplanar."""
    points = _alike_in_size(first, second)
    return points - points.min(axis=0) + first[0].min(axis=0), second[1]


def pose_beside(first: Arrays, second: Arrays, rng: np.random.Generator) -> Arrays:
    """Put the second mesh against the first: outer faces touch from both sides."""
    points = _alike_in_size(first, second)
    points = points - points.min(axis=0) + first[0].min(axis=0)
    axis = int(rng.integers(3))
    points[:, axis] += first[0][:, axis].max() - first[0][:, axis].min()
    return points, second[1]


def pose_copy(first: Arrays, second: Arrays, rng: np.random.Generator) -> Arrays:
    """Shift a copy of the first along an axis: its faces slide in their own planes."""
    shift = np.zeros(3)
    axis = int(rng.integers(3))
    shift[axis] = rng.choice([0.25, 0.5, 1.0]) * np.ptp(first[0], axis=0)[axis]
    return first[0] + shift, first[1]


def pose_mirror(first: Arrays, second: Arrays, rng: np.random.Generator) -> Arrays:
    """Mirror a copy of the first in the middle of its box."""
    points, axis = first[0].copy(), int(rng.integers(3))
    points[:, axis] = points[:, axis].max() + points[:, axis].min() - points[:, axis]
    return points, first[1][:, ::-1].copy()


def pose_turned(first: Arrays, second: Arrays, rng: np.random.Generator) -> Arrays:
    """Turn a copy of the first by a quarter about the middle of its box."""
    return (first[0] - _middle(first)) @ QUARTER_TURN.T + _middle(first), first[1]


def pose_same(first: Arrays, second: Arrays, rng: np.random.Generator) -> Arrays:
    """List the faces of the first in another order."""
    return first[0], first[1][rng.permutation(len(first[1]))]


POSES: dict[str, Pose] = {
    "random": pose_random,
    "corner": pose_corner,
    "beside": pose_beside,
    "copy": pose_copy,
    "mirror": pose_mirror,
    "turned": pose_turned,
    "same": pose_same,
}


def main() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT, MEMORY_LIMIT))
    for line in sys.stdin:
        print(json.dumps(run(json.loads(line))), flush=True)


if __name__ == "__main__":
    main()
