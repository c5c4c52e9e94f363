"""The report of a check: verdicts and facts about meshes, as words and as JSON values."""

from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Any, Literal

from ..mesh.mesh import Mesh
from .discrepancy import SetDifference


class Verdict(StrEnum):
    """The result of a check."""

    AGREE = "agree"
    OTHER_TOPOLOGY = "same set, other topology"
    WITHIN_ROUNDING = "within rounding"
    DISAGREE = "DISAGREE"
    ORACLE_REFUSED = "oracle refused"
    ORACLE_FAILED = "oracle failed"
    SUBJECT_FAILED = "subject failed"


@dataclass(frozen=True)
class Facts:
    """The facts about a mesh.

    Parameters
    ----------
    vertices, triangles : int
    volume, area : float
        In model units.
    euler_number, components : int
    open_edges : int
        Directed edges without exactly one opposite, by index.
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
        """Return the facts of a mesh."""
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
        """Return one line."""
        closed = "closed" if self.open_edges == 0 else f"{self.open_edges} open edges"
        return (
            f"{self.triangles} triangles, volume {self.volume:.12g}, area {self.area:.12g}, "
            f"Euler number {self.euler_number}, {closed}"
        )


@dataclass(frozen=True)
class CheckReport:
    """The outcome of one comparison.

    Parameters
    ----------
    operation : str
    verdict : Verdict
    reason : str
        Why the verdict is not `Verdict.AGREE`, or empty.
    ours : Facts
    theirs : Facts or None
    set_volume : float
        The volume of our set before its vertices were rounded, itself rounded once.
    set_difference : SetDifference or None
    same_set_bound, rounding_bound : float
        Thicknesses up to which sets count as the same, and as within rounding; in model units.
    oracle : str
    notes : tuple of str
        The changes made to operands for manifold3d.
    probes : int
        If measures were compared instead of sets, the number of points whose sides were compared.
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
        """True if nothing speaks against the result, even if the oracle gave no answer."""
        return self.verdict not in (Verdict.DISAGREE, Verdict.SUBJECT_FAILED)

    @property
    def compared(self) -> Literal["nothing", "measures", "sets"]:
        """The parts of the engines' answers that were compared."""
        if self.set_difference is not None:
            return "sets"
        return "measures" if self.verdict is Verdict.AGREE else "nothing"

    def to_dict(self) -> dict[str, Any]:
        """Return everything as JSON values."""
        found = {**asdict(self), "verdict": str(self.verdict), "ok": self.ok}
        found["notes"] = list(self.notes)
        found["compared"] = self.compared
        if self.set_difference is not None:
            place = self.set_difference.place
            found["set_difference"]["equal"] = self.set_difference.volume == 0
            found["set_difference"]["place"] = None if place is None else list(place)
        return found

    def summary(self) -> str:
        """Return the verdict and its basis, in one line."""
        if self.reason:
            return f"{self.verdict}: {self.reason}"
        return f"{self.verdict} with {self.oracle}: {self._difference()}"

    def __str__(self) -> str:
        """Return a few lines for people."""
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
