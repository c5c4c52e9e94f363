//! The flux of (0, 0, z) through the part of a triangle between the walls of a cell across one axis.
//!
//! Usually a triangle at the border of a cell is cut by one wall, or by two opposite ones. A wall separates
//! one corner from the two others: the flux through the part at this corner is computed from the fractions at
//! which the wall divides two edges, without computing new corners.

use super::fixed::{from_cubic_steps, over_limb, sixfold_flux, Flux, Walls, FRACTION_BITS};
use crate::arith::convert::as_double;
use crate::arith::Int;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Orientation;

/// The part of a triangle inside the walls of a cell.
#[derive(Clone, Copy, Debug)]
pub enum TrimmedFlux {
    /// The whole triangle.
    All,
    /// Part of the triangle, with six times the flux through that part.
    Part(Flux),
    /// No part of the triangle: all corners lie outside one wall.
    Nothing,
    /// Undecided: walls across several axes cut the triangle.
    Undecided,
}

/// Trims a lattice triangle by the walls of a cell; `area` is the z component of its normal, in lattice
/// steps.
pub fn trimmed(corners: &[Lattice; 3], area: i128, walls: &Walls) -> TrimmedFlux {
    let mut cuts = [None; 6];
    for (wall, cut) in cuts.iter_mut().enumerate() {
        let beyond = corners.map(|p| walls.half_steps_outside(wall, &p));
        match beyond.iter().filter(|b| **b > 0).count() {
            0 => {}
            3 => return TrimmedFlux::Nothing,
            _ => *cut = Some(beyond),
        }
    }
    let across = |axis: usize| cuts[2 * axis].is_some() || cuts[2 * axis + 1].is_some();
    match (0..3).filter(|axis| across(*axis)).count() {
        0 => TrimmedFlux::All,
        1 => TrimmedFlux::Part(flux_inside(corners, area, cuts.iter().flatten())),
        _ => TrimmedFlux::Undecided,
    }
}

/// Six times the flux through a triangle minus its parts outside walls that do not meet; each of `cuts` has,
/// for one wall, the distances of the three corners outside the wall, in half steps.
fn flux_inside<'a>(
    corners: &[Lattice; 3],
    area: i128,
    cuts: impl Iterator<Item = &'a [i64; 3]>,
) -> Flux {
    let all = from_cubic_steps(&sixfold_flux(corners));
    let mut rest = Flux {
        value: all,
        error: 0.0,
    };
    for beyond in cuts {
        let lone = lone_corner(beyond);
        let inside = beyond[lone] < 0;
        let corner = at_corner(corners, area, beyond, lone);
        rest.add(&corner, Orientation::turned_around(!inside));
        if inside {
            rest.value -= all;
        }
    }
    rest
}

/// The index of the corner that lies alone on its side of a wall.
fn lone_corner(beyond: &[i64; 3]) -> usize {
    match beyond.map(|b| b > 0) {
        [a, b, c] if b == c && a != b => 0,
        [a, b, c] if a == c && a != b => 1,
        _ => 2,
    }
}

/// The number of binary fraction digits of the fraction of an edge that [`share`] returns.
const SHARE_FRACTION_BITS: u32 = 104;

/// Six times the flux through the part of a triangle between its corner `lone` and a wall that separates this
/// corner from the others.
///
/// With the corner a and the fractions s and t of the edges to b and c before the wall, the result is the
/// triangle's `area` times s t (3 a + s (b − a) + t (c − a)), where a, b, c are heights z.
///
/// # Error
/// Let u be 2^-104, Z the largest |z|. Shares are off by u, their product by 2u + 2^-144, the sum
/// of heights by 4 Z u + 2^-72 and it is at most 3 Z: together area (10 Z u + 2^-71).
///
/// # Bits
/// Area and product of shares: 109 + 144. Heights: 55 + 72. Both: 380.
fn at_corner(corners: &[Lattice; 3], area: i128, beyond: &[i64; 3], lone: usize) -> Flux {
    let [a, b, c] = each_axis(|k| (lone + k) % 3);
    let [s, t] = [b, c].map(|end| share(beyond[a].unsigned_abs(), beyond[end].unsigned_abs()));
    let product: Int<4> = s.mul(&t);
    let [_, low, middle, high] = *product.limbs();
    let product: Int<3> = Int::from_limbs([low, middle, high]);
    let cut: Int<4> = Int::<2>::from_i128(area).mul(&product);
    let z = corners.map(|p| p[2]);
    let height = height(3 * z[a], [(s, z[b] - z[a]), (t, z[c] - z[a])]);
    let size = as_double(z.iter().map(|z| z.unsigned_abs()).max().unwrap_or(0));
    Flux {
        value: over_limb(&cut.mul_i128(height)),
        error: 1.0 + as_double(area.unsigned_abs()) * (size * 2f64.powi(52) + 2f64.powi(81)),
    }
}

/// Return the fraction of an edge before a wall, from the distances of both ends to the wall, in units of
/// 2^-[`SHARE_FRACTION_BITS`]; rounded down.
fn share(before: u64, behind: u64) -> Int<2> {
    let length = u128::from(before + behind);
    let dividend = u128::from(before) << (SHARE_FRACTION_BITS / 2);
    let (high, rest) = (dividend / length, dividend % length);
    let low = (rest << (SHARE_FRACTION_BITS / 2)) / length;
    Int::from_i128((high << (SHARE_FRACTION_BITS / 2) | low).cast_signed())
}

/// The height z `first` plus two fractions, each times the rise of z along an edge, in units of
/// 2^-`FRACTION_BITS` steps; rounded down.
fn height(first: i64, rises: [(Int<2>, i64); 2]) -> i128 {
    let mut sum: Int<3> = Int::<2>::from_i128(1 << SHARE_FRACTION_BITS).mul_i64(first);
    for (share, rise) in rises {
        sum += share.mul_i64(rise);
    }
    let [low, middle, high] = *sum.limbs();
    let shift = SHARE_FRACTION_BITS - FRACTION_BITS;
    let pair = |a: u64, b: u64| u128::from(a >> shift | b << (64 - shift));
    (pair(middle, high) << 64 | pair(low, middle)).cast_signed()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::cell::Cell;
    use crate::geometry::flux::fixed::minor;
    use crate::geometry::flux::fixed::{flux_through_ring, Triangle, FLUX_FRACTION_BITS};

    fn point(reach: i64) -> impl Strategy<Value = Lattice> {
        [-reach..=reach, -reach..=reach, -reach..=reach]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// Coordinates are few, so that triangle edges often run along walls.
        #[test]
        fn trimmed_triangles_have_the_flux_of_clipped_ones(
            corners in [point(12), point(12), point(12)],
            [p, q] in [point(9), point(9)],
            shift in prop::sample::select(vec![0, 1i64 << 20, 1 << 50]),
        ) {
            let low = each_axis(|i| p[i].min(q[i]) + shift);
            let high = each_axis(|i| p[i].max(q[i]) + shift);
            let corners = corners.map(|c| c.map(|x| x + shift));
            let normal = [(1, 2), (2, 0), (0, 1)].map(|(u, v)| minor(&corners, u, v));
            prop_assume!(normal[2] != 0);
            let walls = Walls::of(&Cell::around(&low, &high));
            let clipped = Triangle::new(&corners, normal).clipped(&walls);
            let expected = clipped.map_or(Int::ZERO, |ring| flux_through_ring(&ring));
            let flux = match trimmed(&corners, normal[2], &walls) {
                TrimmedFlux::All => Flux { value: from_cubic_steps(&sixfold_flux(&corners)), error: 0.0 },
                TrimmedFlux::Part(flux) => flux,
                TrimmedFlux::Nothing => Flux::ZERO,
                TrimmedFlux::Undecided => return Ok(()),
            };
            let gap = (flux.value - expected).to_f64().abs();
            // The corners of the clipped polygon are rounded to 2^-72 steps.
            let rounding = 2f64.powi(FLUX_FRACTION_BITS.cast_signed() - 60) * (1.0 + as_double(shift));
            prop_assert!(gap <= flux.error + rounding, "{} apart, {}", gap, flux.error);
        }
    }
}
