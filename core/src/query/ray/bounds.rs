//! The widths of the exact numbers of ray casting, derived as in `arith::bounds`.
//!
//! Notation: `p` bounds a lattice coordinate, so that corners relative to a ray's origin are below
//! 2^(p + 1). Determinants with entries in [−1, 1] are at most 2 (order 2) and 4 (order 3).

use crate::arith::bounds::{limbs_for, COORDINATE_BITS};

/// Components of a ray's direction are below 2^`DIRECTION_BITS` in magnitude.
///
/// A double has 53 bits; the rest keeps components that are up to 2^60 times smaller exact.
pub const DIRECTION_BITS: u32 = 113;

/// Limbs of the numerator of a ray's parameter at a facet.
pub const NUMERATOR_LIMBS: usize = 3;

/// Limbs of the denominator of a ray's parameter at a facet, and of the weights of corners that add up to
/// it.
pub const DENOMINATOR_LIMBS: usize = 4;

/// Limbs of the product of one parameter's numerator with another's denominator, for comparing them.
pub const COMPARE_LIMBS: usize = 7;

/// Limbs of the weights of a facet's corners if the ray runs in the facet's hyperplane.
pub const WEIGHT_LIMBS: usize = 5;

/// The bits of the largest power of ten by which a lattice step scales.
const PITCH_BITS: u32 = 74;

const fn det2(columns: [u32; 2]) -> u32 {
    columns[0] + columns[1] + 1
}

const fn det3(columns: [u32; 3]) -> u32 {
    columns[0] + columns[1] + columns[2] + 2
}

/// The bits of a corner's weight, a determinant of the direction and two relative corners.
pub const fn weight(p: u32) -> u32 {
    det3([DIRECTION_BITS, p + 1, p + 1])
}

/// The bits of the sum of three weights.
pub const fn denominator(p: u32) -> u32 {
    weight(p) + 2
}

/// The bits of the determinant of three relative corners.
pub const fn numerator(p: u32) -> u32 {
    det3([p + 1, p + 1, p + 1])
}

/// The bits of the products by which two parameters are compared.
pub const fn comparison(p: u32) -> u32 {
    numerator(p) + denominator(p)
}

/// The bits of a corner's weight at the origin of a ray in the facet's plane.
pub const fn value_within(p: u32) -> u32 {
    det2([p + 1, p + 1])
}

/// The bits of the change of a corner's weight along a ray in the facet's plane.
pub const fn slope_within(p: u32) -> u32 {
    det2([DIRECTION_BITS, p + 2])
}

/// The bits of a corner's weight at a parameter along a ray in the facet's plane, times the denominator.
pub const fn weight_within(p: u32) -> u32 {
    value_within(p) + slope_within(p) + 1
}

const _: () = {
    const P: u32 = COORDINATE_BITS;
    assert!(limbs_for(numerator(P)) <= NUMERATOR_LIMBS);
    assert!(limbs_for(value_within(P)) <= NUMERATOR_LIMBS);
    assert!(limbs_for(denominator(P)) <= DENOMINATOR_LIMBS);
    assert!(limbs_for(slope_within(P)) <= NUMERATOR_LIMBS);
    assert!(limbs_for(comparison(P)) <= COMPARE_LIMBS);
    assert!(limbs_for(weight_within(P)) <= WEIGHT_LIMBS);
    assert!(limbs_for(numerator(P) + PITCH_BITS) <= NUMERATOR_LIMBS + 1);
    assert!(limbs_for(denominator(P) + PITCH_BITS) <= DENOMINATOR_LIMBS + 1);
};
