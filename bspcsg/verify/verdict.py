"""The report of a check: the verdict and facts about both meshes, as text and JSON values."""

from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Any, Literal

from ..mesh.mesh import Mesh
from .discrepancy import SetDifference


class Verdict(StrEnum):
    """The outcome of comparing our result with manifold3d's."""

    AGREE = "agree"
    OTHER_TOPOLOGY = "same set, other topology"
    WITHIN_ROUNDING = "within rounding"
    DISAGREE = "DISAGREE"
    ORACLE_REFUSED = "oracle refused"
    ORACLE_FAILED = "oracle failed"
    SUBJECT_FAILED = "subject failed"


@dataclass(frozen=True)
class Facts:
    """The numbers of elements, the measures and the topology of a mesh.

    Parameters
    ----------
    vertices, triangles : int
    volume, area : float
        The volume and the area, in model units.
    euler_number, components : int
    open_edges : int
        The number of directed edges without exactly one opposite edge of the same vertex indices.
    """

    vertices: int
    triangles: int
    volume: float
    area: float
    euler_number: int
    components: int
    open_edges: int

    @classmethod
    def of(cls, mesh: Mesh) -> "Facts":
        """Return the facts about a mesh."""
        return cls(
            len(mesh.vertices),
            len(mesh.faces),
            mesh.volume,
            mesh.area,
            mesh.euler_number,
            mesh.surface_count,
            mesh.open_edges,
        )

    def __str__(self) -> str:
        """Return the facts as one line of text."""
        closed = "closed" if self.open_edges == 0 else f"{self.open_edges} open edges"
        return (
            f"{self.triangles} triangles, volume {self.volume:.12g}, area {self.area:.12g}, "
            f"Euler number {self.euler_number}, {closed}"
        )


@dataclass(frozen=True)
class CheckReport:
    """The report of comparing our result with manifold3d's.

    Parameters
    ----------
    operation : str
    verdict : Verdict
    reason : str
        The reason for any other verdict than `Verdict.AGREE`, else empty.
    ours : Facts
    theirs : Facts or None
    set_volume : float
        The volume of our set before its vertices were rounded to doubles.
    set_difference : SetDifference or None
    same_set_bound, rounding_bound : float
        The thicknesses up to which sets count as equal, and as equal within rounding, in model
        units.
    oracle : str
    notes : tuple of str
        Texts about operands that were changed for manifold3d.
    probes : int
        The number of sample points that were classified, if measures were compared instead of sets.
    """

    operation: str
    verdict: Verdict
    reason: str
    ours: Facts
    theirs: Facts | None
    set_volume: float
    set_difference: SetDifference | None
    same_set_bound: float
    rounding_bound: float
    oracle: str
    notes: tuple[str, ...] = ()
    probes: int = 0

    @property
    def ok(self) -> bool:
        """True unless the verdict is `DISAGREE` or `SUBJECT_FAILED`."""
        return self.verdict not in (Verdict.DISAGREE, Verdict.SUBJECT_FAILED)

    @property
    def compared(self) -> Literal["nothing", "measures", "sets"]:
        """What was compared: the sets, only the measures of the meshes, or nothing."""
        if self.set_difference is not None:
            return "sets"
        return "measures" if self.verdict is Verdict.AGREE else "nothing"

    def to_dict(self) -> dict[str, Any]:
        """Return all fields, `ok` and `compared` as JSON values."""
        found = {**asdict(self), "verdict": str(self.verdict), "ok": self.ok}
        found["notes"] = list(self.notes)
        found["compared"] = self.compared
        if self.set_difference is not None:
            place = self.set_difference.place
            found["set_difference"]["equal"] = self.set_difference.volume == 0
            found["set_difference"]["place"] = None if place is None else list(place)
        return found

    def summary(self) -> str:
        """Return the verdict and its reason, or what was compared, as one line of text."""
        if self.reason:
            return f"{self.verdict}: {self.reason}"
        return f"{self.verdict} with {self.oracle}: {self._difference()}"

    def __str__(self) -> str:
        """Return the summary, the facts of both meshes and the notes as lines of text."""
        lines = [f"{self.operation}: {self.summary()}", f"  ours       {self.ours}"]
        if self.theirs is not None:
            lines.append(f"  oracle     {self.theirs}  ({self.oracle})")
        if self.set_difference is not None:
            lines.append(f"  difference {self._difference()}")
        return "\n".join([*lines, *(f"  note: {note}" for note in self.notes)])

    def _difference(self) -> str:
        found = self.set_difference
        if self.compared == "measures":
            points = f" and {self.probes} points at the seam" if self.probes else ""
            return f"volume, area, parts, Euler number{points}"
        if found is None:
            return "not compared"
        if found.volume == 0:
            return "exactly the same set"
        return (
            f"the sets differ by a film {found.thickness:.2g} thick"
            f" (up to {self.same_set_bound:.2g} is rounding), of volume {found.volume:.3g}"
        )
