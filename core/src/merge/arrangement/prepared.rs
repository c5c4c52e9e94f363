//! Quick tests that two faces of a mesh share no more than corners and edges.

use crate::arith::convert::as_double;
use crate::arith::{Filtered, Sign};
use crate::geometry::axes::each_axis;
use crate::geometry::doubles::meeting::{has_no_area, meeting, Meeting};
use crate::geometry::doubles::{Point, Triangle};
use crate::geometry::plane::Lattice;
use crate::geometry::side::Side;
use crate::mesh::handle::{FaceId, VertexId};
use crate::mesh::topology::NONE;
use crate::mesh::triangles::TriangleMesh;

/// A face prepared for quick tests against other faces.
pub(super) struct PreparedFace {
    vertices: [VertexId; 3],
    low: Lattice,
    high: Lattice,
    /// For each corner, whether surfaces may cross at its vertex although no two faces cross.
    irregular: [bool; 3],
    /// The normal of the face in doubles, from its edges at the first corner.
    normal: [f64; 3],
    /// The product of the largest components of the two edges, to which the rounding errors of the normal are
    /// proportional.
    size: f64,
    /// True if the face has a positive area.
    has_area: bool,
    /// The corners, whose coordinates are exact in doubles.
    doubles: Triangle,
    /// The number of the face's terrain (a set of faces known not to overlap each other), or `NONE`.
    terrain: u32,
}

impl PreparedFace {
    pub(super) fn at(mesh: &TriangleMesh, face: FaceId, irregular: &[bool], terrain: u32) -> Self {
        let (low, high) = mesh.face_box(face);
        let corners = mesh.corners(face).map(|c| c.map(as_double));
        let u = difference(&corners[1], &corners[0]);
        let v = difference(&corners[2], &corners[0]);
        let normal = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        let longest = |w: &[f64; 3]| w.iter().fold(0.0f64, |m, c| m.max(c.abs()));
        let size = longest(&u) * longest(&v);
        Self {
            vertices: mesh.vertices_of(face),
            low,
            high,
            irregular: mesh.vertices_of(face).map(|v| irregular[v.index()]),
            normal,
            size,
            has_area: longest(&normal) > 16.0 * f64::EPSILON * size || !has_no_area(&corners),
            doubles: corners,
            terrain,
        }
    }

    /// Returns true if two faces certainly share only corners and edges; false proves nothing.
    pub(super) fn is_clear_of(&self, other: &Self) -> bool {
        if (0..3).any(|i| self.high[i] < other.low[i] || other.high[i] < self.low[i]) {
            return true;
        }
        if self.terrain != NONE && self.terrain == other.terrain {
            return true;
        }
        let theirs = self.shared_with(other);
        match theirs.iter().filter(|shared| **shared).count() {
            0 | 1 => {
                self.has_beyond(other, theirs)
                    || other.has_beyond(self, other.shared_with(self))
                    || self.meets_in_points(other)
            }
            2 => {
                !self.shares_irregular_edge(other)
                    && (self.folds_away(other) || self.meets_in_edges(other))
            }
            _ => false,
        }
    }

    /// Returns true if two faces certainly cross or overlap; false proves nothing.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        let meet = || meeting(&self.doubles, &other.doubles);
        let have_area = self.has_area && other.has_area;
        have_area && matches!(meet(), Meeting::Crossing | Meeting::Overlap)
    }

    /// Returns for each corner of another face whether it is a corner of this face.
    #[allow(clippy::float_cmp, reason = "doubles hold the coordinates")]
    fn shared_with(&self, other: &Self) -> [bool; 3] {
        let [a, b, c] = &self.doubles;
        other.doubles.map(|p| p == *a || p == *b || p == *c)
    }

    /// Returns true if two faces certainly share only points. Surfaces cross along lines, so common points
    /// are no overlap.
    fn meets_in_points(&self, other: &Self) -> bool {
        let exact = || meeting(&self.doubles, &other.doubles) == Meeting::Clear;
        self.has_area && other.has_area && exact()
    }

    /// Returns true if two faces with a common edge certainly share nothing else.
    fn meets_in_edges(&self, other: &Self) -> bool {
        let meets = || meeting(&self.doubles, &other.doubles);
        let are_clear = || matches!(meets(), Meeting::Clear | Meeting::Edges(..));
        self.has_area && other.has_area && are_clear()
    }

    /// Returns true if more than two faces may meet in the common edge of two faces, so that surfaces can
    /// cross there although no two faces do: both ends are irregular, or an end is two vertices at one point.
    fn shares_irregular_edge(&self, other: &Self) -> bool {
        let common = || (0..3).filter(|i| other.doubles.contains(&self.doubles[*i]));
        let is_twin = |i: usize| !other.vertices.contains(&self.vertices[i]);
        common().any(is_twin) || common().all(|i| self.irregular[i])
    }

    /// Returns true if the corners of the other face that are not marked in `shared` certainly lie strictly
    /// on one side of this face's plane.
    fn has_beyond(&self, other: &Self, shared: [bool; 3]) -> bool {
        let corners = other.doubles.iter().zip(shared);
        let mut sides = corners.filter(|c| !c.1).map(|(p, _)| self.side(p));
        let Some(first) = sides.next() else {
            return false;
        };
        first.is_certain() && sides.all(|s| s == first)
    }

    /// Returns true if two faces with a common edge certainly lie in different planes, or side by side in one
    /// plane.
    fn folds_away(&self, other: &Self) -> bool {
        let apex = other.doubles.iter().find(|p| !self.doubles.contains(p));
        let cosine: f64 = (0..3).map(|i| self.normal[i] * other.normal[i]).sum();
        let bound = 64.0 * f64::EPSILON * self.size * other.size;
        apex.is_some_and(|p| self.side(p).is_certain())
            || (cosine > bound && self.runs_against(other))
    }

    /// Returns true if an edge of one face is the reverse of an edge of the other, by coordinates.
    fn runs_against(&self, other: &Self) -> bool {
        let edge = |c: &Triangle, i: usize| (c[i], c[(i + 1) % 3]);
        (0..3).any(|i| {
            let (a, b) = edge(&self.doubles, i);
            (0..3).any(|j| edge(&other.doubles, j) == (b, a))
        })
    }

    /// Returns the side of the face's plane on which a point lies, or that doubles do not decide it.
    fn side(&self, p: &Point) -> Filtered<Side> {
        let w = difference(p, &self.doubles[0]);
        let value: f64 = (0..3).map(|i| self.normal[i] * w[i]).sum();
        let reach: f64 = w.iter().map(|c| c.abs()).sum();
        let certain = value.abs() > 16.0 * f64::EPSILON * self.size * reach;
        Filtered::when(certain, Side::from_sign(Sign::of(value)))
    }
}

/// Returns a − b, rounded once, because the exact difference may have 54 bits.
fn difference(a: &Point, b: &Point) -> [f64; 3] {
    each_axis(|i| a[i] - b[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns faces over these corners after a shear that makes them long and thin; it keeps volumes and
    /// common planes.
    fn sheared(corners: &[Lattice], faces: &[[u32; 3]]) -> Vec<PreparedFace> {
        let shear = |[x, y, z]: Lattice| [x + (y << 22) + (z << 43), y + (z << 22), z];
        let mesh = TriangleMesh {
            vertices: corners.iter().copied().map(shear).collect(),
            faces: VertexId::rows(faces.iter().copied()),
            ..TriangleMesh::default()
        };
        let irregular = vec![false; corners.len()];
        let prepared = |face| PreparedFace::at(&mesh, face, &irregular, NONE);
        mesh.face_ids().map(prepared).collect()
    }

    #[test]
    fn slivers_that_share_an_edge_are_clear_of_each_other() {
        let corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
        let faces = sheared(&corners, &[[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]);
        for i in 0..4 {
            assert!(faces[i].has_area);
            assert!(faces[..i].iter().all(|other| faces[i].is_clear_of(other)));
        }
    }

    #[test]
    fn slivers_that_are_folded_onto_each_other_are_not() {
        let corners = [[0, 0, 0], [1, 2, 1], [3, 1, 2], [4, 3, 3], [-2, 1, -1]];
        // All faces lie in one plane; the last corner lies on the other side of the common edge.
        let faces = sheared(&corners, &[[0, 1, 2], [1, 0, 3], [1, 0, 4]]);
        assert!(!faces[0].is_clear_of(&faces[1]));
        assert!(faces[0].is_clear_of(&faces[2]));
    }
}
