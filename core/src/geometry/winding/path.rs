//! Changes of the winding number along a straight path from a cell's corner to an exact point.
//!
//! The path ends at a point of one surface, to find on which side of other surfaces this point lies. The path
//! is not shifted to avoid special positions: where it runs through an edge, or ends on another surface, the
//! result is doubtful.

use super::crossing::change_between;
use crate::arith::convert::{as_double, as_whole};
use crate::arith::{Filtered, Int, Sign};
use crate::geometry::axes::each_axis;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::side::{Half, Side};
use crate::geometry::vertex::Vertex;

/// The relative error bound of a determinant of three rows, each of rounded differences of integers.
///
/// A product of three has 3 roundings of factors and 2 of products, a sum of six at most 5: 10u relative to
/// the sum of magnitudes, u = 2^-53; 16u leaves room for the bound's own rounding.
const DETERMINANT_FILTER: f64 = 16.0 / 9_007_199_254_740_992.0;

/// The padding of boxes around a path, as a fraction of the largest coordinate.
///
/// Ends and differences are rounded by a few units in the last place of a coordinate, quotients by as much
/// of the extent: together below 2^-48 of the largest coordinate.
const PATH_SLACK: f64 = 1e-14;

/// A straight path from one point to another in doubles, to test against boxes.
pub struct PaddedPath {
    from: [f64; 3],
    /// For each axis, one over the path's extent along it; infinite if the path is perpendicular to the axis.
    inverse: [f64; 3],
    /// The padding of boxes, in lattice steps.
    slack: f64,
    /// The lowest corner of a padded box around the path; `high` is the highest.
    low: Lattice,
    high: Lattice,
}

impl PaddedPath {
    /// The path between two points, each rounded by less than a lattice step.
    pub fn new(from: [f64; 3], to: [f64; 3]) -> Self {
        let sizes = from.iter().chain(&to).map(|x| x.abs());
        let slack = 2.0 + sizes.fold(0.0, f64::max) * PATH_SLACK;
        Self {
            from,
            inverse: each_axis(|i| 1.0 / (to[i] - from[i])),
            slack,
            low: each_axis(|i| as_whole((from[i].min(to[i]) - slack).floor())),
            high: each_axis(|i| as_whole((from[i].max(to[i]) + slack).ceil())),
        }
    }

    /// Return whether the path may meet a lattice box, given by its lowest and highest point; may return
    /// false positives.
    #[inline]
    pub fn may_meet(&self, low: &Lattice, high: &Lattice) -> bool {
        let beyond = |i: usize| low[i] > self.high[i] || high[i] < self.low[i];
        !(beyond(0) || beyond(1) || beyond(2)) && self.meets_padded_box(low, high)
    }

    fn meets_padded_box(&self, low: &Lattice, high: &Lattice) -> bool {
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for i in 0..3 {
            let before = as_double(low[i]) - self.slack - self.from[i];
            let after = as_double(high[i]) + self.slack - self.from[i];
            if self.inverse[i].is_infinite() {
                if before > 0.0 || after < 0.0 {
                    return false;
                }
                continue;
            }
            let (enters, leaves) = (before * self.inverse[i], after * self.inverse[i]);
            first = first.max(enters.min(leaves));
            last = last.min(enters.max(leaves));
        }
        first <= last
    }
}

/// The change of the winding number across a lattice triangle, along a path from the corner of a cell, given
/// in half lattice steps, to a lattice point; doubtful if the path meets an edge or ends in the triangle's
/// plane.
pub fn triangle_change_on_path(
    corners: &[Lattice; 3],
    from: &Lattice,
    to: &Lattice,
) -> Filtered<i32> {
    let doubled = |p: &Lattice| each_axis(|i| 2 * p[i] - from[i]);
    let [a, b, c] = [&corners[0], &corners[1], &corners[2]].map(doubled);
    let end = doubled(to);
    let turns = [(&a, &b), (&b, &c), (&c, &a)].map(|(p, q)| determinant(&end, p, q));
    let all = |s: Sign| turns.iter().all(|t| *t == s);
    if turns.contains(&Sign::Zero) {
        return Filtered::Doubtful;
    }
    if !all(Sign::Positive) && !all(Sign::Negative) {
        return Filtered::Certain(0);
    }
    let difference = |p: &Lattice, q: &Lattice| each_axis(|i| p[i] - q[i]);
    let (u, v) = (difference(&b, &a), difference(&c, &a));
    let before = determinant(&difference(&[0; 3], &a), &u, &v);
    let after = determinant(&difference(&end, &a), &u, &v);
    if before == Sign::Zero || after == Sign::Zero {
        return Filtered::Doubtful;
    }
    Filtered::Certain(change_between(
        Half::from_sign(before),
        Half::from_sign(after),
    ))
}

/// The sign of the determinant of three rows, where doubles decide it.
pub fn near_determinant(a: &Lattice, b: &Lattice, c: &Lattice) -> Filtered<Sign> {
    NearCross::of(b, c).sign_with(a)
}

/// A cross product in doubles, with the error bound that determinants with further rows need.
#[derive(Clone, Copy, Debug)]
pub struct NearCross {
    value: [f64; 3],
    /// For each component, the sum of the magnitudes of its two products.
    size: [f64; 3],
}

impl NearCross {
    /// A placeholder for a cross product of unknown rows: the sign of any determinant with it is doubtful.
    pub const UNKNOWN: Self = Self {
        value: [f64::NAN; 3],
        size: [f64::NAN; 3],
    };

    /// The cross product of two integer rows.
    #[inline]
    pub fn of(b: &Lattice, c: &Lattice) -> Self {
        Self::of_rounded(&rounded(b), &rounded(c))
    }

    /// The cross product of two rows of rounded differences.
    #[inline]
    pub fn of_rounded(q: &[f64; 3], r: &[f64; 3]) -> Self {
        let minor = |i: usize, j: usize| (q[i] * r[j], q[j] * r[i]);
        let minors = [minor(1, 2), minor(2, 0), minor(0, 1)];
        Self {
            value: each_axis(|i| minors[i].0 - minors[i].1),
            size: each_axis(|i| minors[i].0.abs() + minors[i].1.abs()),
        }
    }

    /// The sign of the determinant whose rows are an integer row and the two rows of this cross product,
    /// where doubles decide it.
    #[inline]
    pub fn sign_with(&self, a: &Lattice) -> Filtered<Sign> {
        self.sign_with_rounded(&rounded(a))
    }

    /// The sign of the determinant whose rows are a row of rounded differences and the two rows of this cross
    /// product, where doubles decide it.
    #[inline]
    pub fn sign_with_rounded(&self, p: &[f64; 3]) -> Filtered<Sign> {
        let value = p[0] * self.value[0] + p[1] * self.value[1] + p[2] * self.value[2];
        let size =
            p[0].abs() * self.size[0] + p[1].abs() * self.size[1] + p[2].abs() * self.size[2];
        let doubt = size * DETERMINANT_FILTER;
        Filtered::when(value.abs() > doubt, Sign::of(value))
    }
}

#[inline]
fn rounded(row: &Lattice) -> [f64; 3] {
    each_axis(|i| as_double(row[i]))
}

/// The exact sign of the determinant of three rows.
pub fn determinant(a: &Lattice, b: &Lattice, c: &Lattice) -> Sign {
    near_determinant(a, b, c).or_exact(|| exact_determinant(a, b, c))
}

fn exact_determinant(a: &Lattice, b: &Lattice, c: &Lattice) -> Sign {
    let minor = |i: usize, j: usize| {
        i128::from(b[i]) * i128::from(c[j]) - i128::from(b[j]) * i128::from(c[i])
    };
    let term = |i: usize, m: i128| -> Int<3> { Int::<2>::from_i128(m).mul_i64(a[i]) };
    (term(0, minor(1, 2)) + term(1, minor(2, 0)) + term(2, minor(0, 1))).sign()
}

/// The change of the winding number across a convex polygon, along a path from the corner of a cell, given
/// in half lattice steps, to an exact point; doubtful if the path meets an edge or ends in the polygon's
/// plane.
///
/// `support` is the polygon's plane, and `rims` are planes through its edges with the polygon on their minus
/// sides.
pub fn polygon_change_on_path<'a>(
    support: &Plane,
    rims: impl FnOnce() -> &'a [Plane],
    from: &Lattice,
    to: &Vertex,
) -> Filtered<i32> {
    let (before, after) = (support.side_of_corner(from), to.side_of(support));
    let after = match after {
        Side::Minus => Half::Minus,
        Side::On => return Filtered::Doubtful,
        Side::Plus => Half::Plus,
    };
    if before == after {
        return Filtered::Certain(0);
    }
    for rim in rims() {
        match before.sign() * cross(support, rim, from, to) {
            Sign::Zero => return Filtered::Doubtful,
            Sign::Positive => return Filtered::Certain(0),
            Sign::Negative => {}
        }
    }
    Filtered::Certain(change_between(before, after))
}

/// The sign of b(c) e(x) − e(c) b(x), where b(p) and e(p) are the values of two planes at a point p. It is
/// the sign of plane `e` at the point where the path from c to x meets plane `b`, times the sign of b(c).
fn cross(b: &Plane, e: &Plane, c: &Lattice, x: &Vertex) -> Sign {
    let (bc, ec) = (b.near_value_at_doubled(c), e.near_value_at_doubled(c));
    let (bx, ex) = (x.near_value(b), x.near_value(e));
    let value = bc.0 * ex.0 - ec.0 * bx.0;
    let doubt = |p: (f64, f64), q: (f64, f64)| {
        (p.0.abs() + p.1) * q.1 + p.1 * q.0.abs() + p.0.abs() * q.0.abs() * 4.0 * f64::EPSILON
    };
    if value.abs() > 2.0 * (doubt(bc, ex) + doubt(ec, bx)) {
        return Sign::of(value);
    }
    let left: Int<11> = b.value_at_doubled(c).mul(&x.value(e));
    let right: Int<11> = e.value_at_doubled(c).mul(&x.value(b));
    (left - right).sign()
}
