//! Volumes of solids: exact, in doubles, and modulo primes.

use num_bigint::BigInt;

use super::exact::lowest;
use super::shares::Shares;
use crate::arith::{ratio_to_f64, Int, P1, P2};
use crate::error::{Error, ErrorKind, Result};
use crate::extract::assemble::assemble;
use crate::geometry::flux::fixed::FLUX_FRACTION_BITS;
use crate::tree::flux::share;
use crate::tree::solid::Solid;

/// An exact fraction; it is in lowest terms unless it is very long.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fraction {
    /// The numerator.
    pub numerator: BigInt,
    /// The positive denominator.
    pub denominator: BigInt,
}

/// Returns the exact volume of a solid in cubic model units.
///
/// # Errors
/// `Unbounded`.
pub fn volume(solid: &Solid) -> Result<Fraction> {
    volume_within(solid, u64::MAX)
}

/// Returns the exact volume in cubic model units, unless its denominator may be too long.
///
/// Sums over faces: integers for triangles with lattice corners, fractions for all others.
///
/// # Errors
/// `Unbounded`; `TooMany` if the denominator may have more than `most_bits` bits.
pub fn volume_within(solid: &Solid, most_bits: u64) -> Result<Fraction> {
    let mesh = assemble(solid)?;
    let shares = Shares::of(solid, &mesh);
    let bits = shares.denominator_bits();
    if bits > most_bits {
        return Err(too_long(bits, most_bits));
    }
    let (numerator, denominator) = shares.sum();
    Ok(in_units(
        numerator,
        denominator * 6,
        solid.pitch().exponent(),
    ))
}

fn too_long(bits: u64, most_bits: u64) -> Error {
    // The decimal logarithm of 2 is 0.30103, to within 10^-8.
    let digits = |bits: u64| u128::from(bits) * 30_103 / 100_000;
    let text = format!(
        "the exact volume is a fraction of up to {} digits, more than the limit of {}; use the rounded \
         volume instead",
        digits(bits),
        digits(most_bits)
    );
    Error::at(ErrorKind::TooMany, vec![bits], text)
}

/// Returns the volume in cubic model units as the nearest double, from sums that the tree's nodes cache.
///
/// Visits only nodes that are not shared with a solid whose volume was already computed. `None` if more than
/// one double lies within the error bound, or if the boundary may be unbounded; [`volume_near`] then gives
/// the volume.
pub fn volume_rounded(solid: &Solid) -> Option<f64> {
    let share = share(solid.root());
    if solid.root().outside > 0 || share.open {
        return None;
    }
    let ends = share.flux.ends()?;
    let [low, high] = ends.map(|flux| flux_in_units(&flux, solid.pitch().exponent()));
    low.filter(|_| low == high)
}

/// Converts six times a volume in fixed-point cubic steps to model units; `None` if the exponent is too
/// large.
fn flux_in_units(flux: &Int<6>, exponent: i64) -> Option<f64> {
    const MAX_EXPONENT: u64 = 25;
    let size = exponent.unsigned_abs();
    let power = (0..3 * size.min(MAX_EXPONENT)).fold(Int::<4>::ONE, |p, _| p.mul_i64(10));
    let units = Int::<3>::from_limbs([0, 0, 6 << (FLUX_FRACTION_BITS - 128)]);
    let ratio = if exponent < 0 {
        ratio_to_f64(flux, &units.mul::<4, 7>(&power))
    } else {
        ratio_to_f64(&flux.mul::<4, 10>(&power), &units)
    };
    (size <= MAX_EXPONENT).then_some(ratio)
}

/// [`volume_near`] rounds the contribution of each cut triangle to the volume to this many binary places, in
/// cubic steps.
const BINARY_PLACES: usize = 128;

/// Returns the volume in cubic model units, accurate to 2^-128 cubic steps for each cut triangle.
///
/// Each triangle contributes the volume of its tetrahedron with the origin: an exact integer if its corners
/// are lattice points, else a fraction that is rounded down once. The error is far below a double's
/// precision, and the cost, unlike that of the exact sum, does not grow with the square of the number of cut
/// faces.
///
/// # Errors
/// `Unbounded`.
pub fn volume_near(solid: &Solid) -> Result<Fraction> {
    let mesh = assemble(solid)?;
    let shares = Shares::of(solid, &mesh);
    let rounded: BigInt = shares.near(BINARY_PLACES).sum();
    let sum = (shares.whole << BINARY_PLACES) + rounded;
    let denominator = BigInt::from(6) << BINARY_PLACES;
    Ok(in_units(sum, denominator, solid.pitch().exponent()))
}

/// Returns six times the exact volume in cubic steps, modulo the primes 2^61 − 1 and 2^61 − 31.
///
/// Serves to compare sums of exact volumes: two different sums agree with probability 2^-122. `None` if a
/// denominator is a multiple of a prime.
///
/// # Errors
/// `Unbounded`.
pub fn volume_residues(solid: &Solid) -> Result<Option<[u64; 2]>> {
    let mesh = assemble(solid)?;
    let shares = Shares::of(solid, &mesh);
    Ok(shares
        .modulo(P1)
        .and_then(|a| Some([a, shares.modulo(P2)?])))
}

/// A fraction with a denominator longer than this many bits is not reduced: finding the common divisor would
/// cost more than it saves.
const MAX_BITS_REDUCED: u64 = 4096;

fn reduced(numerator: BigInt, denominator: BigInt) -> (BigInt, BigInt) {
    if denominator.bits() > MAX_BITS_REDUCED {
        return (numerator, denominator);
    }
    lowest(numerator, denominator)
}

pub(super) fn pairwise_sum(mut terms: Vec<(BigInt, BigInt)>) -> (BigInt, BigInt) {
    while terms.len() > 1 {
        terms = terms
            .chunks(2)
            .map(|pair| match pair {
                [(a, b), (c, d)] if b == d => reduced(a + c, b.clone()),
                [(a, b), (c, d)] => reduced(a * d + c * b, b * d),
                rest => rest[0].clone(),
            })
            .collect();
    }
    terms.pop().unwrap_or((BigInt::ZERO, BigInt::from(1)))
}

/// Converts a volume from cubic lattice steps to cubic model units.
fn in_units(numerator: BigInt, denominator: BigInt, exponent: i64) -> Fraction {
    in_powers(numerator, denominator, exponent, 3)
}

/// Converts a length, area or volume (`dimension` 1, 2 or 3) from lattice steps to model units.
pub fn in_powers(
    numerator: BigInt,
    denominator: BigInt,
    exponent: i64,
    dimension: u32,
) -> Fraction {
    let power = BigInt::from(10).pow(dimension * exponent.unsigned_abs() as u32);
    let (n, d) = if exponent < 0 {
        (numerator, denominator * power)
    } else {
        (numerator * power, denominator)
    };
    let (numerator, denominator) = reduced(n, d);
    Fraction {
        numerator,
        denominator,
    }
}
