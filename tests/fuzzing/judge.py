"""Judge the results of a random scene: points, volumes, meshes, copies, manifold3d's volume."""

import pickle
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

import bspcsg as b
from bspcsg.verify import oracle
from bspcsg.verify.check import Verdict, check_result

from .places import (
    Balls,
    Point,
    Surface,
    Triangle,
    UndecidedError,
    cross,
    dot,
    less,
    location,
    normal,
    windings,
)
from .scenes import CALLS, PITCH, UNIT, Body, Scene, asked_for, text_of

#: Points nearer to a face than this many units are not compared with the rounded mesh. Rounding
#: moves its vertices by far less, at coordinates below 1000.
CLEAR = 1e-6

#: The steps per unit to which meshes are rounded for checks, far finer than those of the lattice.
FINE = 2**40

#: The largest thickness of a set that may vanish when it is rounded to doubles: at coordinates
#: below 1024 two sides move by less than √3 · 2⁻⁴⁴ each, and mending moves them by no more.
THINNEST = Fraction(1, 2**41)

#: The volume, of each unit of area, that manifold3d may gain or lose where it merges what is near.
MERGED = 1e-4


class Kernel:
    """The calls of the package that the judge makes; tests replace them by wrong ones."""

    def solid(self, body: Body) -> "b.Solid":
        """Return the solid of an operand before its motions."""
        if body.plane is not None:
            return b.half_space(*body.half_space())
        vertices, faces = body.arrays()
        rule: Any = body.rule
        return b.Solid(np.array(vertices), np.array(faces), pitch=PITCH, winding=rule)

    def evaluate(self, text: str, names: dict[str, "b.Solid"]) -> "b.Solid":
        """Return the value of an expression."""
        found: b.Solid = eval(text, {"__builtins__": {}, **CALLS}, names)
        return found

    def classify(self, solid: "b.Solid", points: Sequence[Point]) -> list[int]:
        """Return for each point 1 if it is inside, 0 on the boundary, -1 outside."""
        found: list[int] = solid.classify([[k / UNIT for k in p] for p in points]).tolist()
        return found

    def volume(self, solid: "b.Solid") -> Fraction:
        """Return the exact volume of a solid."""
        return solid.volume_exact

    def mesh(self, solid: "b.Solid") -> "b.Mesh":
        """Return the mesh of the reduced boundary of a solid."""
        return solid.normalized().to_mesh()

    def arrays(self, solid: "b.Solid") -> tuple[bytes, ...]:
        """Return the bytes of a solid's vertices, faces and their origins."""
        mesh = solid.to_mesh()
        return mesh.vertices.tobytes(), mesh.faces.tobytes(), mesh.source.tobytes()

    def copy(self, solid: "b.Solid") -> "b.Solid":
        """Return the solid after pickling and unpickling."""
        found: b.Solid = pickle.loads(pickle.dumps(solid))
        return found


def judge(scene: Scene, kernel: Kernel | None = None) -> list[str]:
    """Return what is wrong with the results of a scene, one sentence each, starting with its kind.

    An error of the package is wrong, since all scenes have a result.
    """
    try:
        return list(_Trial(scene, kernel or Kernel()).complaints())
    except b.BspcsgError as error:
        return [f"error {error.code}: {type(error).__name__}: {error.message}"]


def evaluated(scene: Scene, kernel: Kernel) -> tuple[list["b.Solid"], "b.Solid"]:
    """Return the moved operands of a scene, and the value of its expression."""
    names = {chr(ord("a") + k): kernel.solid(body) for k, body in enumerate(scene.bodies)}
    moved = (text_of(k, scene.bodies) for k in range(len(scene.bodies)))
    operands = [kernel.evaluate(text, names) for text in moved]
    return operands, kernel.evaluate(scene.text(), names)


class _Trial:
    def __init__(self, scene: Scene, kernel: Kernel) -> None:
        self.scene, self.kernel = scene, kernel
        self.sets = scene.known()
        self.operands, self.result = evaluated(scene, kernel)

    def complaints(self) -> Any:
        """Yield what is wrong with the results of the scene."""
        yield from self._points(self.result, "points")
        yield from self._known_volumes()
        yield from self._sums()
        yield from self._copies()
        if self.scene.is_bounded:
            mesh = self.kernel.mesh(self.result)
            yield from self._mesh(mesh)
            yield from self._inside_mesh(mesh)
            yield from self._steps()
            yield from self._rival()

    def _points(self, result: "b.Solid", kind: str) -> Any:
        for point, found in zip(
            self.scene.points, self.kernel.classify(result, self.scene.points), strict=True
        ):
            try:
                expected = location(self.sets, self.scene.value, point)
            except UndecidedError:
                continue
            if found != expected:
                yield f"{kind}: {point} is {found}, not {expected}"

    def _known_volumes(self) -> Any:
        for k, (body, solid) in enumerate(zip(self.scene.bodies, self.operands, strict=True)):
            if body.volume is not None and self.kernel.volume(solid) != body.volume:
                yield f"volume: operand {k} has {self.kernel.volume(solid)}, not {body.volume}"

    def _sums(self) -> Any:
        """Check inclusion-exclusion for volumes of operands and the result."""
        bounded = [
            solid
            for body, solid in zip(self.scene.bodies, self.operands, strict=True)
            if body.plane is None
        ]
        bounded += [self.result] if self.scene.is_bounded else []
        if not bounded:
            return
        p, q = bounded[0], bounded[-1]
        volume = self.kernel.volume
        joint, common, rest, either = map(volume, (p | q, p & q, p - q, p ^ q))
        if joint + common != volume(p) + volume(q):
            yield "sums: union and intersection do not add up"
        if rest + common != volume(p):
            yield "sums: difference and intersection do not add up"
        if joint - common != either:
            yield "sums: the symmetric difference is not union minus intersection"
        if not (~p & ~q).equals(~(p | q)):
            yield "sums: De Morgan does not hold"

    def _steps(self) -> Any:
        """Check that evaluating all operations together and one by one gives the same bytes.

        Only for operands that do not overlap themselves: others are united only where an operation
        met them.
        """
        if not all(body.volume is not None for body in self.scene.bodies):
            return
        names = {chr(ord("a") + k): solid for k, solid in enumerate(self.operands)}
        still = [replace(body, motions=()) for body in self.scene.bodies]
        arrays = []
        for steps in (False, True):
            text = text_of(asked_for(self.scene.expression, steps=steps), still)
            arrays.append(self.kernel.arrays(self.kernel.evaluate(text, names)))
        if arrays[0] != arrays[1]:
            yield "steps: what was asked for on the way changes the bytes of the mesh"

    def _copies(self) -> Any:
        copy = self.kernel.copy(self.result)
        if self.kernel.classify(copy, self.scene.points) != self.kernel.classify(
            self.result, self.scene.points
        ):
            yield "copy: points lie elsewhere in a copy"
        if self.scene.is_bounded and self.kernel.volume(copy) != self.kernel.volume(self.result):
            yield "copy: a copy has another volume"

    def _mesh(self, mesh: "b.Mesh") -> Any:
        faces = mesh.faces.tolist()
        after = _corners(faces)
        if after is None:
            yield "mesh: an edge is used twice in one direction"
            return
        if any((w, v) not in after for v, w in after):
            yield "mesh: an edge has no opposite"
            return
        if _count_fans(after) != len(mesh.vertices):
            yield "mesh: a vertex is not used, or has several fans"
        exact = self.kernel.volume(self.result)
        if not faces:
            yield from self._nothing_left(exact)
            return
        six = sum(dot(p, cross(q, r)) for p, q, r in _triangles(mesh))
        volume = Fraction(six, 6 * FINE**3)
        if abs(volume - exact) > Fraction(mesh.area) / UNIT:
            yield f"mesh: its volume is {float(volume)}, the set's {float(exact)}"

    def _nothing_left(self, exact: Fraction) -> Any:
        """Yield a complaint if an empty mesh has a volume above rounding or lacks a finding."""
        delivered = self.result.normalized()
        delivered.to_mesh()
        is_told = any(finding.code == "mended" for finding in delivered.findings)
        areas = [Fraction(each.to_mesh().area) for each in self.operands if each.is_bounded]
        if exact and not (is_told and exact < THINNEST * sum(areas)):
            yield f"mesh: it has no triangles, the set has the volume {float(exact)}"

    def _inside_mesh(self, mesh: "b.Mesh") -> Any:
        """Compare points far from all faces with the winding numbers of the mesh."""
        proper = Balls([each for each in _triangles(mesh) if normal(each) != (0, 0, 0)])
        for point in self.scene.points:
            if not self._is_clear(point):
                continue
            x, y, z = (round(Fraction(k, UNIT) * FINE) for k in point)
            try:
                [found] = windings(proper, (x, y, z), [()])
                expected = location(self.sets, self.scene.value, point) > 0
            except UndecidedError:
                continue
            if found != expected:
                yield f"inside: the mesh winds {found} times around {point}"

    def _is_clear(self, point: Point) -> bool:
        """Return true if the point is not close to the plane of any nearby face."""
        for known in self.sets:
            reach = CLEAR * UNIT
            faces = known.balls.around(point, reach) if isinstance(known, Surface) else ()
            for face in faces if isinstance(known, Surface) else (known.corners,):
                n = normal(face)
                away = abs(dot(n, less(point, face[0]))) / dot(n, n) ** 0.5 / UNIT
                if away < CLEAR:
                    return False
        return True

    def _rival(self) -> Any:
        """Compare the volume with manifold3d's, if no operand overlaps itself."""
        if not all(body.volume is not None for body in self.scene.bodies):
            return
        record = self.result.last_operation
        if record is None or not all(operand.is_bounded for operand in record.operands):
            return
        meshes = [operand.normalized().to_mesh() for operand in record.operands]
        try:
            theirs = oracle.manifold_result(record.program, meshes).mesh
        except (oracle.OracleFailedError, oracle.OracleRefusedError):
            return
        ours = float(self.kernel.volume(self.result))
        area = sum(mesh.area for mesh in meshes)
        if abs(theirs.volume - ours) > MERGED * area and not self._is_rival_wrong(ours):
            yield f"rival: manifold3d has the volume {theirs.volume}, not {ours}"

    def _is_rival_wrong(self, volume: float) -> bool:
        """Return true if exact counts of crossings show that manifold3d's result is wrong.

        Our set, which the counts confirm, must have this volume.
        """
        report = check_result(self.result)
        is_settled = report.verdict is Verdict.ORACLE_FAILED and report.compared == "sets"
        return is_settled and report.set_volume == volume


def _corners(faces: Sequence[Sequence[int]]) -> dict[tuple[int, int], int] | None:
    """Return for each (vertex, edge start) the next edge's end; None if an edge repeats."""
    after: dict[tuple[int, int], int] = {}
    for p, q, r in faces:
        for v, start, end in ((p, q, r), (q, r, p), (r, p, q)):
            if (v, start) in after:
                return None
            after[v, start] = end
    return after


def _count_fans(after: dict[tuple[int, int], int]) -> int:
    fans: Counter[int] = Counter()
    open_edges = set(after)
    while open_edges:
        v, start = spoke = open_edges.pop()
        fans[v] += 1
        while (spoke := (v, after[spoke])) != (v, start):
            open_edges.discard(spoke)
    return sum(fans.values())


def _triangles(mesh: "b.Mesh") -> list[Triangle]:
    """Return the triangles of a mesh in steps of 1 / FINE units."""
    corners = [(round(x * FINE), round(y * FINE), round(z * FINE)) for x, y, z in mesh.vertices]
    return [(corners[p], corners[q], corners[r]) for p, q, r in mesh.faces.tolist()]


Judge = Callable[[Scene], list[str]]
