//! Residues of 128-bit integers modulo the primes just below 2^61, without division.

use crate::arith::{mul_mod, reduce_mod, P1};

/// The residue of a signed integer in `0..P`, where `P` is `P1` or `P2`.
#[inline]
pub fn residue<const P: u64>(value: i128) -> u64 {
    let r = reduce::<P>(value.unsigned_abs());
    if value < 0 && r != 0 {
        P - r
    } else {
        r
    }
}

/// The residue of an unsigned 128-bit integer in `0..P`, where `P` is `P1` or `P2`.
#[inline]
pub fn reduce<const P: u64>(value: u128) -> u64 {
    // A fold modulo the Mersenne prime needs no multiplication.
    if P == P1 {
        reduce_p1(value)
    } else {
        reduce_mod(value, P)
    }
}

/// The product of two residues modulo `P`, which is `P1` or `P2`.
#[inline]
pub fn mul<const P: u64>(a: u64, b: u64) -> u64 {
    if P == P1 {
        mul_p1(a, b)
    } else {
        mul_mod(a, b, P)
    }
}

#[inline]
#[allow(clippy::cast_possible_truncation)]
fn reduce_p1(value: u128) -> u64 {
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

#[inline]
#[allow(clippy::cast_possible_truncation)]
fn mul_p1(a: u64, b: u64) -> u64 {
    let product = u128::from(a).wrapping_mul(u128::from(b));
    // Below 2^122, so that the two halves of 61 bits are all of it.
    let sum = (product as u64 & P1).wrapping_add((product >> 61) as u64);
    if sum >= P1 {
        sum - P1
    } else {
        sum
    }
}
