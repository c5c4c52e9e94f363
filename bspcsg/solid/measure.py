"""The volume of a solid, and the findings about its mesh."""

import math
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from ..errors import Finding, core_errors
from ..mesh.boxes import boxes_of
from ..mesh.mesh import Mesh, surfaces_of
from ..parameters import at_least
from .point_classification import sides_of

if TYPE_CHECKING:
    from .solid import Solid

#: The moduli of `volume_residues`.
_PRIMES = (2**61 - 1, 2**61 - 31)

#: The default limit of digits of exact volumes: reducing a longer fraction takes over a second.
LONGEST_VOLUME = 200_000

#: The largest limit of decimal digits that is passed to the core, which counts bits in 64-bit
#: integers. No memory has room for a number with more digits.
_MAX_DIGITS = 10**15

#: A volume below this fraction of the sum of its absolute terms may be a rounding error.
_ROUNDING = 1e-9

#: The largest number of faces that a finding lists.
_MAX_PLACES_NAMED = 8


def findings_of(solid: "Solid") -> tuple[Finding, ...]:
    """Return the findings about the inputs of a solid and about its mesh (see `Solid.findings`)."""
    found = solid.tree.findings
    if solid.is_bounded:
        solid.to_mesh()
        found = [*found, *solid.tree.mesh_findings()]
    told = tuple(Finding.from_core(finding) for finding in found)
    return (*told, *_faults_of(solid, told)) if solid.is_bounded else told


def exact_volume(solid: "Solid", most_digits: int) -> Fraction:
    """Return the exact volume of a solid in cubic model units (see `Solid.exact_volume`)."""
    digits = min(at_least(1, most_digits, "most_digits"), _MAX_DIGITS)
    bits = math.ceil(digits * math.log2(10))
    with core_errors():
        return Fraction(*solid.normalized().tree.volume6_exact(bits))


def rounded_volume(solid: "Solid") -> float:
    """Return the volume of a solid in cubic model units, rounded once."""
    volume = solid.normalized().tree.volume_rounded()
    return float(volume_near(solid)) if volume is None else volume


def volume_near(solid: "Solid") -> Fraction:
    """Return the volume in cubic model units to within 2**-100 cubic lattice steps.

    This is far more precise than a double and, unlike the exact volume, cheap for any number of cut
    faces.
    """
    with core_errors():
        return Fraction(*solid.normalized().tree.volume_near())


def volume_residues(solid: "Solid") -> tuple[int, int] | None:
    """Return six times the exact volume in cubic lattice steps, modulo 2**61 - 1 and 2**61 - 31.

    Two sums of exact volumes of solids of one pitch can be compared by their residues in one pass
    each: different sums agree with a probability of 2**-122. None in the rare case that a prime
    divides the denominator.
    """
    with core_errors():
        return solid.normalized().tree.volume_residues()


def residues_of_volume(solid: "Solid") -> tuple[int | None, ...]:
    """Return six times the exact volume in cubic units, modulo two primes.

    Unlike those of `volume_residues`, the residues depend only on the set of points, not on its
    lattice or triangles. An entry is None if its prime divides the reduced denominator.
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


def overlaps_of(solid: "Solid") -> tuple[Finding, ...]:
    """Return findings if the mesh of a solid is not the solid's boundary, else an empty tuple.

    Such a mesh has faces that cross, overlap or lie inside the solid, or shells that are inside
    out. The check normalizes the solid.
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


def _turned_shells(mesh: Mesh, reduced: "Solid") -> tuple[Finding, ...]:
    """Return a finding about connected surfaces that are inside out, so that the solid omits them.

    The walls of cavities are inside out, too, but lie on the boundary of the solid, so they do not
    count.
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


def _faults_of(solid: "Solid", findings: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return findings about faults of a solid's mesh that the given findings do not cover."""
    codes = {one.code for one in findings}
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


def _crossings_of(solid: "Solid", *, is_on_lattice: bool) -> tuple[Finding, ...]:
    """Return a finding if the mesh of a solid crosses itself, else an empty tuple.

    Its code is "self_overlap" if faces cross on the lattice, too, and "crossing" if they cross only
    in the given coordinates, by less than a lattice step.
    """
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
    """Return the finding about triangles that have area on the lattice, but none in doubles."""
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
