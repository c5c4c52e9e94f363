"""The measures of a solid: the queries, apart from the value that answers them."""

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
    """A solid as the measures see it."""

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
        """Return the same value as another object, with all that is known about it."""

    @abstractmethod
    def normalized(self) -> "Measured":
        """Return the same set with the reduced boundary as its mesh."""

    @abstractmethod
    def _divided_mesh(self) -> Mesh:
        """Return the reduced boundary, its faces divided where edges lie in the middle of them."""

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

        Called, they give the faces that they make up, to choose some of them: flat ones, and round
        ones such as the wall of a bore (see `FaceSelection`). Facets of one round surface are those
        that bend by 30 degrees at most, or another ``angle``, and of which neither is more than
        twice as wide as the other; ``all=True`` gives them one by one.

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
        """Identities of the input meshes, in the order in which `Mesh.source` counts them."""
        return tuple(self.tree.sources)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The notes about the inputs and about making the mesh, which is looked at for this.

        Where it is not the boundary of the solid, "self_overlap" says so, and names triangles of
        the mesh that cross or overlap others; `normalized` returns the solid with that boundary.
        Where an input crosses itself by less than a step of the lattice, "crossing" says so, and
        "flat" names triangles that have area on the lattice, but none in the doubles of the mesh.
        Nothing else is in the mesh's `certificate`.
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
        """True if no volume is inside."""
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

        Its denominator grows by about one constructed corner's for each corner. Lowest terms cost
        the square of the length, and cannot be interrupted.

        Parameters
        ----------
        most_digits : int
            The number of decimal digits that the numerator and the denominator may have.

        Raises
        ------
        UnboundedError
            If the solid reaches to infinity.
        LimitError
            If they might have more; the message says how many.
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
        """Surface area in square model units, which is that of the complement, too.

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

        Before, this number was `components`, which has the parts now, each with its cavities.
        Surfaces that touch in a point or an edge only are apart, even where the edge lies in the
        middle of a face that goes on from one to the other, which the mesh does not divide there.
        """
        return self._divided_mesh().surface_count

    @property
    def genus(self) -> int:
        """Number of handles, summed over all connected surfaces."""
        return self._divided_mesh().genus

    def classify(self, points: Any) -> SideArray:
        """Say of each point whether it is inside, exactly.

        Parameters
        ----------
        points : (k, 3) array_like of float
            In model units; snapped to the lattice. What is bounded may be asked about any point.

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

    Sums of exact volumes of solids of one pitch agree if these do, but for a chance of 2**-122;
    comparing them costs one pass. None in the rare case of a denominator that is a multiple of a
    prime.
    """
    with core_errors():
        return solid.normalized().tree.volume_residues()


def residues_of_volume(solid: Measured) -> tuple[int | None, ...]:
    """Return six times the exact volume in cubic units, modulo two primes.

    Unlike `volume_residues` they follow from the set alone, not from its lattice or its
    triangles; None where the reduced denominator is a multiple of the prime.
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
    """Return what is to be said of a solid whose mesh is not its boundary.

    Inputs that nobody has vouched for are united with themselves for this, once.
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
        f"faces cross, overlap, touch or lie inside: {len(mesh.faces)} triangles, where the"
        f" boundary of the solid has {len(reduced.to_mesh().faces)}"
    )
    if crossing:
        message += (
            f"; {len(crossing)} cross or overlap others, the first near {_near(mesh, crossing)}"
        )
    where = tuple(crossing[:_MAX_PLACES_NAMED])
    overlap = Finding("self_overlap", "warning", message, where, max(1, len(crossing)))
    return (*turned, overlap)


def _turned_shells(mesh: Mesh, reduced: Measured) -> tuple[Finding, ...]:
    """Return what is to be said of bodies that face inwards and so are left out of the solid.

    The walls of cavities face inwards, too, but lie on the boundary of the solid.
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
    message = f"{many} inside out, and left out of the solid; the first near {_near(mesh, found)}"
    return (
        Finding("inside_out", "warning", message, tuple(found[:_MAX_PLACES_NAMED]), len(found)),
    )


def _faults_of(solid: Measured, told: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return what else is to be said of the faults in the certificate of a solid's mesh."""
    codes = {one.code for one in told}
    more: tuple[Finding, ...] = ()
    # Inside out, the set may be empty, and comparing the mesh with its boundary says nothing.
    if not {"inside_out", "self_overlap"} & codes:
        more = overlaps_of(solid)
    if not more and not {"crossing", "self_overlap"} & codes:
        more = _crossings_of(solid, is_on_lattice="inside_out" in codes)
    flat = solid.to_mesh().certificate.flat
    if flat and not {"collapsed", "turned"} & codes:
        more = (*more, _flat(solid.to_mesh(), list(flat)))
    return more


def _crossings_of(solid: Measured, *, is_on_lattice: bool) -> tuple[Finding, ...]:
    """Return what is to be said of a mesh that crosses itself, on the lattice or only beside it."""
    mesh = solid.to_mesh()
    crossing = _crossing_faces(mesh)
    if not crossing:
        return ()
    code, much = "crossing", " of inputs cross or overlap others by less than a step of the lattice"
    if is_on_lattice:
        code, much = "self_overlap", " cross or overlap others"
    message = f"these triangles{much}; the first near {_near(mesh, crossing)}"
    return (Finding(code, "warning", message, tuple(crossing[:_MAX_PLACES_NAMED]), len(crossing)),)


def _flat(mesh: Mesh, faces: list[int]) -> Finding:
    """Return what is to be said of triangles whose given coordinates leave them no area."""
    message = (
        "these triangles of inputs have no area in doubles, though their corners have on the"
        f" lattice; the first near {_near(mesh, faces)}"
    )
    return Finding("flat", "note", message, tuple(faces[:_MAX_PLACES_NAMED]), len(faces))


def _crossing_faces(mesh: Mesh) -> list[int]:
    return sorted({face for pair in mesh.certificate.crossings for face in pair})


def _near(mesh: Mesh, faces: list[int]) -> str:
    corner = mesh.vertices[mesh.faces[faces[0], 0]]
    return f"({', '.join(f'{x:.6g}' for x in corner)})"
