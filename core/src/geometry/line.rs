//! Names for lines that do not depend on which planes or edges they were made from.

use smallvec::SmallVec;

use super::plane::{Lattice, Plane};
use super::residue::residue;
use crate::arith::{inv_mod, mul_mod, P1};

/// Plücker coordinates of a line up to scale, modulo a prime.
///
/// Equal lines have equal keys; two unequal lines share one by chance 2^-244 (four degrees of
/// freedom, 61 bits each).
///
/// # Source
/// Design review, F5.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LineKey([u64; 6]);

/// Plücker coordinates of a line modulo the prime, at any scale.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    direction: [u64; 3],
    moment: [u64; 3],
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
    pub fn of_planes(a: &Plane, b: &Plane) -> Self {
        let residues = |[x, y, z]: &[i128; 3]| [residue(*x), residue(*y), residue(*z)];
        let (n, m) = (residues(a.normal()), residues(b.normal()));
        let (d, e) = (a.offset().rem_u61(P1), b.offset().rem_u61(P1));
        let moment = |i: usize| sub(mul_mod(d, m[i], P1), mul_mod(e, n[i], P1));
        Self {
            direction: cross(&n, &m),
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
        let scaled = |c| mul_mod(c, scale, P1);
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
        Self::of(&Line::of_planes(a, b))
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
                product = mul_mod(product, line.lead(), P1);
                (line, so_far)
            })
            .collect();
        let mut inverse = inv_mod(product, P1);
        let mut keys: SmallVec<[Self; 8]> = SmallVec::with_capacity(before.len());
        for (line, so_far) in before.iter().rev() {
            keys.push(line.scaled(mul_mod(inverse, *so_far, P1)));
            inverse = mul_mod(inverse, line.lead(), P1);
        }
        keys.reverse();
        keys
    }

    /// The first axis the line is not perpendicular to: points on it are ordered by this coordinate.
    pub fn axis(&self) -> usize {
        self.0[..3].iter().position(|c| *c != 0).unwrap_or(0)
    }
}

/// The direction of an edge parallel to an axis, of which the lead has a trivial inverse.
fn unit_along(a: &Lattice, b: &Lattice) -> Option<[u64; 3]> {
    let along = [0, 1, 2].map(|i| u64::from(a[i] != b[i]));
    (along.iter().sum::<u64>() == 1).then_some(along)
}

fn sub(a: u64, b: u64) -> u64 {
    if a >= b {
        a - b
    } else {
        a + P1 - b
    }
}

fn cross(a: &[u64; 3], b: &[u64; 3]) -> [u64; 3] {
    let term = |i: usize, j: usize| sub(mul_mod(a[i], b[j], P1), mul_mod(a[j], b[i], P1));
    [term(1, 2), term(2, 0), term(0, 1)]
}
