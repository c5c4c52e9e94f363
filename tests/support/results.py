"""The records of a small campaign, made without running one."""

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import bspcsg as b
from bspcsg.campaign.cases.meshes import packed

Record = dict[str, Any]


def header(**other: Any) -> Record:
    """Return the record of a run."""
    machine = {"processor": "a processor", "cores": 2, "memory_gb": 8.0, "system": "a system"}
    return {
        "schema": 1,
        "type": "run",
        "command": "bspcsg crosscheck a.stl b.stl --seed 7",
        "seed": 7,
        "started": "2026-01-02T03:04:05+00:00",
        "versions": {"bspcsg": b.__version__, "numpy": np.__version__},
        "machine": machine,
        **other,
    }


def solids() -> list[tuple[str, b.Solid, b.Solid]]:
    """Return pairs of solids, each with a name."""
    cube = b.cube(2, center=True)
    return [
        ("corner", cube, cube.translate(1, 1, 1)),
        ("bore", cube, b.cylinder(h=4, r=0.6, segments=24, center=True)),
        ("ball", cube, b.sphere(r=1.2, segments=24)),
        ("away", cube, cube.translate(5, 0, 0)),
    ]


def case(name: str, operation: Any, first: b.Solid, second: b.Solid, **other: Any) -> Record:
    """Return the record of one operation, which is carried out and checked."""
    report = b.validate(operation, first, second).to_dict()
    found = report["set_difference"]
    theirs = report["theirs"]
    return {
        "schema": 1,
        "type": "case",
        "key": f"{name}-{operation}",
        "case": f"{name}-{operation}",
        "kind": "pair",
        "operation": operation,
        "operands": [_operand("a", first), _operand("b", second)],
        "command": f"bspcsg {operation} a.stl b.stl -o out.stl",
        "seed": None,
        "pose": None,
        "verdict": report["verdict"],
        "reason": report["reason"],
        "ours": _facts(report["ours"]),
        "oracles": [
            {
                "name": "manifold3d",
                "version": "3.5",
                "agrees": report["ok"],
                "says": "agrees",
                "facts": None if theirs is None else _facts(theirs),
                "seconds": 0.002,
            }
        ],
        "set_difference": None
        if found is None
        else {key: found[key] for key in ("volume", "thickness", "equal", "place")}
        | {"exact": None},
        "hausdorff": None,
        "bounds": {"same_set": report["same_set_bound"], "rounding": report["rounding_bound"]},
        "seconds": {"load": 0.001, "ours": 0.004, "check": 0.01, "total": 0.015},
        "memory_mb": 90.0,
        "meshes": None,
        **other,
    }


def disagreeing() -> Record:
    """Return a record of a case in which two results differ by a small cube."""
    first, second = b.cube(2), b.cube(0.5).translate(2, 0, 0)
    found = case("<b>bump</b>", "union", first, second)
    difference = {"volume": 0.125, "thickness": 0.166, "equal": False, "place": [2.0, 0.0, 0.0]}
    return found | {
        "verdict": "DISAGREE",
        "reason": "the sets differ by more than rounding",
        "set_difference": difference | {"exact": "1/8"},
    }


def keep_meshes(
    record: Record, folder: Path, operands: Sequence[b.Solid], result: b.Solid, other: b.Solid
) -> Record:
    """Write the meshes of a case beside its results, and return the record with their path.

    `other` stands for manifold3d's result.
    """
    name = f"meshes-{len(list(folder.glob('meshes-*.npz')))}.npz"
    meshes = [solid.to_mesh() for solid in operands]
    data = packed(meshes, result.to_mesh(), (result ^ other).to_mesh())
    (folder / name).write_bytes(data)
    return record | {"meshes": name}


def records(folder: Path) -> list[Record]:
    """Return a run and cases, with and without meshes, one of which failed."""
    found = [header()]
    for name, first, second in solids():
        for operation in ("union", "difference"):
            record = case(name, operation, first, second)
            result = first | second if operation == "union" else first - second
            kept = name != "away"
            operands = [first, second]
            found.append(keep_meshes(record, folder, operands, result, result) if kept else record)
    first, second = b.cube(2), b.cube(0.5).translate(2, 0, 0)
    return [*found, keep_meshes(disagreeing(), folder, [first, second], first | second, first)]


def write_results(path: Path, lines: Iterable[Record]) -> Path:
    """Write records as a results file."""
    path.write_text("".join(json.dumps(line) + "\n" for line in lines))
    return path


def _operand(name: str, solid: b.Solid) -> Record:
    mesh = solid.to_mesh()
    return {
        "name": name,
        "file": f"cad/{name}.stl",
        "sha256": "0" * 64,
        "pose": None,
        "triangles": len(mesh.faces),
        "volume": mesh.volume,
    }


def _facts(facts: Record) -> Record:
    return facts | {"centroid": [0.0, 0.0, 0.0], "inertia": None, "self_intersections": None}
