//! Exact predicates of constructed points: turns in a projection, and sides of planes through points.

use super::axes::each_axis;
use super::doubles::Point;
use super::side::Side;
use super::vertex::{Homogeneous, Vertex, MAX_COORDINATE_ERROR};
use crate::arith::bounds::{ANGLE_LIMBS, CROSS_LIMBS, ORIENTATION_LIMBS, SIDE_LIMBS};
use crate::arith::{Filtered, Int, Sign};

/// The sign of the turn a → b → c in the projection to the axes u and v, positive to the left.
///
/// # Example
/// ```
/// use bspcsg::arith::Sign;
/// use bspcsg::geometry::points::turn;
/// use bspcsg::geometry::vertex::Vertex;
///
/// let [a, b, c] = [[0, 0, 9], [4, 0, 7], [4, 4, 5]].map(Vertex::lattice);
/// assert_eq!(turn([&a, &b, &c], [0, 1]), Sign::Positive);
/// ```
pub fn turn(points: [&Vertex; 3], [u, v]: [usize; 2]) -> Sign {
    if let [Some(a), Some(b), Some(c)] = points.map(Vertex::as_lattice) {
        let step = |p: &[i64; 3], q: &[i64; 3], i: usize| i128::from(q[i] - p[i]);
        return Sign::of(step(a, b, u) * step(a, c, v) - step(a, b, v) * step(a, c, u));
    }
    let [a, b, c] = points.map(Vertex::coordinates);
    let minor = |p: &Int<6>, q: &Int<6>, r: &Int<6>, s: &Int<6>| -> Int<CROSS_LIMBS> {
        let (left, right): (Int<CROSS_LIMBS>, _) = (p.mul(q), r.mul(s));
        left - right
    };
    let by_x: Int<ORIENTATION_LIMBS> = minor(&b.x[v], &c.w, &c.x[v], &b.w).mul(&a.x[u]);
    let by_y: Int<ORIENTATION_LIMBS> = minor(&b.x[u], &c.w, &c.x[u], &b.w).mul(&a.x[v]);
    let by_w: Int<ORIENTATION_LIMBS> = minor(&b.x[u], &c.x[v], &c.x[u], &b.x[v]).mul(&a.w);
    (by_x - by_y + by_w).sign()
}

/// The side of the plane through a, b and c on which d lies; the normal by the right-hand rule points to
/// `Plus`. Always `On` if a, b and c are on one line.
///
/// # Example
/// ```
/// use bspcsg::geometry::points::side;
/// use bspcsg::geometry::side::Side;
/// use bspcsg::geometry::vertex::Vertex;
///
/// let [a, b, c, d] = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 5]].map(Vertex::lattice);
/// assert_eq!(side([&a, &b, &c], &d), Side::Plus);
/// ```
pub fn side([a, b, c]: [&Vertex; 3], d: &Vertex) -> Side {
    clear_side([a, b, c, d].map(Vertex::approx)).or_exact(|| exact_side([a, b, c, d]))
}

/// The side of the plane through a, b and c on which d lies, where the points' doubles decide it.
///
/// If coordinates are below m in magnitude, their differences are off by δ =
/// [`MAX_COORDINATE_ERROR`] m at most; let s bound the differences with that. A product of three is
/// off by 3 s² δ, and there are six of them; rounding adds less than eight units in the last place
/// of each.
pub fn clear_side([a, b, c, d]: [Point; 4]) -> Filtered<Side> {
    let from = |p: &Point| each_axis(|i| p[i] - a[i]);
    let [u, v, w] = [&b, &c, &d].map(from);
    let largest = |points: &[Point]| {
        points
            .as_flattened()
            .iter()
            .fold(0.0f64, |m, x| m.max(x.abs()))
    };
    let off = MAX_COORDINATE_ERROR * largest(&[a, b, c, d]);
    let size = largest(&[u, v, w]) + off;
    let doubt = size * size * (18.0 * off + 48.0 * f64::EPSILON * size);
    let minor = |i: usize, j: usize| u[i] * v[j] - u[j] * v[i];
    let value = minor(1, 2) * w[0] + minor(2, 0) * w[1] + minor(0, 1) * w[2];
    let side = if value > 0.0 { Side::Plus } else { Side::Minus };
    Filtered::when(value.abs() > doubt, side)
}

fn exact_side(points: [&Vertex; 4]) -> Side {
    let [a, b, c, d] = points.map(Vertex::coordinates);
    let [u, v, w] = [&b, &c, &d].map(|p| step(&a, p));
    let minor = |i: usize, j: usize| -> Int<ANGLE_LIMBS> {
        let (left, right): (Int<ANGLE_LIMBS>, _) = (u[i].mul(&v[j]), u[j].mul(&v[i]));
        left - right
    };
    let term = |i: usize, j: usize, k: usize| -> Int<SIDE_LIMBS> { minor(i, j).mul(&w[k]) };
    Side::from_sign((term(1, 2, 0) + term(2, 0, 1) + term(0, 1, 2)).sign())
}

/// The vector from point a to point b, times the weights w of both.
fn step(a: &Homogeneous, b: &Homogeneous) -> [Int<CROSS_LIMBS>; 3] {
    each_axis(|i| {
        let (to, from): (Int<CROSS_LIMBS>, _) = (b.x[i].mul(&a.w), a.x[i].mul(&b.w));
        to - from
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use proptest::prelude::*;

    use super::*;
    use crate::geometry::plane::{Lattice, Plane};

    fn lattice() -> impl Strategy<Value = Lattice> {
        const LIMIT: i64 = (1 << 53) - 1;
        let coordinate =
            || prop_oneof![4 => -3i64..=3, 1 => -LIMIT..=LIMIT, 1 => LIMIT - 9..=LIMIT];
        [coordinate(), coordinate(), coordinate()]
    }

    /// A lattice point, or the meet of a plane through three lattice points with two planes across axes.
    fn point() -> impl Strategy<Value = Vertex> {
        let places = [-5i64..=5, -5i64..=5];
        let met = ([lattice(), lattice(), lattice()], places).prop_filter_map(
            "no single point",
            |([a, b, c], [x, y])| {
                let walls = [(0, x), (1, y)].map(|(axis, at)| Arc::new(Plane::axis_cut(axis, at)));
                Vertex::meet(&Arc::new(Plane::through(&a, &b, &c)?), &walls[0], &walls[1])
            },
        );
        prop_oneof![lattice().prop_map(Vertex::lattice), met]
    }

    proptest! {
        #[test]
        fn sides_of_planes_through_lattice_points_are_those_of_the_planes(
            [a, b, c] in [lattice(), lattice(), lattice()], d in point(),
        ) {
            let corners = [a, b, c].map(Vertex::lattice);
            let found = side(corners.each_ref(), &d);
            let plane = Plane::through(&a, &b, &c);
            prop_assert_eq!(found, plane.map_or(Side::On, |plane| d.side_of(&plane)));
        }

        #[test]
        fn sides_change_with_the_order_of_points(
            [a, b, c, d] in [point(), point(), point(), point()],
        ) {
            let found = side([&a, &b, &c], &d);
            prop_assert_eq!(exact_side([&a, &b, &c, &d]), found);
            prop_assert_eq!(side([&b, &c, &a], &d), found);
            prop_assert_eq!(side([&b, &a, &c], &d), found.opposite());
            prop_assert_eq!(side([&a, &b, &d], &c), found.opposite());
        }

        #[test]
        fn turns_in_a_view_are_sides_of_upright_planes(
            [a, b, c] in [lattice(), lattice(), lattice()], d in point(), axis in 0..3usize,
        ) {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let [a, b] = [a, b].map(|p| each_axis(|i| if i == axis { c[i] } else { p[i] }));
            let upright = Plane::beside_edge(&a, &b, axis);
            let found = turn([&Vertex::lattice(a), &Vertex::lattice(b), &d], [u, v]);
            prop_assert_eq!(Side::from_sign(found), d.side_of(&upright).opposite());
        }
    }
}
