//! The construction of a fragment tree: one record for each node, in the order of the nodes.

use serde::{Deserialize, Serialize};

use super::node::NodeCut;
use crate::geometry::side::Half;
use crate::mesh::handle::NodeId;

/// A region was divided.
///
/// Pieces are named by their numbers: a convex piece has one part at most in a convex region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Division {
    /// The node made.
    pub node: NodeId,
    /// The node above and the side of it; `None` for the root.
    pub place: Option<(NodeId, Half)>,
    /// The number of cuts above.
    pub depth: u32,
    /// The owner of the hyperplane.
    pub cut: NodeCut,
    /// The reason for this one.
    pub reason: Reason,
    /// The candidates compared, in the order of the list; none where nothing was compared.
    pub candidates: Vec<Candidate>,
    /// The pieces in the region, in the order of the list.
    pub pieces: Vec<u32>,
    /// Those with a part on the minus side.
    pub minus: Vec<u32>,
    /// Those with a part on the plus side.
    pub plus: Vec<u32>,
    /// Those with parts on both sides.
    pub split: Vec<u32>,
    /// Those in the hyperplane.
    pub coplanar: Vec<u32>,
}

/// The reason why a hyperplane divides a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Reason {
    /// Its piece is the first of the list.
    First,
    /// Its piece is the first of the list, which was shuffled once.
    Random,
    /// It cuts the fewest pieces of all candidates.
    LeastSplits,
    /// Its sides differ least.
    Balanced,
    /// Its weighted sum of imbalance and cuts is least.
    Weighted,
    /// The expected number of pieces after it is least.
    LeastCost,
    /// It is axis-parallel and halves a long list.
    Median,
    /// It was given.
    Given,
    /// Whoever was asked said so.
    Asked,
    /// It goes through corners of pieces, or supports one, and its larger side has fewest pieces.
    Ends,
}

/// A hyperplane that might have been chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The piece whose hyperplane it is.
    pub piece: u32,
    /// The number of pieces that have parts on its minus side.
    pub minus: u32,
    /// The number of those on its plus side.
    pub plus: u32,
    /// The number of those on both.
    pub splits: u32,
    /// The score that the policy minimizes; of equal ones the first is taken.
    pub score: f64,
}
