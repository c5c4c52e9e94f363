//! Records of how a fragment tree was built: one for each node, in the order of the nodes.

use serde::{Deserialize, Serialize};

use super::node::NodeCut;
use crate::geometry::side::Half;
use crate::mesh::handle::NodeId;

/// A record of how a node's hyperplane divided a region.
///
/// Pieces (convex parts of facets) are identified by their numbers: a convex piece has at most one part in a
/// convex region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Division {
    /// The new node that divides the region.
    pub node: NodeId,
    /// The parent, and the side of it on which the region lies; `None` for the root.
    pub place: Option<(NodeId, Half)>,
    /// The number of cuts above the node.
    pub depth: u32,
    /// The origin of the hyperplane.
    pub cut: NodeCut,
    /// The reason why this hyperplane was chosen.
    pub reason: Reason,
    /// The candidates that were compared, in the order of the list of pieces (convex parts of facets); empty
    /// if none were.
    pub candidates: Vec<Candidate>,
    /// The numbers of the pieces (convex parts of facets) in the region, in the order of the list.
    pub pieces: Vec<u32>,
    /// The numbers of the pieces (convex parts of facets) with a part on the minus side.
    pub minus: Vec<u32>,
    /// The numbers of the pieces (convex parts of facets) with a part on the plus side.
    pub plus: Vec<u32>,
    /// The numbers of the pieces (convex parts of facets) with parts on both sides.
    pub split: Vec<u32>,
    /// The numbers of the pieces (convex parts of facets) that lie in the hyperplane.
    pub coplanar: Vec<u32>,
}

/// The reason why a hyperplane divides a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Reason {
    /// The hyperplane contains the first piece (convex part of a facet) in the given list.
    First,
    /// The hyperplane contains the first piece (convex part of a facet) in the list, which was shuffled once.
    Random,
    /// The hyperplane cuts the fewest pieces (convex parts of facets) of all candidates.
    LeastSplits,
    /// The numbers of pieces (convex parts of facets) on the two sides of the hyperplane differ least.
    Balanced,
    /// The weighted sum of the sides' difference and the number of cut pieces (convex parts of facets) is
    /// least.
    Weighted,
    /// The expected number of pieces (convex parts of facets) on a random point's side of the hyperplane is
    /// least.
    LeastCost,
    /// The hyperplane is an axis-parallel cut at the median of a long list's corners.
    Median,
    /// The hyperplane was given by the caller.
    Given,
    /// A callback chose this hyperplane.
    Asked,
    /// The hyperplane passes through corners of pieces (convex parts of facets), or supports a piece, and its
    /// larger side has the fewest pieces.
    Ends,
}

/// A hyperplane that was compared with others when a region was divided.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The number of the piece (a convex part of a facet) whose hyperplane this is.
    pub piece: u32,
    /// The number of pieces (convex parts of facets) with parts on the minus side of the hyperplane.
    pub minus: u32,
    /// The number of pieces (convex parts of facets) with parts on the plus side of the hyperplane.
    pub plus: u32,
    /// The number of pieces (convex parts of facets) with parts on both sides of the hyperplane.
    pub splits: u32,
    /// The score that the policy minimizes; of equal scores, the first is chosen.
    pub score: f64,
}
