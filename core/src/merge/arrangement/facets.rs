//! Numbers the faces of all operands together.

use smallvec::SmallVec;

use super::candidates::Operand;
use crate::arith::convert::as_number;
use crate::geometry::plane::Lattice;
use crate::mesh::handle::{FaceId, VertexId};

/// The number of a face among the faces of all operands: operand after operand, each in the order of its
/// mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct FacetId(u32);

/// The operands of an arrangement, and the numbers of their faces.
#[derive(Debug)]
pub(super) struct Facets<'a> {
    pub(super) operands: Vec<Operand<'a>>,
    /// For each operand the number of its first face.
    firsts: SmallVec<[u32; 2]>,
}

impl<'a> Facets<'a> {
    pub(super) fn of(operands: Vec<Operand<'a>>) -> Self {
        let mut next = 0;
        let firsts = operands.iter().map(|operand| {
            let first = next;
            next += as_number(operand.mesh.faces.len());
            first
        });
        Self {
            firsts: firsts.collect(),
            operands,
        }
    }

    /// Returns the number of an operand's face.
    pub(super) fn number(&self, operand: usize, face: FaceId) -> FacetId {
        FacetId(self.firsts[operand] + face.0)
    }

    /// Returns the index of the operand that has a facet.
    pub(super) fn operand_of(&self, facet: FacetId) -> usize {
        let later = &self.firsts[1..];
        later.iter().take_while(|first| **first <= facet.0).count()
    }

    /// Returns the operand that has a facet.
    pub(super) fn operand(&self, facet: FacetId) -> &Operand<'a> {
        &self.operands[self.operand_of(facet)]
    }

    /// Returns the number of a facet in its mesh.
    pub(super) fn face(&self, facet: FacetId) -> FaceId {
        FaceId(facet.0 - self.firsts[self.operand_of(facet)])
    }

    pub(super) fn vertices(&self, facet: FacetId) -> [VertexId; 3] {
        self.operand(facet).mesh.vertices_of(self.face(facet))
    }

    /// Returns the corners of a facet as lattice points.
    pub(super) fn corners(&self, facet: FacetId) -> [Lattice; 3] {
        self.operand(facet).mesh.corners(self.face(facet))
    }

    /// Returns one corner of a facet as a lattice point.
    pub(super) fn corner(&self, facet: FacetId, corner: usize) -> Lattice {
        self.operand(facet).mesh.vertices[self.vertices(facet)[corner].index()]
    }
}
