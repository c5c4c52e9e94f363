//! Unsigned integers as little-endian arrays of 64-bit limbs.
//!
//! These are the loops under [`Int`](super::Int) and under the rounding to doubles. All operations wrap
//! explicitly, so the build's overflow checks change nothing.

use super::convert::{as_number, low_limb};

/// The largest number of top limbs by which a result may be shorter than the full product; these limbs are
/// computed anyway, to check that they only repeat the sign.
pub(super) const MAX_TRUNCATED_LIMBS: usize = 2;

/// The product of two unsigned integers: its low `R >= A + B - MAX_TRUNCATED_LIMBS` limbs, and the limbs
/// above these.
#[inline]
pub(super) fn unsigned_product<const A: usize, const B: usize, const R: usize>(
    a: &[u64; A],
    b: &[u64; B],
) -> ([u64; R], [u64; MAX_TRUNCATED_LIMBS]) {
    let mut product = [0; R];
    let mut top = [0; MAX_TRUNCATED_LIMBS];
    for (i, &a) in a.iter().enumerate() {
        let mut carry = 0;
        for (j, &b) in b.iter().enumerate() {
            let limb = limb_of(&mut product, &mut top, i + j);
            (*limb, carry) = multiply_add(a, b, *limb, carry);
        }
        *limb_of(&mut product, &mut top, i + B) = carry;
    }
    (product, top)
}

/// The limb at index `place` of an integer whose limbs from `R` on are in `top`.
#[inline(always)]
#[allow(
    clippy::inline_always,
    reason = "the place is a constant once loops are unrolled"
)]
fn limb_of<'a, const R: usize>(
    number: &'a mut [u64; R],
    top: &'a mut [u64; MAX_TRUNCATED_LIMBS],
    place: usize,
) -> &'a mut u64 {
    if place < R {
        &mut number[place]
    } else {
        &mut top[place - R]
    }
}

/// The low and the high limb of `a * b + c + d`, which always fits.
#[inline]
pub(super) const fn multiply_add(a: u64, b: u64, c: u64, d: u64) -> (u64, u64) {
    let wide = (a as u128)
        .wrapping_mul(b as u128)
        .wrapping_add(c as u128)
        .wrapping_add(d as u128);
    (low_limb(wide), (wide >> 64) as u64)
}

/// Subtracts `subtrahend & mask`, shifted by `start` limbs, from an integer whose limbs from `R` on are in
/// `top`.
///
/// The borrow from above the subtrahend's last limb is dropped.
#[inline]
pub(super) fn subtract_masked<const R: usize, const B: usize>(
    number: &mut [u64; R],
    top: &mut [u64; MAX_TRUNCATED_LIMBS],
    start: usize,
    subtrahend: &[u64; B],
    mask: u64,
) {
    let mut borrow = false;
    for (j, &limb) in subtrahend.iter().enumerate() {
        let from = limb_of(number, top, start + j);
        (*from, borrow) = borrowing_sub(*from, limb & mask, borrow);
    }
}

/// The low limb of `a + b + carry`, and whether the sum exceeds a limb.
#[inline]
pub(super) const fn carrying_add(a: u64, b: u64, carry: bool) -> (u64, bool) {
    let (sum, first) = a.overflowing_add(b);
    let (sum, second) = sum.overflowing_add(carry as u64);
    (sum, first | second)
}

/// The low limb of `a - b - borrow`, and whether the difference is negative.
#[inline]
pub(super) const fn borrowing_sub(a: u64, b: u64, borrow: bool) -> (u64, bool) {
    let (difference, first) = a.overflowing_sub(b);
    let (difference, second) = difference.overflowing_sub(borrow as u64);
    (difference, first | second)
}

/// The remainder of an unsigned integer on division by a divisor of one limb.
#[inline]
pub(super) fn remainder_short<const N: usize>(limbs: &[u64; N], divisor: u64) -> u64 {
    limbs.iter().rev().fold(0, |rest, &limb| {
        low_limb((u128::from(rest) << 64 | u128::from(limb)) % u128::from(divisor))
    })
}

/// The remainder of an unsigned integer on division by a divisor of two limbs.
pub(super) fn remainder_long<const N: usize>(limbs: &[u64; N], divisor: u128) -> u128 {
    let shift = divisor.leading_zeros();
    let normalised = divisor << shift;
    let shifted = |i: usize| {
        let low = if i == 0 { 0 } else { limbs[i - 1] };
        let high = limbs.get(i).copied().unwrap_or(0);
        ((u128::from(high) << 64 | u128::from(low)) << shift >> 64) as u64
    };
    let rest = (0..=N)
        .rev()
        .fold(0, |rest, i| remainder_step(rest, shifted(i), normalised));
    rest >> shift
}

/// The remainder of `rest * 2^64 + limb` by a divisor with its top bit set; `rest < divisor`.
#[inline]
pub(super) fn remainder_step(rest: u128, limb: u64, divisor: u128) -> u128 {
    let (lead, low) = ((divisor >> 64) as u64, low_limb(divisor));
    let guess = low_limb((rest / u128::from(lead)).min(u128::from(u64::MAX)));
    let (product_low, carry) = multiply_add(guess, low, 0, 0);
    let (product_mid, product_high) = multiply_add(guess, lead, carry, 0);
    let (low, borrow) = borrowing_sub(limb, product_low, false);
    let (mid, borrow) = borrowing_sub(low_limb(rest), product_mid, borrow);
    let (mut high, _) = borrowing_sub((rest >> 64) as u64, product_high, borrow);
    let mut rest = u128::from(mid) << 64 | u128::from(low);
    // The guess is at most two too large, which makes the remainder negative.
    while high != 0 {
        let (sum, carry) = rest.overflowing_add(divisor);
        rest = sum;
        high = high.wrapping_add(u64::from(carry));
    }
    rest
}

/// The inverse of an odd integer modulo 2^64.
#[inline]
pub(super) const fn inverse_mod_limb(odd: u64) -> u64 {
    // The start is correct in its five low bits; each Newton step doubles the correct bits.
    let mut inverse = odd.wrapping_mul(3) ^ 2;
    let mut step = 0;
    while step < 4 {
        inverse = inverse.wrapping_mul(2u64.wrapping_sub(odd.wrapping_mul(inverse)));
        step += 1;
    }
    inverse
}

/// Subtracts `factor * digit` from an integer in little-endian limbs, modulo 2 to the power of its width.
#[inline]
pub(super) fn subtract_multiple(number: &mut [u64], factor: u128, digit: u64) {
    let factor = [low_limb(factor), (factor >> 64) as u64];
    let (mut carry, mut borrow) = (0, false);
    for (i, limb) in number.iter_mut().enumerate() {
        let (low, high) = multiply_add(factor.get(i).copied().unwrap_or(0), digit, carry, 0);
        carry = high;
        (*limb, borrow) = borrowing_sub(*limb, low, borrow);
    }
}

/// The number of significant bits of an unsigned integer; 0 for zero.
#[inline]
pub(super) fn bit_length<const N: usize>(limbs: &[u64; N]) -> u32 {
    limbs
        .iter()
        .rposition(|&limb| limb != 0)
        .map_or(0, |i| 64 * (as_number(i) + 1) - limbs[i].leading_zeros())
}

/// The 64 bits of an integer from bit `start` on; bits outside the integer are zero.
#[inline]
pub(super) fn limb_at<const N: usize>(limbs: &[u64; N], start: i32) -> u64 {
    let limb = |i: i32| {
        usize::try_from(i)
            .ok()
            .and_then(|i| limbs.get(i))
            .copied()
            .unwrap_or(0)
    };
    let (index, offset) = (start.div_euclid(64), start.rem_euclid(64));
    let pair = u128::from(limb(index + 1)) << 64 | u128::from(limb(index));
    low_limb(pair >> offset)
}

/// Return whether any bit of an integer below bit `end` is set.
#[inline]
pub(super) fn any_bit_below<const N: usize>(limbs: &[u64; N], end: i32) -> bool {
    let end = usize::try_from(end).unwrap_or(0);
    let whole = limbs[..(end / 64).min(N)].iter().any(|&limb| limb != 0);
    whole
        || limbs
            .get(end / 64)
            .is_some_and(|&limb| limb & ((1 << (end % 64)) - 1) != 0)
}
