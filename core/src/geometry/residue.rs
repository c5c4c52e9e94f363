//! Residues of small integers modulo the Mersenne prime 2^61 − 1, by folding.

use crate::arith::P1;

/// The residue of a signed integer in `0..P1`.
#[allow(clippy::cast_possible_truncation)]
pub fn residue(value: i128) -> u64 {
    let size = value.unsigned_abs();
    let mask = u128::from(P1);
    let once = (size & mask) + (size >> 61 & mask) + (size >> 122);
    let twice = ((once & mask) + (once >> 61)) as u64;
    let r = if twice >= P1 { twice - P1 } else { twice };
    if value < 0 && r != 0 {
        P1 - r
    } else {
        r
    }
}
