//! Compares the sum of two angles in a plane to 180 degrees, exactly.
//!
//! Angles are kept as their cosine and sine, up to one positive factor: the inner product and the
//! determinant of two differences of points. The sine of the sum of two angles is a polynomial of
//! degree four in the points; its sign tells whether the sum is below or above 180 degrees.

use std::cmp::Ordering;

use crate::arith::bounds::{ANGLES_LIMBS, ANGLE_LIMBS, CROSS_LIMBS, NORMAL_LIMBS};
use crate::arith::{Filtered, Int, Sign};
use crate::geometry::plane::Lattice;
use crate::geometry::vertex::{Homogeneous, Vertex, MAX_COORDINATE_ERROR};

/// The two ends of an edge, then the apexes of the two triangles at the edge, as (x, y) in doubles that are
/// accurate to [`MAX_COORDINATE_ERROR`].
pub(super) type Quad = [[f64; 2]; 4];

/// Compares the sum of the angles at the two apexes to 180 degrees in doubles, or returns `Doubtful` if
/// rounding errors could change the result.
pub(super) fn rough([a, b, c, d]: Quad) -> Filtered<Ordering> {
    let larger = |p: [f64; 2]| p[0].abs().max(p[1].abs());
    let doubt = MAX_COORDINATE_ERROR * larger(a).max(larger(b)).max(larger(c)).max(larger(d));
    let (first, second) = (Rough::at(c, a, b, doubt), Rough::at(d, b, a, doubt));
    let (left, right) = (first.cos * second.sin, second.cos * first.sin);
    let spread = |one: &Rough, other: &Rough| one.cos.abs().max(one.sin.abs()) * other.doubt;
    let bound = 2.0 * (spread(&first, &second) + spread(&second, &first))
        + 2.0 * first.doubt * second.doubt
        + 4.0 * f64::EPSILON * (left.abs() + right.abs());
    let sine = left + right;
    Filtered::when(sine.abs() > bound, (-Sign::of(sine)).order())
}

/// The cosine and sine of an angle, both multiplied by one common positive factor, as doubles, and a bound on
/// their errors.
struct Rough {
    cos: f64,
    sin: f64,
    doubt: f64,
}

impl Rough {
    /// The angle at `apex` from `p` to `q`, whose coordinates may be wrong by `doubt`.
    fn at(apex: [f64; 2], p: [f64; 2], q: [f64; 2], doubt: f64) -> Self {
        let [ux, uy] = [p[0] - apex[0], p[1] - apex[1]];
        let [vx, vy] = [q[0] - apex[0], q[1] - apex[1]];
        let (u, v) = (ux.abs() + uy.abs(), vx.abs() + vy.abs());
        Self {
            cos: ux * vx + uy * vy,
            sin: ux * vy - uy * vx,
            doubt: 2.0 * doubt * (u + v + 2.0 * doubt) + 4.0 * f64::EPSILON * u * v,
        }
    }
}

/// Compares the sum of the angles at the last two points, over the edge between the first two, to 180
/// degrees exactly, in the coordinates `axes`.
pub(super) fn exact(points: [&Vertex; 4], axes: [usize; 2]) -> Ordering {
    if let [Some(a), Some(b), Some(c), Some(d)] = points.map(Vertex::as_lattice) {
        return on_lattice([a, b, c, d], axes);
    }
    let [a, b, c, d] = points.map(Vertex::coordinates);
    let (first, second) = (wide_angle(&c, &a, &b, axes), wide_angle(&d, &b, &a, axes));
    let left: Int<ANGLES_LIMBS> = first[0].mul(&second[1]);
    let right: Int<ANGLES_LIMBS> = second[0].mul(&first[1]);
    (-(left + right).sign()).order()
}

fn on_lattice([a, b, c, d]: [&Lattice; 4], axes: [usize; 2]) -> Ordering {
    let angle = |apex: &Lattice, p: &Lattice, q: &Lattice| -> [Int<NORMAL_LIMBS>; 2] {
        let [ux, uy] = axes.map(|i| i128::from(p[i] - apex[i]));
        let [vx, vy] = axes.map(|i| i128::from(q[i] - apex[i]));
        [ux * vx + uy * vy, ux * vy - uy * vx].map(Int::from_i128)
    };
    let (first, second) = (angle(c, a, b), angle(d, b, a));
    let left: Int<{ 2 * NORMAL_LIMBS }> = first[0].mul(&second[1]);
    let right: Int<{ 2 * NORMAL_LIMBS }> = second[0].mul(&first[1]);
    (-(left + right).sign()).order()
}

/// Returns the cosine and sine of the angle at `apex` from `p` to `q`, both multiplied by one common positive
/// factor.
fn wide_angle(
    apex: &Homogeneous,
    p: &Homogeneous,
    q: &Homogeneous,
    axes: [usize; 2],
) -> [Int<ANGLE_LIMBS>; 2] {
    let difference = |point: &Homogeneous, axis: usize| -> Int<CROSS_LIMBS> {
        let theirs: Int<CROSS_LIMBS> = point.x[axis].mul(&apex.w);
        let ours: Int<CROSS_LIMBS> = apex.x[axis].mul(&point.w);
        theirs - ours
    };
    let [ux, uy] = axes.map(|axis| difference(p, axis));
    let [vx, vy] = axes.map(|axis| difference(q, axis));
    let product = |s: &Int<CROSS_LIMBS>, t: &Int<CROSS_LIMBS>| -> Int<ANGLE_LIMBS> { s.mul(t) };
    [
        product(&ux, &vx) + product(&uy, &vy),
        product(&ux, &vy) - product(&uy, &vx),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[i64; 2]; 4] = [[0, 0], [7, 7], [0, 7], [7, 0]];

    /// The corners of a square, all shifted by `shift` in x and y, the last also by `moved` outwards.
    fn square(moved: i64, shift: i64) -> [Lattice; 4] {
        let mut corners = CORNERS.map(|[x, y]| [x + shift, y + shift, 3]);
        corners[3] = [corners[3][0] + moved, corners[3][1] - moved, 3];
        corners
    }

    /// The point `p` with the weight 2, so that its representation does not say that it is a lattice point.
    fn given(p: Lattice) -> Vertex {
        let twice = |k: i64| Int::from_i64(2 * k);
        Vertex::homogeneous(p.map(twice), Int::from_i64(2))
    }

    #[test]
    fn a_step_tells_wherever_the_points_are() {
        for shift in [0, -(1 << 40), (1 << 53) - 100] {
            for (moved, expected) in [
                (-1, Ordering::Greater),
                (0, Ordering::Equal),
                (1, Ordering::Less),
            ] {
                let corners = square(moved, shift);
                let ours = corners.map(Vertex::lattice);
                assert_eq!(exact(ours.each_ref(), [0, 1]), expected);
                let theirs = corners.map(given);
                assert_eq!(exact(theirs.each_ref(), [0, 1]), expected);
                let places = ours.each_ref().map(Vertex::approx);
                let told = rough(places.map(|p| [p[0], p[1]]));
                assert!([Filtered::Doubtful, Filtered::Certain(expected)].contains(&told));
                assert!(told.is_certain() || shift != 0 || moved == 0);
            }
        }
    }
}
