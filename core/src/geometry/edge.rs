//! Directed edges between lattice points.

use std::sync::Arc;

use smallvec::SmallVec;

use super::plane::{normal, Lattice, Plane};
use super::side::Side;
use crate::arith::Sign;

/// The corners of a face, in order around it.
pub type Ring = SmallVec<[Lattice; 3]>;

/// A directed edge between two lattice points; the edges of one face share a list of its corners.
#[derive(Clone, Debug)]
pub struct LatticeEdge {
    ring: Arc<Ring>,
    start: u32,
    reversed: bool,
}

impl LatticeEdge {
    /// The directed edge from one lattice point to another.
    pub fn new(from: Lattice, to: Lattice) -> Self {
        Self::of_ring(&Arc::new(SmallVec::from_slice(&[from, to])), 0)
    }

    /// The edge from corner `start` of a face to the next corner.
    pub fn of_ring(ring: &Arc<Ring>, start: u32) -> Self {
        Self {
            ring: Arc::clone(ring),
            start,
            reversed: false,
        }
    }

    /// The start point and the end point of the edge.
    pub fn ends(&self) -> (&Lattice, &Lattice) {
        let (at, n) = (self.start as usize, self.ring.len());
        let (from, to) = (&self.ring[at], &self.ring[(at + 1) % n]);
        if self.reversed {
            (to, from)
        } else {
            (from, to)
        }
    }

    /// Return whether two edges are parallel, in the same or in opposite directions.
    pub fn is_parallel(&self, other: &Self) -> bool {
        let ((a, b), (c, d)) = (self.ends(), other.ends());
        let step = |p: &Lattice, q: &Lattice, i: usize| i128::from(q[i] - p[i]);
        (0..3).all(|i| {
            let j = (i + 1) % 3;
            step(a, b, i) * step(c, d, j) == step(a, b, j) * step(c, d, i)
        })
    }

    /// Return whether two edges have the same ends, in either order.
    pub fn shares_ends(&self, other: &Self) -> bool {
        let (ends, (a, b)) = (self.ends(), other.ends());
        ends == (a, b) || ends == (b, a)
    }

    /// Return whether both ends of the edge lie in a plane.
    pub fn lies_in(&self, plane: &Plane) -> bool {
        let (a, b) = self.ends();
        plane.side_of_lattice(a) == Side::On && plane.side_of_lattice(b) == Side::On
    }

    /// Return whether a lattice point lies on the infinite line through the edge.
    pub fn line_contains(&self, point: &Lattice) -> bool {
        let (a, b) = self.ends();
        normal(a, b, point) == [0; 3]
    }

    /// The sign that says on which side of a plane a lattice point lies; the plane contains the edge and is
    /// parallel to `axis`.
    ///
    /// # Bits
    /// Steps between lattice points are below 2^54, and a sum of two products of them below 2^110.
    pub fn sign_beside(&self, point: &Lattice, axis: usize) -> Sign {
        let (a, b) = self.ends();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let product = |p: i64, q: i64| i128::from(p) * i128::from(q);
        let value = product(b[v] - a[v], point[u] - a[u]) + product(a[u] - b[u], point[v] - a[v]);
        Sign::of(value)
    }

    /// The same edge in the opposite direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self {
            reversed: !self.reversed,
            ..self.clone()
        }
    }
}
