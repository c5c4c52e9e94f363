//! The input of a sweep: weighted segments between corners.

use crate::arith::convert::as_number;
use crate::error::{Error, ErrorKind, Result};
use crate::geometry::spaces::dim2::{Lattice2, Line2};
use crate::tree::partition::Label;
use crate::tree::plane::{Boundary, Corner};

/// Directed segments, each of which adds its weight to the winding numbers on its left.
#[derive(Clone, Debug, Default)]
pub struct Outlines {
    /// The end points of the segments, in any order; some may be equal.
    pub corners: Vec<Corner>,
    /// The segments.
    pub strands: Vec<Strand>,
    /// The winding number far outside.
    pub base: i32,
}

/// A directed segment.
#[derive(Clone, Copy, Debug)]
pub struct Strand {
    /// The line that it lies in.
    pub line: Line2,
    /// The numbers of its first and its last corner.
    pub ends: [u32; 2],
    /// Its contribution to the winding number on the minus side.
    pub weight: i32,
}

impl Outlines {
    /// Adds a segment between lattice points, unless they are equal.
    ///
    /// # Errors
    /// `TooLarge` beyond the lattice.
    pub fn push(&mut self, from: Lattice2, to: Lattice2, weight: i32) -> Result<()> {
        if from == to {
            return Ok(());
        }
        let Some(line) = Line2::through(from, to) else {
            let text = "an outline extends beyond the lattice of 2^53 steps";
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

    /// The number of a corner; reuses the last corner if it is the same point.
    fn corner(&mut self, at: Lattice2) -> u32 {
        let known = self.corners.last().and_then(|c| c.point.as_lattice());
        if known != Some(at) {
            self.corners.push(Corner::lattice(at));
        }
        as_number(self.corners.len()) - 1
    }

    /// Adds the boundary of a set; `weight` adds to the winding numbers inside it.
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
