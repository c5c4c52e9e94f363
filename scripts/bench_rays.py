"""Times first hits beside trimesh's ray engines: the same rays, one thread, answers compared.

Needs the packages embreex and rtree for the engines of those names; one that is missing is left
out. Rates are of rays in processor time; the first pass of bspcsg includes what its tree grows.
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
from recording import keep
from support.shapes import icosphere

#: trimesh's engine without embree takes up to a tenth of a second a ray.
RTREE_RAYS = 50

Arrays = tuple[Any, Any]


class Case(NamedTuple):
    """Rays at a mesh."""

    name: str
    origins: Any
    directions: Any


def camera(width: int) -> Case:
    """Return the rays of a camera at (0, 0, 3), square pixels, the unit sphere in view."""
    x, y = np.meshgrid(np.linspace(-1.1, 1.1, width), np.linspace(1.1, -1.1, width))
    directions = np.stack([x / 3, y / 3, -np.ones_like(x)], axis=-1).reshape(-1, 3)
    origins = np.broadcast_to([0.013, 0.021, 3.0], directions.shape)
    return Case(f"camera, {width}×{width}", origins.copy(), directions)


def scattered(count: int) -> Case:
    """Return rays from all around through the middle third, in no order."""
    rng = np.random.default_rng(0)
    origins = rng.normal(size=(count, 3))
    origins *= 2 / np.linalg.norm(origins, axis=1, keepdims=True)
    return Case(f"scattered, {count:,}", origins, rng.uniform(-0.6, 0.6, (count, 3)) - origins)


def vertices(mesh: Arrays, count: int) -> Case:
    """Return rays through vertices, from outside."""
    rng = np.random.default_rng(1)
    aims = mesh[0][rng.integers(0, len(mesh[0]), count)]
    return Case(f"at vertices, {count:,}", aims * 3, -aims)


def seconds(call: Callable[[], Any]) -> tuple[float, Any]:
    """Time one call in processor time, which other work on the machine does not lengthen."""
    began = time.process_time()
    result = call()
    return time.process_time() - began, result


def engines(mesh: Arrays) -> dict[str, Callable[[Any, Any], Any]]:
    """Return the first-hit functions of trimesh's engines that are installed."""
    surface = trimesh.Trimesh(*mesh, process=False)
    found: dict[str, Callable[[Any, Any], Any]] = {}
    engine: Any
    if importlib.util.find_spec("embreex"):
        from trimesh.ray import ray_pyembree

        engine = ray_pyembree.RayMeshIntersector
        found["embreex"] = engine(surface).intersects_first
    if importlib.util.find_spec("rtree"):
        from trimesh.ray import ray_triangle

        engine = ray_triangle.RayMeshIntersector
        found["rtree"] = engine(surface).intersects_first
    return found


def compare(mesh: Arrays, case: Case) -> list[dict[str, Any]]:
    """Time all engines on one case, and count where they name another triangle than bspcsg."""
    caster = bsp.RayCaster(mesh)
    rays = (case.origins, case.directions)
    first, hits = seconds(lambda: caster.first_hit(*rays, threads=1))
    again, _ = seconds(lambda: caster.first_hit(*rays, threads=1))
    count = len(case.origins)
    mine = count / again
    rows = [_row(case, "bspcsg, first pass", count / first, mine, hits, hits.facet)]
    rows.append(_row(case, "bspcsg", mine, mine, hits, hits.facet))
    for name, cast in engines(mesh).items():
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
    parser.add_argument("--record", action="store_true", help="keep the result in scripts/records")
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
    if options.record:
        print(keep("bench_rays", {"triangles": len(mesh[1]), "cases": rows}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
