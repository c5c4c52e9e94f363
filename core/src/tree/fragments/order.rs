//! The painter's order of a fragment tree: no fragment hides another one that comes later.

use super::node::FragmentTree;
use crate::geometry::side::Side;
use crate::geometry::spaces::affine::{Affine, Viewpoint};
use crate::mesh::handle::NodeId;

/// For each node, the side of its hyperplane on which the viewpoint lies.
pub fn sides<S: Affine>(tree: &FragmentTree<S>, eye: &Viewpoint) -> Vec<Side> {
    tree.nodes()
        .iter()
        .map(|node| eye.side::<S>(&node.hyperplane))
        .collect()
}

/// The nodes in painter's order, from the farthest to the nearest, as seen from a viewpoint.
///
/// The subtree on the far side of a node's hyperplane comes first, then the node itself, then the subtree on
/// the viewpoint's side. If the viewpoint is in the hyperplane, neither side hides the other, and the plus
/// side comes first. The reverse is a front-to-back order.
///
/// # Source
/// Fuchs, Kedem, Naylor 1980.
pub fn back_to_front<S: Affine>(tree: &FragmentTree<S>, eye: &Viewpoint) -> Vec<NodeId> {
    let mut order = Vec::with_capacity(tree.nodes().len());
    let mut pending = Vec::new();
    if !tree.nodes().is_empty() {
        pending.push(Step::Enter(NodeId::ROOT));
    }
    while let Some(step) = pending.pop() {
        let number = match step {
            Step::Emit(number) => {
                order.push(number);
                continue;
            }
            Step::Enter(number) => number,
        };
        let node = &tree.nodes()[number.index()];
        let (far, near) = match eye.side::<S>(&node.hyperplane) {
            Side::Plus => (node.minus, node.plus),
            Side::Minus | Side::On => (node.plus, node.minus),
        };
        pending.extend(near.map(Step::Enter));
        pending.push(Step::Emit(number));
        pending.extend(far.map(Step::Enter));
    }
    order
}

enum Step {
    Enter(NodeId),
    Emit(NodeId),
}
