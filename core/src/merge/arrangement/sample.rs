//! A sample of faces, to detect meshes that touch or are crowded all over.
//!
//! Copies of a mesh, or its revisions, touch nearly everywhere, and in bundles of needles nearly all boxes
//! meet. The arrangement would find this out only after most of its work.

use super::candidates::{Operand, Within};
use super::contact::{contact, Contact};
use crate::geometry::doubles::Facing;
use crate::interrupt::spend;
use crate::merge::profile::Declined;

/// The number of faces compared with all faces of the other mesh.
const FACES_SAMPLED: usize = 16;

/// With fewer faces than this, all the work costs less than a sample is worth.
const SAMPLED_FROM: usize = 256;

/// In a crowd a box meets this many faces of the other mesh on average; in real meshes about twenty.
const CROWDED_FROM: usize = 128;

/// Samples faces of the first mesh.
///
/// # Errors
/// `AllOver` if one of them touches another face, `Crowded` if boxes do not separate faces.
pub(super) fn sample(operands: &[Operand; 2], within: &[Within; 2]) -> Result<(), Declined> {
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
