//! Rounded differences and products of vectors in doubles.

use super::{Point, Triangle};

/// The vector p − q, from `q` to `p`.
#[inline]
pub fn difference(p: &Point, q: &Point) -> Point {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

/// The scalar product of two vectors.
#[inline]
pub fn dot(u: &Point, v: &Point) -> f64 {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

/// The vector product of two vectors: perpendicular to both, its length the area of their parallelogram.
///
/// # Example
/// ```
/// use bspcsg::geometry::doubles::vector::{cross, dot};
///
/// let (x, y) = ([2.0, 0.0, 0.0], [0.0, 3.0, 0.0]);
/// assert_eq!(cross(&x, &y), [0.0, 0.0, 6.0]);
/// assert_eq!(dot(&cross(&x, &y), &x), 0.0);
/// ```
#[inline]
pub fn cross(u: &Point, v: &Point) -> Point {
    let minor = |j: usize, k: usize| u[j] * v[k] - u[k] * v[j];
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// Returns a vector scaled to length 1; `None` for the zero vector and for infinite lengths.
pub fn unit(v: &Point) -> Option<Point> {
    let length = dot(v, v).sqrt();
    (length > 0.0 && length.is_finite()).then(|| v.map(|x| x / length))
}

/// The normal of a triangle by the right-hand rule, its length twice the triangle's area.
#[inline]
pub fn normal([a, b, c]: &Triangle) -> Point {
    cross(&difference(b, a), &difference(c, a))
}
