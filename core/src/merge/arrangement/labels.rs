//! The winding numbers of each operand around the vertices of the other.
//!
//! A number is the same at all corners of a face that nothing cuts, and known in its differences where
//! something does. So one question settles all vertices that hang together.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::candidates::{Operand, Windings};
use super::triangulation::Special;
use crate::arith::convert::as_number;
use crate::geometry::plane::Plane;
use crate::geometry::vertex::Vertex;
use crate::interrupt::poll;
use crate::mesh::handle::VertexId;

/// The winding numbers around the vertices of one mesh, as far as they are known: classes of vertices
/// with the differences between them.
#[derive(Debug)]
pub(super) struct Labels<'a> {
    of: Operand<'a>,
    windings: Windings<'a>,
    parents: Vec<u32>,
    /// By how much the number at a vertex exceeds that at its parent.
    above: Vec<i32>,
    /// The number at the root of a class.
    known: Vec<Option<i32>>,
    /// By vertex, whether it lies on the other operand; empty if none does.
    touching: Vec<bool>,
}

impl<'a> Labels<'a> {
    /// The numbers of one operand around the vertices of another: nothing is known.
    pub(super) fn new(of: Operand<'a>, around: Operand<'a>, on_faces: &[VertexId]) -> Self {
        let vertices = of.mesh.vertices.len();
        let mut touching = vec![false; if on_faces.is_empty() { 0 } else { vertices }];
        for vertex in on_faces {
            touching[vertex.place()] = true;
        }
        Self {
            of,
            windings: Windings::of(around),
            parents: (0..as_number(vertices)).collect(),
            above: vec![0; vertices],
            known: vec![None; vertices],
            touching,
        }
    }

    /// The root of a vertex's class, and by how much the number at the vertex exceeds that there.
    fn root(&mut self, vertex: VertexId) -> (usize, i32) {
        let (mut at, mut sum) = (vertex.place(), 0);
        loop {
            let parent = self.parents[at] as usize;
            if parent == at {
                return (at, sum);
            }
            // Each second vertex on the way becomes a child of its parent's parent; a root has nothing above.
            self.above[at] += self.above[parent];
            self.parents[at] = self.parents[parent];
            sum += self.above[at];
            at = self.parents[at] as usize;
        }
    }

    /// Notes by how much the number at one vertex exceeds that at another.
    ///
    /// # Errors
    /// `Special` if that contradicts what is known: the mesh that is wound around overlaps itself.
    pub(super) fn join(&mut self, a: VertexId, b: VertexId, more: i32) -> Result<(), Special> {
        let (of_a, of_b) = (self.root(a), self.root(b));
        self.join_roots(of_a, of_b, more).map(|_| ())
    }

    /// Notes that the number is the same at all corners of a face that do not lie on the other operand.
    ///
    /// # Errors
    /// As for [`Self::join`].
    pub(super) fn join_corners(&mut self, corners: [VertexId; 3]) -> Result<(), Special> {
        if corners.iter().any(|v| self.is_touching(*v)) {
            let free: SmallVec<[VertexId; 3]> = corners
                .into_iter()
                .filter(|v| !self.is_touching(*v))
                .collect();
            return free
                .windows(2)
                .try_for_each(|pair| self.join(pair[0], pair[1], 0));
        }
        let [a, b, c] = corners.map(|v| self.root(v));
        let joined = self.join_roots(a, b, 0)?;
        // What was c's root may be the root that has just got a parent.
        let c = if c.0 == a.0 || c.0 == b.0 {
            self.root(corners[2])
        } else {
            c
        };
        self.join_roots(joined, c, 0).map(|_| ())
    }

    /// Return whether a vertex lies on the other operand: then no number is that around it.
    pub(super) fn is_touching(&self, vertex: VertexId) -> bool {
        self.touching.get(vertex.place()).is_some_and(|t| *t)
    }

    /// The number in front of a plane at a point.
    pub(super) fn in_front(&mut self, plane: &Plane, point: &Vertex, doubled: [i64; 2]) -> i32 {
        self.windings.in_front(plane, point, doubled)
    }

    /// Joins two classes, given as roots and what vertices have above them; returns that of the first
    /// vertex.
    fn join_roots(
        &mut self,
        (a, above_a): (usize, i32),
        (b, above_b): (usize, i32),
        more: i32,
    ) -> Result<(usize, i32), Special> {
        // The number at a's root is that at b's root and this.
        let between = above_b + more - above_a;
        match a.cmp(&b) {
            Ordering::Equal if between != 0 => Err(Special),
            Ordering::Equal => Ok((a, above_a)),
            Ordering::Greater => {
                self.parents[a] = as_number(b);
                self.above[a] = between;
                Ok((b, above_b + more))
            }
            Ordering::Less => {
                self.parents[b] = as_number(a);
                self.above[b] = -between;
                Ok((a, above_a))
            }
        }
    }

    /// Notes the vertices outside of the box around the other operand: their number is zero.
    pub(super) fn note_beyond(&mut self) {
        for (vertex, place) in VertexId::all().zip(&self.of.mesh.vertices) {
            poll();
            if self.windings.are_zero_at(place) && !self.is_touching(vertex) {
                let (root, above) = self.root(vertex);
                self.known[root].get_or_insert(-above);
            }
        }
    }

    /// The number at a vertex; for the first of its class it is counted.
    pub(super) fn at(&mut self, vertex: VertexId) -> i32 {
        let (root, above) = self.root(vertex);
        if let Some(known) = self.known[root] {
            return known + above;
        }
        let number = self.windings.around(&self.of.mesh.vertices[vertex.place()]);
        self.known[root] = Some(number - above);
        number
    }
}
