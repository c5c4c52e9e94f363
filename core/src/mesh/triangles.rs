//! Triangle meshes on the lattice, with their original doubles.

use rustc_hash::{FxBuildHasher, FxHashMap as HashMap};

use serde::{Deserialize, Serialize};

use super::grid::Pitch;
use super::handle::{FaceId, VertexId};
use crate::geometry::axes::each_axis;
use crate::geometry::plane::{Lattice, Plane};
use crate::geometry::side::Side;

/// Triangles on the lattice, and the doubles from which their vertices were snapped.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct TriangleMesh {
    /// The vertices in lattice steps.
    pub vertices: Vec<Lattice>,
    /// The original doubles of the vertices, in model units.
    pub doubles: Vec<[f64; 3]>,
    /// The triangles, counterclockwise as seen from outside.
    pub faces: Vec<[VertexId; 3]>,
    /// The index of each face in the input; `None` if no faces were left out.
    pub numbers: Option<Vec<u32>>,
}

impl TriangleMesh {
    /// The numbers of all faces, ascending.
    pub fn face_ids(&self) -> impl Iterator<Item = FaceId> {
        FaceId::all().take(self.faces.len())
    }

    /// The corners of a face, in lattice steps.
    #[inline]
    pub fn corners(&self, face: FaceId) -> [Lattice; 3] {
        let [a, b, c] = self.vertices_of(face);
        let at = |vertex: VertexId| self.vertices[vertex.index()];
        [at(a), at(b), at(c)]
    }

    /// The vertex numbers of a face's corners.
    #[inline]
    pub fn vertices_of(&self, face: FaceId) -> [VertexId; 3] {
        self.faces[face.index()]
    }

    /// The lowest and highest corner of the lattice box around a face.
    pub fn face_box(&self, face: FaceId) -> (Lattice, Lattice) {
        let [a, b, c] = self.corners(face);
        let least = |i: usize| a[i].min(b[i]).min(c[i]);
        let most = |i: usize| a[i].max(b[i]).max(c[i]);
        ([least(0), least(1), least(2)], [most(0), most(1), most(2)])
    }

    /// Return whether the given faces lie in one plane; true for no faces.
    ///
    /// # Cost
    /// Stops at the first face that is not in the plane of the first face.
    pub fn are_in_one_plane(&self, mut faces: impl Iterator<Item = FaceId>) -> bool {
        let Some([a, b, c]) = faces.next().map(|face| self.corners(face)) else {
            return true;
        };
        let Some(plane) = Plane::through(&a, &b, &c) else {
            return false;
        };
        let lies_in = |corner: &Lattice| plane.side_of_lattice(corner) == Side::On;
        faces.all(|face| self.corners(face).iter().all(lies_in))
    }

    /// For each vertex, the first vertex at the same lattice point.
    pub fn first_equal_vertices(&self) -> Vec<VertexId> {
        first_equal_vertices(&self.vertices)
    }

    /// For each lattice point at which vertices have different original doubles, the first of these vertices;
    /// ascending.
    pub fn blurred(&self) -> Vec<VertexId> {
        let first_equal_vertices = VertexId::all().zip(self.first_equal_vertices());
        let bits = |v: VertexId| self.doubles[v.index()].map(f64::to_bits);
        let differ = |(v, first): &(VertexId, VertexId)| bits(*v) != bits(*first);
        let mut blurred: Vec<VertexId> = first_equal_vertices
            .filter(differ)
            .map(|(_, first)| first)
            .collect();
        blurred.sort_unstable();
        blurred.dedup();
        blurred
    }

    /// The largest difference, in any coordinate, between a vertex on the lattice and its original double, in
    /// model units.
    ///
    /// More than half a step if the lattice has been refined after import.
    pub fn snapped_by(&self, pitch: Pitch) -> f64 {
        let pairs = self.doubles.iter().zip(&self.vertices);
        let distances = pairs.flat_map(|(p, v)| each_axis(|i| p[i] - pitch.coordinate(v[i])));
        distances.fold(0.0, |most, d| most.max(d.abs()))
    }

    /// The lowest and highest corner of the lattice box around all vertices; `None` if there are none.
    pub fn bounds(&self) -> Option<(Lattice, Lattice)> {
        let first = *self.vertices.first()?;
        let grow = |(low, high): (Lattice, Lattice), p: &Lattice| {
            (
                each_axis(|i| low[i].min(p[i])),
                each_axis(|i| high[i].max(p[i])),
            )
        };
        Some(self.vertices.iter().fold((first, first), grow))
    }
}

/// For each lattice point of a list, the index of the first point equal to it.
pub fn first_equal_vertices(points: &[Lattice]) -> Vec<VertexId> {
    let mut first: HashMap<Lattice, VertexId> =
        HashMap::with_capacity_and_hasher(points.len(), FxBuildHasher);
    let points = VertexId::all().zip(points);
    points
        .map(|(vertex, point)| *first.entry(*point).or_insert(vertex))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_of_a_place_is_blurred_where_others_have_other_doubles() {
        let points = [0, 7, 0, 7, 9];
        let doubles = [0.0, 7.0, 0.1, 7.0, 9.2];
        let mesh = TriangleMesh {
            vertices: points.map(|x| [x, 0, 0]).to_vec(),
            doubles: doubles.map(|x| [x, 0.0, 0.0]).to_vec(),
            ..TriangleMesh::default()
        };
        assert_eq!(mesh.first_equal_vertices(), [0, 1, 0, 1, 4].map(VertexId));
        assert_eq!(mesh.blurred(), [VertexId(0)]);
    }
}
