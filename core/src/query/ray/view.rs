//! The nodes of a scene's tree, for inspection.

use super::cell::Cell;
use super::scene::Scene;
use super::treelet::{Child, Treelet};
use crate::interrupt::poll;
use crate::mesh::handle::NodeId;

/// A node as it is shown.
#[derive(Clone, Debug)]
pub struct View<const D: usize> {
    /// Its box, in lattice steps.
    pub cell: Cell<D>,
    /// The node above, by its place in this list.
    pub parent: Option<NodeId>,
    /// True if no ray has reached it yet.
    pub deferred: bool,
    /// The facets of a leaf.
    pub facets: Vec<u32>,
}

/// The nodes made so far, in preorder.
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

/// The root of a treelet as a child.
fn root<const D: usize>(treelet: &Treelet<D>) -> Child {
    if treelet.nodes.is_empty() {
        Child::None
    } else {
        Child::Node(NodeId::ROOT)
    }
}
