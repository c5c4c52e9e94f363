//! Numbers of two doubles each, for sums that lose too much to cancellation in one double.

use std::ops::{Add, AddAssign, Div, Mul, Sub};

use super::sum::two_sum;

/// The unrounded sum of two doubles; the second is at most half a unit in the last place of the first.
///
/// Sums and products have a relative error below 2^-103, as long as nothing overflows.
///
/// # Source
/// Joldes, Muller, Popescu 2017, "Tight and rigorous error bounds for basic building blocks of
/// double-word arithmetic", algorithms 6 and 12.
///
/// # Example
/// ```
/// use bspcsg::arith::DoubleDouble;
///
/// let third = DoubleDouble::from(1.0) / DoubleDouble::from(3.0);
/// let rest = DoubleDouble::from(1.0) - third * DoubleDouble::from(3.0);
/// assert!(rest.rounded().abs() < 1e-31);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// The exact difference `a - b` of two doubles.
    #[inline]
    pub fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, -b);
        Self { high, low }
    }

    /// The double nearest to the number.
    #[inline]
    pub fn rounded(self) -> f64 {
        self.high
    }

    /// The exact sum of a double and one of smaller magnitude.
    #[inline]
    fn of(large: f64, small: f64) -> Self {
        let high = large + small;
        let low = small - (high - large);
        Self { high, low }
    }
}

impl From<f64> for DoubleDouble {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let (high, lost) = two_sum(self.high, other.high);
        let (low, last) = two_sum(self.low, other.low);
        let sum = Self::of(high, lost + low);
        Self::of(sum.high, last + sum.low)
    }
}

impl AddAssign for DoubleDouble {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        let negative = Self {
            high: -other.high,
            low: -other.low,
        };
        self + negative
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let lost = self.high.mul_add(other.high, -high);
        let mixed = self.low.mul_add(other.high, self.high * other.low);
        Self::of(high, lost + mixed)
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    /// The quotient, with a relative error below 2^-100.
    #[inline]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::from(first);
        Self::of(first, rest.high / other.high)
    }
}

#[cfg(test)]
mod tests {
    use super::DoubleDouble;

    #[test]
    fn what_one_double_loses_is_kept() {
        let (large, one) = (DoubleDouble::from(1e15), DoubleDouble::from(1.0));
        let near = large * large + one;
        assert!(((near - large * large).rounded() - 1.0).abs() < 1e-15);
        let step = DoubleDouble::difference(1e16, 0.125);
        assert!(((DoubleDouble::from(1e16) - step).rounded() - 0.125).abs() < 1e-15);
    }
}
