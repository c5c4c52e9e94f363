//! Names for lines that do not depend on which planes or edges they were made from.

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

impl LineKey {
    /// The line through two lattice points.
    pub fn of_edge(a: &Lattice, b: &Lattice) -> Self {
        let (p, q) = (a.map(|c| residue(c.into())), b.map(|c| residue(c.into())));
        let direction = [0, 1, 2].map(|i| sub(q[i], p[i]));
        Self::normalized(direction, cross(&p, &q))
    }

    /// The line in which two planes meet.
    pub fn of_planes(a: &Plane, b: &Plane) -> Self {
        let n = a.normal().map(residue);
        let m = b.normal().map(residue);
        let (d, e) = (a.offset().rem_u61(P1), b.offset().rem_u61(P1));
        let moment = [0, 1, 2].map(|i| sub(mul_mod(d, m[i], P1), mul_mod(e, n[i], P1)));
        Self::normalized(cross(&n, &m), moment)
    }

    fn normalized(direction: [u64; 3], moment: [u64; 3]) -> Self {
        let lead = direction.iter().copied().find(|c| *c != 0).unwrap_or(1);
        let scale = inv_mod(lead, P1);
        let [u, v, w] = direction.map(|c| mul_mod(c, scale, P1));
        let [x, y, z] = moment.map(|c| mul_mod(c, scale, P1));
        Self([u, v, w, x, y, z])
    }

    /// The first axis the line is not perpendicular to: points on it are ordered by this coordinate.
    pub fn axis(&self) -> usize {
        self.0[..3].iter().position(|c| *c != 0).unwrap_or(0)
    }
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
