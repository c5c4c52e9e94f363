//! Ratios of integers, rounded correctly to doubles.

use super::round::magnitudes_to_f64;
use super::{Int, Sign};

/// The double nearest to `numerator / denominator`, ties to even; `denominator > 0`.
///
/// Subnormal results are rounded once, like all others; a ratio above the largest double gives an infinity. A
/// zero numerator gives +0.
///
/// # Example
/// ```
/// use bspcsg::arith::{ratio_to_f64, Int};
///
/// let third = ratio_to_f64(&Int::<1>::from_i64(1), &Int::<1>::from_i64(3));
/// assert_eq!(third, 1.0 / 3.0);
/// ```
#[inline]
pub fn ratio_to_f64<const A: usize, const B: usize>(
    numerator: &Int<A>,
    denominator: &Int<B>,
) -> f64 {
    debug_assert!(
        denominator.sign() == Sign::Positive,
        "the denominator is not positive"
    );
    if numerator.is_zero() {
        return 0.0;
    }
    let nearest = magnitudes_to_f64(&numerator.magnitude(), &denominator.magnitude());
    if numerator.is_negative() {
        -nearest
    } else {
        nearest
    }
}
