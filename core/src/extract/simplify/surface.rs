//! A closed mesh with the triangles around each vertex.

use crate::geometry::doubles::{Point, Triangle};
use crate::interrupt::spend;
use crate::mesh::handle::VertexId;

/// A mesh closed by index, with one fan at each vertex.
pub struct Surface<'a> {
    /// The vertices.
    pub vertices: &'a [Point],
    /// The triangles.
    pub triangles: &'a [[VertexId; 3]],
    /// For each vertex, the index in `stars` at which its triangles begin; the last entry is the end.
    starts: Vec<u32>,
    stars: Vec<u32>,
}

impl<'a> Surface<'a> {
    /// Finds the triangles around each vertex of a mesh.
    pub fn of(vertices: &'a [Point], triangles: &'a [[VertexId; 3]]) -> Self {
        spend(triangles.len());
        let mut starts = vec![0u32; vertices.len() + 1];
        for v in triangles.as_flattened() {
            starts[v.index() + 1] += 1;
        }
        for v in 0..vertices.len() {
            starts[v + 1] += starts[v];
        }
        let mut ends = starts.clone();
        let mut stars = vec![0; 3 * triangles.len()];
        for (t, corners) in (0..).zip(triangles) {
            for v in corners {
                let end = &mut ends[v.index()];
                stars[*end as usize] = t;
                *end += 1;
            }
        }
        Self {
            vertices,
            triangles,
            starts,
            stars,
        }
    }

    /// The triangles around a vertex.
    pub fn star(&self, v: VertexId) -> &[u32] {
        let [start, end] = [0, 1].map(|next| self.starts[v.index() + next] as usize);
        &self.stars[start..end]
    }

    /// Yields the neighbours of a vertex, each once: the next corner in each triangle around the vertex.
    pub fn neighbours(&self, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        self.star(v).iter().map(move |t| {
            let corners = &self.triangles[*t as usize];
            corners[(place_of(v, corners) + 1) % 3]
        })
    }

    /// Returns true if an edge joins two vertices.
    pub fn are_joined(&self, v: VertexId, w: VertexId) -> bool {
        let [few, other] = self.rarer_first(v, w);
        self.neighbours(few).any(|n| n == other)
    }

    /// Two vertices, the one with fewer triangles first.
    fn rarer_first(&self, v: VertexId, w: VertexId) -> [VertexId; 2] {
        if self.star(v).len() <= self.star(w).len() {
            [v, w]
        } else {
            [w, v]
        }
    }

    /// The position of a vertex.
    pub fn place(&self, v: VertexId) -> &'a Point {
        &self.vertices[v.index()]
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> Triangle {
        self.places(&self.triangles[triangle as usize])
    }

    /// The positions of three vertices.
    pub fn places(&self, corners: &[VertexId; 3]) -> Triangle {
        corners.map(|v| *self.place(v))
    }

    /// Returns the triangle on the left of a directed edge; `None` if there is no such edge.
    pub fn left_of(&self, from: VertexId, to: VertexId) -> Option<u32> {
        let follows = |t: &&u32| {
            let corners = &self.triangles[**t as usize];
            (0..3).any(|i| corners[i] == from && corners[(i + 1) % 3] == to)
        };
        let [few, _] = self.rarer_first(from, to);
        self.star(few).iter().find(follows).copied()
    }
}

/// Returns the index, 0 to 2, of a vertex among the corners of a triangle.
pub fn place_of(v: VertexId, corners: &[VertexId; 3]) -> usize {
    corners.iter().position(|c| *c == v).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    #[test]
    fn a_vertex_knows_its_triangles_and_an_edge_the_one_on_its_left() {
        let places = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let triangles = VertexId::rows(TRIANGLES);
        let surface = Surface::of(&places, &triangles);
        let [a, b, c, d] = [0, 1, 2, 3].map(VertexId);
        assert_eq!(surface.star(d), [1, 2, 3]);
        let mut around: Vec<VertexId> = surface.neighbours(d).collect();
        around.sort_unstable();
        assert_eq!(around, [a, b, c]);
        assert_eq!(
            (surface.left_of(b, d), surface.left_of(d, b)),
            (Some(1), Some(3))
        );
        assert!(surface.are_joined(a, d));
    }
}
