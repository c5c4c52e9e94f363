//! Lengths and heights of triangles, in doubles; they never decide whether a change is right.

use crate::geometry::doubles::vector::{cross, difference, dot, normal};
use crate::geometry::doubles::{Point, Triangle};

/// The rounding error of a sum of three squares and its root, relative to the root, with a margin.
const LENGTH_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The rounding errors of a point between two points, relative to the largest coordinate.
const POINT_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The distance of two points, rounded up.
///
/// Dividing by the largest difference keeps squares of the smallest and the largest doubles apart
/// from zero and infinity.
pub fn distance_above(p: &Point, q: &Point) -> f64 {
    let gap = difference(p, q);
    let most = gap.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if most == 0.0 {
        return 0.0;
    }
    let scaled = gap.map(|x| x / most);
    (dot(&scaled, &scaled).sqrt() * (1.0 + LENGTH_ROUNDING) * most).next_up()
}

/// A bound on the error of a point that is computed between `p` and `q`.
pub fn rounding_of(p: &Point, q: &Point) -> f64 {
    let largest = p.iter().chain(q).fold(0.0f64, |m, x| m.max(x.abs()));
    POINT_ROUNDING * largest
}

/// The lengths of a triangle's edges, each from a corner to the next one.
pub fn lengths(corners: &Triangle) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let edge = difference(&corners[(i + 1) % 3], &corners[i]);
        dot(&edge, &edge).sqrt()
    })
}

/// The least height of a triangle, the one over its longest edge.
pub fn height(corners: &Triangle) -> f64 {
    let longest = lengths(corners).into_iter().fold(0.0, f64::max);
    if longest == 0.0 {
        return 0.0;
    }
    let normal = normal(corners);
    dot(&normal, &normal).sqrt() / longest
}

/// Returns true if the least height or an edge of a triangle is not above the tolerance.
pub fn is_small(corners: &Triangle, tolerance: f64) -> bool {
    height(corners) <= tolerance || lengths(corners).iter().any(|l| *l <= tolerance)
}

/// Six times the volume that a triangle with the edge p → q sweeps when its third corner moves.
pub fn swept(from: &Point, to: &Point, [p, q]: [&Point; 2]) -> f64 {
    dot(
        &difference(to, from),
        &cross(&difference(p, from), &difference(q, from)),
    )
    .abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_height_stands_on_the_longest_edge() {
        let right = [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        assert!((height(&right) - 2.4).abs() < 1e-12);
        assert!(!is_small(&right, 2.0) && is_small(&right, 3.0));
        let needle = [[0.0; 3], [100.0, 0.0, 0.0], [50.0, 0.1, 0.0]];
        assert!(is_small(&needle, 0.2));
    }

    #[test]
    fn distances_are_never_too_short() {
        let tiny = f64::from_bits(1);
        assert!(distance_above(&[0.0; 3], &[tiny; 3]) >= 3.0f64.sqrt() * tiny);
        assert!(distance_above(&[0.0; 3], &[3.0, 4.0, 0.0]) >= 5.0);
        assert!(distance_above(&[1.0; 3], &[1.0; 3]) <= 0.0);
    }
}
