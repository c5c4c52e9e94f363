//! Samples faces, to detect pairs of meshes that touch nearly everywhere or whose boxes separate little.
//!
//! Copies and revisions of a mesh touch it nearly everywhere, and in bundles of needles (long thin triangles)
//! nearly all boxes meet. Without the sample the arrangement would detect this only after most of its work.

use super::candidates::{FacesInWindow, Operand};
use super::contact::{contact, Contact};
use crate::geometry::doubles::Facing;
use crate::interrupt::spend;
use crate::merge::profile::Declined;

/// The number of sampled faces, each of which is compared with all faces of the other mesh.
const FACES_SAMPLED: usize = 16;

/// The least number of faces in each mesh for which a sample pays.
const SAMPLED_FROM: usize = 256;

/// The most boxes of the other mesh that a sampled face's box may meet on average; in real meshes it meets
/// about twenty.
const CROWDED_FROM: usize = 128;

/// Compares about `FACES_SAMPLED` faces of the first mesh with all faces of the second one in the window.
///
/// # Errors
/// `AllOver` if a sampled face touches a face without crossing it, `Crowded` if too many boxes meet.
pub(super) fn sample(operands: &[Operand; 2], within: &[FacesInWindow; 2]) -> Result<(), Declined> {
    let [first, second] = within;
    if first.faces.len().min(second.faces.len()) < SAMPLED_FROM {
        return Ok(());
    }
    let mut met = 0;
    let sampled = first.faces.iter().zip(&first.boxes);
    for (face, bounds) in sampled.step_by(first.faces.len() / FACES_SAMPLED) {
        spend(second.faces.len() / FACES_SAMPLED);
        let facing = Facing::of(&operands[0].triangle(*face));
        let others = second.faces.iter().zip(&second.boxes);
        for (other, _) in others.filter(|(_, others)| bounds.meets(others)) {
            met += 1;
            let other = Facing::of(&operands[1].triangle(*other));
            if met > CROWDED_FROM * FACES_SAMPLED {
                return Err(Declined::Crowded);
            }
            if matches!(contact(&facing, &other), Contact::Touching(_)) {
                return Err(Declined::AllOver);
            }
        }
    }
    Ok(())
}
