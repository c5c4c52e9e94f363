//! The convex regions of In leaves, which make up a set.

use super::node::{Label, PartitionTree};
use crate::geometry::side::Half;
use crate::geometry::spaces::space::{Region, Space};
use crate::interrupt::poll;

/// For each In leaf, the faces of its region, with the region on their minus sides.
///
/// The regions are a convex decomposition of the set. The border of the frame is not a face.
///
/// # Order
/// Leaves in preorder, minus before plus; the faces of a region in the order of the cuts from the root down.
///
/// # Cost
/// For each In leaf, the square of its depth.
pub fn cells<S: Space>(tree: &PartitionTree<S>, frame: &S::Frame) -> Vec<Vec<S::Fragment>> {
    let mut region = Region::<S>::new(frame.clone());
    let mut cells = Vec::new();
    let mut pending = vec![(tree.clone(), None)];
    while let Some((next, from)) = pending.pop() {
        poll();
        if let Some((depth, bound, half)) = from {
            region.truncate(depth);
            region.push(bound, half);
        }
        match next {
            PartitionTree::Leaf(Label::In) => cells.push(region.faces()),
            PartitionTree::Leaf(Label::Out) => {}
            PartitionTree::Cut(cut) => {
                let depth = region.depth();
                for half in [Half::Plus, Half::Minus] {
                    let from = Some((depth, cut.hyperplane().clone(), half));
                    pending.push((cut.child(half), from));
                }
            }
        }
    }
    cells
}
