//! The input of a sweep over the plane: directed segments with weights.

use crate::arith::convert::as_number;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::spaces::dim2::{Lattice2, Line2};
use crate::tree::partition::Label;
use crate::tree::plane::{Boundary, Corner};

/// Directed segments in the plane; the winding number on the left of each exceeds that on its right by its
/// weight.
#[derive(Clone, Debug, Default)]
pub struct Outlines {
    /// The end points of the segments, in any order; the same point may occur several times.
    pub corners: Vec<Corner>,
    /// The directed segments, with indices into `corners`.
    pub strands: Vec<Strand>,
    /// The winding number far outside all segments.
    pub base: i32,
}

/// A directed segment in the plane, with a weight.
#[derive(Clone, Copy, Debug)]
pub struct Strand {
    /// The directed line that contains the segment.
    pub line: Line2,
    /// The indices of its first and its last point in `Outlines::corners`.
    pub ends: [u32; 2],
    /// The increase of the winding number from the plus side (right) to the minus side (left).
    pub weight: i32,
}

impl Outlines {
    /// Adds a segment between two lattice points, unless they are equal.
    ///
    /// # Errors
    /// `TooLarge` if a coordinate exceeds the lattice of 2^53 steps.
    pub fn push(&mut self, from: Lattice2, to: Lattice2, weight: i32) -> Result<()> {
        if from == to {
            return Ok(());
        }
        let Some(line) = Line2::through(from, to) else {
            let text =
                "an outline has a corner beyond the lattice of 2^53 steps; scale the outline \
                        down, or choose a coarser pitch";
            return Err(Error::new(ErrorKind::TooLarge, text));
        };
        let first = self.corner(from);
        let last = as_number(self.corners.len());
        self.corners.push(Corner::lattice(to));
        self.strands.push(Strand {
            line,
            ends: [first, last],
            weight,
        });
        Ok(())
    }

    /// Returns the index of a corner for a lattice point: the last corner if it is this point, otherwise a
    /// new one.
    fn corner(&mut self, at: Lattice2) -> u32 {
        let known = self.corners.last().and_then(|c| c.point.as_lattice());
        if known != Some(at) {
            self.corners.push(Corner::lattice(at));
        }
        as_number(self.corners.len()) - 1
    }

    /// Adds the boundary of a set of the plane; winding numbers inside the set increase by `weight`.
    pub fn extend(&mut self, boundary: &Boundary, weight: i32) {
        let shift = as_number(self.corners.len());
        self.corners.extend_from_slice(&boundary.corners);
        let strand = |edge: &crate::tree::plane::Edge| Strand {
            line: edge.line,
            ends: edge.ends.map(|end| end + shift),
            weight,
        };
        self.strands.extend(boundary.edges.iter().map(strand));
        if boundary.outer == Label::In {
            self.base += weight;
        }
    }
}
