//! Signs of numbers.

use std::cmp::Ordering;
use std::ops::{Mul, Neg};

/// The sign of a number, or of a turn, determinant or direction that a number represents.
///
/// # Example
/// ```
/// use bspcsg::arith::Sign;
///
/// assert_eq!(Sign::of(-0.5), Sign::Negative);
/// assert_eq!(Sign::of(-2) * -Sign::of(3), Sign::Positive);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(i8)]
pub enum Sign {
    /// Below zero; for a turn: right.
    Negative = -1,
    /// Zero; for a turn: straight.
    Zero = 0,
    /// Above zero; for a turn: left.
    Positive = 1,
}

impl Sign {
    /// The sign of a number.
    #[inline]
    pub fn of<T: PartialOrd + Default + Copy>(number: T) -> Self {
        let zero = T::default();
        if number > zero {
            Self::Positive
        } else if number < zero {
            Self::Negative
        } else {
            Self::Zero
        }
    }

    /// The sign of a − b, where `order` is the order of a and b.
    #[inline]
    pub fn from_order(order: Ordering) -> Self {
        match order {
            Ordering::Less => Self::Negative,
            Ordering::Equal => Self::Zero,
            Ordering::Greater => Self::Positive,
        }
    }

    /// The order of a number of this sign and zero.
    #[inline]
    pub fn order(self) -> Ordering {
        self.cmp(&Self::Zero)
    }

    /// The first sign that is not zero, or zero if all are zero: the sign of a sum in which each term
    /// outweighs the sum of all later terms.
    #[inline]
    pub fn first(signs: impl IntoIterator<Item = Self>) -> Self {
        let found = signs.into_iter().find(|sign| *sign != Self::Zero);
        found.unwrap_or(Self::Zero)
    }

    /// Return `number`, negated if the sign is negative; a zero sign leaves it unchanged.
    #[inline]
    #[must_use]
    pub fn times<T: Neg<Output = T>>(self, number: T) -> T {
        match self {
            Self::Negative => -number,
            Self::Zero | Self::Positive => number,
        }
    }
}

impl Neg for Sign {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        match self {
            Self::Negative => Self::Positive,
            Self::Zero => Self::Zero,
            Self::Positive => Self::Negative,
        }
    }
}

impl Mul for Sign {
    type Output = Self;

    /// The sign of a product of two numbers with these signs.
    #[inline]
    fn mul(self, other: Self) -> Self {
        match self {
            Self::Negative => -other,
            Self::Zero => Self::Zero,
            Self::Positive => other,
        }
    }
}

impl From<Sign> for i32 {
    /// −1 for negative, 0 for zero, 1 for positive.
    #[inline]
    fn from(sign: Sign) -> Self {
        sign as Self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Sign; 3] = [Sign::Negative, Sign::Zero, Sign::Positive];

    #[test]
    fn signs_multiply_and_turn_as_numbers_do() {
        for a in ALL {
            assert_eq!(i32::from(-a), -i32::from(a));
            assert_eq!(a.order(), i32::from(a).cmp(&0));
            assert_eq!(Sign::from_order(a.order()), a);
            for b in ALL {
                assert_eq!(i32::from(a * b), i32::from(a) * i32::from(b));
            }
        }
    }

    #[test]
    fn zeros_leave_the_decision_to_the_next() {
        assert_eq!(Sign::first([]), Sign::Zero);
        assert_eq!(
            Sign::first([Sign::Zero, Sign::Negative, Sign::Positive]),
            Sign::Negative
        );
    }

    #[test]
    fn numbers_that_are_neither_above_nor_below_have_no_sign() {
        assert_eq!(Sign::of(-0.0), Sign::Zero);
        assert_eq!(Sign::of(f64::NAN), Sign::Zero);
        assert_eq!(Sign::of(i128::MIN), Sign::Negative);
    }
}
