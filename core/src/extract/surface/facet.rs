//! Triangles with exact corners, and exact tests of whether two of them meet.

use std::cmp::Ordering;
use std::sync::Arc;

use crate::arith::Sign;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::Plane;
use crate::geometry::points;
use crate::geometry::side::Side;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;

/// A triangle with exact corners, and its plane.
pub struct Facet {
    /// The corners.
    pub corners: [Vertex; 3],
    /// The plane of the triangle; the outside of the solid may be on either side.
    pub plane: Arc<Plane>,
}

impl Facet {
    /// Returns true if two triangles have a point in common.
    pub fn meets(&self, other: &Self) -> bool {
        poll();
        let ours = self.sides_of(other);
        if is_beside(ours) {
            return false;
        }
        let theirs = other.sides_of(self);
        !is_beside(theirs) && (self.meets_edges(other, ours) || other.meets_edges(self, theirs))
    }

    /// Returns the side of this triangle's plane on which each corner of `other` lies.
    fn sides_of(&self, other: &Self) -> [Side; 3] {
        other.corners.each_ref().map(|p| p.side_of(&self.plane))
    }

    /// Returns true if an edge of `other` meets this triangle; `sides` are the sides of this triangle's
    /// plane on which the corners of `other` lie.
    fn meets_edges(&self, other: &Self, sides: [Side; 3]) -> bool {
        (0..3).any(|i| {
            let j = (i + 1) % 3;
            let ends = [&other.corners[i], &other.corners[j]];
            match [sides[i], sides[j]] {
                [Side::On, Side::On] => self.meets_flat(ends),
                [Side::On, _] => self.holds(ends[0]),
                [_, Side::On] => self.holds(ends[1]),
                [from, to] => from != to && self.is_pierced(ends),
            }
        })
    }

    /// Returns true if a segment with its ends on different sides of the triangle's plane meets the triangle,
    /// that is, if no two edges turn in opposite directions around the segment.
    fn is_pierced(&self, [from, to]: [&Vertex; 2]) -> bool {
        let around = |i: usize| {
            let (a, b) = (&self.corners[i], &self.corners[(i + 1) % 3]);
            points::side([from, to, a], b)
        };
        !is_split(each_axis(around))
    }

    /// Returns true if a point of the triangle's plane lies in the triangle.
    fn holds(&self, point: &Vertex) -> bool {
        let turns = each_axis(|i| {
            let (a, b) = (&self.corners[i], &self.corners[(i + 1) % 3]);
            Side::from_sign(points::turn([a, b, point], self.view()))
        });
        !is_split(turns)
    }

    /// Returns true if a segment in the triangle's plane has a point in the triangle's interior: for each
    /// edge, an end of the segment lies on the inner side, and corners lie on both sides of the segment's
    /// line.
    pub fn has_inside(&self, [from, to]: [&Vertex; 2]) -> bool {
        let turn = |a, b, c| points::turn([a, b, c], self.view());
        let [a, b, c] = self.corners.each_ref();
        let inner = turn(a, b, c);
        let enters = |i: usize| {
            let (a, b) = (&self.corners[i], &self.corners[(i + 1) % 3]);
            turn(a, b, from) == inner || turn(a, b, to) == inner
        };
        let corners = self.corners.each_ref().map(|p| turn(from, to, p));
        let is_split = corners.contains(&Sign::Positive) && corners.contains(&Sign::Negative);
        is_split && (0..3).all(enters)
    }

    /// Returns true if a segment in the triangle's plane overlaps an edge in more than one point.
    pub fn has_along(&self, edge: usize, [from, to]: [&Vertex; 2]) -> bool {
        let [u, v] = self.view();
        let (a, b) = (&self.corners[edge], &self.corners[(edge + 1) % 3]);
        let is_on = |point| points::turn([a, b, point], [u, v]) == Sign::Zero;
        let axis = if a.compare(b, u) == Ordering::Equal {
            v
        } else {
            u
        };
        let sorted = |p: &'_ Vertex, q: &'_ Vertex| p.compare(q, axis) == Ordering::Less;
        let [low, high] = if sorted(a, b) { [a, b] } else { [b, a] };
        let [first, last] = if sorted(from, to) {
            [from, to]
        } else {
            [to, from]
        };
        is_on(from) && is_on(to) && sorted(first, high) && sorted(low, last)
    }

    /// Returns true if a segment in the triangle's plane meets the triangle: one end lies in it, or the
    /// segment crosses an edge.
    fn meets_flat(&self, [from, to]: [&Vertex; 2]) -> bool {
        let turn = |a, b, c| points::turn([a, b, c], self.view());
        let is_across = |i: usize| {
            let (a, b) = (&self.corners[i], &self.corners[(i + 1) % 3]);
            let ends = [turn(from, to, a), turn(from, to, b)];
            let sides = [turn(a, b, from), turn(a, b, to)];
            // An edge on the segment's line does not count: the segment also meets the neighbouring edges,
            // or one of its ends lies on the edge.
            ends != [Sign::Zero; 2]
                && ends[0] * ends[1] != Sign::Positive
                && sides[0] * sides[1] != Sign::Positive
        };
        self.holds(from) || self.holds(to) || (0..3).any(is_across)
    }

    /// The two axes of the coordinate plane in which the triangle's projection is largest.
    fn view(&self) -> [usize; 2] {
        let axis = self.plane.main_axis();
        [(axis + 1) % 3, (axis + 2) % 3]
    }
}

/// Returns true if three points lie strictly on one side of a plane, the same for all.
fn is_beside(sides: [Side; 3]) -> bool {
    sides[0] != Side::On && sides.iter().all(|side| *side == sides[0])
}

/// Returns true if points lie strictly on both sides of a plane.
fn is_split(sides: [Side; 3]) -> bool {
    sides.contains(&Side::Plus) && sides.contains(&Side::Minus)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::plane::Lattice;

    fn facet(corners: [Lattice; 3]) -> Option<Facet> {
        let [a, b, c] = corners;
        Some(Facet {
            plane: Arc::new(Plane::through(&a, &b, &c)?),
            corners: corners.map(Vertex::lattice),
        })
    }

    /// Returns true if two triangles have a point in common: no plane through the origin has all differences
    /// of their points strictly on one side.
    fn touch(p: &[Lattice; 3], q: &[Lattice; 3]) -> bool {
        let differences: Vec<[i64; 3]> = p
            .iter()
            .flat_map(|a| q.iter().map(|b| each_axis(|i| a[i] - b[i])))
            .collect();
        let edges =
            |t: &[Lattice; 3]| [0, 1, 2].map(|k| each_axis(|i| t[(k + 1) % 3][i] - t[k][i]));
        let cross = |a: [i64; 3], b: [i64; 3]| {
            each_axis(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
        };
        let (own, other) = (edges(p), edges(q));
        let faces = [cross(own[0], own[1]), cross(other[0], other[1])];
        let mut normals: Vec<[i64; 3]> = faces.to_vec();
        normals.extend(own.iter().flat_map(|e| other.iter().map(|f| cross(*e, *f))));
        // For two triangles in one plane.
        normals.extend(own.iter().map(|e| cross(*e, faces[0])));
        normals.extend(other.iter().map(|e| cross(*e, faces[1])));
        let separates = |n: &[i64; 3]| {
            let along = |d: &[i64; 3]| (0..3).map(|i| n[i] * d[i]).sum::<i64>();
            let signs = differences.iter().map(|d| along(d).signum());
            let sum: i64 = signs.sum();
            sum.unsigned_abs() == differences.len() as u64
        };
        !normals.iter().any(separates)
    }

    fn triangle() -> impl Strategy<Value = [Lattice; 3]> {
        let point = || [0..=4i64, 0..=4i64, 0..=3i64];
        [point(), point(), point()]
    }

    /// Returns true if a segment has a point inside a left-turning triangle of the plane z = 0: the three
    /// turns of a point there with the edges are all positive.
    fn enters([a, b, c]: &[Lattice; 3], [from, to]: &[Lattice; 2]) -> bool {
        let turn = |p: &Lattice, q: &Lattice, r: &Lattice| {
            (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        };
        // The parameters at which a turn is zero, and the middles between them, as fractions.
        let turns = [(a, b), (b, c), (c, a)].map(|(p, q)| [turn(p, q, from), turn(p, q, to)]);
        let zeros = turns.iter().filter(|t| t[0] != t[1]);
        let mut shares: Vec<(i64, i64)> = zeros.map(|t| (t[0], t[0] - t[1])).collect();
        shares.extend([(0, 1), (1, 1)]);
        let middles: Vec<(i64, i64)> = shares
            .iter()
            .flat_map(|(m, n)| shares.iter().map(move |(p, q)| (m * q + p * n, 2 * n * q)))
            .collect();
        shares.extend(middles);
        let positive = |(m, n): &(i64, i64)| {
            let (m, n) = (m * n.signum(), n.abs());
            (0..=n).contains(&m) && turns.iter().all(|t| t[0] * (n - m) + t[1] * m > 0)
        };
        shares.iter().any(positive)
    }

    fn on_floor() -> impl Strategy<Value = Lattice> {
        (0..=5i64, 0..=5i64).prop_map(|(x, y)| [x, y, 0])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        #[test]
        fn segments_enter_triangles_where_all_turns_are_positive(
            corners in [on_floor(), on_floor(), on_floor()], ends in [on_floor(), on_floor()],
        ) {
            let Some(found) = facet(corners) else { return Ok(()) };
            let [a, b, c] = corners;
            let left = found.plane.normal()[2] > 0;
            let turned = if left { [a, b, c] } else { [a, c, b] };
            let [from, to] = ends.map(Vertex::lattice);
            if ends[0] != ends[1] {
                prop_assert_eq!(found.has_inside([&from, &to]), enters(&turned, &ends));
            }
        }

        #[test]
        fn segments_run_along_edges_of_their_line_that_they_overlap(
            corners in [on_floor(), on_floor(), on_floor()], line in on_floor(), ends in [0..9i64, 0..9i64],
        ) {
            let Some(found) = facet(corners) else { return Ok(()) };
            let [a, b, _] = corners;
            let at = |k: i64| each_axis(|i| a[i] + (b[i] - a[i]) * (k - 4));
            if ends[0] == ends[1] { return Ok(()) }
            let [from, to] = ends.map(|k| Vertex::lattice(at(k)));
            let overlaps = ends[0].min(ends[1]) < 5 && ends[0].max(ends[1]) > 4;
            prop_assert_eq!(found.has_along(0, [&from, &to]), overlaps);
            let aside = Vertex::lattice(line);
            let turn = points::turn([&found.corners[0], &found.corners[1], &aside], found.view());
            prop_assert!(turn == Sign::Zero || !found.has_along(0, [&from, &aside]));
        }

        #[test]
        fn triangles_meet_where_no_plane_separates_them(p in triangle(), q in triangle()) {
            if let (Some(first), Some(second)) = (facet(p), facet(q)) {
                prop_assert_eq!(first.meets(&second), touch(&p, &q));
                prop_assert_eq!(second.meets(&first), touch(&p, &q));
            }
        }
    }
}
