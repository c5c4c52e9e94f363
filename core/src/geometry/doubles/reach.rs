//! Tests in doubles whether a point lies far from the convex hull of a small number of other points.

use crate::geometry::doubles::vector::{cross, difference, dot};
use crate::geometry::doubles::{Point, Triangle};

/// The largest number of steps towards the nearest point of the hull; usually two or three suffice.
const MAX_STEPS: usize = 64;

/// Return whether `point`, outside the convex hull of `others`, lies farther from it than the distance
/// `max_distance`; also true where rounding leaves a doubt, and if `others` is empty.
///
/// The nearest point of the hull lies in a triangle whose corners are among `others`. In each step, the point
/// of `others` that is farthest in the direction of `point` replaces a corner of the triangle.
///
/// # Source
/// Gilbert, Johnson, Keerthi 1988, "A fast procedure for computing the distance between complex
/// objects in three-dimensional space".
///
/// # Example
/// ```
/// use bspcsg::geometry::doubles::reach::is_beyond;
///
/// let square = [[0.0; 3], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [0.0, 4.0, 0.0]];
/// assert!(is_beyond(&[1.0, 2.0, 3.0], &square, 2.9));
/// assert!(!is_beyond(&[-3.0, 2.0, 4.0], &square, 5.0));
/// ```
#[must_use]
pub fn is_beyond(point: &Point, others: &[Point], max_distance: f64) -> bool {
    let Some(mut near) = middle(point, others) else {
        return true;
    };
    let mut triangle = [near; 3];
    for _ in 0..MAX_STEPS {
        let size = square(&near);
        if size <= max_distance * max_distance {
            return false;
        }
        let (along, next) = farthest_against(&near, point, others);
        // All others lie on the far side of a plane that is far enough away.
        if along > 0.0 && along * along > max_distance * max_distance * size {
            return true;
        }
        let [a, b, c] = triangle;
        let found = [[a, b, next], [b, c, next], [c, a, next]].map(|t| (nearest(&t), t));
        let shorter = |p: (Point, Triangle), q: (Point, Triangle)| {
            if square(&q.0) < square(&p.0) {
                q
            } else {
                p
            }
        };
        let [first, second, third] = found;
        let best = shorter(shorter(first, second), third);
        if square(&best.0) >= size {
            return true;
        }
        (near, triangle) = best;
    }
    true
}

/// The vector from a point to the mean of other points; `None` if there are none.
fn middle(point: &Point, others: &[Point]) -> Option<Point> {
    let mut sum = [0.0; 3];
    let mut count = 0.0;
    for other in others {
        let way = difference(other, point);
        sum = [sum[0] + way[0], sum[1] + way[1], sum[2] + way[2]];
        count += 1.0;
    }
    (count > 0.0).then(|| sum.map(|x| x / count))
}

/// Returns the least scalar product of a direction with a vector from `point` to one of `others`, and this
/// vector.
fn farthest_against(direction: &Point, point: &Point, others: &[Point]) -> (f64, Point) {
    let mut least = (f64::INFINITY, *direction);
    for other in others {
        let way = difference(other, point);
        let along = dot(direction, &way);
        if along < least.0 {
            least = (along, way);
        }
    }
    least
}

fn square(p: &Point) -> f64 {
    dot(p, p)
}

/// The point of a triangle that is nearest to the origin.
fn nearest(triangle: &Triangle) -> Point {
    let [a, b, c] = triangle;
    let normal = cross(&difference(b, a), &difference(c, a));
    let share = |p: &Point, q: &Point| dot(&cross(p, q), &normal);
    let shares = [share(b, c), share(c, a), share(a, b)];
    let sum: f64 = shares.iter().sum();
    let on_sides = [[a, b], [b, c], [c, a]].map(|[p, q]| nearest_on(p, q));
    let mut best = on_sides[0];
    for near in &on_sides[1..] {
        if square(near) < square(&best) {
            best = *near;
        }
    }
    if shares.iter().all(|s| *s > 0.0) {
        let at = |i: usize| (shares[0] * a[i] + shares[1] * b[i] + shares[2] * c[i]) / sum;
        let inner = [at(0), at(1), at(2)];
        if square(&inner) < square(&best) {
            best = inner;
        }
    }
    best
}

/// The point of a segment that is nearest to the origin.
fn nearest_on(p: &Point, q: &Point) -> Point {
    let way = difference(q, p);
    let size = square(&way);
    let share = if size > 0.0 {
        (-dot(p, &way) / size).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let at = |i: usize| p[i] + share * way[i];
    [at(0), at(1), at(2)]
}

#[cfg(test)]
mod tests {
    use super::{is_beyond, Point};
    use proptest::prelude::*;

    proptest! {
        /// A point near a convex combination of the others is near their hull; a point above a plane over
        /// them is not.
        #[test]
        fn what_is_near_is_no_farther_than_a_mix(
            others in prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), 1..12),
            shares in prop::collection::vec(0.01..1.0f64, 12),
            height in 1.01..4.0f64,
        ) {
            let point = [0.3, -0.2, height];
            let sum: f64 = shares[..others.len()].iter().sum();
            let mix = |i: usize| {
                let parts = others.iter().zip(&shares).map(|(p, s)| p[i] * s);
                parts.sum::<f64>() / sum
            };
            let to = |p: &Point| (0..3).map(|i| (p[i] - point[i]).powi(2)).sum::<f64>().sqrt();
            prop_assert!(!is_beyond(&point, &others, to(&[mix(0), mix(1), mix(2)]) + 1e-9));
            let highest = others.iter().map(|p| p[2]).fold(f64::NEG_INFINITY, f64::max);
            prop_assert!(is_beyond(&point, &others, height - highest - 1e-9));
        }
    }

    #[test]
    fn a_point_between_far_others_is_at_them() {
        let far = [
            [-1e10, -1e10, 0.0],
            [1e10, -1e10, 0.0],
            [0.0, 1e10, 0.0],
            [3.0, 1.0, 0.5],
        ];
        assert!(!is_beyond(&[7.0, 5.0, 1.0], &far, 1.0 + 1e-5));
        assert!(is_beyond(&[7.0, 5.0, 1.0], &far, 0.5));
        assert!(is_beyond(&[2e10, 0.0, 0.0], &far, 1e9));
    }
}
