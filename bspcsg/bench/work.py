"""The work that is timed: one thing to do for any engine, prepared outside the clock."""

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .._types import MeshArrays
from ..mesh.mesh import Mesh
from ..verify.referee import Columns
from .engines import Engine, Operation
from .facts import area, mesh_volume, size_of
from .meter import Usage
from .shapes import generator

#: Called with the number of steps that are done; for chains only.
Tell = Callable[[int], None]


@dataclass
class Outcome:
    """The result of one run.

    Parameters
    ----------
    mesh : (vertices, faces)
    parts : dict
        Seconds of the parts of the run, by name; parts that are not timed separately are left out.
    step_seconds : list of float
        Of each step of a chain.
    solid : object
        The engine's, for its counters; None if it made none.
    process : Usage, optional
        The use of resources by a process that did the work instead of this one.
    """

    mesh: MeshArrays
    parts: dict[str, float] = field(default_factory=dict)
    step_seconds: list[float] = field(default_factory=list)
    solid: Any = None
    process: Usage | None = None


@dataclass(frozen=True)
class Evidence:
    """The agreement of something other than an engine with an answer."""

    agrees: bool
    text: str


@dataclass(frozen=True)
class SurfaceExtent:
    """The area, size and triangles of the operands; area and size bound the errors of volumes."""

    area: float
    size: float
    triangles: int


class Work(ABC):
    """One thing to do."""

    @abstractmethod
    def extent(self) -> SurfaceExtent:
        """Measure the operands."""

    def prepare(self, engine: Engine) -> Any:
        """Prepare a run, outside the clock."""
        return None

    @abstractmethod
    def run(self, engine: Engine, prepared: Any, tell: Tell) -> Outcome:
        """Do the work."""

    def counted(self, engine: Engine, outcome: Outcome) -> dict[str, int]:
        """Return the engine's counters of a run, if it has any."""
        return {} if outcome.solid is None else engine.counters(outcome.solid)

    def proof(self, answer: MeshArrays) -> Evidence | None:
        """Check an answer where other engines cannot; None if they can."""
        return None


@dataclass(frozen=True)
class Pair(Work):
    """Two meshes, arrays in to arrays out."""

    first: MeshArrays
    second: MeshArrays
    operation: Operation = "difference"

    def extent(self) -> SurfaceExtent:
        """Add the operands up."""
        return extent_of([self.first, self.second])

    def run(self, engine: Engine, prepared: Any, tell: Tell) -> Outcome:
        """Do the work."""
        return Outcome(engine.boolean(self.first, self.second, self.operation))

    def counted(self, engine: Engine, outcome: Outcome) -> dict[str, int]:
        """Repeat the work on solids, since arrays have no counters."""
        if not engine.counts:
            return {}
        operands = [engine.solid(self.first), engine.solid(self.second)]
        return engine.counters(engine.combine(self.operation, operands))


@dataclass(frozen=True)
class PairAsBalls(Pair):
    """Two meshes close to balls, so large that few engines answer.

    Parameters
    ----------
    volume : float
        The volume of the answer if both were their circumscribed balls.
    depth : float
        The greatest depth of the meshes' faces below the surfaces of those balls.
    """

    volume: float = 0.0
    depth: float = 0.0

    def counted(self, engine: Engine, outcome: Outcome) -> dict[str, int]:
        """Return nothing, so that the work is not repeated."""
        return {}

    def proof(self, answer: MeshArrays) -> Evidence:
        """Compare the volume with that of the balls, whose surfaces are at most `depth` away."""
        found = mesh_volume(answer)
        apart = abs(found.value - self.volume)
        # Between a mesh and its ball is at most the ball's area times the depth.
        balls = self.extent().area / (1 - self.depth) ** 2
        allowed = balls * self.depth + found.error
        return Evidence(apart <= allowed, f"of balls {apart:.1e}, {allowed:.1e} allowed")


@dataclass(frozen=True)
class OverlappingPair(Pair):
    """Two meshes that may overlap themselves: inside is where faces wind around at least once."""

    #: The number of random points at which the answer is checked against its operands.
    samples: int = 100

    def proof(self, answer: MeshArrays) -> Evidence:
        """Count crossings of rays from random points in the first operand's box."""
        wrong, settled = wrong_points(self.first, self.second, answer, self.samples)
        return Evidence(wrong == 0 < settled, f"wrong at {wrong} of {settled} points")


@dataclass(frozen=True)
class BuiltPair(Pair):
    """A pair whose operands are built anew for each run, before the clock starts."""

    def prepare(self, engine: Engine) -> Any:
        """Build both operands."""
        return [engine.solid(self.first), engine.solid(self.second)]

    def run(self, engine: Engine, prepared: Any, tell: Tell) -> Outcome:
        """Do the work."""
        made = engine.combine(self.operation, prepared)
        return Outcome(engine.arrays(made), solid=made)


@dataclass(frozen=True)
class Expression(Work):
    """A mesh and groups of others, in one expression: each group is united, then all combined."""

    base: MeshArrays
    groups: Sequence[Sequence[MeshArrays]]
    operation: Operation = "difference"

    def extent(self) -> SurfaceExtent:
        """Add the operands up."""
        return extent_of([self.base, *(mesh for group in self.groups for mesh in group)])

    def run(self, engine: Engine, prepared: Any, tell: Tell) -> Outcome:
        """Do the work."""
        laps = Laps()
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
    """Overlapping meshes in one file; engines that do not accept these unite the parts."""

    parts: Sequence[MeshArrays]

    def extent(self) -> SurfaceExtent:
        """Add the parts up."""
        return extent_of(self.parts)

    def run(self, engine: Engine, prepared: Any, tell: Tell) -> Outcome:
        """Do the work."""
        made = engine.united(self.parts)
        return Outcome(engine.arrays(made), solid=made)


@dataclass(frozen=True)
class Chain(Work):
    """A mesh and others one after the other; the volume is read after each step."""

    base: MeshArrays
    tools: Sequence[MeshArrays]
    operation: Operation = "difference"

    def extent(self) -> SurfaceExtent:
        """Add the operands up."""
        return extent_of([self.base, *self.tools])

    def at_once(self) -> Expression:
        """Return the same set as one expression."""
        return Expression(self.base, [[tool] for tool in self.tools], self.operation)

    def run(self, engine: Engine, prepared: Any, tell: Tell) -> Outcome:
        """Do the work."""
        laps = Laps()
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
    """A chain so long that its tools are made one at a time, outside the clock."""

    base: MeshArrays
    tools: Callable[[], Iterable[MeshArrays]]

    def extent(self) -> SurfaceExtent:
        """Add the operands up."""
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
        """Return the same set as one expression."""
        return Expression(self.base, [[tool] for tool in self.tools()])

    def run(self, engine: Engine, prepared: Any, tell: Tell) -> Outcome:
        """Do the work."""
        solid = engine.solid(self.base)
        steps = []
        for done, tool in enumerate(self.tools(), start=1):
            began = time.perf_counter()
            solid = engine.combine("difference", [solid, engine.solid(tool)])
            engine.volume(solid)
            steps.append(time.perf_counter() - began)
            tell(done)
        laps = Laps()
        mesh = engine.arrays(solid)
        laps.end("mesh out")
        return Outcome(mesh, {"steps": sum(steps), **laps.seconds}, steps, solid)


class Laps:
    """A clock that is read at the end of each part."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def end(self, name: str) -> None:
        """Note the time since the last part ended."""
        now = time.perf_counter()
        self.seconds[name] = now - self._last
        self._last = now


def stepwise(
    engine: Engine, operation: Operation, solid: Any, tools: Iterable[Any], tell: Tell
) -> tuple[Any, list[float]]:
    """Combine a solid with others one after the other and read each volume."""
    steps = []
    for done, tool in enumerate(tools, start=1):
        began = time.perf_counter()
        solid = engine.combine(operation, [solid, tool])
        engine.volume(solid)
        steps.append(time.perf_counter() - began)
        tell(done)
    return solid, steps


def wrong_points(
    first: MeshArrays, second: MeshArrays, answer: MeshArrays, samples: int
) -> tuple[int, int]:
    """Return at how many random points a difference is wrong, and at how many that was decided."""
    meshes = [Columns(_mesh(arrays)) for arrays in (first, second, answer)]
    low, high = first[0].min(axis=0), first[0].max(axis=0)
    points = generator().uniform(low, high, (samples, 3))
    wrong = settled = 0
    for x, y, z in points.tolist():
        found = [mesh.is_inside((x, y, z)) for mesh in meshes]
        if None not in found:
            settled += 1
            wrong += (found[0] and not found[1]) != found[2]
    return wrong, settled


def _mesh(arrays: MeshArrays) -> Mesh:
    vertices, faces = np.asarray(arrays[0], np.float64), np.asarray(arrays[1], np.int64)
    return Mesh(vertices, faces, np.zeros((len(faces), 2), np.int64))


def extent_of(meshes: Iterable[MeshArrays]) -> SurfaceExtent:
    """Add up meshes."""
    listed = list(meshes)
    return SurfaceExtent(
        area=float(np.sum([area(mesh) for mesh in listed])),
        size=max(size_of(vertices) for vertices, _ in listed),
        triangles=sum(len(faces) for _, faces in listed),
    )
