"""Check that the exact volumes of a result and its two operands satisfy an equation."""

from ...errors import BspcsgError
from ...solid.measure import volume_residues
from ...solid.solid import Solid
from ..record import IdentityRecord

#: The moduli by which volumes are compared; see `volume_residues`.
_PRIMES = (2**61 - 1, 2**61 - 31)

#: For each operation the equation as text, and the coefficients of |A|, |B| and |A ∩ B|.
_EQUATIONS = {
    "union": ("|A ∪ B| = |A| + |B| − |A ∩ B|", (1, 1, -1)),
    "difference": ("|A − B| = |A| − |A ∩ B|", (1, 0, -1)),
    "xor": ("|A ⊕ B| = |A| + |B| − 2 |A ∩ B|", (1, 1, -2)),
}


def identity_of(op: str, operands: list[Solid], result: Solid) -> IdentityRecord | None:
    """Return the equation of exact volumes of an operation, and whether it holds; or None.

    It is None for other than two operands, for operands on different lattices, and for
    intersections, whose volume is used in the equations.
    """
    if op not in _EQUATIONS or len(operands) != 2 or operands[0].pitch != operands[1].pitch:
        return None
    equation, weights = _EQUATIONS[op]
    a, b = operands
    volumes = [_residues(solid) for solid in (a, b, a & b, result)]
    known = [volume for volume in volumes if volume is not None]
    if len(known) < len(volumes):
        return None
    holds = all(
        (sum(weight * part[k] for weight, part in zip(weights, known[:3], strict=True))
         - known[3][k]) % prime == 0
        for k, prime in enumerate(_PRIMES)
    )  # fmt: skip
    return {"equation": equation, "holds": holds}


def _residues(solid: Solid) -> tuple[int, int] | None:
    try:
        return volume_residues(solid)
    except BspcsgError:
        return None
