"""The cases: what is done, how large, by whom, and what is to be reached."""

from pathlib import Path

from .._types import MeshArrays
from . import real, shapes
from .case import BenchCase, WorkMaker
from .cliffs import CLIFFS
from .targets import (
    Faster,
    Goal,
    GrowthTarget,
    MeanFaster,
    MemoryWithin,
    SteadySteps,
    Within,
)
from .work import BuiltPair, Carving, Chain, Expression, Pair, Work

#: Engines that take part in large pairs and in long chains, beside those that are asked for.
QUICK_ENGINES = ("bspcsg", "manifold3d", "trueform", "meshlib")
CHAIN_ENGINES = ("bspcsg", "manifold3d")


def _spheres(level: int) -> WorkMaker:
    return lambda _: Pair(*shapes.spheres_apart(shapes.icosphere(level)))


def _built_spheres(level: int) -> WorkMaker:
    return lambda _: BuiltPair(*shapes.spheres_apart(shapes.icosphere(level)))


def _even_spheres(n: int) -> WorkMaker:
    return lambda _: Pair(*shapes.spheres_apart(shapes.octasphere(n)))


def _coincident(level: int) -> WorkMaker:
    return lambda _: Pair(*shapes.spheres_coincident(shapes.icosphere(level)))


def _needles(sides: int) -> WorkMaker:
    return lambda _: Pair(*shapes.needles(sides))


def _cubes(_: Path) -> Work:
    cube: MeshArrays = shapes.box((0, 0, 0), (1, 1, 1))
    return Pair(cube, shapes.moved(cube, (0.5, 0.25, 0.125)))


def _drilled_steps(count: int) -> WorkMaker:
    return lambda _: Chain(*shapes.drilled_cube(count))


def _drilled_at_once(count: int) -> WorkMaker:
    return lambda _: Chain(*shapes.drilled_cube(count)).at_once()


def _plate(rows: int) -> WorkMaker:
    return lambda _: Chain(*shapes.drilled_plate(rows))


def _boxes(count: int) -> WorkMaker:
    def make(_: Path) -> Work:
        first, *rest = shapes.random_boxes(count)
        return Chain(first, rest, "union")

    return make


def _menger(depth: int) -> WorkMaker:
    return lambda _: Expression(*shapes.menger(depth))


def _capsules(steps: int) -> WorkMaker:
    def make(shared: Path) -> Work:
        base, tools = real.swept_capsules(shared)
        return Chain(base, tools[:steps])

    return make


def dome(steps: int) -> WorkMaker:
    """Return the carving of the first steps of the dome."""
    block, _ = shapes.dome(0)
    return lambda _: Carving(block, lambda: shapes.dome(steps)[1])


def _real_pair(number: int) -> WorkMaker:
    return lambda shared: Pair(*real.posed_pair(shared, number))


_SPHERE_TARGETS: tuple[Goal, ...] = (Faster(15), Faster(2.5, "trueform"))
_SIZES = (36, 72, 144, 288, 576, 708)

CASES: dict[str, BenchCase] = {
    "spheres-328k": BenchCase(
        "sphere pair difference, 328 k triangles each",
        _SPHERE_TARGETS,
        {"2 × 327 680": _spheres(7)},
        {"2 × 5 120": _spheres(4)},
    ),
    "spheres-1310k": BenchCase(
        "sphere pair difference, 1.31 M triangles each",
        _SPHERE_TARGETS,
        {"2 × 1 310 720": _spheres(8)},
        {"2 × 20 480": _spheres(5)},
        QUICK_ENGINES,
    ),
    "spheres-328k-one-core": BenchCase(
        "the same, 328 k, all engines on one core",
        (Faster(12),),
        {"2 × 327 680": _spheres(7)},
        {"2 × 5 120": _spheres(4)},
        QUICK_ENGINES,
        cores=1,
    ),
    "spheres-1310k-one-core": BenchCase(
        "the same, 1.31 M, all engines on one core",
        (Faster(12),),
        {"2 × 1 310 720": _spheres(8)},
        {"2 × 20 480": _spheres(5)},
        QUICK_ENGINES,
        cores=1,
    ),
    "built-328k": BenchCase(
        "the same, 328 k, operands already built",
        (Faster(6),),
        {"2 × 327 680": _built_spheres(7)},
        {"2 × 5 120": _built_spheres(4)},
        QUICK_ENGINES,
    ),
    "built-1310k": BenchCase(
        "the same, 1.31 M, operands already built",
        (Faster(6),),
        {"2 × 1 310 720": _built_spheres(8)},
        {"2 × 20 480": _built_spheres(5)},
        QUICK_ENGINES,
    ),
    "real-pairs": BenchCase(
        "real pairs in random poses",
        (MeanFaster(5), Faster(1)),
        {f"pair {k}": _real_pair(k) for k in range(16)},
        {f"pair {k}": _real_pair(k) for k in range(2)},
        QUICK_ENGINES,
        needs="meshes/MANIFEST.tsv",
    ),
    "drilled-steps": BenchCase(
        "cube minus 1 000 spheres, every step evaluated",
        (Within(0.2), Faster(100)),
        {"1 000 steps": _drilled_steps(1000)},
        {"8 steps": _drilled_steps(8)},
        CHAIN_ENGINES,
        checked_at_once=True,
    ),
    "drilled-expression": BenchCase(
        "the same as one expression",
        (Faster(4),),
        {"1 000 spheres": _drilled_at_once(1000)},
        {"20 spheres": _drilled_at_once(20)},
        ("bspcsg", "manifold3d", "trueform"),
    ),
    "plate-steps": BenchCase(
        "plate minus 400 cylinders, every step evaluated",
        (Faster(50),),
        {"400 steps": _plate(20)},
        {"4 steps": _plate(2)},
        CHAIN_ENGINES,
        checked_at_once=True,
    ),
    "boxes-steps": BenchCase(
        "union of 1 000 random boxes, every step evaluated",
        (Faster(50),),
        {"1 000 boxes": _boxes(1000)},
        {"20 boxes": _boxes(20)},
        CHAIN_ENGINES,
        checked_at_once=True,
    ),
    "menger-3": BenchCase(
        "Menger sponge of depth 3, one expression",
        (Faster(5),),
        {"depth 3": _menger(3)},
        {"depth 1": _menger(1)},
        CHAIN_ENGINES,
    ),
    "menger-4": BenchCase(
        "Menger sponge of depth 4, one expression",
        (Faster(5),),
        {"depth 4": _menger(4)},
        {"depth 2": _menger(2)},
        CHAIN_ENGINES,
    ),
    "cubes": BenchCase("two cubes", (Faster(1),), {"2 × 12": _cubes}, {"2 × 12": _cubes}),
    "coincident": BenchCase(
        "nearly coincident spheres, 1.31 M triangles each",
        (Faster(3),),
        {"2 × 1 310 720": _coincident(8)},
        {"2 × 5 120": _coincident(4)},
        QUICK_ENGINES,
    ),
    "needles": BenchCase(
        "two rods of needle triangles, 9 450 long, 30 k triangles",
        (Within(0.3),),
        {"2 × 14 996": _needles(3750)},
        {"2 × 236": _needles(60)},
        QUICK_ENGINES,
    ),
    "capsules": BenchCase(
        "swept capsules, 100 steps evaluated",
        (Within(1.0),),
        {"100 steps": _capsules(100)},
        {"5 steps": _capsules(5)},
        CHAIN_ENGINES,
        needs="chains/swept-capsules-100.npz",
        checked_at_once=True,
    ),
    "dome": BenchCase(
        "dome carved out of a block, 100 000 steps evaluated",
        (Within(600.0), MemoryWithin(6144), SteadySteps(2)),
        {"100 000 steps": dome(shapes.DOME_STEPS)},
        {"20 steps": dome(20)},
        ("bspcsg",),
        alone=True,
        limit=900.0,
        checked_at_once=True,
    ),
    "sizes": BenchCase(
        "cost against size, 10 k to 4 M triangles each",
        (GrowthTarget(1.05),),
        {f"2 × {8 * n * n}": _even_spheres(n) for n in _SIZES},
        {f"2 × {8 * n * n}": _even_spheres(n) for n in (8, 16)},
        QUICK_ENGINES,
    ),
    "memory": BenchCase(
        "memory of a pair of 1.05 M triangles each, operands and imports counted",
        (MemoryWithin(500),),
        {"2 × 1 048 352": _even_spheres(362)},
        {"2 × 2 048": _even_spheres(16)},
        QUICK_ENGINES,
        alone=True,
    ),
    **CLIFFS,
}
