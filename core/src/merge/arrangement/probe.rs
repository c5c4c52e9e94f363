//! A look at a few faces: whether the two meshes touch or are crowded all over.
//!
//! Copies of a mesh, or its revisions, touch nearly everywhere, and bundles of needles meet nearly all
//! others by their boxes. The arrangement would find that out only after most of its work.

use super::candidates::{Operand, Within};
use super::contact::{contact, Contact};
use crate::geometry::doubles::Facing;
use crate::interrupt::spend;
use crate::merge::profile::Declined;

/// Faces that are compared with all faces of the other mesh.
const SAMPLE: usize = 16;

/// With fewer faces than this all the work costs less than a look is worth.
const WORTH_A_LOOK: usize = 256;

/// Faces of the other mesh that a box meets, on average, in a crowd; of real meshes it meets about twenty.
const CROWD: usize = 128;

/// Looks at some faces of the first mesh.
///
/// # Errors
/// `AllOver` if one of them touches another face, `Crowded` if boxes do not tell faces apart.
pub(super) fn probe(operands: &[Operand; 2], within: &[Within; 2]) -> Result<(), Declined> {
    let [first, second] = within;
    if first.faces.len().min(second.faces.len()) < WORTH_A_LOOK {
        return Ok(());
    }
    let mut met = 0;
    let sampled = first.faces.iter().zip(&first.boxes);
    for (face, bounds) in sampled.step_by(first.faces.len() / SAMPLE) {
        spend(second.faces.len() / SAMPLE);
        let facing = Facing::of(&operands[0].triangle(*face));
        let others = second.faces.iter().zip(&second.boxes);
        for (other, _) in others.filter(|(_, others)| bounds.meets(others)) {
            met += 1;
            let other = Facing::of(&operands[1].triangle(*other));
            if met > CROWD * SAMPLE {
                return Err(Declined::Crowded);
            }
            if matches!(contact(&facing, &other), Contact::Touching(_)) {
                return Err(Declined::AllOver);
            }
        }
    }
    Ok(())
}
