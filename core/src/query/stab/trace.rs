//! The trace of a ray through a stab tree: its cost, and its changes of the tree.

use serde::{Deserialize, Serialize};

use crate::mesh::handle::NodeId;

/// The cost of one ray's path through a stab tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    /// The number of nodes visited, leaves among them.
    pub nodes: u32,
    /// The number of leaves visited.
    pub leaves: u32,
    /// The number of facets tested, in leaves and in cuts.
    pub tests: u32,
}

/// A step of a ray through a stab tree; facets are given by their indices in the input.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum StabEvent {
    /// The ray visits a node, an inner one or a leaf.
    Visit {
        /// The number of the node.
        node: NodeId,
        /// The visits T(v) of the node, this one counted.
        visits: u64,
        /// True if it is a leaf.
        leaf: bool,
    },
    /// The ray is tested against a facet in a leaf's list or in a cut.
    Test {
        /// The number of the node.
        node: NodeId,
        /// The index of the facet.
        facet: u32,
        /// True if the ray meets it.
        met: bool,
    },
    /// A facet of a leaf is hit in the leaf's region, and the hit is counted.
    Count {
        /// The number of the leaf.
        node: NodeId,
        /// The index of the facet.
        facet: u32,
        /// The hits T(p) of the facet, this one counted.
        hits: u64,
    },
    /// A leaf is divided after the ray.
    Divide {
        /// The number of the leaf, which is now an inner node.
        node: NodeId,
        /// The index of the facet whose hyperplane is the cut.
        facet: u32,
        /// The indices of the facets in the cut.
        coplanar: Vec<u32>,
        /// The numbers of the new leaves on the minus and the plus side.
        children: [NodeId; 2],
        /// The lists L(v) of the new leaves, in the order of their heaps.
        lists: [Vec<u32>; 2],
    },
}
