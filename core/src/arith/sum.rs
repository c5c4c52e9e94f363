//! Exact sums of doubles, rounded once at the end.
#![allow(clippy::float_cmp)]

use smallvec::SmallVec;

/// The number of doubles that a [`Sum`] stores without allocation; at least 40, because as many doubles of 53
/// bits fit side by side in the 2098 bits from the least to the largest double.
const PARTS: usize = 64;

/// An exact sum of doubles, stored as doubles whose bits do not overlap, the smallest first.
///
/// # Source
/// Shewchuk 1997, "Adaptive precision floating-point arithmetic", § 2.4, GROW-EXPANSION.
///
/// # Example
/// ```
/// use bspcsg::arith::Sum;
///
/// let mut sum = Sum::default();
/// for number in [1e100, 1.0, -1e100] {
///     sum.add(number);
/// }
/// assert_eq!(sum.rounded(), 1.0);
/// ```
#[derive(Debug, Default)]
pub struct Sum {
    parts: SmallVec<[f64; PARTS]>,
    /// The sum of infinite and NaN terms and of overflows; 0 if there are none.
    beyond: f64,
}

impl Sum {
    /// Adds a double to the sum, without rounding.
    pub fn add(&mut self, number: f64) {
        let mut high = number;
        let mut kept = 0;
        for at in 0..self.parts.len() {
            let (sum, error) = two_sum(high, self.parts[at]);
            if error != 0.0 {
                self.parts[kept] = error;
                kept += 1;
            }
            high = sum;
        }
        self.parts.truncate(kept);
        if high.is_finite() {
            self.parts.push(high);
        } else {
            self.parts.clear();
            self.beyond += high;
        }
    }

    /// The double nearest to the sum, ties to even; infinite or NaN if a term was, or if a partial sum
    /// overflowed.
    pub fn rounded(mut self) -> f64 {
        if self.beyond != 0.0 {
            return self.beyond;
        }
        let mut high = self.parts.pop().unwrap_or(0.0);
        while let Some(part) = self.parts.pop() {
            let (sum, error) = two_sum(high, part);
            high = sum;
            if error != 0.0 {
                return self.nearer(high, error);
            }
        }
        high
    }

    /// Returns `high`, or the neighbouring double of `high` if `error` is half the distance to it and the
    /// next smaller part of the sum has the sign of `error`.
    fn nearer(&self, high: f64, error: f64) -> f64 {
        let below = self.parts.last().copied().unwrap_or(0.0);
        let further = high + 2.0 * error;
        let is_half = further - high == 2.0 * error;
        if is_half && below * error.signum() > 0.0 {
            further
        } else {
            high
        }
    }
}

/// The rounded sum of two doubles and its rounding error: together they are the exact sum.
#[inline]
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let (large, small) = if a.abs() < b.abs() { (b, a) } else { (a, b) };
    let sum = large + small;
    (sum, small - (sum - large))
}

#[cfg(test)]
mod tests {
    use super::Sum;

    fn sum(numbers: &[f64]) -> f64 {
        let mut sum = Sum::default();
        for &number in numbers {
            sum.add(number);
        }
        sum.rounded()
    }

    #[test]
    fn cancellation_loses_nothing() {
        assert_eq!(sum(&[]).to_bits(), 0.0f64.to_bits());
        assert_eq!(
            sum(&[1e100, 1.0, -1e100, 1e-30]).to_bits(),
            1.0f64.to_bits()
        );
        assert_eq!(sum(&[0.1; 10]).to_bits(), 1.0f64.to_bits());
    }

    #[test]
    fn what_lies_below_a_tie_decides_it() {
        let half = f64::EPSILON / 2.0;
        assert_eq!(sum(&[1.0, half]).to_bits(), 1.0f64.to_bits());
        assert_eq!(sum(&[1.0, half, 1e-40]), 1.0 + f64::EPSILON);
        assert_eq!(sum(&[1.0, half, -1e-40]).to_bits(), 1.0f64.to_bits());
    }

    #[test]
    fn what_is_beyond_doubles_stays_there() {
        assert!(sum(&[f64::NAN, 1.0]).is_nan());
        assert_eq!(sum(&[1e308, 1e308]), f64::INFINITY);
    }
}
