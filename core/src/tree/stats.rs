//! Counts of the nodes and faces of a solid's tree.

use super::node::Node;
use super::solid::Solid;

/// Counts of the nodes, faces and parts in the tree of a solid, and its depth.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// The number of cuts, which are the inner nodes.
    pub nodes: usize,
    /// The number of leaves without boundary.
    pub leaves: usize,
    /// The number of deferred leaves.
    pub deferred: usize,
    /// The number of whole faces that deferred leaves list; a face counts once for each leaf that lists it.
    pub elements: usize,
    /// The number of parts of faces that deferred leaves list.
    pub parts: usize,
    /// The number of cuts on the longest path from the root to a leaf.
    pub depth: usize,
}

/// Counts the nodes and faces of a solid's tree; a shared subtree counts at each occurrence.
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
