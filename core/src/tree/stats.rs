//! The size of a tree.

use super::node::Node;
use super::solid::Solid;

/// Counts over a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Cuts.
    pub nodes: usize,
    /// Leaves without boundary.
    pub leaves: usize,
    /// Deferred leaves.
    pub deferred: usize,
    /// Listed whole faces, once for each leaf.
    pub elements: usize,
    /// Listed parts.
    pub parts: usize,
    /// The longest path, in cuts.
    pub depth: usize,
}

/// Counts a solid's tree; shared subtrees count at each occurrence.
pub fn stats(solid: &Solid) -> Stats {
    let mut total = Stats::default();
    let mut open = vec![(solid.root().node.clone(), 0)];
    while let Some((node, depth)) = open.pop() {
        total.depth = total.depth.max(depth);
        match &*node {
            Node::Leaf(_) => total.leaves += 1,
            Node::Deferred(leaf) => {
                total.deferred += 1;
                total.parts += leaf.parts.len();
                total.elements += leaf.len() - leaf.parts.len();
            }
            Node::Cut(halves) => {
                total.nodes += 1;
                open.extend(halves.children.iter().map(|c| (c.node.clone(), depth + 1)));
            }
        }
    }
    total
}
