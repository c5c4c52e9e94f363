//! The contents of each node of a stab tree, for inspection.

use std::sync::atomic::Ordering;

use super::cast::Cast;
use super::node::Content;
use super::tree::StabTree;
use crate::arith::Int;
use crate::mesh::handle::NodeId;

/// A node of a stab tree, for inspection; facets are given by their indices in the input.
#[derive(Clone, Debug)]
pub struct View<const D: usize> {
    /// The number of visits T(v).
    pub visits: u64,
    /// The number of cuts above the node.
    pub depth: u32,
    /// The normal and the offset of the cut n·x + c = 0, and the children on its minus and its plus side;
    /// `None` for a leaf.
    pub cut: Option<([i128; D], Int<3>, [NodeId; 2])>,
    /// For a leaf, its list of facets L(v) in the order of the heap; for an inner node, the facets in its
    /// cut, the pivot first.
    pub facets: Vec<u32>,
    /// The hits T(p) of each facet in `facets`; 0 for those in a cut.
    pub hits: Vec<u64>,
}

impl<S: Cast<D>, const D: usize> StabTree<S, D> {
    /// Returns all nodes in the order in which they were made.
    pub fn views(&self) -> Vec<View<D>> {
        let number = |facet: u32| self.scene().number(facet);
        let view = |node: &super::node::Node<S, D>| {
            let (visits, depth) = (node.visits.load(Ordering::Relaxed), node.depth);
            match &node.content {
                Content::Leaf(list) => View {
                    visits,
                    depth,
                    cut: None,
                    facets: list.entries().iter().map(|e| number(e.facet)).collect(),
                    hits: list.entries().iter().map(|e| e.hits).collect(),
                },
                Content::Inner(inner) => {
                    let (normal, offset) = inner.cut.coefficients();
                    View {
                        visits,
                        depth,
                        cut: Some((normal, offset, inner.children)),
                        facets: inner.coplanar.iter().map(|f| number(*f)).collect(),
                        hits: vec![0; inner.coplanar.len()],
                    }
                }
            }
        };
        self.nodes().all.iter().map(view).collect()
    }
}
