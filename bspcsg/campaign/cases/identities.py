"""Checks that exact volumes of the results of one pair add up."""

from ...errors import BspcsgError
from ...solid.measure import volume_residues
from ...solid.solid import Solid
from ..record import IdentityRecord

#: The moduli by which volumes are compared; see `volume_residues`.
_PRIMES = (2**61 - 1, 2**61 - 31)

#: For each operation the equation, and the coefficients of A, B and their intersection.
_EQUATIONS = {
    "union": ("|A ∪ B| = |A| + |B| − |A ∩ B|", (1, 1, -1)),
    "difference": ("|A − B| = |A| − |A ∩ B|", (1, 0, -1)),
    "xor": ("|A ⊕ B| = |A| + |B| − 2 |A ∩ B|", (1, 1, -2)),
}


def identity_of(op: str, operands: list[Solid], result: Solid) -> IdentityRecord | None:
    """Return whether the exact volume of a result agrees with those of its operands.

    None for other than two operands, for operands on different lattices, and for intersections,
    from which the other volumes are computed.
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
