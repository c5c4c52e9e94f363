//! Integers represented by their leading bits, and quotients that are rounded correctly from these bits.

use super::convert::low_limb;
use super::round::nearly_to_f64;

/// The number of bits of the lower part of a [`SplitInteger`].
pub const SPLIT_BITS: u32 = 40;

/// The integer high·2^[`SPLIT_BITS`] + low, with 0 ≤ low < 2^[`SPLIT_BITS`].
///
/// Nothing checks that sums fit: callers bound them.
#[derive(Clone, Copy, Debug)]
pub struct SplitInteger {
    high: i128,
    low: i128,
}

impl SplitInteger {
    /// The integer high·2^[`SPLIT_BITS`] + low, for any low part and a high part below 2^126 in magnitude.
    #[inline]
    pub const fn new(high: i128, low: i128) -> Self {
        Self {
            high: high.wrapping_add(low >> SPLIT_BITS),
            low: low & ((1 << SPLIT_BITS) - 1),
        }
    }

    /// The sum of two split integers; its high part must be below 2^126 in magnitude.
    #[inline]
    #[must_use]
    pub const fn plus(&self, other: &Self) -> Self {
        Self::new(self.high.wrapping_add(other.high), self.low + other.low)
    }

    /// The integer with its sign reversed.
    #[inline]
    #[must_use]
    pub const fn negated(&self) -> Self {
        Self::new(self.high.wrapping_neg(), -self.low)
    }

    /// Return whether the integer is zero.
    #[inline]
    pub const fn is_zero(&self) -> bool {
        self.high | self.low == 0
    }

    /// Return whether the integer is below zero.
    #[inline]
    pub const fn is_negative(&self) -> bool {
        self.high < 0
    }

    /// The leading bits of the integer, which must be positive.
    #[inline]
    pub fn leading(&self) -> Leading {
        let (high, low) = (self.high.cast_unsigned(), self.low.cast_unsigned());
        let spare = high.leading_zeros();
        if spare > SPLIT_BITS {
            return Leading::of(high << SPLIT_BITS | low);
        }
        Leading {
            bits: high << spare | low << spare >> SPLIT_BITS,
            exponent: SPLIT_BITS.cast_signed() - spare.cast_signed(),
        }
    }
}

/// The leading 128 bits of a positive number, which is (bits + part)·2^exponent with 2^127 ≤ bits < 2^128 and
/// 0 ≤ part ≤ bits·2^-63.
#[derive(Clone, Copy, Debug)]
pub struct Leading {
    bits: u128,
    exponent: i32,
}

impl Leading {
    /// The leading bits of a positive integer, which they represent exactly.
    #[inline]
    pub const fn of(number: u128) -> Self {
        let spare = number.leading_zeros();
        Self {
            bits: number << spare,
            exponent: -spare.cast_signed(),
        }
    }

    /// The leading bits of the product with an integer factor; the number must be exact, or inexact only
    /// below its leading 64 bits.
    #[inline]
    #[must_use]
    pub fn times(&self, factor: u64) -> Self {
        let product = Self::of(u128::from(self.top()).wrapping_mul(u128::from(factor)));
        Self {
            exponent: product.exponent + self.exponent + 64,
            ..product
        }
    }

    /// The double nearest to the quotient of two numbers, or `None` if their leading bits do not decide it.
    ///
    /// A numerator n·(1 + a) of 127 bits over a denominator d·(1 + b) of 64, with 0 ≤ a ≤ 2^-63 and 0 ≤ b <
    /// 2^-63 + 2^-63: as n/d is below 2^64, the ratio is more than n/d − 4 and at most n/d + 2. So it
    /// rounds like all numbers within `UNSURE` of the quotient, unless these include the midpoint of two
    /// doubles.
    #[inline]
    pub fn over(&self, denominator: &Self) -> Option<f64> {
        let quotient = low_limb((self.bits >> 1) / u128::from(denominator.top()));
        nearly_to_f64(quotient, UNSURE, self.exponent - denominator.exponent - 63)
    }

    /// The leading 64 bits of the number.
    #[inline]
    const fn top(&self) -> u64 {
        (self.bits >> 64) as u64
    }
}

/// A bound on the error of a quotient that is computed from leading bits, in units of its last bit.
const UNSURE: u64 = 8;

#[cfg(test)]
mod tests {
    use super::super::{ratio_to_f64, Int};
    use super::*;

    /// Positive integers of all lengths up to `bits` bits, in pseudorandom order.
    fn numbers(bits: u32) -> impl Iterator<Item = i128> {
        let mut state = 0x9E37_79B9_7F4A_7C15_F39C_C060_5CED_C835_u128;
        std::iter::repeat_with(move || {
            state = state
                .wrapping_mul(0xDA94_2042_E4DD_58B5_u128)
                .rotate_left(41)
                ^ 0xB5;
            let length = (state >> 100) as u32 % bits;
            ((state >> 1) & ((1 << length) - 1) | 1 << length).cast_signed()
        })
        .take(4000)
    }

    fn whole(high: i128, low: i128) -> Int<4> {
        let high: Int<4> = Int::<2>::from_i128(high).mul(&Int::<2>::from_i128(1 << SPLIT_BITS));
        high + Int::from_i128(low)
    }

    #[test]
    fn quotients_are_those_of_integers() {
        let mut decided = 0;
        let parts: Vec<i128> = numbers(124).zip(numbers(60)).map(|(a, b)| a ^ b).collect();
        for pair in parts.chunks_exact(4) {
            let [a, b, c, d] = [pair[0], pair[1], pair[2] >> 9, pair[3] | 1];
            let exact = ratio_to_f64(&whole(a, b), &whole(c, d));
            let (n, m) = (
                SplitInteger::new(a, b).leading(),
                SplitInteger::new(c, d).leading(),
            );
            if let Some(nearest) = n.over(&m) {
                assert_eq!(nearest.to_bits(), exact.to_bits(), "{a}, {b} over {c}, {d}");
                decided += 1;
            }
        }
        assert!(decided > 900, "{decided} of 1000");
    }

    #[test]
    fn factors_are_those_of_integers() {
        let ten = Int::<2>::from_i128(10i128.pow(9));
        for (a, b) in numbers(124).zip(numbers(90)) {
            let [n, m] = [a, b].map(|c| Leading::of(c.cast_unsigned()));
            let [whole_n, whole_m] = [a, b].map(Int::<2>::from_i128);
            let (up, down): (Int<4>, Int<4>) = (whole_n.mul(&ten), whole_m.mul(&ten));
            if let Some(nearest) = n.times(1_000_000_000).over(&m) {
                assert_eq!(nearest.to_bits(), ratio_to_f64(&up, &whole_m).to_bits());
            }
            if let Some(nearest) = n.over(&m.times(1_000_000_000)) {
                assert_eq!(nearest.to_bits(), ratio_to_f64(&whole_n, &down).to_bits());
            }
        }
    }

    #[test]
    fn middles_between_doubles_are_not_decided() {
        let one = Leading::of(1);
        let odd = (1u128 << 53) + 1;
        assert_eq!(Leading::of(odd).over(&one), None);
        assert_eq!(
            Leading::of(odd - 1).over(&one),
            Some(9_007_199_254_740_992.0)
        );
    }

    #[test]
    fn sums_and_signs_carry() {
        let minus = SplitInteger::new(0, -1);
        assert!(minus.is_negative() && !minus.negated().is_negative());
        assert!(minus.plus(&minus.negated()).is_zero());
        let half = SplitInteger::new(0, 1 << 39);
        assert_eq!(half.plus(&half).leading().bits, 1 << 127);
    }
}
