//! Exact measures.

use num_bigint::{BigInt, Sign};
use num_integer::Integer;

use crate::arith::Int;
use crate::error::Result;
use crate::extract::assemble::{assemble, Corner, ExactMesh};
use crate::geometry::plane::Lattice;
use crate::geometry::vertex::Homogeneous;
use crate::tree::solid::Solid;

/// An exact fraction in lowest terms, the denominator positive.
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
    let mut whole = Int::<4>::ZERO;
    let mut cut = Vec::new();
    for triangle in &mesh.triangles {
        match triangle.map(|v| lattice(solid, &mesh, v)) {
            [Some(a), Some(b), Some(c)] => whole += determinant(&a, &b, &c),
            _ => cut.push(fraction_of(&triangle.map(|v| homogeneous(solid, &mesh, v)))),
        }
    }
    cut.push((big(&whole), BigInt::from(1)));
    let (numerator, denominator) = pairwise_sum(cut);
    Ok(in_units(
        numerator,
        denominator * 6,
        solid.pitch().exponent(),
    ))
}

fn lattice(solid: &Solid, mesh: &ExactMesh, vertex: u32) -> Option<Lattice> {
    match mesh.vertices[vertex as usize] {
        Corner::Source(slot, index) => {
            Some(solid.sources()[slot as usize].mesh()?.vertices[index as usize])
        }
        Corner::Point(point) => mesh.table.point(point).as_lattice().copied(),
    }
}

fn homogeneous(solid: &Solid, mesh: &ExactMesh, vertex: u32) -> Homogeneous {
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

fn lowest(numerator: BigInt, denominator: BigInt) -> (BigInt, BigInt) {
    let g = numerator.gcd(&denominator);
    if g == BigInt::from(1) || g == BigInt::ZERO {
        return (numerator, denominator);
    }
    (numerator / &g, denominator / g)
}

fn pairwise_sum(mut terms: Vec<(BigInt, BigInt)>) -> (BigInt, BigInt) {
    while terms.len() > 1 {
        terms = terms
            .chunks(2)
            .map(|pair| match pair {
                [(a, b), (c, d)] if b == d => lowest(a + c, b.clone()),
                [(a, b), (c, d)] => lowest(a * d + c * b, b * d),
                rest => rest[0].clone(),
            })
            .collect();
    }
    terms.pop().unwrap_or((BigInt::ZERO, BigInt::from(1)))
}

/// Cubic lattice steps to cubic model units, in lowest terms.
fn in_units(numerator: BigInt, denominator: BigInt, exponent: i64) -> Fraction {
    let power = BigInt::from(10).pow(3 * exponent.unsigned_abs() as u32);
    let (n, d) = if exponent < 0 {
        (numerator, denominator * power)
    } else {
        (numerator * power, denominator)
    };
    let (numerator, denominator) = lowest(n, d);
    Fraction {
        numerator,
        denominator,
    }
}

fn big<const N: usize>(value: &Int<N>) -> BigInt {
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
