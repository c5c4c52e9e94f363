//! Tests whether a mesh in doubles is star-shaped, by the argument for meshes on the lattice
//! (`merge::arrangement::star`): if a point lies behind the planes of all faces, and a ray from it leaves
//! through exactly one face, no two faces cross.

use crate::arith::convert::{as_double, as_number};
use crate::arith::{Filtered, Sign};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::{seen_along, turn, Facing, Point, Triangle};
use crate::geometry::side::Side;
use crate::mesh::chain::is_closed;
use crate::mesh::faces::Faces;

/// Returns whether a mesh is closed by index and star-shaped about the mean of its vertices; may return
/// false negatives.
///
/// # Cost
/// One test per triangle, up to the first triangle that may have the mean on or outside its plane.
pub fn is_star_shaped(faces: &Faces) -> bool {
    let eye = mean(faces.vertices);
    let mut left = 0;
    for t in 0..as_number(faces.triangles.len()) {
        let facing = Facing::of(&faces.corners(t));
        if facing.clear_strict_side(&eye) != Filtered::Certain(Side::Minus) {
            return false;
        }
        left += u64::from(is_left_by(facing.triangle(), &eye));
    }
    left == 1 && is_closed(faces.triangles)
}

fn mean(points: &[Point]) -> Point {
    let sum = |sum: Point, p: &Point| each_axis(|i| sum[i] + p[i]);
    let sum = points.iter().fold([0.0; 3], sum);
    sum.map(|s| s / as_double(points.len()))
}

/// Returns true if a ray along the first axis, from a point behind a triangle, leaves through the triangle:
/// projected along this axis, its corners then wind counterclockwise around the point.
///
/// If triangles share an edge or a corner on the ray, it leaves through exactly one of them.
fn is_left_by(triangle: &Triangle, eye: &Point) -> bool {
    let [a, b, c] = seen_along(triangle, 0);
    let place = [eye[1], eye[2]];
    let is_below = |p: [f64; 2]| p[1] <= place[1];
    let change = |from: [f64; 2], to: [f64; 2]| match (is_below(from), is_below(to)) {
        (true, false) => i32::from(turn([from, to, place]) == Sign::Positive),
        (false, true) => -i32::from(turn([from, to, place]) == Sign::Negative),
        _ => 0,
    };
    change(a, b) + change(b, c) + change(c, a) > 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::handle::VertexId;

    fn star(vertices: &[Point], triangles: &[[u32; 3]]) -> bool {
        is_star_shaped(&Faces {
            vertices,
            triangles: &VertexId::rows(triangles.iter().copied()),
        })
    }

    /// Double cones over a ring of corners, in which each edge leads `step` corners on.
    fn cones(ring: u32, step: u32) -> (Vec<Point>, Vec<[u32; 3]>) {
        let turn = |i: u32| f64::from(i) * std::f64::consts::TAU / f64::from(ring);
        let corner = |i: u32| [turn(i).cos(), turn(i).sin(), 0.0];
        let ends = |i: u32| (2 + i, 2 + (i + step) % ring);
        let faces = |i: u32| [[0, ends(i).0, ends(i).1], [1, ends(i).1, ends(i).0]];
        let poles = [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
        (
            poles.into_iter().chain((0..ring).map(corner)).collect(),
            (0..ring).flat_map(faces).collect(),
        )
    }

    #[test]
    fn a_surface_that_winds_twice_is_not_star_shaped() {
        let (vertices, triangles) = cones(7, 1);
        assert!(star(&vertices, &triangles));
        assert!(!star(&vertices, &cones(7, 2).1));
        let behind: Vec<[u32; 3]> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
        assert!(!star(&vertices, &behind));
        assert!(!star(&vertices, &triangles[1..]));
    }

    #[test]
    fn rays_that_meet_edges_and_corners_leave_through_one_face() {
        // The mean is the origin; the first axis passes through a corner, or through an edge.
        for ring in [4, 8] {
            let (vertices, triangles) = cones(ring, 1);
            assert!(star(&vertices, &triangles));
            let turned: Vec<Point> = vertices
                .iter()
                .map(|[x, y, z]| [x - y, x + y, *z])
                .collect();
            assert!(star(&turned, &triangles));
        }
    }

    #[test]
    fn a_mesh_that_shows_a_back_is_not() {
        let (mut vertices, triangles) = cones(8, 1);
        vertices[4] = [0.2, 0.2, 0.9];
        assert!(!star(&vertices, &triangles));
    }
}
