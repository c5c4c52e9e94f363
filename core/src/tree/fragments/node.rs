//! The nodes of a fragment tree in a list in preorder, and the fragments in their coplanar sets.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::geometry::side::Half;
use crate::geometry::spaces::affine::{Affine, Polytope};
use crate::mesh::handle::NodeId;

/// A convex part of a facet (piece) from which a tree is built, or a part of it, with its number.
#[derive(Clone, Debug)]
pub struct Piece<S: Affine> {
    /// The convex part of the facet, as a fragment.
    pub fragment: S::Fragment,
    /// The number of the piece (convex part of an input facet) from which the fragment was cut.
    pub number: u32,
}

/// A piece (a convex part of a facet) that lies in a node's hyperplane.
#[derive(Clone, Debug)]
pub struct Fragment<S: Affine> {
    /// A piece (convex part of an input facet), or the part of it in the node's region.
    pub piece: Piece<S>,
    /// True if the orientation of the piece (a convex part of a facet) is opposite to that of the node's
    /// hyperplane.
    pub flipped: bool,
}

/// The origin of a node's hyperplane; enough to rebuild the tree from the pieces (convex parts of facets).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum NodeCut {
    /// The supporting hyperplane of the input piece (a convex part of a facet) with this number.
    Pivot(u32),
    /// The hyperplane `x[axis] = at`, in lattice steps: a free cut.
    Axis {
        /// The axis to which the cut is perpendicular.
        axis: usize,
        /// The coordinate of the cut on the axis, in lattice steps.
        at: i64,
    },
    /// The hyperplane at this index in the tree's own list, see `FragmentTree::own`.
    Own(u32),
}

/// An inner node: a region that a hyperplane divides.
#[derive(Clone, Debug)]
pub struct Node<S: Affine> {
    /// The hyperplane that divides the node's region.
    pub hyperplane: S::Hyperplane,
    /// The origin of the hyperplane.
    pub cut: NodeCut,
    /// The fragments that lie in the hyperplane, as a range of the tree's fragments.
    pub coplanar: Range<u32>,
    /// The child on the minus side; `None` if no facet lies there.
    pub minus: Option<NodeId>,
    /// The child on the plus side; `None` if no facet lies there.
    pub plus: Option<NodeId>,
    /// The parent, and on which side of its hyperplane this node lies; `None` for the root.
    pub parent: Option<(NodeId, Half)>,
    /// The number of cuts above this node.
    pub depth: u32,
}

/// The event that a node's hyperplane cut a fragment of a piece (a convex part of a facet).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crossing {
    /// The node whose hyperplane cut the fragment.
    pub node: NodeId,
    /// The number of the piece (a convex part of a facet) that was cut.
    pub piece: u32,
}

/// A partition tree over facets, whose inner nodes list the fragments in their hyperplanes.
#[derive(Clone, Debug)]
pub struct FragmentTree<S: Affine> {
    pub(super) nodes: Vec<Node<S>>,
    pub(super) fragments: Vec<Fragment<S>>,
    pub(super) crossings: Vec<Crossing>,
    pub(super) own: Vec<S::Hyperplane>,
}

impl<S: Affine> FragmentTree<S> {
    /// The tree without facets, which has no nodes, and with the given list of own hyperplanes.
    pub(super) fn empty(own: Vec<S::Hyperplane>) -> Self {
        Self {
            nodes: Vec::new(),
            fragments: Vec::new(),
            crossings: Vec::new(),
            own,
        }
    }

    /// The inner nodes in preorder, minus before plus; the root is first.
    pub fn nodes(&self) -> &[Node<S>] {
        &self.nodes
    }

    /// The fragments in the coplanar sets of all nodes, node by node.
    pub fn fragments(&self) -> &[Fragment<S>] {
        &self.fragments
    }

    /// All cuts of fragments by nodes' hyperplanes, node by node.
    pub fn crossings(&self) -> &[Crossing] {
        &self.crossings
    }

    /// The tree's list of hyperplanes that come from neither a facet nor an axis.
    pub fn own_hyperplanes(&self) -> &[S::Hyperplane] {
        &self.own
    }

    /// The child on one side of a node; `None` if no facet lies there.
    pub fn child(&self, node: NodeId, half: Half) -> Option<NodeId> {
        let node = self.nodes.get(node.index())?;
        match half {
            Half::Minus => node.minus,
            Half::Plus => node.plus,
        }
    }

    /// The region of a node: the part of `whole` on the node's sides of all cuts above it.
    ///
    /// `None` if there is no such node or its region is empty.
    ///
    /// # Cost
    /// One division of a region for each cut above the node.
    pub fn region(&self, node: NodeId, whole: &Polytope<S>) -> Option<Polytope<S>> {
        let mut way = Vec::new();
        let mut next = self.nodes.get(node.index())?.parent;
        while let Some((above, half)) = next {
            let above = self.nodes.get(above.index())?;
            way.push((&above.hyperplane, half));
            next = above.parent;
        }
        let step = |region: Polytope<S>, (cut, half): &(&S::Hyperplane, Half)| {
            let [minus, plus] = region.divided(cut);
            match half {
                Half::Minus => minus,
                Half::Plus => plus,
            }
        };
        way.iter().rev().try_fold(whole.clone(), step)
    }
}
