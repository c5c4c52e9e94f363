"""Times set operations, arrays in to arrays out, beside manifold3d in one process.

Runs of both engines alternate; each answer is checked against the other before its time counts.
Only the ratio means anything on a machine that is shared.
"""

import argparse
import gc
import sys
import time
from collections.abc import Callable
from statistics import median
from typing import Any, NamedTuple

import manifold3d
import numpy as np

import bspcsg as b
from recording import keep
from support.shapes import Arrays, cube, icosphere, moved, random_rotation, turned

Output = tuple[Any, Any]


class Case(NamedTuple):
    """One comparison: the same arrays through both engines."""

    name: str
    triangles: int
    ours: Callable[[], Output]
    theirs: Callable[[], Output]


def their_solid(mesh: Arrays) -> "manifold3d.Manifold":
    """Build manifold3d's solid in double precision."""
    return manifold3d.Manifold(manifold3d.Mesh64(mesh[0], mesh[1].astype(np.uint64)))


def their_arrays(solid: "manifold3d.Manifold") -> Output:
    """Force the evaluation and take the arrays out."""
    solid.num_tri()
    mesh = solid.to_mesh64()
    return mesh.vert_properties[:, :3], mesh.tri_verts


def difference(name: str, first: Arrays, second: Arrays) -> Case:
    """Compare one difference of two meshes."""
    return Case(
        name,
        len(first[1]) + len(second[1]),
        lambda: b.boolean(*first, *second, "difference"),
        lambda: their_arrays(their_solid(first) - their_solid(second)),
    )


def spheres(level: int) -> Case:
    """Compare the difference of two half-overlapping icospheres in general position."""
    rng = np.random.default_rng(17)
    ball = icosphere(level)
    direction = rng.normal(size=3)
    shifted = moved(turned(ball, random_rotation(rng)), direction / np.linalg.norm(direction))
    return difference(f"spheres, {len(ball[1]):,} triangles each", ball, shifted)


def drilled_cube(count: int = 1000) -> Case:
    """Compare a cube minus many small spheres, given as one expression."""
    rng = np.random.default_rng(7)
    ball = icosphere(1)
    drills = [moved((ball[0] * 0.03, ball[1]), at) for at in rng.random((count, 3)).tolist()]

    def ours() -> Output:
        mesh = b.difference(b.Solid(*cube()), *(b.Solid(*drill) for drill in drills)).to_mesh()
        return mesh.vertices, mesh.faces

    def theirs() -> Output:
        solids = [their_solid(cube()), *(their_solid(drill) for drill in drills)]
        return their_arrays(manifold3d.Manifold.batch_boolean(solids, manifold3d.OpType.Subtract))

    return Case(
        f"cube minus {count} spheres, one expression", 12 + count * len(ball[1]), ours, theirs
    )


def cases(quick: bool) -> list[Case]:
    """Return all comparisons, the large ones last."""
    two_cubes = difference("two cubes", cube(), moved(cube(), (0.5, 0.25, 0.125)))
    levels = (4, 5) if quick else (6, 7, 8)
    return [two_cubes, drilled_cube(100 if quick else 1000), *(spheres(level) for level in levels)]


def volume(output: Output) -> float:
    """Return the volume that a mesh bounds."""
    vertices, faces = np.asarray(output[0]), np.asarray(output[1], dtype=np.int64)
    a, c, d = vertices[faces[:, 0]], vertices[faces[:, 1]], vertices[faces[:, 2]]
    return float(np.einsum("ij,ij->i", np.cross(a, c), d).sum() / 6)


def seconds(call: Callable[[], Output]) -> tuple[float, Output]:
    """Time one call, with the rubbish of earlier ones out of the way."""
    gc.collect()
    began = time.perf_counter()
    output = call()
    return time.perf_counter() - began, output


def compare(case: Case, runs: int) -> dict[str, Any]:
    """Alternate both engines, check each answer, and return medians."""
    ours, theirs = [], []
    triangles = (0, 0)
    for _ in range(runs + 1):
        own_time, own = seconds(case.ours)
        their_time, their = seconds(case.theirs)
        ours.append(own_time)
        theirs.append(their_time)
        expected = volume(their)
        if abs(volume(own) - expected) > 1e-9 * abs(expected):
            raise SystemExit(
                f"{case.name}: volumes {volume(own)} and {expected} differ; no time counts"
            )
        triangles = (len(own[1]), len(their[1]))
    # The first run of each warms caches and pools.
    mine, other = median(ours[1:]), median(theirs[1:])
    return {
        "case": case.name,
        "input_triangles": case.triangles,
        "output_triangles": triangles,
        "ours_ms": round(mine * 1e3, 2),
        "manifold3d_ms": round(other * 1e3, 2),
        "ratio": round(mine / other, 3),
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5, help="timed runs of each engine")
    parser.add_argument("--quick", action="store_true", help="small cases only")
    parser.add_argument("--record", action="store_true", help="keep the result in scripts/records")
    options = parser.parse_args()
    print(f"{'case':42} {'ours ms':>10} {'manifold3d':>10} {'ratio':>7}")
    rows = []
    for case in cases(options.quick):
        row = compare(case, options.runs)
        rows.append(row)
        figures = f"{row['ours_ms']:10.2f} {row['manifold3d_ms']:10.2f} {row['ratio']:7.2f}"
        print(f"{case.name:42} {figures}", flush=True)
    if options.record:
        print(keep("bench", {"runs": options.runs, "cases": rows}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
