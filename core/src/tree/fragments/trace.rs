//! Records of how a fragment tree was built: one for each node, in the order of the nodes.

use serde::{Deserialize, Serialize};

use super::node::NodeCut;
use crate::geometry::side::Half;
use crate::mesh::handle::NodeId;

/// A record of how a node's hyperplane divided a region.
///
/// Pieces are identified by their numbers: a convex piece has at most one part in a convex region.
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
    /// The candidates that were compared, in the order of the list of pieces; empty if none were.
    pub candidates: Vec<Candidate>,
    /// The numbers of the pieces in the region, in the order of the list.
    pub pieces: Vec<u32>,
    /// The numbers of the pieces with a part on the minus side.
    pub minus: Vec<u32>,
    /// The numbers of the pieces with a part on the plus side.
    pub plus: Vec<u32>,
    /// The numbers of the pieces with parts on both sides.
    pub split: Vec<u32>,
    /// The numbers of the pieces that lie in the hyperplane.
    pub coplanar: Vec<u32>,
}

/// The reason why a hyperplane divides a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Reason {
    /// Its piece is the first in the given list.
    First,
    /// Its piece is the first in the list, which was shuffled once.
    Random,
    /// It cuts the fewest pieces of all candidates.
    LeastSplits,
    /// The numbers of pieces on its two sides differ least.
    Balanced,
    /// The weighted sum of the sides' difference and the number of cut pieces is least.
    Weighted,
    /// The expected number of pieces on a random point's side is least.
    LeastCost,
    /// It is an axis-parallel cut at the median of a long list's corners.
    Median,
    /// It was a given cut.
    Given,
    /// A callback chose this hyperplane.
    Asked,
    /// It passes through corners of pieces, or supports a piece, and its larger side has the fewest pieces.
    Ends,
}

/// A hyperplane that was compared with others when a region was divided.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The number of the piece whose hyperplane this is.
    pub piece: u32,
    /// The number of pieces with parts on its minus side.
    pub minus: u32,
    /// The number of pieces with parts on its plus side.
    pub plus: u32,
    /// The number of pieces with parts on both sides.
    pub splits: u32,
    /// The score that the policy minimizes; of equal scores, the first is chosen.
    pub score: f64,
}
