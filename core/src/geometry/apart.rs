//! Tests whether two lattice triangles are disjoint, by signs of determinants in doubles.

use super::axes::each_axis;
use super::plane::Lattice;
use crate::arith::convert::as_double;
use crate::arith::{Filtered, Sign};
use crate::geometry::winding::path::NearCross;

type Sides = [Filtered<Sign>; 3];

/// A lattice triangle in doubles, prepared to be compared with other triangles.
#[derive(Clone, Copy, Debug)]
pub struct NearTriangle {
    /// The corners; coordinates below 2⁵³ are exact, so that differences are rounded only once.
    corners: [[f64; 3]; 3],
    normal: NearCross,
}

impl NearTriangle {
    /// A placeholder for an unknown triangle: a comparison with it never proves that two triangles have no
    /// common point.
    pub const UNKNOWN: Self = Self {
        corners: [[f64::NAN; 3]; 3],
        normal: NearCross::UNKNOWN,
    };

    /// The triangle with these lattice corners.
    pub fn of(corners: &[Lattice; 3]) -> Self {
        let corners = each_axis(|k| each_axis(|i| as_double(corners[k][i])));
        let [a, b, c] = &corners;
        Self {
            normal: NearCross::of_rounded(&difference(b, a), &difference(c, a)),
            corners,
        }
    }

    /// For each corner of another triangle, the side of this triangle's plane on which the corner lies, as a
    /// sign.
    #[inline]
    fn sides_of(&self, other: &Self) -> Sides {
        let base = &self.corners[0];
        let [x, y, z] = &other.corners;
        [
            self.normal.sign_with_rounded(&difference(x, base)),
            self.normal.sign_with_rounded(&difference(y, base)),
            self.normal.sign_with_rounded(&difference(z, base)),
        ]
    }
}

/// Return whether two lattice triangles certainly have no point in common; may return false negatives.
///
/// They are apart if all corners of one lie strictly on one side of the other's plane, or if the segments in
/// which they meet the common line of the two planes are apart (Möller 1997; in signs alone as Guigue and
/// Devillers 2003).
pub fn are_apart(p: &NearTriangle, q: &NearTriangle) -> bool {
    let of_p = q.sides_of(p);
    if are_on_one_side(of_p) {
        return true;
    }
    let of_q = p.sides_of(q);
    if are_on_one_side(of_q) {
        return true;
    }
    match (lone_corner(of_p), lone_corner(of_q)) {
        (Some(i), Some(k)) => segments_are_apart(&p.corners, i, &q.corners, k),
        _ => false,
    }
}

/// Return whether all three corners of a triangle certainly lie strictly on one side of a plane.
fn are_on_one_side(sides: Sides) -> bool {
    sides[0].is_certain() && sides[1] == sides[0] && sides[2] == sides[0]
}

/// The index of the corner of a triangle that is alone on its side of a plane; `None` if that is not certain.
fn lone_corner(sides: Sides) -> Option<usize> {
    let [Filtered::Certain(a), Filtered::Certain(b), Filtered::Certain(c)] = sides else {
        return None;
    };
    Some(if b == c {
        0
    } else if a == c {
        1
    } else {
        2
    })
}

/// Return whether the segments in which two triangles meet the common line of their planes are certainly
/// apart; corner `i` of `p` is alone on its side of the plane of `q`, and corner `k` of `q` on its side of
/// the plane of `p`.
///
/// An edge of one triangle, an edge of the other, and a vector between these edges span a signed volume; its
/// sign says which edge meets the common line first, up to a sign that is the same for all four pairs.
fn segments_are_apart(p: &[[f64; 3]; 3], i: usize, q: &[[f64; 3]; 3], k: usize) -> bool {
    let (from, other) = (&p[i], &q[k]);
    let toward = difference(other, from);
    let edges = |t: &[[f64; 3]; 3], at: usize| {
        let edge = |step: usize| difference(&t[(at + step) % 3], &t[at]);
        [edge(1), edge(2)]
    };
    let (ours, theirs) = (edges(p, i), edges(q, k));
    let order = |our: &[f64; 3], their: &[f64; 3]| {
        NearCross::of_rounded(our, their).sign_with_rounded(&toward)
    };
    let first = order(&ours[0], &theirs[0]);
    let same = |our: &[f64; 3]| theirs.iter().all(|their| order(our, their) == first);
    first.is_certain() && ours.iter().all(same)
}

#[inline]
fn difference(p: &[f64; 3], q: &[f64; 3]) -> [f64; 3] {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

/// Return whether any point of an edge of `p` lies in `q`, by exact determinants.
#[cfg(test)]
pub fn pierces(p: &[Lattice; 3], q: &[Lattice; 3]) -> bool {
    let difference = |p: &Lattice, q: &Lattice| each_axis(|i| p[i] - q[i]);
    let volume = |a: &Lattice, b: &Lattice, c: &Lattice, d: &Lattice| {
        let (u, v, w) = (difference(b, a), difference(c, a), difference(d, a));
        u[0] * (v[1] * w[2] - v[2] * w[1])
            + u[1] * (v[2] * w[0] - v[0] * w[2])
            + u[2] * (v[0] * w[1] - v[1] * w[0])
    };
    (0..3).any(|e| {
        let (a, b) = (&p[e], &p[(e + 1) % 3]);
        let across =
            volume(a, &q[0], &q[1], &q[2]).signum() * volume(b, &q[0], &q[1], &q[2]).signum();
        let turns = [0, 1, 2].map(|i| volume(a, b, &q[i], &q[(i + 1) % 3]).signum());
        across < 0 && (turns == [1; 3] || turns == [-1; 3])
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::winding::path::near_determinant;

    fn corner(reach: i64) -> impl Strategy<Value = Lattice> {
        [-reach..=reach, -reach..=reach, -reach..=reach]
    }

    #[test]
    fn what_is_not_known_is_apart_from_nothing() {
        let far = NearTriangle::of(&[[99, 0, 0], [99, 1, 0], [99, 0, 1]]);
        let near = NearTriangle::of(&[[0, 0, 0], [0, 1, 0], [0, 0, 1]]);
        assert!(are_apart(&near, &far));
        let unknown = NearTriangle::UNKNOWN;
        assert!(!are_apart(&unknown, &far) && !are_apart(&far, &unknown));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn triangles_that_pierce_each_other_are_not_apart(
            p in [corner(4), corner(4), corner(4)],
            q in [corner(4), corner(4), corner(4)],
        ) {
            let meet = pierces(&p, &q) || pierces(&q, &p);
            let (near_p, near_q) = (NearTriangle::of(&p), NearTriangle::of(&q));
            prop_assert!(!(meet && are_apart(&near_p, &near_q)));
        }

        /// In general position, small triangles are certainly apart or pierce each other.
        #[test]
        fn triangles_in_general_position_are_apart_or_pierce_each_other(
            p in [corner(99), corner(99), corner(99)],
            q in [corner(99), corner(99), corner(99)],
        ) {
            let (near_p, near_q) = (NearTriangle::of(&p), NearTriangle::of(&q));
            let sides = [near_p.sides_of(&near_q), near_q.sides_of(&near_p)];
            let difference = |p: &Lattice, q: &Lattice| each_axis(|i| p[i] - q[i]);
            prop_assume!(sides.iter().flatten().all(Filtered::is_certain));
            let edges = |t: &[Lattice; 3]| [0, 1, 2].map(|i| (t[i], t[(i + 1) % 3]));
            let flat = edges(&p).iter().any(|(a, b)| edges(&q).iter().any(|(c, d)| {
                !near_determinant(&difference(b, a), &difference(c, a), &difference(d, a)).is_certain()
            }));
            prop_assume!(!flat);
            prop_assert_eq!(are_apart(&near_p, &near_q), !(pierces(&p, &q) || pierces(&q, &p)));
        }
    }
}
