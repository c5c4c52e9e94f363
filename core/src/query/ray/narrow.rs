//! Computes the meeting of a ray and a triangle in 128-bit integers, and rounds it.
//!
//! The module `facet` computes the same numbers in wide integers; here they are exact if they fit into 128
//! bits. Quotients are computed from leading bits, which usually decide the rounding; otherwise, and for
//! wider numbers, the wide integers are used.
//!
//! # Widths
//! Let corners relative to the origin be below 2^p, p ≤ 41, and the direction below 2^q. Components
//! of their cross products are below 2^(2p + 1). A direction is split at 2^40: sums of three products
//! with the lower parts are below 2^(2p + 43) ≤ 2^125, with the higher ones below 2^(2p + q − 37), and
//! those of three weights below 2^(2p + q − 35) ≤ 2^126 for 2p + q ≤ 161. The determinant of the
//! corners is below 2^(3p + 3) ≤ 2^126.

use super::facet::{relative, Corners, Facet};
use super::line::Ray;
use crate::arith::leading::{Leading, SplitInteger, SPLIT_BITS};
use crate::mesh::grid::Pitch;

/// The largest p in the derivation of widths: the bits of a corner relative to the origin.
const CORNER_BITS: u32 = 41;

/// The largest 2p + q in the derivation of widths: twice the bits of a corner plus those of the direction.
const ALL_BITS: u32 = 161;

/// The largest exponent of a power of ten that fits into a 64-bit limb.
const LARGEST_POWER: u64 = 19;

/// The exact weights and the height of a ray that crosses a triangle's plane inside the triangle.
pub struct Narrow<const D: usize> {
    weights: [SplitInteger; D],
    /// The sum of the weights, positive.
    sum: Leading,
    height: i128,
}

impl<const D: usize> Narrow<D> {
    /// Computes the weights and the height of the point at which a ray meets a facet; `None` if the ray does
    /// not meet the facet or runs in its plane, or if numbers are too wide.
    #[inline]
    pub fn of(ray: &Ray<D>, facet: &Facet<D>) -> Option<Self> {
        let v = relative(ray, facet);
        if D != 3 || !fits(&v, ray) {
            return None;
        }
        let mut weights = [SplitInteger::new(0, 0); D];
        let mut height = 0i128;
        for i in 0..D {
            let normal = cross(&v[(i + 1) % D], &v[(i + 2) % D]);
            weights[i] = dot(ray.direction(), &normal);
            if i == 0 {
                for k in 0..D {
                    let term = normal[k].wrapping_mul(i128::from(v[0][k]));
                    height = height.wrapping_add(term);
                }
            }
        }
        let mut sum = total(&weights);
        if sum.is_negative() {
            for weight in &mut weights {
                *weight = weight.negated();
            }
            sum = sum.negated();
            height = -height;
        }
        let meets = height >= 0 && !sum.is_zero() && !weights.iter().any(SplitInteger::is_negative);
        meets.then(|| Self {
            weights,
            sum: sum.leading(),
            height,
        })
    }

    /// Returns the barycentric weights, correctly rounded; `None` if their leading bits do not decide the
    /// rounding.
    #[inline]
    pub fn weights(&self) -> Option<[f64; D]> {
        let mut rounded = [0.0; D];
        for (rounded, weight) in rounded.iter_mut().zip(&self.weights) {
            if !weight.is_zero() {
                *rounded = weight.leading().over(&self.sum)?;
            }
        }
        Some(rounded)
    }

    /// Returns how many weights are zero.
    #[inline]
    pub fn zeros(&self) -> usize {
        self.weights.iter().filter(|w| w.is_zero()).count()
    }

    /// Returns the parameter along the ray in model units, correctly rounded; `None` if the leading bits of
    /// its numbers do not decide the rounding.
    #[inline]
    pub fn parameter(&self, pitch: Pitch) -> Option<f64> {
        if self.height == 0 {
            return Some(0.0);
        }
        let height = Leading::of(self.height.unsigned_abs());
        let power = pitch.exponent().unsigned_abs();
        if power > LARGEST_POWER {
            return None;
        }
        let ten = 10u64.pow(power as u32);
        if pitch.exponent() < 0 {
            height.over(&self.sum.times(ten))
        } else {
            height.times(ten).over(&self.sum)
        }
    }
}

/// Returns true if all numbers fit into 128 bits, by the derivation at the head of this file.
#[inline]
fn fits<const D: usize>(v: &Corners<D>, ray: &Ray<D>) -> bool {
    let all = v.iter().flatten().fold(0, |all, c| all | c.unsigned_abs());
    let corner = u64::BITS - all.leading_zeros();
    let lead = ray.direction()[ray.near.main].unsigned_abs();
    corner <= CORNER_BITS && 2 * corner + u128::BITS - lead.leading_zeros() <= ALL_BITS
}

#[inline]
fn cross<const D: usize>(a: &[i64; D], b: &[i64; D]) -> [i128; D] {
    let product = |x: i64, y: i64| i128::from(x).wrapping_mul(i128::from(y));
    let mut normal = [0; D];
    for (k, c) in normal.iter_mut().enumerate() {
        let (i, j) = ((k + 1) % D, (k + 2) % D);
        *c = product(a[i], b[j]).wrapping_sub(product(a[j], b[i]));
    }
    normal
}

#[inline]
fn dot<const D: usize>(direction: &[i128; D], normal: &[i128; D]) -> SplitInteger {
    let (mut high, mut low) = (0i128, 0i128);
    for (d, n) in direction.iter().zip(normal) {
        high = high.wrapping_add((d >> SPLIT_BITS).wrapping_mul(*n));
        low = low.wrapping_add((d & ((1 << SPLIT_BITS) - 1)).wrapping_mul(*n));
    }
    SplitInteger::new(high, low)
}

#[inline]
fn total<const D: usize>(weights: &[SplitInteger; D]) -> SplitInteger {
    let mut sum = weights[0];
    for weight in &weights[1..] {
        sum = sum.plus(weight);
    }
    sum
}
