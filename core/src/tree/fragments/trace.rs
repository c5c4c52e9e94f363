//! The construction of a fragment tree: one record for each node, in the order of the nodes.

use serde::{Deserialize, Serialize};

use super::node::NodeCut;
use crate::geometry::side::Half;
use crate::mesh::handle::NodeId;

/// A division of a region.
///
/// Numbers identify pieces: a convex piece has one part at most in a convex region.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Division {
    /// The new node.
    pub node: NodeId,
    /// The parent and the side of it; `None` for the root.
    pub place: Option<(NodeId, Half)>,
    /// The number of cuts above.
    pub depth: u32,
    /// The owner of the hyperplane.
    pub cut: NodeCut,
    /// The reason for this hyperplane.
    pub reason: Reason,
    /// The compared candidates, in the order of the list; empty if nothing was compared.
    pub candidates: Vec<Candidate>,
    /// The pieces in the region, in the order of the list.
    pub pieces: Vec<u32>,
    /// The pieces with a part on the minus side.
    pub minus: Vec<u32>,
    /// The pieces with a part on the plus side.
    pub plus: Vec<u32>,
    /// The pieces with parts on both sides.
    pub split: Vec<u32>,
    /// The pieces in the hyperplane.
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
    /// A callback chose it.
    Asked,
    /// It goes through corners of pieces, or supports one, and its larger side has the fewest pieces.
    Ends,
}

/// A hyperplane that might have been chosen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The piece whose hyperplane it is.
    pub piece: u32,
    /// The number of pieces with parts on its minus side.
    pub minus: u32,
    /// The number of pieces with parts on its plus side.
    pub plus: u32,
    /// The number of pieces with parts on both sides.
    pub splits: u32,
    /// The score that the policy minimizes; the first of equal ones wins.
    pub score: f64,
}
