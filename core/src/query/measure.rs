//! Exact measures.

use num_bigint::{BigInt, Sign};
use num_integer::Integer;

use crate::arith::{inv_mod, mul_mod, ratio_to_f64, Int, P1, P2};
use crate::error::Result;
use crate::extract::assemble::{assemble, Corner, ExactMesh};
use crate::geometry::fixed::FLUX_PLACES;
use crate::geometry::plane::Lattice;
use crate::geometry::vertex::Homogeneous;
use crate::tree::flux::share;
use crate::tree::solid::Solid;

/// An exact fraction, the denominator positive; in lowest terms unless it is very long.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fraction {
    /// The numerator.
    pub numerator: BigInt,
    /// The positive denominator.
    pub denominator: BigInt,
}

/// The exact volume in cubic model units.
///
/// A sum over faces, never over cells: integers for lattice triangles, fractions for the others,
/// added pairwise so that the operands stay of similar length.
///
/// # Errors
/// `Unbounded`.
pub fn volume(solid: &Solid) -> Result<Fraction> {
    let mesh = assemble(solid)?;
    let (whole, cut) = shares(solid, &mesh);
    let mut cut: Vec<(BigInt, BigInt)> = cut.collect();
    cut.push((big(&whole), BigInt::from(1)));
    let (numerator, denominator) = pairwise_sum(cut);
    Ok(in_units(
        numerator,
        denominator * 6,
        solid.pitch().exponent(),
    ))
}

/// The volume in cubic model units as the nearest double, from what the tree's nodes have kept.
///
/// The cost is that of what changed since a solid was asked that shares nodes with this one. `None`
/// if the bound on the error leaves a choice of doubles, or if the boundary may be unbounded; then
/// [`volume_near`] tells.
pub fn volume_rounded(solid: &Solid) -> Option<f64> {
    let share = share(solid.root());
    if solid.root().outside > 0 || share.open {
        return None;
    }
    let ends = share.flux.ends()?;
    let [low, high] = ends.map(|flux| flux_in_units(&flux, solid.pitch().exponent()));
    low.filter(|_| low == high)
}

/// A flux as a volume in model units, if no number gets too long.
fn flux_in_units(flux: &Int<6>, exponent: i64) -> Option<f64> {
    const LONGEST: u64 = 25;
    let size = exponent.unsigned_abs();
    let power = (0..3 * size.min(LONGEST)).fold(Int::<4>::ONE, |p, _| p.mul_i64(10));
    let units = Int::<3>::from_limbs([0, 0, 6 << (FLUX_PLACES - 128)]);
    let ratio = if exponent < 0 {
        ratio_to_f64(flux, &units.mul::<4, 7>(&power))
    } else {
        ratio_to_f64(&flux.mul::<4, 10>(&power), &units)
    };
    (size <= LONGEST).then_some(ratio)
}

/// Binary places that [`volume_near`] keeps of each cut triangle's share, in cubic steps.
const PLACES: usize = 128;

/// The volume in cubic model units to within 2^-128 cubic steps for each cut triangle.
///
/// The shares of lattice triangles are exact integers, those of the others are rounded down once:
/// an error far below what a double can hold, at a cost that does not grow with the square of the
/// number of cut faces as that of the exact sum does.
///
/// # Errors
/// `Unbounded`.
pub fn volume_near(solid: &Solid) -> Result<Fraction> {
    let mesh = assemble(solid)?;
    let (whole, cut) = shares(solid, &mesh);
    let rounded: BigInt = cut.map(|(n, d)| (n << PLACES).div_floor(&d)).sum();
    let sum = (big(&whole) << PLACES) + rounded;
    let denominator = BigInt::from(6) << PLACES;
    Ok(in_units(sum, denominator, solid.pitch().exponent()))
}

/// Six times the exact volume in cubic steps, modulo the primes 2^61 − 1 and 2^61 − 31.
///
/// Sums of exact volumes can be compared by these at the cost of one pass: two different sums agree
/// by chance 2^-122. `None` if a denominator is a multiple of a prime.
///
/// # Errors
/// `Unbounded`.
pub fn volume_residues(solid: &Solid) -> Result<Option<[u64; 2]>> {
    let mesh = assemble(solid)?;
    let (whole, cut) = shares(solid, &mesh);
    let cut: Vec<(BigInt, BigInt)> = cut.collect();
    let residue = |p: u64| {
        let of = |n: &BigInt| {
            let r = n.mod_floor(&BigInt::from(p));
            u64::try_from(r).unwrap_or(0)
        };
        cut.iter().try_fold(of(&big(&whole)), |sum, (n, d)| {
            let d = of(d);
            let share = mul_mod(of(n), inv_mod(d, p), p);
            (d != 0).then_some((sum + share) % p)
        })
    };
    Ok(residue(P1).and_then(|a| Some([a, residue(P2)?])))
}

/// Six times the volume over all triangles: the lattice triangles' sum, and the others' fractions.
fn shares<'a>(
    solid: &'a Solid,
    mesh: &'a ExactMesh,
) -> (Int<4>, impl Iterator<Item = (BigInt, BigInt)> + 'a) {
    let corners = |t: &[u32; 3]| t.map(|v| lattice(solid, mesh, v));
    let whole = mesh.triangles.iter().filter_map(move |t| match corners(t) {
        [Some(a), Some(b), Some(c)] => Some(determinant(&a, &b, &c)),
        _ => None,
    });
    let mut sum = Int::<4>::ZERO;
    whole.for_each(|d| sum += d);
    let cut = mesh
        .triangles
        .iter()
        .filter(move |t| corners(t).iter().any(Option::is_none))
        .map(move |t| fraction_of(&t.map(|v| homogeneous(solid, mesh, v))));
    (sum, cut)
}

fn lattice(solid: &Solid, mesh: &ExactMesh, vertex: u32) -> Option<Lattice> {
    match mesh.vertices[vertex as usize] {
        Corner::Source(slot, index) => {
            Some(solid.sources().get(slot as usize).mesh()?.vertices[index as usize])
        }
        Corner::Point(point) => mesh.table.point(point).as_lattice().copied(),
    }
}

pub(super) fn homogeneous(solid: &Solid, mesh: &ExactMesh, vertex: u32) -> Homogeneous {
    if let Some(p) = lattice(solid, mesh, vertex) {
        return Homogeneous {
            x: p.map(Int::from_i64),
            w: Int::ONE,
        };
    }
    match mesh.vertices[vertex as usize] {
        Corner::Point(point) => mesh.table.point(point).coordinates(),
        Corner::Source(..) => Homogeneous {
            x: [Int::ZERO; 3],
            w: Int::ONE,
        },
    }
}

/// Six times the volume of the tetrahedron from the origin.
fn determinant(a: &Lattice, b: &Lattice, c: &Lattice) -> Int<4> {
    let minor = |i: usize, j: usize| {
        i128::from(b[i]) * i128::from(c[j]) - i128::from(b[j]) * i128::from(c[i])
    };
    let term = |i: usize, m: i128| -> Int<4> { Int::<2>::from_i128(m).mul_i64(a[i]) };
    term(0, minor(1, 2)) + term(1, minor(2, 0)) + term(2, minor(0, 1))
}

fn fraction_of(corners: &[Homogeneous; 3]) -> (BigInt, BigInt) {
    let [a, b, c] = corners;
    let x = |h: &Homogeneous, i: usize| big(&h.x[i]);
    let minor = |i: usize, j: usize| x(b, i) * x(c, j) - x(b, j) * x(c, i);
    let value = x(a, 0) * minor(1, 2) + x(a, 1) * minor(2, 0) + x(a, 2) * minor(0, 1);
    lowest(value, big(&a.w) * big(&b.w) * big(&c.w))
}

/// Fractions longer than this many bits are left as they are: the divisor would cost more to find
/// than it saves.
const REDUCED: u64 = 4096;

fn reduced(numerator: BigInt, denominator: BigInt) -> (BigInt, BigInt) {
    if denominator.bits() > REDUCED {
        return (numerator, denominator);
    }
    lowest(numerator, denominator)
}

fn lowest(numerator: BigInt, denominator: BigInt) -> (BigInt, BigInt) {
    let g = numerator.gcd(&denominator);
    if g == BigInt::from(1) || g == BigInt::ZERO {
        return (numerator, denominator);
    }
    (numerator / &g, denominator / g)
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

/// Cubic lattice steps to cubic model units.
fn in_units(numerator: BigInt, denominator: BigInt, exponent: i64) -> Fraction {
    in_powers(numerator, denominator, exponent, 3)
}

/// A power of lattice steps to that power of model units.
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

/// The integer without a bound on its width.
pub fn big<const N: usize>(value: &Int<N>) -> BigInt {
    let size = value.abs();
    let digits: Vec<u32> = size
        .limbs()
        .iter()
        .flat_map(|l| [*l as u32, (*l >> 32) as u32])
        .collect();
    let sign = if value.is_negative() {
        Sign::Minus
    } else {
        Sign::Plus
    };
    BigInt::from_slice(sign, &digits)
}
