//! Closed meshes of triangles in doubles.

use super::handle::VertexId;
use crate::geometry::doubles::{Point, Triangle};

/// A closed triangle mesh in doubles.
#[derive(Clone, Copy, Debug)]
pub struct Faces<'a> {
    /// The vertices of the mesh.
    pub vertices: &'a [Point],
    /// The triangles of the mesh. Each directed edge has one opposite; where vertices were welded by
    /// position, it has as many opposites as it occurs.
    pub triangles: &'a [[VertexId; 3]],
}

impl Faces<'_> {
    /// The corners of the triangle with this number.
    #[inline]
    pub fn corners(&self, triangle: u32) -> Triangle {
        let [a, b, c] = self.triangles[triangle as usize];
        let at = |vertex: VertexId| self.vertices[vertex.index()];
        [at(a), at(b), at(c)]
    }
}

/// The directed edges of a triangle, each from a corner to the next.
#[inline]
pub fn edges([a, b, c]: [VertexId; 3]) -> [[VertexId; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_has_its_edges_in_its_direction() {
        let edges = edges([4, 7, 9].map(VertexId));
        assert_eq!(edges.map(|e| e.map(|v| v.0)), [[4, 7], [7, 9], [9, 4]]);
    }
}
