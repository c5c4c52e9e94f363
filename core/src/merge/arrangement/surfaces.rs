//! The faces of all operands that may meet others, numbered together.

use super::candidates::Operand;
use crate::arith::convert::as_number;
use crate::geometry::plane::Lattice;
use crate::mesh::handle::{FaceId, VertexId};

/// One operand or two, and their faces that may meet others: the first operand's, then the second's.
#[derive(Debug)]
pub(super) struct Surfaces<'a> {
    pub(super) operands: Vec<Operand<'a>>,
    faces: Vec<Vec<FaceId>>,
    /// The number of the second operand's first face.
    pub(super) second: u32,
}

impl<'a> Surfaces<'a> {
    pub(super) fn new(operands: Vec<Operand<'a>>, faces: Vec<Vec<FaceId>>) -> Self {
        let second = as_number(faces[0].len());
        Self {
            operands,
            faces,
            second,
        }
    }

    /// The faces of an operand.
    pub(super) fn of_operand(&self, operand: usize) -> std::ops::Range<u32> {
        let first = if operand == 0 { 0 } else { self.second };
        first..first + as_number(self.faces[operand].len())
    }

    /// The operand of a face.
    pub(super) fn operand_of(&self, face: u32) -> usize {
        usize::from(face >= self.second)
    }

    /// The index of a face among its operand's candidates.
    fn local(&self, face: u32) -> usize {
        (if face < self.second {
            face
        } else {
            face - self.second
        }) as usize
    }

    /// The mesh of a face.
    pub(super) fn operand(&self, face: u32) -> &Operand<'a> {
        &self.operands[self.operand_of(face)]
    }

    /// The number of a face in its mesh.
    pub(super) fn id(&self, face: u32) -> FaceId {
        self.faces[self.operand_of(face)][self.local(face)]
    }

    /// The vertices of a face.
    pub(super) fn vertices(&self, face: u32) -> [VertexId; 3] {
        self.operand(face).mesh.vertices_of(self.id(face))
    }

    /// The lattice points of a face's corners.
    pub(super) fn corners(&self, face: u32) -> [Lattice; 3] {
        self.operand(face).mesh.corners(self.id(face))
    }

    /// The lattice point of a corner of a face.
    pub(super) fn place(&self, face: u32, corner: usize) -> Lattice {
        self.operand(face).mesh.vertices[self.vertices(face)[corner].place()]
    }
}
