//! Clips triangles to boxes.
//!
//! # Source
//! Sutherland, Hodgman 1974, "Reentrant polygon clipping": one plane after the other.

use smallvec::SmallVec;

use crate::geometry::axes::each_axis;
use crate::geometry::doubles::{Point, Triangle};

/// A triangle clipped by the six planes of a box, which has up to nine corners.
type Polygon = SmallVec<[Point; 9]>;

/// Returns the bounding box of the part of a triangle inside a box, as low and high corner; `None` if the
/// part is empty.
///
/// The result is off by a few units in the last place of the coordinates.
pub fn part_within(triangle: &Triangle, [low, high]: &[Point; 2]) -> Option<[Point; 2]> {
    let mut polygon = Polygon::from_slice(triangle);
    for axis in 0..3 {
        polygon = part_over(polygon, |p| p[axis] - low[axis]);
        polygon = part_over(polygon, |p| high[axis] - p[axis]);
    }
    let first = *polygon.first()?;
    let end = |i: usize, most: fn(f64, f64) -> f64| {
        let coordinates = polygon.iter().map(|p| p[i]);
        coordinates.fold(first[i], most)
    };
    Some([f64::min, f64::max].map(|most| each_axis(|i| end(i, most))))
}

/// Returns the part of a polygon on which the linear function `height` is at least zero.
fn part_over(polygon: Polygon, height: impl Fn(&Point) -> f64) -> Polygon {
    if polygon.iter().all(|p| height(p) >= 0.0) {
        return polygon;
    }
    let mut part = Polygon::new();
    for (i, p) in polygon.iter().enumerate() {
        let q = &polygon[(i + 1) % polygon.len()];
        let (from, to) = (height(p), height(q));
        if from >= 0.0 {
            part.push(*p);
        }
        if (from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0) {
            let share = from / (from - to);
            part.push(each_axis(|k| p[k] + share * (q[k] - p[k])));
        }
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEEDLE: Triangle = [[0.0, 0.0, 0.0], [8.0, 8.0, 0.0], [8.0, 8.0, 1.0]];

    #[test]
    fn a_needle_along_a_diagonal_has_a_small_part_in_a_small_box() {
        let part = part_within(&NEEDLE, &[[2.0, -9.0, -9.0], [4.0, 9.0, 9.0]]);
        assert_eq!(part, Some([[2.0, 2.0, 0.0], [4.0, 4.0, 0.5]]));
    }

    #[test]
    fn nothing_of_it_is_beside_the_diagonal() {
        assert!(part_within(&NEEDLE, &[[2.0, 5.0, -9.0], [4.0, 9.0, 9.0]]).is_none());
    }

    #[test]
    fn all_of_it_is_in_a_box_that_holds_it() {
        let part = part_within(&NEEDLE, &[[0.0; 3], [8.0; 3]]);
        assert_eq!(part, Some([[0.0; 3], [8.0, 8.0, 1.0]]));
    }
}
