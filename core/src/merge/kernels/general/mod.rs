//! The leaf kernel for operands in general position.
//!
//! Only faces that truly cross are divided, by each other. Everything else keeps its winding numbers
//! over the whole cell: they are counted once along a path from the cell's corner, for all faces
//! that hang together at vertices. Whatever is special — faces in one plane, edges in faces,
//! contacts, operands that overlap themselves — is left to the local trees of `leaf`.

mod anchors;
mod curves;
mod fates;
mod keep;
mod known;
mod labels;
mod points;
mod scene;
mod segment;
mod trace;

use smallvec::SmallVec;

use super::kept::Kept;
use crate::geometry::cell::Cell;
use crate::merge::expression::Expression;
use crate::merge::lists::list::{List, Sources};
use scene::Scene;

/// More operands than this do not meet in one small cell, or are left to the local trees.
pub const MOST: usize = 64;

/// For each operand of the cell whether a region is inside it, as bits.
type Labels = u64;

/// The labels of an element's pieces: of one that nothing cuts, or of a few.
type OnPieces = SmallVec<[Labels; 2]>;

/// What stays of the operands' boundaries in a cell, and the winding number at its corner; `None`
/// if their position is special.
pub fn evaluate(
    cell: &Cell,
    expression: &Expression,
    lists: &[(u32, &List)],
    sources: &Sources,
) -> Option<(Vec<Kept>, i32)> {
    let simple = lists.iter().all(|(_, list)| (0..=1).contains(&list.corner));
    if !simple || lists.len() < 2 || lists.len() > MOST {
        return None;
    }
    let scene = Scene::new(cell, lists, sources);
    let fates = scene.fates()?;
    let labels = scene.labels(&fates)?;
    let place = |number: u32| lists.partition_point(|l| l.0 < number);
    let scratch = &mut Vec::new();
    let mut value = |bits: Labels| expression.value(|k| bits >> place(k) & 1 == 1, scratch);
    let corner = i32::from(value(scene.at_corner()));
    let kept = scene.keep(fates, &labels, &mut value);
    Some((kept, corner))
}
