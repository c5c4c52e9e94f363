//! The faces of one or two meshes that may meet other faces, numbered together.

use super::candidates::Operand;
use crate::arith::convert::as_number;
use crate::geometry::plane::Lattice;
use crate::mesh::handle::{FaceId, VertexId};

/// One or two operands, and their faces that may meet other faces. These faces are numbered together: first
/// the first operand's faces, then the second's.
#[derive(Debug)]
pub(super) struct Surfaces<'a> {
    pub(super) operands: Vec<Operand<'a>>,
    faces: Vec<Vec<FaceId>>,
    /// The number of the second operand's first face (faces of both operands are numbered together).
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

    /// Returns the numbers of an operand's faces (faces of both operands are numbered together).
    pub(super) fn of_operand(&self, operand: usize) -> std::ops::Range<u32> {
        let first = if operand == 0 { 0 } else { self.second };
        first..first + as_number(self.faces[operand].len())
    }

    /// Returns the operand (0 or 1) of the face with this number (faces of both operands are numbered
    /// together).
    pub(super) fn operand_of(&self, face: u32) -> usize {
        usize::from(face >= self.second)
    }

    /// Returns the index of a face among the listed faces of its operand, given its number (faces of both
    /// operands are numbered together).
    fn index_in_operand(&self, face: u32) -> usize {
        (if face < self.second {
            face
        } else {
            face - self.second
        }) as usize
    }

    /// Returns the operand that has the face with this number (faces of both operands are numbered together).
    pub(super) fn operand(&self, face: u32) -> &Operand<'a> {
        &self.operands[self.operand_of(face)]
    }

    /// Converts a face's number among the faces of both operands, which are numbered together, to its number
    /// in its mesh.
    pub(super) fn id(&self, face: u32) -> FaceId {
        self.faces[self.operand_of(face)][self.index_in_operand(face)]
    }

    /// Returns the vertex numbers of the face with this number (faces of both operands are numbered
    /// together).
    pub(super) fn vertices(&self, face: u32) -> [VertexId; 3] {
        self.operand(face).mesh.vertices_of(self.id(face))
    }

    /// Returns the corners, as lattice points, of the face with this number (faces of both operands are
    /// numbered together).
    pub(super) fn corners(&self, face: u32) -> [Lattice; 3] {
        self.operand(face).mesh.corners(self.id(face))
    }

    /// Returns one corner, as a lattice point, of the face with this number (faces of both operands are
    /// numbered together).
    pub(super) fn corner(&self, face: u32, corner: usize) -> Lattice {
        self.operand(face).mesh.vertices[self.vertices(face)[corner].index()]
    }
}
