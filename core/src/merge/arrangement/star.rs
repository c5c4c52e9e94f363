//! Tests whether a closed mesh is star-shaped: a point inside sees all of its faces from behind, and no face
//! hides another.
//!
//! Let a point lie strictly behind the planes of all faces. Seen from it, each face covers its part of the
//! sphere of directions once, and all faces have the same orientation. The surface has no border, so both
//! sides of an edge are covered by the same number of faces. Hence a ray from the point that meets no edge
//! meets the same number of faces in every direction. If one ray meets a single face, all do: no two faces
//! overlap or cross, and the winding number is 1 inside the faces and 0 outside.
//!
//! All convex meshes are star-shaped about the mean of their vertices, however their flat sides are divided,
//! except slivers so thin that the rounded mean is not inside them.
//!
//! # Source
//! Mehlhorn, Näher, Seel, Seidel, Schilz, Schirra, Uhrig: *Checking geometric programs or
//! verification of geometric structures*, 1999. The ray distinguishes one covering from several.

use crate::arith::bounds::MAX_COORDINATE;
use crate::arith::Sign;
use crate::geometry::axes::each_axis;
use crate::geometry::plane::Lattice;
use crate::geometry::winding::crossing::{triangle_change, Segment};
use crate::geometry::winding::path::determinant;
use crate::mesh::triangles::TriangleMesh;

/// Returns true if a mesh is certainly star-shaped about the mean of its vertices; its edges must pair by
/// vertex index.
pub fn is_star_shaped(mesh: &TriangleMesh) -> bool {
    let Some(eye) = mean(&mesh.vertices) else {
        return false;
    };
    let ray = Segment {
        from: eye.map(|c| 2 * c),
        axis: 0,
        to: 2 * MAX_COORDINATE,
    };
    let mut change = 0;
    for face in mesh.face_ids() {
        let corners = mesh.corners(face);
        let seen = corners.map(|corner| each_axis(|i| corner[i] - eye[i]));
        if !is_ahead(&seen) {
            return false;
        }
        if !is_beside(&seen, 1) && !is_beside(&seen, 2) {
            change += triangle_change(&corners, &ray);
        }
    }
    change == -1
}

/// Returns the mean of points, with each coordinate rounded down; `None` if there are no points.
#[allow(clippy::cast_possible_truncation, reason = "a mean of coordinates")]
fn mean(points: &[Lattice]) -> Option<Lattice> {
    let sum = points.iter().fold([0; 3], |sum: [i128; 3], p| {
        each_axis(|i| sum[i] + i128::from(p[i]))
    });
    let count = i128::try_from(points.len()).ok().filter(|n| *n > 0)?;
    Some(sum.map(|s| s.div_euclid(count) as i64))
}

/// Returns true if the origin lies strictly behind the plane of a face.
fn is_ahead([a, b, c]: &[Lattice; 3]) -> bool {
    determinant(a, b, c) == Sign::Positive
}

/// Returns true if the coordinates of all corners on an axis are positive, or all are negative.
///
/// A ray from near the origin along another axis does not meet such a face. The signs are unpredictable, so
/// their bits are combined without a branch.
fn is_beside(corners: &[Lattice; 3], axis: usize) -> bool {
    let [a, b, c] = corners.map(|corner| corner[axis]);
    (a & b & c | -a & -b & -c) < 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arith::convert::as_whole;
    use crate::mesh::handle::VertexId;

    fn tetrahedron() -> TriangleMesh {
        TriangleMesh {
            vertices: vec![[0, 0, 0], [88, 0, 0], [0, 88, 0], [0, 0, 88]],
            faces: [[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]
                .map(|f| f.map(VertexId))
                .to_vec(),
            ..TriangleMesh::default()
        }
    }

    /// Double cones over a closed ring of `ring` corners, whose edges connect each corner with the one `step`
    /// further on.
    fn cone(ring: u32, step: u32) -> TriangleMesh {
        let corner = |i: u32| {
            let turn = f64::from(i) * std::f64::consts::TAU / f64::from(ring);
            [as_whole(1e6 * turn.cos()), as_whole(1e6 * turn.sin()), 0]
        };
        let ends = |i: u32| (2 + i, 2 + (i + step) % ring);
        let faces = |i: u32| [[0, ends(i).0, ends(i).1], [1, ends(i).1, ends(i).0]];
        TriangleMesh {
            vertices: [[0, 0, 1_000_000], [0, 0, -1_000_000]]
                .into_iter()
                .chain((0..ring).map(corner))
                .collect(),
            faces: (0..ring).flat_map(faces).map(|f| f.map(VertexId)).collect(),
            ..TriangleMesh::default()
        }
    }

    #[test]
    fn convex_meshes_are_star_shaped() {
        assert!(is_star_shaped(&tetrahedron()));
        assert!(is_star_shaped(&cone(7, 1)));
    }

    #[test]
    fn slivers_are_where_doubles_cannot_tell() {
        let mut mesh = tetrahedron();
        for p in &mut mesh.vertices {
            *p = [
                p[0] + (p[1] << 20) + (p[2] << 41),
                p[1] + (p[2] << 20),
                p[2],
            ];
        }
        assert!(is_star_shaped(&mesh));
    }

    #[test]
    fn meshes_turned_inside_out_are_not() {
        let mut mesh = tetrahedron();
        mesh.faces.iter_mut().for_each(|f| f.swap(1, 2));
        assert!(!is_star_shaped(&mesh));
    }

    #[test]
    fn no_ray_meets_a_face_beside_it() {
        let digit = |n: i64, at: u32| n / 3i64.pow(at) % 3 - 1;
        let ray = Segment {
            from: [0; 3],
            axis: 0,
            to: 2 * MAX_COORDINATE,
        };
        for n in 0..3i64.pow(9) {
            let corners = [0, 3, 6].map(|k| [0, 1, 2].map(|i| digit(n, k + i)));
            if is_beside(&corners, 1) || is_beside(&corners, 2) {
                assert_eq!(triangle_change(&corners, &ray), 0, "{corners:?}");
            }
        }
    }

    /// The surfaces are convex at every edge, with the eye behind all faces, but wind two or three times
    /// around two vertices.
    #[test]
    fn surfaces_that_wind_around_the_eye_more_than_once_are_not() {
        assert!(!is_star_shaped(&cone(7, 2)));
        assert!(!is_star_shaped(&cone(7, 3)));
    }

    #[test]
    fn surfaces_that_are_there_twice_are_not() {
        let mut mesh = tetrahedron();
        mesh.faces.extend(mesh.faces.clone());
        assert!(!is_star_shaped(&mesh));
    }
}
