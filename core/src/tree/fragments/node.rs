//! The arena: nodes in preorder, and the fragments of their coplanar sets.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::geometry::side::Half;
use crate::geometry::spaces::affine::{Affine, Polytope};
use crate::mesh::handle::NodeId;

/// An input of a tree: a convex piece and its number.
#[derive(Clone, Debug)]
pub struct Piece<S: Affine> {
    /// The convex piece.
    pub fragment: S::Fragment,
    /// The number of the input piece it comes from.
    pub number: u32,
}

/// A piece in a node's coplanar set.
#[derive(Clone, Debug)]
pub struct Fragment<S: Affine> {
    /// The part of an input piece.
    pub piece: Piece<S>,
    /// Whether it faces against its node's hyperplane.
    pub flipped: bool,
}

/// The origin of a node's hyperplane: enough to rebuild the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum NodeCut {
    /// The supporting hyperplane of the input piece with this number.
    Pivot(u32),
    /// x[axis] = at, in lattice steps: a free cut.
    Axis {
        /// The axis the cut is perpendicular to.
        axis: usize,
        /// The coordinate.
        at: i64,
    },
    /// The hyperplane at this index in the tree's own list, see [`FragmentTree::own`].
    Own(u32),
}

/// A region that is divided.
#[derive(Clone, Debug)]
pub struct Node<S: Affine> {
    /// H(v).
    pub hyperplane: S::Hyperplane,
    /// The origin of the hyperplane.
    pub cut: NodeCut,
    /// The coplanar set S(v), as a range of the tree's fragments.
    pub coplanar: Range<u32>,
    /// The subtree on the minus side, unless no facet lies there.
    pub minus: Option<NodeId>,
    /// The subtree on the plus side, unless no facet lies there.
    pub plus: Option<NodeId>,
    /// The parent and the side of it on which this node lies.
    pub parent: Option<(NodeId, Half)>,
    /// The number of cuts above.
    pub depth: u32,
}

/// A cut of a fragment of this piece by a node's hyperplane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crossing {
    /// The node.
    pub node: NodeId,
    /// The number of the piece.
    pub piece: u32,
}

/// A partition tree over facets.
#[derive(Clone, Debug)]
pub struct FragmentTree<S: Affine> {
    pub(super) nodes: Vec<Node<S>>,
    pub(super) fragments: Vec<Fragment<S>>,
    pub(super) crossings: Vec<Crossing>,
    pub(super) own: Vec<S::Hyperplane>,
}

impl<S: Affine> FragmentTree<S> {
    /// The tree without facets: one empty region.
    pub(super) fn empty(own: Vec<S::Hyperplane>) -> Self {
        Self {
            nodes: Vec::new(),
            fragments: Vec::new(),
            crossings: Vec::new(),
            own,
        }
    }

    /// The nodes in preorder, minus before plus; the root is first.
    pub fn nodes(&self) -> &[Node<S>] {
        &self.nodes
    }

    /// The fragments of all coplanar sets, node by node.
    pub fn fragments(&self) -> &[Fragment<S>] {
        &self.fragments
    }

    /// Every cut of a fragment, node by node.
    pub fn crossings(&self) -> &[Crossing] {
        &self.crossings
    }

    /// Hyperplanes that come from no facet and may have any direction.
    pub fn own(&self) -> &[S::Hyperplane] {
        &self.own
    }

    /// The subtree on one side of a node.
    pub fn child(&self, node: NodeId, half: Half) -> Option<NodeId> {
        let node = self.nodes.get(node.place())?;
        match half {
            Half::Minus => node.minus,
            Half::Plus => node.plus,
        }
    }

    /// R(v): the part of `whole` on the node's sides of all cuts above it.
    ///
    /// `None` if there is no such node or nothing is left.
    ///
    /// # Cost
    /// One division for each cut above.
    pub fn region(&self, node: NodeId, whole: &Polytope<S>) -> Option<Polytope<S>> {
        let mut way = Vec::new();
        let mut next = self.nodes.get(node.place())?.parent;
        while let Some((above, half)) = next {
            let above = self.nodes.get(above.place())?;
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
