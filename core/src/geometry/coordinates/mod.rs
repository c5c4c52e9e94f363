//! Homogeneous coordinates of constructed points, as wide as their construction requires.

mod homogeneous;
mod long;
mod short;

use std::cmp::Ordering;

pub use self::homogeneous::Homogeneous;
pub use self::long::cross;
use super::edge::LatticeEdge;
use super::plane::{Lattice, Plane};
use crate::arith::Int;
use crate::geometry::side::Side;

/// The homogeneous coordinates of an exact point: in four limbs if all planes of its construction are short,
/// else in six.
pub enum Coordinates {
    /// Four limbs: the point is a lattice point or a meet of short planes.
    Short(Homogeneous<4>),
    /// Six limbs: the point may come from planes of any width.
    Long(Homogeneous),
}

impl Coordinates {
    /// The coordinates of a lattice point.
    pub fn of_lattice(p: &Lattice) -> Self {
        Self::Short(Homogeneous {
            x: p.map(Int::from_i64),
            w: Int::ONE,
        })
    }

    /// The coordinates of the point where three planes meet; `None` if they have no single common point.
    pub fn of_planes(a: &Plane, b: &Plane, c: &Plane) -> Option<Self> {
        match (a.short(), b.short(), c.short()) {
            (Some(a), Some(b), Some(c)) => short::meet(&a, &b, &c).map(Self::Short),
            _ => long::meet(a, b, c).map(Self::Long),
        }
    }

    /// The coordinates of the point where the line through a lattice edge meets a plane; `None` if the two
    /// are parallel.
    pub fn on_edge(edge: &LatticeEdge, cut: &Plane) -> Option<Self> {
        let (a, b) = edge.ends();
        match cut.short() {
            Some(cut) => short::on_edge(a, b, &cut).map(Self::Short),
            None => long::on_edge(a, b, cut).map(Self::Long),
        }
    }

    /// The homogeneous coordinates x, y, z and w, each rounded to the nearest double.
    pub fn approx(&self) -> [f64; 4] {
        match self {
            Self::Short(h) => h.approx(),
            Self::Long(h) => h.approx(),
        }
    }

    /// The same coordinates as integers of six limbs.
    pub fn widened(&self) -> Homogeneous {
        match self {
            Self::Short(h) => h.widened(),
            Self::Long(h) => h.clone(),
        }
    }

    /// The side of a plane on which the point with these coordinates lies.
    pub fn side_of(&self, plane: &Plane) -> Side {
        Side::from_sign(match (self, plane.short()) {
            (Self::Short(h), Some(plane)) => h.value(&plane).sign(),
            (known, _) => known.widened().value(plane).sign(),
        })
    }

    /// The exact order of two points by their coordinate along an axis.
    pub fn compare(&self, other: &Self, axis: usize) -> Ordering {
        if let (Self::Short(p), Self::Short(q)) = (self, other) {
            let left: Int<8> = p.x[axis].mul(&q.w);
            let right: Int<8> = q.x[axis].mul(&p.w);
            return left.cmp(&right);
        }
        let (p, q) = (self.widened(), other.widened());
        let left: Int<12> = p.x[axis].mul(&q.w);
        let right: Int<12> = q.x[axis].mul(&p.w);
        left.cmp(&right)
    }

    /// The coordinates x/w, y/w and z/w modulo the prime `P1`; all `u64::MAX` if the prime divides w.
    pub fn residues(&self) -> [u64; 3] {
        match self {
            Self::Short(h) => h.residues(),
            Self::Long(h) => h.residues(),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn component() -> impl Strategy<Value = i128> {
        const LIMIT: i128 = (1 << 62) - 1;
        prop_oneof![
            2 => -2i128..=2,
            1 => -LIMIT..=LIMIT,
            1 => Just(LIMIT),
            1 => Just(-LIMIT),
        ]
    }

    fn offset() -> impl Strategy<Value = i128> {
        const LIMIT: i128 = (1 << 124) - 1;
        prop_oneof![
            2 => -9i128..=9,
            2 => -(1i128 << 54)..=1 << 54,
            1 => Just(LIMIT),
            1 => Just(-LIMIT),
        ]
    }

    fn plane() -> impl Strategy<Value = Plane> {
        let coefficients = ([component(), component(), component()], offset());
        coefficients.prop_filter_map("no normal", |(n, d)| Plane::new(n, Int::from_i128(d)))
    }

    fn point() -> impl Strategy<Value = Lattice> {
        let coordinate = || -(1i64 << 53)..=1 << 53;
        [coordinate(), coordinate(), coordinate()]
    }

    fn limbs(h: Option<Homogeneous>) -> Option<([Int<6>; 3], Int<6>)> {
        h.map(|h| (h.x, h.w))
    }

    proptest! {
        #[test]
        fn short_planes_meet_where_long_ones_do(a in plane(), b in plane(), c in plane()) {
            let known = Coordinates::of_planes(&a, &b, &c);
            prop_assert!(!matches!(known, Some(Coordinates::Long(_))));
            let wide = known.map(|k| k.widened());
            prop_assert_eq!(limbs(wide), limbs(long::meet(&a, &b, &c)));
        }

        #[test]
        fn short_planes_meet_edges_where_long_ones_do(a in point(), b in point(), cut in plane()) {
            let known = Coordinates::on_edge(&LatticeEdge::new(a, b), &cut);
            prop_assert!(!matches!(known, Some(Coordinates::Long(_))));
            let wide = known.map(|k| k.widened());
            prop_assert_eq!(limbs(wide), limbs(long::on_edge(&a, &b, &cut)));
        }

        #[test]
        fn short_points_lie_and_are_ordered_as_long_ones(
            a in plane(), b in plane(), c in plane(), d in plane(), e in plane(),
        ) {
            let meets = (Coordinates::of_planes(&a, &b, &c), Coordinates::of_planes(&a, &b, &d));
            let (Some(p), Some(q)) = meets else {
                return Ok(());
            };
            let (long_p, long_q) = (Coordinates::Long(p.widened()), Coordinates::Long(q.widened()));
            prop_assert_eq!(p.side_of(&e), long_p.side_of(&e));
            prop_assert_eq!(p.side_of(&a), Side::On);
            prop_assert_eq!(p.residues(), long_p.residues());
            for axis in 0..3 {
                prop_assert_eq!(p.compare(&q, axis), long_p.compare(&long_q, axis));
            }
        }
    }
}
