//! Triangles on the lattice.

use super::grid::Pitch;
use super::handle::{FaceId, VertexId};
use crate::geometry::axes::each_axis;
use crate::geometry::plane::Lattice;

/// Lattice triangles, and the doubles they came from.
#[derive(Clone, Debug, Default)]
pub struct TriangleMesh {
    /// Vertices in lattice steps.
    pub vertices: Vec<Lattice>,
    /// The original doubles of the vertices.
    pub doubles: Vec<[f64; 3]>,
    /// Triangles, counterclockwise as seen from outside.
    pub faces: Vec<[VertexId; 3]>,
    /// The index each face had in its input, where faces were left out.
    pub numbers: Option<Vec<u32>>,
}

impl TriangleMesh {
    /// All faces, ascending.
    pub fn face_ids(&self) -> impl Iterator<Item = FaceId> {
        FaceId::all().take(self.faces.len())
    }

    /// The corners of a face.
    #[inline]
    pub fn corners(&self, face: FaceId) -> [Lattice; 3] {
        let [a, b, c] = self.vertices_of(face);
        let at = |vertex: VertexId| self.vertices[vertex.place()];
        [at(a), at(b), at(c)]
    }

    /// The numbers of a face's corners.
    #[inline]
    pub fn vertices_of(&self, face: FaceId) -> [VertexId; 3] {
        self.faces[face.place()]
    }

    /// The lattice box around a face.
    pub fn face_box(&self, face: FaceId) -> (Lattice, Lattice) {
        let [a, b, c] = self.corners(face);
        let least = |i: usize| a[i].min(b[i]).min(c[i]);
        let most = |i: usize| a[i].max(b[i]).max(c[i]);
        ([least(0), least(1), least(2)], [most(0), most(1), most(2)])
    }

    /// The farthest that a coordinate is from the double it came from, rounded.
    ///
    /// More than half a step if the lattice was refined since.
    pub fn snapped_by(&self, pitch: Pitch) -> f64 {
        let pairs = self.doubles.iter().zip(&self.vertices);
        let distances = pairs.flat_map(|(p, v)| each_axis(|i| p[i] - pitch.coordinate(v[i])));
        distances.fold(0.0, |most, d| most.max(d.abs()))
    }

    /// The lattice box around all vertices; `None` without any.
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
