"""The losses of a file format: compare the mesh that was written with the mesh read back."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from .._types import FloatArray
from ..attributes.colours import are_equal_in_bytes, is_color
from ..errors import BspcsgError
from ..formats.raw import RawMesh
from ..mesh.mesh import Mesh
from ..mesh.weld import welded
from ..solid.ledger import uncounted
from ..solid.solid import Solid

#: The largest number of names in a message.
_MAX_NAMES_SHOWN = 4


@dataclass(frozen=True)
class Losses:
    """The differences between a mesh that was written and the mesh read back.

    Parameters
    ----------
    triangles, points : tuple of int
        The numbers before and after; points are distinct positions of vertices.
    shift : float or None
        The largest change of a coordinate, in model units; None if the numbers of triangles differ.
    size : float
        The largest extent of the written mesh, in model units.
    volume : tuple of float
        The signed volume before and after.
    solid : tuple of bool
        Whether the mesh bounds a set, before and after.
    names : tuple of str
        The names of objects that were lost.
    passed_by : tuple of str
        The parts of the input file that its reader reported as left out.
    dropped : tuple of str
        The kinds of data in the input file that a triangle mesh cannot store.
    attributes : tuple of str
        The names of attributes that were lost or changed.
    """

    triangles: tuple[int, int]
    points: tuple[int, int]
    shift: float | None
    size: float
    volume: tuple[float, float]
    solid: tuple[bool, bool]
    names: tuple[str, ...] = ()
    passed_by: tuple[str, ...] = ()
    dropped: tuple[str, ...] = ()
    attributes: tuple[str, ...] = ()

    @property
    def any(self) -> bool:
        """True if at least one loss is reported."""
        return bool(self.sentences())

    def sentences(self) -> list[str]:
        """Return one short text for each loss."""
        found = [sentence.rstrip(".") for sentence in self.passed_by]
        found += [", ".join(self.dropped)] if self.dropped else []
        if self.triangles[0] != self.triangles[1]:
            found.append(f"{self.triangles[1]} triangles instead of {self.triangles[0]}")
        if self.points[0] != self.points[1]:
            found.append(f"{self.points[1]} different points instead of {self.points[0]}")
        if self.shift is None:
            found.append("triangles in another order")
        elif self.shift:
            relative = self.shift / self.size if self.size else self.shift
            found.append(
                f"coordinates changed by up to {self.shift:.2g} ({relative:.1g} of the size)"
            )
        if self.solid == (True, False):
            found.append("no longer a solid")
        if self.names:
            told = ", ".join(f"“{name}”" for name in self.names[:_MAX_NAMES_SHOWN])
            more = len(self.names) - _MAX_NAMES_SHOWN
            found.append(f"names of objects: {told}" + (f" and {more} more" if more > 0 else ""))
        if self.attributes:
            told = ", ".join(f"“{name}”" for name in self.attributes[:_MAX_NAMES_SHOWN])
            more = len(self.attributes) - _MAX_NAMES_SHOWN
            found.append(f"attributes: {told}" + (f" and {more} more" if more > 0 else ""))
        return found

    def to_dict(self) -> dict[str, Any]:
        """Return all fields and `any` as JSON values."""
        return {**asdict(self), "any": self.any}


@uncounted
def losses_between(before: RawMesh, after: RawMesh) -> Losses:
    """Return the losses between a mesh that was written and the mesh read back.

    Parameters
    ----------
    before, after : RawMesh
        The mesh that was written, with the reports of the reader of its own file, and the mesh read
        back.
    """
    kept = {name for name, _ in after.objects} | {after.name}
    names = [name for name, _ in before.objects if name and name not in kept]
    return Losses(
        (len(before.faces), len(after.faces)),
        (_points(before), _points(after)),
        _shift(before, after),
        float(np.ptp(before.vertices, axis=0).max()) if len(before.vertices) else 0.0,
        (_volume(before), _volume(after)),
        (_is_solid(before), _is_solid(after)),
        tuple(dict.fromkeys(names)),
        before.passed_by,
        before.dropped,
        _changed_attributes(before, after),
    )


def _changed_attributes(before: RawMesh, after: RawMesh) -> tuple[str, ...]:
    """Return the names of attributes that are missing after or differ at a corner."""
    if before.attributes is None:
        return ()
    found = []
    for name in before.attributes.names:
        said = after.attributes
        if said is None or said.kind_of(name) is None or len(after.faces) != len(before.faces):
            found.append(name)
            continue
        meant, told = before.attributes.at_corners(name), said.at_corners(name)
        if is_color(name, meant, 2) and is_color(name, told, 2):
            if not are_equal_in_bytes(meant, told):
                found.append(name)
            continue
        is_float = meant.dtype.kind == "f" and told.dtype.kind == "f"
        if not np.array_equal(meant, told, equal_nan=is_float):
            found.append(name)
    return tuple(found)


def _corners(raw: RawMesh) -> FloatArray:
    corners: FloatArray = raw.vertices[raw.faces]
    return corners


def _points(raw: RawMesh) -> int:
    return len(welded(_corners(raw).reshape(-1, 3))[0]) if len(raw.faces) else 0


def _shift(before: RawMesh, after: RawMesh) -> float | None:
    """Return the largest change of a coordinate; None if the numbers of triangles differ."""
    if len(before.faces) != len(after.faces):
        return None
    with np.errstate(over="ignore"):
        return float(np.abs(_corners(before) - _corners(after)).max(initial=0.0))


def _volume(raw: RawMesh) -> float:
    with np.errstate(over="ignore", invalid="ignore"):
        volume = Mesh(raw.vertices, raw.faces, raw.faces[:, :2]).volume
    return volume if np.isfinite(volume) else 0.0


def _is_solid(raw: RawMesh) -> bool:
    try:
        Solid(raw.vertices, raw.faces)
    except BspcsgError:
        return False
    return True
