//! The projection of numbered points onto a plane, and exact questions about them.

use std::cmp::Ordering;

use super::angles;
use super::triangulate::Planar;
use crate::arith::convert::as_double;
use crate::arith::{Filtered, Sign};
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::points;
use crate::geometry::vertex::{Vertex, MAX_COORDINATE_ERROR};
use crate::geometry::vertices::VertexTable;

/// The points of a table, projected along the main axis of a plane's normal, as seen from its plus side.
#[derive(Debug)]
pub struct Projection<'a> {
    table: &'a VertexTable,
    u: usize,
    v: usize,
}

impl<'a> Projection<'a> {
    /// Makes the projection onto a plane.
    pub fn onto(plane: &Plane, table: &'a VertexTable) -> Self {
        let axis = plane.main_axis();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let (u, v) = if plane.normal()[axis] < 0 {
            (v, u)
        } else {
            (u, v)
        };
        Self { table, u, v }
    }
}

impl Projection<'_> {
    /// The projection of a lattice point.
    pub fn flat(&self, p: &Lattice) -> [f64; 2] {
        [as_double(p[self.u]), as_double(p[self.v])]
    }

    /// Returns true if a point lies strictly inside the segment from `a` to `b`.
    pub fn is_between(&self, a: u32, point: u32, b: u32) -> bool {
        point != a
            && point != b
            && self.orient(a, point, b) == Sign::Zero
            && self.compare(a, point) == self.compare(point, b)
    }
}

impl Projection<'_> {
    /// Returns true if two segments cross at a point inside both.
    pub fn crosses(&self, a: [u32; 2], b: [u32; 2]) -> bool {
        a.iter().all(|p| !b.contains(p))
            && self.orient(a[0], a[1], b[0]) * self.orient(a[0], a[1], b[1]) == Sign::Negative
            && self.orient(b[0], b[1], a[0]) * self.orient(b[0], b[1], a[1]) == Sign::Negative
    }
}

impl Planar for Projection<'_> {
    fn compare(&self, a: u32, b: u32) -> Ordering {
        if a == b {
            return Ordering::Equal;
        }
        let by = |axis| self.compare_by(a, b, axis);
        by(self.u).then_with(|| by(self.v))
    }

    fn orient(&self, a: u32, b: u32, c: u32) -> Sign {
        self.rough_orient([a, b, c])
            .or_exact(|| points::turn([a, b, c].map(|p| &**self.table.point(p)), [self.u, self.v]))
    }

    fn opposite_angles(&self, [a, b]: [u32; 2], [c, d]: [u32; 2]) -> Ordering {
        let quad = [a, b, c, d];
        angles::rough(quad.map(|p| self.approx(p))).or_exact(|| {
            let points = quad.map(|p| &**self.table.point(p));
            angles::exact(points, [self.u, self.v])
        })
    }

    fn approx(&self, a: u32) -> [f64; 2] {
        let p = self.table.position(a);
        [p[self.u], p[self.v]]
    }
}

impl Projection<'_> {
    fn compare_by(&self, a: u32, b: u32, axis: usize) -> Ordering {
        let (p, q) = (self.table.position(a)[axis], self.table.position(b)[axis]);
        if (p - q).abs() > (p.abs() + q.abs()) * MAX_COORDINATE_ERROR {
            return p.total_cmp(&q);
        }
        self.table.point(a).compare(self.table.point(b), axis)
    }

    /// The sign of a turn if doubles decide it, given that coordinates are accurate to
    /// [`MAX_COORDINATE_ERROR`].
    fn rough_orient(&self, points: [u32; 3]) -> Filtered<Sign> {
        let [a, b, c] = points.map(|p| self.approx(p));
        let (bu, bv) = (b[0] - a[0], b[1] - a[1]);
        let (cu, cv) = (c[0] - a[0], c[1] - a[1]);
        let larger = |p: [f64; 2]| p[0].abs().max(p[1].abs());
        let doubt = MAX_COORDINATE_ERROR * larger(a).max(larger(b)).max(larger(c));
        let size = bu.abs() + bv.abs() + cu.abs() + cv.abs();
        let bound = 2.0 * doubt * (size + 2.0 * doubt)
            + 4.0 * f64::EPSILON * (bu * cv).abs().max((bv * cu).abs());
        let cross = bu * cv - bv * cu;
        Filtered::when(cross.abs() > bound, Sign::of(cross))
    }
}

/// The signs of the three coordinates of b − a.
pub fn direction(a: &Vertex, b: &Vertex) -> [Sign; 3] {
    [0, 1, 2].map(|axis| Sign::from_order(b.compare(a, axis)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_and_across_are_exact_in_the_view_from_above() {
        let mut table = VertexTable::default();
        let [a, b, c, d] = [[0, 0, 0], [9, 9, 0], [3, 3, 0], [9, 0, 0]].map(|p| table.number_at(p));
        let e = table.number_at([0, 9, 0]);
        let floor = Plane::through(&[0, 0, 0], &[1, 0, 0], &[0, 1, 0]).expect("a plane");
        let view = Projection::onto(&floor, &table);
        assert!(view.is_between(a, c, b) && !view.is_between(a, d, b));
        assert!(view.crosses([a, b], [d, e]) && !view.crosses([a, c], [d, e]));
    }
}
