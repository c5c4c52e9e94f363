//! The reasons why a solid's boundary makes no mesh.

use std::sync::Arc;

use crate::error::{Error, ErrorKind, Result};
use crate::merge::evaluate::overlaps_itself;
use crate::mesh::handle::{OrientedFace, Slot};
use crate::mesh::source::Source;
use crate::tree::solid::Solid;

/// A reason why a boundary makes no mesh.
pub(super) enum Failure {
    /// Faces cross or overlap each other.
    Overlap(Overlap),
    /// No mesh can be made for another reason, such as an infinite boundary.
    Refused(Error),
}

/// Faces found to cross or overlap each other.
pub(super) struct Overlap {
    /// What was found, as a text for the error message.
    pub(super) sign: String,
    /// The faces at which the failure was found.
    pub(super) faces: Vec<OrientedFace>,
}

impl From<Overlap> for Failure {
    fn from(overlap: Overlap) -> Self {
        Self::Overlap(overlap)
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Refused(error)
    }
}

impl Failure {
    /// Returns the error to report: `NotReduced` if an input mesh overlaps itself, else a defect or a
    /// refusal.
    pub(super) fn error(self, solid: &Solid) -> Error {
        match self {
            Self::Refused(error) => error,
            Self::Overlap(overlap) => overlap.error(solid),
        }
    }
}

impl Overlap {
    fn error(self, solid: &Solid) -> Error {
        if solid.is_reduced_by_claim() {
            return Error::internal(self.sign);
        }
        let (slot, source) = match culprit(solid) {
            Ok(Some(found)) => found,
            Ok(None) => return Error::internal(self.sign),
            Err(error) => return error,
        };
        let own = self.faces.iter().filter(|f| f.slot() == slot);
        let mut faces: Vec<u64> = own.map(|f| u64::from(f.id().0)).collect();
        faces.sort_unstable();
        faces.dedup();
        let note = if solid.is_reduced() {
            ", though it was declared trusted"
        } else {
            ""
        };
        let text = format!(
            "input mesh {} of the solid (source {}) overlaps itself{note}: {}",
            slot.0,
            source.id(),
            self.sign
        );
        Error::at(ErrorKind::NotReduced, faces, text)
    }
}

/// Returns the first input mesh that overlaps itself, with its slot; `None` if there is none.
fn culprit(solid: &Solid) -> Result<Option<(Slot, &Arc<Source>)>> {
    for (slot, source) in Slot::all().zip(solid.sources().iter()) {
        if overlaps_itself(source)? {
            return Ok(Some((slot, source)));
        }
    }
    Ok(None)
}
