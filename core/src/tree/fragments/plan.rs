//! Plans for building a fragment tree: which hyperplane divides each region.

use super::node::{FragmentTree, NodeCut, Piece};
use super::policy::{Policy, Sample};
use super::trace::Candidate;
use crate::error::Result;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Half;
use crate::geometry::spaces::affine::{Affine, Polytope};
use crate::mesh::handle::NodeId;

/// The plan for building a fragment tree: which hyperplane divides each region.
pub enum Plan<S: Affine> {
    /// A policy chooses a pivot among the region's pieces (convex parts of facets).
    Policy {
        /// The policy that chooses the pivot.
        policy: Policy,
        /// Regions with more pieces (convex parts of facets) than this are divided by axis-parallel cuts
        /// where these divide well; `None` for autopartition alone.
        top: Option<usize>,
        /// The region of the root, for policies that compare volumes.
        region: Option<Polytope<S>>,
    },
    /// The given cuts, one for each node in preorder.
    Given(Vec<NodeCut>),
    /// A callback chooses each hyperplane.
    Asked(Ask<S>),
    /// Hyperplanes through corners of pieces (convex parts of facets) are compared with supporting ones:
    /// lines through two, planes through three.
    Lines(Lines),
    /// The cuts of an existing tree, whose pieces (convex parts of facets) come first in the list; another
    /// plan divides its leaves.
    Grown(Box<FragmentTree<S>>, Box<Self>),
    /// The given hyperplanes in order, except where all pieces (convex parts of facets) are on one side; then
    /// another plan, which may refer to them by index.
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

/// A callback that chooses the hyperplane for a region from its depth, its number of pieces (convex parts of
/// facets) and the candidates.
pub type AnswerCallback<S> = Box<dyn FnMut(u32, usize, &[Candidate]) -> Result<Answer<S>> + Send>;

/// A callback that chooses hyperplanes, and the number of candidates that it receives.
pub struct Ask<S: Affine> {
    /// The number of candidates, evenly spaced in the region's list of pieces (convex parts of facets); there
    /// is at least one.
    pub sample: Sample,
    /// The callback; each candidate's score is the number of pieces (convex parts of facets) that it cuts.
    pub answer: AnswerCallback<S>,
}

/// The hyperplane that a callback chooses.
pub enum Answer<S: Affine> {
    /// The hyperplane of the candidate at this index.
    Candidate(usize),
    /// A hyperplane that belongs to no candidate.
    Hyperplane(S::Hyperplane),
}

/// The data for cuts through corners of pieces (convex parts of facets): lines through two in the plane,
/// planes through three in space.
pub struct Lines {
    /// The corners of each piece (a convex part of a facet), by the piece's number.
    pub corners: Vec<Vec<Lattice>>,
    /// The number of hyperplanes through corners to compare in each region, and of supporting ones as well.
    pub sample: Sample,
}

/// A region that is not yet divided.
pub(super) struct OpenRegion<S: Affine> {
    pub(super) pieces: Vec<Piece<S>>,
    pub(super) parent: Option<(NodeId, Half)>,
    pub(super) depth: u32,
    pub(super) region: Option<Polytope<S>>,
    /// The node with the same region in the existing tree that the new tree extends, if any.
    pub(super) old: Option<NodeId>,
}
