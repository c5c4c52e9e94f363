//! Correctly rounded conversion of unsigned integers in limbs, and of their ratios, to doubles.

use super::convert::{as_double, as_number, low_limb};
use super::limbs::{any_bit_below, bit_length, limb_at};

/// The binary exponent of the least positive double, 2^-1074.
const LEAST_EXPONENT: i32 = -1074;

/// The binary exponent of the least normal double, 2^-1022.
const LEAST_NORMAL_EXPONENT: i32 = -1022;

/// The integers m and e with m·2^e = `x`, for a finite double; both are zero for zero.
#[inline]
pub fn mantissa_and_exponent(x: f64) -> (i64, i32) {
    const FRACTION: u64 = (1 << 52) - 1;
    let bits = x.abs().to_bits();
    let (fraction, exponent) = ((bits & FRACTION).cast_signed(), (bits >> 52) as i32);
    let (size, exponent) = match (exponent, fraction) {
        (0, 0) => return (0, 0),
        (0, _) => (fraction, LEAST_EXPONENT),
        _ => (fraction | 1 << 52, exponent - 1 + LEAST_EXPONENT),
    };
    (if x < 0.0 { -size } else { size }, exponent)
}

/// The double nearest to a ratio of two positive integers.
pub(super) fn magnitudes_to_f64<const A: usize, const B: usize>(
    num: &[u64; A],
    den: &[u64; B],
) -> f64 {
    leading_to_f64(num, den).unwrap_or_else(|| all_to_f64(num, den))
}

/// The double nearest to a ratio of two positive integers, or `None` if their leading bits do not decide it.
///
/// A numerator n·(1 + a) of 127 bits over a denominator d·(1 + b) of 64, with 0 ≤ a < 2^-126 and 0 ≤ b <
/// 2^-63: as n/d is below 2^64, the ratio is more than n/d − 2 and at most n/d + 2^-62. So it rounds like
/// all numbers within `UNSURE` of the quotient, unless these include the midpoint of two doubles.
fn leading_to_f64<const A: usize, const B: usize>(num: &[u64; A], den: &[u64; B]) -> Option<f64> {
    const UNSURE: u64 = 4;
    let (num_bits, den_bits) = (bit_length(num).cast_signed(), bit_length(den).cast_signed());
    let divisor = limb_at(den, den_bits - 64);
    let head = u128::from(limb_at(num, num_bits - 63)) << 64;
    let quotient =
        low_limb((head | u128::from(limb_at(num, num_bits - 127))) / u128::from(divisor));
    nearly_to_f64(quotient, UNSURE, num_bits - den_bits - 63)
}

/// The double nearest to (number ± unsure) · 2^`exponent`, or `None` if numbers in this interval may round
/// differently.
///
/// `number` has at least 63 bits.
#[inline]
pub(super) fn nearly_to_f64(number: u64, unsure: u64, exponent: i32) -> Option<f64> {
    // Bits below the last bit of a double's mantissa.
    let spare = 64 - f64::MANTISSA_DIGITS - number.leading_zeros();
    let rest = number & ((1 << spare) - 1);
    let sure = rest.abs_diff(1 << (spare - 1)) > unsure;
    (sure && exponent > LEAST_NORMAL_EXPONENT).then(|| scaled_to_f64(number, true, exponent))
}

/// The double nearest to a ratio of two positive integers, computed from all of their bits.
///
/// One step of long division is enough. With the denominator shifted to fill its `B` limbs
/// and the numerator shifted to `64 * B + 63` bits, the quotient has 63 or 64 bits.
fn all_to_f64<const A: usize, const B: usize>(num: &[u64; A], den: &[u64; B]) -> f64 {
    let (num_bits, den_bits) = (bit_length(num).cast_signed(), bit_length(den).cast_signed());
    let den_start = den_bits - 64 * as_number(B).cast_signed();
    let divisor: [u64; B] =
        std::array::from_fn(|i| limb_at(den, den_start + 64 * as_number(i).cast_signed()));
    let num_start = num_bits - 63 - 64 * as_number(B).cast_signed();
    let low: [u64; B] =
        std::array::from_fn(|i| limb_at(num, num_start + 64 * as_number(i).cast_signed()));
    let lead = limb_at(num, num_start + 64 * as_number(B).cast_signed());
    let (quotient, exact) = divide_step(lead, low, &divisor);
    let sticky = !exact || any_bit_below(num, num_start);
    scaled_to_f64(quotient, sticky, num_bits - den_bits - 63)
}

/// The quotient of `lead * 2^(64 B) + low` by a divisor with its top bit set, and whether the remainder is
/// zero; the quotient must fit in a limb.
#[inline]
fn divide_step<const B: usize>(lead: u64, low: [u64; B], divisor: &[u64; B]) -> (u64, bool) {
    let head = u128::from(lead) << 64 | u128::from(low[B - 1]);
    let mut quotient = low_limb(head / u128::from(divisor[B - 1]));
    let (mut high, mut rest) = subtract_multiple(lead, low, divisor, quotient);
    // The guess from the leading limbs is at most two too large.
    while high != 0 {
        quotient -= 1;
        high = high.wrapping_add(add_to(&mut rest, divisor));
    }
    (quotient, rest.iter().all(|&limb| limb == 0))
}

/// `number - divisor * quotient` modulo 2^(64 (B + 1)), where `lead` is the top limb of the number; returns
/// the top limb and the others.
#[inline]
fn subtract_multiple<const B: usize>(
    lead: u64,
    mut number: [u64; B],
    divisor: &[u64; B],
    quotient: u64,
) -> (u64, [u64; B]) {
    let mut carry = 0u64;
    for (limb, &part) in number.iter_mut().zip(divisor) {
        let product = u128::from(part)
            .wrapping_mul(u128::from(quotient))
            .wrapping_add(u128::from(carry));
        let (difference, borrow) = limb.overflowing_sub(low_limb(product));
        *limb = difference;
        carry = ((product >> 64) as u64).wrapping_add(u64::from(borrow));
    }
    (lead.wrapping_sub(carry), number)
}

/// Adds `addend` to `number` in place and returns the carry out of the last limb.
#[inline]
fn add_to<const B: usize>(number: &mut [u64; B], addend: &[u64; B]) -> u64 {
    let mut carry = 0;
    for (limb, &other) in number.iter_mut().zip(addend) {
        let sum = u128::from(*limb)
            .wrapping_add(u128::from(other))
            .wrapping_add(carry);
        *limb = low_limb(sum);
        carry = sum >> 64;
    }
    low_limb(carry)
}

/// The double nearest to an unsigned integer in little-endian limbs, ties to even.
#[inline]
pub(super) fn limbs_to_f64<const N: usize>(limbs: &[u64; N]) -> f64 {
    let start = bit_length(limbs).cast_signed() - 64;
    if start <= 0 {
        return as_double(limbs[0]);
    }
    scaled_to_f64(limb_at(limbs, start), any_bit_below(limbs, start), start)
}

/// The double nearest to `(number + part) * 2^exponent`, where `part` lies strictly between
/// 0 and 1 if `sticky`, else is 0; `number` has at least 63 bits.
#[inline]
fn scaled_to_f64(number: u64, sticky: bool, exponent: i32) -> f64 {
    let lead = exponent + 63 - number.leading_zeros().cast_signed();
    if lead < LEAST_NORMAL_EXPONENT {
        return subnormal(number, sticky, LEAST_EXPONENT - exponent);
    }
    // The sticky bit lies below the last bit of the mantissa, so that it only decides ties.
    let rounded = as_double(number | u64::from(sticky));
    // Two steps, because the scale alone may be out of range for doubles.
    let half = exponent / 2;
    rounded * power_of_two(half) * power_of_two(exponent - half)
}

/// The subnormal double nearest to `(number + part) / 2^shift` times the least positive double, where `part`
/// lies strictly between 0 and 1 if `sticky`, else is 0.
#[inline]
fn subnormal(number: u64, sticky: bool, shift: i32) -> f64 {
    if shift > 64 {
        return 0.0;
    }
    let wide = u128::from(number) << 64 >> shift;
    let (whole, part) = ((wide >> 64) as u64, low_limb(wide));
    let half = 1 << 63;
    let up = part > half || part == half && (sticky || whole % 2 == 1);
    f64::from_bits(whole + u64::from(up))
}

/// The double 2^`exponent`, infinite above the range of doubles; the exponent must not be below the normal
/// range.
#[inline]
fn power_of_two(exponent: i32) -> f64 {
    debug_assert!(exponent >= LEAST_NORMAL_EXPONENT);
    f64::from_bits(u64::from((exponent.min(1024) + 1023).cast_unsigned()) << 52)
}
