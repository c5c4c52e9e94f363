//! The candidates of all operands, in one numbering.

use super::candidates::{Candidates, Operand};
use crate::geometry::plane::Lattice;
use crate::mesh::handle::{FaceId, VertexId};

/// Two operands and the faces of them that may meet: those of the first, then those of the second.
#[derive(Debug)]
pub(super) struct Surfaces<'a> {
    pub(super) operands: [Operand<'a>; 2],
    pub(super) candidates: [Candidates; 2],
    /// The number of the second operand's first face.
    pub(super) second: u32,
}

impl<'a> Surfaces<'a> {
    /// The operand that a face is of.
    pub(super) fn operand_of(&self, face: u32) -> usize {
        usize::from(face >= self.second)
    }

    /// The place of a face among its operand's candidates.
    fn local(&self, face: u32) -> usize {
        (if face < self.second {
            face
        } else {
            face - self.second
        }) as usize
    }

    pub(super) fn operand(&self, face: u32) -> &Operand<'a> {
        &self.operands[self.operand_of(face)]
    }

    /// A face as its mesh numbers it.
    pub(super) fn id(&self, face: u32) -> FaceId {
        self.candidates[self.operand_of(face)].faces[self.local(face)]
    }

    /// The vertices at a face's corners.
    pub(super) fn vertices(&self, face: u32) -> [VertexId; 3] {
        self.operand(face).mesh.vertices_of(self.id(face))
    }

    /// The places of a face's corners.
    pub(super) fn corners(&self, face: u32) -> [Lattice; 3] {
        self.operand(face).mesh.corners(self.id(face))
    }

    /// The place of a corner of a face.
    pub(super) fn place(&self, face: u32, corner: usize) -> Lattice {
        self.operand(face).mesh.vertices[self.vertices(face)[corner].place()]
    }
}
