//! An integer image of triangles, rotated so that many of them are perpendicular to an axis.
//!
//! The box around a triangle that is perpendicular to an axis is flat, so that few such boxes overlap; the
//! box around an oblique triangle overlaps everything near. A rotated body with right angles has mostly
//! oblique walls, and so have the needles (long thin triangles) along a rotated cylinder.

use crate::arith::convert::{as_double, as_number, as_whole};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::extent::Extent;
use crate::geometry::doubles::vector::{cross, difference, dot, normal, unit};
use crate::geometry::doubles::{Point, Triangle};
use crate::geometry::plane::Lattice;
use crate::mesh::terrains::is_needle;

/// The number of triangles sampled to find the axes.
const TRIANGLES_SAMPLED: usize = 64;

/// Axes are rotated if at least one in this many sampled triangles is then flat along an axis.
const SUITED_IF_ONE_IN: usize = 4;

/// Directions are parallel or perpendicular if their cosine is this close to one or to zero: a triangle that
/// deviates by this share of its length counts as flat.
const DIRECTION_TOLERANCE: f64 = 1e-6;

/// Lines whose directions have a larger cosine count as parallel. Mapping perpendicular to both lines would
/// shrink lengths to less than a twentieth, and the rounding of a rotation must stay far below a step.
const MAX_COSINE_OF_AXES: f64 = 0.99;

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
        let sample: Vec<Triangle> = numbers.clone().step_by(step).map(&corners).collect();
        let normals: Vec<Point> = sample.iter().map(normal).filter_map(|n| unit(&n)).collect();
        let axes = axes(&normals).or_else(|| axes_across_needles(&sample));
        let frame = axes.map(|axes| (corners(0)[0], axes));
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

/// Returns three directions perpendicular to needles (long thin triangles) of a sample; `None` if too few
/// needles are parallel to two lines, or if all needles are parallel to coordinate axes.
///
/// The first direction is perpendicular to both lines; each of the other two lies in the plane of the lines
/// and is perpendicular to one line. So a needle along either line is thin in two directions.
fn axes_across_needles(sample: &[Triangle]) -> Option<[Point; 3]> {
    let needles: Vec<Point> = sample.iter().filter_map(second_edge_direction).collect();
    if SUITED_IF_ONE_IN * needles.len() < sample.len() || needles.iter().all(is_axis) {
        return None;
    }
    let first = most_common(&needles, |_| true)?;
    let second = most_common(&needles, |a| dot(a, &first).abs() < MAX_COSINE_OF_AXES);
    let suited = |a: &Point| count_along(a, &needles);
    if SUITED_IF_ONE_IN * (suited(&first) + second.as_ref().map_or(0, suited)) < sample.len() {
        return None;
    }
    let across = unit(&cross(&first, &second.unwrap_or(beside(&first))))?;
    let in_plane = |a: &Point| cross(a, &across);
    let third = second.map_or(first, |second| in_plane(&second));
    Some([across, in_plane(&first), third])
}

/// Returns the direction of the second longest edge of a needle (a long thin triangle); `None` for any other
/// triangle. The longest edge is the diagonal between two neighbouring needles.
fn second_edge_direction(triangle: &Triangle) -> Option<Point> {
    let [a, b, c] = triangle;
    let mut edges = [difference(b, a), difference(c, b), difference(a, c)];
    edges.sort_unstable_by(|e, f| dot(e, e).total_cmp(&dot(f, f)));
    is_needle(triangle).then(|| unit(&edges[1])).flatten()
}

/// Returns an axis that is not parallel to a direction.
fn beside([x, y, _]: &Point) -> Point {
    if x.abs() < y.abs() {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    }
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

    /// Needles around a line, as on the side of a cylinder, rotated about the y axis.
    fn cylinder(count: u32, angle: f64) -> Vec<Triangle> {
        let (sin, cos) = angle.sin_cos();
        let turn = |[x, y, z]: Point| [cos * x - sin * z, y, sin * x + cos * z];
        let side = |k: u32| {
            let at = |k: u32, z: f64| {
                let (y, x) = (std::f64::consts::TAU * f64::from(k) / f64::from(count)).sin_cos();
                [x, y, z]
            };
            [at(k, -9.0), at(k + 1, -9.0), at(k, 9.0)].map(turn)
        };
        (0..count).map(side).collect()
    }

    #[test]
    fn needles_along_two_lines_overlap_no_more_than_along_an_axis() {
        let straight = overlaps(&cylinder(300, 0.0));
        assert!(straight < 3 * 300, "{straight}");
        assert!(overlaps(&cylinder(300, 0.5)) < 2 * straight);
        let two = [cylinder(300, 0.5), cylinder(300, 1.2)].concat();
        let both = overlaps(&two);
        assert!(both < 10 * straight, "{both}");
    }

    #[test]
    fn no_length_is_lost_across_lines_that_are_nearly_one() {
        for apart in [0.0, 1e-5, 0.01, 0.1, 0.2, 1.0] {
            let two = [cylinder(300, 0.5), cylinder(300, 0.5 + apart)].concat();
            let [a, b, c] = axes_across_needles(&two).expect("needles");
            assert!(dot(&cross(&a, &b), &c).abs() > 0.1, "{apart}");
        }
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
