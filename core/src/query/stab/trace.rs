//! The trace of a ray: its cost, and what it did to the tree.

use serde::{Deserialize, Serialize};

use crate::mesh::handle::NodeId;

/// Counts of one ray's way through a tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    /// Nodes visited, including leaves.
    pub nodes: u32,
    /// Leaves stabbed.
    pub leaves: u32,
    /// Facets tested, in leaves and in cuts.
    pub tests: u32,
}

/// A step of a ray through a tree that counts; facets by their places in the input.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum StabEvent {
    /// A node is visited, an inner one or a leaf.
    Visit {
        /// The node.
        node: NodeId,
        /// T(v) after this visit.
        visits: u64,
        /// True if it is a leaf.
        leaf: bool,
    },
    /// A facet of a leaf's list or in a cut is tested.
    Test {
        /// The node.
        node: NodeId,
        /// The facet.
        facet: u32,
        /// True if the ray meets it.
        met: bool,
    },
    /// A facet of a leaf is hit within the leaf.
    Count {
        /// The leaf.
        node: NodeId,
        /// The facet.
        facet: u32,
        /// T(p) after this hit.
        hits: u64,
    },
    /// A leaf is divided.
    Divide {
        /// The leaf, an inner node from now on.
        node: NodeId,
        /// The facet whose hyperplane is the cut.
        facet: u32,
        /// The facets in the cut.
        coplanar: Vec<u32>,
        /// The new leaves on the minus and the plus side.
        children: [NodeId; 2],
        /// L(v) of the new leaves, in the order of their heaps.
        lists: [Vec<u32>; 2],
    },
}
