//! Tests whether a tree's set reaches the border of the frame.

use super::node::{Label, PartitionTree};
use crate::geometry::side::{Half, Split};
use crate::geometry::spaces::axis::AxisSpace;
use crate::interrupt::poll;

/// Return whether the set is bounded: no In leaf touches the border of the frame.
///
/// # Cost
/// Proportional to the number of nodes whose regions reach the border.
pub fn is_bounded<S: AxisSpace>(tree: &PartitionTree<S>) -> bool {
    let mut pending: Vec<_> = S::border().into_iter().map(|p| (tree.clone(), p)).collect();
    while let Some((tree, piece)) = pending.pop() {
        poll();
        let cut = match tree {
            PartitionTree::Leaf(Label::In) => return false,
            PartitionTree::Leaf(Label::Out) => continue,
            PartitionTree::Cut(cut) => cut,
        };
        let [minus, plus] = [Half::Minus, Half::Plus].map(|half| cut.child(half));
        match S::split(&piece, cut.hyperplane()) {
            Split::Minus => pending.push((minus, piece)),
            Split::Plus => pending.push((plus, piece)),
            Split::Both { minus: a, plus: b } => pending.extend([(minus, a), (plus, b)]),
            Split::Coplanar(_) => pending.extend([(minus, piece.clone()), (plus, piece)]),
        }
    }
    true
}
