"""The benchmark cases: operations, numbers of triangles, engines and targets."""

from math import pi
from pathlib import Path

from .._types import MeshArrays
from . import public_meshes, shapes
from .case import BenchCase, WorkMaker
from .command_line import CommandLine
from .dense_cases import DENSE_CASES
from .engines import Operation
from .targets import (
    MAIN_RIVAL,
    OURS,
    Faster,
    Goal,
    GrowthTarget,
    MeanFaster,
    MemoryWithin,
    ScratchWithin,
    SteadySteps,
    StepWithin,
    Within,
    WorkWithin,
)
from .workloads import (
    BuiltPair,
    Carving,
    Chain,
    Expression,
    OverlappingPair,
    Pair,
    PairAsBalls,
    Work,
)

#: The engines that are timed on large pairs, and on long chains.
QUICK_ENGINES = ("bspcsg", "manifold3d", "trueform", "meshlib")
CHAIN_ENGINES = ("bspcsg", "manifold3d")

#: The engines besides the main rival that the targets of pairs refer to.
_OTHERS = ("meshlib", "trueform")

_MESHES = "meshes/MANIFEST.tsv"

#: The operations on real pairs.
_OPERATIONS: tuple[Operation, ...] = ("union", "intersection", "difference")


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
        base, tools = public_meshes.swept_capsules(shared)
        return Chain(base, tools[:steps])

    return make


def dome(steps: int) -> WorkMaker:
    """Return the maker of the work of carving the first `steps` balls of the dome."""
    block, _ = shapes.dome(0)
    return lambda _: Carving(block, lambda: shapes.dome(steps)[1])


def _real_pair(number: int, operation: Operation, kind: str) -> WorkMaker:
    work = OverlappingPair if kind == "overlap" else Pair

    def make(shared: Path) -> Work:
        pair = public_meshes.real_pairs(shared)[number]
        return work(*pair.meshes(shared), operation, pair.names)

    return make


def _label(number: int, operation: Operation) -> str:
    return f"pair {number}, {operation}"


def _real_pairs(title: str, kind: str, targets: tuple[Goal, ...]) -> BenchCase:
    """Return the case of all operations on the real pairs of a kind."""
    items = {
        _label(number, operation): _real_pair(number, operation, kind)
        for number in range(public_meshes.PAIRS)
        for operation in _OPERATIONS
    }

    def chosen(shared: Path) -> list[str]:
        found = enumerate(public_meshes.kinds(shared))
        numbers = [number for number, each in found if each == kind]
        return [_label(number, operation) for number in numbers for operation in _OPERATIONS]

    overlap = kind == "overlap"
    return BenchCase(
        f"real pairs in random poses, {title}",
        targets,
        items,
        items,
        CHAIN_ENGINES if overlap else QUICK_ENGINES,
        needs=_MESHES,
        other_sets=overlap,
        chosen=chosen,
    )


def _milled_by_balls(count: int) -> WorkMaker:
    return lambda _: Chain(*shapes.milled_by_balls(count))


def _milled_by_cylinders(count: int) -> WorkMaker:
    return lambda _: Chain(*shapes.milled_by_cylinders(count))


def _files(level: int, *options: str) -> WorkMaker:
    return lambda _: CommandLine(*shapes.spheres_apart(shapes.icosphere(level)), options)


#: The volume of a unit ball minus a unit ball whose centre is on the surface of the first.
_BALL_WITHOUT_BALL = 11 * pi / 12


def _huge_spheres(n: int) -> WorkMaker:
    # An edge of the divided octahedron is √2 / n long, and at most √3 times that on the sphere. A
    # point of a triangle with corners on the unit sphere and edges up to e is at most e² / 3 below
    # it.
    depth = 2 / n**2
    balls = shapes.spheres_apart
    return lambda _: PairAsBalls(
        *balls(shapes.octasphere(n)), volume=_BALL_WITHOUT_BALL, depth=depth
    )


def _huge_label(n: int) -> str:
    return f"2 × {8 * n * n // 10**6} M"


def _sphere_targets(factor: float) -> tuple[Goal, ...]:
    return Faster(factor), Faster(4, "trueform"), Faster(4, "meshlib")


def _none_below(factor: float, *engines: str) -> tuple[Goal, ...]:
    return tuple(Faster(factor, engine) for engine in engines)


#: The targets of real pairs with few triangles.
_SMALL_PAIRS = (
    MeanFaster(4),
    MeanFaster(1.5, "meshlib"),
    *_none_below(1, MAIN_RIVAL, "meshlib"),
)

_SIZES = (36, 72, 144, 288, 576, 708)

#: The divisions of huge spheres, and the memory that each pair needs, in 10^9 bytes.
_HUGE = (500, 1000, 1582)
_HUGE_GB = (2.5, 8.0, 18.0)

CASES: dict[str, BenchCase] = {
    "spheres-82k": BenchCase(
        "sphere pair difference, 82 k triangles each",
        _sphere_targets(15),
        {"2 × 81 920": _spheres(6)},
        {"2 × 1 280": _spheres(3)},
        QUICK_ENGINES,
    ),
    "spheres-328k": BenchCase(
        "sphere pair difference, 328 k triangles each",
        _sphere_targets(20),
        {"2 × 327 680": _spheres(7)},
        {"2 × 5 120": _spheres(4)},
    ),
    "spheres-1310k": BenchCase(
        "sphere pair difference, 1.31 M triangles each",
        (*_sphere_targets(25), WorkWithin(0.18)),
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
        (Faster(8),),
        {"2 × 327 680": _built_spheres(7)},
        {"2 × 5 120": _built_spheres(4)},
        QUICK_ENGINES,
    ),
    "built-1310k": BenchCase(
        "the same, 1.31 M, operands already built",
        (Faster(12),),
        {"2 × 1 310 720": _built_spheres(8)},
        {"2 × 20 480": _built_spheres(5)},
        QUICK_ENGINES,
    ),
    "large-pairs": _real_pairs(
        "from 5 000 triangles on",
        "large",
        (
            MeanFaster(7),
            *(MeanFaster(1.5, name) for name in _OTHERS),
            *_none_below(1.3, MAIN_RIVAL, *_OTHERS),
        ),
    ),
    "medium-pairs": _real_pairs("from 1 000 to 5 000 triangles", "medium", _SMALL_PAIRS),
    "tiny-pairs": _real_pairs("below 1 000 triangles", "tiny", _SMALL_PAIRS),
    "overlap-pairs": _real_pairs(
        "one of which overlaps itself, as sets", "overlap", (MeanFaster(2), Faster(0.7))
    ),
    "drilled-steps": BenchCase(
        "cube minus 1 000 spheres, every step evaluated",
        (Faster(100), StepWithin(0.25e-3)),
        {"1 000 steps": _drilled_steps(1000)},
        {"8 steps": _drilled_steps(8)},
        CHAIN_ENGINES,
        checked_at_once=True,
    ),
    "drilled-expression": BenchCase(
        "the same as one expression",
        (Faster(6),),
        {"1 000 spheres": _drilled_at_once(1000)},
        {"20 spheres": _drilled_at_once(20)},
        ("bspcsg", "manifold3d", "trueform"),
    ),
    "plate-steps": BenchCase(
        "plate minus 400 cylinders, every step evaluated",
        (Faster(30),),
        {"400 steps": _plate(20)},
        {"4 steps": _plate(2)},
        CHAIN_ENGINES,
        checked_at_once=True,
    ),
    "boxes-steps": BenchCase(
        "union of 1 000 random boxes, every step evaluated",
        (Faster(20),),
        {"1 000 boxes": _boxes(1000)},
        {"20 boxes": _boxes(20)},
        CHAIN_ENGINES,
        checked_at_once=True,
    ),
    "milled-cylinders": BenchCase(
        "block minus 227 swept cylinders, every step evaluated",
        (Faster(5),),
        {"227 steps": _milled_by_cylinders(227)},
        {"8 steps": _milled_by_cylinders(8)},
        CHAIN_ENGINES,
        checked_at_once=True,
    ),
    "milled-capsules": BenchCase(
        "block minus 1 000 swept capsules, every step evaluated",
        (Faster(10),),
        {"1 000 steps": _milled_by_balls(1000)},
        {"8 steps": _milled_by_balls(8)},
        CHAIN_ENGINES,
        checked_at_once=True,
    ),
    "menger-3": BenchCase(
        "Menger sponge of depth 3, one expression",
        (Faster(8),),
        {"depth 3": _menger(3)},
        {"depth 1": _menger(1)},
        CHAIN_ENGINES,
    ),
    "menger-4": BenchCase(
        "Menger sponge of depth 4, one expression",
        (Faster(10),),
        {"depth 4": _menger(4)},
        {"depth 2": _menger(2)},
        CHAIN_ENGINES,
    ),
    "cubes": BenchCase("two cubes", (Within(40e-6),), {"2 × 12": _cubes}, {"2 × 12": _cubes}),
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
        (Within(200.0), MemoryWithin(6144), SteadySteps(2)),
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
    "huge": BenchCase(
        "sphere pair difference, 2, 8 and 20 M triangles each",
        (GrowthTarget(1.02), ScratchWithin(70)),
        {_huge_label(n): _huge_spheres(n) for n in _HUGE},
        {f"2 × {8 * n * n}": _huge_spheres(n) for n in (16, 32)},
        (OURS,),
        alone=True,
        limit=900.0,
        needs_gb={_huge_label(n): gb for n, gb in zip(_HUGE, _HUGE_GB, strict=True)},
    ),
    "files-checked": BenchCase(
        "command line, two STL files of 1.31 M triangles, checked",
        (WorkWithin(4), MemoryWithin(800)),
        {"2 × 1 310 720": _files(8)},
        {"2 × 5 120": _files(4)},
        (OURS,),
        alone=True,
    ),
    "files-unchecked": BenchCase(
        "the same without the check",
        (WorkWithin(1.5), MemoryWithin(800)),
        {"2 × 1 310 720": _files(8, "--check=off")},
        {"2 × 5 120": _files(4, "--check=off")},
        (OURS,),
        alone=True,
    ),
    **DENSE_CASES,
}

#: The default cases, which take one or two minutes.
SHORT = (
    "spheres-82k",
    "tiny-pairs",
    "drilled-expression",
    "milled-cylinders",
    "menger-3",
    "cubes",
)
