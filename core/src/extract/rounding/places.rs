//! Approximate points at which triangles cross.

use std::cmp::Ordering;

use super::crossings::Faults;
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::vector::{difference, dot, normal};
use crate::geometry::doubles::{Point, Triangle};
use crate::mesh::faces::Faces;

/// Returns, for each pair of triangles that cross, a point near the middle of their intersection.
pub fn places(faces: &Faces, found: &Faults) -> Vec<Point> {
    let place = |[t, u]: &[u32; 2]| middle(&faces.corners(*t), &faces.corners(*u));
    found.crossings.iter().map(place).collect()
}

/// The rounded middle of the segment that two triangles share; the first corner of `p` if they share none.
fn middle(p: &Triangle, q: &Triangle) -> Point {
    let mut ends: Vec<Point> = through(p, q).chain(through(q, p)).collect();
    // All ends lie on one line, so lexicographic order is their order on it, and the common segment lies
    // between the inner two.
    ends.sort_by(in_order);
    match ends.len() {
        0 => p[0],
        n => mean(&ends[(n - 1) / 2], &ends[n / 2]),
    }
}

/// Compares two points lexicographically.
fn in_order(a: &Point, b: &Point) -> Ordering {
    let ordered = |i: usize| a[i].total_cmp(&b[i]);
    ordered(0).then_with(|| ordered(1)).then_with(|| ordered(2))
}

/// Yields the points in which the edges of a triangle pass through the plane of another triangle.
fn through<'a>(t: &'a Triangle, plane: &Triangle) -> impl Iterator<Item = Point> + 'a {
    let across = normal(plane);
    let heights = t.map(|c| dot(&difference(&c, &plane[0]), &across));
    (0..3).filter_map(move |i| {
        let (from, to) = (i, (i + 1) % 3);
        let (above, below) = (heights[from], heights[to]);
        let passes = above > 0.0 && below <= 0.0 || above <= 0.0 && below > 0.0;
        let share = above / (above - below);
        passes.then(|| each_axis(|k| t[from][k] + share * (t[to][k] - t[from][k])))
    })
}

fn mean(a: &Point, b: &Point) -> Point {
    each_axis(|i| a[i] / 2.0 + b[i] / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::handle::VertexId;

    #[test]
    fn a_place_lies_in_the_middle_of_what_two_triangles_have_in_common() {
        let floor = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]];
        let wall = [[1.0, 1.0, -1.0], [1.0, 5.0, -1.0], [1.0, 3.0, 3.0]];
        let vertices = [floor, wall].concat();
        let faces = Faces {
            vertices: &vertices,
            triangles: &VertexId::rows(vec![[0, 1, 2], [3, 4, 5]]),
        };
        let found = Faults {
            crossings: vec![[0, 1]],
            flat: Vec::new(),
        };
        assert_eq!(places(&faces, &found), [[1.0, 3.0, 0.0]]);
    }
}
