"""Measures each system that the notes of the lecture link, beside ours, and writes the tables.

    scripts/lecture_peers [--quick] [--record]

Havran, Kopal: rays through a partition tree leaf by leaf and by cases. Cadet, Lécussan: a partition
tree alone, boxes over blocks, bundles. Ar, Montag, Tal: trees that grow with rays, whose visits,
tests and times `scripts/bench_rays` counts. Apache Commons Geometry: regions of polygons, by the
library that it was taken out of (Debian's libcommons-math3-java; needs a JDK). Perfect
autopartitions: how often there is one, what the search costs, and how often a policy finds it.
All times are processor time of one thread. With --record the figures go to scripts/records, and the
tables into docs/lecture.md.
"""

import argparse
import json
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bench_rays import camera, embree, growing, seconds
from bspcsg import bsp
from recording import RECORDS, REPOSITORY, keep
from support.shapes import icosphere

#: The place where Debian's package puts it.
COMMONS = Path("/usr/share/java/commons-math3.jar")

#: A question is asked again until it has taken so long; the best time counts.
SECONDS = 0.5

PAGE = REPOSITORY / "docs" / "lecture.md"

Row = dict[str, Any]


def best(call: Callable[[], Any]) -> float:
    """Return the least processor time of a call in seconds."""
    least, spent = float("inf"), 0.0
    while spent < SECONDS:
        took, _ = seconds(call)
        least, spent = min(least, took), spent + took
    return least


def significant(value: float) -> float:
    """Return three digits of a number."""
    return float(f"{value:.3g}")


# Havran, Kopal


def traversals(sizes: Iterable[int]) -> list[Row]:
    """Return what a ray costs in a tree leaf by leaf from the root, and by cases."""
    rows = []
    for n in sizes:
        tree = bsp.PartitionTree(bsp.analysis.disjoint_segments(n, seed=2), "random")
        start, end = np.random.default_rng(1).uniform(0, 2**24, (2, 300, 2))
        traces = [tree.trace_ray(a, b) for a, b in zip(start, end - start, strict=True)]
        steps = [step for trace in traces for step in trace.steps]
        depth = {node.index: node.depth for node in tree.nodes}
        ways = [2 + depth[s.node] for s in steps if s.kind == "leaf" and s.node is not None]
        cases = [s.case for s in steps if s.kind == "visit"]
        row: Row = {"segments": n, "leaf_by_leaf": sum(ways) / len(traces)}
        row["by_cases"] = sum(trace.cost for trace in traces) / len(traces)
        row |= {case: cases.count(case) / len(cases) for case in ("near", "far", "both")}
        row["us_per_ray"] = 1e6 * best(partial(tree.test_ray, start, end - start)) / len(start)
        rows.append({name: significant(value) for name, value in row.items()})
    return rows


# Cadet, Lécussan


def coupling(level: int, width: int) -> list[Row]:
    """Return the rates of a camera's rays through a partition tree, and through boxes."""
    mesh = icosphere(level)
    case = camera(width)
    order = np.random.default_rng(3).permutation(len(case.origins))
    rays = (case.origins, case.directions)
    shuffled = tuple(array[order] for array in rays)
    few = tuple(array[:: max(len(order) // 2000, 1)] for array in rays)
    small = icosphere(min(level, 4))
    tree = bsp.PartitionTree(small[0][small[1]], top=8)
    caster = bsp.RayCaster(mesh, deferred=False)
    calls: dict[str, tuple[Callable[[], Any], int, int]] = {
        "partition tree alone": (lambda: tree.test_ray(*few), len(few[0]), len(small[1])),
        "boxes over blocks, rays in no order": (
            lambda: caster.first_hit(*shuffled, threads=1),
            len(order),
            len(mesh[1]),
        ),
        "the same, bundles of neighbours": (
            lambda: caster.first_hit(*rays, threads=1),
            len(order),
            len(mesh[1]),
        ),
    }
    engine = embree(mesh)
    if engine is not None:
        calls["embree 4, in single precision"] = (
            lambda: engine.intersects_first(*rays),
            len(order),
            len(mesh[1]),
        )
    return [
        {"system": name, "triangles": triangles, "rays_per_s": significant(count / best(call))}
        for name, (call, count, triangles) in calls.items()
    ]


# Apache Commons Geometry


def blob(n: int, seed: int) -> Any:
    """Return (n, 2) corners of an outline around the origin whose radius goes up and down."""
    radius = np.random.default_rng(seed).uniform(0.7, 1.0, n)
    angle = np.arange(n) * 2 * np.pi / n
    return np.round(np.column_stack([radius * np.cos(angle), radius * np.sin(angle)]), 6)


def commons(sizes: Iterable[int]) -> list[Row]:
    """Return the times of regions of the plane beside those of Apache Commons."""
    rows = []
    for n in sizes:
        a, b = blob(n, 1), blob(n, 2) + 0.3
        points = np.random.default_rng(3).uniform(-1.3, 1.6, (10_000, 2)).round(6)
        union = bsp.Region(a) | bsp.Region(b)
        trees = bsp.Region(a).tree, bsp.Region(b).tree
        row: Row = {"corners": n}
        for name, (one, other) in {"": (bsp.Region(a), bsp.Region(b)), "_by_trees": trees}.items():
            row[f"union{name}_ms"] = 1e3 * best(partial(type(one).__or__, one, other))
        row["build_ms"] = 1e3 * best(partial(bsp.Region, a))
        row["classify_ms"] = 1e3 * best(partial(union.classify, points))
        theirs = java(a, b, points)
        for name in ("build", "union", "classify") if theirs else ():
            row[f"commons_{name}_ms"] = 1e3 * theirs[name]
        if theirs:
            inside = int((union.classify(points) > 0).sum())
            agree = abs(theirs["area"] - union.area) < 1e-9 and inside == theirs["inside"]
            row["commons_agrees"] = agree
        rows.append({k: v if v is True else significant(v) for k, v in row.items()})
    return rows


def java(*arrays: Any) -> dict[str, float]:
    """Return what Apache Commons measures; nothing where it or Java is missing."""
    command = shutil.which("java")
    if command is None or not COMMONS.exists():
        return {}
    text = "\n".join(f"{len(a)} " + " ".join(map(repr, a.reshape(-1).tolist())) for a in arrays)
    source = Path(__file__).with_name("CommonsRegions.java")
    done = subprocess.run(
        [command, "-XX:+UseSerialGC", "-Xss512m", "-cp", str(COMMONS), str(source)],
        input=text,
        capture_output=True,
        text=True,
        check=True,
    )
    pairs = (line.split() for line in done.stdout.splitlines())
    return {name: float(value) for name, value in pairs}


# Perfect autopartitions


def perfect(sizes: Iterable[int], scenes: int) -> list[Row]:
    """Return how many scenes of long segments have a perfect autopartition, and who finds it."""
    rows = []
    for n in sizes:
        counts = dict.fromkeys(("perfect", "least-splits", "random"), 0)
        took = 0.0
        for seed in range(scenes):
            facets = long_segments(n, seed)
            spent, answer = seconds(partial(bsp.PartitionTree.perfect, facets))
            took += spent
            counts["perfect"] += answer is not None
            for policy in ("least-splits", "random"):
                tree = bsp.PartitionTree(facets, policy)
                counts[policy] += len(tree.fragments) == n
        row: Row = {name: count / scenes for name, count in counts.items()}
        row = {"segments": n, **row, "search_ms": 1e3 * took / scenes}
        rows.append({name: significant(value) for name, value in row.items()})
    return rows


def long_segments(n: int, seed: int) -> Any:
    """Return (n, 2, 2) random segments as long as they may be without meeting."""
    random = np.random.default_rng([n, seed])
    kept: list[Any] = []
    while len(kept) < n:
        middle, arm = random.integers(-1000, 1001, 2), random.integers(-500, 501, 2)
        for part in (1.0, 0.5, 0.25):
            one = np.round([middle - part * arm, middle + part * arm])
            if (one[0] != one[1]).any() and not any(_meet(one, other) for other in kept):
                kept.append(one)
                break
    return np.array(kept)


def _meet(a: Any, b: Any) -> bool:
    def turn(p: Any, q: Any, r: Any) -> float:
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    across = turn(a[0], a[1], b[0]) * turn(a[0], a[1], b[1]) <= 0
    return across and turn(b[0], b[1], a[0]) * turn(b[0], b[1], a[1]) <= 0


# The page


def tables(record: Row) -> str:
    """Return the measured part of the page."""
    parts = [
        _table(
            "Havran, Kopal: traversal by cases",
            "Random segments, 300 rays; nodes and leaves visited per ray, and how many inner nodes"
            " of those that it visits a ray leaves on the near side, on the far side, on both.",
            {
                "segments": "segments",
                "leaf_by_leaf": "leaf by leaf from the root",
                "by_cases": "by cases",
                "near": "near only",
                "far": "far only",
                "both": "both",
                "us_per_ray": "µs per ray",
            },
            record["traversal"],
        ),
        _table(
            "Cadet, Lécussan: two levels and bundles",
            "First hits of a camera's rays. The partition tree is that of a coarser ball.",
            {"system": "system", "triangles": "triangles", "rays_per_s": "rays per second"},
            record["coupling"],
        ),
        _table(
            "Ar, Montag, Tal: trees that grow with their rays",
            f"{_shown(record['adaptive_triangles'])} triangles; the first ray, the first tenth of"
            " all, the last tenth. Embree's time is for the same rays.",
            {
                "distribution": "rays",
                "rays": "which",
                "nodes": "nodes visited",
                "tests": "facets tested",
                "us_per_ray": "µs per ray",
                "embreex_us_per_ray": "embree, µs",
            },
            record["adaptive"],
        ),
        _table(
            "Apache Commons Geometry: regions as trees",
            "Two outlines of n corners each, 10 000 points; times in ms. *By trees* merges as they"
            " do. Areas and places agree. It is version 3.6.1 of Commons Math, from which Commons"
            " Geometry was taken.",
            {
                "corners": "corners",
                "build_ms": "build",
                "commons_build_ms": "theirs",
                "union_ms": "union",
                "union_by_trees_ms": "by trees",
                "commons_union_ms": "theirs",
                "classify_ms": "points",
                "commons_classify_ms": "theirs",
            },
            record["commons"],
        ),
        _table(
            "Perfect autopartitions",
            "Random long segments; the share of scenes that have one, and of those in which a"
            " policy cuts nothing; the search, in ms.",
            {
                "segments": "segments",
                "perfect": "there is one",
                "least-splits": "least splits finds it",
                "random": "a random order does",
                "search_ms": "search",
            },
            record["perfect"],
        ),
    ]
    return "\n".join(parts)


def _table(title: str, text: str, columns: dict[str, str], rows: list[Row]) -> str:
    head = [" | ".join(columns.values()), " | ".join("---" for _ in columns)]
    body = [" | ".join(_shown(row.get(name, "—")) for name in columns) for row in rows]
    lines = "\n".join(f"| {line} |" for line in (*head, *body))
    return f"### {title}\n\n{text}\n\n{lines}\n"


def _shown(value: Any) -> str:
    if isinstance(value, str):
        return value
    return f"{value:,.0f}".replace(",", " ") if abs(value) >= 1000 else f"{value:g}"


def page(text: str, record: Row) -> str:
    """Return the page with these tables below its last heading."""
    kept, _, _ = text.partition("<!-- measured -->\n")
    return f"{kept}<!-- measured -->\n\n{tables(record)}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="small scenes and few rays")
    parser.add_argument("--record", action="store_true", help="keep the figures, write the page")
    options = parser.parse_args()
    quick = options.quick
    ball = icosphere(4 if quick else 7)
    record = {
        "traversal": traversals((20, 40) if quick else (100, 400, 1600)),
        "coupling": coupling(4 if quick else 7, 60 if quick else 1000),
        "adaptive_triangles": len(ball[1]),
        "adaptive": growing(ball, 200 if quick else 5000),
        "commons": commons((20,) if quick else (100, 1000)),
        "perfect": perfect((4, 6) if quick else (6, 9, 12, 15, 18), 5 if quick else 100),
    }
    print(tables(record))
    if options.record:
        print(keep("lecture", record))
        record = json.loads((RECORDS / "lecture.json").read_text(encoding="utf-8"))
        PAGE.write_text(page(PAGE.read_text(encoding="utf-8"), record), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
