//! An integer image of triangles, rotated so that many of them are perpendicular to an axis.
//!
//! The box around a triangle that is perpendicular to an axis is flat, so that few such boxes overlap; the
//! box around an oblique triangle overlaps everything near. A rotated body with right angles has mostly
//! oblique walls.

use crate::arith::convert::{as_double, as_number, as_whole};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::extent::Extent;
use crate::geometry::doubles::vector::{cross, dot, normal, unit};
use crate::geometry::doubles::{Point, Triangle};
use crate::geometry::plane::Lattice;

/// The number of triangles sampled to find the axes.
const TRIANGLES_SAMPLED: usize = 64;

/// Axes are rotated if at least one in this many sampled triangles is then flat along an axis.
const SUITED_IF_ONE_IN: usize = 4;

/// Directions are parallel or perpendicular if their cosine is this close to one or to zero: a triangle that
/// deviates by this share of its length counts as flat.
const DIRECTION_TOLERANCE: f64 = 1e-6;

/// A linear map of triangles to integer coordinates, with the box of each triangle's image.
///
/// If two triangles meet, the boxes of their images overlap: after a rotation the boxes are widened by more
/// than its rounding errors.
pub struct Image {
    /// A point near the triangles, and the three directions that become axes; `None` if nothing is rotated.
    frame: Option<(Point, [Point; 3])>,
    /// The boxes of the rotated triangles.
    extents: Vec<Extent>,
    low: Point,
    factor: f64,
}

impl Image {
    /// The number of bits of an integer coordinate.
    pub const BITS: u32 = 40;

    /// Makes the image of `count` triangles; `None` if there are none.
    pub fn of(count: usize, corners: impl Fn(u32) -> Triangle) -> Option<Self> {
        let numbers = 0..as_number(count);
        let step = count.div_ceil(TRIANGLES_SAMPLED).max(1);
        let sample = numbers.clone().step_by(step).map(|k| normal(&corners(k)));
        let normals: Vec<Point> = sample.filter_map(|n| unit(&n)).collect();
        let frame = axes(&normals).map(|axes| (corners(0)[0], axes));
        let extent = |k: u32| Extent::of(&corners(k).map(|p| turned(frame.as_ref(), &p)));
        let extents: Vec<Extent> = numbers.map(extent).collect();
        let whole = extents.iter().copied().reduce(|a, b| a.joined(&b))?;
        let size = (0..3).fold(0.0f64, |m, i| m.max(whole.high[i] - whole.low[i]));
        let factor = as_double(1u64 << Self::BITS) / size;
        Some(Self {
            frame,
            extents,
            low: whole.low,
            // A mesh whose vertices coincide, or whose extent is too small to resolve, has one point as its
            // image.
            factor: if factor.is_finite() { factor } else { 0.0 },
        })
    }

    /// Maps a point to the image; coordinates are not rounded to integers.
    pub fn place(&self, p: &Point) -> Point {
        self.scaled(&turned(self.frame.as_ref(), p))
    }

    /// The least and the largest corner of the box around a triangle's image.
    pub fn ends(&self, triangle: u32) -> (Lattice, Lattice) {
        let whole = |p: &Point, wider: i64| {
            let image = self.scaled(p);
            each_axis(|i| as_whole(image[i]) + wider)
        };
        let extent = &self.extents[triangle as usize];
        // Rotation is wrong by a few units in the last place, far below a step.
        let wider = i64::from(self.frame.is_some());
        (whole(&extent.low, -wider), whole(&extent.high, wider))
    }

    fn scaled(&self, p: &Point) -> Point {
        each_axis(|i| (p[i] - self.low[i]) * self.factor)
    }
}

fn turned(frame: Option<&(Point, [Point; 3])>, p: &Point) -> Point {
    frame.map_or(*p, |(origin, axes)| {
        let from = each_axis(|i| p[i] - origin[i]);
        each_axis(|i| dot(&axes[i], &from))
    })
}

/// Returns three perpendicular directions, the first two of which are the most common normals; `None` if few
/// normals are parallel to these directions, or if they are the coordinate axes.
fn axes(normals: &[Point]) -> Option<[Point; 3]> {
    if normals.iter().all(is_axis) {
        return None;
    }
    let first = most_common(normals, |_| true)?;
    let second = most_common(normals, |a| dot(a, &first).abs() < DIRECTION_TOLERANCE)?;
    let suited = count_along(&first, normals) + count_along(&second, normals);
    if SUITED_IF_ONE_IN * suited < normals.len() || is_axis(&first) && is_axis(&second) {
        return None;
    }
    Some([first, second, cross(&first, &second)])
}

/// Returns the direction, among those that fit, to which most directions are parallel; the first of several.
fn most_common(directions: &[Point], is_fit: impl Fn(&Point) -> bool) -> Option<Point> {
    let fit = directions.iter().rev().filter(|a| is_fit(a));
    fit.max_by_key(|a| count_along(a, directions)).copied()
}

fn count_along(a: &Point, directions: &[Point]) -> usize {
    directions.iter().filter(|b| is_along(a, b)).count()
}

fn is_along(a: &Point, b: &Point) -> bool {
    dot(a, b).abs() > 1.0 - DIRECTION_TOLERANCE
}

fn is_axis(a: &Point) -> bool {
    a.iter().any(|x| x.abs() > 1.0 - DIRECTION_TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::plane::Lattice;

    /// The sides of boxes beside each other, rotated about the z axis.
    fn boxes(count: u32, angle: f64) -> Vec<Triangle> {
        let (sin, cos) = angle.sin_cos();
        let turn = |[x, y, z]: Point| [cos * x - sin * y, sin * x + cos * y, z];
        let side = |k: u32| {
            let x = f64::from(k);
            let [a, b, c] = [[x, 0.0, 0.0], [x, 9.0, 0.0], [x, 0.0, 9.0]];
            let d = [x + 0.5, 0.0, 0.0];
            [[a, b, c], [a, d, c]].map(|t| t.map(turn))
        };
        (0..count).flat_map(side).collect()
    }

    fn overlaps(triangles: &[Triangle]) -> usize {
        let image = Image::of(triangles.len(), |k| triangles[k as usize]).expect("triangles");
        let ends: Vec<(Lattice, Lattice)> = (0..as_number(triangles.len()))
            .map(|k| image.ends(k))
            .collect();
        let meet = |a: &(Lattice, Lattice), b: &(Lattice, Lattice)| {
            (0..3).all(|i| a.0[i] <= b.1[i] && b.0[i] <= a.1[i])
        };
        let after = |k: usize| ends[..k].iter().filter(|a| meet(a, &ends[k])).count();
        (0..ends.len()).map(after).sum()
    }

    #[test]
    fn boxes_that_lie_askew_overlap_no_more_than_those_that_do_not() {
        let straight = overlaps(&boxes(30, 0.0));
        assert_eq!(straight, 30);
        assert_eq!(overlaps(&boxes(30, 0.5)), straight);
    }

    #[test]
    fn what_is_round_stays_as_it_is() {
        let normals: Vec<Point> = (0..30)
            .map(|k| {
                let (y, x) = f64::from(k).sin_cos();
                [0.6 * x, 0.6 * y, 0.8]
            })
            .collect();
        assert!(axes(&normals).is_none());
    }
}
