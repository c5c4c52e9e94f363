//! Lists the nodes of a ray scene's tree, for inspection.

use super::cell::Cell;
use super::scene::Scene;
use super::treelet::{Child, Treelet};
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// A node of a ray scene's tree, for inspection.
#[derive(Clone, Debug)]
pub struct View<const D: usize> {
    /// The box of the node, in lattice steps.
    pub cell: Cell<D>,
    /// The index of the parent in the list of nodes; `None` for the root.
    pub parent: Option<NodeId>,
    /// True if the tree below this node was not made yet, because no ray has visited it.
    pub deferred: bool,
    /// The indices of the facets of a leaf; empty for an inner node.
    pub facets: Vec<u32>,
}

/// Returns the nodes of a scene's tree that were made already, in preorder.
pub fn views<const D: usize>(scene: &Scene<D>) -> Vec<View<D>> {
    let mut found: Vec<View<D>> = Vec::new();
    let known = scene.root().known();
    let mut open = vec![(None, *scene.cell(), known, known.map_or(Child::None, root))];
    while let Some((parent, cell, treelet, child)) = open.pop() {
        poll();
        let number = NodeId::of(found.len());
        let (mut deferred, mut facets) = (treelet.is_none(), Vec::new());
        if let Some(treelet) = treelet {
            let (below, node) = match child {
                Child::Node(node) => (Some(treelet), node),
                Child::Deferred(i) => (treelet.deferred[i as usize].known(), NodeId::ROOT),
                Child::None | Child::Block(_) => (None, NodeId::ROOT),
            };
            if let Child::Block(block) = child {
                facets = treelet.blocks[block as usize].facets().to_vec();
            }
            deferred = matches!(child, Child::Deferred(_)) && below.is_none();
            let wide = below.and_then(|below| Some((below, below.nodes.get(node.index())?)));
            if let Some((below, wide)) = wide {
                for (lane, child) in wide.children.iter().enumerate().rev() {
                    if *child != Child::None {
                        let cell = scene.frame().outward(&wide.span(lane));
                        open.push((Some(number), cell, Some(below), *child));
                    }
                }
            }
        }
        found.push(View {
            cell,
            parent,
            deferred,
            facets,
        });
    }
    found
}

/// The root of a treelet, as the child of a node; `None` if the treelet is empty.
fn root<const D: usize>(treelet: &Treelet<D>) -> Child {
    if treelet.nodes.is_empty() {
        Child::None
    } else {
        Child::Node(NodeId::ROOT)
    }
}
