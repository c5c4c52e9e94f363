//! Residues modulo two primes just below 2^61.
//!
//! Two residues make a 122-bit fingerprint of an exact number. Both primes have the form 2^61 − c with a
//! small c, so that a number is reduced by adding c times its upper bits to its lower ones, without division.

use super::convert::low_limb;

/// The Mersenne prime 2^61 − 1.
pub const P1: u64 = (1 << 61) - 1;

/// The largest prime below [`P1`], 2^61 − 31.
pub const P2: u64 = (1 << 61) - 31;

/// The mask of the low 61 bits.
const LOW: u128 = (1 << 61) - 1;

/// The largest c = 2^61 − p for which two calls of [`fold`] reduce 128 bits to less than 2p.
const MAX_EXCESS: u64 = 1 << 16;

/// The product of two residues modulo `p`, which is [`P1`] or [`P2`].
#[inline]
pub const fn mul_mod(a: u64, b: u64, p: u64) -> u64 {
    reduce_mod((a as u128).wrapping_mul(b as u128), p)
}

/// The inverse of a residue modulo the prime `p`; 0 for the residue 0.
#[inline]
pub fn inv_mod(a: u64, p: u64) -> u64 {
    let (mut large, mut small) = (p, a % p);
    // Each remainder equals its coefficient times a, modulo p; coefficients stay below p.
    let (mut large_coefficient, mut coefficient) = (0i64, 1i64);
    while small > 1 {
        let quotient = large / small;
        (large, small) = (small, large - quotient * small);
        let next = large_coefficient - quotient.cast_signed() * coefficient;
        (large_coefficient, coefficient) = (coefficient, next);
    }
    if small == 0 {
        0
    } else if coefficient < 0 {
        p - coefficient.unsigned_abs()
    } else {
        coefficient.cast_unsigned()
    }
}

/// The residue of `residue * 2^64 + limb` modulo `p`, which is [`P1`] or [`P2`].
#[inline]
pub(super) const fn push_limb(residue: u64, limb: u64, p: u64) -> u64 {
    let limb_base = excess(p) << 3;
    let wide = (residue as u128).wrapping_mul(limb_base as u128);
    reduce_mod(wide.wrapping_add(limb as u128), p)
}

/// The residue of any 128-bit number modulo `p`, which is [`P1`] or [`P2`].
#[inline]
pub const fn reduce_mod(number: u128, p: u64) -> u64 {
    let once = fold(number, excess(p));
    let twice = low_limb(fold(once, excess(p)));
    if twice >= p {
        twice - p
    } else {
        twice
    }
}

/// A smaller number with the same residue modulo 2^61 − `excess`.
#[inline]
const fn fold(number: u128, excess: u64) -> u128 {
    (number & LOW).wrapping_add((number >> 61).wrapping_mul(excess as u128))
}

/// The difference 2^61 − `p`.
#[inline]
const fn excess(p: u64) -> u64 {
    let excess = (1u64 << 61).wrapping_sub(p);
    debug_assert!(excess >= 1 && excess <= MAX_EXCESS);
    excess
}
