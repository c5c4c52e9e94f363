//! The connected surfaces of a mesh, and counts of vertices, edges and surfaces.

use super::disjoint::DisjointSets;
use super::handle::VertexId;
use crate::arith::convert::as_number;
use crate::interrupt::poll;

/// The numbers of vertices, edges, open edges and surfaces of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// The number of vertices that any face uses.
    pub vertices: usize,
    /// The number of pairs of vertices that a face's edge connects, in either direction.
    pub edges: usize,
    /// The number of directed edges that occur several times, or have no opposite.
    pub open_edges: usize,
    /// The number of connected surfaces.
    pub surfaces: usize,
}

impl Counts {
    /// The Euler number of a surface of `triangles` triangles: vertices minus edges plus triangles.
    pub fn euler_number(&self, triangles: usize) -> i64 {
        let signed = |count: usize| i64::from(as_number(count));
        signed(self.vertices) - signed(self.edges) + signed(triangles)
    }
}

/// Counts vertices, edges, open edges and surfaces of a mesh, by index.
pub fn counts(faces: &[[VertexId; 3]], vertex_count: usize) -> Counts {
    let fans = Fans::new(faces, vertex_count);
    let mut edges = 0;
    let mut open_edges = 0;
    let mut around: Vec<(VertexId, bool)> = Vec::new();
    for vertex in 0..vertex_count {
        poll();
        around.clear();
        around.extend_from_slice(fans.of(vertex));
        around.sort_unstable();
        for uses in around.chunk_by(|a, b| a.0 == b.0) {
            edges += 1;
            open_edges += open_directions(uses, uses[0].0.index() == vertex);
        }
    }
    let owner = surfaces(faces, vertex_count);
    Counts {
        vertices: count_used_vertices(faces, vertex_count),
        edges,
        open_edges,
        surfaces: owner.iter().max().map_or(0, |&last| last as usize + 1),
    }
}

/// Returns how many of an edge's two directions are open: they occur several times, or the opposite direction
/// does not occur. A loop from a vertex to itself counts as one.
fn open_directions(uses: &[(VertexId, bool)], is_loop: bool) -> usize {
    let forth = uses.iter().filter(|(_, forth)| *forth).count();
    match (forth, uses.len() - forth) {
        _ if is_loop => 1,
        (1, 1) => 0,
        (0, _) | (_, 0) => 1,
        (forth, back) => usize::from(forth > 1) + usize::from(back > 1),
    }
}

fn count_used_vertices(faces: &[[VertexId; 3]], vertex_count: usize) -> usize {
    let mut is_used = vec![false; vertex_count];
    for &vertex in faces.iter().flatten() {
        is_used[vertex.index()] = true;
    }
    is_used.into_iter().filter(|&used| used).count()
}

/// For each face, the number of its surface: faces that share a vertex belong to one surface.
///
/// Surfaces are numbered from 0, in the order of their lowest-numbered vertices.
pub fn surfaces(faces: &[[VertexId; 3]], vertex_count: usize) -> Vec<u32> {
    let mut sets = DisjointSets::of_triangles(vertex_count, faces);
    let mut number = vec![None; vertex_count];
    for &[vertex, ..] in faces {
        number[sets.least(vertex.0) as usize] = Some(0);
    }
    for (next, number) in (0..).zip(number.iter_mut().flatten()) {
        *number = next;
    }
    let number_of = |&[vertex, ..]: &[VertexId; 3]| number[sets.least(vertex.0) as usize];
    faces.iter().filter_map(number_of).collect()
}

/// Edges, each stored at the lower-numbered of its two vertices, in compressed rows.
struct Fans {
    starts: Vec<u32>,
    /// The higher-numbered vertex of each edge, and whether the edge runs towards it.
    edges: Vec<(VertexId, bool)>,
}

impl Fans {
    fn new(faces: &[[VertexId; 3]], vertex_count: usize) -> Self {
        let directed = || faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let mut starts = vec![0u32; vertex_count + 1];
        for (a, b) in directed() {
            starts[a.min(b).index() + 1] += 1;
        }
        for i in 0..vertex_count {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut edges = vec![(VertexId::default(), false); 3 * faces.len()];
        for (a, b) in directed() {
            poll();
            let slot = &mut next[a.min(b).index()];
            edges[*slot as usize] = (a.max(b), a < b);
            *slot += 1;
        }
        Self { starts, edges }
    }

    fn of(&self, vertex: usize) -> &[(VertexId, bool)] {
        &self.edges[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::{counts, surfaces, Counts, VertexId};

    fn tetrahedron() -> [[VertexId; 3]; 4] {
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|f| f.map(VertexId))
    }

    #[test]
    fn a_closed_surface_has_no_open_edges() {
        let expected = Counts {
            vertices: 4,
            edges: 6,
            open_edges: 0,
            surfaces: 1,
        };
        assert_eq!(counts(&tetrahedron(), 9), expected);
        assert_eq!(counts(&tetrahedron()[1..], 4).open_edges, 3);
    }

    #[test]
    fn surfaces_are_numbered_by_their_lowest_vertices() {
        let faces = [[7, 8, 9], [1, 5, 2], [9, 10, 11], [3, 6, 5]].map(|f| f.map(VertexId));
        assert_eq!(surfaces(&faces, 12), [1, 0, 1, 0]);
        assert!(surfaces(&[], 3).is_empty());
    }
}
