//! A closed mesh with the triangles around each vertex.

use crate::geometry::doubles::{Point, Triangle};
use crate::interrupt::spend;

/// A mesh closed by index, with one fan at each vertex.
pub struct Surface<'a> {
    /// The vertices.
    pub vertices: &'a [Point],
    /// The triangles.
    pub triangles: &'a [[u32; 3]],
    /// The places in `around` where the triangles of each vertex begin.
    starts: Vec<u32>,
    stars: Vec<u32>,
}

impl<'a> Surface<'a> {
    /// The surface of a mesh.
    pub fn of(vertices: &'a [Point], triangles: &'a [[u32; 3]]) -> Self {
        spend(triangles.len());
        let mut starts = vec![0u32; vertices.len() + 1];
        for v in triangles.as_flattened() {
            starts[*v as usize + 1] += 1;
        }
        for v in 0..vertices.len() {
            starts[v + 1] += starts[v];
        }
        let mut ends = starts.clone();
        let mut stars = vec![0; 3 * triangles.len()];
        for (t, corners) in (0..).zip(triangles) {
            for v in corners {
                let end = &mut ends[*v as usize];
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
    pub fn star(&self, v: u32) -> &[u32] {
        let [start, end] = [v, v + 1].map(|v| self.starts[v as usize] as usize);
        &self.stars[start..end]
    }

    /// The neighbours of a vertex, each once: the next corner of each triangle around.
    pub fn neighbours(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        self.star(v).iter().map(move |t| {
            let corners = &self.triangles[*t as usize];
            corners[(place_of(v, corners) + 1) % 3]
        })
    }

    /// Return whether an edge joins two vertices.
    pub fn are_joined(&self, v: u32, w: u32) -> bool {
        let [few, other] = self.rarer_first(v, w);
        self.neighbours(few).any(|n| n == other)
    }

    /// Two vertices, that with fewer triangles first.
    fn rarer_first(&self, v: u32, w: u32) -> [u32; 2] {
        if self.star(v).len() <= self.star(w).len() {
            [v, w]
        } else {
            [w, v]
        }
    }

    /// The place of a vertex.
    pub fn place(&self, v: u32) -> &'a Point {
        &self.vertices[v as usize]
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> Triangle {
        self.places(&self.triangles[triangle as usize])
    }

    /// The places of three vertices.
    pub fn places(&self, corners: &[u32; 3]) -> Triangle {
        corners.map(|v| *self.place(v))
    }

    /// The triangle on the left of a directed edge.
    pub fn left_of(&self, from: u32, to: u32) -> Option<u32> {
        let follows = |t: &&u32| {
            let corners = &self.triangles[**t as usize];
            (0..3).any(|i| corners[i] == from && corners[(i + 1) % 3] == to)
        };
        let [few, _] = self.rarer_first(from, to);
        self.star(few).iter().find(follows).copied()
    }
}

/// Return the corner of its triangle that a vertex is.
pub fn place_of(v: u32, corners: &[u32; 3]) -> usize {
    corners.iter().position(|c| *c == v).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    #[test]
    fn a_vertex_knows_its_triangles_and_an_edge_the_one_on_its_left() {
        let places = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let surface = Surface::of(&places, &TRIANGLES);
        assert_eq!(surface.star(3), [1, 2, 3]);
        let mut around: Vec<u32> = surface.neighbours(3).collect();
        around.sort_unstable();
        assert_eq!(around, [0, 1, 2]);
        assert_eq!(
            (surface.left_of(1, 3), surface.left_of(3, 1)),
            (Some(1), Some(3))
        );
        assert!(surface.are_joined(0, 3));
    }
}
