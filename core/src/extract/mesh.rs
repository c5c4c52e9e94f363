//! Closed triangle meshes, exact and in doubles.

use std::sync::Arc;

use crate::extract::joining::patches::Patches;
use crate::geometry::plane::{normal, Lattice};
use crate::geometry::vertex::Vertex;
use crate::geometry::vertices::VertexTable;
use crate::interrupt::spend;
use crate::merge::lists::list::Sources;
use crate::mesh::finding::Finding;
use crate::mesh::handle::{OrientedFace, Slot, VertexId};
use crate::mesh::source::Shape;
use crate::mesh::surfaces::{counts, Counts};
use crate::mesh::tasks::fill_chunks;
use crate::tree::solid::Solid;

/// A closed triangle mesh with exact vertices.
#[derive(Debug, Default)]
pub struct ExactMesh {
    /// The vertices: those of sources, by slot and number, then constructed points.
    pub vertices: Vec<Corner>,
    /// Triangles, counterclockwise as seen from outside.
    pub triangles: Vec<[VertexId; 3]>,
    /// For each triangle the source face that it lies in.
    pub faces: Vec<OrientedFace>,
    /// The number of triangles at the start that are untouched faces of sources.
    pub untouched: usize,
    /// The untouched triangles with a vertex that other triangles may use, ascending.
    pub special: Vec<u32>,
    /// The points that [`Corner::Point`] numbers.
    pub table: VertexTable,
    /// The findings of the assembly, such as contacts.
    pub findings: Vec<Finding>,
    /// The counts of the surface, if it touches itself at vertices that were split.
    pub counts: Option<Counts>,
}

impl ExactMesh {
    /// The counts of the surface. Around an edge in which it touches itself, two walls are joined if they
    /// bound the same wedge of the inside, so that the counts depend on the set of points alone, if faces are
    /// divided at all such edges.
    pub fn counts(&self) -> Counts {
        let count = || counts(&self.triangles, self.vertices.len());
        self.counts.unwrap_or_else(count)
    }

    /// The exact position of a vertex.
    pub fn exact(&self, vertex: VertexId, sources: &Sources) -> Arc<Vertex> {
        match self.vertices[vertex.index()] {
            Corner::Point(point) => Arc::clone(self.table.point(point)),
            Corner::Source(slot, index) => {
                let mesh = sources.get(slot).mesh();
                let place = mesh.map_or([0; 3], |m| m.vertices[index.index()]);
                Arc::new(Vertex::lattice(place))
            }
        }
    }

    /// The lattice point of a vertex; `None` if the vertex is not known to be one.
    pub fn lattice(&self, vertex: VertexId, solid: &Solid) -> Option<Lattice> {
        match self.vertices[vertex.index()] {
            Corner::Source(slot, index) => {
                Some(solid.sources().get(slot).mesh()?.vertices[index.index()])
            }
            Corner::Point(point) => self.table.point(point).as_lattice().copied(),
        }
    }

    /// The exact position of a vertex, by value.
    pub fn vertex(&self, vertex: VertexId, solid: &Solid) -> Vertex {
        match self.vertices[vertex.index()] {
            Corner::Point(point) => Vertex::clone(self.table.point(point)),
            Corner::Source(..) => Vertex::lattice(self.lattice(vertex, solid).unwrap_or_default()),
        }
    }

    /// Returns the position of each vertex in doubles, in model units: the original doubles of a source
    /// vertex, else the doubles nearest to the exact point.
    pub fn positions(&self, solid: &Solid) -> Vec<[f64; 3]> {
        let position = |corner: &Corner| match *corner {
            Corner::Point(point) => solid.pitch().position(self.table.point(point)),
            Corner::Source(slot, vertex) => {
                let mesh = solid.sources().get(slot).mesh();
                mesh.map_or([0.0; 3], |m| m.doubles[vertex.index()])
            }
        };
        let mut positions = vec![[0.0; 3]; self.vertices.len()];
        fill_chunks(&self.vertices, &mut positions, |_, corners, out| {
            for (corner, place) in corners.iter().zip(out) {
                *place = position(corner);
            }
        });
        positions
    }
}

/// What a vertex of an [`ExactMesh`] stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Corner {
    /// A vertex of a source, by the source's slot and its number there.
    Source(Slot, VertexId),
    /// A point of the mesh's table, by its number.
    Point(u32),
}

/// The outward normal of a face, up to a positive factor.
pub fn outward_normal(face: OrientedFace, sources: &Sources) -> [i128; 3] {
    let normal = match sources.get(face.slot()).shape() {
        Shape::Mesh(mesh) => {
            let [a, b, c] = mesh.corners(face.id());
            normal(&a, &b, &c)
        }
        Shape::HalfSpace(plane) => *plane.normal(),
    };
    normal.map(|c| face.orientation.signed(c))
}

/// Renumbers vertices by their index in `order`, which contains all vertices of triangles; returns the new
/// number of each old vertex.
pub fn renumber(
    vertices: &mut Vec<Corner>,
    triangles: &mut [[VertexId; 3]],
    order: &[VertexId],
) -> Vec<VertexId> {
    let mut numbers = vec![VertexId::default(); vertices.len()];
    for (number, vertex) in VertexId::all().zip(order) {
        numbers[vertex.index()] = number;
    }
    *vertices = order.iter().map(|v| vertices[v.index()]).collect();
    spend(triangles.len());
    for vertex in triangles.iter_mut().flatten() {
        *vertex = numbers[vertex.index()];
    }
    numbers
}

/// Returns the new number of each vertex after unused vertices are dropped; the order stays the same.
pub fn numbers_left(used: &[bool]) -> Vec<VertexId> {
    let number = |next: &mut u32, used: &bool| {
        *next += u32::from(*used);
        Some(VertexId(*next - u32::from(*used)))
    };
    used.iter().scan(0, number).collect()
}

/// A closed triangle mesh in doubles.
#[derive(Debug, Default)]
pub struct Mesh {
    /// Vertices in model units.
    pub vertices: Vec<[f64; 3]>,
    /// Triangles, counterclockwise as seen from outside.
    pub triangles: Vec<[VertexId; 3]>,
    /// For each triangle the slot of its source, and the number in the input of the face that it lies in.
    pub origins: Vec<[u32; 2]>,
    /// For each triangle whether it is oriented opposite to the face that it lies in.
    pub flips: Vec<bool>,
    /// The findings of assembly and rounding.
    pub findings: Vec<Finding>,
    /// The patches whose polygons the mesh is made of: those asked for, divided where walls of the surface
    /// would pass through one another.
    pub patches: Patches,
    /// The number of triangles compared exactly with all triangles near them, because they are not untouched
    /// faces of inputs; a finding names those that cross others.
    pub compared: u64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_that_are_left_are_numbered_in_their_order() {
        let numbers = numbers_left(&[true, false, true, true]);
        assert_eq!(
            [numbers[0], numbers[2], numbers[3]],
            [0, 1, 2].map(VertexId)
        );
    }
}
