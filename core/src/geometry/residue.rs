//! Residues of small integers modulo the Mersenne prime 2^61 − 1, by folding.

use crate::arith::P1;

/// The residue of a signed integer in `0..P1`.
#[inline]
pub fn residue(value: i128) -> u64 {
    let r = reduce_p1(value.unsigned_abs());
    if value < 0 && r != 0 {
        P1 - r
    } else {
        r
    }
}

/// The residue of any 128-bit number.
#[inline]
#[allow(clippy::cast_possible_truncation)]
pub fn reduce_p1(value: u128) -> u64 {
    let low = value as u64 & P1;
    let middle = (value >> 61) as u64 & P1;
    let once = low.wrapping_add(middle).wrapping_add((value >> 122) as u64);
    let twice = (once & P1).wrapping_add(once >> 61);
    if twice >= P1 {
        twice - P1
    } else {
        twice
    }
}

/// The product of two residues.
#[inline]
#[allow(clippy::cast_possible_truncation)]
pub fn mul_p1(a: u64, b: u64) -> u64 {
    let product = u128::from(a).wrapping_mul(u128::from(b));
    // Below 2^122, so that the two halves of 61 bits are all there is.
    let sum = (product as u64 & P1).wrapping_add((product >> 61) as u64);
    if sum >= P1 {
        sum - P1
    } else {
        sum
    }
}
