//! The plan for building a tree, and the regions still to be divided.

use super::node::{FragmentTree, NodeCut, Piece};
use super::policy::{Policy, Sample};
use super::trace::Candidate;
use crate::error::Result;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Half;
use crate::geometry::spaces::affine::{Affine, Polytope};
use crate::mesh::handle::NodeId;

/// The plan for building a tree.
pub enum Plan<S: Affine> {
    /// By a policy.
    Policy {
        /// The policy that chooses the pivot.
        policy: Policy,
        /// Divide regions with more pieces than this by axis-parallel cuts where that helps; `None` for
        /// autopartition alone.
        top: Option<usize>,
        /// The root's region, for policies that need it.
        region: Option<Polytope<S>>,
    },
    /// By these cuts, one for each node in preorder.
    Given(Vec<NodeCut>),
    /// By a callback.
    Asked(Ask<S>),
    /// By lines through ends of pieces, or planes through their corners.
    Lines(Lines),
    /// Like this tree, whose pieces come first in the list; at its leaves by another plan.
    Grown(Box<FragmentTree<S>>, Box<Self>),
    /// By these hyperplanes in order, skipping those with all pieces on one side; then by another plan,
    /// which may refer to them.
    Own(Vec<S::Hyperplane>, Box<Self>),
}

impl<S: Affine> Plan<S> {
    pub(super) fn region(&self) -> Option<Polytope<S>> {
        match self {
            Self::Policy { policy, region, .. } if policy.needs_region() => region.clone(),
            Self::Grown(_, rest) | Self::Own(_, rest) => rest.region(),
            _ => None,
        }
    }

    pub(super) fn seed(&self) -> Option<u64> {
        match self {
            Self::Policy {
                policy: Policy::Random(seed),
                ..
            } => Some(*seed),
            Self::Grown(_, rest) | Self::Own(_, rest) => rest.seed(),
            _ => None,
        }
    }
}

/// A callback that decides.
pub type Answering<S> = Box<dyn FnMut(u32, usize, &[Candidate]) -> Result<Answer<S>> + Send>;

/// A callback for each region, and the number of candidates to show it.
pub struct Ask<S: Affine> {
    /// Candidates are evenly spaced in the region's list; there is at least one.
    pub sample: Sample,
    /// Gets the region's depth, the number of its pieces and the candidates, scored by their numbers of
    /// splits.
    pub answer: Answering<S>,
}

/// The answer of a callback.
pub enum Answer<S: Affine> {
    /// The candidate at this index.
    Candidate(usize),
    /// A hyperplane that is no candidate.
    Hyperplane(S::Hyperplane),
}

/// Lines through two corners of pieces in the plane, planes through three in space.
pub struct Lines {
    /// The corners of each piece, by its number.
    pub corners: Vec<Vec<Lattice>>,
    /// The number of them to compare in each region, besides as many supporting hyperplanes.
    pub sample: Sample,
}

/// A region still to be divided, if it has pieces.
pub(super) struct OpenRegion<S: Affine> {
    pub(super) pieces: Vec<Piece<S>>,
    pub(super) place: Option<(NodeId, Half)>,
    pub(super) depth: u32,
    pub(super) region: Option<Polytope<S>>,
    /// The node with the same region in the tree that is extended.
    pub(super) old: Option<NodeId>,
}
