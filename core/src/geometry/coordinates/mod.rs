//! Homogeneous coordinates of constructed points, as wide as what they are constructed from asks.

mod long;
mod short;

use std::cmp::Ordering;

pub use self::long::cross;
use super::edge::LatticeEdge;
use super::plane::{Lattice, Plane, ShortPlane};
use crate::arith::{inv_mod, mul_mod, Int, P1};

/// Homogeneous coordinates, w > 0.
#[derive(Clone, Debug)]
pub struct Homogeneous<const N: usize = 6> {
    /// x, y and z times w.
    pub x: [Int<N>; 3],
    /// The positive denominator.
    pub w: Int<N>,
}

/// Coordinates in four limbs where all planes are short, else in six.
pub enum Coordinates {
    /// Of short planes.
    Short(Homogeneous<4>),
    /// Of any planes.
    Long(Homogeneous),
}

impl<const N: usize> Homogeneous<N> {
    /// The coordinates with the denominator made positive; `None` if it is zero.
    fn positive(x: [Int<N>; 3], w: Int<N>) -> Option<Self> {
        match w.signum() {
            0 => None,
            1 => Some(Self { x, w }),
            _ => {
                let x = [-x[0], -x[1], -x[2]];
                Some(Self { x, w: -w })
            }
        }
    }

    /// The coordinates rounded to the nearest doubles.
    pub fn approx(&self) -> [f64; 4] {
        let [x, y, z] = &self.x;
        [x.to_f64(), y.to_f64(), z.to_f64(), self.w.to_f64()]
    }

    /// The same coordinates in six limbs.
    pub fn widened(&self) -> Homogeneous {
        let [x, y, z] = &self.x;
        Homogeneous {
            x: [x.widen(), y.widen(), z.widen()],
            w: self.w.widen(),
        }
    }

    fn residues(&self) -> [u64; 3] {
        let w = self.w.rem_u61(P1);
        if w == 0 {
            return [u64::MAX; 3];
        }
        let inverse = inv_mod(w, P1);
        let over = |x: &Int<N>| mul_mod(x.rem_u61(P1), inverse, P1);
        [over(&self.x[0]), over(&self.x[1]), over(&self.x[2])]
    }
}

impl Homogeneous {
    /// A plane's value here times the denominator.
    pub fn value(&self, plane: &Plane) -> Int<8> {
        let n = plane.normal();
        let term = |i: usize| -> Int<8> { self.x[i].mul_i128(n[i]) };
        let last: Int<8> = self.w.mul(plane.offset());
        term(0) + term(1) + term(2) + last
    }
}

impl Homogeneous<4> {
    fn value(&self, plane: &ShortPlane) -> Int<6> {
        let term = |i: usize| -> Int<6> { self.x[i].mul_i64(plane.n[i]) };
        let last: Int<6> = self.w.mul_i128(plane.d);
        term(0) + term(1) + term(2) + last
    }
}

impl Coordinates {
    /// Those of a lattice point.
    pub fn of_lattice(p: &Lattice) -> Self {
        Self::Short(Homogeneous {
            x: p.map(Int::from_i64),
            w: Int::ONE,
        })
    }

    /// Those of the meet of three planes; `None` if they have no single common point.
    pub fn of_planes(a: &Plane, b: &Plane, c: &Plane) -> Option<Self> {
        match (a.short(), b.short(), c.short()) {
            (Some(a), Some(b), Some(c)) => short::meet(&a, &b, &c).map(Self::Short),
            _ => long::meet(a, b, c).map(Self::Long),
        }
    }

    /// Those of the meet of a lattice edge's line with a plane; `None` if they are parallel.
    pub fn on_edge(edge: &LatticeEdge, cut: &Plane) -> Option<Self> {
        let (a, b) = edge.ends();
        match cut.short() {
            Some(cut) => short::on_edge(a, b, &cut).map(Self::Short),
            None => long::on_edge(a, b, cut).map(Self::Long),
        }
    }

    /// The coordinates rounded to the nearest doubles.
    pub fn approx(&self) -> [f64; 4] {
        match self {
            Self::Short(h) => h.approx(),
            Self::Long(h) => h.approx(),
        }
    }

    /// The coordinates in six limbs.
    pub fn widened(&self) -> Homogeneous {
        match self {
            Self::Short(h) => h.widened(),
            Self::Long(h) => h.clone(),
        }
    }

    /// Sign of a plane's value here.
    pub fn side_of(&self, plane: &Plane) -> i32 {
        match (self, plane.short()) {
            (Self::Short(h), Some(plane)) => h.value(&plane).signum(),
            (known, _) => known.widened().value(plane).signum(),
        }
    }

    /// Order of two points by one coordinate.
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

    /// The coordinates x/w, y/w and z/w modulo a prime.
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
            prop_assert_eq!(p.side_of(&a), 0);
            prop_assert_eq!(p.residues(), long_p.residues());
            for axis in 0..3 {
                prop_assert_eq!(p.compare(&q, axis), long_p.compare(&long_q, axis));
            }
        }
    }
}
