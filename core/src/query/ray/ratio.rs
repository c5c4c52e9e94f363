//! Exact fractions, for parameters along a ray.

use std::cmp::Ordering;

use super::bounds::{COMPARE_LIMBS, DENOMINATOR_LIMBS, NUMERATOR_LIMBS};
use crate::arith::{ratio_to_f64, Int, Sign};

/// A fraction with a positive denominator; it need not be in lowest terms.
#[derive(Clone, Copy, Debug)]
pub struct Ratio {
    numerator: Int<NUMERATOR_LIMBS>,
    denominator: Int<DENOMINATOR_LIMBS>,
}

impl Ratio {
    /// Zero.
    pub const ZERO: Self = Self {
        numerator: Int::ZERO,
        denominator: Int::ONE,
    };

    /// One.
    pub const ONE: Self = Self {
        numerator: Int::ONE,
        denominator: Int::ONE,
    };

    /// Makes a fraction; the denominator must not be zero, but may be negative.
    pub fn new(numerator: Int<NUMERATOR_LIMBS>, denominator: Int<DENOMINATOR_LIMBS>) -> Self {
        if denominator.is_negative() {
            let (numerator, denominator) = (-numerator, -denominator);
            return Self {
                numerator,
                denominator,
            };
        }
        Self {
            numerator,
            denominator,
        }
    }

    /// The numerator.
    pub fn numerator(&self) -> &Int<NUMERATOR_LIMBS> {
        &self.numerator
    }

    /// The denominator, positive.
    pub fn denominator(&self) -> &Int<DENOMINATOR_LIMBS> {
        &self.denominator
    }

    /// The sign.
    pub fn sign(&self) -> Sign {
        self.numerator.sign()
    }

    /// The nearest double.
    pub fn to_f64(&self) -> f64 {
        ratio_to_f64(&self.numerator, &self.denominator)
    }

    /// The double nearest to this fraction times 10^`power`, |`power`| ≤ 22.
    pub fn scaled_to_f64(&self, power: i64) -> f64 {
        let ten = Int::<2>::from_i128(10i128.pow(power.unsigned_abs().min(22) as u32));
        let (up, down) = if power < 0 {
            (Int::ONE, ten)
        } else {
            (ten, Int::ONE)
        };
        let numerator: Int<{ NUMERATOR_LIMBS + 1 }> = self.numerator.mul(&up);
        let denominator: Int<{ DENOMINATOR_LIMBS + 1 }> = self.denominator.mul(&down);
        ratio_to_f64(&numerator, &denominator)
    }
}

impl PartialEq for Ratio {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Ratio {}

impl PartialOrd for Ratio {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ratio {
    fn cmp(&self, other: &Self) -> Ordering {
        let left: Int<COMPARE_LIMBS> = self.numerator.mul(&other.denominator);
        let right: Int<COMPARE_LIMBS> = other.numerator.mul(&self.denominator);
        left.cmp(&right)
    }
}
