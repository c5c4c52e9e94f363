"""The kinds of work that are timed: each prepares its operands outside the timed part."""

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .._types import MeshArrays
from ..mesh.mesh import Mesh
from ..verify.referee import RayClassifier
from .engines import Engine, Operation
from .meter import Usage
from .result_facts import area, mesh_volume, size_of
from .shapes import generator

#: A function that is called with the number of finished steps of a chain.
StepCallback = Callable[[int], None]


@dataclass
class Outcome:
    """The result of one timed run.

    Parameters
    ----------
    mesh : (vertices, faces)
    parts : dict
        The seconds of the parts of the run that are timed separately, by name.
    step_seconds : list of float
        The seconds of each step of a chain.
    solid : object
        The engine's solid, which has its counters; None if there is none.
    process : Usage, optional
        The time and memory of a process that did the work instead of this one.
    """

    mesh: MeshArrays
    parts: dict[str, float] = field(default_factory=dict)
    step_seconds: list[float] = field(default_factory=list)
    solid: Any = None
    process: Usage | None = None


@dataclass(frozen=True)
class Evidence:
    """Whether a check without another engine confirms a result, and the check as text."""

    agrees: bool
    text: str


@dataclass(frozen=True)
class SurfaceExtent:
    """The operands' total area, largest coordinate and number of triangles.

    Area and coordinate bound the errors of volumes.
    """

    area: float
    size: float
    triangles: int


class Work(ABC):
    """The base class of the kinds of work that are timed."""

    #: The names of the operands' files; empty if there are none.
    names: tuple[str, ...] = ()

    @abstractmethod
    def extent(self) -> SurfaceExtent:
        """Return the total extent of the operands."""

    def prepare(self, engine: Engine) -> Any:
        """Return the operands in the form that a run needs, made before the timed part."""
        return None

    @abstractmethod
    def run(self, engine: Engine, prepared: Any, tell: StepCallback) -> Outcome:
        """Do the work with an engine and return the outcome."""

    def counted(self, engine: Engine, outcome: Outcome) -> dict[str, int]:
        """Return the engine's counters of a run; empty if it has none."""
        return {} if outcome.solid is None else engine.counters(outcome.solid)

    def proof(self, answer: MeshArrays) -> Evidence | None:
        """Check a result without another engine; None if other engines can be compared."""
        return None


@dataclass(frozen=True)
class Pair(Work):
    """An operation on two meshes, from arrays to arrays."""

    first: MeshArrays
    second: MeshArrays
    operation: Operation = "difference"
    names: tuple[str, ...] = ()

    def extent(self) -> SurfaceExtent:
        """Return the total extent of both operands."""
        return extent_of([self.first, self.second])

    def run(self, engine: Engine, prepared: Any, tell: StepCallback) -> Outcome:
        """Combine both meshes with an engine."""
        return Outcome(engine.boolean(self.first, self.second, self.operation))

    def counted(self, engine: Engine, outcome: Outcome) -> dict[str, int]:
        """Repeat the operation on solids, and return the engine's counters; empty if none."""
        if not engine.counts:
            return {}
        operands = [engine.solid(self.first), engine.solid(self.second)]
        return engine.counters(engine.combine(self.operation, operands))


@dataclass(frozen=True)
class PairAsBalls(Pair):
    """A pair of meshes close to balls, too large for most engines.

    Parameters
    ----------
    volume : float
        The volume of the result if both meshes were their circumscribed balls.
    depth : float
        The greatest distance of the meshes' faces from the surfaces of the balls.
    """

    volume: float = 0.0
    depth: float = 0.0

    def counted(self, engine: Engine, outcome: Outcome) -> dict[str, int]:
        """Return an empty dict, since counting would repeat the operation on large meshes."""
        return {}

    def proof(self, answer: MeshArrays) -> Evidence:
        """Check that the result's volume differs from `volume` by no more than `depth` explains."""
        found = mesh_volume(answer)
        apart = abs(found.value - self.volume)
        # The volume between a mesh and its ball is at most the ball's area times the depth.
        balls = self.extent().area / (1 - self.depth) ** 2
        allowed = balls * self.depth + found.error
        return Evidence(apart <= allowed, f"of balls {apart:.1e}, {allowed:.1e} allowed")


@dataclass(frozen=True)
class OverlappingPair(Pair):
    """A pair of meshes that may overlap themselves, with the rule "positive"."""

    #: The number of random points at which the result is checked against the operands.
    samples: int = 100

    def proof(self, answer: MeshArrays) -> Evidence:
        """Check the result at random points, by exact counts of crossings."""
        wrong, settled = wrong_points(self, answer)
        return Evidence(wrong == 0 < settled, f"wrong at {wrong} of {settled} points")


@dataclass(frozen=True)
class BuiltPair(Pair):
    """A pair whose operands are made into solids before the timed part of each run."""

    def prepare(self, engine: Engine) -> Any:
        """Return both operands as solids of the engine."""
        return [engine.solid(self.first), engine.solid(self.second)]

    def run(self, engine: Engine, prepared: Any, tell: StepCallback) -> Outcome:
        """Combine both solids with an engine."""
        made = engine.combine(self.operation, prepared)
        return Outcome(engine.arrays(made), solid=made)


@dataclass(frozen=True)
class Expression(Work):
    """One expression: groups of meshes are united, then combined with a base mesh."""

    base: MeshArrays
    groups: Sequence[Sequence[MeshArrays]]
    operation: Operation = "difference"

    def extent(self) -> SurfaceExtent:
        """Return the total extent of all operands."""
        return extent_of([self.base, *(mesh for group in self.groups for mesh in group)])

    def run(self, engine: Engine, prepared: Any, tell: StepCallback) -> Outcome:
        """Evaluate the expression with an engine."""
        laps = Stopwatch()
        operands = [engine.solid(self.base)]
        for group in self.groups:
            solids = [engine.solid(mesh) for mesh in group]
            operands.append(solids[0] if len(solids) == 1 else engine.combine("union", solids))
        laps.end("build")
        made = engine.combine(self.operation, operands)
        mesh = engine.arrays(made)
        laps.end("combine and mesh out")
        return Outcome(mesh, laps.seconds, solid=made)


@dataclass(frozen=True)
class OneMesh(Work):
    """Overlapping parts in one mesh; engines that do not accept this unite the parts."""

    parts: Sequence[MeshArrays]

    def extent(self) -> SurfaceExtent:
        """Return the total extent of all parts."""
        return extent_of(self.parts)

    def run(self, engine: Engine, prepared: Any, tell: StepCallback) -> Outcome:
        """Unite the parts with an engine."""
        made = engine.united(self.parts)
        return Outcome(engine.arrays(made), solid=made)


@dataclass(frozen=True)
class Chain(Work):
    """A chain of operations on a base mesh, with the volume read after each step."""

    base: MeshArrays
    tools: Sequence[MeshArrays]
    operation: Operation = "difference"

    def extent(self) -> SurfaceExtent:
        """Return the total extent of all operands."""
        return extent_of([self.base, *self.tools])

    def at_once(self) -> Expression:
        """Return the work of computing the same set as one expression."""
        return Expression(self.base, [[tool] for tool in self.tools], self.operation)

    def run(self, engine: Engine, prepared: Any, tell: StepCallback) -> Outcome:
        """Carry out the chain with an engine."""
        laps = Stopwatch()
        solid = engine.solid(self.base)
        tools = [engine.solid(tool) for tool in self.tools]
        laps.end("build")
        solid, steps = stepwise(engine, self.operation, solid, tools, tell)
        laps.end("steps")
        mesh = engine.arrays(solid)
        laps.end("mesh out")
        return Outcome(mesh, laps.seconds, steps, solid)


@dataclass(frozen=True)
class Carving(Work):
    """A chain whose tools are too many to store; each is made outside the timed part."""

    base: MeshArrays
    tools: Callable[[], Iterable[MeshArrays]]

    def extent(self) -> SurfaceExtent:
        """Return the total extent of all operands."""
        total = extent_of([self.base])
        for tool in self.tools():
            more = extent_of([tool])
            total = SurfaceExtent(
                total.area + more.area,
                max(total.size, more.size),
                total.triangles + more.triangles,
            )
        return total

    def at_once(self) -> Expression:
        """Return the work of computing the same set as one expression."""
        return Expression(self.base, [[tool] for tool in self.tools()])

    def run(self, engine: Engine, prepared: Any, tell: StepCallback) -> Outcome:
        """Carry out the chain with an engine."""
        solid = engine.solid(self.base)
        steps = []
        for done, tool in enumerate(self.tools(), start=1):
            began = time.perf_counter()
            solid = engine.combine("difference", [solid, engine.solid(tool)])
            engine.volume(solid)
            steps.append(time.perf_counter() - began)
            tell(done)
        laps = Stopwatch()
        mesh = engine.arrays(solid)
        laps.end("mesh out")
        return Outcome(mesh, {"steps": sum(steps), **laps.seconds}, steps, solid)


#: For each operation, whether a point is in the result, from whether it is in the operands.
_HOLDS: dict[Operation, Callable[[Any, Any], bool]] = {
    "union": lambda first, second: first or second,
    "intersection": lambda first, second: first and second,
    "difference": lambda first, second: first and not second,
}


class Stopwatch:
    """A stopwatch that records the seconds of each part of a run."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def end(self, name: str) -> None:
        """Record the seconds since the end of the previous part under a name."""
        now = time.perf_counter()
        self.seconds[name] = now - self._last
        self._last = now


def stepwise(
    engine: Engine, operation: Operation, solid: Any, tools: Iterable[Any], tell: StepCallback
) -> tuple[Any, list[float]]:
    """Return the solid after combining it with all tools in turn, and the seconds of each step.

    The volume is read after each step, which forces deferred work.
    """
    steps = []
    for done, tool in enumerate(tools, start=1):
        began = time.perf_counter()
        solid = engine.combine(operation, [solid, tool])
        engine.volume(solid)
        steps.append(time.perf_counter() - began)
        tell(done)
    return solid, steps


def wrong_points(work: OverlappingPair, answer: MeshArrays) -> tuple[int, int]:
    """Return the numbers of tested points where the result `answer` is wrong, and of all.

    The points are random; one so near a surface that its side is uncertain is not tested.
    """
    meshes = [RayClassifier(_mesh(arrays)) for arrays in (work.first, work.second, answer)]
    low, high = work.first[0].min(axis=0), work.first[0].max(axis=0)
    points = generator().uniform(low, high, (work.samples, 3))
    wrong = settled = 0
    for x, y, z in points.tolist():
        found = [mesh.is_inside((x, y, z)) for mesh in meshes]
        if None not in found:
            settled += 1
            wrong += _HOLDS[work.operation](found[0], found[1]) != found[2]
    return wrong, settled


def _mesh(arrays: MeshArrays) -> Mesh:
    vertices, faces = np.asarray(arrays[0], np.float64), np.asarray(arrays[1], np.int64)
    return Mesh(vertices, faces, np.zeros((len(faces), 2), np.int64))


def extent_of(meshes: Iterable[MeshArrays]) -> SurfaceExtent:
    """Return the total area, the largest coordinate and the number of triangles of meshes."""
    listed = list(meshes)
    return SurfaceExtent(
        area=float(np.sum([area(mesh) for mesh in listed])),
        size=max(size_of(vertices) for vertices, _ in listed),
        triangles=sum(len(faces) for _, faces in listed),
    )
