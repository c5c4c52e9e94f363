"""Time rays beside trimesh's engines: the same rays, one thread, hits compared.

The engines embreex and rtree need the packages of these names; one that is missing is left out.
Rates are rays per second of processor time; the first pass of bspcsg includes the division of its
boxes. Adaptive trees are measured, too: the cost of early and of late rays, for three distributions
of rays.
"""

import argparse
import importlib.util
import sys
import time
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import trimesh

from bspcsg import bsp
from recording import write_record
from support.shapes import icosphere

#: The number of rays for trimesh's engine without embree, which takes up to 0.1 s a ray.
RTREE_RAYS = 50

Arrays = tuple[Any, Any]


class Case(NamedTuple):
    """Rays that are cast at a mesh."""

    name: str
    origins: Any
    directions: Any


def camera(width: int) -> Case:
    """Return the rays of a camera at (0, 0, 3) with square pixels, which sees the unit sphere."""
    x, y = np.meshgrid(np.linspace(-1.1, 1.1, width), np.linspace(1.1, -1.1, width))
    directions = np.stack([x / 3, y / 3, -np.ones_like(x)], axis=-1).reshape(-1, 3)
    origins = np.broadcast_to([0.013, 0.021, 3.0], directions.shape)
    return Case(f"camera, {width}×{width}", origins.copy(), directions)


def scattered(count: int) -> Case:
    """Return rays from random points at distance 2 from the origin to random points near it."""
    rng = np.random.default_rng(0)
    origins = rng.normal(size=(count, 3))
    origins *= 2 / np.linalg.norm(origins, axis=1, keepdims=True)
    return Case(f"scattered, {count:,}", origins, rng.uniform(-0.6, 0.6, (count, 3)) - origins)


def vertices(mesh: Arrays, count: int) -> Case:
    """Return rays from outside through random vertices of a mesh."""
    rng = np.random.default_rng(1)
    aims = mesh[0][rng.integers(0, len(mesh[0]), count)]
    return Case(f"at vertices, {count:,}", aims * 3, -aims)


def seconds(call: Callable[[], Any]) -> tuple[float, Any]:
    """Return the processor time of a call in seconds, and its result."""
    began = time.process_time()
    result = call()
    return time.process_time() - began, result


def engines(mesh: Arrays) -> dict[str, Any]:
    """Return the installed ray engines of trimesh by name, made for a mesh."""
    surface = trimesh.Trimesh(*mesh, process=False)
    found: dict[str, Any] = {}
    engine: Any
    if importlib.util.find_spec("embreex"):
        from trimesh.ray import ray_pyembree

        engine = ray_pyembree.RayMeshIntersector
        found["embreex"] = engine(surface)
    if importlib.util.find_spec("rtree"):
        from trimesh.ray import ray_triangle

        engine = ray_triangle.RayMeshIntersector
        found["rtree"] = engine(surface)
    return found


def embree(mesh: Arrays) -> Any:
    """Return embree's engine with its tree already built, or None if it is not installed."""
    engine = engines(mesh).get("embreex")
    if engine is not None:
        engine.intersects_first(np.array([[0.0, 0, 3]]), np.array([[0.0, 0, -1]]))
    return engine


def build(mesh: Arrays) -> dict[str, float]:
    """Return the milliseconds of building all boxes, of refitting them, and of embree's tree."""
    took, caster = seconds(lambda: bsp.RayCaster(mesh, deferred=False))
    moved = (mesh[0] * [1, 1, 1.01], mesh[1])
    times = {"bspcsg": took, "bspcsg, refitted": seconds(lambda: caster.refitted(moved))[0]}
    times["embreex"] = seconds(lambda: embree(mesh))[0]
    return {name: round(1000 * time, 1) for name, time in times.items()}


def other_questions(mesh: Arrays, case: Case) -> list[dict[str, Any]]:
    """Time three queries beside embree: the first facet, occlusion, and all hits of each ray."""
    engine = embree(mesh)
    if engine is None:
        return []
    caster = bsp.RayCaster(mesh, deferred=False)
    rays = (case.origins, case.directions)
    pairs: dict[str, tuple[Callable[[], Any], Callable[[], Any]]] = {
        "first facet": (
            lambda: np.count_nonzero(caster.first_facet(*rays, threads=1) >= 0),
            lambda: np.count_nonzero(engine.intersects_first(*rays) >= 0),
        ),
        "occluded": (
            lambda: caster.occluded(rays[0], directions=rays[1], threads=1).sum(),
            lambda: engine.intersects_any(*rays).sum(),
        ),
        "all hits": (
            lambda: len(caster.all_hits(*rays, threads=1).hits),
            lambda: len(engine.intersects_id(*rays, multiple_hits=True)[0]),
        ),
    }
    rows = []
    for question, calls in pairs.items():
        (mine, found), (theirs, other) = (seconds(call) for call in calls)
        rates = [round(len(rays[0]) / took) for took in (mine, theirs)]
        rows.append(
            {
                "case": case.name,
                "question": question,
                "bspcsg_rays_per_s": rates[0],
                "embreex_rays_per_s": rates[1],
                "bspcsg_is_times_faster": round(theirs / mine, 3),
                "found": [int(found), int(other)],
            }
        )
    return rows


def distributions(count: int) -> dict[str, Arrays]:
    """Return rays at a unit sphere: spread over it, at one point of it, and at a moving point."""
    rng = np.random.default_rng(2)
    origins = rng.normal(size=(count, 3))
    origins *= 2 / np.linalg.norm(origins, axis=1, keepdims=True)
    small = rng.normal(size=(count, 3)) * 0.05
    angle = np.linspace(0, np.pi, count)
    around = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    near = np.array([1.0, 0, 0]) + small
    return {
        "uniform": (origins, rng.uniform(-0.6, 0.6, (count, 3)) - origins),
        "skewed": (3 * near, -near),
        "moving": (3 * around + small, -around),
    }


def growing(mesh: Arrays, count: int) -> list[dict[str, Any]]:
    """Return the cost of rays in an adaptive tree: the first ray, first tenth, last tenth."""
    engine = embree(mesh)
    rows = []
    for name, (origins, directions) in distributions(count).items():
        tree = bsp.AdaptiveTree(mesh)
        tenth = count // 10
        parts = {"first": slice(0, 1), "tenth": slice(1, tenth), "last tenth": slice(-tenth, None)}
        for part, some in parts.items():
            if part == "last tenth":
                tree.test_ray(origins[tenth:-tenth], directions[tenth:-tenth])
            took, tests = seconds(partial(tree.test_ray, origins[some], directions[some]))
            row: dict[str, Any] = {"distribution": name, "rays": part}
            row["nodes"] = round(float(tests.nodes.mean()), 1)
            row["tests"] = round(float(tests.tests.mean()), 1)
            row["us_per_ray"] = round(1e6 * took / len(tests.nodes), 1)
            if engine is not None:
                cast = partial(engine.intersects_first, origins[some], directions[some])
                row["embreex_us_per_ray"] = round(1e6 * seconds(cast)[0] / len(tests.nodes), 1)
            rows.append(row)
    return rows


def compare(mesh: Arrays, case: Case) -> list[dict[str, Any]]:
    """Time all engines on one case, and count the rays that hit another triangle than in bspcsg."""
    caster = bsp.RayCaster(mesh)
    rays = (case.origins, case.directions)
    first, hits = seconds(lambda: caster.first_hit(*rays, threads=1))
    again, _ = seconds(lambda: caster.first_hit(*rays, threads=1))
    count = len(case.origins)
    mine = count / again
    rows = [_row(case, "bspcsg, first pass", count / first, mine, hits, hits.facet)]
    rows.append(_row(case, "bspcsg", mine, mine, hits, hits.facet))
    for name, engine in engines(mesh).items():
        cast = engine.intersects_first
        some = slice(None, None, max(count // RTREE_RAYS, 1) if name == "rtree" else 1)
        few = (case.origins[some], case.directions[some])
        cast(few[0][:10], few[1][:10])
        took, facets = seconds(partial(cast, *few))
        rows.append(_row(case, name, len(few[0]) / took, mine, hits[some], np.asarray(facets)))
    return rows


def _row(
    case: Case, name: str, rate: float, mine: float, hits: bsp.Hits, facets: Any
) -> dict[str, Any]:
    return {
        "case": case.name,
        "engine": name,
        "rays_per_s": round(rate),
        "bspcsg_is_times_faster": round(mine / rate, 3),
        "misses_that_hit": int((hits.hit & (facets < 0)).sum()),
        "other_triangle": int((hits.hit & (facets >= 0) & (facets != hits.facet)).sum()),
        "hits_that_miss": int((~hits.hit & (facets >= 0)).sum()),
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a small mesh and few rays")
    parser.add_argument("--record", action="store_true", help="keep the result in out/records")
    options = parser.parse_args()
    mesh = icosphere(4 if options.quick else 7)
    width, count = (100, 5000) if options.quick else (1000, 300_000)
    print(f"{len(mesh[1]):,} triangles, one thread")
    print(
        f"{'case':22}{'engine':20}{'rays/s':>12}{'ratio':>9}{'misses':>8}{'others':>8}{'extra':>7}"
    )
    rows = []
    for case in (camera(width), scattered(count), vertices(mesh, count)):
        for row in compare(mesh, case):
            rows.append(row)
            case_name, engine, rate, ratio, *counts = row.values()
            figures = f"{rate:12,}{ratio:9.2f}{counts[0]:8d}{counts[1]:8d}{counts[2]:7d}"
            print(f"{case_name:22}{engine:20}{figures}", flush=True)
    others = [
        row for case in (camera(width), scattered(count)) for row in other_questions(mesh, case)
    ]
    grown = growing(mesh, 500 if options.quick else 5000)
    times = build(mesh)
    for row in (*others, *grown, {"built, ms": times}):
        print(row)
    if options.record:
        kept = {"triangles": len(mesh[1]), "cases": rows, "questions": others}
        print(write_record("bench_rays", kept | {"adaptive": grown, "build_ms": times}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
