"""The measures of a solid, separate from the class `Solid`."""

import math
from abc import ABC, abstractmethod
from fractions import Fraction
from typing import Any, Self

import numpy as np

from .._core import Tree
from .._types import FloatArray, SideArray
from ..errors import Finding, core_errors, deprecated
from ..mesh import interop
from ..mesh.boxes import boxes_of
from ..mesh.mesh import Mesh, surfaces_of
from ..parameters import at_least
from .sides import sides_of
from .triangles import Triangles, triangles_of

#: The moduli of `volume_residues`.
_PRIMES = (2**61 - 1, 2**61 - 31)

#: Fractions of more digits take more than about a second to bring to lowest terms.
LONGEST_VOLUME = 200_000

#: The largest bound on decimal digits that the core gets, which counts bits in 64-bit integers. No
#: machine holds a number with more digits.
_MAX_DIGITS = 10**15

#: Volumes below this part of what they are summed from may be rounding.
_ROUNDING = 1e-9

#: The largest number of places that a finding names.
_MAX_PLACES_NAMED = 8


class Measured(ABC):
    """A solid with measures."""

    __slots__ = ()

    @property
    @abstractmethod
    def tree(self) -> Tree:
        """The partition tree of the set."""

    @abstractmethod
    def to_mesh(self) -> Mesh:
        """Return the boundary as a closed mesh."""

    @abstractmethod
    def _alias(self) -> Self:
        """Return a copy as another object, with all cached results."""

    @abstractmethod
    def normalized(self) -> "Measured":
        """Return the same set with the reduced boundary as its mesh."""

    @abstractmethod
    def _divided_mesh(self) -> Mesh:
        """Return the reduced boundary, with faces divided where edges lie inside them."""

    @abstractmethod
    def _outside(self) -> "Measured":
        """Return the complement with its reduced boundary."""

    @property
    def vertices(self) -> FloatArray:
        """Vertices of the mesh, (n, 3) float64, in model units, read-only."""
        return self.to_mesh().vertices

    @property
    def faces(self) -> Triangles:
        """Triangles of the mesh, (m, 3) int64, indices of `vertices`, read-only.

        Call it, as ``solid.faces()``, to select faces: flat ones, and round ones such as the wall
        of a bore (see `FaceSelection`). Neighbouring facets belong to one round face if they bend
        by at most 30 degrees, or another ``angle``, and neither is more than twice as wide as the
        other; ``all=True`` returns the facets one by one.

        Examples
        --------
        >>> import bspcsg as csg
        >>> part = csg.cylinder(10, d=8)
        >>> part.faces.shape, len(part.faces()), len(part.faces(all=True))
        ((124, 3), 3, 34)
        >>> part.faces().sort_by("z")[-1].normal.tolist()
        [[0.0, 0.0, 1.0]]
        """
        return triangles_of(self, self.to_mesh().faces)

    @property
    def sources(self) -> tuple[int, ...]:
        """Identities of the input meshes, in the order of their numbers in `Mesh.source`."""
        return tuple(self.tree.sources)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The findings about the inputs and the mesh, which is made and checked for this.

        "self_overlap" means that the mesh is not the boundary of the solid, and names triangles
        that cross or overlap others; `normalized` returns the solid with its boundary as mesh.
        "crossing" means that an input crosses itself by less than a step of the lattice. "flat"
        names triangles with area on the lattice, but none in the doubles of the mesh. The mesh's
        `certificate` has no other faults.
        """
        found = self.tree.findings
        if self.is_bounded:
            self.to_mesh()
            found = [*found, *self.tree.mesh_findings()]
        told = tuple(Finding.from_core(finding) for finding in found)
        return (*told, *_faults_of(self, told)) if self.is_bounded else told

    @property
    def pitch(self) -> int:
        """Exponent of the lattice step: it is ``10**pitch`` model units."""
        return self.tree.pitch

    @property
    def is_empty(self) -> bool:
        """True if the solid has no volume."""
        return self.normalized().tree.is_empty

    @property
    def is_bounded(self) -> bool:
        """True if the solid fits into some box."""
        return self.tree.is_bounded

    @property
    def volume_exact(self) -> Fraction:
        """Volume of the set in cubic model units, exactly.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity; so for all measures.
        LimitError
            If it might be a fraction of more than 200 000 digits; see `exact_volume`.
        """
        return self.exact_volume()

    def exact_volume(self, most_digits: int = LONGEST_VOLUME) -> Fraction:
        """Return the volume of the set in cubic model units, exactly.

        The denominator grows by that of about one constructed corner for each corner. Reducing the
        fraction takes time quadratic in the number of digits, and cannot be interrupted.

        Parameters
        ----------
        most_digits : int
            The largest allowed number of decimal digits of numerator and denominator.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity.
        LimitError
            If they might have more digits; the message has the number.
        """
        digits = min(at_least(1, most_digits, "most_digits"), _MAX_DIGITS)
        bits = math.ceil(digits * math.log2(10))
        with core_errors():
            return Fraction(*self.normalized().tree.volume6_exact(bits))

    @property
    def volume_near(self) -> Fraction:
        """Volume to within 2**-100 cubic lattice steps; deprecated, see `exact_volume`."""
        deprecated("Solid.volume_near", "volume or exact_volume")
        return volume_near(self)

    @property
    def volume_residues(self) -> tuple[int, int] | None:
        """Six times the volume modulo two primes; deprecated, compare solids by ``==``."""
        deprecated("Solid.volume_residues", "== or exact_volume")
        return volume_residues(self)

    @property
    def volume(self) -> float:
        """Volume of the set in cubic model units, rounded once."""
        volume = self.normalized().tree.volume_rounded()
        return float(volume_near(self)) if volume is None else volume

    @property
    def area(self) -> float:
        """Surface area in square model units, the same as that of the complement.

        Raises
        ------
        UnboundedError
            If the solid and its complement both reach to infinity.
        """
        reduced = self.normalized()
        return (reduced if reduced.is_bounded else self._outside()).to_mesh().area

    @property
    def centroid(self) -> FloatArray:
        """Centre of volume, (3,) float64, in model units; NaN for the empty set."""
        return self.normalized().to_mesh().centroid

    @property
    def inertia(self) -> FloatArray:
        """Moments of inertia about the centroid at density 1, (3, 3) float64; NaN if empty.

        In model units to the fifth power.
        """
        return self.normalized().to_mesh().inertia

    @property
    def bounds(self) -> FloatArray | None:
        """Lowest and highest coordinates, (2, 3) float64, or None for the empty set."""
        return self.normalized().to_mesh().bounds

    @property
    def euler_number(self) -> int:
        """Vertices - edges + faces of the mesh."""
        return self.normalized().to_mesh().euler_number

    @property
    def surface_count(self) -> int:
        """Number of connected surfaces; the wall of a closed cavity is one of its own.

        This number was formerly `components`, which now has the parts, each with its cavities.
        Surfaces that touch only in a point or an edge count separately, even if the edge lies
        inside a face that belongs to both and that the mesh does not divide there.
        """
        return self._divided_mesh().surface_count

    @property
    def genus(self) -> int:
        """Number of handles, summed over all connected surfaces."""
        return self._divided_mesh().genus

    def classify(self, points: Any) -> SideArray:
        """Classify points as inside, outside or on the boundary, exactly.

        Parameters
        ----------
        points : (k, 3) array_like of float
            In model units; snapped to the lattice. For a bounded solid, points may lie anywhere.

        Returns
        -------
        (k,) int8
            +1 inside, 0 on the boundary, -1 outside.
        """
        return sides_of(interop.points_array(points), self.normalized().tree)


def volume_near(solid: Measured) -> Fraction:
    """Return the volume in cubic model units to within 2**-100 cubic lattice steps.

    Far finer than a double and, unlike the exact volume, cheap for any number of cut faces.
    """
    with core_errors():
        return Fraction(*solid.normalized().tree.volume_near())


def volume_residues(solid: Measured) -> tuple[int, int] | None:
    """Return six times the exact volume in cubic lattice steps, modulo 2**61 - 1 and 2**61 - 31.

    If these agree, sums of exact volumes of solids of one pitch agree, up to a probability of
    2**-122; comparing takes one pass. None in the rare case that a prime divides the denominator.
    """
    with core_errors():
        return solid.normalized().tree.volume_residues()


def residues_of_volume(solid: Measured) -> tuple[int | None, ...]:
    """Return six times the exact volume in cubic units, modulo two primes.

    Unlike `volume_residues` they depend only on the set, not on its lattice or triangles; None if
    the prime divides the reduced denominator.
    """
    steps = volume_residues(solid)
    if steps is not None:
        pitch = 3 * solid.normalized().tree.pitch
        pairs = zip(steps, _PRIMES, strict=True)
        return tuple(count * pow(10, pitch, prime) % prime for count, prime in pairs)
    volume = 6 * solid.volume_exact
    return tuple(
        volume.numerator * pow(volume.denominator, -1, prime) % prime
        if volume.denominator % prime
        else None
        for prime in _PRIMES
    )


def overlaps_of(solid: Measured) -> tuple[Finding, ...]:
    """Return the findings about a solid whose mesh is not its boundary.

    For this, inputs that are not trusted are united with themselves, once.
    """
    reduced = solid.normalized()
    if solid.tree.simple is not False:
        return ()
    mesh = solid.to_mesh()
    turned = _turned_shells(mesh, reduced)
    crossing = _crossing_faces(mesh)
    if turned and not crossing:
        return turned
    message = (
        "the mesh has faces that cross, overlap, touch or lie inside the solid: it has"
        f" {len(mesh.faces)} triangles, but the boundary of the solid has"
        f" {len(reduced.to_mesh().faces)}"
    )
    if crossing:
        message += (
            f"; {len(crossing)} cross or overlap others, the first near {_near(mesh, crossing)}"
        )
    where = tuple(crossing[:_MAX_PLACES_NAMED])
    overlap = Finding("self_overlap", "warning", message, where, max(1, len(crossing)))
    return (*turned, overlap)


def _turned_shells(mesh: Mesh, reduced: Measured) -> tuple[Finding, ...]:
    """Return the findings about inside-out shells, which the solid therefore excludes.

    The walls of cavities are inside out, too, but lie on the boundary of the solid.
    """
    owner = surfaces_of(mesh.faces, len(mesh.vertices))
    corners = mesh.vertices[mesh.faces]
    middle = boxes_of(corners, owner).mean(axis=1)[owner]
    a, b, c = (corners[:, k] - middle for k in range(3))
    parts = np.einsum("ij,ij->i", np.cross(a, b), c)
    is_turned = np.bincount(owner, parts) < -_ROUNDING * np.bincount(owner, np.abs(parts))
    if not is_turned.any():
        return ()
    faces = np.flatnonzero(is_turned[owner])
    is_kept = sides_of(corners[faces].reshape(-1, 3), reduced.tree).reshape(-1, 3) >= 0
    is_turned[owner[faces[is_kept.any(axis=1)]]] = False
    shells, first = np.unique(owner, return_index=True)
    found = first[is_turned[shells]].tolist()
    if not found:
        return ()
    many = "1 body is" if len(found) == 1 else f"{len(found)} bodies are"
    message = f"{many} inside out, so left out of the solid; the first is near {_near(mesh, found)}"
    return (
        Finding("inside_out", "warning", message, tuple(found[:_MAX_PLACES_NAMED]), len(found)),
    )


def _faults_of(solid: Measured, told: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return the other findings about faults in the certificate of a solid's mesh."""
    codes = {one.code for one in told}
    more: tuple[Finding, ...] = ()
    # An inside-out mesh may give the empty set; comparing it with the boundary is then useless.
    if not {"inside_out", "self_overlap"} & codes:
        more = overlaps_of(solid)
    if not more and not {"crossing", "self_overlap"} & codes:
        more = _crossings_of(solid, is_on_lattice="inside_out" in codes)
    flat = solid.to_mesh().certificate.flat
    if flat and not {"collapsed", "turned"} & codes:
        more = (*more, _flat(solid.to_mesh(), list(flat)))
    return more


def _crossings_of(solid: Measured, *, is_on_lattice: bool) -> tuple[Finding, ...]:
    """Return the finding about a mesh that crosses itself, on the lattice or only off it."""
    mesh = solid.to_mesh()
    crossing = _crossing_faces(mesh)
    if not crossing:
        return ()
    code, much = "crossing", " of the inputs cross or overlap others by less than a lattice step"
    if is_on_lattice:
        code, much = "self_overlap", " cross or overlap others"
    message = f"these triangles{much}; the first is near {_near(mesh, crossing)}"
    return (Finding(code, "warning", message, tuple(crossing[:_MAX_PLACES_NAMED]), len(crossing)),)


def _flat(mesh: Mesh, faces: list[int]) -> Finding:
    """Return the finding about triangles without area in the given coordinates."""
    message = (
        "these triangles of the inputs have no area in doubles, although they have on the"
        f" lattice; the first is near {_near(mesh, faces)}"
    )
    return Finding("flat", "note", message, tuple(faces[:_MAX_PLACES_NAMED]), len(faces))


def _crossing_faces(mesh: Mesh) -> list[int]:
    return sorted({face for pair in mesh.certificate.crossings for face in pair})


def _near(mesh: Mesh, faces: list[int]) -> str:
    corner = mesh.vertices[mesh.faces[faces[0], 0]]
    return f"({', '.join(f'{x:.6g}' for x in corner)})"
