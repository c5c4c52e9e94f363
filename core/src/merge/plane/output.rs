//! The boundary that a sweep over the plane builds from left to right.

use crate::arith::convert::as_number;
use crate::geometry::spaces::dim2::Line2;
use crate::mesh::disjoint::DisjointSets;
use crate::tree::partition::Label;
use crate::tree::plane::{Boundary, Corner, Edge};

/// The part of the resulting boundary to the left of the sweep line.
#[derive(Debug)]
pub(super) struct Output {
    corners: Vec<Corner>,
    edges: Vec<Edge>,
    faces: DisjointSets,
}

impl Output {
    /// Makes an empty boundary with one face, number 0, which is unbounded.
    pub(super) fn new() -> Self {
        Self {
            corners: Vec::new(),
            edges: Vec::new(),
            faces: DisjointSets::of_one(1),
        }
    }

    /// Adds a corner to the boundary and returns its index.
    pub(super) fn corner(&mut self, corner: &Corner) -> u32 {
        self.corners.push(*corner);
        as_number(self.corners.len()) - 1
    }

    /// Adds a face (a connected region of the plane without boundary inside) and returns its number.
    pub(super) fn face(&mut self) -> u32 {
        self.faces.push()
    }

    /// Makes two faces one, because no boundary lies between them.
    pub(super) fn join(&mut self, a: u32, b: u32) {
        self.faces.join(a, b);
    }

    /// Adds an edge that runs to the right in `line`; `ends` are its corners from left to right, `faces` the
    /// faces below and above it, and `above` says whether the face above it is inside.
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

    /// Returns the finished boundary; `outer` says whether the unbounded face is inside.
    pub(super) fn into_boundary(mut self, outer: Label) -> Boundary {
        for edge in &mut self.edges {
            edge.inside = self.faces.least(edge.inside);
            edge.outside = self.faces.least(edge.outside);
        }
        Boundary::sorted(outer, self.corners, self.edges)
    }
}
