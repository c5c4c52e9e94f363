//! The output of a sweep: the boundary so far.

use crate::arith::convert::as_number;
use crate::geometry::spaces::dim2::Line2;
use crate::mesh::disjoint::DisjointSets;
use crate::tree::partition::Label;
use crate::tree::plane::{Boundary, Corner, Edge};

/// The boundary to the left of the sweep line.
#[derive(Debug)]
pub(super) struct Output {
    corners: Vec<Corner>,
    edges: Vec<Edge>,
    faces: DisjointSets,
}

impl Output {
    /// An empty boundary; face 0 is the unbounded one.
    pub(super) fn new() -> Self {
        Self {
            corners: Vec::new(),
            edges: Vec::new(),
            faces: DisjointSets::of_one(1),
        }
    }

    /// Adds a corner.
    pub(super) fn corner(&mut self, corner: &Corner) -> u32 {
        self.corners.push(*corner);
        as_number(self.corners.len()) - 1
    }

    /// A new face, not yet joined to any other.
    pub(super) fn face(&mut self) -> u32 {
        self.faces.push()
    }

    /// Merges two faces.
    pub(super) fn join(&mut self, a: u32, b: u32) {
        self.faces.join(a, b);
    }

    /// Adds an edge along a line to the right, between the faces below and above it.
    pub(super) fn edge(&mut self, line: Line2, ends: [u32; 2], faces: [u32; 2], above: Label) {
        let ([first, last], [below, upper]) = (ends, faces);
        self.edges.push(match above {
            Label::In => Edge {
                line,
                ends,
                inside: upper,
                outside: below,
            },
            Label::Out => Edge {
                line: line.flipped(),
                ends: [last, first],
                inside: below,
                outside: upper,
            },
        });
    }

    /// The finished boundary.
    pub(super) fn into_boundary(mut self, outer: Label) -> Boundary {
        for edge in &mut self.edges {
            edge.inside = self.faces.least(edge.inside);
            edge.outside = self.faces.least(edge.outside);
        }
        Boundary::sorted(outer, self.corners, self.edges)
    }
}
