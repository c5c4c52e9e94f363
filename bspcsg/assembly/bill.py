"""`Bill`: a table of the count, volume and mass of the parts of an assembly."""

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from ..geometry import transform

if TYPE_CHECKING:
    from .tree import Part


@dataclass(frozen=True)
class BillRow:
    """The parts of an assembly with the same name, shape and density.

    Parameters
    ----------
    name : str
    count : int
    volume : float
        The volume of each part, in cubic model units.
    density : float or None
        The mass of a cubic model unit; None if it is unknown.
    mass : float or None
        The mass of all these parts together; None without a density.
    """

    name: str
    count: int
    volume: float
    density: float | None
    mass: float | None


@dataclass(frozen=True)
class Bill:
    """The bill of materials of an assembly; ``str`` makes it a table.

    Parameters
    ----------
    rows : tuple of BillRow
        One row for each kind of part, in the order of the parts.
    """

    rows: tuple[BillRow, ...]

    @property
    def volume(self) -> float:
        """The sum of the volumes of all parts, in cubic model units, including overlaps twice."""
        return math.fsum(row.volume * row.count for row in self.rows)

    @property
    def mass(self) -> float:
        """The mass of all parts that have a density, in the density's unit of mass."""
        return math.fsum(row.mass for row in self.rows if row.mass is not None)

    def to_dict(self) -> dict[str, Any]:
        """Return the rows and the totals as values that JSON can represent."""
        rows = [asdict(row) for row in self.rows]
        return {"rows": rows, "volume": self.volume, "mass": self.mass}

    def __str__(self) -> str:
        """Return the bill as a text table with a total row."""
        width = max([4, *(len(row.name) for row in self.rows)])
        lines = [f"{'part':{width}}  {'count':>5}  {'volume':>12}  {'mass':>12}"]
        lines += [
            f"{row.name:{width}}  {row.count:5}  {row.volume:12.6g}  {_number(row.mass):>12}"
            for row in self.rows
        ]
        total = sum(row.count for row in self.rows)
        lines.append(f"{'all':{width}}  {total:5}  {self.volume:12.6g}  {_number(self.mass):>12}")
        return "\n".join(lines)


def bill_of(parts: Iterable["Part"]) -> Bill:
    """Return the bill of materials of the given parts."""
    found: dict[tuple[str, int, float, float | None], list[Any]] = {}
    for part in parts:
        size = _growth(part)
        key = (part.name, id(part.shape), size, part.density)
        found.setdefault(key, [part, 0])[1] += 1
    rows = []
    for (name, _, size, density), (part, count) in found.items():
        volume = part.shape.volume * size
        mass = None if density is None else volume * count * density
        rows.append(BillRow(name, count, volume, density, mass))
    return Bill(tuple(rows))


def _growth(part: "Part") -> float:
    """Return the factor by which a part's transform multiplies its volume; 1 for rotations."""
    factor = 1.0
    for one in part.factors:
        size = abs(float(transform.determinant(transform.exact_linear(one.matrix))))
        factor *= 1.0 if abs(size - 1) < _TURN else size
    return factor


#: The largest difference from 1 of the determinant of a rotation matrix with rounded entries.
_TURN = 2.0**-48


def _number(value: float | None) -> str:
    return "–" if value is None else f"{value:.6g}"
