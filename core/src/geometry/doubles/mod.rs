//! Exact predicates of points given in doubles.
//!
//! A filter in doubles decides most cases. All other cases are decided in integers: coordinates times a
//! common power of two, in fixed width if their exponents differ little.
#![allow(
    clippy::float_cmp,
    reason = "equal coordinates are meant to the last bit"
)]

pub mod extent;
pub mod hull;
pub mod meeting;
pub mod reach;
pub mod sheets;
pub mod slabs;
pub mod vector;

use num_bigint::BigInt;

use super::axes::each_axis;
use super::side::Side;
use crate::arith::{mantissa_and_exponent, Filtered, Int, Sign};

/// A point of space in finite doubles.
pub type Point = [f64; 3];

/// A triangle, given by its corners.
pub type Triangle = [Point; 3];

/// A hash value for each coordinate of a point; equal coordinates have equal values, and so do zeros of
/// either sign.
///
/// Meant for hash tables, as it uses [`folded`].
///
/// # Example
/// ```
/// use bspcsg::geometry::doubles::bit_key;
///
/// assert_eq!(bit_key(&[0.0, 1.0, 2.0]), bit_key(&[-0.0, 1.0, 2.0]));
/// assert_ne!(bit_key(&[0.0, 1.0, 2.0]), bit_key(&[0.0, 1.0, 3.0]));
/// ```
#[inline]
pub fn bit_key(point: &Point) -> [u64; 3] {
    point.map(|c| folded((c + 0.0).to_bits()))
}

/// The bits of a double, the upper half folded into the lower one; different bits give different results.
///
/// Integers of few bits differ only in the upper bits of their doubles. A product hash drops these and would
/// put all whole coordinates in the same few slots.
#[inline]
pub fn folded(bits: u64) -> u64 {
    bits ^ (bits >> (u64::BITS / 2))
}

/// Half a unit in the last place of 1: the largest relative error of one rounding.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// The relative error bound A of orient3d in Shewchuk 1997, "Adaptive precision floating-point arithmetic".
const SIDE_BOUND: f64 = (7.0 + 56.0 * ROUNDING) * ROUNDING;

/// The relative error bound A of orient2d in Shewchuk 1997, "Adaptive precision floating-point arithmetic".
const TURN_BOUND: f64 = (3.0 + 16.0 * ROUNDING) * ROUNDING;

/// The range of sums of products for which the error bounds of the filters are valid. These bounds assume no
/// underflow and no overflow; sums outside this range may have had either. A product of three differences
/// below 1e100 that lost 2^-1074 in one step is off by 1e-223 at most, far less than the bound at 1e-200.
const TRUSTED: std::ops::Range<f64> = 1e-200..1e200;

/// The largest difference of exponents for which integers of fixed width suffice: 53 + 70 bits for a
/// coordinate, 124 for a difference, 249 for a minor of two rows, 375 for a determinant of three.
const MAX_EXPONENT_DIFFERENCE: i32 = 70;

/// A triangle with the products that define its plane, prepared for questions on which side points lie.
#[derive(Clone, Copy, Debug)]
pub struct Facing {
    triangle: Triangle,
    minors: Point,
    sizes: Point,
}

impl Facing {
    /// Prepares a triangle for questions on which side of its plane points lie.
    #[inline]
    pub fn of(triangle: &Triangle) -> Self {
        let [a, b, c] = triangle;
        let (u, v) = (difference(b, a), difference(c, a));
        let products = |j: usize, k: usize| (u[j] * v[k], u[k] * v[j]);
        let (x, y, z) = (products(1, 2), products(2, 0), products(0, 1));
        let size = |(left, right): (f64, f64)| left.abs() + right.abs();
        Self {
            triangle: *triangle,
            minors: [x.0 - x.1, y.0 - y.1, z.0 - z.1],
            sizes: [size(x), size(y), size(z)],
        }
    }

    /// The triangle that was prepared.
    #[inline]
    pub fn triangle(&self) -> &Triangle {
        &self.triangle
    }

    /// The sign of the turn of the corners in the projection along an axis; certain only where doubles settle
    /// it and it is not zero.
    #[inline]
    pub fn clear_turn(&self, axis: usize) -> Filtered<Sign> {
        let (value, size) = (self.minors[axis], self.sizes[axis]);
        let clear = value.abs() > TURN_BOUND * size && TRUSTED.contains(&size);
        Filtered::when(clear, Sign::of(value))
    }

    /// The side of the triangle's plane on which a point lies, exactly; the normal by the right-hand rule
    /// points to `Plus`.
    #[inline]
    pub fn side(&self, d: &Point) -> Side {
        let [a, b, c] = &self.triangle;
        self.clear_side(d).or_exact(|| exact_side([a, b, c, d]))
    }

    /// The side of the triangle's plane on which a point lies, if doubles decide it; `On` can be certain only
    /// if the plane is perpendicular to an axis.
    #[inline]
    pub fn clear_side(&self, d: &Point) -> Filtered<Side> {
        let [a, b, c] = &self.triangle;
        let level = |i: usize| a[i] == d[i] && b[i] == d[i] && c[i] == d[i];
        if level(0) || level(1) || level(2) {
            return Filtered::Certain(Side::On);
        }
        self.clear_strict_side(d)
    }

    /// The side of the triangle's plane on which a point lies, if doubles prove that the point is not in the
    /// plane; else doubtful.
    #[inline]
    pub fn clear_strict_side(&self, d: &Point) -> Filtered<Side> {
        let (value, error) = self.height(d);
        let side = if value > 0.0 { Side::Plus } else { Side::Minus };
        Filtered::when(value.abs() > error, side)
    }

    /// Return whether doubles prove that all points lie strictly on one side of the triangle's plane.
    #[inline]
    pub fn clearly_on_one_side<'a>(&self, points: impl Iterator<Item = &'a Point>) -> bool {
        let (mut above, mut below) = (true, true);
        for (value, error) in points.map(|d| self.height(d)) {
            above &= value > error;
            below &= value < -error;
            if !(above || below) {
                return false;
            }
        }
        true
    }

    /// Six times the signed volume that a point spans with the triangle, and a bound on its error.
    #[inline]
    fn height(&self, d: &Point) -> (f64, f64) {
        let (m, s) = (&self.minors, &self.sizes);
        let w = difference(d, &self.triangle[0]);
        let value = m[0] * w[0] + m[1] * w[1] + m[2] * w[2];
        let size = s[0] * w[0].abs() + s[1] * w[1].abs() + s[2] * w[2].abs();
        let is_trusted = TRUSTED.contains(&size);
        (
            value,
            if is_trusted {
                SIDE_BOUND * size
            } else {
                f64::INFINITY
            },
        )
    }

    /// The axis along which the triangle's projection has the largest area, by doubles.
    pub fn main_axis(&self) -> usize {
        let [x, y, z] = self.minors;
        let (x, y, z) = (x.abs(), y.abs(), z.abs());
        if x >= y && x >= z {
            0
        } else {
            1 + usize::from(z > y)
        }
    }
}

#[inline]
fn difference(p: &Point, q: &Point) -> Point {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

/// The side of the plane through a triangle's corners on which a point lies; exact. The normal by the
/// right-hand rule points to `Plus`.
///
/// # Example
/// ```
/// use bspcsg::geometry::doubles::side;
/// use bspcsg::geometry::side::Side;
///
/// let floor = [[0.0, 0.0, 0.1], [1.0, 0.0, 0.1], [0.0, 1.0, 0.1]];
/// // The sum of these doubles is a little more than the double 0.3.
/// assert_eq!(side(&floor, &[0.2, 0.2, 0.1 + 0.2 - 0.2]), Side::Plus);
/// assert_eq!(side(&floor, &[0.2, 0.2, 0.1]), Side::On);
/// ```
#[inline]
pub fn side(triangle: &Triangle, d: &Point) -> Side {
    Facing::of(triangle).side(d)
}

fn exact_side(points: [&Point; 4]) -> Side {
    let parts = points.map(|p| p.map(mantissa_and_exponent));
    if let Some(grid) = on_common_grid(parts.as_flattened()) {
        let from = |p: usize, i: usize| Int::<2>::from_i128(grid[3 * p + i] - grid[i]);
        let [u, v, w] = [1, 2, 3].map(|p| each_axis(|i| from(p, i)));
        let minor = |j: usize, k: usize| u[j].mul::<2, 4>(&v[k]) - u[k].mul::<2, 4>(&v[j]);
        let term = |i: usize| minor((i + 1) % 3, (i + 2) % 3).mul::<2, 6>(&w[i]);
        Side::from_sign((term(0) + term(1) + term(2)).sign())
    } else {
        let grid = on_big_grid(parts.as_flattened());
        let from = |p: usize, i: usize| &grid[3 * p + i] - &grid[i];
        let [u, v, w] = [1, 2, 3].map(|p| each_axis(|i| from(p, i)));
        let minor = |j: usize, k: usize| &u[j] * &v[k] - &u[k] * &v[j];
        let term = |i: usize| minor((i + 1) % 3, (i + 2) % 3) * &w[i];
        Side::from_order((term(0) + term(1) + term(2)).cmp(&BigInt::ZERO))
    }
}

/// The sign of the turn a → b → c in the plane, positive to the left; exact.
#[inline]
pub fn turn(points: [[f64; 2]; 3]) -> Sign {
    clear_turn(points)
        .or_else(|| turn_by_parts(points))
        .or_exact(|| exact_turn(points))
}

/// The sign of the turn a → b → c in the plane; certain only where doubles settle it and it is not zero.
#[inline]
pub fn clear_turn([a, b, c]: [[f64; 2]; 3]) -> Filtered<Sign> {
    let left = (b[0] - a[0]) * (c[1] - a[1]);
    let right = (b[1] - a[1]) * (c[0] - a[0]);
    let (value, size) = (left - right, left.abs() + right.abs());
    let clear = value.abs() > TURN_BOUND * size && TRUSTED.contains(&size);
    Filtered::when(clear, Sign::of(value))
}

/// The sign of the turn a → b → c, certain only where all differences of coordinates are exact in doubles, so
/// that comparing two products decides; that is usual for points on axis-parallel lines.
fn turn_by_parts([a, b, c]: [[f64; 2]; 3]) -> Filtered<Sign> {
    let [u, v] = [b, c].map(|p| [0, 1].map(|i| exact_difference(p[i], a[i])));
    // Rounding keeps the order of products; products with equal roundings are ordered by their rounding
    // errors.
    let order = || {
        let [left, right] = [exact_product(u[0]?, v[1]?)?, exact_product(u[1]?, v[0]?)?];
        left.partial_cmp(&right)
    };
    match order() {
        Some(order) => Filtered::Certain(Sign::from_order(order)),
        None => Filtered::Doubtful,
    }
}

/// The difference a − b, or `None` if it is not exact in doubles (Knuth's sum of two).
fn exact_difference(a: f64, b: f64) -> Option<f64> {
    let difference = a - b;
    let of_b = a - difference;
    let lost = (a - (difference + of_b)) + (of_b - b);
    (lost == 0.0).then_some(difference)
}

/// A product as its rounded value and the exact rest (Veltkamp and Dekker); `None` if it may over- or
/// underflow.
fn exact_product(a: f64, b: f64) -> Option<(f64, f64)> {
    let product = a * b;
    if product == 0.0 {
        return (a == 0.0 || b == 0.0).then_some((0.0, 0.0));
    }
    if [a, b, product].iter().any(|x| !TRUSTED.contains(&x.abs())) {
        return None;
    }
    let ([a, a_tail], [b, b_tail]) = (halves(a), halves(b));
    let rest = a_tail * b_tail - (((product - a * b) - a_tail * b) - a * b_tail);
    Some((product, rest))
}

/// The leading 26 bits of a double, and its other bits, as two doubles.
fn halves(x: f64) -> [f64; 2] {
    const SPLITTER: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = SPLITTER * x;
    let leading = scaled - (scaled - x);
    [leading, x - leading]
}

fn exact_turn(points: [[f64; 2]; 3]) -> Sign {
    let parts = points.map(|p| p.map(mantissa_and_exponent));
    if let Some(grid) = on_common_grid(parts.as_flattened()) {
        let from = |p: usize, i: usize| Int::<2>::from_i128(grid[2 * p + i] - grid[i]);
        let [u, v] = [1, 2].map(|p| [from(p, 0), from(p, 1)]);
        (u[0].mul::<2, 4>(&v[1]) - u[1].mul::<2, 4>(&v[0])).sign()
    } else {
        let grid = on_big_grid(parts.as_flattened());
        let from = |p: usize, i: usize| &grid[2 * p + i] - &grid[i];
        let [u, v] = [1, 2].map(|p| [from(p, 0), from(p, 1)]);
        Sign::from_order((&u[0] * &v[1]).cmp(&(&u[1] * &v[0])))
    }
}

/// Numbers, given by mantissas and exponents, as multiples of the smallest power of two among them; `None` if
/// these do not fit.
fn on_common_grid(parts: &[(i64, i32)]) -> Option<[i128; 12]> {
    let exponents = || parts.iter().filter(|p| p.0 != 0).map(|p| p.1);
    let (least, most) = (
        exponents().min().unwrap_or(0),
        exponents().max().unwrap_or(0),
    );
    if most - least > MAX_EXPONENT_DIFFERENCE {
        return None;
    }
    let mut grid = [0; 12];
    for (place, (mantissa, exponent)) in grid.iter_mut().zip(parts) {
        if *mantissa != 0 {
            *place = i128::from(*mantissa) << (exponent - least);
        }
    }
    Some(grid)
}

fn on_big_grid(parts: &[(i64, i32)]) -> Vec<BigInt> {
    let exponents = parts.iter().filter(|p| p.0 != 0).map(|p| p.1);
    let least = exponents.min().unwrap_or(0);
    let scaled = |(m, e): &(i64, i32)| BigInt::from(*m) << (e - least).max(0).unsigned_abs();
    parts.iter().map(scaled).collect()
}

/// Return whether the corners of a triangle lie on one line, or two or all of them coincide; exact.
pub fn is_flat(triangle: &Triangle) -> bool {
    (0..3).all(|axis| turn(seen_along(triangle, axis)) == Sign::Zero)
}

/// The corners of a triangle projected along an axis, as seen from the axis' positive end.
#[inline]
pub fn seen_along([a, b, c]: &Triangle, axis: usize) -> [[f64; 2]; 3] {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    [[a[u], a[v]], [b[u], b[v]], [c[u], c[v]]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_exact_in_the_last_place() {
        let step = f64::EPSILON;
        let (a, b) = ([0.0, 0.0], [1.0 + step, 1.0 + step]);
        assert_eq!(turn([a, b, [2.0, 2.0]]), Sign::Zero);
        assert_eq!(turn([a, b, [2.0, 2.0 + 2.0 * step]]), Sign::Positive);
        assert_eq!(turn([a, b, [2.0, 2.0 - step]]), Sign::Negative);
        assert_eq!(turn([a, [1e-300, 1e-300], [1e300, 1e300]]), Sign::Zero);
        assert_eq!(
            turn([[-1.0, 0.5], [0.0, 0.5], [0.5, 0.5 + step]]),
            Sign::Positive
        );
    }

    #[test]
    fn turns_by_parts_agree_with_integers() {
        let mut decided = 0;
        for seed in 0..4000u32 {
            let next = |k: u32| f64::from((seed * 8 + k).wrapping_mul(2_654_435_761) >> 8);
            let scale = [1.0, 0.1, 1e-90, 1e80][seed as usize % 4];
            let [a, u] = [[next(0), next(1)], [next(2), next(3)]].map(|p| p.map(|x| x * scale));
            let along = |t: f64| [a[0] + t * u[0], a[1] + t * u[1]];
            let points = [a, along(2.0), along(f64::from(seed % 3) - 0.5)];
            if let Filtered::Certain(sign) = turn_by_parts(points) {
                assert_eq!(sign, exact_turn(points), "seed {seed}");
                decided += 1;
            }
        }
        assert!(decided > 1000, "{decided}");
    }

    #[test]
    fn sides_are_exact_in_the_last_place() {
        let step = f64::EPSILON;
        let plane = [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
        assert_eq!(side(&plane, &[0.25, 0.5, 0.75]), Side::On);
        assert_eq!(side(&plane, &[0.5, 0.25, 0.75 + step]), Side::Plus);
        assert_eq!(side(&plane, &[0.5, 0.25, 0.75 - step]), Side::Minus);
        let far = [[0.0, 0.0, 0.0], [1e300, 0.0, 1e300], [0.0, 1e-300, 1e-300]];
        assert_eq!(side(&far, &[1.0, 1.0, 2.0]), Side::On);
        assert_eq!(side(&far, &[1.0, 1.0, 2.0 + 2.0 * step]), Side::Plus);
    }

    #[test]
    fn integers_of_fixed_width_and_big_ones_agree() {
        // Nearly coplanar points, with exponents that fit the fixed width and with exponents that do not.
        for seed in 0..2000u32 {
            let next = |k: u32| f64::from((seed * 12 + k).wrapping_mul(2_654_435_761)) / 4e9;
            let mut points = [0, 1, 2, 3].map(|p| [0, 1, 2].map(|i| next(3 * p + i) + 1.0));
            points[3] = each_axis(|i| (points[0][i] + points[1][i]) * 0.5);
            let parts = points.map(|p| p.map(mantissa_and_exponent));
            let grid = on_big_grid(parts.as_flattened());
            let from = |p: usize, i: usize| &grid[3 * p + i] - &grid[i];
            let minor = |j: usize, k: usize| from(1, j) * from(2, k) - from(1, k) * from(2, j);
            let term = |i: usize| minor((i + 1) % 3, (i + 2) % 3) * from(3, i);
            let [a, b, c, d] = &points;
            let expected = Side::from_order((term(0) + term(1) + term(2)).cmp(&BigInt::ZERO));
            assert_eq!(side(&[*a, *b, *c], d), expected, "seed {seed}");
        }
    }

    #[test]
    fn triangles_on_a_line_are_flat() {
        assert!(is_flat(&[[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]]));
        assert!(is_flat(&[[1.0; 3], [1.0; 3], [3.0, 1.0, 3.0]]));
        assert!(!is_flat(&[
            [0.0; 3],
            [1.0, 1.0, 1.0],
            [3.0, 3.0, 3.0 + 1e-15]
        ]));
    }
}
