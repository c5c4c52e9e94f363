"""Check the result of an operation against manifold3d's result, as sets of points.

manifold3d gets the reduced boundaries of our operands, in double precision (it has no notion of
winding numbers, so a mesh that overlaps itself would mean another set to it). Our rounded mesh is
compared with manifold3d's mesh: the symmetric difference, the set of points at which their winding
numbers differ, is built exactly. The verdict depends on the thickness t of its thickest piece. Let
s be the lattice step, u the distance of neighbouring doubles at the largest coordinate, and e the
tolerance that manifold3d reports:

* t ≤ 2 s + 8 u: the same set (both meshes are snapped by up to √3/2 steps per vertex; s is the
  step of the coarsest lattice that vertices were snapped to);
* t ≤ 2 s + 8 u + 4 e: within rounding, as manifold3d itself sees it;
* t larger: the engines disagree. Points of the pieces beyond the bound are decided by counting
  crossings with the operands in rational arithmetic. If all of them support us, the oracle has
  failed.

Volumes and areas in floating point, Euler numbers and closedness are compared as well, because the
symmetric difference comes from the engine under test. A quick check compares these and the sides of
some points first, and builds the set only where they differ.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np

from .._types import ProgramLine, SetOp
from ..errors import BspcsgError, InternalError, invalid_parameter
from ..mesh.mesh import Mesh
from ..mesh.pieces import MeshPieces
from ..operations.setops import OPERATIONS
from ..parameters import instance_of
from ..shapes.primitives import box as box_of
from ..solid.ledger import uncounted
from ..solid.program import name_of, program_of
from ..solid.solid import Solid, uncached_mesh
from . import oracle
from .discrepancy import SetDifference, difference_of
from .oracle import Answer
from .quick_comparison import SUM_ERROR, areas_differ, measures_differ, sides_differ, volume_of_film
from .referee import Ruling, settle
from .verdict import CheckReport, Facts, Verdict

__all__ = [
    "CheckReport",
    "Facts",
    "ReportWithMeshes",
    "Verdict",
    "check_result",
    "report_with_meshes",
    "same_set_bound",
    "validate",
]

#: What is compared. "quick": measures and sample points, and the sets only if these differ; "full":
#: always the sets.
Depth: TypeAlias = Literal["quick", "full"]

#: Differences up to STEPS lattice steps plus ULPS distances of neighbouring doubles thick are no
#: differences; TOLERANCES tolerances of manifold3d more are rounding.
STEPS, ULPS, TOLERANCES = 2, 8, 4

#: The largest number of pieces of a symmetric difference in which crossings are counted, the
#: thickest first.
_MAX_PIECES_SETTLED = 50


@uncounted
def validate(op: SetOp, *operands: Solid) -> CheckReport:
    """Carry out a set operation, and return the comparison of its result with manifold3d's.

    Parameters
    ----------
    op : {"union", "intersection", "difference", "xor"}
    *operands : Solid

    Examples
    --------
    >>> import bspcsg as csg
    >>> report = csg.validate("union", csg.cube(1), csg.cube(1).translate(1, 0, 0))
    >>> report.ok, report.ours.triangles
    (True, 12)
    """
    program_of(op, len(operands))
    for operand in operands:
        instance_of(Solid, operand, "An operand")
    return check_result(OPERATIONS[op](*operands), op, operands)


@uncounted
def check_result(
    result: Solid,
    op: SetOp | None = None,
    operands: Sequence[Solid] | None = None,
    depth: Depth = "full",
) -> CheckReport:
    """Compare a solid with manifold3d's result of the same operation on the same operands.

    Parameters
    ----------
    result : Solid
    op : {"union", "intersection", "difference", "xor"}, optional
        The operation that made the result; by default the evaluation that the solid remembers.
    operands : sequence of Solid, optional
        The solids that the result was made from; needed with `op`.
    depth : {"full", "quick"}
        "full" always builds the symmetric difference with manifold3d's mesh; "quick" only if
        volume, area, parts, Euler number or the classification of sample points differ.

    Raises
    ------
    InvalidParameterError
        If no operation is given and the solid remembers none.
    UnboundedError
        If the result reaches to infinity.
    """
    return report_with_meshes(result, op, operands, depth).report


@dataclass(frozen=True, eq=False)
class ReportWithMeshes:
    """The report of a check, with the meshes that it is based on.

    Parameters
    ----------
    report : CheckReport
    program : sequence of (str, list of int)
    came : list of Solid
        The operands, unbounded ones intersected with a box; empty if manifold3d was not asked.
    ours : Mesh
    theirs : Mesh or None
        The mesh of manifold3d's result, if it gave one.
    difference : Mesh or None
        The boundary of the symmetric difference, if it was built and is not empty.
    """

    report: CheckReport
    program: Sequence[ProgramLine]
    came: list[Solid]
    ours: Mesh
    theirs: Mesh | None = None
    difference: Mesh | None = None

    @property
    def operands(self) -> list[Mesh]:
        """The meshes of the operands in `came`."""
        return _meshes_of(self.came)


def report_with_meshes(
    result: Solid,
    op: SetOp | None = None,
    operands: Sequence[Solid] | None = None,
    depth: Depth = "full",
) -> ReportWithMeshes:
    """Compare a result as `check_result` does, and return the report with the meshes."""
    if op is not None and operands is not None:
        return _Check(op, program_of(op, len(operands)), list(operands), result, depth).run()
    last = result.last_operation
    if last is None or op is not None or operands is not None:
        raise invalid_parameter(
            "There is nothing to compare, because this solid is not the result of an"
            " operation. Pass the operation and its operands."
        )
    name, operands = name_of(last.program), list(last.operands)
    return _Check(name, last.program, operands, last.result, depth).run()


def same_set_bound(pitch: int, *meshes: Mesh, snapped_by: float = 0.0) -> float:
    """Return the thickness, in model units, up to which meshes on a lattice differ by rounding.

    Parameters
    ----------
    pitch : int
    *meshes : Mesh
    snapped_by : float
        The largest distance by which snapping moved coordinates, if to a coarser lattice than
        `pitch`.
    """
    step = max(10.0**pitch, 2 * snapped_by)
    reach = max((float(np.abs(mesh.vertices).max(initial=0)) for mesh in meshes), default=0.0)
    return STEPS * step + ULPS * float(np.spacing(reach))


@dataclass
class _Check:
    operation: str
    program: Sequence[ProgramLine]
    operands: list[Solid]
    result: Solid
    depth: Depth
    notes: list[str] = field(default_factory=list)
    came: list[Solid] = field(default_factory=list)
    set_volume: float = 0.0
    theirs: Mesh | None = None
    difference: Mesh | None = None

    def run(self) -> ReportWithMeshes:
        mesh = self.result.normalized().to_mesh()
        report = self._judged(mesh)
        return ReportWithMeshes(report, self.program, self.came, mesh, self.theirs, self.difference)

    def _judged(self, mesh: Mesh) -> CheckReport:
        ours = Facts.of(mesh)
        self.set_volume = self.result.volume
        fault = self._fault(mesh, ours)
        if fault:
            return self._report(Verdict.SUBJECT_FAILED, fault, ours)
        try:
            box = self._box(mesh)
            self.came = [self._cut(n, solid, box) for n, solid in enumerate(self.operands, 1)]
            answer = self._asked(None if box is None else box.to_mesh())
        except oracle.OracleRefusedError as error:
            return self._report(Verdict.ORACLE_REFUSED, str(error), ours)
        except oracle.OracleFailedError as error:
            return self._report(Verdict.ORACLE_FAILED, str(error), ours)
        self.theirs = answer.mesh
        return self._compared(mesh, ours, answer)

    def _asked(self, inside: Mesh | None) -> Answer:
        """Return manifold3d's answer; add the notes for all operands even if it refuses one."""
        # A generator, so that each mesh is freed once manifold3d has its own copy.
        given = (self._reduced(n, solid) for n, solid in enumerate(self.came, 1))
        try:
            return oracle.manifold_result(self.program, given, inside)
        except oracle.OracleRefusedError:
            deque(given, maxlen=0)
            raise

    def _fault(self, mesh: Mesh, ours: Facts) -> str:
        """Return the defect of our own mesh as text, or "" if it has none."""
        if ours.open_edges:
            return f"the result has {ours.open_edges} open edges"
        status = oracle.status_of(mesh) if self.depth == "full" else "NoError"
        if status != "NoError":
            return f"manifold3d does not accept the result: its status is {status}"
        gap = abs(ours.volume - self.set_volume)
        if gap > self._film(mesh) * ours.area + SUM_ERROR * abs(ours.volume):
            return (
                "the volume of the resulting mesh differs from the exact volume of the set by"
                f" {gap:.3g}"
            )
        return ""

    def _film(self, *meshes: Mesh) -> float:
        """Return the thickness up to which rounding explains that meshes differ from our set."""
        snapped_by = self.result.tree.snapped_by
        return same_set_bound(self.result.pitch, *meshes, snapped_by=snapped_by)

    def _box(self, mesh: Mesh) -> Solid | None:
        """Return a box around the mesh and all bounded operands; None if all are bounded."""
        if all(operand.is_bounded for operand in self.operands):
            return None
        bounds = [mesh.bounds, *(operand.bounds for operand in self.operands if operand.is_bounded)]
        corners = np.concatenate([box for box in bounds if box is not None] or [np.zeros((1, 3))])
        low, high = corners.min(axis=0), corners.max(axis=0)
        # Integers lie on every lattice whose step is at most 1.
        margin = np.ceil((high - low).max() / 8 + 1)
        low, high = np.floor(low - margin), np.ceil(high + margin)
        return box_of(high - low).translate(low)

    def _cut(self, number: int, solid: Solid, box: Solid | None) -> Solid:
        """Return an operand, intersected with the box if it is unbounded."""
        if box is None or solid.is_bounded:
            return solid
        self.notes.append(
            f"operand {number} is unbounded, so the results were compared inside a box around"
            " the other operands"
        )
        return solid & box

    def _reduced(self, number: int, solid: Solid) -> Mesh:
        """Return the reduced boundary of an operand; add a note if it differs from the operand."""
        reduced = uncached_mesh(solid.normalized())
        if solid.normalized() is not solid:
            faces = uncached_mesh(solid).faces
            if not np.array_equal(faces, reduced.faces):
                self.notes.append(
                    f"operand {number} overlaps itself, so manifold3d was given its reduced"
                    f" boundary of {len(reduced.faces)} triangles instead of {len(faces)}"
                )
        return reduced

    def _compared(self, mesh: Mesh, ours: Facts, answer: Answer) -> CheckReport:
        theirs = Facts.of(answer.mesh)
        if theirs.open_edges:
            reason = f"manifold3d's mesh has {theirs.open_edges} open edges"
            return self._report(Verdict.ORACLE_FAILED, reason, ours, theirs)
        same = self._film(mesh, answer.mesh)
        rounding = same + TOLERANCES * answer.tolerance
        probes = self._alike(mesh, answer.mesh, same)
        if probes is not None:
            bounds = (same, rounding)
            return self._report(Verdict.AGREE, "", ours, theirs, None, bounds, probes)
        try:
            found, pieces = difference_of(mesh, answer.mesh, self.result.pitch, same)
        except InternalError as error:
            reason = (
                f"computing the symmetric difference with manifold3d's mesh failed: {error.message}"
            )
            return self._report(Verdict.SUBJECT_FAILED, reason, ours, theirs)
        except BspcsgError as error:
            reason = f"the meshes could not be compared: {error.message}"
            return self._report(Verdict.ORACLE_FAILED, reason, ours, theirs)
        self.difference = None if pieces is None else pieces.mesh
        verdict, reason = _verdict_on(ours, theirs, found, same, rounding, mesh)
        if (
            verdict is Verdict.DISAGREE
            and pieces is not None
            and self._ruling(mesh, answer.mesh, pieces, rounding) is Ruling.OURS
        ):
            reason = f"{reason}; exact counts of crossings show that manifold3d's mesh is wrong"
            verdict = Verdict.ORACLE_FAILED
        return self._report(verdict, reason, ours, theirs, found, (same, rounding))

    def _alike(self, mesh: Mesh, other: Mesh, film: float) -> int | None:
        """Return the number of sample points that agree, or None if the sets must be compared."""
        if self.depth == "full" or measures_differ(mesh, other, film):
            return None
        compared, is_other = sides_differ(mesh, other, film)
        return None if is_other else compared

    def _ruling(self, ours: Mesh, theirs: Mesh, pieces: MeshPieces, rounding: float) -> Ruling:
        """Return which engine is right in all pieces thicker than rounding explains."""
        disputed = pieces.thicker_than(rounding)[:_MAX_PIECES_SETTLED]
        points = [pieces.points_in(piece) for piece in disputed]
        return settle(self.program, _meshes_of(self.came), ours, theirs, points)

    def _report(
        self,
        verdict: Verdict,
        reason: str,
        ours: Facts,
        theirs: Facts | None = None,
        found: SetDifference | None = None,
        bounds: tuple[float, float] = (0.0, 0.0),
        probes: int = 0,
    ) -> CheckReport:
        return CheckReport(
            self.operation,
            verdict,
            reason,
            ours,
            theirs,
            self.set_volume,
            found,
            *bounds,
            oracle.versioned_name(),
            tuple(self.notes),
            probes,
        )


def _meshes_of(solids: Sequence[Solid]) -> list[Mesh]:
    return [solid.to_mesh() for solid in solids]


def _verdict_on(
    ours: Facts,
    theirs: Facts,
    found: SetDifference,
    same: float,
    rounding: float,
    mesh: Mesh,
) -> tuple[Verdict, str]:
    """Return the verdict on our mesh and manifold3d's, and the reason as text."""
    gap = abs(ours.volume - theirs.volume)
    forgiven = volume_of_film(ours, theirs, rounding)
    if found.thickness > rounding:
        x, y, z = found.place or (0.0, 0.0, 0.0)
        return Verdict.DISAGREE, (
            f"the sets differ by volume {found.volume:.6g}, {found.thickness:.3g} thick near"
            f" ({x:.6g}, {y:.6g}, {z:.6g}); rounding explains a thickness of {rounding:.2g}"
            " only"
        )
    if gap > found.volume + forgiven:
        return Verdict.DISAGREE, (
            f"the volumes of the two results differ by {gap:.6g}, but the volume of their"
            f" symmetric difference is only {found.volume:.6g}"
        )
    if found.thickness > same:
        reason = f"the sets differ by {found.thickness:.2g}, within manifold3d's tolerance"
        return Verdict.WITHIN_ROUNDING, reason
    if ours.euler_number != theirs.euler_number:
        return Verdict.OTHER_TOPOLOGY, (
            f"the Euler number of the result is {ours.euler_number}, of manifold3d's result"
            f" {theirs.euler_number}"
        )
    if areas_differ(ours, theirs, mesh, rounding):
        return Verdict.OTHER_TOPOLOGY, (
            f"the area of the result is {ours.area:.9g}, of manifold3d's result {theirs.area:.9g}"
        )
    return Verdict.AGREE, ""
