//! The plan by which a tree is to be built, and what of it is still to be divided.

use super::node::{FragmentTree, NodeCut, Piece};
use super::policy::{Policy, Sample};
use super::trace::Candidate;
use crate::error::Result;
use crate::geometry::plane::Lattice;
use crate::geometry::side::Half;
use crate::geometry::spaces::affine::{Affine, Polytope};
use crate::mesh::handle::NodeId;

/// The plan by which a tree is to be built.
pub enum Plan<S: Affine> {
    /// By a policy.
    Policy {
        /// The policy that chooses the pivot.
        policy: Policy,
        /// Regions with more pieces than this are divided by axis-parallel cuts where that helps;
        /// `None` for autopartition alone.
        top: Option<usize>,
        /// The root's region, for policies that ask for it.
        region: Option<Polytope<S>>,
    },
    /// By these cuts, one for each node in preorder.
    Given(Vec<NodeCut>),
    /// By whoever is asked.
    Asked(Ask<S>),
    /// By lines through ends of pieces, or through corners of them.
    Lines(Lines),
    /// As this tree goes, whose pieces are the first of the list; where it ends, by another plan.
    Grown(Box<FragmentTree<S>>, Box<Self>),
    /// By these hyperplanes, each where it does not leave all pieces on one side, in their order;
    /// then by another plan, which may name them.
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

/// A function that decides.
pub type Answering<S> = Box<dyn FnMut(u32, usize, &[Candidate]) -> Result<Answer<S>> + Send>;

/// The one who is asked for each region, and how many candidates he is shown.
pub struct Ask<S: Affine> {
    /// Candidates are evenly spaced in the region's list; there is at least one.
    pub sample: Sample,
    /// Takes the region's depth, the number of its pieces and the candidates, whose scores are
    /// their numbers of splits.
    pub answer: Answering<S>,
}

/// The answer that divides a region.
pub enum Answer<S: Affine> {
    /// The candidate with this place.
    Candidate(usize),
    /// A hyperplane that is no candidate.
    Hyperplane(S::Hyperplane),
}

/// Lines through two corners of pieces in the plane, planes through three in space.
pub struct Lines {
    /// The corners of each piece, by its number.
    pub corners: Vec<Vec<Lattice>>,
    /// The number that are compared in each region, beside as many supporting hyperplanes.
    pub sample: Sample,
}

/// A region that is still to be divided, if there are pieces in it.
pub(super) struct Open<S: Affine> {
    pub(super) pieces: Vec<Piece<S>>,
    pub(super) place: Option<(NodeId, Half)>,
    pub(super) depth: u32,
    pub(super) region: Option<Polytope<S>>,
    /// The node of the tree that is grown with the same region.
    pub(super) old: Option<NodeId>,
}
