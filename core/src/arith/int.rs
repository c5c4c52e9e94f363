//! Signed integers of a fixed number of limbs.

use super::convert::low_limb;
use super::limbs::{
    bit_length, inverse_mod_limb, remainder_long, remainder_short, subtract_masked,
    subtract_multiple, unsigned_product, MAX_TRUNCATED_LIMBS,
};
use super::modular;
use super::round;
use super::sign::Sign;

/// A signed integer of `N` 64-bit limbs, in two's complement.
///
/// The limbs are little-endian. Arithmetic is exact: callers choose widths by [`bounds`](super::bounds) so
/// that results fit, and an operation whose result does not fit panics, in every build. A product with at
/// least as many limbs as both factors together always fits.
///
/// Values are meant to stay within the symmetric range |x| < 2^(64 `N` − 1).
///
/// # Example
/// ```
/// use bspcsg::arith::{Int, Sign};
///
/// // A product of two integers of two limbs fits four.
/// let big = Int::<2>::from_i128(1 << 100);
/// let square: Int<4> = big.mul(&big);
/// assert_eq!(square.bit_length(), 201);
/// assert_eq!((square - square).sign(), Sign::Zero);
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Int<const N: usize> {
    limbs: [u64; N],
}

impl<const N: usize> Int<N> {
    /// The width of the integer in bits, the sign bit included.
    #[allow(clippy::cast_possible_truncation, reason = "a small constant")]
    pub const BITS: u32 = 64 * N as u32;

    /// Zero.
    pub const ZERO: Self = Self { limbs: [0; N] };

    /// One.
    pub const ONE: Self = Self::from_i64(1);

    /// The integer with the given little-endian two's complement limbs.
    #[inline]
    pub const fn from_limbs(limbs: [u64; N]) -> Self {
        Self { limbs }
    }

    /// The limbs of the integer, little-endian, in two's complement.
    #[inline]
    pub const fn limbs(&self) -> &[u64; N] {
        &self.limbs
    }

    /// The integer equal to `value`.
    #[inline]
    pub const fn from_i64(value: i64) -> Self {
        const { assert!(N >= 1) };
        let mut limbs = [(value >> 63).cast_unsigned(); N];
        limbs[0] = value.cast_unsigned();
        Self { limbs }
    }

    /// The integer equal to `value`; `N` must be at least 2.
    #[inline]
    pub const fn from_i128(value: i128) -> Self {
        const { assert!(N >= 2) };
        let mut limbs = [low_limb((value >> 127).cast_unsigned()); N];
        limbs[0] = low_limb(value.cast_unsigned());
        limbs[1] = low_limb((value >> 64).cast_unsigned());
        Self { limbs }
    }

    /// The same integer in `M >= N` limbs.
    #[inline]
    pub const fn widen<const M: usize>(&self) -> Int<M> {
        const { assert!(M >= N) };
        self.resize()
    }

    /// The same integer in `M <= N` limbs, or `None` if it does not fit.
    #[inline]
    pub fn narrow<const M: usize>(&self) -> Option<Int<M>> {
        const { assert!(M <= N) };
        let low: Int<M> = self.resize();
        (low.resize::<N>() == *self).then_some(low)
    }

    /// The integer as an `i128`, or `None` if it does not fit.
    #[inline]
    pub fn to_i128(&self) -> Option<i128> {
        let low: Int<2> = self.resize();
        let fits = N <= 2 || low.resize::<N>() == *self;
        fits.then_some(i128::from(low.limbs[1]) << 64 | i128::from(low.limbs[0]))
    }

    /// Sign-extends to or truncates to `M` limbs.
    #[inline]
    const fn resize<const M: usize>(&self) -> Int<M> {
        let mut limbs = [self.sign_limb(); M];
        let mut i = 0;
        while i < N && i < M {
            limbs[i] = self.limbs[i];
            i += 1;
        }
        Int { limbs }
    }

    /// A limb of 64 ones if the integer is negative, else 0.
    #[inline]
    const fn sign_limb(&self) -> u64 {
        (self.limbs[N - 1].cast_signed() >> 63).cast_unsigned()
    }

    /// The sign of the integer.
    #[inline]
    pub fn sign(&self) -> Sign {
        if self.is_negative() {
            Sign::Negative
        } else if self.is_zero() {
            Sign::Zero
        } else {
            Sign::Positive
        }
    }

    /// Return whether the integer is zero.
    #[inline]
    pub fn is_zero(&self) -> bool {
        self.limbs.iter().fold(0, |all, limb| all | limb) == 0
    }

    /// Return whether the integer is below zero.
    #[inline]
    pub const fn is_negative(&self) -> bool {
        self.limbs[N - 1].cast_signed() < 0
    }

    /// The absolute value of the integer.
    ///
    /// # Panics
    /// If the integer is −2^(64 `N` − 1), whose absolute value does not fit.
    #[inline]
    #[must_use]
    pub fn abs(self) -> Self {
        assert!(!self.is_minimum(), "the absolute value overflows");
        Self {
            limbs: self.magnitude(),
        }
    }

    /// Return whether the integer is −2^(64 `N` − 1), whose negative does not fit.
    #[inline]
    fn is_minimum(&self) -> bool {
        self.limbs[N - 1] == 1 << 63 && self.limbs[..N - 1].iter().all(|&limb| limb == 0)
    }

    /// The absolute value as unsigned little-endian limbs; correct for every integer, the least included.
    #[inline]
    pub(super) fn magnitude(&self) -> [u64; N] {
        let sign = self.sign_limb();
        let mut limbs = self.limbs;
        let mut carry = sign & 1;
        for limb in &mut limbs {
            let (flipped, overflow) = (*limb ^ sign).overflowing_add(carry);
            *limb = flipped;
            carry = u64::from(overflow);
        }
        limbs
    }

    /// The number of significant bits of the absolute value; 0 for zero.
    #[inline]
    pub fn bit_length(&self) -> u32 {
        bit_length(&self.magnitude())
    }

    /// The double nearest to the integer, ties to even; infinite where the integer exceeds the doubles.
    #[inline]
    pub fn to_f64(&self) -> f64 {
        let nearest = round::limbs_to_f64(&self.magnitude());
        if self.is_negative() {
            -nearest
        } else {
            nearest
        }
    }

    /// The product with `other`, in `R` limbs.
    ///
    /// The product must lie in the symmetric range of `R` limbs; for `R >= N + B` it always fits.
    ///
    /// # Panics
    /// If the product does not fit into `R` limbs.
    #[inline]
    #[must_use]
    #[allow(
        clippy::should_implement_trait,
        reason = "the width of the product is the caller's choice"
    )]
    pub fn mul<const B: usize, const R: usize>(self, other: &Int<B>) -> Int<R> {
        const { assert!(R + MAX_TRUNCATED_LIMBS >= N + B) };
        let (mut product, mut top) = unsigned_product::<N, B, R>(&self.limbs, &other.limbs);
        subtract_masked(&mut product, &mut top, N, &other.limbs, self.sign_limb());
        subtract_masked(&mut product, &mut top, B, &self.limbs, other.sign_limb());
        if R > N + B {
            let sign = (product[N + B - 1].cast_signed() >> 63).cast_unsigned();
            product[N + B..].fill(sign);
        }
        let product = Int { limbs: product };
        let sign = product.sign_limb();
        if R < N + B && top[..N + B - R].iter().any(|limb| *limb != sign) {
            panic_on_overflow("a product", R);
        }
        product
    }

    /// The product with an `i64`, in `R` limbs; panics if it does not fit.
    #[inline]
    #[must_use]
    pub fn mul_i64<const R: usize>(self, other: i64) -> Int<R> {
        self.mul(&Int::<1>::from_i64(other))
    }

    /// The product with an `i128`, in `R` limbs; panics if it does not fit.
    #[inline]
    #[must_use]
    pub fn mul_i128<const R: usize>(self, other: i128) -> Int<R> {
        self.mul(&Int::<2>::from_i128(other))
    }

    /// The residue of the integer modulo `p`, in `0..p`; `p` is [`P1`](super::P1) or [`P2`](super::P2).
    #[inline]
    pub fn rem_u61(&self, p: u64) -> u64 {
        let top = self.limbs[N - 1].cast_signed();
        let lead = modular::reduce_mod(u128::from(top.unsigned_abs()), p);
        let mut residue = if top < 0 && lead != 0 { p - lead } else { lead };
        for &limb in self.limbs[..N - 1].iter().rev() {
            residue = modular::push_limb(residue, limb, p);
        }
        residue
    }

    /// The remainder of the absolute value on division by `divisor`, which is not zero.
    ///
    /// # Panics
    /// If `divisor` is zero.
    #[inline]
    pub fn rem_u128(&self, divisor: u128) -> u128 {
        assert!(divisor != 0, "division by zero");
        match u64::try_from(divisor) {
            Ok(short) => u128::from(remainder_short(&self.magnitude(), short)),
            Err(_) => remainder_long(&self.magnitude(), divisor),
        }
    }

    /// The quotient by `divisor`, which must be nonzero and divide the integer without remainder.
    #[inline]
    #[must_use]
    pub fn div_exact_u128(&self, divisor: u128) -> Self {
        debug_assert!(self.rem_u128(divisor) == 0, "the division is not exact");
        let twos = divisor.trailing_zeros();
        let odd = divisor >> twos;
        let mut rest = self.shift_right(twos).limbs;
        let inverse = inverse_mod_limb(low_limb(odd));
        for i in 0..N {
            let digit = rest[i].wrapping_mul(inverse);
            subtract_multiple(&mut rest[i..], odd, digit);
            rest[i] = digit;
        }
        Self { limbs: rest }
    }

    /// The integer divided by 2^`bits` and rounded down, for `bits < 128`.
    #[inline]
    fn shift_right(&self, bits: u32) -> Self {
        let (whole, part) = ((bits / 64) as usize, bits % 64);
        let limb = |i: usize| self.limbs.get(i).copied().unwrap_or(self.sign_limb());
        let limbs = std::array::from_fn(|i| {
            let pair = u128::from(limb(i + whole + 1)) << 64 | u128::from(limb(i + whole));
            low_limb(pair >> part)
        });
        Self { limbs }
    }
}

/// Panics with the message that `what` does not fit into `limbs` limbs.
#[cold]
#[inline(never)]
pub(super) fn panic_on_overflow(what: &str, limbs: usize) -> ! {
    panic!("{what} exceeds {limbs} limbs")
}
