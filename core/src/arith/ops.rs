//! Arithmetic operators, order and display of [`Int`].

use std::cmp::Ordering;
use std::fmt;
use std::ops::{Add, AddAssign, Neg, Sub, SubAssign};

use super::int::panic_on_overflow;
use super::limbs::{borrowing_sub, carrying_add};
use super::Int;

impl<const N: usize> Add for Int<N> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        let (ours, theirs) = (self.limbs(), other.limbs());
        let mut limbs = [0; N];
        let mut carry = false;
        // The compiler unrolls a loop over indices, but not one over three iterators at once.
        let mut i = 0;
        while i < N {
            (limbs[i], carry) = carrying_add(ours[i], theirs[i], carry);
            i += 1;
        }
        let (a, b, c) = (ours[N - 1], theirs[N - 1], limbs[N - 1]);
        // Both terms have the same sign, and the sum has the other.
        if ((a ^ c) & (b ^ c)).cast_signed() < 0 {
            panic_on_overflow("a sum", N);
        }
        Self::from_limbs(limbs)
    }
}

impl<const N: usize> Sub for Int<N> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        let (ours, theirs) = (self.limbs(), other.limbs());
        let mut limbs = [0; N];
        let mut borrow = false;
        // The compiler unrolls a loop over indices, but not one over three iterators at once.
        let mut i = 0;
        while i < N {
            (limbs[i], borrow) = borrowing_sub(ours[i], theirs[i], borrow);
            i += 1;
        }
        let (a, b, c) = (ours[N - 1], theirs[N - 1], limbs[N - 1]);
        // The terms differ in sign, and the difference has the wrong one.
        if ((a ^ b) & (a ^ c)).cast_signed() < 0 {
            panic_on_overflow("a difference", N);
        }
        Self::from_limbs(limbs)
    }
}

impl<const N: usize> Neg for Int<N> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self::ZERO - self
    }
}

impl<const N: usize> AddAssign for Int<N> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Int<N> {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const N: usize> Default for Int<N> {
    fn default() -> Self {
        Self::ZERO
    }
}

impl<const N: usize> Ord for Int<N> {
    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        let lead = self.limbs()[N - 1]
            .cast_signed()
            .cmp(&other.limbs()[N - 1].cast_signed());
        lead.then_with(|| self.limbs().iter().rev().cmp(other.limbs().iter().rev()))
    }
}

impl<const N: usize> PartialOrd for Int<N> {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<const N: usize> fmt::Debug for Int<N> {
    /// Writes the sign and the hexadecimal digits, as in `-0x1f`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let magnitude = self.magnitude();
        let lead = magnitude.iter().rposition(|&limb| limb != 0).unwrap_or(0);
        let sign = if self.is_negative() { "-" } else { "" };
        write!(f, "{sign}{:#x}", magnitude[lead])?;
        magnitude[..lead]
            .iter()
            .rev()
            .try_for_each(|limb| write!(f, "{limb:016x}"))
    }
}
