//! Names for lines that do not depend on which planes or edges they were made from.

use smallvec::SmallVec;

use super::axes::each_axis;
use super::plane::{normal, Lattice, Plane};
use super::residue::{mul_p1, reduce_p1, residue};
use crate::arith::{inv_mod, P1};

/// Plücker coordinates of a line up to scale, modulo a prime.
///
/// Equal lines have equal keys; two unequal lines share one by chance 2^-244 (four degrees of
/// freedom, 61 bits each).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LineKey([u64; 6]);

/// Plücker coordinates of a line modulo the prime, at any scale.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    direction: [u64; 3],
    moment: [u64; 3],
}

/// A plane's coefficients modulo the prime.
#[derive(Clone, Copy, Debug)]
pub struct PlaneResidues {
    normal: [u64; 3],
    offset: u64,
}

impl PlaneResidues {
    /// Those of a multiple of the plane through three lattice points.
    pub fn through([a, b, c]: &[Lattice; 3]) -> Self {
        let lattice = |c: i64| residue(c.into());
        let [x, y, z] = normal(a, b, c).map(residue);
        let negative = [x, y, z].map(|r| sub(0, r));
        let first = u128::from(negative[0]) * u128::from(lattice(a[0]));
        let second = u128::from(negative[1]) * u128::from(lattice(a[1]));
        let third = u128::from(negative[2]) * u128::from(lattice(a[2]));
        Self {
            normal: [x, y, z],
            offset: reduce_p1(first + second + third),
        }
    }

    /// Those of a plane.
    pub fn of(plane: &Plane) -> Self {
        let ([x, y, z], offset) = (plane.normal(), plane.offset());
        let short = offset.to_i128().map(residue);
        Self {
            normal: [residue(*x), residue(*y), residue(*z)],
            offset: short.unwrap_or_else(|| offset.rem_u61(P1)),
        }
    }
}

impl Line {
    /// The line through two lattice points.
    pub fn of_edge(a: &Lattice, b: &Lattice) -> Self {
        let residue = |c: i64| residue(c.into());
        let residues = |[x, y, z]: &Lattice| [residue(*x), residue(*y), residue(*z)];
        let p = residues(a);
        if let Some(direction) = unit_along(a, b) {
            let moment = cross(&p, &direction);
            return Self { direction, moment };
        }
        let q = residues(b);
        Self {
            direction: [sub(q[0], p[0]), sub(q[1], p[1]), sub(q[2], p[2])],
            moment: cross(&p, &q),
        }
    }

    /// The line in which two planes meet.
    pub fn of_planes(a: &PlaneResidues, b: &PlaneResidues) -> Self {
        let (n, m) = (&a.normal, &b.normal);
        let moment = |i: usize| minor(a.offset, m[i], b.offset, n[i]);
        Self {
            direction: cross(n, m),
            moment: [moment(0), moment(1), moment(2)],
        }
    }

    /// The first component of the direction that is not zero.
    fn lead(&self) -> u64 {
        let lead = self.direction.iter().find(|c| **c != 0);
        lead.copied().unwrap_or(1)
    }

    /// The key, for the inverse of the lead.
    fn scaled(&self, scale: u64) -> LineKey {
        let ([u, v, w], [x, y, z]) = (self.direction, self.moment);
        let scaled = |c| mul_p1(c, scale);
        LineKey([
            scaled(u),
            scaled(v),
            scaled(w),
            scaled(x),
            scaled(y),
            scaled(z),
        ])
    }
}

impl LineKey {
    /// The line through two lattice points.
    pub fn of_edge(a: &Lattice, b: &Lattice) -> Self {
        Self::of(&Line::of_edge(a, b))
    }

    /// The line in which two planes meet.
    pub fn of_planes(a: &Plane, b: &Plane) -> Self {
        Self::of(&Line::of_planes(
            &PlaneResidues::of(a),
            &PlaneResidues::of(b),
        ))
    }

    /// The key of a line.
    pub fn of(line: &Line) -> Self {
        line.scaled(inv_mod(line.lead(), P1))
    }

    /// The keys of several lines, for one inversion modulo the prime.
    pub fn of_all(lines: impl Iterator<Item = Line>) -> SmallVec<[Self; 8]> {
        let mut product = 1;
        let before: SmallVec<[(Line, u64); 8]> = lines
            .map(|line| {
                let so_far = product;
                product = mul_p1(product, line.lead());
                (line, so_far)
            })
            .collect();
        let mut inverse = inv_mod(product, P1);
        let mut keys: SmallVec<[Self; 8]> = SmallVec::with_capacity(before.len());
        for (line, so_far) in before.iter().rev() {
            keys.push(line.scaled(mul_p1(inverse, *so_far)));
            inverse = mul_p1(inverse, line.lead());
        }
        keys.reverse();
        keys
    }

    /// A number that equal keys share and most others do not, to sort by.
    pub fn mixed(&self) -> u64 {
        // Odd constants of SplitMix (Steele, Lea, Flood 2014) keep small coordinates apart.
        let [_, v, w, x, y, z] = self.0;
        let first = v.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(x);
        let second = w.wrapping_mul(0xbf58_476d_1ce4_e5b9).wrapping_add(y);
        let third = first.wrapping_add(second.rotate_left(32));
        third
            .wrapping_mul(0x94d0_49bb_1331_11eb)
            .wrapping_add(z)
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
    }

    /// The first axis the line is not perpendicular to: points on it are ordered by this coordinate.
    pub fn axis(&self) -> usize {
        self.0[..3].iter().position(|c| *c != 0).unwrap_or(0)
    }
}

/// The direction of an edge parallel to an axis, of which the lead has a trivial inverse.
fn unit_along(a: &Lattice, b: &Lattice) -> Option<[u64; 3]> {
    let along = each_axis(|i| u64::from(a[i] != b[i]));
    (along.iter().sum::<u64>() == 1).then_some(along)
}

fn sub(a: u64, b: u64) -> u64 {
    if a >= b {
        a - b
    } else {
        a + P1 - b
    }
}

/// The difference a·d − c·b of residues, reduced once.
fn minor(a: u64, d: u64, c: u64, b: u64) -> u64 {
    // Residues are below P1, so that their products are below its square and nothing overflows.
    const SQUARE: u128 = P1 as u128 * P1 as u128;
    reduce_p1(u128::from(a) * u128::from(d) + (SQUARE - u128::from(c) * u128::from(b)))
}

fn cross(a: &[u64; 3], b: &[u64; 3]) -> [u64; 3] {
    let term = |i: usize, j: usize| minor(a[i], b[j], a[j], b[i]);
    [term(1, 2), term(2, 0), term(0, 1)]
}
