//! The output of a sweep: the boundary as far as it has come.

use crate::arith::convert::as_number;
use crate::geometry::spaces::dim2::Line2;
use crate::tree::partition::Label;
use crate::tree::plane::{Boundary, Corner, Edge};

/// The boundary to the left of the sweep's line.
#[derive(Debug)]
pub(super) struct Output {
    corners: Vec<Corner>,
    edges: Vec<Edge>,
    faces: Faces,
}

impl Output {
    /// Nothing yet; the face with number 0 is what lies far away.
    pub(super) fn new() -> Self {
        Self {
            corners: Vec::new(),
            edges: Vec::new(),
            faces: Faces(vec![0]),
        }
    }

    /// Adds a corner.
    pub(super) fn corner(&mut self, corner: &Corner) -> u32 {
        self.corners.push(*corner);
        as_number(self.corners.len()) - 1
    }

    /// A face that is not known to be any other.
    pub(super) fn face(&mut self) -> u32 {
        let number = as_number(self.faces.0.len());
        self.faces.0.push(number);
        number
    }

    /// Makes two faces one.
    pub(super) fn join(&mut self, a: u32, b: u32) {
        self.faces.join(a, b);
    }

    /// Adds an edge along a line that runs to the right, given the faces below and above it.
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

    /// The boundary, at the end of the sweep.
    pub(super) fn into_boundary(mut self, outer: Label) -> Boundary {
        for edge in &mut self.edges {
            edge.inside = self.faces.of(edge.inside);
            edge.outside = self.faces.of(edge.outside);
        }
        Boundary::sorted(outer, self.corners, self.edges)
    }
}

/// Disjoint sets of faces, each named by its smallest member.
#[derive(Debug)]
struct Faces(Vec<u32>);

impl Faces {
    /// The name of a face's set, the way there shortened for the next question.
    fn of(&mut self, face: u32) -> u32 {
        let mut at = face as usize;
        while self.0[at] as usize != at {
            self.0[at] = self.0[self.0[at] as usize];
            at = self.0[at] as usize;
        }
        as_number(at)
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
