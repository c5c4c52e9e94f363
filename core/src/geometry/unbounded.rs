//! Conversion of integers of fixed width to integers of unbounded width.

use num_bigint::{BigInt, Sign};

use crate::arith::Int;

/// The same integer as a big integer, of unbounded width.
#[allow(clippy::cast_possible_truncation)]
pub fn big<const N: usize>(value: &Int<N>) -> BigInt {
    let size = value.abs();
    let digits: Vec<u32> = size
        .limbs()
        .iter()
        .flat_map(|l| [*l as u32, (*l >> 32) as u32])
        .collect();
    let sign = if value.is_negative() {
        Sign::Minus
    } else {
        Sign::Plus
    };
    BigInt::from_slice(sign, &digits)
}
