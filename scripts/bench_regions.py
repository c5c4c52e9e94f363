"""Time regions of the plane beside shapely, and cross sections beside trimesh; results compared.

Times are processor time, of one thread if the other library has one, the best of several runs in
turns. A ratio is our time divided by theirs.
"""

import argparse
import sys
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import shapely
import trimesh

import bspcsg as b
from bspcsg import bsp
from recording import write_record
from support.shapes import icosphere

#: The number of runs of each library, in turns; the best of each counts.
RUNS = 5

#: The relative difference between results that rounding explains.
ALLOWED = 1e-9

Ask = Callable[[], Any]
Measure = Callable[[Any], float]


class Question(NamedTuple):
    """A computation in bspcsg and in another library, and a function of each result to compare."""

    name: str
    asked: tuple[Ask, Ask]
    numbers: tuple[Measure, Measure]


def area(shape: Any) -> float:
    return float(shape.area)


def areas(shapes: Any) -> float:
    return float(sum(shape.area for shape in shapes))


def total(numbers: Any) -> float:
    return float(np.sum(numbers))


class Sizes(NamedTuple):
    """The numbers of circles, corners, points and triangles of a run."""

    circles: int
    corners: int
    points: int
    distances: int
    subdivisions: int


FULL = Sizes(1000, 100_000, 100_000, 2000, 7)
QUICK = Sizes(50, 1000, 1000, 100, 3)


def circles(count: int) -> list[Any]:
    """Return circles of 64 corners at random in a square, some of which overlap."""
    rng = np.random.default_rng(3)
    angle = np.arange(64) * 2 * np.pi / 64
    turned = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    side = 100 * (count / 1000) ** 0.5
    centres, radii = rng.uniform(0, side, (count, 2)), rng.uniform(1, 4, count)
    return [c + r * turned for c, r in zip(centres, radii, strict=True)]


def rough_disk(corners: int, seed: int, x: float) -> Any:
    """Return the corners of a disk whose radius varies at random by a fiftieth."""
    angle = np.arange(corners) * 2 * np.pi / corners
    radius = 40 * (1 + 0.02 * np.random.default_rng(seed).uniform(-1, 1, corners))
    return np.stack([x + radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def unions(sizes: Sizes) -> list[Question]:
    """Return two computations: the union of circles, and of two outlines with many corners."""
    loops = circles(sizes.circles)
    polygons = [shapely.Polygon(loop) for loop in loops]
    outlines = [rough_disk(sizes.corners, 1, 0.0), rough_disk(sizes.corners, 2, 30.0)]
    (one, other), (first, second) = map(bsp.Region, outlines), map(shapely.Polygon, outlines)
    return [
        Question(
            f"{sizes.circles:,} circles united",
            (lambda: bsp.Region(loops), lambda: shapely.union_all(polygons)),
            (area, area),
        ),
        Question(
            "the same, polygons made",
            (
                lambda: bsp.Region(loops),
                lambda: shapely.union_all([shapely.Polygon(loop) for loop in loops]),
            ),
            (area, area),
        ),
        Question(
            f"two outlines of {sizes.corners:,} corners united",
            (lambda: one | other, lambda: first | second),
            (area, area),
        ),
    ]


def points(sizes: Sizes) -> list[Question]:
    """Return two computations: whether points are inside, and their distances from a boundary."""
    loops, rng = circles(sizes.circles), np.random.default_rng(4)
    ours, theirs = bsp.Region(loops), shapely.union_all([shapely.Polygon(loop) for loop in loops])
    shapely.prepare(theirs)
    reach = loops[0].max()
    places = rng.uniform(0, reach, (sizes.points, 2))
    some = rng.uniform(0, reach, (sizes.distances, 2))
    boundary = theirs.boundary
    return [
        Question(
            f"{sizes.points:,} points classified",
            (lambda: ours.classify(places), lambda: shapely.contains_xy(theirs, *places.T)),
            (lambda sides: total(sides > 0), total),
        ),
        Question(
            f"{sizes.distances:,} points projected",
            (
                lambda: ours.project(some),
                lambda: shapely.distance(boundary, shapely.points(some)),
            ),
            (lambda found: total(found[1]), total),
        ),
    ]


def sections(sizes: Sizes) -> list[Question]:
    """Return one computation: the areas of thirty cross sections of a ball."""
    mesh = icosphere(sizes.subdivisions)
    surface = trimesh.Trimesh(*mesh, process=False)
    solid = b.Solid.from_mesh(mesh)
    heights = np.linspace(-0.9, 0.9, 30)

    return [
        Question(
            f"30 sections of {len(mesh[1]):,} triangles, areas",
            (
                lambda: areas(solid.slice(heights)),
                lambda: areas(surface.section_multiplane([0, 0, 0], [0, 0, 1], heights)),
            ),
            (float, float),
        )
    ]


def timed(ask: Ask) -> tuple[float, Any]:
    """Return the processor time of one call in seconds, and its result."""
    began = time.process_time()
    answer = ask()
    return time.process_time() - began, answer


def row(question: Question) -> dict[str, Any]:
    """Return the best times of both libraries for a computation, and whether the results agree."""
    runs = [[timed(ask) for ask in question.asked] for _ in range(RUNS)]
    ours, theirs = (min(took for took, _ in side) for side in zip(*runs, strict=True))
    mine, other = (
        number(answer) for number, (_, answer) in zip(question.numbers, runs[-1], strict=True)
    )
    return {
        "question": question.name,
        "bspcsg_ms": round(1000 * ours, 2),
        "other_ms": round(1000 * theirs, 2),
        "ratio": round(ours / theirs, 3),
        "agrees": bool(abs(mine - other) <= ALLOWED * abs(other)),
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="few and small")
    parser.add_argument("--record", action="store_true", help="keep the result in out/records")
    options = parser.parse_args()
    sizes = QUICK if options.quick else FULL
    rows = []
    print(f"{'question':45}{'bspcsg':>12}{'other':>12}{'ratio':>8}  agrees")
    for question in (*unions(sizes), *points(sizes), *sections(sizes)):
        found = row(question)
        rows.append(found)
        name, ours, theirs, ratio, agrees = found.values()
        print(f"{name:45}{ours:9.2f} ms{theirs:9.2f} ms{ratio:8.2f}  {agrees}", flush=True)
    if options.record:
        print(write_record("bench_regions", {"shapely": shapely.__version__, "questions": rows}))
    return 0 if all(found["agrees"] for found in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
